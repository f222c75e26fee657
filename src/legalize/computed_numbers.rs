//! Variables whose number is computed, where numbers mean other things on the target.
//!
//! Law: such a variable stays as it is where both controls mean the same by every number that it may have; in a
//! run of system variables that the target keeps elsewhere in the same order, the distance is added; in a run of
//! one state that it keeps otherwise, the variable becomes that state, counted as its numbers are. Side
//! condition, for a reviewer: the number stays in the run in which its constant part lies.
//! Counter-example: `#[2000+#1]` with `#1` = 3 is a length offset on one control and a wear on another.

use super::banks::{all_numbers, each_index};
use super::{Context, rewrite_program};
use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Side, SystemVariable};
use crate::ir::analysis::{Summaries, values_at};
use crate::ir::eval::whole;
use crate::ir::{Bank, BinOp, Expr, Module, Place, Program, StmtKind};
use crate::text::Span;
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};

/// Values of plain variables are looked up for so many computed numbers of a program; others are not known.
const MOST_LOOKED_UP: usize = 50;

/// Checks and shifts computed numbers.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut numbers = Numbers::new(context.source, context.target);
    if numbers.all_alike() {
        return false;
    }
    look(module, &mut numbers, context);
    let moves = |finding: &Finding| matches!(finding, Finding::Shifted(..) | Finding::Counted(..));
    let shifts = numbers.known.values().any(moves);
    if shifts {
        module.programs.iter_mut().for_each(|program| shift(program, &mut numbers));
    }
    shifts
}

fn look(module: &Module, numbers: &mut Numbers<'_>, context: &mut Context<'_>) {
    let summaries = LazyCell::new(|| Summaries::of(module));
    let mut all_found: Vec<Vec<(Span, Finding)>> = Vec::new();
    // Numbers that others are known to be: the verifier must not take them for strays.
    let mut sure: BTreeSet<u32> = BTreeSet::new();
    for program in &module.programs {
        let mut found: Vec<(Span, Finding)> = Vec::new();
        let mut looked_up = 0;
        each_index(program, &mut |bank, number, span, id, at| {
            if bank != Bank::Numbered {
                return;
            }
            looked_up += 1;
            let known = match number {
                Expr::Var(var) if looked_up <= MOST_LOOKED_UP => {
                    values_at(program, &summaries, *var, id, at).and_then(all_numbers)
                }
                _ => None,
            };
            let finding = match known {
                Some(all) => {
                    sure.extend(&all);
                    all.into_iter().find(|n| !numbers.alike(*n)).map(Finding::Other)
                }
                None => Some(numbers.of(number).clone()),
            };
            if let Some(finding) = finding
                && found.iter().all(|(_, other)| *other != finding)
            {
                found.push((span, finding));
            }
        });
        all_found.push(found);
    }
    let sure: String = sure.into_iter().map(|number| format!(", #{number}")).collect();
    for (index, found) in all_found.into_iter().enumerate() {
        for (span, finding) in found {
            let fact = finding.fact(numbers).map(|fact| fact + &sure);
            finding.rest_on_rows(index, span, context);
            let (code, what) = finding.told(context, numbers);
            let told = Diagnostic { fact: fact.map(Into::into), ..Diagnostic::new(code, span, what.clone()) };
            context.add_once(index, &what, told);
        }
    }
}

/// Numbers of axes repeat at this distance.
const GAP: u32 = 20;

/// What is known of a computed number.
#[derive(Clone, Debug, PartialEq)]
enum Finding {
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

    /// The numbers that it must be one of, as the verifier is told them.
    fn fact(&self, numbers: &Numbers<'_>) -> Option<String> {
        match self {
            Finding::Alike(first, last)
            | Finding::Shifted(_, first, last, _)
            | Finding::Counted(_, first, last, _) => Some(format!("numbers:#{first}-#{last}")),
            Finding::Any => Some(format!("numbers:{}", numbers.list())),
            Finding::Other(_) => None,
        }
    }

    fn told(self, context: &Context<'_>, numbers: &Numbers<'_>) -> (Code, String) {
        let title = &context.target.dialect().title;
        match self {
            Finding::Alike(first, last) => (
                Code::Conditional,
                must_stay(first, last)
                    + &format!(", outside of which numbers mean other variables on {title}"),
            ),
            Finding::Shifted(state, first, last, by) => {
                let there = |n: u32| i64::from(n) + by;
                (
                    Code::Conditional,
                    format!(
                        "{} ('{state}'), which are #{} to #{} on {title}",
                        must_stay(first, last),
                        there(first),
                        there(last)
                    ),
                )
            }
            Finding::Counted(state, first, last, _) => {
                (Code::Conditional, format!("{} ('{state}')", must_stay(first, last)))
            }
            Finding::Other(number) => (
                Code::NoEquivalent,
                format!(
                    "the number of a variable is computed, and #{number}, which it starts from or may be, is not the same variable on {title}"
                ),
            ),
            Finding::Any => (
                Code::Conditional,
                format!(
                    "which variable is meant is known only when the program runs: it must be one of {}, which mean the same on {title}",
                    numbers.list()
                ),
            ),
        }
    }
}

