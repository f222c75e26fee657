//! Codes that a word of the machine's builder makes others: each gets a line in the profile with that word.

use super::roles::BlockCodes;
use crate::canon::Op;
use crate::diag::Asks;
use crate::lower::macro_b::build::Lowering;
use crate::syntax::{ExprKind, Word};

impl<'a> Lowering<'a> {
    /// What to do where a builder's word beside a code of the spindle says which spindle it is: `M3 P11`.
    pub(super) fn spindle_by_word(&self, word: &Word, codes: &BlockCodes<'a>) -> Option<(String, Asks)> {
        let spindle = |op: Op| matches!(op, Op::SpindleCw | Op::SpindleCcw | Op::SpindleStop);
        let (_, row) = codes.iter().find(|(_, row)| spindle(row.op))?;
        let ExprKind::Number(number) = &word.value.as_ref()?.kind else { return None };
        if word.letter != 'P' || word.comma || number.value.fract() != 0.0 {
            return None;
        }
        let code = format!("{} P{}", row.code, number.value);
        let help = format!(
            "if P says which spindle it is, name the code with it in the machine's profile: [[site]] with code = \"{code}\", op = \"{}\", and a \
             text, where it is the one that the target's {} turns; else with a name",
            row.op, row.code
        );
        Some((help, Asks::Code { code: code.into(), op: Some(row.op) }))
    }

    /// What to do where a word beside a probe move says which signal ends it, `G31 P2`, or how it stops, `G31 R1`. Where the
    /// machine's builder wired the tool setter to a signal of its own, the shop knows whether it ends such moves on the target.
    pub(super) fn signal_by_word(&self, word: &Word, codes: &BlockCodes<'a>) -> Option<(String, Asks)> {
        let (_, row) = codes.iter().find(|(_, row)| row.op == Op::Probe)?;
        let ExprKind::Number(number) = &word.value.as_ref()?.kind else { return None };
        let is_signal = (1.0..10.0).contains(&number.value) && number.value.fract() == 0.0;
        let (says, where_so) = match word.letter {
            'P' if is_signal => {
                ("which signal ends the move", "where the same probe ends the moves of the target")
            }
            'R' => ("how the move stops", "where the target may stop it its own way"),
            _ => return None,
        };
        if word.comma || number.value.fract() != 0.0 {
            return None;
        }
        let code = format!("{} {}{}", row.code, word.letter, number.value);
        let help = format!(
            "if {} says {says}, name the code with it in the machine's profile: [[site]] with code = \"{code}\", op = \"{}\", \
             and a text, {where_so}",
            word.letter, row.op
        );
        Some((help, Asks::Code { code: code.into(), op: Some(row.op) }))
    }
}
