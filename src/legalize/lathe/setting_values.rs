//! What cycles need of the target's settings, over a whole library.
//!
//! Law: a setting is one value while a run lasts. Side conditions: a person may set it anew between two programs that no run goes through
//! both of; and how far the passes of a roughed contour go back changes no cut, so a person looks at the room that there is. Counter-example:
//! a groove that goes back by 0.5 and one that goes back by 1, in a program and one that it calls.

use super::cycle_values::setting_named;
use super::left_settings::{self, Left};
use crate::assume::Predicate;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::features::Feature;
use crate::text::Span;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What is found: where, what, what to do, and what comes of it.
pub(super) type Found = Vec<(Span, String, String, So)>;

/// What comes of something that is found.
pub(super) enum So {
    /// The cycle is refused.
    Refused,
    /// It is refused, because the source's profile does not state this setting.
    Lacks(Arc<str>),
    /// Moves are written in the place of the cycle.
    Noted,
    /// A person must look at it.
    Open,
    /// The conversion supposes something.
    Supposed(Predicate),
    /// The target's machine says it: told once for the library.
    Left(Left),
}

/// Tells what was found in the programs of a library, each with its index; `calls` are its callers with what each calls.
pub(super) fn tell(
    found: Vec<(usize, Found)>,
    calls: &[(usize, usize)],
    module: &Module,
    context: &mut Context<'_>,
) {
    let runs = OnceCell::new();
    let mut values: BTreeMap<Arc<str>, Vec<(f64, usize)>> = BTreeMap::new();
    let left = left_settings::told(&found, context.target);
    for (index, found) in found {
        for (span, mut what, mut help, mut so) in found {
            let stated = match &so {
                So::Supposed(Predicate::Setting(name, _)) if is_way_back(name, context.target) => {
                    context.target.setting(name).map(str::to_owned)
                }
                _ => None,
            };
            if let (So::Supposed(Predicate::Setting(name, value)), Some(stated)) = (&so, stated) {
                // Another cycle of the program may need what the profile says.
                (what, help) = another_way_back((name, *value), &stated, "the profile says");
                so = So::Open;
            } else if let So::Supposed(
                Predicate::Setting(name, value) | Predicate::TurnedSetting(name, value),
            ) = &so
            {
                let known = values.entry(name.clone()).or_default();
                let other = |(first, _): &&(f64, usize)| first.to_bits() != value.to_bits();
                // A value that this program itself needs otherwise counts before one of another.
                let own = known.iter().filter(other).find(|(_, program)| *program == index);
                let clash = own.or_else(|| known.iter().find(other)).copied();
                if !known.contains(&(*value, index)) {
                    known.push((*value, index));
                }
                // How long threads run out is left, and the first value says that they do.
                let is_left =
                    *value > 0.0 && is_run_out(name, context.target) && left_settings::leaves(context.target);
                if let Some((first, program)) = clash.filter(|(first, _)| !(is_left && *first > 0.0)) {
                    let is_own = program == index;
                    let is_one_run = || {
                        runs.get_or_init(|| Runs::of(module, calls, context.features.has(Feature::Chain)))
                            .goes_through([program, index])
                    };
                    let together = is_own || is_one_run();
                    let goes_back = together && is_way_back(name, context.target);
                    let other = (first, (!is_own).then_some(program));
                    (what, help) = if goes_back {
                        another_way_back((name, *value), &first.to_string(), "a cycle before needs")
                    } else {
                        two_values((name, *value), other, module)
                    };
                    if goes_back {
                        so = So::Open;
                    } else if together {
                        so = So::Refused;
                    }
                }
            }
            if let So::Left(one) = &so
                && let Some((what, help)) = left.get(&one.what)
            {
                let told = Diagnostic::new(Code::Conditional, span, what.as_str()).with_help(help.clone());
                let told = told.assuming(Predicate::OfMachine(one.what)).asked_once();
                context.add_once(index, what, told);
                continue;
            }
            let code = match so {
                So::Supposed(_) | So::Open | So::Left(_) => Code::Conditional,
                So::Noted => Code::CycleWrittenOut,
                So::Refused | So::Lacks(_) => Code::NoEquivalent,
            };
            let finding = Diagnostic::new(code, span, what.as_str());
            let finding = if help.is_empty() { finding } else { finding.with_help(help) };
            let finding = match &so {
                So::Noted => finding.lacking_there(MACHINE),
                So::Supposed(predicate) if left_settings::may_be_left(predicate, context.target) => {
                    finding.lacking_there(MACHINE)
                }
                _ => finding,
            };
            match so {
                So::Supposed(predicate) => context.add_once(index, &what, finding.assuming(predicate)),
                So::Lacks(setting) => context.add(index, finding.lacking(setting)),
                So::Noted | So::Open | So::Left(_) => context.add_once(index, &what, finding),
                So::Refused => context.add(index, finding),
            }
        }
    }
}

