//! Methods of the `diffuse` slot.

use crate::method::{for_all_methods, modules};

for_all_methods! { modules diffuse }
