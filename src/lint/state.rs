//! What is in force where, as far as faults hang on it: followed over all calls of the library.
//!
//! Law: what is said to be so is so on every way that the text shows. What ways disagree on, what stands outside the
//! library and what was not understood leave nothing known.

use super::calls::is_tangled;
use super::looked::{Looked, blocks, is_hole};
use super::{in_force, left_on};
use crate::canon::{Group, Op, Role};
use crate::diag::Code;
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Expr, Nc, NcItem, Stmt, StmtKind, TermKind};
use crate::text::Span;

/// Something to be said, for the rule of its code.
pub(super) struct Noted {
    pub code: Code,
    pub file: usize,
    pub span: Span,
    pub message: String,
}

/// Whether something was named.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Named {
    /// On no way here.
    Never,
    /// On some way, or not known.
    Maybe,
}

/// Whether something that has to be ended is in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum On {
    /// It is not, or nobody knows.
    No,
    /// It is: the operation, its program and its place.
    Yes(Op, usize, Span),
}

/// What the spindle does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spindle {
    /// Nobody knows, or it turns.
    Unknown,
    /// It stands: the place that stopped it, and whether that was a tool change.
    Stands(bool),
}

/// What has to be ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kept {
    RadiusComp,
    Cycle,
    Rotation,
    Scaling,
    Mirror,
    Shift,
    Distance,
    Length,
    ModalCall,
}

impl Kept {
    pub(super) const ALL: [Self; 9] = [
        Self::RadiusComp,
        Self::Cycle,
        Self::Rotation,
        Self::Scaling,
        Self::Mirror,
        Self::Shift,
        Self::Distance,
        Self::Length,
        Self::ModalCall,
    ];
}

/// What is known at a place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Known {
    pub feed: Named,
    pub unit: Named,
    pub speed: Named,
    pub spindle: Spindle,
    pub motion: Option<Op>,
    pub on: [On; Kept::ALL.len()],
    /// The tool that the last tool word named.
    pub selected: Option<f64>,
    /// The tool in the spindle.
    pub tool: Option<f64>,
    /// True where the last length code cancelled the length.
    pub length_off: bool,
    /// True where a tool was changed and no length was named since.
    pub old_length: bool,
}

impl Known {
    const NOTHING: Self = Self {
        feed: Named::Maybe,
        unit: Named::Maybe,
        speed: Named::Maybe,
        spindle: Spindle::Unknown,
        motion: None,
        on: [On::No; Kept::ALL.len()],
        selected: None,
        tool: None,
        length_off: false,
        old_length: false,
    };

    pub(super) fn is_on(&self, kept: Kept) -> On {
        self.on[kept as usize]
    }

    fn put(&mut self, kept: Kept, on: On) {
        self.on[kept as usize] = on;
    }
}

impl Lattice for Known {
    fn join(&mut self, other: &Self) -> bool {
        if self == other {
            return false;
        }
        let before = self.clone();
        let named = |a: Named, b: Named| if a == b { a } else { Named::Maybe };
        self.feed = named(self.feed, other.feed);
        self.unit = named(self.unit, other.unit);
        self.speed = named(self.speed, other.speed);
        if self.spindle != other.spindle {
            self.spindle = match (self.spindle, other.spindle) {
                (Spindle::Stands(_), Spindle::Stands(_)) => Spindle::Stands(false),
                _ => Spindle::Unknown,
            };
        }
        let same = |a: Option<f64>, b: Option<f64>| if a == b { a } else { None };
        self.motion = if self.motion == other.motion { self.motion } else { None };
        self.selected = same(self.selected, other.selected);
        self.tool = same(self.tool, other.tool);
        self.length_off &= other.length_off;
        self.old_length &= other.old_length;
        for (mine, theirs) in self.on.iter_mut().zip(&other.on) {
            *mine =
                match (*mine, *theirs) {
                    (On::Yes(op, a, first), On::Yes(_, b, second)) => {
                        if (a, first.start) <= (b, second.start) { On::Yes(op, a, first) } else { *theirs }
                    }
                    _ => On::No,
                };
        }
        *self != before
    }
}

