//! The command line of irradia.
fn main() {}
