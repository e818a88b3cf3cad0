//! What a file says about itself.

use std::collections::BTreeMap;

/// What a picture is of, by name: scene, settings, device, version …
pub type Attributes = BTreeMap<String, String>;
