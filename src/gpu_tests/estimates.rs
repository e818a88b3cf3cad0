//! What estimators add to a frame.

use std::sync::Arc;

use super::session::Session;
use crate::frame::compose::{MEANS_AT_ONCE, estimated};
use crate::graph::Graph;
use crate::renderer::{Slot, Timing};

/// However many rows a pass takes.
#[test]
fn means_become_the_slot_they_are_of() {
    let session = Session::open();
    let size = [13_u32, 9];
    let means: Vec<[f32; 3]> =
        (0..size[0] * size[1]).map(|pixel| [0.5, 1.0, 2.0].map(|part| part * pixel as f32)).collect();
    let bytes: Arc<[u8]> = bytemuck::cast_slice(&means).into();
    for bytes_at_once in [1, 12 * 13 * 4, MEANS_AT_ONCE] {
        let mut store = session.store();
        let mut graph = Graph::new(&mut store);
        let image = estimated(&mut graph, Slot::Caustics, size, (&bytes, 7), bytes_at_once);
        let read_back = graph.read_back(image);
        let found: Vec<[f32; 4]> =
            bytemuck::pod_collect_to_vec(&graph.run(Timing::Frame).expect("a frame").take(read_back));
        for (pixel, (found, mean)) in found.iter().zip(&means).enumerate() {
            assert_eq!(found[..3], mean[..], "pixel {pixel}, {bytes_at_once} bytes at once");
        }
    }
}
