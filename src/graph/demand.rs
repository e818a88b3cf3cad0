//! Which passes must run: those whose outputs somebody asks for and memory does not hold already. Pure; no Vulkan.
//!
//! Every content that a resource takes has a key, a hash of all that it depends on: the pass that makes it, its
//! settings, and the keys of its inputs. A resource whose memory still holds the key that is wanted needs no pass.

use std::collections::{HashMap, HashSet};

/// One buffer, or one mip level of an image.
pub(crate) type Place = (usize, u32);

/// A content of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Version {
    pub(crate) place: Place,
    pub(crate) key: u64,
}

/// What one pass reads and makes. A place that it modifies is in both lists.
#[derive(Clone, Debug, Default)]
pub(crate) struct Needs {
    pub(crate) reads: Vec<Version>,
    pub(crate) writes: Vec<Version>,
    /// Whether it leaves what it writes in another order each time it runs.
    pub(crate) unordered: bool,
}

/// Whether a pass runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Run,
    /// Its last result stands.
    Unchanged,
    /// Nobody asks for its outputs.
    NotAsked,
}

/// Decides about `passes`, in the order of their declaration, when `wanted` is asked for and `stored` tells what each
/// place holds. What memory holds of what came of an order never meets another one: where a pass that leaves one runs, all that is read of what
/// came of it is made again.
pub(crate) fn decide(passes: &[Needs], wanted: &[Version], stored: impl Fn(Place) -> Option<u64>) -> Vec<Verdict> {
    let none = vec![false; passes.len()];
    let asked = walk(passes, wanted, &none, |_| false).0;
    verdicts(&asked, &settle(passes, wanted, &none, stored, |runs| made_anew(passes, runs, |pass| pass.unordered)))
}

/// Decides which of `passes` run so that those of them that are `forced`, and that `wanted` asks for, do once more: apart from them those alone that
/// make what the forced ones need and memory no longer holds, because a later pass has changed it since.
///
/// What is made again may differ from what it was in the order of its elements. So nothing that memory holds of what came of it meets it: who reads
/// such a content has it made again too.
pub(crate) fn decide_again(
    passes: &[Needs],
    wanted: &[Version],
    forced: &[bool],
    stored: impl Fn(Place) -> Option<u64>,
) -> Vec<Verdict> {
    let asked = walk(passes, wanted, &vec![false; passes.len()], |_| false).0;
    let forced: Vec<bool> = forced.iter().zip(&asked).map(|(forced, asked)| *forced && *asked).collect();
    verdicts(&asked, &settle(passes, &[], &forced, stored, |runs| made_anew(passes, runs, |_| true)))
}

/// The contents that those running passes make which `may_differ` from what they were, and all that come of them.
fn made_anew(passes: &[Needs], runs: &[bool], may_differ: impl Fn(&Needs) -> bool) -> HashSet<Version> {
    let mut anew = HashSet::new();
    for (pass, runs) in passes.iter().zip(runs) {
        if (*runs && may_differ(pass)) || pass.reads.iter().any(|read| anew.contains(read)) {
            anew.extend(&pass.writes);
        }
    }
    anew
}

fn verdicts(asked: &[bool], runs: &[bool]) -> Vec<Verdict> {
    let verdict = |(asked, runs): (&bool, &bool)| match (asked, runs) {
        (_, true) => Verdict::Run,
        (true, false) => Verdict::Unchanged,
        (false, false) => Verdict::NotAsked,
    };
    asked.iter().zip(runs).map(verdict).collect()
}

/// Which passes run: `forced` ones, and those that make what they or `wanted` ask for and memory does not hold. None takes
/// from memory what is `unfit` when these run.
fn settle(
    passes: &[Needs],
    wanted: &[Version],
    forced: &[bool],
    stored: impl Fn(Place) -> Option<u64>,
    unfit: impl Fn(&[bool]) -> HashSet<Version>,
) -> Vec<bool> {
    let mut stale: HashSet<Place> = HashSet::new();
    loop {
        let held = |version: Version| !stale.contains(&version.place) && stored(version.place) == Some(version.key);
        let (runs, taken) = walk(passes, wanted, forced, held);
        // A content taken from memory must not be overwritten by an earlier pass that has to run after all.
        let overwritten = |user: usize, version: Version| {
            let mut earlier = passes[..user].iter().zip(&runs);
            earlier.any(|(pass, runs)| *runs && pass.writes.iter().any(|write| write.place == version.place))
        };
        let unfit = unfit(&runs);
        let lost = |(user, version): &(usize, Version)| overwritten(*user, *version) || unfit.contains(version);
        match taken.into_iter().find(lost) {
            Some((_, version)) => drop(stale.insert(version.place)),
            None => return runs,
        }
    }
}

