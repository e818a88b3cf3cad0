//! From where a picture is taken.

use std::ffi::c_char;

use glam::DAffine3;

use super::border::call;
use super::descriptor::{Descriptor, descriptors, read, read_optional, write, zero};
use super::matrix::affine;
use super::scene::{Id, SceneHandle, add, index_of};
use super::status::{Fault, Status};
use super::text::optional_text;
use crate::scene::{Camera, CameraId, CameraView, Projection};

/// Central projection by its vertical angle.
pub const IRRADIA_PROJECTION_PERSPECTIVE: u32 = 0;
/// Parallel projection by half its width and height.
pub const IRRADIA_PROJECTION_ORTHOGRAPHIC: u32 = 1;
/// Either of them by its matrix.
pub const IRRADIA_PROJECTION_MATRIX: u32 = 2;

/// A camera in the world. It looks along its -Z, +Y is up.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct CameraDescriptor {
    /// sizeof(irradia_camera_descriptor).
    pub size: usize,
    /// Camera space to world space, the inverse of a view matrix: 4×4, column after column. A rigid motion; what is not one is made one. All zero: the identity.
    pub world_from_camera: [f64; 16],
    /// One of IRRADIA_PROJECTION_….
    pub projection: u32,
    /// Zero.
    pub reserved: u32,
    /// Full angle of a perspective, radians, above 0 and below π.
    pub vertical_fov: f64,
    /// Nearest distance seen, metres; above 0 in a perspective.
    pub near: f64,
    /// Farthest distance that an orthographic camera sees, metres. A perspective has no far plane.
    pub far: f64,
    /// Half the width of what an orthographic camera sees, metres.
    pub half_width: f64,
    /// Half the height, metres.
    pub half_height: f64,
    /// For IRRADIA_PROJECTION_MATRIX: camera space to clip space, column after column, y up or down. Its depth is not looked at: `near` and `far` say that. It
    /// must be centred, and as wide as the frame.
    pub clip_from_camera: [f64; 16],
}

descriptors! {
    CameraDescriptor = "camera descriptor", size_of::<CameraDescriptor>();
}

/// The camera of a frame of `width` to `height` pixels.
pub(super) fn view(given: &CameraDescriptor, [width, height]: [u32; 2]) -> Result<CameraView, Fault> {
    let world = affine(&given.world_from_camera, "the camera's matrix")?;
    let projection = projection(given, Some(f64::from(width) / f64::from(height.max(1))))?;
    let DAffine3 { matrix3, translation } = world;
    let back = matrix3.z_axis;
    if !back.is_normalized() && back.length_squared() <= 0.0 {
        return Err(Fault::argument("the camera's matrix has no direction to look along"));
    }
    let view = CameraView::look_at(translation, translation - back, matrix3.y_axis, projection);
    view.fault().map_or(Ok(view), |fault| Err(Fault::argument(format!("the camera cannot be used: {fault}"))))
}

/// `aspect`: of the frame, if there is one yet.
pub(super) fn projection(given: &CameraDescriptor, aspect: Option<f64>) -> Result<Projection, Fault> {
    zero(given.reserved, CameraDescriptor::NAME)?;
    Ok(match given.projection {
        IRRADIA_PROJECTION_PERSPECTIVE => {
            Projection::Perspective { vertical_fov: given.vertical_fov, aspect: None, near: given.near }
        }
        IRRADIA_PROJECTION_ORTHOGRAPHIC => Projection::Orthographic {
            half_width: given.half_width,
            half_height: given.half_height,
            near: given.near,
            far: given.far,
        },
        IRRADIA_PROJECTION_MATRIX => by_matrix(given, aspect)?,
        other => {
            return Err(Fault::argument(format!("the projection is {other}; write one of IRRADIA_PROJECTION_…")));
        }
    })
}

fn by_matrix(given: &CameraDescriptor, aspect: Option<f64>) -> Result<Projection, Fault> {
    let m = &given.clip_from_camera;
    if !m.iter().all(|number| number.is_finite()) {
        return Err(Fault::argument("the projection's matrix has a number that is not finite"));
    }
    let wrong = |what: &str| Fault::argument(format!("the projection's matrix {what}"));
    let [x, y] = [m[0], m[5].abs()];
    if !(x > 0.0 && y > 0.0) {
        return Err(wrong("has no width or no height; matrices go column after column"));
    }
    let skewed = [m[1], m[2], m[3], m[4], m[6], m[7]].iter().any(|&number| number.abs() > 1e-9 * x.max(y));
    if skewed {
        return Err(wrong("is skewed; only such that scale x and y are taken"));
    }
    if let Some(aspect) = aspect.filter(|aspect| ((y / x) / aspect - 1.0).abs() > 1e-3) {
        return Err(wrong(&format!(
            "is made for a frame {:.4} times as wide as high, and this one is {aspect:.4}",
            y / x
        )));
    }
    let centred = |offsets: [f64; 2]| offsets.iter().all(|offset| offset.abs() < 1e-9);
    match [m[11], m[15]] {
        [-1.0, 0.0] if centred([m[8], m[9]]) => {
            Ok(Projection::Perspective { vertical_fov: 2.0 * (1.0 / y).atan(), aspect: None, near: given.near })
        }
        [0.0, 1.0] if centred([m[12], m[13]]) => {
            Ok(Projection::Orthographic { half_width: 1.0 / x, half_height: 1.0 / y, near: given.near, far: given.far })
        }
        [-1.0, 0.0] | [0.0, 1.0] => Err(wrong("is not centred; shift the picture instead")),
        _ => Err(wrong("is neither a perspective along -z nor a parallel projection")),
    }
}

