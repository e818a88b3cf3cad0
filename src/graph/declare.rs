//! A frame while it is declared: its images, buffers and passes, and what is asked of it.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::marker::PhantomData;
use std::sync::Arc;

use ash::vk;
use bytemuck::Pod;

use super::bindings::{Access, BufferRef, BufferUse, ImageRef, ImageUse, Part};
use super::demand::{Place, Version};
use super::dependence::Dependence;
use super::key::hash_of;
use super::pass::{ClearColor, Pass, Work};
use super::resource::{Body, KeptUse, Proof, ReadBack, Resource};
use super::store::Store;
use crate::vulkan::{Buffer, DeviceTraits, Image, ImageInfo};

/// One frame while it is declared.
pub(crate) struct Graph<'s> {
    pub(super) store: &'s mut Store,
    pub(super) resources: Vec<Resource>,
    pub(super) passes: Vec<Pass>,
    pub(super) wanted: Vec<Version>,
    /// Of images, one level of some layers.
    pub(super) read_backs: Vec<(usize, Option<Part>)>,
    pub(super) growing: Vec<Growing>,
    pub(super) watcher: Option<Watcher>,
    /// Whether what earlier graphs on the same store left may be read.
    pub(super) goes_on: bool,
    pub(super) kept: Vec<KeptUse>,
    /// Held while it is proved what passes write.
    pub(super) proof: Option<Proof>,
    /// The first mistake that the frame was declared with, as a sentence.
    pub(super) mistake: Option<String>,
}

/// What a pass wrote.
pub(crate) enum Output {
    /// One mip level of an image.
    Image(ImageRef),
    Buffer(BufferRef<u32>),
}

