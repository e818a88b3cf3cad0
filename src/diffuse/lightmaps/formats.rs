//! Formats in which passes read buffers of texels.

use ash::vk;

pub(super) const WORD: vk::Format = vk::Format::R32_UINT;
pub(super) const WORDS2: vk::Format = vk::Format::R32G32_UINT;
pub(super) const WORDS4: vk::Format = vk::Format::R32G32B32A32_UINT;
pub(super) const FLOATS4: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
