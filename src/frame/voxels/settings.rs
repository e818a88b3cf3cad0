//! What voxels are asked for.

/// How triangles become voxels. Both ways give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Voxelisation {
    /// By invocations that each look through a tile of a triangle's columns.
    Compute,
    /// Drawn along their dominant axes, enlarged, each fragment a column. Takes geometry shaders.
    Raster,
}

/// What a method asks of the voxels of a frame; equal ones are made once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VoxelSettings {
    /// Voxels along the longest axis of the scene, 16 to 512.
    pub(crate) resolution: u32,
    /// `None`: `Compute`, which is faster where it was measured.
    pub(crate) voxelisation: Option<Voxelisation>,
    /// Closed meshes are filled.
    pub(crate) solid: bool,
    /// How fast the opacity of a voxel follows what is there, 1/s; 0: at once.
    pub(crate) adaption: f32,
    /// Cones meet the opacity that voxels have along their way, in place of the mean.
    pub(crate) directional: bool,
    /// Cones skip what is empty.
    pub(crate) skip_empty: bool,
    /// The width of a cone's samples over the cone's, above 0 and up to 1.
    pub(crate) cone_width: f32,
}

impl Default for VoxelSettings {
    fn default() -> VoxelSettings {
        VoxelSettings {
            resolution: 128,
            voxelisation: None,
            solid: false,
            adaption: 0.0,
            directional: true,
            skip_empty: true,
            cone_width: 0.5,
        }
    }
}