/// Which passes run when `held` contents need none, and which contents are taken from memory: by which pass (its
/// number; `passes.len()` for `wanted`). `forced` passes run in any case.
fn walk(
    passes: &[Needs],
    wanted: &[Version],
    forced: &[bool],
    held: impl Fn(Version) -> bool,
) -> (Vec<bool>, Vec<(usize, Version)>) {
    let mut runs = vec![false; passes.len()];
    let mut wants: HashMap<Place, u64> = HashMap::new();
    let mut taken = Vec::new();
    let want = |user: usize, version: Version, wants: &mut HashMap<Place, u64>, taken: &mut Vec<(usize, Version)>| {
        if held(version) {
            taken.push((user, version));
        } else {
            wants.insert(version.place, version.key);
        }
    };
    for &version in wanted {
        want(passes.len(), version, &mut wants, &mut taken);
    }
    for (index, pass) in passes.iter().enumerate().rev() {
        runs[index] = forced[index] || pass.writes.iter().any(|write| wants.get(&write.place) == Some(&write.key));
        if runs[index] {
            for write in &pass.writes {
                wants.remove(&write.place);
            }
            for &read in &pass.reads {
                want(index, read, &mut wants, &mut taken);
            }
        }
    }
    (runs, taken)
}

#[cfg(test)]
mod tests {
    use rand_pcg::Pcg32;
    use rand_pcg::rand_core::Rng;

    use super::*;
    use Verdict::{NotAsked, Run, Unchanged};

    fn pass(reads: &[(usize, u64)], writes: &[(usize, u64)]) -> Needs {
        let versions =
            |list: &[(usize, u64)]| list.iter().map(|&(resource, key)| Version { place: (resource, 0), key }).collect();
        Needs { reads: versions(reads), writes: versions(writes), unordered: false }
    }

    fn unordered(needs: Needs) -> Needs {
        Needs { unordered: true, ..needs }
    }

    fn run(passes: &[Needs], wanted: &[(usize, u64)], stored: &[(usize, u64)]) -> Vec<Verdict> {
        let wanted: Vec<_> = wanted.iter().map(|&(resource, key)| Version { place: (resource, 0), key }).collect();
        decide(passes, &wanted, |(resource, _)| {
            stored.iter().find(|(place, _)| *place == resource).map(|(_, key)| *key)
        })
    }

    #[test]
    fn only_what_leads_to_a_wanted_output_runs() {
        let passes = [pass(&[], &[(0, 10)]), pass(&[], &[(1, 11)]), pass(&[(0, 10)], &[(2, 12)])];
        assert_eq!(run(&passes, &[(2, 12)], &[]), [Run, NotAsked, Run]);
        assert_eq!(run(&passes, &[], &[]), [NotAsked; 3]);
    }

    #[test]
    fn what_memory_holds_is_not_made_again() {
        let passes = [pass(&[], &[(0, 10)]), pass(&[(0, 10)], &[(1, 11)]), pass(&[(1, 11)], &[(2, 12)])];
        assert_eq!(run(&passes, &[(2, 12)], &[(0, 10), (1, 11), (2, 12)]), [Unchanged; 3]);
        assert_eq!(run(&passes, &[(2, 12)], &[(0, 10), (1, 11)]), [Unchanged, Unchanged, Run]);
        assert_eq!(
            run(&passes, &[(2, 12)], &[(0, 99), (1, 11)]),
            [Unchanged, Unchanged, Run],
            "an intermediate may be gone"
        );
        assert_eq!(run(&passes, &[(2, 12)], &[(0, 10), (1, 99)]), [Unchanged, Run, Run]);
    }

    #[test]
    fn a_chain_of_modifications_runs_as_a_whole_or_not_at_all() {
        let passes = [pass(&[], &[(0, 1)]), pass(&[(0, 1)], &[(0, 2)]), pass(&[(0, 2)], &[(1, 3)])];
        assert_eq!(run(&passes, &[(1, 3)], &[(0, 2)]), [Unchanged, Unchanged, Run]);
        assert_eq!(run(&passes, &[(1, 3)], &[(0, 1)]), [Unchanged, Run, Run], "the first version stands");
        assert_eq!(run(&passes, &[(1, 3)], &[(0, 7)]), [Run, Run, Run]);
    }

