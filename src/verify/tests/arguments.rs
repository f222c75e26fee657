//! Functions by arithmetic, which gives the same for some arguments only.

use super::assumed::{assumption, place};
use super::{SymbolMap, supposing};
use crate::assume::{Assumption, Domain, Predicate};
use crate::canon::Func;
use crate::verify::{Outcome, Why};

/// The digits of #1 as those of a BCD word, for whole numbers of up to eight; `six` is 6.
fn by_arithmetic(six: u32) -> String {
    let terms =
        (2..8).map(|i| format!("#161=#161+FIX[#1/1{}]*{}\n", "0".repeat(i), 6 * 16u32.pow(i as u32 - 1)));
    format!(
        "O1\nG21G90\nIF[#1LT12]GOTO9\n#161=#1+FIX[#1/10]*{six}\n{}G0X#161\nN9M30\n",
        terms.collect::<String>()
    )
}

#[test]
fn an_argument_that_the_conversion_does_not_hold_for_is_a_condition() {
    let source = "O1\nG21G90\nIF[#1LT12]GOTO9\nG0X[BCD[#1]]\nN9M30\n";
    let outcome = |target: &str, supposed: &[(usize, Assumption)]| {
        let names = SymbolMap { scratch: [161].into(), ..SymbolMap::default() };
        let found = supposing(("fanuc", source), ("haas", target), names, supposed);
        let broken = found[0].reasons.iter().any(|reason| reason.why == Why::Condition);
        (found[0].outcome, broken)
    };
    let places = place(source, "G0X[BCD[#1]]");
    let domain = Domain::Digits(8);
    let domain = [assumption(Predicate::Arguments { function: Func::Bcd, places, domain })];
    assert_eq!(outcome(&by_arithmetic(6), &domain), (Outcome::Undecided, true));
    // Nobody said so, and inside of it they differ.
    assert_eq!(outcome(&by_arithmetic(6), &[]).0, Outcome::Different);
    assert_eq!(outcome(&by_arithmetic(7), &domain).0, Outcome::Different);
}
