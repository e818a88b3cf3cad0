//! The nearest surfaces of each texel by depth peeling (Krüger et al. 2006).

use super::list_views::ListView;
use super::lists::{ListInputs, SceneLists};
use crate::graph::Graph;

pub(super) fn peel(
    _graph: &mut Graph<'_>,
    _inputs: &ListInputs<'_>,
    _lists: &SceneLists,
    _views: &[ListView],
    _count: u32,
) {
}
