//! Checks of the G and M codes.

use super::overlay::options_apart;
use super::reader::{Placed, Reader};
use super::{Beside, CodeHead, CodeMeaning};

/// A row, and its spelling: each row meets each, so it is read once.
struct Spelt<'a> {
    row: &'a CodeMeaning,
    head: CodeHead,
    beside: Vec<Beside>,
}

/// Codes are spelt as codes, stand once, and no operation has two preferred spellings.
pub(super) fn check(reader: &mut Reader, rows: &[Placed<CodeMeaning>]) {
    let mut earlier: Vec<Spelt<'_>> = Vec::with_capacity(rows.len());
    for placed in rows {
        let row = &placed.row;
        let place = || placed.place.clone();
        let (Some(head), Some(beside)) = (row.head(), row.beside()) else {
            let help = "write a letter and a number, then words: 'G10 L2', 'G17 Q', 'G54.1 P'";
            reader.fault_at(place(), format!("'{}' is not a code", row.code), help);
            continue;
        };
        if row.through.is_some_and(|last| last < head.whole() || last > head.whole() + 1000) {
            reader.fault_at(
                place(),
                "the run of codes is backwards",
                "write the last code's number as 'through'",
            );
        }
        if row.counted.is_some_and(|role| row.through.is_none() || !row.fixed.contains_key(&role)) {
            let help = "'counted' needs 'through' and a first value in 'fixed'";
            reader.fault_at(place(), "nothing counts up", help);
        }
        if row.words.keys().any(|letter| !is_address(letter)) || row.required.iter().any(|l| !is_address(l)) {
            reader.fault_at(
                place(),
                "a word is one letter",
                "write 'R', ',R' for a comma word, 'R0' for a parametric variable",
            );
        }
        if row.shift.values().flatten().any(|shift| shift.first > shift.last) {
            reader.fault_at(place(), "a shift's range is backwards", "write the smaller number as 'first'");
        }
        let spelt = Spelt { row, head, beside };
        for other in &earlier {
            if !together(other.row, row) {
                continue;
            }
            if same_code(other, &spelt) {
                reader.fault_at(
                    place(),
                    format!("{} stands twice", row.code),
                    "keep one row, or say 'machine' or 'when'",
                );
            }
            if both_preferred(other.row, row) {
                let message =
                    format!("{} and {} are both preferred for {}", other.row.code, row.code, row.op);
                reader.fault_at(place(), message, "write 'preferred = false' in the one that is only read");
            }
        }
        earlier.push(spelt);
    }
}

fn is_address(letter: &str) -> bool {
    let letter = letter.strip_prefix(',').unwrap_or(letter);
    let (head, digits) = letter.split_at_checked(1).unwrap_or(("", ""));
    head.chars().all(|c| c.is_ascii_uppercase())
        && !head.is_empty()
        && digits.chars().all(|c| c.is_ascii_digit())
}

/// True where both rows can hold on one machine.
fn together(a: &CodeMeaning, b: &CodeMeaning) -> bool {
    let apart = |x: &Option<String>, y: &Option<String>| matches!((x, y), (Some(x), Some(y)) if x != y);
    let options = options_apart(a.option.as_ref(), b.option.as_ref());
    !apart(&a.machine, &b.machine) && !apart(&a.when, &b.when) && !options
}

/// True where the codes, or their runs, meet beside the same words.
fn same_code(a: &Spelt<'_>, b: &Spelt<'_>) -> bool {
    let (x, y) = (a.head, b.head);
    if x.letter != y.letter || a.beside != b.beside || a.row.when.is_some() != b.row.when.is_some() {
        return false;
    }
    let last = |row: &CodeMeaning, first: u32| row.through.map_or(first, |last| last.saturating_mul(1000));
    let whole_steps = x.thousandths % 1000 == y.thousandths % 1000;
    whole_steps && x.thousandths <= last(b.row, y.thousandths) && y.thousandths <= last(a.row, x.thousandths)
}

/// True where a writer could not choose between them.
fn both_preferred(a: &CodeMeaning, b: &CodeMeaning) -> bool {
    a.preferred
        && b.preferred
        && a.op == b.op
        && a.fixed == b.fixed
        && a.shift == b.shift
        && a.when.is_some() == b.when.is_some()
        && !named_by_control(a)
}

/// Operations that many codes have, each its own: none is the spelling of the others.
fn named_by_control(row: &CodeMeaning) -> bool {
    use crate::canon::Op::*;
    matches!(row.op, Builder | MachineSpecific | CycleOther | ProbeOther | PlaneOther)
}
