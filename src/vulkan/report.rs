//! What a physical device offers, and whether irradia can use it.

#![allow(unsafe_code, reason = "queries of physical devices")]

use ash::vk;
use serde::Serialize;

use super::error::VulkanError;
use super::features::Features;
use super::instance::{Instance, Validation, version_text};
use super::limits::{FORMATS, Offer};
use super::traits::DeviceTraits;

/// One device as `irradia devices` lists it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct DeviceReport {
    /// Its number for `--device`.
    pub index: usize,
    /// Its name for `--device`, or a part of it.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    #[serde(rename = "type")]
    pub kind: String,
    /// Driver name and version.
    pub driver: String,
    /// The Vulkan version that it implements.
    pub api: String,
    /// The limits that matter here, as name and value.
    pub limits: Vec<(String, String)>,
    /// Methods with what they need and the device lacks; empty if all can run.
    pub lacks: Vec<(String, String)>,
    /// Why it cannot be used; `None` if it can.
    pub unfit: Option<String>,
    /// Whether the default choice falls on it.
    pub default: bool,
}

/// What a physical device says of itself.
pub(crate) struct Survey {
    pub(crate) report: DeviceReport,
    pub(crate) properties: vk::PhysicalDeviceProperties,
    pub(crate) features: Features,
    pub(crate) queue_family: u32,
    pub(crate) timestamp_bits: u32,
    pub(crate) traits: DeviceTraits,
    pub(crate) offer: Offer,
}

impl Survey {
    pub(crate) fn of(instance: &Instance, index: usize, device: vk::PhysicalDevice) -> Survey {
        let raw = &instance.raw;
        let mut vulkan12 = vk::PhysicalDeviceVulkan12Properties::default();
        let mut vulkan11 = vk::PhysicalDeviceVulkan11Properties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut vulkan12).push_next(&mut vulkan11);
        // SAFETY: the device belongs to this living instance; the chained structures live on.
        unsafe { raw.get_physical_device_properties2(device, &mut properties) };
        let properties = properties.properties;
        let features = Features::offered(instance, device);
        // SAFETY: as above.
        let families = unsafe { raw.get_physical_device_queue_family_properties(device) };
        // SAFETY: as above.
        let memory = unsafe { raw.get_physical_device_memory_properties(device) };
        let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let family = families.iter().position(|family| family.queue_flags.contains(wanted));
        let limits = &properties.limits;
        let traits = DeviceTraits::of(&properties, vulkan12.driver_id, vulkan11.subgroup_size);
        let features_of = |format: vk::Format| {
            // SAFETY: as above.
            let found = unsafe { raw.get_physical_device_format_properties(device, format) };
            let mut images = found.optimal_tiling_features;
            if !traits.draws {
                images &= !vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
            }
            (format, images)
        };
        let offer = Offer::new(limits, &vulkan11, &features.core, FORMATS.iter().copied().map(features_of).collect());
        let device_bytes: u64 = memory
            .memory_heaps_as_slice()
            .iter()
            .filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL))
            .map(|heap| heap.size)
            .sum();
        let text =
            |name: Result<&std::ffi::CStr, _>| name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let report = DeviceReport {
            index,
            name: text(properties.device_name_as_c_str()),
            kind: kind_name(properties.device_type).to_owned(),
            driver: format!("{} {}", text(vulkan12.driver_name_as_c_str()), text(vulkan12.driver_info_as_c_str()))
                .trim()
                .to_owned(),
            api: version_text(properties.api_version),
            limits: vec![
                ("device memory, MiB".to_owned(), (device_bytes >> 20).to_string()),
                ("image side, texels".to_owned(), limits.max_image_dimension2_d.to_string()),
                ("texel buffer, elements".to_owned(), limits.max_texel_buffer_elements.to_string()),
                ("storage buffer, MiB".to_owned(), (limits.max_storage_buffer_range >> 20).to_string()),
                ("work group, invocations".to_owned(), limits.max_compute_work_group_invocations.to_string()),
                ("shared memory, KiB".to_owned(), (limits.max_compute_shared_memory_size >> 10).to_string()),
                ("subgroup size".to_owned(), vulkan11.subgroup_size.to_string()),
                ("timestamp period, ns".to_owned(), limits.timestamp_period.to_string()),
            ],
            lacks: Vec::new(),
            unfit: unfit(&features, &properties, family.map(|family| families[family].timestamp_valid_bits)),
            default: false,
        };
        let timestamp_bits = family.map_or(0, |family| families[family].timestamp_valid_bits);
        Survey {
            report,
            properties,
            features,
            queue_family: family.and_then(|family| u32::try_from(family).ok()).unwrap_or(0),
            timestamp_bits,
            traits,
            offer,
        }
    }
}

fn unfit(
    features: &Features,
    properties: &vk::PhysicalDeviceProperties,
    timestamp_bits: Option<u32>,
) -> Option<String> {
    if properties.api_version < vk::API_VERSION_1_3 {
        return Some(format!("it implements Vulkan {}, irradia needs 1.3", version_text(properties.api_version)));
    }
    if let Some((name, needed_by)) = features.missing() {
        return Some(format!("it lacks the feature {name}, which {needed_by} needs"));
    }
    match timestamp_bits {
        None => Some("it has no queue for both graphics and compute".to_owned()),
        Some(0) => Some("its queue has no timestamps, which every timing needs".to_owned()),
        Some(_) => None,
    }
}

fn kind_name(kind: vk::PhysicalDeviceType) -> &'static str {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
        vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
        vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
        vk::PhysicalDeviceType::CPU => "cpu",
        _ => "other",
    }
}

/// All devices of the instance, the default one marked: the first fit discrete GPU, else integrated, else any.
pub(crate) fn survey(instance: &Instance) -> Result<Vec<(vk::PhysicalDevice, Survey)>, VulkanError> {
    let devices = instance.physical_devices()?;
    let mut surveys: Vec<_> =
        devices.into_iter().enumerate().map(|(index, device)| (device, Survey::of(instance, index, device))).collect();
    let rank = |survey: &Survey| {
        ["discrete", "integrated", "virtual", "cpu", "other"].iter().position(|kind| *kind == survey.report.kind)
    };
    let best = surveys
        .iter_mut()
        .filter(|(_, survey)| survey.report.unfit.is_none())
        .min_by_key(|(_, survey)| (rank(survey), survey.report.index));
    if let Some((_, survey)) = best {
        survey.report.default = true;
    }
    Ok(surveys)
}

/// The devices of this machine, usable or not.
///
/// # Errors
/// Without a loader, or when the loader fails.
pub(crate) fn devices() -> Result<Vec<Survey>, VulkanError> {
    let instance = match Instance::new(Validation::Off) {
        Err(VulkanError::NoDevice) => return Ok(Vec::new()),
        instance => instance?,
    };
    Ok(survey(&instance)?.into_iter().map(|(_, survey)| survey).collect())
}
