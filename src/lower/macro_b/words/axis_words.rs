//! Axis words beside codes of a machine's builder.

use super::roles::BlockCodes;
use crate::canon::{Group, Op};
use crate::diag::{Asks, Code, Diagnostic};
use crate::dialect::CodeMeaning;
use crate::lower::macro_b::build::Lowering;
use crate::text::Span;

impl Lowering<'_> {
    /// True, and an error, for an axis beside a G code of which the profile says what becomes of it: it is a word of that
    /// code, as the X of a return to a second reference position, and goes with it, or a move, and stays.
    pub(super) fn is_axis_beside(&mut self, letter: char, span: Span, codes: &BlockCodes<'_>) -> bool {
        let Some(code) = takes_axes(codes) else { return false };
        let message = format!(
            "{letter} beside {code} may be a word of that code, which goes with it, or a move, which stays"
        );
        let help = format!(
            "name it in the [[site]] of {code} in the machine's profile: words = {{ {letter} = \"{letter}\" }}; if it is a move, \
             write it into a block of its own"
        );
        let told = Diagnostic::new(Code::NotUnderstood, span, message).with_help(help);
        let name = letter.to_string().into();
        self.findings.add(told.asking_for(Asks::Word { target: false, code: code.into(), letter, name }));
        true
    }
}

/// The G code of the profile that may take the axis words of a block, where no other G code of the block does.
fn takes_axes<'c>(codes: &BlockCodes<'c>) -> Option<&'c str> {
    let is_told = |row: &CodeMeaning| matches!(row.op, Op::Act | Op::Builder);
    let is_g = |row: &CodeMeaning| row.code.starts_with('G');
    let others = |row: &CodeMeaning| is_g(row) && row.op.group() == Group::OneShot && !is_told(row);
    let (_, row) = codes.iter().find(|(_, row)| is_told(row) && is_g(row))?;
    codes.iter().all(|(_, row)| !others(row)).then_some(row.code.as_str())
}
