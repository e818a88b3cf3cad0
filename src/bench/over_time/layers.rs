//! What is stacked in a plot of times: passes put together, in the order in which they run.

use crate::bench::report::Run;
use crate::graph::joined;

/// The most layers with a name of their own.
const MOST: usize = 6;

/// Some passes together, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layer {
    pub(super) name: String,
    pub(super) ms: Vec<f64>,
}

/// The layers of a run, the first to run first: pieces, and the levels of pieces that have any. The largest have a name of their own; what the others come to is last.
pub(super) fn layers(run: &Run) -> Vec<Layer> {
    let Some(over_time) = &run.over_time else { return Vec::new() };
    let mut layers: Vec<Layer> = Vec::new();
    for pass in run.passes.iter().filter(|pass| pass.skipped.is_none()) {
        let name = match pass.pass.split_once('/') {
            Some((level, _)) => joined(&pass.piece, level),
            None => pass.piece.clone(),
        };
        let full_name = pass.full_name();
        let own = over_time.frames.iter().map(|frame| frame.passes_ms.get(&full_name).copied().unwrap_or_default());
        match layers.iter_mut().find(|layer| layer.name == name) {
            Some(layer) => layer.ms.iter_mut().zip(own).for_each(|(sum, ms)| *sum += ms),
            None => layers.push(Layer { name, ms: own.collect() }),
        }
    }
    let sum = |layer: &Layer| layer.ms.iter().sum::<f64>();
    let mut sums: Vec<f64> = layers.iter().map(sum).collect();
    sums.sort_by(|a, b| b.total_cmp(a));
    let least = if layers.len() > MOST + 1 { sums[MOST - 1] } else { 0.0 };
    let (mut named, others): (Vec<Layer>, Vec<Layer>) = layers.into_iter().partition(|layer| sum(layer) >= least);
    if !others.is_empty() {
        let frames = over_time.frames.len();
        let ms = (0..frames).map(|frame| others.iter().map(|layer| layer.ms[frame]).sum()).collect();
        named.push(Layer { name: format!("{} others", others.len()), ms });
    }
    named
}

#[cfg(test)]
mod tests {
    use super::super::record::tests::example;
    use super::*;

    #[test]
    fn levels_stand_beside_pieces_and_the_small_ones_together() {
        let run = example(4);
        let names: Vec<String> = layers(&run).into_iter().map(|layer| layer.name).collect();
        let expected =
            ["gbuffer", "diffuse/a", "diffuse/a/one", "diffuse/a/two", "diffuse/a/three", "diffuse/a/four", "2 others"];
        assert_eq!(names, expected);
        for (frame, record) in run.over_time.as_ref().expect("played").frames.iter().enumerate() {
            let sum: f64 = layers(&run).iter().map(|layer| layer.ms[frame]).sum();
            assert!((sum + record.unexplained_ms - record.serialised_ms).abs() < 1e-9, "{frame}");
        }
    }
}
