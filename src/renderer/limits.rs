//! What methods need of a device: their programs as the build reads them, and the formats of their images. Checked when devices are listed and
//! when a renderer takes its settings, so that none fails halfway through a frame.

use ash::vk;

use super::methods::{Filler, all_methods};
use super::settings::Settings;
use super::technique::Technique;
use crate::frame::light_views::Views;
use crate::method::{Inputs, Preset};
use crate::shaders::PROGRAMS;
use crate::slot::Slot;
use crate::vulkan::limits::Offer;

/// Programs of every frame.
const FRAME: &[&str] = &["gbuffer/*", "compose/*", "tonemap/*", "check/*"];

const DEPTH: vk::FormatFeatureFlags = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
const BLEND: vk::FormatFeatureFlags = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;

/// Programs by their names, and what images of a format serve them for beyond what every device offers.
const IMAGES: &[(&str, vk::Format, vk::FormatFeatureFlags)] = &[
    ("gbuffer/*", vk::Format::D32_SFLOAT, DEPTH),
    ("hemicube/draw", vk::Format::D32_SFLOAT, DEPTH),
    ("light_views/*", vk::Format::D32_SFLOAT, DEPTH),
    ("photons/specular*", vk::Format::D32_SFLOAT, DEPTH),
    ("photon_lists/peel*", vk::Format::D32_SFLOAT, DEPTH),
    ("regions/mark", vk::Format::S8_UINT, DEPTH),
    ("vpl/gather_stencil", vk::Format::S8_UINT, DEPTH),
    ("vpl/gather_stencil", vk::Format::R32G32B32A32_SFLOAT, BLEND),
];

/// Whether a program is called so, or begins as the name does up to a star.
fn is_called(program: &str, name: &str) -> bool {
    name.strip_suffix('*').map_or(program == name, |start| program.starts_with(start))
}

/// What passes of these programs need and the device lacks, in words.
fn lacks(offer: &Offer, shaders: &[&str]) -> Vec<String> {
    let mut faults = Vec::new();
    for program in PROGRAMS.iter().filter(|program| shaders.iter().any(|shader| is_called(program.name, shader))) {
        let name = program.name;
        faults.extend(offer.lacks(program).into_iter().map(|what| format!("{name} needs {what}")));
        for (_, format, uses) in IMAGES.iter().filter(|(shader, ..)| is_called(name, shader)) {
            let absent = *uses & !offer.of_images(*format);
            faults.extend((!absent.is_empty()).then(|| format!("{name} needs images of {format:?} for {absent:?}")));
        }
    }
    faults
}

/// Programs that make what methods take of a frame.
fn of_inputs(inputs: Inputs) -> &'static [&'static str] {
    match (inputs.light_depth, inputs.light_flux) {
        (Views::None, Views::None) => &[],
        (_, Views::None) => &["light_views/depth*"],
        _ => &["light_views/*"],
    }
}

/// What fills a slot with these settings: its name, and the programs that it may run.
fn filler(settings: &Settings, slot: Slot, software: bool) -> Option<(&'static str, Vec<&'static str>)> {
    match settings.methods.filler(slot)? {
        Filler::Method(method) => {
            let mut shaders = method.programs(settings, software);
            shaders.extend(of_inputs((method.inputs)(settings)));
            Some((method.name, shaders))
        }
        Filler::Estimator(estimator) => Some((estimator.name, estimator.shaders.to_vec())),
    }
}

/// The first thing that a frame with these settings needs and the device lacks: a piece, and what it needs.
pub(super) fn first_lack(offer: &Offer, settings: &Settings, software: bool) -> Option<(&'static str, String)> {
    let fillers = Slot::ALL.into_iter().filter_map(|slot| filler(settings, slot, software));
    let mut all = std::iter::once(("the frame", FRAME.to_vec())).chain(fillers);
    all.find_map(|(name, shaders)| Some((name, lacks(offer, &shaders).into_iter().next()?)))
}

/// What each method lacks with its default options, in the order of the list of methods.
pub(super) fn lacks_by_method(offer: &Offer, software: bool) -> Vec<(String, String)> {
    let settings = Settings::new(Technique::Direct, Preset::Default);
    let mut found: Vec<(String, String)> =
        lacks(offer, FRAME).into_iter().map(|what| ("the frame".to_owned(), what)).collect();
    for (name, shaders) in all_methods(&settings, software, of_inputs) {
        found.extend(lacks(offer, &shaders).into_iter().map(|what| (name.to_owned(), what)));
    }
    found
}

/// Whether the settings' methods, or every frame, say that they may run a program.
#[cfg(test)]
pub(crate) fn is_program_of(settings: &Settings, program: &str, software: bool) -> bool {
    let fillers = Slot::ALL.into_iter().filter_map(|slot| filler(settings, slot, software));
    let shaders = fillers.flat_map(|(_, shaders)| shaders).chain(FRAME.iter().copied());
    shaders.into_iter().any(|shader| is_called(program, shader))
}

