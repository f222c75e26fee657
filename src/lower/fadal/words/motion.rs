//! How a block moves when it does not say so itself.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{CodeMeaning, Question};
use crate::lower::common::CALLERS_MODE;
use crate::lower::fadal::build::Lowering;
use crate::lower::fadal::codes::{Codes, thousandths};
use crate::syntax::Word;
use crate::text::Span;

/// What a block's words show of its kind.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    /// True where an axis word makes it a move of the motion mode.
    pub axes: bool,
    /// True where an arc's centre or radius is written.
    pub centre: bool,
}

impl<'b> Lowering<'b> {
    /// The meanings that the motion mode may have before the block.
    fn modes(&self, codes: &Codes<'b, 'b>) -> Vec<&'b CodeMeaning> {
        self.state.motion.set.list().iter().filter_map(|code| codes.modal(*code)).collect()
    }

    /// The motion mode that gives letters their roles, where the block has no motion
    /// code: an active cycle, else an arc.
    pub fn modal_row(&self, codes: &Codes<'b, 'b>) -> Option<&'b CodeMeaning> {
        if codes.motion().is_some() || codes.takes_axes() {
            return None;
        }
        let cycles = self.state.cycle.list().iter().filter(|code| **code != 0);
        let cycle = cycles.filter_map(|code| codes.modal(*code)).next();
        cycle.or_else(|| self.modes(codes).iter().copied().find(|row| is_arc(row.op)))
    }

    /// True where the letter of a block without a motion code means something else in another cycle that may be in
    /// force, or in none.
    pub fn hangs_on_cycle(&self, word: &Word, role: Role, codes: &Codes<'b, 'b>) -> bool {
        let cycles = self.state.cycle.list();
        if cycles.len() < 2 || codes.motion().is_some() || codes.takes_axes() {
            return false;
        }
        let row = |code: &u32| if *code == 0 { None } else { codes.modal(*code) };
        cycles.iter().any(|code| codes.role(word.letter, word.comma, row(code)) != Ok(Some(role)))
    }

    /// The operation to write before the words of a block, and whether the arc code of the
    /// block itself is dropped for it. A block under an arc mode without centre and radius
    /// is straight here, so the common form spells out each block under an arc mode.
    pub fn spell_motion(&mut self, codes: &Codes<'b, 'b>, shown: Move, span: Span) -> Option<Spelling> {
        if let Some(row) = codes.motion() {
            if codes.interpolation().is_some() && codes.cycle().is_none() && self.in_cycle() {
                self.suppose(Question::CycleEndsByMotion, "true", span);
            }
            if !is_arc(row.op) {
                if shown.centre {
                    return self.no_arc(span);
                }
                return Some(Spelling::default());
            }
            if shown.centre {
                return Some(Spelling::default());
            }
            // The mode is set; what it means is spelled out with each block.
            let op = if shown.axes { Some(self.straight(span)?) } else { None };
            return Some(Spelling { op, drop: thousandths(row) });
        }
        let other = codes.takes_axes() || codes.has(Op::MachineOnce);
        if other || !(shown.axes || shown.centre) {
            return if shown.centre { self.no_arc(span) } else { Some(Spelling::default()) };
        }
        let cycles = self.state.cycle.list();
        let mixed = self.in_cycle() && cycles.contains(&0);
        if self.in_cycle() && !mixed {
            return if shown.centre { self.no_arc(span) } else { Some(Spelling::default()) };
        }
        if self.state.motion.set.is_any() {
            return self.conflict(span, "too many different motion modes may be in force here");
        }
        let modes = self.modes(codes);
        let arcs: Vec<Op> = modes.iter().map(|row| row.op).filter(|op| is_arc(*op)).collect();
        if mixed && !arcs.is_empty() {
            return self.conflict(span, "an arc mode or a drilling cycle may be in force here");
        }
        if arcs.is_empty() {
            if self.state.motion.entry && shown.centre {
                return self.conflict(span, "the caller's motion mode decides the direction of this arc");
            }
            if shown.centre && !modes.is_empty() && !mixed {
                return self.no_arc(span);
            }
            if self.state.motion.entry {
                self.once(Code::ModalAssumed, "entry", span, CALLERS_MODE.into());
            }
            if mixed && self.state.after_cycle {
                return self.conflict(
                    span,
                    "a drilling cycle, or the motion mode from before one, may be in force here",
                );
            }
            return Some(self.after_cycle(&modes, span));
        }
        if self.state.motion.entry {
            return self.conflict(span, "an arc mode or the caller's motion mode may be in force here");
        }
        if self.state.motion.called {
            let message = "the programs called since G2 or G3 are taken to leave the motion mode as it was";
            self.once(Code::ModalAssumed, "called", span, message.into());
        }
        if shown.centre {
            return match (arcs.as_slice(), modes.len()) {
                ([arc], 1) => Some(Spelling { op: Some(*arc), drop: None }),
                _ => self.conflict(span, "several motion modes may be in force here"),
            };
        }
        if modes.iter().any(|row| !is_arc(row.op) && row.op != Op::Linear) {
            return self.conflict(span, "several motion modes may be in force here");
        }
        Some(Spelling { op: Some(self.straight(span)?), drop: None })
    }

    /// After the end of a cycle the interpolation from before it is in force again; it is
    /// spelled out, since a cycle and the interpolation are one group elsewhere.
    fn after_cycle(&mut self, modes: &[&'b CodeMeaning], span: Span) -> Spelling {
        if !self.state.after_cycle {
            return Spelling::default();
        }
        if self.state.resumed {
            self.suppose(Question::MotionAfterCycle, "kept", span);
        }
        if self.state.motion.called {
            let message = "this moves in the motion mode from before the cycle, or in one that a program \
                           called since then has set";
            self.once(Code::ModalAssumed, "called", span, message.into());
            return Spelling::default();
        }
        match modes {
            [row] if !self.state.motion.entry => Spelling { op: Some(row.op), drop: None },
            _ => Spelling::default(),
        }
    }

    /// A block under an arc mode without centre and radius.
    fn straight(&mut self, span: Span) -> Option<Op> {
        if self.rely(Question::ArcWithoutCentre, span) != Some("straight") {
            return self.refuse(span, "an arc without a centre or a radius");
        }
        self.spelled_out = true;
        Some(Op::Linear)
    }

    fn no_arc<T>(&mut self, span: Span) -> Option<T> {
        self.refuse(span, "the block has the centre or radius of an arc, but it is not an arc")
    }

    pub fn conflict<T>(&mut self, span: Span, message: &str) -> Option<T> {
        let help = "write the motion code in the block";
        self.findings.add(Diagnostic::new(Code::ModalConflict, span, message).with_help(help));
        None
    }
}

/// How a block's motion is written in the common form.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spelling {
    /// The operation that goes before the block's words.
    pub op: Option<Op>,
    /// The code of the block that is left out.
    pub drop: Option<u32>,
}

/// True for an arc.
pub fn is_arc(op: Op) -> bool {
    matches!(op, Op::ArcCw | Op::ArcCcw | Op::ArcTangent)
}
