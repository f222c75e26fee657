//! Variables whose number is computed, where numbers mean other things on the target.
//!
//! Law: such a variable stays as it is where both controls mean the same by every number that it may have; in a
//! run of system variables that the target keeps elsewhere in the same order, the distance is added; in a run of
//! one state that it keeps otherwise, the variable becomes that state, counted as its numbers are. What the number may
//! be is followed from where it is assigned. Side condition, for a reviewer, where that leaves it open: the number stays
//! in the run in which its constant part lies, and is none of the registers that the conversion took for itself.
//! Counter-example: `#[2000+#1]` with `#1` = 3 is a length offset on one control and a wear on another.

mod alike;
mod found;
mod meaning;
mod near;
mod numbers;
mod shared;
mod shift;
mod told;
mod written;

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Side};
use crate::ir::analysis::{self, Assigned, Ranges, Summaries, Values};
use crate::ir::{Bank, Expr, Module, Program, Var, constant_part};
use crate::legalize::Context;
use crate::legalize::by_program::look_with;
use crate::legalize::variables::banks::{all_numbers, each_index};
use crate::legalize::variables::state::additional;
use crate::text::Span;
use found::Found;
use numbers::{Numbers, Table};
use shared::Shared;
use shift::shift;
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
pub(in crate::legalize) use written::Written;

/// Computed numbers are followed for so many of a program; others are not known.
const MOST_LOOKED_UP: usize = 500;

/// What computed numbers of a library reach.
#[derive(Debug, Default)]
pub struct Reached {
    /// Numbers that some are known to be: no register is taken there.
    pub sure: analysis::Numbers,
    /// What is supposed of the others, by program.
    open: Vec<(usize, Found)>,
    /// Blocks of variables that those of which nothing is supposed are counted from.
    near: analysis::Numbers,
    /// What both controls mean by each number, once it is known.
    table: Table,
}

impl Reached {
    /// Numbers that any of the others are supposed to be.
    pub(in crate::legalize) fn everything(&self, source: &Control, target: &Control) -> analysis::Numbers {
        let mut all = self.supposed();
        if self.open.iter().any(|(_, found)| found.finding == Finding::Any) {
            all.join(Numbers::new(source, target, self.table.clone()).list());
        }
        all
    }

    /// Numbers that some are supposed to be, or are counted from: registers are taken elsewhere, where there are any.
    pub fn supposed(&self) -> analysis::Numbers {
        let mut all = analysis::Numbers::of(self.open.iter().filter_map(|(_, found)| found.finding.run()));
        all.join(&self.near);
        all
    }
}

/// Shifts computed numbers, and notes what they may be; gives the programs in which any is shifted.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> Vec<usize> {
    let (source, target, table) = (context.source, context.target, Table::default());
    let numbers = || Numbers::new(source, target, table.clone());
    let summaries = context.summaries(module);
    let summaries = &*summaries;
    // That none is in force is asked where it is read which is.
    let standard = !additional::may_select(module, context);
    let shared = Shared::of(module, summaries);
    let look = |numbers: &mut Numbers<'_>, index: usize, program: &Program| {
        Looked::at((index, program), summaries, (standard, &shared), numbers)
    };
    let all = look_with(module, numbers, look);
    let mut reached = Reached { table: table.clone(), ..Reached::default() };
    let mut moving: Vec<usize> = Vec::new();
    let mut unbounded: Vec<(usize, Expr)> = Vec::new();
    for (index, looked) in all.into_iter().enumerate() {
        looked.tell(index, context);
        looked.rests.iter().for_each(|(var, span)| shared.tell(index, *span, *var, context));
        reached.sure.join(&looked.sure);
        reached.open.extend(looked.open.into_iter().map(|found| (index, found)));
        unbounded.extend(looked.unbounded.into_iter().map(|number| (index, number)));
        moving.extend(looked.moves.then_some(index));
    }
    reached.near = near::blocks(module, &unbounded, source);
    context.reached = reached;
    let mut numbers = numbers();
    moving.into_iter().filter(|index| shift(&mut module.programs[*index], &mut numbers)).collect()
}

