//! Renderers: settings, and what they keep on the device between frames.

use std::ffi::c_char;
use std::sync::Arc;

use super::border::{Guarded, call, create, handles, take};
use super::context::{ContextHandle, Shared, shared};
use super::descriptor::{descriptors, read_optional, write};
use super::options::{OptionDescriptor, OptionTexts};
use super::status::{Fault, IRRADIA_ERROR_SETTINGS, Status};
use super::text::{self, optional_text, text};
use crate::renderer::{Cancel, Preset, Renderer, Settings, SettingsError, Technique};
use crate::scene::Revisions;
use crate::slot::Slot;

/// How a renderer begins.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct RendererDescriptor {
    /// sizeof(irradia_renderer_descriptor).
    pub size: usize,
    /// A technique's name, such as "hybrid" or "path"; null: "hybrid". A name that does not exist is answered by the list.
    pub technique: *const c_char,
    /// "default", "draft", "high" or "paper"; null: "default".
    pub preset: *const c_char,
}

descriptors! {
    RendererDescriptor = "renderer descriptor", size_of::<RendererDescriptor>();
}

/// A renderer and what it stands on.
pub struct RendererState {
    // Before the context, whose device it uses.
    pub(super) renderer: Renderer,
    pub(super) shared: Arc<Shared>,
    pub(super) options: Vec<OptionTexts>,
    /// What the last frame showed, with these settings.
    pub(super) shown: Option<Shown>,
}

/// A scene as it was, and what was asked of it. What is made of scenes is made on all threads; another frame of the same needs none but the caller's.
#[derive(PartialEq)]
pub(super) struct Shown {
    pub(super) scene: u64,
    pub(super) revisions: Revisions,
    /// Slots, of the host's memory and of targets.
    pub(super) asked: [u32; 2],
}

/// Settings, and what frames leave on the device for the next one. One call at a time may use it, but for irradia_renderer_cancel().
pub struct RendererHandle {
    guarded: Guarded<RendererState>,
    cancel: Cancel,
}

handles! {
    RendererHandle(RendererState) = "renderer";
}

/// Makes a renderer on a context's device. The context may be destroyed before it.
///
/// `descriptor`: null for a descriptor of zeros.
/// `renderer`: receives it; irradia_renderer_destroy() ends it.
///
/// Errors: IRRADIA_ERROR_SETTINGS for names that do not exist, IRRADIA_ERROR_DEVICE if the device lacks what a method needs, IRRADIA_ERROR_MEMORY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_create(
    context: *const ContextHandle,
    descriptor: *const RendererDescriptor,
    renderer: *mut *mut RendererHandle,
) -> Status {
    let make = || {
        // SAFETY: the host's pointers are what the header asks for.
        let (shared, given) = unsafe { (shared(context)?, read_optional(descriptor)?) };
        let names = given.map_or([std::ptr::null(); 2], |given| [given.technique, given.preset]);
        // SAFETY: as above.
        let names = unsafe { [optional_text(names[0], "the technique")?, optional_text(names[1], "the preset")?] };
        let technique = names[0].map_or(Ok(Technique::Hybrid), Technique::from_name).map_err(SettingsError::from)?;
        let preset = names[1].map_or(Ok(Preset::Default), Preset::from_name).map_err(SettingsError::from)?;
        let settings = Settings::new(technique, preset);
        let options = OptionTexts::all(&settings);
        let renderer = shared.run(|| Renderer::new(&shared.context, settings))?;
        let cancel = renderer.cancel();
        let state = RendererState { renderer, shared, options, shown: None };
        Ok(RendererHandle { guarded: Guarded::new(state), cancel })
    };
    // SAFETY: as above.
    unsafe { create(renderer, |_| make()) }
}

/// Ends a renderer and frees what it holds on the device. Null is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_destroy(renderer: *mut RendererHandle) {
    // SAFETY: the host gives back what it was given.
    unsafe { take(renderer) };
}

/// Changes the settings by `change`; the old ones stand if that fails.
///
/// # Safety
/// `renderer` is null, which is a fault, or alive.
unsafe fn change(
    renderer: *mut RendererHandle,
    change: impl FnOnce(&mut Settings) -> Result<(), Fault> + Send,
) -> Status {
    call(|border| {
        // SAFETY: the caller's.
        let RendererState { renderer, shared, shown, .. } = unsafe { border.enter(renderer) }?;
        *shown = None;
        let mut settings = renderer.settings().clone();
        change(&mut settings)?;
        Ok(shared.run(|| renderer.set_settings(settings))?)
    })
}

