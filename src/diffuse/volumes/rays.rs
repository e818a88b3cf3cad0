//! The scene that rays to and from caches meet.

use crate::method::FrameCx;
use crate::shaders::groups::SceneRays;
use crate::shaders::types::VolumeRays;

/// As passes bind it; absent in a frame that traces none.
pub(super) fn rays_of(cx: &mut FrameCx<'_, '_>) -> (SceneRays, VolumeRays) {
    let Some(traced) = cx.rays() else { return (SceneRays::absent(), VolumeRays { shift: [0.0; 3] }) };
    let shift = (cx.frame.data.origin - traced.origin).as_vec3().to_array();
    (traced.rays(cx.graph), VolumeRays { shift })
}
