//! Where to stand inside a scene, and where to look.
//!
//! Wherever a lattice of vertical lines goes through a floor with room above it, somebody could stand. Rays all around say how
//! much space there is and which way the view is deep; the best of those places are then looked at more closely, and the view
//! that shows most of the scene's surfaces wins, as long as it is not spoilt by the sky, by the backs of walls or by something
//! right in front of the eye.
//!
//! Lengths are relative to the scene's radius, and its middle is the origin.

use super::rays::{Rays, SurfacePoint};
use glam::{Quat, Vec2, Vec3};
use rayon::prelude::*;
use std::f32::consts::TAU;

/// Vertical lines along each side of the bounds. Odd, so that one goes through the middle.
const LINES: usize = 9;
/// Surfaces on one line that are looked at.
const MOST_STOREYS: usize = 12;
/// Rooms lower than this are furniture.
const LOWEST_ROOM: f32 = 0.03;
/// Height of a standing person's eyes in metres.
const EYE_METRES: f64 = 1.6;
/// Directions around a place, and their slopes (rise over run).
const AROUND: usize = 24;
const SLOPES: [f32; 3] = [-0.27, 0.09, 0.47];
/// So many directions to each side of the middle one are in a picture: ±45°.
const HALF_PICTURE: usize = 3;
/// At most these shares of the rays around a place may leave the scene or meet the back of a surface.
const MOST_MISSES: f32 = 0.5;
const MOST_BACKS: f32 = 0.1;
/// A surface nearer than this stands in the way.
const CLOSE: f32 = 0.07;
/// Places that are looked at more closely.
const FINALISTS: usize = 24;
/// A view this many times as good as the one along the deepest direction is preferred to it.
const WORTH_TURNING: f32 = 1.25;
/// Rays across and down the trial picture of a finalist.
const PICTURE: [usize; 2] = [16, 12];
/// Every so many of the surface points are tried from a finalist.
const POINT_STRIDE: usize = 2;

/// A place to stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stand {
    /// Position of the eye.
    pub(super) eye: Vec3,
    /// Horizontal unit vector.
    pub(super) forward: Vec3,
    score: f32,
}

/// The best place in bounds of half the size `half`. `radius` is the scene's in metres, `tangent` that of half the vertical angle
/// of view. `None` if there is no floor with free space above it.
pub(super) fn find(rays: &Rays, points: &[SurfacePoint], half: Vec3, radius: f64, tangent: f32) -> Option<Stand> {
    let eye_height = (EYE_METRES / radius) as f32;
    let lines: Vec<Vec2> = (0..LINES * LINES)
        .map(|line| {
            let at = Vec2::new((line % LINES) as f32, (line / LINES) as f32);
            ((at + 0.5) / LINES as f32 * 2.0 - 1.0) * Vec2::new(half.x, half.z)
        })
        .collect();
    let mut stands: Vec<Stand> = lines
        .par_iter()
        .flat_map_iter(|&line| {
            eyes(rays, line, half.y, eye_height).into_iter().filter_map(|eye| look_around(rays, eye))
        })
        .collect();
    // The sort keeps the order of equals, so that the choice never depends on the number of threads.
    stands.sort_by(|a, b| b.score.total_cmp(&a.score));
    stands.truncate(FINALISTS);
    let closer: Vec<Stand> = stands.par_iter().map(|stand| judge(rays, points, stand, tangent)).collect();
    let best = best_of(closer.into_iter())?;
    // Depth alone has turned it so far; what it shows can be to one side. Small gains are not worth a slanted picture.
    let turned = (-2..=2).map(|step| {
        let forward = Quat::from_rotation_y(step as f32 * TAU / AROUND as f32) * best.forward;
        judge(rays, points, &Stand { forward, ..best }, tangent)
    });
    best_of(turned).filter(|turned| turned.score > best.score * WORTH_TURNING).or(Some(best))
}

/// The stand with the highest score, of almost equal ones the first.
fn best_of(stands: impl Iterator<Item = Stand>) -> Option<Stand> {
    stands.reduce(|best, other| if other.score > best.score + 1e-4 { other } else { best })
}