/// Uses of formats by a program that neither Vulkan's required format support nor the table knows of.
#[cfg(test)]
pub(crate) fn format_lacks(
    program: &str,
    images: &[(vk::Format, vk::FormatFeatureFlags)],
    texels: &[vk::Format],
) -> Vec<String> {
    use vk::{Format, FormatFeatureFlags as Feature};
    let texel_formats = [
        Format::R8G8B8A8_UNORM,
        Format::R16G16B16A16_SFLOAT,
        Format::R32_UINT,
        Format::R32_SFLOAT,
        Format::R32G32_UINT,
        Format::R32G32_SFLOAT,
        Format::R32G32B32A32_UINT,
        Format::R32G32B32A32_SFLOAT,
    ];
    let promised = |format: Format| match format {
        Format::D32_SFLOAT => Feature::SAMPLED_IMAGE,
        format if texel_formats.contains(&format) => {
            Feature::SAMPLED_IMAGE | Feature::STORAGE_IMAGE | Feature::COLOR_ATTACHMENT
        }
        _ => Feature::empty(),
    };
    let known = |format: Format| {
        let of = IMAGES.iter().filter(|(shader, listed, _)| is_called(program, shader) && *listed == format);
        of.fold(promised(format), |known, (_, _, uses)| known | *uses)
    };
    let images = images.iter().filter(|(format, uses)| !known(*format).contains(*uses));
    let texels = texels.iter().filter(|format| !texel_formats.contains(format));
    let of_images = images.map(|(format, uses)| format!("{program} has images of {format:?} for {uses:?}"));
    of_images.chain(texels.map(|format| format!("{program} reads texels of {format:?}"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::limits::tests::generous;

    fn of(technique: Technique, keys: &[(&str, &str)]) -> Settings {
        let mut settings = Settings::new(technique, Preset::Default);
        keys.iter().for_each(|(key, value)| settings.set(key, value).expect("a setting"));
        settings
    }

    #[test]
    fn a_device_that_offers_all_lacks_nothing() {
        assert_eq!(lacks_by_method(&generous(), true), []);
        assert!(Technique::ALL.iter().all(|technique| first_lack(&generous(), &of(*technique, &[]), false).is_none()));
    }

    #[test]
    fn what_a_device_lacks_is_said_of_the_methods_that_need_it() {
        let mut poor = generous();
        poor.of_stage.storage_buffers = 4;
        let methods = |offer: &Offer| {
            let mut names: Vec<String> = lacks_by_method(offer, true).into_iter().map(|(name, _)| name).collect();
            names.dedup();
            names
        };
        assert_eq!(methods(&poor), ["particles", "photons", "points", "path", "sppm"]);
        let (piece, what) = first_lack(&poor, &of(Technique::Hybrid, &[]), true).expect("it lacks buffers");
        assert_eq!(piece, "photons");
        assert!(what.contains("storage buffers in a stage (4 are offered)"), "{what}");
        assert_eq!(first_lack(&poor, &of(Technique::Rsm, &[]), true), None);

        let mut without_stencil = generous();
        without_stencil.formats.insert(vk::Format::S8_UINT, vk::FormatFeatureFlags::empty());
        // By lists on the software driver, by stencil elsewhere: the settings and the device decide.
        assert_eq!(methods(&without_stencil), Vec::<String>::new());
        let vpl = |shading| of(Technique::Hybrid, &[("vpl.shading", shading)]);
        assert_eq!(first_lack(&without_stencil, &vpl("compute"), false), None);
        let (piece, what) = first_lack(&without_stencil, &vpl("auto"), false).expect("it lacks a stencil");
        assert_eq!(
            (piece, what.as_str()),
            ("vpl", "regions/mark needs images of S8_UINT for DEPTH_STENCIL_ATTACHMENT")
        );

        let mut without_depth = generous();
        without_depth.formats.insert(vk::Format::D32_SFLOAT, vk::FormatFeatureFlags::empty());
        assert_eq!(
            first_lack(&without_depth, &of(Technique::Direct, &[]), true).map(|(piece, _)| piece),
            Some("the frame")
        );
    }

    #[test]
    fn every_name_of_the_tables_is_some_programs() {
        let settings = of(Technique::Hybrid, &[]);
        let of_methods = all_methods(&settings, true, of_inputs).into_iter().flat_map(|(_, shaders)| shaders);
        let names = of_methods.chain(FRAME.iter().copied()).chain(IMAGES.iter().map(|(shader, ..)| *shader));
        for name in names {
            assert!(PROGRAMS.iter().any(|program| is_called(program.name, name)), "{name} is no program");
        }
    }
}
