//! How much light a scene's lights send out.

use std::f64::consts::PI;

use super::{LightKind, Scene};

impl Scene {
    /// The power of all lights together, W: of points and spots (glTF's fall-off between the angles is a square of the cosine), of emissive surfaces, and what directional lights and
    /// the sky send through a sphere around the scene.
    pub(crate) fn emitted_power(&self) -> [f64; 3] {
        let radius = self.bounds().map_or(0.0, |bounds| bounds.radius());
        let mut power = self.sky().map(|radiance| f64::from(radiance) * PI * 4.0 * PI * radius * radius);
        let mut add = |light: [f32; 3], factor: f64| {
            power.iter_mut().zip(light).for_each(|(sum, channel)| *sum += factor * f64::from(channel));
        };
        for light in self.placed_lights() {
            let factor = match light.kind {
                LightKind::Point => 4.0 * PI,
                LightKind::Spot { inner_angle, outer_angle } => {
                    let [inner, outer] = [inner_angle, outer_angle].map(|angle| f64::from(angle).cos());
                    2.0 * PI * (1.0 - inner + (inner - outer) / 3.0)
                }
                LightKind::Directional => PI * radius * radius,
            };
            add(light.intensity, factor);
        }
        // Each stands for an equal part; how many there are changes nothing in their sum.
        for sample in self.emitter_samples(1) {
            add(sample.power, 1.0);
        }
        power
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_lights_send_what_their_closed_forms_say() {
        let power = |name: &str| Scene::open(name).expect("a built-in scene").emitted_power()[0];
        assert!((power("leak") / (2.0 * 4.5 * 4.0 * PI) - 1.0).abs() < 1e-6);
        let [inner, outer] = [25_f64, 35.0].map(|angle| angle.to_radians().cos());
        assert!((power("cornell-spot") / (22.0 * 2.0 * PI * (1.0 - inner + (inner - outer) / 3.0)) - 1.0).abs() < 1e-5);
        let scene = Scene::open("cornell-panel").expect("a built-in scene");
        let area: f64 = scene.emitter_samples(64).iter().map(|sample| sample.area).sum();
        assert!((scene.emitted_power()[0] / (PI * 16.0 * area) - 1.0).abs() < 1e-5);
    }
}
