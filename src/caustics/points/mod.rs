//! `points`: caustics by photons that are kept over frames, drawn as points and filtered (Larsen & Christensen 2004, section 5).
//!
//! 1. `kept.rs`: photons from the specular surfaces that lights see, through the scene's hierarchy to where they land; some of them are sent again in each frame where
//!    something changed.
//! 2. `draw.rs`: the points, and their filter in the tiles that they reach; `frame/photons/field.rs`: their light at what mirrors show.

pub(crate) mod draw;
pub(crate) mod kept;
pub(crate) mod options;

use self::options::PointOptions;
use crate::frame::light_views::Views;
use crate::frame::photons::field::{Widths, light_mirrored};
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{CausticPaths, LightPaths, Slot};

/// Photons from the specular surfaces that lights see, as filtered points.
pub(crate) struct Points;

impl Method for Points {
    const NAME: &'static str = "points";
    const SLOT: Slot = Slot::Caustics;
    type Options = PointOptions;
    const LIGHTS_MIRRORED: bool = true;

    fn light_paths(options: &PointOptions) -> LightPaths {
        LightPaths { bounces: Some(options.bounces), caustics: CausticPaths::Specular, mirrors: None }
    }

    fn inputs(_: &PointOptions) -> Inputs {
        Inputs { light_depth: Views::All, rays: Rays::ToSurfaces, ..Inputs::default() }
    }

    fn shaders(_: &PointOptions, _: bool) -> Vec<&'static str> {
        let choose = ["photons/pyramid", "photons/choose", "photons/mark", "photons/number", "photons/list"];
        let send = [
            "photons/specular*",
            "photons/start",
            "photons/emit",
            "photons/scatter",
            "photons/trace",
            "photons/land_traced",
            "photons/keep",
        ];
        [&choose[..], &send, &["photons/field*", "buckets/starts", "points/*"]].concat()
    }

    fn skip(options: &PointOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.specular, facts.diffuse, options.photons.min(options.bounces)) {
            (false, ..) => Some("no specular or transmissive surface"),
            (_, false, _) => Some("no diffuse surface"),
            (.., 0) => Some("no photons asked for"),
            _ => None,
        }
    }

    fn reduced(options: &PointOptions) -> Option<String> {
        let (asked, sent) = (options.photons, kept::sent(options));
        let bounces = options.bounces;
        (sent < asked).then(|| {
            format!("points.photons is {asked}, but buffers hold {sent} at points.bounces {bounces}: so many are sent")
        })
    }

    fn lead_in(options: &PointOptions) -> u32 {
        options.frames - 1
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &PointOptions) -> Result<Option<ImageRef>, Error> {
        let Some(scene) = cx.rays() else { return Ok(None) };
        let photons = kept::keep(cx, scene, options);
        let widths = Widths { radius: options.radius as f32, scale: draw::RADIUS_SCALE, tolerance: 0.0 };
        light_mirrored(cx.graph, cx.frame, "caustics/points/mirrored", photons, widths);
        Ok(Some(draw::draw(cx.graph, cx.frame.surface, options, photons)))
    }
}