/// The rules of what statements do.
pub(super) struct Steps<'l, 'a> {
    looked: &'l Looked<'a>,
    changes_stop: bool,
    stops_stop: bool,
    messages_stop: bool,
    length_by_tool: bool,
}

impl<'l, 'a> Steps<'l, 'a> {
    fn new(looked: &'l Looked<'a>) -> Self {
        let control: &Control = looked.control;
        Self {
            looked,
            changes_stop: control.is(Question::ChangeEndsSpindle),
            stops_stop: control.is(Question::StopEndsSpindle),
            messages_stop: control.is(Question::MessageEndsSpindle),
            length_by_tool: control.is(Question::ToolWordSelectsLength),
        }
    }

    pub(super) fn stmt(&self, program: usize, stmt: &Stmt, known: &mut Known) {
        let before = stmt.site.skip.map(|_| known.clone());
        match &stmt.kind {
            StmtKind::Nc(nc) => {
                self.nc(program, stmt.site.span, nc, known);
                if nc.moves() && known.is_on(Kept::ModalCall) != On::No {
                    let open = known.is_on(Kept::ModalCall);
                    self.lose(known);
                    known.put(Kept::ModalCall, open);
                }
            }
            StmtKind::ModalCall(_) => {
                known.put(Kept::ModalCall, On::Yes(Op::CallModal, program, stmt.site.span));
            }
            StmtKind::ModalCallOff => known.put(Kept::ModalCall, On::No),
            StmtKind::StopMessage { .. } | StmtKind::Input { .. } if self.messages_stop => {
                known.spindle = Spindle::Stands(false);
            }
            StmtKind::Comment => {
                let file = self.looked.module.programs.get(program).map(|program| program.file);
                let text = file.and_then(|file| self.looked.inputs.get(file)).map(|input| &*input.bytes);
                if is_hole(stmt, text.unwrap_or_default()) {
                    self.lose(known);
                }
            }
            _ => {}
        }
        if let Some(before) = before {
            known.join(&before);
        }
    }

    fn nc(&self, program: usize, span: Span, nc: &Nc, known: &mut Known) {
        for item in &nc.items {
            match item {
                NcItem::Op(op) => self.op(*op, program, span, nc, known),
                NcItem::Code(..) => self.lose(known),
                NcItem::Word(Role::Feed, _) => known.feed = Named::Maybe,
                NcItem::Word(Role::Speed, _) => known.speed = Named::Maybe,
                NcItem::Word(Role::Tool, value) => known.selected = value.constant(),
                NcItem::Word(Role::LengthOffset, _) => known.old_length = false,
                NcItem::Word(..) => {}
            }
        }
        if nc.has(Op::ToolChange) {
            known.tool = known.selected;
            known.old_length = !self.length_by_tool && nc.word(Role::LengthOffset).is_none();
        }
    }