/// The eyes of people standing on the floors that a vertical line goes through.
fn eyes(rays: &Rays, line: Vec2, top: f32, eye_height: f32) -> Vec<Vec3> {
    let mut eyes = Vec::new();
    let mut ceiling = top;
    let mut from = top + 1e-3;
    for _ in 0..MOST_STOREYS {
        let Some(hit) = rays.first(Vec3::new(line.x, from, line.y), Vec3::NEG_Y, f32::INFINITY) else {
            break;
        };
        let floor = from - hit.distance;
        let height = ceiling - floor;
        if hit.front && height > LOWEST_ROOM {
            // In a high hall somewhat above the heads, in a dolls' house at half the height of its rooms.
            let eye = floor + (height * 0.25).max(eye_height.min(height * 0.5));
            eyes.push(Vec3::new(line.x, eye, line.y));
        }
        ceiling = floor;
        from = floor - 1e-4;
    }
    eyes
}

/// The deepest view from a place; `None` if it is inside a solid or in the open.
fn look_around(rays: &Rays, eye: Vec3) -> Option<Stand> {
    let forward = |turn: usize| {
        let angle = turn as f32 / AROUND as f32 * TAU;
        Vec3::new(angle.sin(), 0.0, -angle.cos())
    };
    let all = (AROUND * SLOPES.len()) as f32;
    let (mut misses, mut backs) = (0.0, 0.0);
    // The binary logarithm of the distance, summed over the slopes: twice as deep counts the same near and far.
    let mut depths = [0.0; AROUND];
    // Every fifth direction next, so that the rays of a bad place soon show it.
    for turn in (0..AROUND).map(|number| number * 5 % AROUND) {
        for slope in SLOPES {
            depths[turn] += match rays.first(eye, forward(turn) + Vec3::Y * slope, f32::INFINITY) {
                Some(hit) => {
                    backs += f32::from(!hit.front);
                    let blocks = if hit.distance < CLOSE { 2.0 } else { 0.0 };
                    hit.distance.max(1e-3).log2() - blocks
                }
                // The sky is as dull as a wall right ahead.
                None => {
                    misses += 1.0;
                    CLOSE.log2()
                }
            };
        }
        if misses > MOST_MISSES * all || backs > MOST_BACKS * all {
            return None;
        }
    }
    let score = |turn: usize| -> f32 {
        let first = turn + AROUND - HALF_PICTURE;
        (first..=first + 2 * HALF_PICTURE).map(|turn| depths[turn % AROUND]).sum()
    };
    let best = (0..AROUND).map(|turn| Stand { eye, forward: forward(turn), score: score(turn) });
    best_of(best)
}

/// Scores a place by how much of the scene's surface its picture shows, less what spoils it.
fn judge(rays: &Rays, points: &[SurfacePoint], stand: &Stand, tangent: f32) -> Stand {
    let [width, height] = PICTURE;
    let right = stand.forward.cross(Vec3::Y);
    let aspect = width as f32 / height as f32;
    let (mut misses, mut backs, mut blocked) = (0.0, 0.0, 0.0);
    let mut depths = [0.0, 0.0];
    for pixel in 0..width * height {
        let x = ((pixel % width) as f32 + 0.5) / width as f32 * 2.0 - 1.0;
        let y = 1.0 - ((pixel / width) as f32 + 0.5) / height as f32 * 2.0;
        let direction = stand.forward + right * (x * tangent * aspect) + Vec3::Y * (y * tangent);
        let Some(hit) = rays.first(stand.eye, direction, f32::INFINITY) else {
            misses += 1.0;
            continue;
        };
        backs += f32::from(!hit.front);
        blocked += f32::from(hit.distance < CLOSE);
        let depth = hit.distance.max(1e-3).log2();
        depths = [depths[0] + depth, depths[1] + depth * depth];
    }
    let all = (width * height) as f32;
    let hits = (all - misses).max(1.0);
    let varied = (depths[1] / hits - (depths[0] / hits).powi(2)).max(0.0).sqrt();
    let in_picture = |point: &&SurfacePoint| {
        let way = point.position() - stand.eye;
        let depth = way.dot(stand.forward) * tangent;
        way.dot(right).abs() < depth * aspect && way.y.abs() < depth
    };
    let tried = points.iter().step_by(POINT_STRIDE);
    let seen = tried.filter(in_picture).filter(|point| rays.sees(stand.eye, point)).count();
    let share = (seen * POINT_STRIDE) as f32 / points.len().max(1) as f32;
    let spoilt = (1.0 - misses / all) * (1.0 - backs / all).powi(3) * (1.0 - blocked / all).powi(2);
    Stand { score: (share + 0.03 * varied) * spoilt, ..*stand }
}
