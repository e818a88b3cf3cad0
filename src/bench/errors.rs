//! How far a contender's images are from references: slot by slot against the light paths that its methods account for, and
//! against full light transport.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use super::report::{ImageErrors, Reference as Compared, Run};
use super::run::{Finished, SlotImages, Subject};
use crate::metrics::{self, MetricsError};
use crate::reference::{
    Cache, CausticPaths, Estimator, IMAGE, Job, PixelFilter, Progress, Reference, ReferenceRequest, estimator_name,
};
use crate::renderer::{ColorImage, Context, Settings, Slot};
use crate::slot::LightPaths;

/// The name of the sum of the slots that a technique fills.
pub(crate) const COVERED: &str = "covered";

/// Why a run has no errors.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorsUnknown {
    /// There is no reference, for any contender.
    #[error("there is no reference: {0}")]
    Reference(String),
    /// The contender's images cannot be compared.
    #[error("the {part} cannot be compared: {source}")]
    Images {
        /// A slot, `covered` or `image`.
        part: String,
        /// Why not.
        source: MetricsError,
    },
}

/// The references of one scene, each made when it is first needed.
pub struct References<'a> {
    obtain: Box<dyn FnMut(Kind) -> Result<Reference, String> + 'a>,
    pub(super) made: HashMap<Kind, Rc<Reference>>,
}

/// What the references of a scene differ in: which light they show, and where in a pixel it is sampled.
pub(super) type Kind = (LightPaths, PixelFilter);

impl<'a> References<'a> {
    /// The references of `subject` at `size`, of `spp` samples per pixel, light sampled where in a pixel a contender does.
    pub fn new(
        context: &'a Context,
        subject: &'a Subject<'_>,
        size: [u32; 2],
        spp: u32,
        cache: Option<&'a Cache>,
        mut progress: impl FnMut(Progress) + 'a,
    ) -> References<'a> {
        References::by(move |(LightPaths { bounces, caustics, mirrors }, filter)| {
            let request = ReferenceRequest {
                size,
                camera: subject.camera.clone(),
                // Of small lamps paths do not find such caustics.
                estimator: if caustics == CausticPaths::Mirrored { Estimator::Auto } else { Estimator::Path },
                bounces,
                caustics,
                mirrors,
                filter,
                seed: 0,
            };
            let job = Job { context, scene: subject.scene, scene_name: subject.name, request: &request };
            let file = job.make(spp, cache, &mut progress).map_err(|error| error.to_string())?;
            Ok(file.reference())
        })
    }

    fn by(obtain: impl FnMut(Kind) -> Result<Reference, String> + 'a) -> References<'a> {
        References { obtain: Box::new(obtain), made: HashMap::new() }
    }

    /// Fills in the errors of a run made with `settings`, whose slots were asked for.
    ///
    /// # Errors
    /// No reference; images that are of another size or not finite. The run is then as it was.
    pub fn compare(&mut self, finished: &mut Finished, settings: &Settings) -> Result<(), ErrorsUnknown> {
        let Some(images) = &finished.images else { return Ok(()) };
        let filter = settings.filter();
        let (equal, full) = (self.equal_to(settings, filter)?, self.get((LightPaths::default(), filter))?);
        let (equally, fully) = (errors(images, &equal)?, errors(images, &full)?);
        let bounces = settings.bounces();
        let indirect = [Slot::Diffuse, Slot::Caustics, Slot::Specular].into_iter();
        let filled = indirect.filter(|slot| settings.methods.fills(*slot));
        let limits = filled.map(|slot| (slot.name().to_owned(), settings.light_paths(slot).bounces));
        let slot_bounces: BTreeMap<String, Option<u32>> = limits.filter(|(_, limit)| *limit != bounces).collect();
        let fills_specular = settings.methods.fills(Slot::Specular);
        let mirrors = settings.light_paths(Slot::Specular).mirrors.filter(|_| fills_specular);
        let compared = |spp, bounces, caustics: CausticPaths, slot_bounces, mirrors| Compared {
            technique: estimator_name(Estimator::Path).to_owned(),
            spp,
            bounces,
            caustics: caustics.name().to_owned(),
            slot_bounces,
            mirrors,
        };
        let equal_caustics = settings.light_paths(Slot::Caustics).caustics;
        let run = std::mem::take(&mut finished.run);
        finished.run = Run {
            reference: Some(compared(equal.spp, bounces, equal_caustics, slot_bounces, mirrors)),
            reference_full: Some(compared(full.spp, None, CausticPaths::All, BTreeMap::new(), None)),
            error: Some(equally.errors),
            error_full: Some(fully.errors),
            noise: Some(equally.noise),
            noise_full: Some(fully.noise),
            block_noise: Some(equally.block_noise),
            block_noise_full: Some(fully.block_noise),
            ..run
        };
        Ok(())
    }

    /// The errors of images made with `settings`, by the light paths that these account for, and the reference that they are against.
    pub(super) fn against_equal(
        &mut self,
        images: &SlotImages,
        settings: &Settings,
    ) -> Result<(Errors, Rc<Reference>), ErrorsUnknown> {
        let equal = self.equal_to(settings, settings.filter())?;
        Ok((errors(images, &equal)?, equal))
    }

    /// The slots as far as the methods go, each from the reference that is limited like it.
    fn equal_to(&mut self, settings: &Settings, filter: PixelFilter) -> Result<Rc<Reference>, ErrorsUnknown> {
        let kind_of = |slot| (settings.light_paths(slot), filter);
        let whole = self.get(kind_of(Slot::Diffuse))?;
        if Slot::ALL.into_iter().all(|slot| kind_of(slot) == kind_of(Slot::Diffuse)) {
            return Ok(whole);
        }
        let mut mixed = Reference::clone(&whole);
        for slot in Slot::ALL {
            let of_slot = self.get(kind_of(slot))?;
            mixed.spp = mixed.spp.min(of_slot.spp);
            mixed.slots.extend(of_slot.slots.get(&slot).map(|image| (slot, image.clone())));
            mixed.half_differences.extend(of_slot.half_differences.get(&slot).map(|image| (slot, image.clone())));
        }
        mixed.image = ColorImage::sum(mixed.image.size, mixed.slots.values());
        Ok(Rc::new(mixed))
    }

    fn get(&mut self, kind: Kind) -> Result<Rc<Reference>, ErrorsUnknown> {
        if let Some(reference) = self.made.get(&kind) {
            return Ok(reference.clone());
        }
        let reference = Rc::new((self.obtain)(kind).map_err(ErrorsUnknown::Reference)?);
        self.made.insert(kind, reference.clone());
        Ok(reference)
    }
}

