//! Which instances send out light, and where on them it comes from.

use std::sync::Arc;

use super::emission::{Emission, emission_of};
use super::mesh::Instance;
use super::world::Scene;

impl Scene {
    /// What the surface of an instance sends out. Kept until its material changes.
    pub(crate) fn emission(&self, instance: &Instance) -> &Arc<Emission> {
        let primitive = self.primitive(instance);
        self.emissions[instance.mesh.0][instance.primitive]
            .get_or_init(|| Arc::new(emission_of(primitive, self.material_of(instance), &self.textures)))
    }

    /// Whether some point of an instance sends out light.
    pub(crate) fn shines(&self, instance: &Instance) -> bool {
        self.material_of(instance).emits() && **self.emission(instance) != Emission::Dark
    }
}
