//! References as tables for a terminal: one with its noise, and what the cache holds.

use super::text::table;
use crate::bench::units;
use crate::reference::{Entry, IMAGE, Reference};
use crate::renderer::Slot;

/// A row for every slot and the image, and below what the samples took.
pub fn reference_text(reference: &Reference) -> String {
    let mut table = table(&["slot", "mean", "noise rmse", "noise"], &[1, 2, 3]);
    for part in Slot::ALL.into_iter().map(Slot::name).chain([IMAGE]) {
        let noise = reference.noise.get(part).copied().unwrap_or_default();
        table.add_row([part.to_owned(), units::error(noise.mean), units::error(noise.rmse), share(noise.rrmse)]);
    }
    let Reference { spp, seconds, samples_per_second, rays_per_second, devices, .. } = reference;
    let mut effort = format!("{spp} samples per pixel in {seconds:.1} s");
    for (rate, what) in [(*samples_per_second, "samples/s"), (*rays_per_second, "rays/s")] {
        if rate > 0.0 {
            effort += &format!(", {} {what}", units::count(rate as u64));
        }
    }
    format!("{}\n{effort} on {}\n", table.trim_fmt(), devices.join("; "))
}

/// A row for every reference in the cache; those that cannot be used say why.
pub fn cache_text(entries: &[Entry]) -> String {
    let header = ["key", "scene", "camera", "size", "transport", "bounces", "spp", "noise", "bytes"];
    let mut table = table(&header, &[6, 7, 8]);
    let mut unusable = String::new();
    for Entry { path, bytes, content } in entries {
        match content {
            Ok(content) => {
                let key = content.key.prefix().to_owned();
                let words = [&content.scene, &content.camera, &content.size, &content.estimator, &content.bounces];
                let numbers = [content.spp.to_string(), share(content.noise), units::bytes(*bytes)];
                table.add_row([key].into_iter().chain(words.map(Clone::clone)).chain(numbers));
            }
            Err(reason) => unusable += &format!("{}: {reason}\n", path.display()),
        }
    }
    format!("{}\n{unusable}", table.trim_fmt())
}

/// A relative noise as a percentage with three digits that count.
fn share(noise: f64) -> String {
    format!("{} %", units::error(100.0 * noise))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::reference::{Noise, ReferenceKey};
    use crate::renderer::ColorImage;

    #[test]
    fn every_slot_and_the_image_have_a_row() {
        let noise = Noise { rmse: 0.0125, rrmse: 0.05, mean: 0.25 };
        let reference = Reference {
            key: ReferenceKey::parse(&"0".repeat(64)).expect("64 digits"),
            spp: 64,
            slots: BTreeMap::new(),
            image: ColorImage { size: [1, 1], pixels: vec![[0.25; 3]] },
            half_differences: BTreeMap::new(),
            noise: BTreeMap::from([("image".to_owned(), noise)]),
            seconds: 12.34,
            samples_per_second: 1_234_567.0,
            rays_per_second: 0.0,
            devices: vec!["one".to_owned(), "two".to_owned()],
        };
        let text = reference_text(&reference);
        let row = |name: &str| text.lines().find(|line| line.trim_start().starts_with(name)).expect("a row");
        assert_eq!(row("image").split_whitespace().collect::<Vec<_>>(), ["image", "0.250", "0.0125", "5.00", "%"]);
        assert_eq!(row("caustics").split_whitespace().collect::<Vec<_>>(), ["caustics", "0", "0", "0", "%"]);
        assert!(text.ends_with("64 samples per pixel in 12.3 s, 1.2 M samples/s on one; two\n"), "{text}");
    }
}
