//! What stands between frames: the memory behind the graph's names, what it holds, and how it was last used.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use ash::vk;

use super::barriers::State;
use super::interrupt::Interrupt;
use super::resource::{Body, Resource};
use crate::vulkan::{Buffer, Device, Image, ImageInfo, Location, Pipelines, Queries, Recorder, VulkanError};

pub(super) struct StoredImage {
    pub(super) image: Arc<Image>,
    pub(super) usage: vk::ImageUsageFlags,
    /// For each mip level of each layer ([`ImageInfo::level_and_layer`]).
    pub(super) states: Vec<State>,
    /// Likewise: the key of its content, if it has one.
    pub(super) keys: Vec<Option<u64>>,
    pub(super) piece: String,
}

pub(super) struct StoredBuffer {
    pub(super) buffer: Arc<Buffer>,
    pub(super) usage: vk::BufferUsageFlags,
    pub(super) bytes: u64,
    pub(super) upload: bool,
    pub(super) state: State,
    pub(super) key: Option<u64>,
    pub(super) piece: String,
}

/// Memory, pipelines and queries of one renderer.
pub(crate) struct Store {
    pub(super) device: Arc<Device>,
    pub(super) pipelines: Arc<Pipelines>,
    pub(super) recorder: Recorder,
    pub(super) queries: Queries,
    pub(super) images: HashMap<String, StoredImage>,
    pub(super) buffers: HashMap<String, StoredBuffer>,
    /// One word for each pass of the frame, written when it has finished.
    pub(super) markers: Buffer,
    /// Work counters and indirect arguments, copied here for the host.
    pub(super) counters: Buffer,
    pub(super) read_back: Option<Buffer>,
    /// Elements that growing buffers need, by name.
    pub(super) grown: HashMap<String, usize>,
    /// What outlasts frames, by name.
    pub(super) kept: HashMap<String, Kept>,
    pub(crate) interrupt: Interrupt,
    /// What passes that ran made of programs and formats.
    #[cfg(test)]
    pub(crate) uses: Vec<super::uses::ProgramUse>,
}

/// Something that outlasts frames (super::kept).
pub(super) struct Kept {
    /// Names all that it is about.
    pub(super) depends: u64,
    /// Frames that made it what it is.
    pub(super) age: u32,
}

/// Passes of a frame for which there are timestamps, markers and counters: with rays, a gather takes 96 of at most 196,323 VPLs a pass.
pub(super) const MAX_PASSES: u32 = 4096;
/// Timestamps around the submissions of a frame, of which there are two at most; those around passes follow.
pub(super) const STAMPS: u32 = 4;
pub(super) const MAX_COUNTERS: u64 = 4 * MAX_PASSES as u64;

impl Store {
    pub(crate) fn new(pipelines: &Arc<Pipelines>) -> Result<Store, VulkanError> {
        let device = pipelines.device();
        let host_visible = |name: &str, bytes| {
            Buffer::new(device, name, bytes, vk::BufferUsageFlags::TRANSFER_DST, Location::ReadBack)
        };
        Ok(Store {
            device: device.clone(),
            pipelines: pipelines.clone(),
            recorder: Recorder::new(device)?,
            queries: Queries::new(device, stamp_of_pass(MAX_PASSES))?,
            images: HashMap::new(),
            buffers: HashMap::new(),
            markers: host_visible("crash markers", u64::from(MAX_PASSES) * 4)?,
            counters: host_visible("work counters", MAX_COUNTERS * 4)?,
            read_back: None,
            grown: HashMap::new(),
            kept: HashMap::new(),
            interrupt: Interrupt::default(),
            #[cfg(test)]
            uses: Vec::new(),
        })
    }

    /// Passes of the last frame that left a mark.
    #[cfg(test)]
    pub(crate) fn marked_passes(&self) -> usize {
        let bytes = self.markers.mapped().expect("it is read by the host");
        bytes.chunks_exact(4).filter(|word| **word != [0; 4]).count()
    }

    /// Bytes of the largest buffer that a kernel may see whole.
    pub(super) fn largest_buffer(&self) -> usize {
        self.device.limits().max_storage_buffer_range as usize
    }

