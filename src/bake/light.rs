//! The light of the atlas: irradiance, and the radiance ρ/π·E + Le that surfaces send out because of it, in eight bits times a power of two for each surface, so that a
//! lamp beside it does not leave a dark wall a handful of steps.

use std::collections::BTreeMap;
use std::f32::consts::PI;

use super::atlas::{Atlas, Sheet};
use super::fill::{fill, smoothed};
use super::looks::SurfaceLooks;
use crate::image::{ColorImage, quantize, srgb_encode};
use crate::renderer::SurfaceLight;
use crate::slot::Slot;

/// Exponents of the powers of two: those of normal numbers.
const EXPONENTS: (i32, i32) = (-126, 127);
/// What few rays found is smoothed over so many texels of the light maps to either side, twice.
const SMOOTHED: u32 = 3;

pub(super) struct Light {
    /// W/m²
    pub(super) irradiance: ColorImage,
    pub(super) parts: BTreeMap<Slot, ColorImage>,
    /// sRGB-encoded, of the atlas; what it is multiplied by is that of the sheet.
    pub(super) emissive: Vec<[u8; 3]>,
    /// Of each surface, whether it keeps the scene's material: mirrors and glass, with little diffuse light or none.
    pub(super) kept: Vec<bool>,
    /// Of each sheet the exponent of the power of two that its texels are multiplied by, W/(m² sr); `None`: it is black.
    pub(super) exponents: Vec<Option<i32>>,
}

impl Light {
    pub(super) fn new(atlas: &Atlas, found: &SurfaceLight, looks: &[SurfaceLooks]) -> Light {
        let texel_count = atlas.size[0] as usize * atlas.size[1] as usize;
        let black = || ColorImage::black(atlas.size);
        let mut light = Light {
            irradiance: black(),
            parts: [Slot::Direct, Slot::Diffuse, Slot::Caustics].into_iter().map(|slot| (slot, black())).collect(),
            emissive: vec![[0; 3]; texel_count],
            kept: looks.iter().map(SurfaceLooks::keep_the_material).collect(),
            exponents: Vec::new(),
        };
        for sheet in &atlas.sheets {
            let received = received(sheet, found);
            let of = |start: usize| received.iter().map(move |it| [it[start], it[start + 1], it[start + 2]]);
            let (direct, diffuse, caustics): (Vec<_>, Vec<_>, Vec<_>) =
                (of(0).collect(), of(3).collect(), of(6).collect());
            let all: Vec<[f32; 3]> = received
                .iter()
                .map(|it| [0, 1, 2].map(|channel| it[channel] + it[channel + 3] + it[channel + 6]))
                .collect();
            let radiance = radiance(sheet, &all, &looks[sheet.surface as usize]);
            let brightest = radiance.iter().flatten().copied().fold(0.0, f32::max);
            let exponent = exponent_of(brightest);
            let scale = exponent.map_or(0.0, |exponent| 2.0_f64.powi(-exponent));
            let encoded: Vec<[u8; 3]> = radiance
                .iter()
                .map(|it| it.map(|channel| quantize(srgb_encode((f64::from(channel) * scale) as f32))))
                .collect();
            light.exponents.push(exponent);
            put(atlas, sheet, &encoded, &mut light.emissive);
            put(atlas, sheet, &all, &mut light.irradiance.pixels);
            for (slot, values) in [(Slot::Direct, &direct), (Slot::Diffuse, &diffuse), (Slot::Caustics, &caustics)] {
                if let Some(image) = light.parts.get_mut(&slot) {
                    put(atlas, sheet, values, &mut image.pixels);
                }
            }
        }
        light
    }
}

/// Direct, diffuse and caustic irradiance of each of its texels. Those within geometry have that of their neighbours.
fn received(sheet: &Sheet, found: &SurfaceLight) -> Vec<[f32; 9]> {
    let numbers = sheet.first as usize..sheet.first as usize + sheet.texel_count();
    let mut known: Vec<bool> = numbers.clone().map(|number| found.valid[number]).collect();
    let arrivals = smoothed(&found.arrivals[numbers.clone()], &known, sheet.size, SMOOTHED * found.detail);
    let of = |number: usize| {
        let [direct, diffuse, caustics] = [&found.direct, &found.diffuse, &found.caustics].map(|it| it[number]);
        let arrival = arrivals[number - sheet.first as usize];
        let caustics = [0, 1, 2].map(|channel| caustics[channel] + arrival[channel]);
        std::array::from_fn(|channel| [direct, diffuse, caustics][channel / 3][channel % 3])
    };
    let mut values: Vec<[f32; 9]> =
        numbers.zip(&known).map(|(number, known)| if *known { of(number) } else { [0.0; 9] }).collect();
    fill(&mut values, &mut known, sheet.size);
    values
}

/// What each texel sends out, W/(m² sr).
fn radiance(sheet: &Sheet, irradiance: &[[f32; 3]], looks: &SurfaceLooks) -> Vec<[f32; 3]> {
    let emits = sheet.side == 0 || looks.emits_back;
    let of = |(irradiance, look): (&[f32; 3], &[f32; 6])| {
        [0, 1, 2].map(|channel| {
            let emitted = if emits { look[channel + 3] } else { 0.0 };
            look[channel] / PI * irradiance[channel] + emitted
        })
    };
    irradiance.iter().zip(&looks.texels).map(of).collect()
}

/// Of the least power of two that is no less.
fn exponent_of(brightest: f32) -> Option<i32> {
    let exponent = (brightest.is_normal() && brightest > 0.0).then(|| brightest.log2().ceil() as i32)?;
    Some(exponent.clamp(EXPONENTS.0, EXPONENTS.1))
}

/// Puts the texels of a sheet in their place in the image, and those at its borders in the margin too.
fn put<T: Copy>(atlas: &Atlas, sheet: &Sheet, values: &[T], image: &mut [T]) {
    let ([width, height], margin) = (sheet.size.map(i64::from), i64::from(sheet.margin()));
    for row in -margin..height + margin {
        let y = i64::from(sheet.place[1]) + row;
        for column in -margin..width + margin {
            let x = i64::from(sheet.place[0]) + column;
            let inside = row.clamp(0, height - 1) * width + column.clamp(0, width - 1);
            image[(y * i64::from(atlas.size[0]) + x) as usize] = values[inside as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_hold_what_there_is() {
        assert_eq!(
            [0.0, 1.0, 1.01, 0.5, 0.3, 700.0].map(exponent_of),
            [None, Some(0), Some(1), Some(-1), Some(-1), Some(10)]
        );
        assert_eq!([f32::MAX, f32::INFINITY, f32::NAN, 1e-45].map(exponent_of), [Some(127), None, None, None]);
    }
}
