//! Memory over frames. A *history* has two copies: passes read the last frame's while they write the next, and the two change places where a frame
//! made the next one. A *state* is changed in place, by passes that run once it is known that all buffers of the frame are large enough. Both
//! start at zero, with age 0, outlast frames that do not declare them, and begin anew where what they depend on changes.
//!
//! A frame that fails leaves both as they were, and so does one that has to be made again with larger buffers.

use ash::vk;

use super::bindings::{BufferRef, ImageRef};
use super::declare::Graph;
use super::demand::Verdict;
use super::key::hash_of;
use super::pass::ClearColor;
use super::resource::KeptUse;
use crate::vulkan::ImageInfo;

/// Whether a frame in which nothing else changed makes the next copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Advance {
    EveryFrame,
    OnChange,
}

/// An image of the last frame and the one of this frame, which a pass writes whole.
#[cfg_attr(not(test), allow(dead_code, reason = "methods keep buffers; tests keep images"))]
#[derive(Clone, Copy, Debug)]
pub(crate) struct HistoryImage {
    pub(crate) last: ImageRef,
    pub(crate) next: ImageRef,
    /// Frames that made it what `last` holds.
    pub(crate) age: u32,
}

/// Likewise of buffers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HistoryBuffer<T> {
    pub(crate) last: BufferRef<T>,
    pub(crate) next: BufferRef<T>,
    pub(crate) age: u32,
}

/// What a frame finds of something kept.
struct Found {
    age: u32,
    depends: u64,
    /// Of the content that the frame starts from.
    key: u64,
}

