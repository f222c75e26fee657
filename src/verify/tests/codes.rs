//! Codes whose number is computed, where the conversion has made it a condition what they are.

use super::assumed::{assumption, place};
use super::{SymbolMap, supposing};
use crate::assume::{Assumption, Numbers, Predicate, Subscripts};
use crate::verify::{Outcome, Why};

/// What becomes of O1, and whether a condition is why.
fn outcome(source: &str, target: &str) -> (Outcome, bool) {
    let places = place(source, "G1G#500X5.F100.");
    let codes = assumption(Predicate::Codes { letter: 'G', places, same: vec![0.0, 1.0, 17.0, 90.0] });
    let found = supposing(("fanuc", source), ("haas", target), SymbolMap::default(), &[codes]);
    (found[0].outcome, found[0].reasons.iter().any(|reason| reason.why == Why::Condition))
}

/// G4 waits as long as X says on the one control and not on the other.
const SOURCE: &str = "O1\nG21G90\nG1G#500X5.F100.\nG0X1.\nM30\n";

#[test]
fn a_code_that_means_something_else_is_a_condition() {
    assert_eq!(outcome(SOURCE, SOURCE), (Outcome::Undecided, true));
    // What differs where the code is the same on both is different, and so is what differs before it.
    assert_eq!(outcome(SOURCE, &SOURCE.replace("X1.", "X2.")).0, Outcome::Different);
    assert_eq!(outcome(SOURCE, &SOURCE.replace("G21G90", "G21G90G0X9.")).0, Outcome::Different);
}

/// The wear of a tool length by the tool's number, which a test takes past the table of the target.
fn wear(base: u32) -> String {
    format!("O1\nG21G90\nIF[#501NE250]GOTO5\nG0X1.\nN5#500=#[{base}+#501]\nG0X[#500]\nM30\n")
}

#[test]
fn a_number_outside_of_those_reported_is_a_condition() {
    let outcome = |base: u32, supposed: &[(usize, Assumption)]| {
        let found = supposing(("fanuc", &wear(2000)), ("haas", &wear(base)), SymbolMap::default(), supposed);
        (found[0].outcome, found[0].reasons.iter().any(|reason| reason.why == Why::Condition))
    };
    let places = place(&wear(2000), "N5#500=#[2000+#501]");
    let safe = Numbers::new([(2001, 2199)]);
    let told = &[assumption(Predicate::Subscripts(Subscripts { places, safe, bases: vec![2000.0] }))];
    assert_eq!(outcome(2200, told), (Outcome::Undecided, true));
    assert_eq!(outcome(2200, &[]).0, Outcome::Different);
    // Another table is another one inside of them.
    assert_eq!(outcome(2000, told).0, Outcome::Different);
}
