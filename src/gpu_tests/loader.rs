//! What several threads do to the loader at a time. Where it goes wrong the process dies (`vulkan/loader_lock.rs`).

use ash::vk;

use super::session::Session;
use crate::renderer::Context;
use crate::vulkan::{Buffer, Location};

#[test]
fn objects_are_named_while_other_threads_look_for_devices() {
    let session = Session::open();
    std::thread::scope(|scope| {
        for _ in 0..3 {
            scope.spawn(|| (0..8).for_each(|_| assert!(!Context::devices().expect("a loader").is_empty())));
        }
        scope.spawn(|| {
            let device = session.context.pipelines().device();
            for _ in 0..2000 {
                let (usage, location) = (vk::BufferUsageFlags::STORAGE_BUFFER, Location::Device);
                Buffer::new(device, "named", 64, usage, location).expect("room for 64 bytes");
            }
        });
    });
}