/// Declares passes that look at the outputs of the one that was just declared, whose name it gets.
pub(crate) type Watcher = Box<dyn FnMut(&mut Graph<'_>, &str, &[(String, Output)])>;

/// The key of what nobody has written.
pub(super) const NOTHING: u64 = 0;

/// A buffer whose size only the device finds out.
pub(super) struct Growing {
    pub(super) name: String,
    pub(super) capacity: usize,
    /// Elements that the device allows.
    pub(super) most: usize,
    pub(super) needed: ReadBack,
    pub(super) index: usize,
}

impl<'s> Graph<'s> {
    pub(crate) fn new(store: &'s mut Store) -> Graph<'s> {
        Graph {
            store,
            resources: Vec::new(),
            passes: Vec::new(),
            wanted: Vec::new(),
            read_backs: Vec::new(),
            growing: Vec::new(),
            watcher: None,
            goes_on: false,
            kept: Vec::new(),
            proof: None,
            mistake: None,
        }
    }

    /// One of several that do a work together, submission by submission: what earlier ones left may be read.
    pub(crate) fn going_on(store: &'s mut Store) -> Graph<'s> {
        Graph { goes_on: true, ..Graph::new(store) }
    }

    /// Notes a mistake; the first one is what running the frame fails with.
    pub(super) fn note_mistake(&mut self, sentence: impl FnOnce() -> String) {
        self.mistake.get_or_insert_with(sentence);
    }

    /// What passes are shaped by that depends on the driver.
    pub(crate) fn traits(&self) -> DeviceTraits {
        self.store.device().traits()
    }

    /// Whether depths are drawn anew by the triangles' planes, since the device rounds vertices coarsely.
    pub(crate) fn draws_plane_depths(&self) -> bool {
        self.traits().plane_depths
    }

    /// The longest side that an image of the device may have.
    pub(crate) fn longest_side(&self) -> u32 {
        self.store.device().limits().max_image_dimension2_d
    }

    fn add(&mut self, name: &str, body: Body, places: u32, content: impl Fn(u32) -> (u64, Dependence)) -> usize {
        if self.resources.iter().any(|resource| resource.name == name) {
            self.note_mistake(|| format!("two resources are called {name}"));
        }
        let content = (0..places).map(content).collect();
        let (image_usage, buffer_usage) = Default::default();
        self.resources.push(Resource { name: name.to_owned(), body, content, image_usage, buffer_usage, piece: None });
        self.resources.len() - 1
    }

    /// An image of the frame. No pass may read it before one has written it, but in a graph that goes on ([`Graph::going_on`]).
    pub(crate) fn image(&mut self, name: &str, format: vk::Format, extent: [u32; 2]) -> ImageRef {
        self.image_with(
            name,
            ImageInfo { format, extent: [extent[0], extent[1], 1], mips: 1, layers: 1, volume: false },
        )
    }

    /// An image of any shape.
    pub(crate) fn image_with(&mut self, name: &str, info: ImageInfo) -> ImageRef {
        let left = |part: u32| self.store.image_key(name, &info, part).filter(|_| self.goes_on).unwrap_or(NOTHING);
        let held: Vec<u64> = (0..info.parts()).map(left).collect();
        let id = self.add(name, Body::Image(info), info.parts(), |part| (held[part as usize], Dependence::NONE));
        ImageRef::whole(id, info)
    }

    /// Whether passes have written all of these levels and layers.
    pub(super) fn is_written(&self, image: ImageRef) -> bool {
        image.part().places().all(|place| self.resources[image.id].content[place as usize].0 != NOTHING)
    }

    /// The name that an image was declared by.
    pub(crate) fn name_of(&self, image: ImageRef) -> &str {
        &self.resources[image.id].name
    }

    /// A buffer of `count` elements. As with images, writing comes first.
    pub(crate) fn buffer<T>(&mut self, name: &str, count: usize) -> BufferRef<T> {
        let bytes = (size_of::<T>() * count) as u64;
        let held = self.store.buffer_key(name, bytes).filter(|_| self.goes_on).unwrap_or(NOTHING);
        let id = self.add(name, Body::Buffer { bytes }, 1, |_| (held, Dependence::NONE));
        BufferRef { id, count, element: PhantomData }
    }

    /// A buffer for a number of elements that only the device finds out: `least` at first, and what [`Graph::grows`] found to be
    /// needed from then on, never more than the device allows.
    pub(crate) fn growing_buffer<T>(&mut self, name: &str, least: usize) -> BufferRef<T> {
        let count = self.store.grown.get(name).map_or(least, |&grown| grown.max(least));
        self.buffer(name, count.min(self.store.largest_buffer() / size_of::<T>().max(1)))
    }

    /// Says that word `index` of `needed` counts the elements that `buffer` ought to hold, also those for which there is no room. If it turns out
    /// that there was not enough, [`Executed::outgrown`] says so, and the frame has to be declared and made again; if the device does not allow
    /// as many, the frame fails.
    pub(crate) fn grows<T>(&mut self, buffer: BufferRef<T>, needed: BufferRef<u32>, index: usize) {
        let needed_words = needed.count;
        let needed = self.read_back_buffer(needed);
        let name = self.resources[buffer.id].name.clone();
        let most = self.store.largest_buffer() / size_of::<T>().max(1);
        if index >= needed_words {
            self.note_mistake(|| format!("{name} grows by word {index} of a buffer of {needed_words}"));
        }
        self.growing.push(Growing { name, capacity: buffer.count, most, needed, index });
    }

    /// A buffer that the host fills with `elements`.
    pub(crate) fn upload<T: Pod>(&mut self, name: &str, elements: &[T], dependence: Dependence) -> BufferRef<T> {
        let bytes: &[u8] = bytemuck::cast_slice(elements);
        let key = hash_of(&(name, bytes));
        let id = self.add(name, Body::Upload(bytes.into()), 1, |_| (key, dependence));
        BufferRef { id, count: elements.len(), element: PhantomData }
    }

    /// A buffer that the host fills with `bytes`, elements of `T`, whose content `key` names.
    pub(crate) fn upload_shared<T: Pod>(
        &mut self,
        name: &str,
        bytes: Arc<[u8]>,
        key: u64,
        dependence: Dependence,
    ) -> BufferRef<T> {
        let count = bytes.len() / size_of::<T>().max(1);
        let id = self.add(name, Body::Upload(bytes), 1, |_| (key, dependence));
        BufferRef { id, count, element: PhantomData }
    }

    /// A buffer of the scene, whose content `key` names. Several pieces may import the same one.
    pub(crate) fn import_buffer<T>(
        &mut self,
        name: &str,
        buffer: &Arc<Buffer>,
        key: u64,
        dependence: Dependence,
    ) -> BufferRef<T> {
        let count = usize::try_from(buffer.size).unwrap_or(0) / size_of::<T>().max(1);
        let is_same = |resource: &Resource| {
            resource.name == name && matches!(&resource.body, Body::ExternalBuffer(known) if Arc::ptr_eq(known, buffer))
        };
        let known = self.resources.iter().position(is_same);
        let id =
            known.unwrap_or_else(|| self.add(name, Body::ExternalBuffer(buffer.clone()), 1, |_| (key, dependence)));
        BufferRef { id, count, element: PhantomData }
    }

    /// An image of the scene, in the layout for sampling, whose content `key` names.
    #[allow(
        dead_code,
        reason = "textures are bound per material so far; compute passes that sample them bind them here"
    )]
    pub(crate) fn import_image(
        &mut self,
        name: &str,
        image: &Arc<Image>,
        key: u64,
        dependence: Dependence,
    ) -> ImageRef {
        let info = image.info;
        let id = self.add(name, Body::ExternalImage(image.clone()), info.parts(), |_| (key, dependence));
        ImageRef::whole(id, info)
    }

    /// Sets every texel of a colour image.
    pub(crate) fn clear_image(&mut self, name: &str, image: ImageRef, value: ClearColor) {
        let bytes = format!("{value:?}").into_bytes();
        let work = Work::ClearImage { image: image.id, part: image.part(), value };
        let access = image.access(ImageUse::Clear);
        self.add_pass(Pass::transfer(name, access, bytes, work));
    }

    /// Sets every word of a buffer.
    pub(crate) fn fill_buffer<T>(&mut self, name: &str, buffer: BufferRef<T>, word: u32) {
        let access = buffer.access(BufferUse::Clear);
        let work = Work::FillBuffer { buffer: buffer.id, word };
        self.add_pass(Pass::transfer(name, access, word.to_le_bytes().to_vec(), work));
    }

    /// Says that passes fill the buffer element by element, and that nobody cares for what it holds before.
    pub(crate) fn start_undefined<T>(&mut self, buffer: BufferRef<T>) {
        let resource = &mut self.resources[buffer.id];
        if resource.content[0].0 == NOTHING {
            resource.content[0].0 = hash_of(&("undefined", &resource.name));
        }
    }

    /// Notes a piece or pass that the scene does not need, and why.
    pub(crate) fn skip(&mut self, name: &str, reason: &str) {
        self.passes.push(Pass::skipped(name, reason));
    }

    /// Asks that the image be made.
    pub(crate) fn want(&mut self, image: ImageRef) {
        let content = &self.resources[image.id].content;
        let places = image.part().places();
        self.wanted.extend(places.map(|place| Version { place: (image.id, place), key: content[place as usize].0 }));
    }

    /// Asks that the buffer be made.
    pub(crate) fn want_buffer<T>(&mut self, buffer: BufferRef<T>) {
        self.wanted.push(Version { place: (buffer.id, 0), key: self.resources[buffer.id].content[0].0 });
    }

    /// Says that a buffer which this frame leaves for a later one will be copied to the host then: memory that lacks the use would be
    /// replaced, and what it holds lost.
    pub(crate) fn keep_for_read_back<T>(&mut self, buffer: BufferRef<T>) {
        self.resources[buffer.id].buffer_usage |= vk::BufferUsageFlags::TRANSFER_SRC;
    }

    /// Says that a buffer which this frame leaves for a later one will be used in other ways by that one's passes, as
    /// [`Graph::keep_for_read_back`] does for copies.
    pub(crate) fn keep_for_passes<T>(&mut self, buffer: BufferRef<T>) {
        self.resources[buffer.id].buffer_usage |= vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
    }

    /// Asks that the image be made and the first of its mip levels copied to the host, its layers after each other; `image.mip(n)` copies level n,
    /// `image.layer(n)` layer n. Returns its number among the read-backs.
    pub(crate) fn read_back(&mut self, image: ImageRef) -> ReadBack {
        let image = image.mip(image.mips.0);
        self.want(image);
        self.resources[image.id].image_usage |= vk::ImageUsageFlags::TRANSFER_SRC;
        self.read_backs.push((image.id, Some(image.part())));
        ReadBack(self.read_backs.len() - 1)
    }

    /// Asks that the buffer be made and copied to the host.
    pub(crate) fn read_back_buffer<T>(&mut self, buffer: BufferRef<T>) -> ReadBack {
        self.want_buffer(buffer);
        self.resources[buffer.id].buffer_usage |= vk::BufferUsageFlags::TRANSFER_SRC;
        self.read_backs.push((buffer.id, None));
        ReadBack(self.read_backs.len() - 1)
    }

    /// Derives the usage flags, contents and needs of a pass from its accesses, and adds it.
    pub(super) fn add_pass(&mut self, mut pass: Pass) {
        self.note_mistakes_of(&pass);
        let mut hasher = DefaultHasher::new();
        pass.hash_work(&mut hasher);
        let accesses: Vec<Access> = pass.accesses().cloned().collect();
        for access in &accesses {
            self.hash_access(access, &mut hasher);
            for (place, reads, _) in places(access) {
                let (key, dependence) = self.resources[place.0].content[place.1 as usize];
                if reads {
                    self.note_read_of_nothing(&pass, place, key);
                    key.hash(&mut hasher);
                    // The same work on an image or buffer of another size gives another result.
                    match &self.resources[place.0].body {
                        Body::Image(info) => info.hash(&mut hasher),
                        Body::Buffer { bytes } => bytes.hash(&mut hasher),
                        Body::Upload(_) | Body::ExternalBuffer(_) | Body::ExternalImage(_) => {}
                    }
                    pass.needs.reads.push(Version { place, key });
                    pass.dependence = pass.dependence | dependence;
                }
            }
        }
        for access in &accesses {
            self.note_usage(access, &pass.piece);
            for (place, _, writes) in places(access) {
                if writes {
                    let mut hasher = hasher.clone();
                    (&self.resources[place.0].name, place.1).hash(&mut hasher);
                    let made = hasher.finish().max(NOTHING + 1);
                    let key = pass.named.iter().find(|(id, _)| *id == place.0).map_or(made, |(_, key)| *key);
                    pass.needs.writes.push(Version { place, key });
                    self.resources[place.0].content[place.1 as usize] = (key, pass.dependence);
                }
            }
        }
        self.passes.push(pass);
        self.tell_watcher(&accesses);
    }

    /// By the resource's name: its number is another one in a frame that asks for more.
    fn hash_access(&self, access: &Access, hasher: &mut impl Hasher) {
        match access {
            Access::Image { image, part, usage } => (&self.resources[*image].name, part, usage).hash(hasher),
            Access::Buffer { buffer, usage } => (&self.resources[*buffer].name, usage).hash(hasher),
        }
    }

    fn note_usage(&mut self, access: &Access, piece: &str) {
        if self.proof.is_some() {
            let (Access::Image { image: id, .. } | Access::Buffer { buffer: id, .. }) = access;
            let resource = &mut self.resources[*id];
            resource.buffer_usage |= vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
            resource.image_usage |= vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        }
        match access {
            Access::Image { image, usage, .. } => {
                let resource = &mut self.resources[*image];
                resource.image_usage |= match usage {
                    ImageUse::Sampled(_) => vk::ImageUsageFlags::SAMPLED,
                    ImageUse::StorageRead
                    | ImageUse::StorageWrite
                    | ImageUse::StorageStart
                    | ImageUse::StorageModify => vk::ImageUsageFlags::STORAGE,
                    ImageUse::Color { .. } => vk::ImageUsageFlags::COLOR_ATTACHMENT,
                    ImageUse::Depth { .. } | ImageUse::DepthTest => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
                    ImageUse::Clear => vk::ImageUsageFlags::TRANSFER_DST,
                };
                resource.piece.get_or_insert_with(|| piece.to_owned());
            }
            Access::Buffer { buffer, usage } => {
                let resource = &mut self.resources[*buffer];
                resource.buffer_usage |= match usage {
                    BufferUse::Uniform => vk::BufferUsageFlags::UNIFORM_BUFFER,
                    BufferUse::Read | BufferUse::Write | BufferUse::Start | BufferUse::Modify | BufferUse::Absent => {
                        vk::BufferUsageFlags::STORAGE_BUFFER
                    }
                    BufferUse::Texels(_) => vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER,
                    BufferUse::Indirect => vk::BufferUsageFlags::INDIRECT_BUFFER,
                    BufferUse::Clear => vk::BufferUsageFlags::TRANSFER_DST,
                };
                resource.piece.get_or_insert_with(|| piece.to_owned());
            }
        }
    }
}

/// The places that an access touches, and whether it reads and writes what they hold.
pub(super) fn places(access: &Access) -> Vec<(Place, bool, bool)> {
    match access {
        Access::Image { image, part, usage } => {
            let (reads, writes) = match usage {
                ImageUse::Sampled(_) | ImageUse::StorageRead | ImageUse::DepthTest => (true, false),
                ImageUse::StorageWrite | ImageUse::StorageStart | ImageUse::Clear => (false, true),
                ImageUse::StorageModify => (true, true),
                ImageUse::Color { keep } | ImageUse::Depth { keep } => (*keep, true),
            };
            part.places().map(|place| ((*image, place), reads, writes)).collect()
        }
        Access::Buffer { buffer, usage } => {
            let (reads, writes) = match usage {
                BufferUse::Uniform
                | BufferUse::Read
                | BufferUse::Absent
                | BufferUse::Texels(_)
                | BufferUse::Indirect => (true, false),
                BufferUse::Write | BufferUse::Start | BufferUse::Clear => (false, true),
                BufferUse::Modify => (true, true),
            };
            vec![((*buffer, 0), reads, writes)]
        }
    }
}
