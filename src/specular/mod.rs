//! Methods of the `specular` slot: none so far but estimators.

use crate::method::{for_all_methods, modules};

for_all_methods! { modules specular }