fn must_stay(first: u32, last: u32) -> String {
    format!("the number of a variable is computed: it must stay in #{first} to #{last}")
}

/// What a number means.
#[derive(PartialEq)]
enum Meaning {
    Local,
    Shared,
    State(Sys, Vec<u32>),
}

fn meaning(control: &Control, number: u32) -> Option<Meaning> {
    if let Some(row) = control.variable_class("#", number) {
        return Some(if row.class == "local" { Meaning::Local } else { Meaning::Shared });
    }
    control.read_system("#", Some(number)).map(|(state, subscripts, _)| Meaning::State(state, subscripts))
}

/// What both controls mean by the numbers of variables.
struct Numbers<'c> {
    source: &'c Control,
    target: &'c Control,
    /// By number: true where both mean the same, none where neither means anything.
    alike: Vec<Option<bool>>,
    /// By the constant part of a number.
    known: BTreeMap<u32, Finding>,
}

impl<'c> Numbers<'c> {
    fn new(source: &'c Control, target: &'c Control) -> Self {
        let same = |number: u32| {
            let (here, there) = (meaning(source, number), meaning(target, number));
            let access = |control: &'c Control| {
                control.read_system("#", Some(number)).map_or("", |(.., row)| row.access.as_str())
            };
            match &here {
                None if there.is_none() => None,
                Some(Meaning::State(Sys::Other, _)) if source.name() != target.name() => Some(false),
                Some(Meaning::State(..)) => {
                    Some(here == there && access(source).chars().all(|c| access(target).contains(c)))
                }
                _ => Some(here == there && !target.is_reserved("#", number)),
            }
        };
        let alike = (0..=last_number(source)).map(same).collect();
        Self { source, target, alike, known: BTreeMap::new() }
    }

    fn alike(&self, number: u32) -> bool {
        self.alike.get(number as usize).copied().flatten().unwrap_or(false)
    }

    /// True where no number of the source means another thing on the target.
    fn all_alike(&self) -> bool {
        let has = |number: usize| meaning(self.source, number as u32).is_some();
        self.alike.iter().enumerate().all(|(number, alike)| *alike != Some(false) || !has(number))
    }

    /// What is known of a computed number by its constant part: the run that it lies in, or that begins behind it.
    fn of(&mut self, number: &Expr) -> &Finding {
        let start = constant_part(number).filter(|start| *start >= 100.0);
        let start = start.and_then(whole);
        let key = start.unwrap_or(0);
        if !self.known.contains_key(&key) {
            let finding = start.map_or(Finding::Any, |start| self.look_up(start));
            self.known.insert(key, finding);
        }
        self.known.get(&key).unwrap_or(&Finding::Any)
    }

    fn look_up(&self, start: u32) -> Finding {
        // People count from 1: `#[2400+#1]` means the run from #2401, though #2400 ends another.
        let behind = start.saturating_add(1);
        let first = match (self.begins(start), self.begins(behind)) {
            (None, None) => return Finding::Other(start),
            (None, _) | (Some(false), Some(true)) => behind,
            _ => start,
        };
        if self.alike(first) {
            let around = self.runs().into_iter().find(|(from, to)| (*from..=*to).contains(&first));
            return around.map_or(Finding::Any, |(from, to)| Finding::Alike(from, to));
        }
        self.distance(first).or_else(|| self.counted(first)).unwrap_or(Finding::Other(first))
    }

    /// The run of a state that is counted by one number.
    fn counted(&self, number: u32) -> Option<Finding> {
        let (state, _, row) =
            self.source.read_system("#", Some(number)).filter(|(state, ..)| *state != Sys::Other)?;
        let (first, last) = (row.first?, row.last()?);
        match row.subscripts.as_slice() {
            [one] if one.step == 1 && !one.axis => Some(Finding::Counted(state, first, last, one.from)),
            _ => None,
        }
    }

    /// True for the first number of a run, false for another one in it; none outside of all.
    fn begins(&self, number: u32) -> Option<bool> {
        if let Some(row) = self.source.variable_class("#", number) {
            return Some(row.first == number);
        }
        self.source.read_system("#", Some(number)).map(|(.., row)| row.first == Some(number))
    }

    /// The run of a state as far as the target has it at one distance.
    fn distance(&self, number: u32) -> Option<Finding> {
        let (state, _, row) = self.source.read_system("#", Some(number))?;
        let (first, last) = (row.first?, row.last()?);
        let distance = |number: u32| {
            let (name, there, found) = self.target.system_address(state, &row.subscripts_of(number)?)?;
            let fits = name == "#" && row.access.chars().all(|c| found.access.contains(c));
            Some(i64::from(there.filter(|_| fits)?) - i64::from(number))
        };
        let by = distance(first)?;
        let inside = |number: &u32| row.subscripts_of(*number).is_some();
        let reached =
            (first..=last).filter(inside).take_while(|number| distance(*number) == Some(by)).last()?;
        (number <= reached).then_some(Finding::Shifted(state, first, reached, by))
    }

    /// Runs of numbers that mean the same, over gaps that stand for axes that are not there.
    fn runs(&self) -> Vec<(u32, u32)> {
        let mut runs: Vec<(u32, u32)> = Vec::new();
        let mut broken = true;
        for (number, alike) in (0..).zip(&self.alike).skip(1) {
            match (alike, runs.last_mut()) {
                (Some(true), Some((_, last))) if !broken && number - *last < GAP => *last = number,
                (Some(true), _) => runs.push((number, number)),
                _ => {}
            }
            broken = *alike == Some(false) || broken && *alike != Some(true);
        }
        runs
    }

    /// The numbers that mean the same, as people write them.
    fn list(&self) -> String {
        let written = |(first, last): (u32, u32)| match first == last {
            true => format!("#{first}"),
            false => format!("#{first}-#{last}"),
        };
        self.runs().into_iter().map(written).collect::<Vec<_>>().join(", ")
    }
}