    #[test]
    fn a_content_that_an_earlier_pass_overwrites_is_made_again() {
        // Pass 1 needs the first content of 0, pass 3 the second, which memory holds.
        let passes =
            [pass(&[], &[(0, 1)]), pass(&[(0, 1)], &[(1, 5)]), pass(&[(0, 1)], &[(0, 2)]), pass(&[(0, 2)], &[(2, 6)])];
        assert_eq!(run(&passes, &[(1, 5), (2, 6)], &[(0, 2)]), [Run, Run, Run, Run]);
        assert_eq!(run(&passes, &[(2, 6)], &[(0, 2)]), [Unchanged, NotAsked, Unchanged, Run]);
    }

    #[test]
    fn an_order_never_meets_what_came_of_another() {
        // 0 lists, 1 sorts by the list, 2 reads both; then 3 uses up the list.
        let passes = |first: Needs| {
            [first, pass(&[(0, 1)], &[(1, 5)]), pass(&[(0, 1), (1, 5)], &[(2, 6)]), pass(&[(0, 1)], &[(0, 2)])]
        };
        let listing = || pass(&[], &[(0, 1)]);
        // The list is gone, what was sorted by it is not.
        let stored = [(0, 2), (1, 5)];
        assert_eq!(run(&passes(listing()), &[(2, 6)], &stored), [Run, Unchanged, Run, NotAsked]);
        assert_eq!(run(&passes(unordered(listing())), &[(2, 6)], &stored), [Run, Run, Run, NotAsked]);
        // Nothing has to run: all of it fits itself.
        let whole = [(0, 1), (1, 5), (2, 6)];
        assert_eq!(run(&passes(unordered(listing())), &[(2, 6)], &whole), [Unchanged, Unchanged, Unchanged, NotAsked]);
        // What is wanted besides and came of the old order is made again too.
        assert_eq!(run(&passes(unordered(listing())), &[(1, 5), (2, 6)], &stored), [Run, Run, Run, NotAsked]);
    }

    /// `forced` are numbers of passes; the frame wants the output of the last one.
    fn again(passes: &[Needs], forced: &[usize], stored: &[(usize, u64)]) -> Vec<Verdict> {
        let forced: Vec<bool> = (0..passes.len()).map(|index| forced.contains(&index)).collect();
        let wanted = &passes[passes.len() - 1].writes;
        decide_again(passes, wanted, &forced, |(resource, _)| {
            stored.iter().find(|(place, _)| *place == resource).map(|(_, key)| *key)
        })
    }

    #[test]
    fn a_forced_pass_runs_alone_if_memory_holds_its_inputs() {
        let passes = [pass(&[], &[(0, 10)]), pass(&[(0, 10)], &[(1, 11)]), pass(&[(1, 11)], &[(2, 12)])];
        let stored = [(0, 10), (1, 11), (2, 12)];
        assert_eq!(again(&passes, &[1], &stored), [Unchanged, Run, Unchanged]);
        assert_eq!(again(&passes, &[0, 1], &stored), [Run, Run, Unchanged]);
        assert_eq!(again(&passes, &[2], &[(0, 99), (1, 11)]), [Unchanged, Unchanged, Run]);
        assert_eq!(again(&passes, &[2], &[(0, 10)]), [Unchanged, Run, Run], "its input is made");
        assert_eq!(again(&passes, &[], &stored), [Unchanged; 3]);
    }

    #[test]
    fn a_forced_pass_that_nobody_asks_for_does_not_run() {
        let passes = [pass(&[], &[(0, 10)]), pass(&[], &[(1, 11)]), pass(&[(0, 10)], &[(2, 12)])];
        assert_eq!(again(&passes, &[1, 2], &[(0, 10), (1, 11)]), [Unchanged, NotAsked, Run]);
    }

    #[test]
    fn what_was_modified_since_is_made_for_a_forced_pass() {
        // 0 counts; 1 reads the counts, 2 goes on counting, 3 reads what came of both.
        let passes = [
            pass(&[], &[(0, 1)]),
            pass(&[(0, 1)], &[(1, 5)]),
            pass(&[(0, 1)], &[(0, 2)]),
            pass(&[(0, 2), (1, 5)], &[(2, 6)]),
        ];
        let stored = [(0, 2), (1, 5), (2, 6)];
        assert_eq!(again(&passes, &[1], &stored), [Run, Run, Unchanged, Unchanged]);
        // After that memory holds the first counts, and it stays so.
        assert_eq!(again(&passes, &[1], &[(0, 1), (1, 5), (2, 6)]), [Unchanged, Run, Unchanged, Unchanged]);
        assert_eq!(again(&passes, &[2], &stored), [Run, Unchanged, Run, Unchanged]);
    }

