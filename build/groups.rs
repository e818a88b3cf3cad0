//! Groups: files of `glsl/groups/` that declare bindings and specialisation constants for several programs, with numbers that are theirs alone.
//!
//! A file says which numbers in a line of its own,
//! ```text
//! // group: bindings 32 to 47, constants 32 to 39
//! ```
//! and is compiled by itself, so that what it declares is what the compiler says it does.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use super::reflect::{Binding, Constant, Stage};

/// The set that groups are in.
const SET: u32 = 0;

/// One group: the file's stem names its Rust struct and the field that programs have for it.
pub(crate) struct Group {
    pub(crate) name: String,
    pub(crate) summary: String,
    pub(crate) members: Vec<Binding>,
    pub(crate) constants: Vec<Constant>,
    ranges: Ranges,
}

/// Numbers of bindings and of specialisation constants.
struct Ranges {
    bindings: Option<RangeInclusive<u32>>,
    constants: Option<RangeInclusive<u32>>,
}

/// A group's file, compiled by itself.
pub(crate) struct GroupFile {
    pub(crate) name: String,
    pub(crate) source: String,
    pub(crate) summary: String,
    pub(crate) stage: Stage,
    /// Other groups that it includes.
    pub(crate) includes: BTreeSet<String>,
}

/// All groups.
///
/// # Errors
/// Says which file declares what is not its own.
pub(crate) fn groups(files: Vec<GroupFile>) -> Result<Vec<Group>, String> {
    let mut includes = BTreeMap::new();
    let mut groups = Vec::new();
    for file in files {
        let ranges = ranges(&file.source).map_err(|error| format!("{}: {error}", path(&file.name)))?;
        includes.insert(file.name.clone(), file.includes);
        groups.push(Group {
            name: file.name,
            summary: file.summary,
            members: file.stage.declared_bindings,
            constants: file.stage.declared_constants,
            ranges,
        });
    }
    for (index, group) in groups.iter().enumerate() {
        for other in &groups[..index] {
            apart(other, group)?;
        }
    }
    for index in 0..groups.len() {
        let included = |other: &Group| includes[&groups[index].name].contains(&other.name);
        let others: Vec<&Group> = groups.iter().filter(|other| included(other)).collect();
        let belongs = |name: &str, number: u32, set: u32, of: fn(&Ranges) -> &Option<RangeInclusive<u32>>| {
            let own = &groups[index];
            let others_too = others.iter().any(|other| holds(of(&other.ranges), number));
            match (set == SET && holds(of(&own.ranges), number), others_too) {
                (true, _) => Ok(true),
                (false, true) => Ok(false),
                (false, false) => {
                    Err(format!("{} declares {name} with the number {number}, outside of its range", path(&own.name)))
                }
            }
        };
        let mut own_members = Vec::new();
        for member in &groups[index].members {
            if belongs(&member.name, member.binding, member.set, |ranges| &ranges.bindings)? {
                own_members.push(member.clone());
            }
        }
        let mut own_constants = Vec::new();
        for constant in &groups[index].constants {
            if belongs(&constant.name, constant.id, SET, |ranges| &ranges.constants)? {
                own_constants.push(constant.clone());
            }
        }
        (groups[index].members, groups[index].constants) = (own_members, own_constants);
    }
    declared_once(&groups)?;
    Ok(groups)
}

fn path(name: &str) -> String {
    format!("glsl/groups/{name}.glsl")
}

fn holds(range: &Option<RangeInclusive<u32>>, number: u32) -> bool {
    range.as_ref().is_some_and(|range| range.contains(&number))
}

/// The ranges that the line `// group: …` names.
fn ranges(source: &str) -> Result<Ranges, String> {
    const FORM: &str = "it must say its numbers in a line \"// group: bindings A to B, constants C to D\"";
    let line = source.lines().find_map(|line| line.strip_prefix("// group: ")).ok_or(FORM)?;
    let mut ranges = Ranges { bindings: None, constants: None };
    for part in line.split(", ") {
        let words: Vec<&str> = part.split_whitespace().collect();
        let [what, low, "to", high] = words[..] else { return Err(FORM.to_owned()) };
        let (Ok(low), Ok(high)) = (low.parse::<u32>(), high.parse::<u32>()) else { return Err(FORM.to_owned()) };
        match what {
            "bindings" => ranges.bindings = Some(low..=high),
            "constants" => ranges.constants = Some(low..=high),
            _ => return Err(FORM.to_owned()),
        }
    }
    Ok(ranges)
}

/// Two groups must not share numbers: a program may include both.
fn apart(a: &Group, b: &Group) -> Result<(), String> {
    let overlap = |a: &Option<RangeInclusive<u32>>, b: &Option<RangeInclusive<u32>>| match (a, b) {
        (Some(a), Some(b)) => a.start() <= b.end() && b.start() <= a.end(),
        _ => false,
    };
    for (what, overlaps) in [
        ("bindings", overlap(&a.ranges.bindings, &b.ranges.bindings)),
        ("constants", overlap(&a.ranges.constants, &b.ranges.constants)),
    ] {
        if overlaps {
            return Err(format!("{} and {} claim the same numbers of {what}", path(&a.name), path(&b.name)));
        }
    }
    Ok(())
}

/// Likewise names.
fn declared_once(groups: &[Group]) -> Result<(), String> {
    let mut known: BTreeMap<&str, &str> = BTreeMap::new();
    for group in groups {
        let names = group.members.iter().map(|member| &member.name);
        for name in names.chain(group.constants.iter().map(|constant| &constant.name)) {
            if let Some(other) = known.insert(name, &group.name) {
                return Err(format!("{name} is declared in {} and in {}", path(other), path(&group.name)));
            }
        }
    }
    Ok(())
}

impl Group {
    /// Whether a binding of a program is a member.
    pub(crate) fn owns(&self, binding: &Binding) -> bool {
        binding.set == SET && self.members.iter().any(|member| member.binding == binding.binding)
    }

    /// Whether a specialisation constant of a program is one of the group's.
    pub(crate) fn owns_constant(&self, constant: &Constant) -> bool {
        self.constants.iter().any(|known| known.id == constant.id)
    }

    /// Checks what one stage of `program` declares: with the group's numbers nothing but what it has from the group. `included`: whether it
    /// includes the group's file.
    pub(crate) fn check(&self, program: &str, stage: &Stage, included: bool) -> Result<(), String> {
        let intrusion = |name: &str, what: &str, number: u32| {
            format!(
                "glsl/{program} declares {name} itself, with {what} {number}, which {} has for its own",
                path(&self.name)
            )
        };
        for binding in stage.declared_bindings.iter().filter(|binding| binding.set == SET) {
            let member = included && self.members.contains(binding);
            if holds(&self.ranges.bindings, binding.binding) && !member {
                return Err(intrusion(&binding.name, "binding", binding.binding));
            }
        }
        for constant in &stage.declared_constants {
            let member = included && self.constants.contains(constant);
            if holds(&self.ranges.constants, constant.id) && !member {
                return Err(intrusion(&constant.name, "constant", constant.id));
            }
        }
        Ok(())
    }
}
