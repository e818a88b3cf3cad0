//! Passes leave marks on the device where a lost one is to name the last, and nothing where times count.

use super::session::DEVICE;
use crate::graph::{Graph, Store};
use crate::renderer::{Context, ContextOptions, CrashMarkers, Timing};

#[test]
fn passes_leave_marks_where_they_are_asked_to() {
    let count = |crash_markers| {
        let options = ContextOptions { device: std::env::var(DEVICE).ok(), crash_markers, ..ContextOptions::default() };
        let context = Context::new(&options).expect("a device");
        let mut store = Store::new(context.pipelines()).expect("a store");
        let mut graph = Graph::new(&mut store);
        let buffers = ["one", "two", "three"].map(|name| graph.buffer::<u32>(name, 4));
        for (buffer, name) in buffers.into_iter().zip(["test/one", "test/two", "test/three"]) {
            graph.fill_buffer(name, buffer, 7);
            graph.want_buffer(buffer);
        }
        graph.run(Timing::Frame).expect("a frame");
        store.marked_passes()
    };
    assert_eq!(count(CrashMarkers::On), 3);
    assert_eq!(count(CrashMarkers::Off), 0, "nothing stands between passes whose times count");
}
