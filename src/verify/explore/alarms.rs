//! Ways that only raise an alarm, and that both texts write alike.
//!
//! A program that is called checks what its callers give it, and those of a library give it what is right: no run goes the
//! way to the alarm. Nothing but an alarm of the program stands there, so that what is left to compare can be read: the
//! condition, which must be the same of the same variables, the number, and the text. Runs of both sides must have gone the other way
//! of the same branch. Each branch of the target stands for one of the source, in their order.

use super::branches::{Coverage, Place};
use crate::canon::Sys;
use crate::control::ProgramRef;
use crate::dialect::Control;
use crate::syntax::{Block, Expr, ExprKind, Index, Item, ItemKind, Label, Target, VarRef};
use crate::verify::compare::say_the_same;
use crate::verify::sides::{Job, Side, name_of, of_target};

/// Blocks without a move or a change that are followed to an alarm, at the most.
const STEPS: usize = 8;

/// A way of a branch to an alarm.
struct AlarmWay<'t> {
    place: Place,
    way: i64,
    condition: &'t Expr,
    number: f64,
    text: String,
}

/// Takes the ways to alarms that both texts write alike for compared.
pub fn compare_alarms(job: &Job<'_>, program: ProgramRef, source: &mut Coverage, target: &mut Coverage) {
    if source.is_complete() {
        return;
    }
    let mut theirs: Vec<AlarmWay<'_>> = Vec::new();
    for there in of_target(job, program) {
        theirs.extend(alarm_ways(job.target, there));
    }
    theirs.retain(|way| target.lacks_one_way(way.place, way.way));
    let mut left = theirs.iter();
    for ours in alarm_ways(job.source, program) {
        if !source.lacks_one_way(ours.place, ours.way) {
            continue;
        }
        let mut rest = left.clone();
        if let Some(twin) = rest.find(|theirs| is_alike(job, &ours, theirs)) {
            left = rest;
            source.read(ours.place, ours.way);
            target.read(twin.place, twin.way);
        }
    }
}

fn is_alike(job: &Job<'_>, ours: &AlarmWay<'_>, theirs: &AlarmWay<'_>) -> bool {
    ours.way == theirs.way
        && ours.number == theirs.number
        && say_the_same(&ours.text, &theirs.text, None)
        && is_same(job, ours.condition, theirs.condition)
}

/// The ways of conditions of a program after which nothing but an alarm of its own comes, in the order of its text.
fn alarm_ways<'s>(side: &'s Side<'_>, program: ProgramRef) -> Vec<AlarmWay<'s>> {
    let text = Text { side, file: program.file, blocks: side.text(program) };
    let mut found = Vec::new();
    for (at, block) in text.blocks.iter().enumerate() {
        let Some((ItemKind::If { condition, body, .. }, [])) =
            rest(block).split_first().map(|(item, rest)| (&item.kind, rest))
        else {
            continue;
        };
        for (way, alarm) in [(1, text.done(block, body)), (0, text.alarm_from(at + 1))] {
            let Some((number, text)) = alarm else { continue };
            found.push(AlarmWay { place: (program.file, condition.span), way, condition, number, text });
        }
    }
    found
}

/// The text of a program.
struct Text<'s, 'a> {
    side: &'s Side<'a>,
    file: usize,
    blocks: &'s [Block],
}

impl Text<'_, '_> {
    /// The number and the text of the alarm that items of a block raise, or jump to.
    fn done(&self, block: &Block, items: &[Item]) -> Option<(f64, String)> {
        let first = items.iter().find(|item| !says_nothing(item))?;
        match &first.kind {
            ItemKind::Goto(target) => self.alarm_from(place_in(self.blocks, target)?),
            ItemKind::Assign { target, value, by_sign: false } => self.alarm(block, target, value),
            _ => None,
        }
    }