/// The camera that a descriptor has, if there is one.
///
/// # Safety
/// `camera` is null or a descriptor.
pub(super) unsafe fn given(camera: *const CameraDescriptor, size: [u32; 2]) -> Result<Option<CameraView>, Fault> {
    // SAFETY: the caller's.
    unsafe { read_optional(camera) }?.map(|given| view(&given, size)).transpose()
}

/// Fills a descriptor, whose size is set, with a camera of the scene.
///
/// `name`: its name, its node's, or its number as text, 0 for the first; null: the first, or a view that shows the scene if it has none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_camera(
    scene: *const SceneHandle,
    name: *const c_char,
    camera: *mut CameraDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let (state, name) = unsafe { (border.enter(scene)?, optional_text(name, "the camera's name")?) };
        let view = state.work(|scene| scene.camera_view(name))?;
        let mut descriptor = CameraDescriptor {
            size: size_of::<CameraDescriptor>(),
            world_from_camera: glam::DMat4::from(view.world).to_cols_array(),
            projection: IRRADIA_PROJECTION_PERSPECTIVE,
            reserved: 0,
            vertical_fov: 0.0,
            near: 0.0,
            far: 0.0,
            half_width: 0.0,
            half_height: 0.0,
            clip_from_camera: [0.0; 16],
        };
        match view.projection {
            Projection::Perspective { vertical_fov, near, .. } => {
                (descriptor.vertical_fov, descriptor.near) = (vertical_fov, near);
            }
            Projection::Orthographic { half_width, half_height, near, far } => {
                descriptor.projection = IRRADIA_PROJECTION_ORTHOGRAPHIC;
                (descriptor.half_width, descriptor.half_height) = (half_width, half_height);
                (descriptor.near, descriptor.far) = (near, far);
            }
        }
        // SAFETY: as above.
        unsafe { write(camera, &descriptor) }
    })
}

/// A camera of a node.
///
/// # Safety
/// The pointers are what the header asks for.
unsafe fn of_node(descriptor: *const CameraDescriptor, name: *const c_char) -> Result<Camera, Fault> {
    // SAFETY: the caller's.
    let (given, name) = unsafe { (read(descriptor)?, optional_text(name, "the camera's name")?) };
    if given.world_from_camera != [0.0; 16] {
        return Err(Fault::argument("a scene's camera stands where its node does: its own matrix must be all zero"));
    }
    Ok(Camera { name: name.unwrap_or_default().to_owned(), projection: projection(&given, None)? })
}

/// Adds a camera; a node must place it before one can look through it, by its name or its number. It moves as its node does.
///
/// `name`: null: none. `descriptor`: how it projects; its `world_from_camera` is all zero. A matrix must be as wide as the frames that are taken through it: only their
/// height is looked at.
/// `id`: receives its identifier; may be null.
///
/// Errors: IRRADIA_ERROR_SCENE for a projection out of range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_add_camera(
    scene: *mut SceneHandle,
    name: *const c_char,
    descriptor: *const CameraDescriptor,
    id: *mut Id,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    unsafe { add(scene, id, |state| Ok(state.scene.add_camera(of_node(descriptor, name)?)?.0)) }
}

/// Replaces a camera, its name too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_set_camera(
    scene: *mut SceneHandle,
    id: Id,
    name: *const c_char,
    descriptor: *const CameraDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let (state, camera) = unsafe { (border.enter(scene)?, of_node(descriptor, name)?) };
        Ok(state.scene.set_camera(CameraId(index_of(id, "camera")?), camera)?)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> CameraDescriptor {
        CameraDescriptor {
            size: size_of::<CameraDescriptor>(),
            world_from_camera: [0.0; 16],
            projection: IRRADIA_PROJECTION_MATRIX,
            reserved: 0,
            vertical_fov: 0.0,
            near: 0.1,
            far: 10.0,
            half_width: 0.0,
            half_height: 0.0,
            clip_from_camera: [0.0; 16],
        }
    }

    /// Three metres to each side, two up and down.
    fn parallel(shift: f64) -> [f64; 16] {
        let columns = [[1.0 / 3.0, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, -0.1, 0.0], [shift, 0.0, 0.0, 1.0]];
        glam::DMat4::from_cols_array_2d(&columns).to_cols_array()
    }

    #[test]
    fn matrices_are_read_whatever_their_depth() {
        let (fov, aspect) = (0.9_f64, 1.5);
        let mut given = camera();
        let y = 1.0 / (0.5 * fov).tan();
        // Depths of Vulkan, of OpenGL, reversed and infinite.
        for [a, b] in [[-1.001, -0.1001], [-1.002, -0.2002], [0.0, 0.1]] {
            let columns = [[y / aspect, 0.0, 0.0, 0.0], [0.0, -y, 0.0, 0.0], [0.0, 0.0, a, -1.0], [0.0, 0.0, b, 0.0]];
            let matrix = glam::DMat4::from_cols_array_2d(&columns);
            given.clip_from_camera = matrix.to_cols_array();
            let found = view(&given, [300, 200]).expect("a perspective").projection;
            let Projection::Perspective { vertical_fov, near, .. } = found else { panic!("{found:?}") };
            assert!((vertical_fov - fov).abs() < 1e-12 && near == 0.1);
            assert!(view(&given, [200, 200]).is_err(), "of another shape");
        }
        given.clip_from_camera = parallel(0.0);
        let found = view(&given, [300, 200]).expect("parallel").projection;
        let Projection::Orthographic { half_width, half_height, .. } = found else { panic!("{found:?}") };
        assert!((half_width - 3.0).abs() < 1e-12 && (half_height - 2.0).abs() < 1e-12);
        given.clip_from_camera = parallel(0.1);
        assert!(view(&given, [300, 200]).is_err(), "off its centre");
        given.clip_from_camera = [f64::NAN; 16];
        assert!(view(&given, [350, 200]).is_err());
    }
}