impl Graph<'_> {
    /// An image in two copies. `depends` names all that what it holds is about; another value starts anew.
    #[cfg_attr(not(test), allow(dead_code, reason = "methods keep buffers; tests keep images"))]
    pub(crate) fn history_image(
        &mut self,
        name: &str,
        info: ImageInfo,
        depends: u64,
        advance: Advance,
    ) -> HistoryImage {
        let found = self.found(name, hash_of(&(depends, info)), advance);
        let [last, next] = ["last", "next"].map(|copy| self.image_with(&format!("{name}.{copy}"), info));
        for copy in [last, next] {
            self.keep_image(copy, "history");
        }
        self.start_image(name, last, &found);
        self.note_use(name, next.id, true, &found);
        HistoryImage { last, next, age: found.age }
    }

    /// A buffer in two copies.
    pub(crate) fn history_buffer<T>(
        &mut self,
        name: &str,
        count: usize,
        depends: u64,
        advance: Advance,
    ) -> HistoryBuffer<T> {
        let found = self.found(name, hash_of(&(depends, count, size_of::<T>())), advance);
        let [last, next] = ["last", "next"].map(|copy| self.buffer::<T>(&format!("{name}.{copy}"), count));
        for copy in [last, next] {
            self.keep_buffer(copy, "history");
        }
        self.start_buffer(name, last, &found);
        self.note_use(name, next.id, true, &found);
        HistoryBuffer { last, next, age: found.age }
    }

    /// An image that passes modify in place, and its age.
    #[cfg_attr(not(test), allow(dead_code, reason = "methods keep buffers; tests keep images"))]
    pub(crate) fn state_image(
        &mut self,
        name: &str,
        info: ImageInfo,
        depends: u64,
        advance: Advance,
    ) -> (ImageRef, u32) {
        let found = self.found(name, hash_of(&(depends, info)), advance);
        let image = self.image_with(name, info);
        self.keep_image(image, "state");
        self.start_image(name, image, &found);
        self.note_use(name, image.id, false, &found);
        (image, found.age)
    }

    /// A buffer that passes modify in place, and its age.
    pub(crate) fn state_buffer<T>(
        &mut self,
        name: &str,
        count: usize,
        depends: u64,
        advance: Advance,
    ) -> (BufferRef<T>, u32) {
        let found = self.found(name, hash_of(&(depends, count, size_of::<T>())), advance);
        let buffer = self.buffer::<T>(name, count);
        self.keep_buffer(buffer, "state");
        self.start_buffer(name, buffer, &found);
        self.note_use(name, buffer.id, false, &found);
        (buffer, found.age)
    }

    fn note_use(&mut self, name: &str, resource: usize, in_two_copies: bool, found: &Found) {
        let swap = in_two_copies.then(|| ["last", "next"].map(|copy| format!("{name}.{copy}")));
        let (name, depends, age) = (name.to_owned(), found.depends, found.age);
        self.kept.push(KeptUse { name, resource, swap, depends, age });
    }

    fn found(&self, name: &str, depends: u64, advance: Advance) -> Found {
        let age = self.store.kept.get(name).filter(|kept| kept.depends == depends).map_or(0, |kept| kept.age);
        // What does not advance by itself makes nothing that reads it run again.
        let turn = if advance == Advance::EveryFrame { age } else { 0 };
        Found { age, depends, key: hash_of(&("kept", name, depends, turn)).max(1) }
    }

    /// Any frame may use it in any way: memory that lacks a use would be replaced, and what it holds lost.
    fn keep_image(&mut self, image: ImageRef, piece: &str) {
        let resource = &mut self.resources[image.id];
        resource.image_usage |= vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        resource.piece = Some(piece.to_owned());
    }

    fn keep_buffer<T>(&mut self, buffer: BufferRef<T>, piece: &str) {
        self.keep_for_passes(buffer);
        self.resources[buffer.id].piece = Some(piece.to_owned());
    }

    fn start_image(&mut self, name: &str, image: ImageRef, found: &Found) {
        if found.age == 0 {
            use vk::Format as F;
            let integers = [F::R32_UINT, F::R32G32_UINT, F::R32G32B32A32_UINT].contains(&image.info.format);
            let zero = if integers { ClearColor::Uint([0; 4]) } else { ClearColor::Float([0.0; 4]) };
            self.clear_image(&format!("memory/zero-{name}"), image, zero);
        }
        self.holds(image.id, found);
    }

    fn start_buffer<T>(&mut self, name: &str, buffer: BufferRef<T>, found: &Found) {
        if found.age == 0 {
            self.fill_buffer(&format!("memory/zero-{name}"), buffer, 0);
        }
        self.holds(buffer.id, found);
    }

    /// What the frame starts from has one key, whether it is zero or what frames before left.
    fn holds(&mut self, id: usize, found: &Found) {
        for content in &mut self.resources[id].content {
            content.0 = found.key;
        }
        if found.age == 0 {
            let zeroing = self.passes.last_mut().expect("declared just before");
            zeroing.needs.writes.iter_mut().for_each(|version| version.key = found.key);
        }
    }

    /// What running passes make anew of what is kept, by number.
    pub(super) fn advancing(&self, verdicts: &[Verdict]) -> Vec<usize> {
        let writes = |id: usize| {
            let mut running = self.passes.iter().zip(verdicts).filter(|(_, verdict)| **verdict == Verdict::Run);
            running.any(|(pass, _)| pass.piece != "memory" && pass.needs.writes.iter().any(|write| write.place.0 == id))
        };
        (0..self.kept.len()).filter(|&index| writes(self.kept[index].resource)).collect()
    }

    /// The first running pass that changes a state, which has to wait for growing buffers.
    pub(super) fn first_change_of_state(&self, verdicts: &[Verdict]) -> Option<usize> {
        let states: Vec<usize> =
            self.kept.iter().filter(|kept| kept.swap.is_none()).map(|kept| kept.resource).collect();
        let changes = |index: &usize| {
            let pass = &self.passes[*index];
            verdicts[*index] == Verdict::Run
                && pass.piece != "memory"
                && pass.needs.writes.iter().any(|write| states.contains(&write.place.0))
        };
        (0..self.passes.len()).find(changes)
    }

    /// Lets copies change places: what was made last becomes what is read.
    pub(super) fn swap_histories(&mut self, advancing: &[usize]) {
        for &index in advancing {
            let KeptUse { swap, age, .. } = &self.kept[index];
            if let (Some([last, next]), true) = (swap, *age > 0) {
                self.store.swap(last, next);
            }
        }
    }

    /// Notes that a frame succeeded.
    pub(super) fn note_ages(&mut self, advancing: &[usize]) {
        for &index in advancing {
            let kept = &self.kept[index];
            self.store.note_kept(&kept.name, kept.depends, kept.age.saturating_add(1));
        }
    }
}
