//! Matrices of the host's.

use glam::{DAffine3, DMat4};

use super::status::Fault;

/// From 4×4, column after column.
pub(super) fn affine(matrix: &[f64; 16], what: &str) -> Result<DAffine3, Fault> {
    if matrix.iter().all(|&number| number == 0.0) {
        return Ok(DAffine3::IDENTITY);
    }
    if !matrix.iter().all(|number| number.is_finite()) {
        return Err(Fault::argument(format!("{what} has a number that is not finite")));
    }
    if [matrix[3], matrix[7], matrix[11], matrix[15]] != [0.0, 0.0, 0.0, 1.0] {
        let sentence = format!("the last row of {what} is not 0 0 0 1; matrices go column after column");
        return Err(Fault::argument(sentence));
    }
    Ok(DAffine3::from_mat4(DMat4::from_cols_array(matrix)))
}