    fn op(&self, op: Op, program: usize, span: Span, nc: &Nc, known: &mut Known) {
        let on = On::Yes(op, program, span);
        match op {
            Op::Inch | Op::Metric => known.unit = Named::Maybe,
            Op::RadiusLeft | Op::RadiusRight => known.put(Kept::RadiusComp, on),
            Op::RadiusOff => known.put(Kept::RadiusComp, On::No),
            Op::CycleOff => known.put(Kept::Cycle, On::No),
            Op::RotateOn if is_nothing(nc.word(Role::Angle)) => known.put(Kept::Rotation, On::No),
            Op::RotateOn => known.put(Kept::Rotation, on),
            Op::RotateOff => known.put(Kept::Rotation, On::No),
            Op::ScaleOn => known.put(Kept::Scaling, on),
            Op::ScaleOff => known.put(Kept::Scaling, On::No),
            Op::MirrorOn => known.put(Kept::Mirror, on),
            Op::MirrorOff => known.put(Kept::Mirror, On::No),
            Op::LocalShift => known.put(Kept::Shift, if shifts(nc) { on } else { On::No }),
            Op::ShiftCancel => known.put(Kept::Shift, On::No),
            Op::Incremental => known.put(Kept::Distance, on),
            Op::Absolute => known.put(Kept::Distance, On::No),
            Op::LengthPlus | Op::LengthMinus => {
                (known.old_length, known.length_off) = (false, false);
                known.put(Kept::Length, on);
            }
            Op::LengthOff => {
                known.put(Kept::Length, On::No);
                (known.old_length, known.length_off) = (false, true);
            }
            Op::SpindleStop | Op::SpindleOrient => known.spindle = Spindle::Stands(false),
            Op::SpindleCw | Op::SpindleCcw => known.spindle = Spindle::Unknown,
            Op::ToolChange if self.changes_stop => known.spindle = Spindle::Stands(true),
            Op::Stop if self.stops_stop => known.spindle = Spindle::Stands(false),
            Op::Builder | Op::MachineSpecific => known.spindle = Spindle::Unknown,
            op if op.is_cycle() => {
                known.put(Kept::Cycle, on);
                if op.is_tap() || op == Op::CycleOther {
                    known.spindle = Spindle::Unknown;
                }
            }
            op if op.group() == Group::Motion => {
                known.motion = Some(op);
                known.put(Kept::Cycle, On::No);
            }
            _ => {}
        }
    }
}

impl Follow for Steps<'_, '_> {
    type Known = Known;

    fn outside(&self, program: usize) -> Known {
        let mut known = Known::NOTHING;
        if self.looked.is_main(program) {
            (known.feed, known.unit, known.speed) = (Named::Never, Named::Never, Named::Never);
        }
        known
    }

    fn stmts(&self, (program, _): (usize, BlockId), block: &Block, known: &mut Known) {
        block.stmts.iter().for_each(|stmt| self.stmt(program, stmt, known));
    }

    fn lose(&self, known: &mut Known) {
        *known = Known::NOTHING;
    }
}

fn is_nothing(value: Option<&Expr>) -> bool {
    value.and_then(Expr::constant) == Some(0.0)
}

/// True unless all axis words are 0.
fn shifts(nc: &Nc) -> bool {
    nc.items.iter().any(|item| match item {
        NcItem::Word(role, value) => {
            role.is_axis() && !matches!(value, Expr::Increments(n) if *n == 0.0) && !is_nothing(Some(value))
        }
        _ => false,
    })
}

/// A statement with what is known before and after it.
pub(super) struct Step<'s> {
    pub program: usize,
    pub stmt: &'s Stmt,
    pub nc: &'s Nc,
    pub before: &'s Known,
    pub after: &'s Known,
}

/// Follows the library, and gathers what the rules of what is in force say.
pub(super) fn noted(looked: &Looked<'_>) -> Vec<Noted> {
    if is_tangled(looked) {
        return Vec::new();
    }
    let steps = Steps::new(looked);
    let found = OverCalls::of(looked.module, &steps);
    let mut noted = Vec::new();
    let mut watch = in_force::Watch::new(looked);
    for (program, id, block) in blocks(looked.module) {
        let Some(mut known) = found.at(program, id).cloned() else { continue };
        for stmt in &block.stmts {
            let Some(nc) = stmt.kind.nc() else {
                steps.stmt(program, stmt, &mut known);
                continue;
            };
            let mut settled = known.clone();
            steps.nc(program, stmt.site.span, nc, &mut settled);
            watch.step(&Step { program, stmt, nc, before: &known, after: &settled }, &mut noted);
            steps.stmt(program, stmt, &mut known);
        }
        if let TermKind::End { .. } = block.term.kind {
            left_on::at_end(looked, program, block, &known, &mut noted);
        }
    }
    noted
}
