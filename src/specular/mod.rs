//! Methods of the `specular` slot.

use crate::method::{for_all_methods, modules};

for_all_methods! { modules specular }
