//! What several threads do to the loader at a time. Where it goes wrong the process dies (`vulkan/loader_lock.rs`); it does
//! with loader 1.4.309 where it finds drivers without devices.

use std::sync::atomic::{AtomicUsize, Ordering};

use ash::vk;

use super::session::Session;
use crate::renderer::Context;
use crate::vulkan::{Buffer, Location};

#[test]
fn objects_are_named_while_other_threads_look_for_devices() {
    let session = Session::open();
    let device = session.context.pipelines().device();
    let (usage, location) = (vk::BufferUsageFlags::STORAGE_BUFFER, Location::Device);
    let buffer = Buffer::new(device, "a buffer", 64, usage, location).expect("room for 64 bytes");
    let looking = AtomicUsize::new(2);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                (0..8).for_each(|_| assert!(!Context::devices().expect("a loader").is_empty()));
                looking.fetch_sub(1, Ordering::Relaxed);
            });
        }
        scope.spawn(|| {
            while looking.load(Ordering::Relaxed) > 0 {
                device.set_name(buffer.raw, "a buffer");
            }
        });
    });
}
