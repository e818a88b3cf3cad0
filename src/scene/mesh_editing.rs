//! Adding meshes to a scene and replacing them.

use std::sync::OnceLock;

use super::mesh::{Mesh, Primitive};
use super::world::Scene;
use super::{MeshId, SceneError};

impl Scene {
    /// Adds a mesh; a node must place it before it is seen.
    ///
    /// # Errors
    /// [`SceneError::UnknownId`] if a primitive's material does not exist; [`SceneError::InvalidObject`] if its arrays
    /// contradict what [`Primitive`] promises.
    pub fn add_mesh(&mut self, mesh: Mesh) -> Result<MeshId, SceneError> {
        self.check_mesh(&mesh)?;
        Ok(self.insert_mesh(mesh))
    }

    /// Replaces a mesh, for instance one whose vertices moved, wherever nodes place it. It must have as many primitives as before.
    ///
    /// # Errors
    /// As [`Scene::add_mesh`]; [`SceneError::UnknownId`]; [`SceneError::InvalidObject`] if the number of primitives differs.
    pub fn set_mesh(&mut self, id: MeshId, mesh: Mesh) -> Result<(), SceneError> {
        self.check_replacement(id, &mesh)?;
        self.replace_mesh(id, mesh);
        Ok(())
    }

    /// [`Scene::add_mesh`] of a mesh as hosts have it: its normals are made unit vectors, and tangents are made where the material has a normal texture, as of
    /// files. `sound`: of its numbers all are known to be what they must, and its normals to be unit vectors.
    #[cfg(feature = "capi")]
    pub(crate) fn add_host_mesh(&mut self, mut mesh: Mesh, sound: bool) -> Result<MeshId, SceneError> {
        self.check_host_mesh(&mesh, sound)?;
        self.complete(&mut mesh, sound);
        Ok(self.insert_mesh(mesh))
    }

    /// Likewise [`Scene::set_mesh`].
    #[cfg(feature = "capi")]
    pub(crate) fn set_host_mesh(&mut self, id: MeshId, mut mesh: Mesh, sound: bool) -> Result<(), SceneError> {
        self.check("mesh", id.0, self.meshes.len())?;
        self.check_host_mesh(&mesh, sound)?;
        self.check_part_count(id, &mesh)?;
        self.complete(&mut mesh, sound);
        self.replace_mesh(id, mesh);
        Ok(())
    }

    #[cfg(feature = "capi")]
    fn check_host_mesh(&self, mesh: &Mesh, sound: bool) -> Result<(), SceneError> {
        if sound { self.check_mesh_by(mesh, Primitive::count_fault) } else { self.check_mesh(mesh) }
    }

    #[cfg(feature = "capi")]
    fn complete(&self, mesh: &mut Mesh, sound: bool) {
        for primitive in &mut mesh.primitives {
            if !sound {
                super::tangents::repair_normals(primitive);
            }
            match self.materials[primitive.material.0].normal_texture {
                Some(texture) => super::tangents::complete(primitive, texture),
                None => primitive.tangents = None,
            }
        }
    }

    fn insert_mesh(&mut self, mesh: Mesh) -> MeshId {
        self.emissions.push(mesh.primitives.iter().map(|_| OnceLock::new()).collect());
        self.shapes.push(mesh.primitives.iter().map(|_| OnceLock::new()).collect());
        self.meshes.push(mesh);
        self.count_mesh();
        self.mesh_changes.push(self.revisions.meshes);
        MeshId(self.meshes.len() - 1)
    }

    fn replace_mesh(&mut self, id: MeshId, mesh: Mesh) {
        self.shapes[id.0] = mesh.primitives.iter().map(|_| OnceLock::new()).collect();
        self.emissions[id.0] = mesh.primitives.iter().map(|_| OnceLock::new()).collect();
        let emits = |mesh: &Mesh| mesh.primitives.iter().any(|part| self.materials[part.material.0].emits());
        let lights = emits(&self.meshes[id.0]) || emits(&mesh);
        self.meshes[id.0] = mesh;
        self.count_mesh();
        self.mesh_changes[id.0] = self.revisions.meshes;
        self.revisions.lights += u64::from(lights);
        self.forget_bounds();
    }

    /// When each mesh changed last, in [`Revisions::meshes`](super::Revisions::meshes).
    pub(crate) fn mesh_changes(&self) -> &[u64] {
        &self.mesh_changes
    }

    pub(super) fn count_mesh(&mut self) {
        self.revisions.geometry += 1;
        self.revisions.meshes += 1;
    }

    fn check_replacement(&self, id: MeshId, mesh: &Mesh) -> Result<(), SceneError> {
        self.check("mesh", id.0, self.meshes.len())?;
        self.check_mesh(mesh)?;
        self.check_part_count(id, mesh)
    }

    fn check_part_count(&self, id: MeshId, mesh: &Mesh) -> Result<(), SceneError> {
        let (old, new) = (self.meshes[id.0].primitives.len(), mesh.primitives.len());
        if old == new {
            return Ok(());
        }
        Err(self.invalid("mesh", &mesh.name, format!("it has {new} primitives in place of {old}")))
    }

    fn check_mesh(&self, mesh: &Mesh) -> Result<(), SceneError> {
        self.check_mesh_by(mesh, Primitive::fault)
    }

    fn check_mesh_by(&self, mesh: &Mesh, fault: fn(&Primitive) -> Option<String>) -> Result<(), SceneError> {
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            self.check("material", primitive.material.0, self.materials.len())?;
            if let Some(fault) = fault(primitive) {
                return Err(self.invalid("mesh", &mesh.name, format!("primitive {index}: {fault}")));
            }
        }
        Ok(())
    }
}
