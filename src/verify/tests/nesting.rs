//! Calls that nest deeper than the target takes, where the conversion has made that a condition.

use super::assumed::assumption;
use super::{SymbolMap, supposing};
use crate::assume::Predicate;
use crate::verify::{Outcome, ProgramCertificate, Why};

/// The outcome of O1 and why, where the conversion has reported the limit, and where it has not.
fn outcomes(source: &str, target: &str) -> [(Outcome, bool); 2] {
    let broken = |program: &ProgramCertificate| {
        (program.outcome, program.reasons.iter().any(|reason| reason.why == Why::Condition))
    };
    let (limit, counts) = ("call.macro".into(), [false, true]);
    let nesting = [assumption(Predicate::Nesting { limit, counts, most: 5 })];
    [&nesting[..], &[]].map(|supposed| {
        let found = supposing(("haas", source), ("fanuc", target), SymbolMap::default(), supposed);
        broken(&found[0])
    })
}

/// O2 calls itself as often as #500 says: five levels are what the target takes, nine the source.
fn library(inside: &str, behind: &str) -> String {
    format!("O1\nG21G90\nG0X0\nG65P2A#500\n{behind}\nM30\nO2\nIF[#1LE0]GOTO9\n{inside}\nN9M99\n")
}

#[test]
fn a_depth_that_data_decides_is_a_condition() {
    use Outcome::{Different, Undecided};
    // Moves on the way down, on the way up, after all of it, and nowhere.
    for (inside, behind) in [
        ("G0X#1\nG65P2A[#1-1]", "G0X99."),
        ("G65P2A[#1-1]\nG0X#1", "G0X99."),
        ("#501=#501+#1\nG65P2A[#1-1]", "G0X[FIX[#501]]"),
        ("#501=#501+#1\nG65P2A[#1-1]", "#502=1"),
    ] {
        let both = library(inside, behind);
        assert_eq!(outcomes(&both, &both), [(Undecided, true), (Different, false)], "{both}");
    }
}

#[test]
fn what_differs_besides_the_depth_is_different() {
    let source = library("G0X#1\nG65P2A[#1-1]", "G0X99.");
    let differs = |target: &str| outcomes(&source, target)[0].0 == Outcome::Different;
    assert!(differs(&source.replace("G0X#1", "G0X-#1")));
    assert!(differs(&source.replace("G0X0", "G0X1.")));
    assert!(differs(&source.replace("G0X99.", "G0X98.")));
    // The target nests where the source does not.
    assert!(differs(&source.replace("LE0", "LE-7")));
    let flat = library("G0X#1", "G0X99.");
    assert_eq!(outcomes(&flat, &library("G0X#1\nG65P2A[#1]", "G0X99."))[0].0, Outcome::Different);
}