/// The programs that a run may go through, by the program that it begins with.
struct Runs(Vec<BTreeSet<usize>>);

impl Runs {
    /// A run begins with any program that nothing in the library calls. Those of them that return are called by what is not in the
    /// library, which may call several.
    fn of(module: &Module, calls: &[(usize, usize)], chains: bool) -> Self {
        let mut callees = vec![BTreeSet::new(); module.programs.len()];
        for (caller, callee) in calls {
            callees[*caller].insert(*callee);
        }
        let reach = |first: &mut dyn Iterator<Item = usize>| {
            let (mut work, mut seen): (Vec<usize>, BTreeSet<usize>) = (first.collect(), BTreeSet::new());
            while let Some(program) = work.pop() {
                if seen.insert(program) {
                    work.extend(&callees[program]);
                }
            }
            seen
        };
        if chains {
            return Self(vec![(0..module.programs.len()).collect()]);
        }
        let called: BTreeSet<usize> = callees.iter().flatten().copied().collect();
        let is_called_outside = |at: &usize| !called.contains(at) && module.programs[*at].returns();
        let all = 0..module.programs.len();
        let mut runs: Vec<BTreeSet<usize>> = all.clone().map(|at| reach(&mut std::iter::once(at))).collect();
        runs.push(reach(&mut all.filter(is_called_outside)));
        Self(runs)
    }

    /// True if some run may go through both.
    fn goes_through(&self, both: [usize; 2]) -> bool {
        self.0.iter().any(|run| both.iter().all(|program| run.contains(program)))
    }
}

/// True for how far the passes of a roughed contour go back.
fn is_way_back(name: &str, target: &Control) -> bool {
    target.setting_row(name).is_some_and(|row| {
        row.gives == Some(Role::CutRetract)
            && row.cycles.iter().all(|op| matches!(op, Op::RoughTurning | Op::RoughFacing))
    })
}

/// The answer that lets a cycle stay with the settings of its machine.
const MACHINE: &str = "behaviour.cycle.settings=machine";

/// True for how long threads run out.
fn is_run_out(name: &str, target: &Control) -> bool {
    target.setting_row(name).is_some_and(|row| row.gives.or(row.otherwise) == Some(Role::ThreadRunOut))
}

/// What is said of another way back than the target's; `who` says that the target goes back so.
fn another_way_back((name, value): (&str, f64), there: &str, who: &str) -> (String, String) {
    let (kind, number) = setting_named(name);
    let what = format!(
        "the passes of this cycle go back by {value} on the source and by {there} on the target, as {who}: no program can change {kind} {number}"
    );
    let help = format!(
        "look whether the tool has that much room, most of all in a bore; or set it to {value} before the program is run, if all its cycles need that"
    );
    (what, help)
}

/// What is said where moves take the place of a cycle, and what to do to keep the cycle.
pub(super) type Instead = (String, String);

/// The same, for a setting that the cycle needs with a value, and what the profile says of it.
pub(super) fn written((name, value): (&str, f64), stated: Option<&str>, title: &str) -> Instead {
    let (kind, number) = setting_named(name);
    let now = stated.map_or("a cycle before needs another value".to_owned(), |stated| {
        format!("the profile of the {title} says {stated}")
    });
    let what = format!(
        "this cycle needs {kind} {number} to be {value}, and {now}: its moves are written out in its place"
    );
    let help = match stated {
        Some(_) => format!(
            "to keep the cycle, set it so on the machine, and write in its profile, under [{kind}s]: {number} = \"{value}\"; or, if what the machine is set \
             to is right for its cycles, under [behaviours]: \"cycle.settings\" = \"machine\""
        ),
        None => "to keep the cycle, give both cycles the same value".to_owned(),
    };
    (what, help)
}

/// What is said of a second value: the first one, and the program that needs it, where that is another one.
fn two_values(
    (name, value): (&str, f64),
    (first, other): (f64, Option<usize>),
    module: &Module,
) -> (String, String) {
    let (kind, number) = setting_named(name);
    let Some(other) = other else {
        let what = format!(
            "{kind} {number} must be {value} here, and {first} for a cycle before: a program cannot change it"
        );
        return (what, "give both cycles the same value, or make two programs of them".into());
    };
    let program = module.programs.get(other).and_then(|program| program.name.as_ref());
    let program = program.map_or_else(|| "another program".to_owned(), ToString::to_string);
    let what = format!(
        "{kind} {number} must be {value} while this program runs, and {first} while {program} runs: it has one value at a time"
    );
    (what, "give the cycles of both the same value, or set it anew before each of the two is run".into())
}
