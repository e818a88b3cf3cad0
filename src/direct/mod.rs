//! Methods of the `direct` slot.

use crate::method::{for_all_methods, modules};

for_all_methods! { modules direct }