/// What was found in one program.
#[derive(Default)]
struct Looked {
    /// Numbers that some are known to be.
    sure: analysis::Numbers,
    /// What is supposed of the others.
    open: Vec<Found>,
    /// Those of which nothing is known.
    unbounded: Vec<Expr>,
    /// All that is known of any, with its place.
    known: Vec<(Finding, Span)>,
    /// The shared variables that it rests on, with the first place of each.
    rests: BTreeMap<Var, Span>,
    /// True where the target has some elsewhere.
    moves: bool,
}

impl Looked {
    fn at(
        (index, program): (usize, &Program),
        summaries: &Summaries,
        (standard, shared): (bool, &Shared),
        numbers: &mut Numbers<'_>,
    ) -> Self {
        let mut looked = Self::default();
        let ranges = LazyCell::new(|| Ranges::of_offsets(program, summaries, standard));
        let assigned = Assigned::new(program, summaries);
        // Numbers that others in the same block are known to be: they are no strays.
        let mut known: Vec<(Span, analysis::Numbers)> = Vec::new();
        let mut looked_up = 0;
        each_index(program, &mut |bank, number, span, id, at| {
            if bank != Bank::Numbered {
                return;
            }
            looked_up += 1;
            // A plain variable is looked up with the literals that stand at the head.
            let constants = match number {
                Expr::Var(var) if looked_up <= MOST_LOOKED_UP / 10 => {
                    assigned.at(*var, id, at).and_then(all_numbers)
                }
                _ => None,
            };
            let (may_be, exact) = match constants {
                Some(constants) => (constants, true),
                None if looked_up > MOST_LOOKED_UP => (Values::ANY.numbers(), false),
                None => {
                    let mut rests = BTreeSet::new();
                    let other = |var: Var| ranges.at(id, at, &Expr::Var(var));
                    let held = shared.number((index, id, at), number, &other, &mut rests);
                    rests.into_iter().for_each(|var| _ = looked.rests.entry(var).or_insert(span));
                    let values = held.unwrap_or_else(|| ranges.at(id, at, number));
                    (values.numbers(), matches!(values, Values::Few(_)))
                }
            };
            looked.moves |= numbers.of(number).moves();
            let (finding, sure) = numbers.judge(number, &may_be, exact);
            if sure {
                looked.sure.join(&may_be);
                known.push((span, may_be));
            }
            let Some(finding) = finding else { return };
            looked.known.push((finding.clone(), span));
            if !sure && finding == Finding::Any && !looked.unbounded.contains(number) {
                looked.unbounded.push(number.clone());
            }
            if !sure && !matches!(finding, Finding::Other(_)) {
                Found::note(&mut looked.open, finding, span, constant_part(number).unwrap_or_default());
            }
        });
        for found in &mut looked.open {
            let here = known.iter().filter(|(span, _)| found.places.contains(span));
            here.for_each(|(_, numbers)| found.sure.join(numbers));
        }
        looked
    }

    /// Says what the program rests on, and what it may not have.
    fn tell(&self, index: usize, context: &mut Context<'_>) {
        for (finding, span) in &self.known {
            finding.rest_on_rows(index, *span, context);
            let Finding::Other(number) = finding else { continue };
            // `#[2400+#1]` means the run from #2401.
            let near = [*number, number.saturating_add(1)].into_iter();
            let space = context.source.numbered().unwrap_or_default();
            let under = near.filter_map(|at| Some((at, context.source.system_under(space, at)?))).next();
            let told = match under {
                Some((at, (setting, value, stated))) => {
                    let short = setting.split_once('.').map_or(setting, |(_, short)| short);
                    let at = named(context.source, at.into());
                    let what = format!(
                        "the number of a variable is computed and starts from {at}, which the machine has only where {short} \
                         is {value}"
                    );
                    let help = "look at the machine, and write its value into its profile";
                    let told = Diagnostic::new(Code::NoEquivalent, *span, what).with_help(help);
                    if stated { told } else { told.lacking(format!("{setting}={value}")) }
                }
                None => {
                    let (code, what) = finding.told(context, &analysis::Numbers::default(), &[]);
                    Diagnostic::new(code, *span, what)
                }
            };
            let what = told.message.clone();
            context.add_once(index, &what, told);
        }
    }
}

