//! Words beside a drilling cycle, or under one, that would be something else in another block.

use super::roles::BlockCodes;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{CodeMeaning, Machine, beside_letter};
use crate::ir::{Expr, Nc};
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::parts::Words;
use crate::syntax::Word;
use crate::text::Span;

/// The setting that says what a comma word beside a tap means.
const TAP_WORD: &str = "setting.tap_word";

const NO_LEAD: &str =
    "this tap is told no lead, so it is not known how far it goes in a turn: write F into its block";

impl<'a> Lowering<'a> {
    /// The motion code or the cycle in force, as the text has it.
    pub(super) fn code_in_force(&self) -> Option<&'a CodeMeaning> {
        match self.motion.beside {
            Some(place) => self.control.code_at(place),
            None => self.codes.get(self.motion.code?)?.row,
        }
    }

    /// True, and an error, for a corner beside a drilling cycle or under it: no cut follows that it could round.
    pub(super) fn is_corner_of_cycle(&mut self, word: &Word, span: Span, row: &CodeMeaning) -> bool {
        let usual = self.codes.letter(word.letter, word.comma).map(|usual| usual.role);
        if !matches!(usual, Some(Role::CornerRadius | Role::CornerChamfer)) {
            return false;
        }
        let comma = if word.comma { "," } else { "" };
        let (letter, code) = (word.letter, row.code.split(' ').next().unwrap_or_default());
        let what = format!("{comma}{letter} has no meaning beside {code}: a drilling cycle has no corner");
        let told = Diagnostic::new(Code::NotUnderstood, span, what);
        let of_tap = letter == 'R' && row.op.is_tap();
        self.findings.add(match self.control.setting(TAP_WORD).filter(|_| of_tap) {
            Some("none") => {
                let help = "if it makes the tap synchronous, with F as its lead, say 'tap_word' under [settings] of the machine's \
                            profile; else take it out";
                told.with_help(help).lacking(TAP_WORD)
            }
            Some(_) => told.with_help("write ,R0 or ,R1 into the block of the tapping cycle, as a number"),
            None => told.with_help("take it out, or end the cycle (G80) before the cut"),
        });
        true
    }

    /// Tells of codes beside the code of a drilling cycle that take the axis words of its block too, and of one that moves.
    pub(super) fn check_codes_of_cycle(&mut self, words: &Words<'a>, codes: &BlockCodes<'a>, span: Span) {
        let Some((_, cycle)) = codes.iter().find(|(_, row)| row.op.is_cycle()) else { return };
        let is_axis = |word: &Word| {
            self.codes.letter(word.letter, word.comma).is_some_and(|usual| usual.role.is_axis())
        };
        if self.control.machine() != Machine::Mill || !words.iter().any(|(word, _)| is_axis(word)) {
            return;
        }
        let own = |op: Op| {
            op.takes_axes()
                || op.is_return()
                || matches!(op, Op::MachineOnce | Op::Home | Op::Probe | Op::ProbeOther)
        };
        let head = |row: &CodeMeaning| row.code.split(' ').next().unwrap_or_default().to_owned();
        let cycle = head(cycle);
        if let Some((_, row)) = codes.iter().find(|(_, row)| own(row.op)) {
            let what = format!(
                "{} and {cycle} stand in one block, and both take its axis words: it is not known which of them gets them",
                head(row)
            );
            let told = Diagnostic::new(Code::NotUnderstood, span, what);
            self.findings.add(told.with_help("give each a block of its own"));
        } else if let Some((_, row)) = codes.iter().find(|(_, row)| row.op.group() == Group::Motion) {
            let what = format!(
                "{} and {cycle} stand in one block: it is taken to drill; some controls end the cycle by such a code, and move",
                head(row)
            );
            let told = Diagnostic::new(Code::Conditional, span, what);
            self.findings.add(told.with_help("leave out the code that does not count"));
        }
    }

    /// An error for a word that tells which code this is, and stands twice: `,R1 ,R0`.
    pub(super) fn check_told_once(&mut self, words: &Words<'a>, codes: &BlockCodes<'a>) {
        for (_, row) in codes.iter().filter(|(_, row)| row.code.contains(' ')) {
            for beside in row.beside().into_iter().flatten().filter(|beside| beside.thousandths.is_some()) {
                let is_it = |word: &Word| beside_letter(word.letter, word.comma) == beside.letter;
                if let Some((word, span)) = words.iter().filter(|(word, _)| is_it(word)).nth(1) {
                    let what = format!(
                        "{} is in this block twice, and says what {} does",
                        word.letter,
                        row.code.split(' ').next().unwrap_or_default()
                    );
                    self.findings.not_understood(*span, what);
                }
            }
        }
    }

    /// An error for a tap of this block whose code takes a lead, and which is told none.
    pub(super) fn check_lead(&mut self, nc: &Nc, codes: &BlockCodes<'a>, span: Span) {
        let told = |nc: &Nc| nc.word(Role::Lead).is_some() || nc.word(Role::ThreadsPerInch).is_some();
        let by_lead = codes.iter().any(|(_, row)| row.op.is_tap() && row.words.get("F") == Some(&Role::Lead));
        if by_lead && !told(nc) {
            self.findings.not_understood(span, NO_LEAD);
        } else if by_lead && nc.word(Role::Lead).and_then(Expr::constant).is_some_and(|lead| lead <= 0.0) {
            self.findings.not_understood(span, "the lead of a tap is a length above 0");
        }
    }
}
