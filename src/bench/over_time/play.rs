//! Playing a sequence: every contender renders every frame, in turn, first timed as a whole, then pass by pass and compared.

use std::collections::HashMap;
use std::rc::Rc;

use super::player::{Player, Shot};
use super::sequence::{Comparing, Sequence};
use crate::bench::errors::{ErrorsUnknown, Kind, References};
use crate::bench::report::Failure;
use crate::bench::run::{Finished, Options, Subject, sentence};
use crate::reference::Reference;
use crate::renderer::{Context, Settings, Timing};
use crate::scene::{CameraView, Revisions};

/// What came of a sequence.
#[derive(Debug)]
pub struct Played {
    /// A contender each, in their order.
    pub outcomes: Vec<Result<Finished, Failure>>,
    /// What befell all of them.
    pub failure: Option<Failure>,
}

/// How often one contender reports progress.
pub fn steps_per_contender(options: &Options) -> u64 {
    2 * u64::from(options.frames)
}

/// Plays `options.frames` frames of the scene with every contender. Each plays them twice, both times after the frames of lead-in and warm-up, in which frame 0 stands still,
/// with nothing kept from before: first timed as a whole, then pass by pass, with its pictures. The medians of a run are over the frames. Pieces on their own are
/// not measured. `progress` is called after every frame of every contender.
pub fn play(
    context: &Context,
    subject: &Subject<'_>,
    contenders: &[Settings],
    options: &Options,
    sequence: &Sequence<'_>,
    progress: &mut dyn FnMut(),
) -> Played {
    let mut scene = subject.scene.clone();
    let mut players: Vec<Player> = contenders.iter().map(|settings| Player::new(context, settings)).collect();
    let mut failure = None;
    for timing in [Timing::Frame, Timing::Passes] {
        let mut truths: Vec<Option<Truth>> =
            players.iter().map(|_| sequence.compare.map(|_| Truth::default())).collect();
        for frame in 0..options.frames {
            scene.set_time(sequence.seconds(frame));
            let camera = match sequence.view(&scene, frame) {
                Ok(camera) => camera,
                Err(error) => return all_failed(&players, subject, sentence(&error)),
            };
            let shot = Shot { scene: &scene, camera: &camera, frame, options, sequence };
            for (player, truth) in players.iter_mut().zip(&mut truths) {
                if frame == 0 {
                    player.begin(&shot);
                }
                if timing == Timing::Frame {
                    player.time(&shot);
                } else {
                    player.show(&shot, context);
                    let compared = truth.as_mut().map(|truth| truth.compare(player, &shot, subject, context));
                    if let Some(Err(error)) = compared {
                        failure.get_or_insert(error);
                    }
                    player.keep();
                }
                progress();
            }
            if failure.is_some() {
                truths.fill_with(|| None);
            }
        }
    }
    let failure = failure.map(|error: String| Failure { scene: subject.name.to_owned(), error, ..Failure::default() });
    let last = options.frames.saturating_sub(1);
    let outcomes = match sequence.view(&scene, last) {
        Ok(camera) => {
            let shot = Shot { scene: &scene, camera: &camera, frame: last, options, sequence };
            players.into_iter().map(|player| player.finish(&shot, subject)).collect()
        }
        Err(error) => return all_failed(&players, subject, sentence(&error)),
    };
    Played { outcomes, failure }
}

fn all_failed(players: &[Player], subject: &Subject<'_>, error: String) -> Played {
    let outcomes = players.iter().map(|player| Err(player.failure(subject, error.clone()))).collect();
    Played { outcomes, failure: None }
}

/// The references of one contender's latest frame, which stand while nothing changes.
#[derive(Default)]
struct Truth {
    made: HashMap<Kind, Rc<Reference>>,
    of: Option<(Revisions, CameraView)>,
}

impl Truth {
    /// Compares what the player showed last with the reference of this very frame. What is wrong with its pictures stops the player; without a reference there is an
    /// error.
    fn compare(
        &mut self,
        player: &mut Player,
        shot: &Shot<'_>,
        subject: &Subject<'_>,
        context: &Context,
    ) -> Result<(), String> {
        let Some(Comparing { spp, cache }) = shot.sequence.compare else { return Ok(()) };
        let revisions = Revisions { camera: 0, ..shot.scene.revisions() };
        let now = Some((revisions, shot.camera.clone()));
        if self.of != now {
            (self.of, self.made) = (now, HashMap::new());
        }
        let subject = Subject { scene: shot.scene, camera: shot.camera, ..*subject };
        let mut references = References::new(context, &subject, shot.options.size, spp, cache, |_| ());
        references.made = std::mem::take(&mut self.made);
        let compared = player.compare(shot.frame, &mut references);
        self.made = std::mem::take(&mut references.made);
        match compared {
            Err(error @ ErrorsUnknown::Reference(_)) => Err(error.to_string()),
            Err(error) => {
                player.stop(sentence(&error));
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }
}