/// The largest number that the control has.
fn last_number(control: &Control) -> u32 {
    let dialect = control.dialect();
    let system = dialect.system.iter().filter(|row| row.name == "#").filter_map(SystemVariable::last);
    let own = control.classes().iter().filter(|row| row.name == "#").map(|row| row.last);
    system.chain(own).max().unwrap_or(0).min(100_000)
}

/// The sum of the constants that are added up in a number.
fn constant_part(number: &Expr) -> Option<f64> {
    match number {
        Expr::Number(value) => Some(*value),
        Expr::Binary(op @ (BinOp::Add | BinOp::Sub), operands) => {
            let [a, b] = [0, 1].map(|at| constant_part(&operands[at]));
            let b = if *op == BinOp::Sub { b.map(|b| -b) } else { b };
            if let (Some(a), Some(b)) = (a, b) { Some(a + b) } else { a.or(b) }
        }
        _ => None,
    }
}

/// Adds the distance to computed numbers that the target has elsewhere, and names what it counts otherwise.
fn shift(program: &mut Program, numbers: &mut Numbers<'_>) {
    let mut moved = |number: Expr| match *numbers.of(&number) {
        Finding::Shifted(.., by) => Place::Indirect(Bank::Numbered, Box::new(add(number, by as f64))),
        Finding::Counted(state, first, _, from) => {
            let count = match add(number, f64::from(from) - f64::from(first)) {
                // What is left of the number is the count itself.
                Expr::Binary(BinOp::Add, sum) if sum[0] == Expr::Number(0.0) => {
                    let [_, count] = *sum;
                    count
                }
                count => count,
            };
            Place::System(state, [count].into())
        }
        _ => Place::Indirect(Bank::Numbered, Box::new(number)),
    };
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        if let StmtKind::Assign { target, .. } | StmtKind::Input { target, .. } = &mut stmt.kind
            && let Place::Indirect(Bank::Numbered, number) = target
        {
            *target = moved(std::mem::replace(number.as_mut(), Expr::Vacant));
        }
    }
    rewrite_program(program, |e| matches!(e, Expr::Indirect(Bank::Numbered, _)), &mut |e, _, _| match e {
        Expr::Indirect(Bank::Numbered, number) => moved(*number).read(),
        other => other,
    });
}

/// Adds to the first constant of a sum.
fn add(number: Expr, by: f64) -> Expr {
    match number {
        Expr::Number(value) => Expr::Number(value + by),
        Expr::Binary(op @ (BinOp::Add | BinOp::Sub), operands) if constant_part(&operands[0]).is_some() => {
            let [a, b] = *operands;
            Expr::binary(op, add(a, by), b)
        }
        Expr::Binary(BinOp::Add, operands) if constant_part(&operands[1]).is_some() => {
            let [a, b] = *operands;
            Expr::binary(BinOp::Add, a, add(b, by))
        }
        number => Expr::binary(BinOp::Add, number, Expr::Number(by)),
    }
}