impl std::fmt::Debug for References<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("References").field("made", &self.made.keys()).finish_non_exhaustive()
    }
}

/// Errors, and the relative noise of what they are against, of pixels and of blocks, by part.
#[derive(Default)]
pub(super) struct Errors {
    pub(super) errors: BTreeMap<String, ImageErrors>,
    pub(super) noise: BTreeMap<String, f64>,
    block_noise: BTreeMap<String, f64>,
}

/// The errors of every slot that the contender fills, of their sum, and of the image, in which what it does not fill is missing.
fn errors(images: &SlotImages, reference: &Reference) -> Result<Errors, ErrorsUnknown> {
    let filled: Vec<Slot> = images.slots.keys().copied().collect();
    let covered = ColorImage::sum(images.image.size, images.slots.values());
    let covered_reference = reference.sum_of(&filled);
    let mut found = Errors::default();
    let mut add = |part: &str, image: &ColorImage, truth: &ColorImage, slots: &[Slot]| {
        let compared = metrics::compare(image, truth);
        let compared = compared.map_err(|source| ErrorsUnknown::Images { part: part.to_owned(), source })?;
        found.errors.insert(part.to_owned(), compared.errors);
        let [noise, block_noise] = [reference.noise_of(slots).rrmse, reference.block_noise_of(slots)];
        found.noise.extend(noise.is_finite().then(|| (part.to_owned(), noise)));
        found.block_noise.extend(block_noise.is_finite().then(|| (part.to_owned(), block_noise)));
        Ok(())
    };
    for (slot, image) in &images.slots {
        if let Some(truth) = reference.slots.get(slot) {
            add(slot.name(), image, truth, &[*slot])?;
        }
    }
    add(COVERED, &covered, &covered_reference, &filled)?;
    add(IMAGE, &images.image, &reference.image, &Slot::ALL)?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::samples::tests::example_run;
    use crate::reference::ReferenceKey;
    use crate::renderer::{Preset, Technique};

    const SIZE: [u32; 2] = [8, 6];

    fn even(value: f32) -> ColorImage {
        ColorImage { size: SIZE, pixels: vec![[value; 3]; 48] }
    }

    /// Slots of 1, 2, 3, 4, 5, and as much more as there are bounces; noise of 0.01 everywhere.
    fn reference(bounces: Option<u32>) -> Reference {
        let more = bounces.unwrap_or(9) as f32;
        let slots: BTreeMap<Slot, ColorImage> =
            Slot::ALL.into_iter().zip(1..).map(|(slot, value)| (slot, even(value as f32 + more))).collect();
        Reference {
            key: ReferenceKey::parse(&"0".repeat(64)).expect("64 digits"),
            spp: 64,
            image: ColorImage::sum(SIZE, slots.values()),
            slots,
            half_differences: Slot::ALL.into_iter().map(|slot| (slot, even(0.01))).collect(),
            noise: BTreeMap::new(),
            seconds: 1.0,
            samples_per_second: 1.0,
            rays_per_second: 0.0,
            devices: Vec::new(),
        }
    }

    fn finished(technique: Technique) -> (Finished, Settings) {
        let settings = Settings::new(technique, Preset::Default);
        let filled = Slot::ALL.into_iter().filter(|slot| settings.methods.fills(*slot));
        let slots: BTreeMap<Slot, ColorImage> = filled.map(|slot| (slot, even(2.0))).collect();
        let images = SlotImages { image: ColorImage::sum(SIZE, slots.values()), slots };
        (Finished { run: example_run(), picture: None, images: Some(images) }, settings)
    }

    #[test]
    fn slots_are_compared_with_the_light_paths_that_methods_account_for() {
        let mut asked = Vec::new();
        let mut references = References::by(|(LightPaths { bounces, .. }, _)| {
            asked.push(bounces);
            Ok(reference(bounces))
        });
        let mut runs = [Technique::Rsm, Technique::Rsm, Technique::Direct].map(|technique| {
            let (mut finished, settings) = finished(technique);
            references.compare(&mut finished, &settings).expect("sound images");
            finished.run
        });
        drop(references);
        assert_eq!(asked, [Some(1), None, Some(0)], "each reference is made once");
        assert_eq!(runs[0], runs[1]);

        let run = &runs[0];
        let compared = |bounces| {
            let caustics = "all".to_owned();
            Some(Compared { technique: "path".to_owned(), spp: 64, bounces, caustics, ..Compared::default() })
        };
        assert_eq!((run.reference.clone(), run.reference_full.clone()), (compared(Some(1)), compared(None)));
        let (error, error_full) = (run.error.as_ref().expect("compared"), run.error_full.as_ref().expect("compared"));
        assert!(error.keys().eq(["covered", "diffuse", "direct", "emission", "image"]), "{error:?}");
        assert!(error_full.keys().eq(error.keys()));
        // With one bounce the reference's slots are 2, 3, 4, 5 and 6, with full transport 10 to 14; the contender's are 2.
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} {b}");
        close(error["emission"].rmse, 0.0);
        close(error["diffuse"].rrmse, 0.5);
        close(error["covered"].rrmse, 3.0 / 9.0);
        close(error["image"].rrmse, 14.0 / 20.0);
        close(error_full["diffuse"].rrmse, 10.0 / 12.0);
        close(error_full["image"].rrmse, 54.0 / 60.0);
        let noise = run.noise.as_ref().expect("compared");
        close(noise["diffuse"], 0.01 / 4.0);
        close(noise["covered"], 0.03 / 9.0);
        close(noise["image"], 0.05 / 20.0);
        close(run.noise_full.as_ref().expect("compared")["image"], 0.05 / 60.0);
        // Even images have the errors and the noise of their pixels in blocks too.
        close(error["covered"].block_rrmse, 3.0 / 9.0);
        close(run.block_noise.as_ref().expect("compared")["covered"], 0.03 / 9.0);
        close(run.block_noise_full.as_ref().expect("compared")["image"], 0.05 / 60.0);

        let direct = runs[2].error.take().expect("compared");
        assert!(direct.keys().eq(["covered", "direct", "emission", "image"]), "{direct:?}");
    }

    #[test]
    fn without_a_reference_the_run_stays_as_it_was() {
        let (mut finished, settings) = finished(Technique::Rsm);
        let mut references = References::by(|_| Err("no light".to_owned()));
        let error = references.compare(&mut finished, &settings).expect_err("no reference").to_string();
        assert!(error.contains("no light"), "{error}");
        assert_eq!(finished.run, example_run());

        let mut references = References::by(|(LightPaths { bounces, .. }, _)| Ok(reference(bounces)));
        if let Some(images) = &mut finished.images {
            images.slots.insert(Slot::Direct, ColorImage { size: SIZE, pixels: vec![[f32::NAN; 3]; 48] });
        }
        let error = references.compare(&mut finished, &settings).expect_err("not finite").to_string();
        assert!(error.contains("direct"), "{error}");
        assert_eq!(finished.run, example_run());
    }
}
