//! A program as those of its library call it.
//!
//! Its callers give a program its arguments and the modes it runs in, and a conversion may rest on that. Run by
//! itself, in circumstances that no caller makes, it may then do something else. That is no fault only where the
//! callers' runs come to the very place and do the same; and never more than undecided, because runs show what
//! callers give, not that they never give anything else.

use super::assumed::{excuse, tried};
use super::stops::stops_by_itself;
use crate::control::{ProgramRef, Run};
use crate::text::Span;
use crate::verify::compare::{Tolerance, compare, is_cut};
use crate::verify::entry::{is_root, scenarios};
use crate::verify::explore::on_target;
use crate::verify::sides::{EntryState, Job};
use std::collections::{BTreeMap, BTreeSet};

/// A block of a library: its file and place.
pub type Spot = (usize, Span);

/// Where a difference showed itself.
#[derive(Debug, Default)]
pub struct Shown {
    /// The blocks on both sides; none if that side did nothing more.
    pub source: Option<Spot>,
    /// The block of the target.
    pub target: Option<Spot>,
    /// The ways that branches of the program went in that run.
    pub ways: BTreeSet<(Spot, i64)>,
}

/// Runs of all callers together, and the fewest of each.
const RUNS: usize = 240;
const FEWEST: usize = 12;

/// What the runs that come through a program show of it.
#[derive(Debug, Default)]
pub struct Through {
    /// The programs that such runs begin in.
    pub callers: BTreeSet<String>,
    /// How many of them came to the place in question.
    pub reached: usize,
    /// Ways to the difference that none of them went.
    pub untried: usize,
    /// True where one of them did something else.
    pub differs: bool,
    /// Programs that call it and have no conversion to run.
    pub absent: BTreeSet<String>,
    /// True where a run came through it.
    pub entered: bool,
    /// True where a control stopped one of them, or an assumption excuses what it did.
    pub open: bool,
}

impl Through {
    /// True where something calls the program, and no such run could show what it does then.
    pub fn is_alone(&self, given: &EntryState) -> bool {
        let called = self.entered || given.never_come_to || !self.absent.is_empty();
        called && !self.differs && self.reached == 0
    }

    /// True where runs came through the program, and did the same.
    pub fn does_the_same(&self) -> bool {
        self.entered && !self.differs && !self.callers.is_empty()
    }

    /// The same where everything that calls the program could be run, and every run shows something.
    pub fn shows_all(&self) -> bool {
        self.does_the_same() && self.absent.is_empty() && !self.open
    }

    /// True where runs came through the program, and the control stopped each of them.
    pub fn is_stopped(&self) -> bool {
        self.entered && !self.differs && self.callers.is_empty()
    }

    /// True where no run came through the program, and something that calls it has no conversion to run.
    pub fn is_absent(&self) -> bool {
        !self.entered && !self.differs && !self.absent.is_empty()
    }

    /// Why a difference that shows by itself is none as the library calls the program, in words; none if
    /// nothing says so.
    pub fn excuses(&self) -> Option<String> {
        if self.differs || self.reached == 0 || self.untried > 0 {
            return None;
        }
        let list = |all: &BTreeSet<String>| all.iter().cloned().collect::<Vec<_>>().join(", ");
        let mut text = format!(
            "it does the same in {} runs that reach this place from {}; these callers may still give it \
             something else",
            self.reached,
            list(&self.callers)
        );
        if !self.absent.is_empty() {
            text += &format!(", and {}, which also calls it, could not be run", list(&self.absent));
        }
        Some(text)
    }
}

/// Runs what calls a program, and looks at the runs that come through it to where it showed a difference.
pub fn through(job: &Job<'_>, program: ProgramRef, shown: &Shown, tolerance: Tolerance) -> Through {
    let mut found = Through::default();
    let mut gone = BTreeSet::new();
    let links = job.source.links();
    let all = links.programs();
    let has_target = |caller: &ProgramRef| job.names.program(job.source, *caller, job.target).is_some();
    for caller in all.iter().filter(|caller| **caller != program && !has_target(caller)) {
        if links.callees(*caller).contains(&program) {
            found.absent.insert(name(job, *caller));
        }
    }
    let reaches = |caller: &ProgramRef| *caller != program && links.may_reach(*caller, program);
    let callers = || all.iter().filter(|caller| reaches(caller) && is_root(job, caller));
    let runs = (RUNS / callers().count().max(1)).max(FEWEST);
    for caller in callers() {
        let Some(there) = job.names.program(job.source, *caller, job.target) else {
            if scenarios(job, *caller, FEWEST).any(|(_, run)| links.enters(&run, program)) {
                found.absent.insert(name(job, *caller));
            }
            continue;
        };
        for (at, (scenario, run)) in scenarios(job, *caller, runs).enumerate() {
            if !links.enters(&run, program) {
                // One that never comes through it in its first runs is none of its callers.
                if at >= FEWEST && !found.callers.contains(&name(job, *caller)) {
                    break;
                }
                continue;
            }
            found.entered = true;
            let sides = (job.source, job.target);
            let circumstances = on_target((&scenario, &run), job.names, sides, (false, &BTreeMap::new()));
            let other = job.target.run(there, &circumstances);
            let compared = compare((job.source, &run), (job.target, &other), job.names, tolerance);
            let cut = is_cut(&run) || is_cut(&other);
            match compared.difference.or(compared.hair) {
                // Where a control stops the run, nothing is shown.
                Some(difference)
                    if stops_by_itself(&run, &difference)
                        || excuse(&tried(job, &run, &other), &run, &other, &difference).is_some() =>
                {
                    found.open = true;
                }
                Some(_) => {
                    found.differs = true;
                    return found;
                }
                None if !cut => {
                    found.callers.insert(name(job, *caller));
                    let came = comes_to(&run, shown.source) && comes_to(&other, shown.target);
                    found.reached += usize::from(came);
                    gone.extend(ways(&run, program.file));
                }
                None => {}
            }
        }
    }
    found.untried = shown.ways.difference(&gone).count();
    found
}

/// The ways that the branches of a file went in a run.
pub fn ways(run: &Run, file: usize) -> impl Iterator<Item = (Spot, i64)> + '_ {
    let here = move |at: u32| run.programs.get(at as usize).is_some_and(|program| program.file == file);
    let branches = run.branches.iter().filter(move |(branch, _)| here(branch.at.program));
    branches.flat_map(move |(branch, ways)| ways.iter().map(move |way| ((file, branch.at.span), *way)))
}

/// True where something happened in a block, or none is asked for.
fn comes_to(run: &Run, spot: Option<Spot>) -> bool {
    let file = |at: u32| run.programs.get(at as usize).map(|program| program.file);
    spot.is_none_or(|(there, span)| {
        run.events.iter().any(|event| event.at.span == span && file(event.at.program) == Some(there))
    })
}

fn name(job: &Job<'_>, program: ProgramRef) -> String {
    match job.source.name(program) {
        Some(name) => name.to_string(),
        None => job.source.files.get(program.file).map_or_else(String::new, |file| file.name.to_owned()),
    }
}