    pub(crate) fn device(&self) -> &Arc<Device> {
        &self.device
    }

    pub(crate) fn pipelines(&self) -> &Arc<Pipelines> {
        &self.pipelines
    }

    /// Forgets all contents, so that everything asked for is made anew. Memory stays.
    pub(crate) fn invalidate(&mut self) {
        for image in self.images.values_mut() {
            image.keys.fill(None);
        }
        for buffer in self.buffers.values_mut() {
            buffer.key = None;
        }
    }

    /// How often what outlasts frames was made anew, all together.
    pub(crate) fn past(&self) -> u64 {
        self.kept.values().map(|kept| u64::from(kept.age)).sum()
    }

    /// Lets everything that outlasts frames start anew.
    pub(crate) fn reset_history(&mut self) {
        for name in std::mem::take(&mut self.kept).into_keys() {
            for name in names_of(&name) {
                if let Some(image) = self.images.get_mut(&name) {
                    image.keys.fill(None);
                }
                if let Some(buffer) = self.buffers.get_mut(&name) {
                    buffer.key = None;
                }
            }
        }
    }

    /// Names of all memory that is held.
    #[cfg(test)]
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.images.keys().chain(self.buffers.keys()).cloned().collect();
        names.sort();
        names
    }

    /// Returns the memory behind a name, with what it holds.
    #[cfg(test)]
    pub(crate) fn evict(&mut self, name: &str) {
        self.images.remove(name);
        self.buffers.remove(name);
    }

    /// Lets the memory behind two names change places.
    pub(super) fn swap(&mut self, one: &str, other: &str) {
        if let [Some(a), Some(b)] = self.images.get_disjoint_mut([one, other]) {
            std::mem::swap(a, b);
        }
        if let [Some(a), Some(b)] = self.buffers.get_disjoint_mut([one, other]) {
            std::mem::swap(a, b);
        }
    }

    pub(super) fn note_kept(&mut self, name: &str, depends: u64, age: u32) {
        self.kept.insert(name.to_owned(), Kept { depends, age });
    }

    /// Forgets all contents and how they were last used: after a frame that failed, what was recorded may not have run.
    pub(super) fn forget(&mut self) {
        self.invalidate();
        for image in self.images.values_mut() {
            image.states.fill(State::default());
        }
        for buffer in self.buffers.values_mut() {
            buffer.state = State::default();
        }
    }

    /// The key of what the named image holds, if it has this shape.
    pub(super) fn image_key(&self, name: &str, info: &ImageInfo, part: u32) -> Option<u64> {
        let stored = self.images.get(name).filter(|stored| stored.image.info == *info)?;
        stored.keys[part as usize]
    }

    /// The key of what the named buffer holds, if it has this size.
    pub(super) fn buffer_key(&self, name: &str, bytes: u64) -> Option<u64> {
        self.buffers.get(name).filter(|stored| stored.bytes == bytes)?.key
    }

    /// Whether the memory behind `resource` can serve this frame's uses.
    pub(super) fn fits(&self, resource: &Resource) -> bool {
        match &resource.body {
            Body::Image(info) => self
                .images
                .get(&resource.name)
                .is_some_and(|stored| stored.image.info == *info && stored.usage.contains(resource.image_usage)),
            Body::Buffer { bytes } => self.buffers.get(&resource.name).is_some_and(|stored| {
                !stored.upload && stored.bytes == *bytes && stored.usage.contains(resource.buffer_usage)
            }),
            Body::Upload(data) => self.buffers.get(&resource.name).is_some_and(|stored| {
                stored.upload && stored.bytes == data.len() as u64 && stored.usage.contains(resource.buffer_usage)
            }),
            Body::ExternalBuffer(_) | Body::ExternalImage(_) => true,
        }
    }

    /// Makes the memory behind `resource` fit for this frame's uses.
    pub(super) fn provide(&mut self, resource: &Resource) -> Result<(), VulkanError> {
        if self.fits(resource) {
            return Ok(());
        }
        let piece = resource.piece.clone().unwrap_or_default();
        let name = &resource.name;
        match &resource.body {
            Body::Image(info) => {
                // The old memory is returned first: the two need not fit side by side.
                let old = self.images.remove(name).map_or(vk::ImageUsageFlags::empty(), |stored| stored.usage);
                let usage = resource.image_usage | old;
                let flags = match info.holds_cubes() {
                    true => vk::ImageCreateFlags::CUBE_COMPATIBLE,
                    false => vk::ImageCreateFlags::empty(),
                };
                let image = Image::new(&self.device, name, *info, usage, flags)?;
                let parts = info.parts() as usize;
                let stored = StoredImage {
                    image: Arc::new(image),
                    usage,
                    states: vec![State::default(); parts],
                    keys: vec![None; parts],
                    piece,
                };
                self.images.insert(name.clone(), stored);
            }
            Body::Buffer { bytes } => {
                self.provide_buffer(name, *bytes, resource.buffer_usage, Location::Device, piece)?
            }
            Body::Upload(data) => {
                self.provide_buffer(name, data.len() as u64, resource.buffer_usage, Location::Upload, piece)?
            }
            Body::ExternalBuffer(_) | Body::ExternalImage(_) => {}
        }
        Ok(())
    }

    fn provide_buffer(
        &mut self,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: Location,
        piece: String,
    ) -> Result<(), VulkanError> {
        let old = self.buffers.remove(name).map_or(vk::BufferUsageFlags::empty(), |stored| stored.usage);
        let usage = usage | old;
        let limit = self.largest_buffer() as u64;
        if usage.contains(vk::BufferUsageFlags::STORAGE_BUFFER) && bytes > limit {
            let mib = |bytes: u64| format!("{} MiB", bytes >> 20);
            return Err(VulkanError::TooLarge { what: name.to_owned(), asked: mib(bytes), limit: mib(limit) });
        }
        let buffer = Arc::new(Buffer::new(&self.device, name, bytes, usage, location)?);
        let upload = location == Location::Upload;
        self.buffers.insert(
            name.to_owned(),
            StoredBuffer { buffer, usage, bytes, upload, state: State::default(), key: None, piece },
        );
        Ok(())
    }

    /// Returns the memory of names that a frame no longer declares, but for what outlasts frames.
    pub(super) fn retain(&mut self, declares: impl Fn(&str) -> bool) {
        let kept: Vec<String> = self.kept.keys().flat_map(|name| names_of(name)).collect();
        let keep = |name: &str| declares(name) || kept.iter().any(|known| known == name);
        self.grown.retain(|name, _| keep(name));
        self.images.retain(|name, _| keep(name));
        self.buffers.retain(|name, _| keep(name));
    }

    /// Bytes that each piece's images and buffers hold.
    pub(crate) fn memory_by_piece(&self) -> BTreeMap<String, u64> {
        self.memory_by_part().into_iter().map(|(piece, parts)| (piece, parts.values().sum())).collect()
    }

    /// The same by their names as well; those that differ in a number at the end are one.
    pub(crate) fn memory_by_part(&self) -> BTreeMap<String, BTreeMap<String, u64>> {
        let images = self.images.iter().map(|(name, stored)| (name, &stored.piece, stored.image.bytes()));
        let buffers = self.buffers.iter().map(|(name, stored)| (name, &stored.piece, stored.buffer.bytes()));
        let mut bytes: BTreeMap<String, BTreeMap<String, u64>> = BTreeMap::new();
        for (name, piece, held) in images.chain(buffers) {
            let part = name.trim_end_matches(|c: char| c.is_ascii_digit()).strip_suffix('.').unwrap_or(name);
            *bytes.entry(piece.clone()).or_default().entry(part.to_owned()).or_default() += held;
        }
        bytes
    }
}

/// What the memory of something kept may be called: a history has two copies.
fn names_of(kept: &str) -> [String; 3] {
    [kept.to_owned(), format!("{kept}.last"), format!("{kept}.next")]
}

/// The timestamp before submission number `number`; the one after it follows.
pub(super) fn stamp_of_frame(number: usize) -> u32 {
    2 * u32::try_from(number).unwrap_or(0)
}

/// The timestamp before the pass in slot `slot`; the one after it follows.
pub(super) fn stamp_of_pass(slot: u32) -> u32 {
    STAMPS + 2 * slot
}