/// Sets one setting, as `--set key=value` on the command line does.
///
/// `key`: "piece.name", such as "vpl.count". `value`: as text, such as "2000"; "null" for no limit.
///
/// Errors: IRRADIA_ERROR_SETTINGS; the sentence says what the setting takes, or which there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_set(
    renderer: *mut RendererHandle,
    key: *const c_char,
    value: *const c_char,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    let texts = unsafe { (text(key, "the setting's key"), text(value, "the setting's value")) };
    // SAFETY: as above.
    unsafe { change(renderer, |settings| Ok(settings.set(texts.0?, texts.1?)?)) }
}

/// Chooses the method of a slot, as `--diffuse vpl` on the command line does.
///
/// `slot`: "direct", "diffuse", "caustics" or "specular". `method`: a name, or "none"; one that does not exist is answered by the list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_set_method(
    renderer: *mut RendererHandle,
    slot: *const c_char,
    method: *const c_char,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    let texts = unsafe { (text(slot, "the slot"), text(method, "the method")) };
    let choose = |settings: &mut Settings| {
        let name = texts.0?;
        let slot = Slot::from_name(name).ok_or_else(|| Fault {
            status: IRRADIA_ERROR_SETTINGS,
            sentence: format!("there is no slot {name:?}; slots: direct, diffuse, caustics, specular"),
        })?;
        settings.methods.set(slot, texts.1?).map_err(SettingsError::from)?;
        Ok(())
    };
    // SAFETY: as above.
    unsafe { change(renderer, choose) }
}

/// Copies all settings as JSON, as `--json` of the command line has them.
///
/// `buffer`: room for `capacity` bytes; null: only the length is asked for. `needed`: receives the text's length, its final zero included; may be null beside a
/// buffer.
///
/// Errors: IRRADIA_ERROR_ARGUMENT if the text does not fit; nothing is written then but `needed`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_settings(
    renderer: *const RendererHandle,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(renderer) }?;
        let json = serde_json::to_string(state.renderer.settings())
            .map_err(|error| Fault { status: IRRADIA_ERROR_SETTINGS, sentence: error.to_string() })?;
        // SAFETY: as above.
        unsafe { text::copy(&json, buffer, capacity, needed) }
    })
}

/// Replaces all settings by what irradia_renderer_settings() wrote, or a part of it with a technique: what is not given is that of the technique and the preset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_set_settings(renderer: *mut RendererHandle, json: *const c_char) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    let json = unsafe { text(json, "the settings") };
    let replace = |settings: &mut Settings| {
        let fault = |sentence: String| Fault { status: IRRADIA_ERROR_SETTINGS, sentence };
        let json = serde_json::from_str(json?).map_err(|error| fault(format!("the settings are no JSON: {error}")))?;
        *settings = Settings::from_json(&json)?;
        Ok(())
    };
    // SAFETY: as above.
    unsafe { change(renderer, replace) }
}

/// One of the settings, by its place in the list: `index` from 0 until IRRADIA_ERROR_ARGUMENT says that there is no more.
///
/// `option`: a descriptor whose size is set; it is filled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_option(
    renderer: *const RendererHandle,
    index: usize,
    option: *mut OptionDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(renderer) }?;
        let options = &state.options;
        let Some(texts) = options.get(index) else {
            return Err(Fault::argument(format!("there are {} settings, none of index {index}", options.len())));
        };
        // SAFETY: as above.
        unsafe { write(option, &texts.descriptor()) }
    })
}

/// Forgets what methods keep over frames, as before the first frame.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_reset_history(renderer: *mut RendererHandle) -> Status {
    call(|border| {
        // SAFETY: the host's pointer is what the header asks for.
        let RendererState { renderer, shared, .. } = unsafe { border.enter(renderer) }?;
        shared.workers.listen(|| renderer.reset_history());
        Ok(())
    })
}

/// Forgets all results, so that the next frame makes everything anew; for timings of whole frames.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_invalidate(renderer: *mut RendererHandle) -> Status {
    call(|border| {
        // SAFETY: the host's pointer is what the header asks for.
        let RendererState { renderer, shared, .. } = unsafe { border.enter(renderer) }?;
        shared.workers.listen(|| renderer.invalidate());
        Ok(())
    })
}

/// Stops the frame that another thread is having made, at the end of what the device is doing: between the samples of `path` and `sppm` and between the attempts of
/// other frames, not within one. That call returns IRRADIA_ERROR_CANCELLED. If none is in progress, the next one is stopped.
///
/// From any thread, while the renderer is alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_renderer_cancel(renderer: *const RendererHandle) -> Status {
    call(|_| {
        // SAFETY: the host's pointer is what the header asks for.
        let renderer = unsafe { renderer.as_ref() };
        let renderer = renderer.ok_or_else(|| Fault::argument("the renderer is a null pointer"))?;
        renderer.cancel.ask();
        Ok(())
    })
}
