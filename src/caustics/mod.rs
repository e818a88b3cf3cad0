//! Methods of the `caustics` slot.

use crate::method::{for_all_methods, modules};

for_all_methods! { modules caustics }