/// Says what is supposed of computed numbers, now that registers are taken.
pub fn report(_: &Module, context: &mut Context<'_>) {
    let reached = std::mem::take(&mut context.reached);
    if reached.open.is_empty() {
        return;
    }
    let numbers = Numbers::new(context.source, context.target, reached.table);
    let alike = numbers.all_alike();
    let taken: Vec<u32> = context.registers.taken().collect();
    // Programs suppose few things, again and again.
    let mut known: Vec<(Finding, Supposed)> = Vec::new();
    for (index, found) in reached.open {
        let at = known.iter().position(|(finding, _)| *finding == found.finding).unwrap_or_else(|| {
            let supposed = found.finding.supposed(&numbers);
            let safe = supposed.without(taken.iter().copied());
            let mut hits: Vec<u32> =
                taken.iter().copied().filter(|number| supposed.contains(*number)).collect();
            hits.sort_unstable();
            hits.dedup();
            let hit = !hits.is_empty();
            let (code, what) = found.finding.told(context, &safe, &hits);
            known.push((found.finding.clone(), Supposed { safe, hit, code, what: what.into() }));
            known.len() - 1
        });
        let (_, Supposed { safe, hit, code, what }) = &known[at];
        if alike && !hit {
            continue;
        }
        let span = found.places.first().copied().unwrap_or_default();
        let told = Diagnostic::new(*code, span, what.clone()).assuming(found.predicate(safe));
        // `#[2000+#1]` is a row of a table: how many rows both machines have is one question for all programs.
        let is_row = match found.finding {
            Finding::Shifted(..) | Finding::Counted(..) => true,
            Finding::Alike(first, last) => !hit && is_table(context.source, first, last),
            _ => false,
        };
        context.add_once(index, what, if is_row { told.asked_once() } else { told });
    }
}

/// What is supposed of a computed number, now that registers are taken.
struct Supposed {
    /// The numbers that it must be one of.
    safe: analysis::Numbers,
    /// True where registers were taken among them.
    hit: bool,
    code: Code,
    what: Arc<str>,
}

/// What is known of a computed number.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::legalize) enum Finding {
    /// It starts in these numbers, by each of which both controls mean the same.
    Alike(u32, u32),
    /// It starts in this run of a state, to whose numbers this is added.
    Shifted(Sys, u32, u32, i64),
    /// It starts in this run of a state, whose first number has this count.
    Counted(Sys, u32, u32, u32),
    /// It may be this number, which the target uses for something else, or not at all.
    Other(u32),
    /// Nothing.
    Any,
}

impl Finding {
    /// Says which of the rows that hold these numbers nobody confirmed.
    fn rest_on_rows(&self, index: usize, span: Span, context: &mut Context<'_>) {
        let (here, there) = match *self {
            Finding::Alike(first, _) => (first, Some(first)),
            Finding::Shifted(_, first, _, by) => (first, u32::try_from(i64::from(first) + by).ok()),
            Finding::Counted(_, first, ..) => (first, None),
            _ => return,
        };
        context.rests_on_number(Side::Source, index, span, here);
        there.into_iter().for_each(|number| context.rests_on_number(Side::Target, index, span, number));
    }

    /// True where the target has such numbers elsewhere.
    fn moves(&self) -> bool {
        matches!(self, Finding::Shifted(..) | Finding::Counted(..))
    }

    /// The run that it must stay in.
    fn run(&self) -> Option<(u32, u32)> {
        match *self {
            Finding::Alike(first, last)
            | Finding::Shifted(_, first, last, _)
            | Finding::Counted(_, first, last, _) => Some((first, last)),
            Finding::Any | Finding::Other(_) => None,
        }
    }

    /// The numbers that it must be one of, were there no registers among them.
    fn supposed(&self, numbers: &Numbers<'_>) -> analysis::Numbers {
        match self {
            Finding::Any => numbers.list().clone(),
            other => analysis::Numbers::of(other.run()),
        }
    }
}

/// True where all these numbers are the system's, and the first is a row of a table that is counted.
fn is_table(source: &Control, first: u32, last: u32) -> bool {
    let counted = |number: u32| {
        source.numbered_state(number).is_some_and(|(.., row)| {
            matches!(row.subscripts.as_slice(), [one] if one.step == 1 && !one.axis && one.count > 1)
        })
    };
    counted(first) && counted(last) && (first..=last).all(|number| source.numbered_class(number).is_none())
}

/// A variable of the space that computed numbers reach, as the control writes it.
fn named(control: &Control, number: i64) -> String {
    format!("{}{number}", control.numbered().unwrap_or_default())
}
