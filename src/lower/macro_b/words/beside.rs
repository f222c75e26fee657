//! Words beside codes of a machine's builder.

use super::roles::BlockCodes;
use crate::canon::{Op, Role};
use crate::dialect::{CodeMeaning, Without};
use crate::lower::common::may_take;
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::parts::Words;
use crate::text::Span;

impl<'a> Lowering<'a> {
    /// Notes whether the block has axis words, where a code stands in it that may take words.
    pub(super) fn note_axes(&mut self, words: &Words<'a>, codes: &BlockCodes<'a>) {
        let told = |row: &CodeMeaning| matches!(row.op, Op::Act | Op::Builder);
        let is_axis = |letter, comma| self.codes.letter(letter, comma).is_some_and(|row| row.role.is_axis());
        self.moves = codes.iter().any(|(_, row)| told(row))
            && words.iter().any(|(word, _)| is_axis(word.letter, word.comma));
    }

    /// True where a builder's G code is the only code of its block and an alarm takes its place: no word of it matters, for the run ends there.
    pub(super) fn stops_with_alarm(&self, codes: &BlockCodes<'a>) -> bool {
        let [(_, row)] = codes.as_slice() else { return false };
        let site = self.control.profile().site.iter().find(|site| site.code == row.code);
        row.code.starts_with('G')
            && site.is_some_and(|site| {
                site.without == Some(Without::Alarm)
                    && site.name.is_none()
                    && site.target.is_none()
                    && site.words.is_empty()
            })
    }

    /// True, and an error, for a word of the block or the mode in force beside a code of which the profile says what becomes
    /// of it: it may be a word of that code.
    pub(super) fn is_beside(&mut self, letter: char, role: Role, span: Span, codes: &BlockCodes<'a>) -> bool {
        let rows = codes.iter().map(|(_, row)| *row);
        let Some(row) = may_take(rows, role, self.moves) else { return false };
        self.findings.beside_code(letter, role, &row.code, span);
        true
    }
}
