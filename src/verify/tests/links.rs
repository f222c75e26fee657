//! Which programs of a side call which.

use crate::control::{LoadedFile, ProgramRef};
use crate::dialect::{Control, registry};
use crate::syntax::parse_file;
use crate::verify::Side;
use std::fmt::Write;

/// Calls a look with the side of one file.
fn with_side(text: &str, look: impl FnOnce(&Side<'_>)) {
    let control = Control::plain("fanuc").unwrap();
    let entry = registry::find("fanuc").unwrap();
    let parsed = parse_file(text.as_bytes(), entry.parse);
    let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
    look(&Side::new(&control, entry.execute.unwrap(), &files));
}

fn nth(program: usize) -> ProgramRef {
    ProgramRef { file: 0, program }
}

#[test]
fn calls_are_followed_as_deep_as_a_control_nests_them() {
    let mut text = String::new();
    (1..=150).for_each(|at| writeln!(text, "O{at}\nM98 P{}\nM99", at + 1).unwrap());
    with_side(&text, |side| {
        let all = side.links().called_from(nth(0), |_| true);
        assert_eq!(all, (0..=100).map(nth).collect::<Vec<_>>());
        let some = side.links().called_from(nth(0), |program| program.program < 5);
        assert_eq!(some, (0..5).map(nth).collect::<Vec<_>>());
    });
}

#[test]
fn a_program_that_calls_itself_is_not_one_that_others_call() {
    with_side("O1\nM98 P1\nM98 P2\nM98 P2\nM99\nO2\nM99\n", |side| {
        assert_eq!(side.links().callees(nth(0)), [nth(0), nth(1)]);
        assert!(!side.links().is_called(nth(0)));
        assert!(side.links().is_called(nth(1)));
    });
}
