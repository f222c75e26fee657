//! Moves that lack something: a feed, a unit, a spindle that turns, a tool length.

use super::looked::{Findings, Looked};
use super::state::{Kept, Known, Named, Noted, On, Spindle, Step};
use crate::canon::{Op, Role};
use crate::diag::Code;
use crate::ir::{Expr, Nc, StmtKind};
use std::collections::BTreeSet;

/// Looks at each block of words, with what is in force before and after it.
pub(super) struct Watch<'l, 'a> {
    looked: &'l Looked<'a>,
    /// True where the unit is a matter of the program.
    asks_unit: bool,
    /// True where programs name tool lengths by a word.
    names_lengths: bool,
    told: BTreeSet<(usize, Code)>,
}

impl<'l, 'a> Watch<'l, 'a> {
    pub(super) fn new(looked: &'l Looked<'a>) -> Self {
        let control = looked.control;
        let has_units = control.dialect().codes.iter().any(|row| row.op == Op::Inch);
        let stmts = looked.module.programs.iter().flat_map(|p| &p.blocks).flat_map(|block| &block.stmts);
        let names = |kind: &StmtKind| kind.nc().is_some_and(|nc| nc.word(Role::LengthOffset).is_some());
        Self {
            looked,
            asks_unit: has_units && control.units().is_none(),
            names_lengths: stmts.map(|stmt| &stmt.kind).any(names),
            told: BTreeSet::new(),
        }
    }

    pub(super) fn step(&mut self, step: &Step<'_>, noted: &mut Vec<Noted>) {
        let (nc, after) = (step.nc, step.after);
        if is_length(nc) && self.asks_unit && after.unit == Named::Never {
            self.once(step, Code::NoUnit, noted, || {
                "the program moves before it names inch or millimetres: it runs in what was in force".into()
            });
        }
        if cuts(nc, after) {
            if after.feed == Named::Never {
                self.once(step, Code::NoFeed, noted, || {
                    "this move cuts before the program names a feed: it runs at the last one".into()
                });
            }
            if let (Spindle::Stands(_), Spindle::Stands(by_change)) = (step.before.spindle, after.spindle) {
                let why = if by_change { "since the tool change" } else { "here" };
                self.once(step, Code::SpindleStands, noted, || {
                    format!("this move cuts, and the spindle stands {why}")
                });
            }
        }
        let turns = nc.has(Op::SpindleCw) || nc.has(Op::SpindleCcw);
        if turns && after.speed == Named::Never {
            self.once(step, Code::NoSpeed, noted, || {
                "the spindle starts before the program names a speed: it turns at the last one".into()
            });
        }
        self.length(step, noted);
    }

    fn length(&mut self, step: &Step<'_>, noted: &mut Vec<Noted>) {
        let (nc, after) = (step.nc, step.after);
        // Without any length, 0 is where the spindle is at home.
        let home = after.length_off && nc.word(Role::Z).and_then(Expr::constant) == Some(0.0);
        let elsewhere = home || nc.has(Op::MachineOnce) || nc.ops().any(is_reference);
        if self.names_lengths
            && after.old_length
            && nc.moves()
            && nc.word(Role::Z).is_some()
            && !elsewhere
            && after.is_on(Kept::Distance) == On::No
        {
            self.once(step, Code::OldLength, noted, || {
                "Z moves after a tool change before the length of the new tool is named".into()
            });
        }
        let row = nc.word(Role::LengthOffset).and_then(Expr::constant).filter(|row| *row > 0.0);
        if let (Some(row), Some(tool)) = (row, after.tool.filter(|tool| *tool > 0.0))
            && row != tool
        {
            let message = format!("the length offset is {row}, and the tool in the spindle is {tool}");
            self.add(step, Code::OtherLength, noted, message);
        }
    }

    /// Says it of the first place of each program.
    fn once(
        &mut self,
        step: &Step<'_>,
        code: Code,
        noted: &mut Vec<Noted>,
        message: impl FnOnce() -> String,
    ) {
        if self.told.insert((step.program, code)) {
            self.add(step, code, noted, message());
        }
    }

    fn add(&self, step: &Step<'_>, code: Code, noted: &mut Vec<Noted>, message: String) {
        let Some(program) = self.looked.module.programs.get(step.program) else { return };
        noted.push(Noted { code, file: program.file, span: step.stmt.site.span, message });
    }
}

fn is_reference(op: Op) -> bool {
    matches!(
        op,
        Op::ReferenceReturn
            | Op::Reference2
            | Op::ReferenceFrom
            | Op::ReferenceCheck
            | Op::Home
            | Op::SetPosition
    )
}

/// True for a move along a linear axis.
fn is_length(nc: &Nc) -> bool {
    nc.moves()
        && !nc.has(Op::MachineOnce)
        && !nc.ops().any(is_reference)
        && [Role::X, Role::Y, Role::Z].into_iter().any(|role| nc.word(role).is_some())
}

/// True for a move that cuts: at feed, or of a drilling cycle.
fn cuts(nc: &Nc, known: &Known) -> bool {
    use Op::{ArcCcw, ArcCw, ArcTangent, Linear, Probe, ProbeOther, RapidOnce, Thread};
    let other = nc.has(Probe) || nc.has(ProbeOther) || nc.has(RapidOnce) || nc.ops().any(is_reference);
    let feeds = matches!(known.motion, Some(Linear | ArcCw | ArcCcw | ArcTangent | Thread));
    let drills = matches!(known.is_on(Kept::Cycle), On::Yes(op, ..) if op != Op::CycleOther);
    nc.moves() && !other && (feeds || drills)
}

macro_rules! said {
    ($($name:ident $code:ident)*) => { $(
        pub(super) fn $name(looked: &Looked<'_>, findings: &mut Findings) {
            super::left_on::said(looked, Code::$code, findings);
        }
    )* };
}

said! {
    no_feed NoFeed
    no_unit NoUnit
    no_speed NoSpeed
    spindle_stands SpindleStands
    old_length OldLength
    other_length OtherLength
}