    #[test]
    fn what_came_of_another_order_is_made_again_too() {
        // 1 sorts by the order that 0 leaves, 2 reads both.
        let passes = [pass(&[], &[(0, 1)]), pass(&[(0, 1)], &[(1, 5)]), pass(&[(0, 1), (1, 5)], &[(2, 6)])];
        let stored = [(0, 1), (1, 5), (2, 6)];
        assert_eq!(again(&passes, &[0, 2], &stored), [Run, Run, Run], "2 must not mix the new order with the old one");
        assert_eq!(again(&passes, &[2], &stored), [Unchanged, Unchanged, Run], "the old one fits itself");
        assert_eq!(again(&passes, &[0], &stored), [Run, Unchanged, Unchanged]);
    }

    fn below(random: &mut Pcg32, end: usize) -> usize {
        random.next_u32() as usize % end
    }

    /// A frame of random passes over few places, as the graph declares them: what a pass reads is the content of its time, what it makes is named by
    /// all that it reads. `settings` tells passes apart whose settings have changed.
    fn random_frame(random: &mut Pcg32, settings: &[u64]) -> Vec<Needs> {
        const PLACES: usize = 5;
        let mut content = [0_u64; PLACES];
        let mut passes = Vec::new();
        for (index, setting) in settings.iter().enumerate() {
            let reads: Vec<usize> = (0..below(random, 3)).map(|_| below(random, PLACES)).collect();
            let reads: Vec<usize> = reads.into_iter().filter(|&place| content[place] != 0).collect();
            let mut writes = vec![below(random, PLACES)];
            writes.extend((below(random, 3) == 0).then(|| below(random, PLACES)));
            writes.dedup();
            let versions = |places: &[usize], content: &[u64]| -> Vec<Version> {
                places.iter().map(|&place| Version { place: (place, 0), key: content[place] }).collect()
            };
            let reads = versions(&reads, &content);
            for &place in &writes {
                let keys: Vec<u64> = reads.iter().map(|read| read.key).collect();
                content[place] = super::super::key::hash_of(&(index, setting, keys, place)).max(1);
            }
            let unordered = below(random, 4) == 0;
            passes.push(Needs { writes: versions(&writes, &content), reads, unordered });
        }
        passes
    }

    /// Whatever was asked for before and whatever is gone since: each pass that runs finds what it needs, nothing mixes two orders, and what is wanted is
    /// there at the end.
    #[test]
    fn random_frames_find_what_they_need() {
        let random = &mut Pcg32::new(1, 1);
        let mut skipped = 0;
        for _ in 0..3000 {
            let shape = random.clone();
            let mut settings = vec![0_u64; 1 + below(random, 9)];
            // What memory holds: a content, and the runs of unordered passes that it came of.
            let mut memory: HashMap<Place, (u64, HashMap<u64, u64>)> = HashMap::new();
            let mut run_number = 0_u64;
            for _ in 0..6 {
                let passes = random_frame(&mut shape.clone(), &settings);
                let wanted: Vec<Version> = {
                    let all: HashMap<Place, u64> =
                        passes.iter().flat_map(|pass| &pass.writes).map(|write| (write.place, write.key)).collect();
                    let mut all: Vec<Version> = all.into_iter().map(|(place, key)| Version { place, key }).collect();
                    all.sort_by_key(|version| version.place);
                    all.into_iter().filter(|_| below(random, 2) == 0).collect()
                };
                let verdicts = decide(&passes, &wanted, |place| memory.get(&place).map(|(key, _)| *key));
                for (pass, _) in passes.iter().zip(&verdicts).filter(|(_, verdict)| **verdict == Run) {
                    run_number += 1;
                    let mut orders: HashMap<u64, u64> = HashMap::new();
                    for read in &pass.reads {
                        let (key, came_of) = memory.get(&read.place).expect("what it reads was made");
                        assert_eq!(*key, read.key, "it reads what it was declared to read");
                        for (order, run) in came_of {
                            assert_eq!(*orders.entry(*order).or_insert(*run), *run, "two orders of one list meet");
                        }
                    }
                    if pass.unordered {
                        orders.insert(pass.writes[0].key, run_number);
                    }
                    for write in &pass.writes {
                        memory.insert(write.place, (write.key, orders.clone()));
                    }
                }
                skipped += verdicts.iter().filter(|verdict| **verdict == Unchanged).count();
                assert!(wanted.iter().all(|wish| memory[&wish.place].0 == wish.key), "what is wanted is there");
                // Settings change, and memory goes.
                let change = below(random, 2 * settings.len());
                settings.iter_mut().skip(change).take(1).for_each(|setting| *setting += 1);
                if below(random, 3) == 0 {
                    memory.remove(&(below(random, 5), 0));
                }
            }
        }
        assert!(skipped > 1000, "{skipped} passes were skipped");
    }
}
