//! Timestamps and pipeline statistics of one frame.

#![allow(unsafe_code, reason = "query pools")]

use std::sync::Arc;

use ash::vk;

use super::device::Device;
use super::error::{Called, VulkanError};

/// What the fixed-function stages of a raster pass did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Statistics {
    pub(crate) vertices: u64,
    pub(crate) triangles: u64,
    pub(crate) fragments: u64,
}

/// A pool of timestamps and one of statistics, both reset by the host between frames.
pub(crate) struct Queries {
    device: Arc<Device>,
    pub(crate) timestamps: vk::QueryPool,
    pub(crate) statistics: Option<vk::QueryPool>,
    capacity: u32,
}

impl Queries {
    pub(crate) fn new(device: &Arc<Device>, capacity: u32) -> Result<Queries, VulkanError> {
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(capacity);
        // SAFETY: the device is alive.
        let timestamps =
            unsafe { device.raw.create_query_pool(&info, None) }.called("vkCreateQueryPool for timestamps")?;
        let mut queries = Queries { device: device.clone(), timestamps, statistics: None, capacity };
        if device.survey.features.core.pipeline_statistics_query == vk::TRUE {
            use vk::QueryPipelineStatisticFlags as Flags;
            let flags =
                Flags::VERTEX_SHADER_INVOCATIONS | Flags::CLIPPING_INVOCATIONS | Flags::FRAGMENT_SHADER_INVOCATIONS;
            let info = info.query_type(vk::QueryType::PIPELINE_STATISTICS).pipeline_statistics(flags);
            // SAFETY: the device is alive and has the feature.
            let pool =
                unsafe { device.raw.create_query_pool(&info, None) }.called("vkCreateQueryPool for statistics")?;
            queries.statistics = Some(pool);
        }
        Ok(queries)
    }

    pub(crate) fn reset(&mut self) {
        // SAFETY: the last frame that used the pools has finished (module invariant).
        unsafe {
            self.device.raw.reset_query_pool(self.timestamps, 0, self.capacity);
            if let Some(pool) = self.statistics {
                self.device.raw.reset_query_pool(pool, 0, self.capacity);
            }
        }
    }

    /// The first `count` timestamps in ticks; `None` for one that was not written.
    pub(crate) fn read_timestamps(&self, count: u32) -> Result<Vec<Option<u64>>, VulkanError> {
        let mut data = vec![[0_u64; 2]; count as usize];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        if count > 0 {
            // SAFETY: the pool is alive; `data` has two words a query, as the flags ask.
            let result = unsafe { self.device.raw.get_query_pool_results(self.timestamps, 0, &mut data, flags) };
            if result != Err(vk::Result::NOT_READY) {
                result.called("vkGetQueryPoolResults")?;
            }
        }
        Ok(data.into_iter().map(|[ticks, available]| (available != 0).then_some(ticks)).collect())
    }

    /// Milliseconds between two timestamps, which wrap at the queue's number of valid bits.
    pub(crate) fn milliseconds(&self, start: u64, end: u64) -> f64 {
        let bits = self.device.survey.timestamp_bits;
        let mask = if bits >= 64 { u64::MAX } else { (1 << bits) - 1 };
        (end.wrapping_sub(start) & mask) as f64 * f64::from(self.device.limits().timestamp_period) * 1e-6
    }

    /// The statistics of query `index`, if the device counts them and the query was made.
    pub(crate) fn read_statistics(&self, index: u32) -> Option<Statistics> {
        let mut data = [[0_u64; 4]];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        // SAFETY: the pool is alive; three statistics and the availability fill one element.
        unsafe { self.device.raw.get_query_pool_results(self.statistics?, index, &mut data, flags) }.ok()?;
        let [[vertices, triangles, fragments, available]] = data;
        (available != 0).then_some(Statistics { vertices, triangles, fragments })
    }
}

impl Drop for Queries {
    fn drop(&mut self) {
        // SAFETY: the last frame that used the pools has finished (module invariant).
        unsafe {
            self.device.raw.destroy_query_pool(self.timestamps, None);
            if let Some(pool) = self.statistics {
                self.device.raw.destroy_query_pool(pool, None);
            }
        }
    }
}
