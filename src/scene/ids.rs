//! Indices that name the things in a scene.

macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident,)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $id(pub usize);
    )*};
}

ids! {
    /// Index into [`Scene::meshes`](super::Scene::meshes).
    MeshId,
    /// Index into [`Scene::materials`](super::Scene::materials).
    MaterialId,
    /// Index into [`Scene::textures`](super::Scene::textures).
    TextureId,
    /// Index into [`Scene::nodes`](super::Scene::nodes).
    NodeId,
    /// Index into [`Scene::lights`](super::Scene::lights).
    LightId,
    /// Index into [`Scene::cameras`](super::Scene::cameras).
    CameraId,
}
