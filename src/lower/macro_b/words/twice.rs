//! Two codes of one group in a block: what the machine does by the one that counts.

use super::nc::Second;
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Expr, Nc, NcItem};
use crate::lower::macro_b::build::Lowering;

const ALONE: &str = "write the one that is meant alone: under incremental coordinates the axis goes home from where it stands if its word is 0";

impl Lowering<'_> {
    /// Says which of two codes of a group counts, once the whole block is known.
    pub(super) fn tell_seconds(&mut self, nc: &Nc, seconds: Vec<Second<'_>>) {
        for Second { row, span } in seconds {
            let home = nc.has(Op::ReferenceReturn) || nc.has(Op::Reference2);
            let places = self.places(nc);
            let (axes, go, moves) =
                if places.len() > 1 { ("the axes", "go", "move") } else { ("the axis", "goes", "moves") };
            let place = places.join(" ");
            let does = match row.op {
                _ if row.op.group() != Group::Distance || places.is_empty() => None,
                Op::Absolute if home => Some(format!("{axes} {go} to {place} of the work first, then home")),
                Op::Incremental if home => {
                    Some(format!("{axes} {moves} by {place} from where the tool stands first, then home"))
                }
                Op::Absolute if nc.has(Op::MachineOnce) => {
                    Some(format!("{axes} {go} to {place} of the machine"))
                }
                _ => None,
            };
            let code = &row.code;
            let told = match does {
                Some(does) => {
                    let what = format!(
                        "{code} is the second code of its group in this block, and counts, as the later one: {does}"
                    );
                    Diagnostic::new(Code::GroupTwice, span, what).with_help(ALONE)
                }
                None => {
                    let what = format!(
                        "{code} is the second code of its group in this block: the second one counts"
                    );
                    Diagnostic::new(Code::GroupTwice, span, what)
                }
            };
            self.findings.add(told);
        }
    }

    /// The words of axes as a person says them: `Z0`; the letter alone where the value is computed.
    fn places(&self, nc: &Nc) -> Vec<String> {
        let said = |item: &NcItem| match item {
            NcItem::Word(role, value) if role.is_axis() => {
                let (letter, _) = self.control.letter(*role, None)?;
                // Without a point it stands as it is written.
                let number = match value {
                    Expr::Increments(number) => Some(number.to_string()),
                    value => value.constant().map(|number| number.to_string()),
                };
                Some(format!("{letter}{}", number.unwrap_or_default()))
            }
            _ => None,
        };
        nc.items.iter().filter_map(said).collect()
    }
}