    /// The alarm that a run comes to from a block on, if it does nothing else before.
    fn alarm_from(&self, mut at: usize) -> Option<(f64, String)> {
        for _ in 0..STEPS {
            let block = self.blocks.get(at)?;
            match rest(block) {
                [] if block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_))) => return None,
                [] => at += 1,
                [item, ..] => match &item.kind {
                    ItemKind::Goto(target) => at = place_in(self.blocks, target)?,
                    ItemKind::Assign { target, value, by_sign: false } => {
                        return self.alarm(block, target, value);
                    }
                    _ => return None,
                },
            }
        }
        None
    }

    fn alarm(&self, block: &Block, target: &VarRef, value: &Expr) -> Option<(f64, String)> {
        let Index::Number(number) = target.index else { return None };
        let (Sys::Alarm, ..) = self.side.control.read_system(&target.name, Some(number))? else {
            return None;
        };
        let ExprKind::Number(number) = &value.kind else { return None };
        let source = self.side.source(self.file)?;
        let shown = block.items.iter().filter_map(|item| match &item.kind {
            ItemKind::Comment(comment) => source.get(comment.text.range()).map(String::from_utf8_lossy),
            _ => None,
        });
        let shown: Vec<_> = shown.collect();
        (number.value >= 1.0).then(|| (number.value, shown.join(" ")))
    }
}

/// The block that a jump goes to, if one block alone has that number or label.
pub(super) fn place_in(blocks: &[Block], to: &Target) -> Option<usize> {
    let is_it = |item: &Item| match (to, &item.kind) {
        (Target::Sequence(to), ItemKind::Sequence { number, .. }) => number == to,
        (Target::Label(to), ItemKind::Label(label)) => label == to,
        (Target::Label(Label::Number(to)), ItemKind::Sequence { number, .. }) => number == to,
        _ => false,
    };
    let mut all = blocks.iter().enumerate().filter(|(_, block)| block.items.iter().any(is_it));
    all.next().filter(|_| all.next().is_none()).map(|(at, _)| at)
}

/// True for what is written and does nothing.
fn says_nothing(item: &Item) -> bool {
    use ItemKind::*;
    matches!(item.kind, Comment(_) | Sequence { .. } | Label(_) | EndOfBlock | MacroMark)
}

/// What a block does, from the first item on that does something to the last; nothing where a switch may skip it.
fn rest(block: &Block) -> &[Item] {
    if block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_) | ItemKind::Tape)) {
        return &[];
    }
    let acts = |item: &Item| !says_nothing(item);
    let Some(first) = block.items.iter().position(acts) else { return &[] };
    let last = block.items.iter().rposition(acts).unwrap_or(first);
    block.items.get(first..=last).unwrap_or_default()
}

/// True for the same expression of the same variables.
fn is_same(job: &Job<'_>, ours: &Expr, theirs: &Expr) -> bool {
    let all = |ours: &[Expr], theirs: &[Expr]| {
        ours.len() == theirs.len() && ours.iter().zip(theirs).all(|(a, b)| is_same(job, a, b))
    };
    match (bare(ours), bare(theirs)) {
        (ExprKind::Number(a), ExprKind::Number(b)) => a.value == b.value,
        (ExprKind::Variable(a), ExprKind::Variable(b)) => is_same_variable(job, a, b),
        (ExprKind::Negate(a), ExprKind::Negate(b)) | (ExprKind::Not(a), ExprKind::Not(b)) => {
            is_same(job, a, b)
        }
        (ExprKind::Binary(op, a), ExprKind::Binary(other, b)) => op == other && all(&a[..], &b[..]),
        (
            ExprKind::Call { function, arguments: a, .. },
            ExprKind::Call { function: other, arguments: b, .. },
        ) => function == other && all(a, b),
        _ => false,
    }
}

fn bare(e: &Expr) -> &ExprKind {
    match &e.kind {
        ExprKind::Group(inner) | ExprKind::Plus(inner) => bare(inner),
        kind => kind,
    }
}

fn is_same_variable(job: &Job<'_>, ours: &VarRef, theirs: &VarRef) -> bool {
    let (source, target) = (job.source.control, job.target.control);
    let state = |control: &Control, variable: &VarRef| match variable.index {
        Index::Number(number) => control
            .read_system(&variable.name, Some(number))
            .map(|(state, subscripts, _)| (state, subscripts)),
        _ => None,
    };
    match (state(source, ours), state(target, theirs)) {
        (None, None) => {
            let named = name_of(ours, source).and_then(|name| job.names.variable(&name, source, target));
            named.is_some() && named == name_of(theirs, target)
        }
        (ours, theirs) => ours == theirs,
    }
}
