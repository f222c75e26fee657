//! Small programs and what they become on another control: `tests/conversions/`, in the form of `support/cases.rs`.
//! What is expected was written from the controls' manuals, not from what the compiler printed.

#[path = "support/cases.rs"]
mod cases;
#[path = "support/machine.rs"]
mod machine;

use cases::{Case, cases, hold};
use machine::machine;
use macroglot::diag::Code;
use macroglot::dialect::Control;
use macroglot::library::{Input, Lock, Options, convert};
use std::collections::BTreeSet;

/// What is wrong with the conversion, if anything is.
fn fault(case: &Case) -> Option<String> {
    let [source, target] =
        [&case.from, &case.to].map(|spec| machine(spec).unwrap_or_else(|error| panic!("{error}")));
    let (source, target) = Control::meeting(source, target).unwrap_or_else(|error| panic!("{error}"));
    let bytes = case.source.clone().into_bytes();
    let inputs = [Input { path: "case.nc".into(), name: "case.nc".into(), bytes }];
    let lock = Lock::new(source.name(), target.name());
    let made = convert(&inputs, &source, &target, lock, Options::default());
    let found = made.programs.iter().flat_map(|program| &program.diagnostics);
    // Whether a fact is common or confirmed is the tables' matter: tests/dialects.rs.
    let found = found.filter(|found| found.code != Code::CommonFact);
    let reports: BTreeSet<String> = found.map(|found| found.code.number().to_owned()).collect();
    let text = match made.texts.first() {
        Some(Some(text)) => text.trim().trim_matches('%').trim().to_owned(),
        _ => "refused".into(),
    };
    let wanted = if case.refused { "refused" } else { case.target.trim() };
    (text != wanted || reports != case.reports).then(|| {
        let Case { to, source, reports: expected, .. } = case;
        format!("to {to}\n{source}\nwanted {expected:?}\n{wanted}\ngot {reports:?}\n{text}")
    })
}

#[test]
fn programs_become_what_the_manuals_make_of_them() {
    let cases = cases("tests/conversions");
    assert!(cases.iter().all(|case| case.refused == case.target.is_empty()), "a case has one of the two");
    hold(&cases, 300, fault);
}
