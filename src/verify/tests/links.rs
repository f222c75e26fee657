//! Which programs of a side call which.

use super::{Outcome, programs};
use crate::control::{LoadedFile, ProgramRef};
use crate::dialect::{Control, registry};
use crate::syntax::parse_file;
use crate::verify::Side;
use std::fmt::Write;

/// Calls a look with the side of one file.
fn with_side<T>(text: &str, look: impl FnOnce(&Side<'_>) -> T) -> T {
    on(&Control::plain("fanuc").unwrap(), text, look)
}

/// The same on a control of one's own.
fn on<T>(control: &Control, text: &str, look: impl FnOnce(&Side<'_>) -> T) -> T {
    let entry = registry::find(control.name()).unwrap();
    let parsed = parse_file(text.as_bytes(), entry.parse);
    let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
    look(&Side::new(control, entry.execute.unwrap(), &files))
}

/// Whether the first program of a file may call another one.
fn may_call(control: &Control, blocks: &str) -> bool {
    let text = format!("O1\nG90G17\n{blocks}\nM30\nO2\nM99\n");
    on(control, &text, |side| side.links().may_call(nth(0)))
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

/// P is a time, a block, or a row of offsets beside such codes.
#[test]
fn a_number_that_names_no_program() {
    let haas = Control::plain("haas").unwrap();
    on(&haas, "O1\nG4 P2\nM97 P2\nG10 L2 P2 X0\nN2 M99\nO2\nM99\n", |side| {
        assert!(!side.links().is_called(nth(1)))
    });
    for call in ["M98 P2", "G65 P2", "M777 P2", "P2", "G4 P2 M98"] {
        on(&haas, &format!("O1\n{call}\nM30\nO2\nM99\n"), |side| {
            assert!(side.links().is_called(nth(1)), "{call}");
        });
    }
}

/// A program that parameters make a code call is no main program.
#[test]
fn what_a_code_calls_is_called() {
    let control = Control::from_profile("dialect = \"fanuc\"\n[parameters]\n6071 = 201\n6050 = 183").unwrap();
    on(&control, "O1\nM201\nG183 X1.\nM30\nO9001\nM99\nO9010\nM99\nO9002\nM99\n", |side| {
        assert_eq!(side.links().callees(nth(0)), [nth(1), nth(2)]);
        assert!(side.links().is_called(nth(1)) && side.links().is_called(nth(2)));
        assert!(!side.links().is_called(nth(3)));
    });
}

/// A number that is written names what is called; one that is computed, and a code that nobody knows, may call anything.
#[test]
fn what_is_not_named_may_be_any_program() {
    let fanuc = Control::plain("fanuc").unwrap();
    for calls in ["M98P2", "G65P2A1.", "M98P#1", "G65P[#1+1]A1.", "G#1X1.", "M#1", "M98", "G65A1.", "M290"] {
        assert!(may_call(&fanuc, calls), "{calls}");
    }
    // No program has these numbers, and a cycle calls none that stands in no file.
    for calls_none in
        ["G0X1.", "M98P7", "G65P7A1.", "M8", "G81Z-1.R1.F50.", "G4P500", "#1=#2+1", "T2M6", "S500M3"]
    {
        assert!(!may_call(&fanuc, calls_none), "{calls_none}");
    }
}

/// Parameters make codes calls that the table has for something else: whether they do is the machine's matter.
#[test]
fn a_code_that_the_profile_makes_a_call_may_call() {
    let plain = Control::plain("fanuc").unwrap();
    let parameters = "6050 = 81\n6051 = -82\n6071 = 8\n6080 = 50\n";
    let profile = format!("dialect = \"fanuc\"\n[parameters]\n{parameters}");
    let aliased = Control::from_profile(&profile).unwrap();
    for code in ["M8", "G81Z-1.R1.F50.", "G82Z-1.R1.P100F50.", "X1.M8"] {
        assert!(may_call(&aliased, code), "{code}");
        assert!(!may_call(&plain, code), "{code}");
    }
    // The code and nothing else: not another one, nor a word of another letter with its number.
    for other in ["M9", "G83Z-1.R1.Q1.F50.", "G1X8.F81.", "S8M3", "T8M6"] {
        assert!(!may_call(&aliased, other), "{other}");
    }
}

/// Who may call what its text does not name may come to any program, and so may who calls it.
#[test]
fn an_alias_may_reach_any_program() {
    let aliased = Control::from_profile("dialect = \"fanuc\"\n[parameters]\n6071 = 8\n").unwrap();
    let text = "O1\nM98P2\nM30\nO2\nM8\nM99\nO3\nG0X1.\nM99\n";
    let reaches = |side: &Side<'_>| {
        [(0, 1), (0, 2), (1, 2), (2, 1), (1, 0)].map(|(from, to)| side.links().may_reach(nth(from), nth(to)))
    };
    assert_eq!(on(&aliased, text, reaches), [true, true, true, false, true]);
    let plain = Control::plain("fanuc").unwrap();
    assert_eq!(on(&plain, text, reaches), [true, false, false, false, false]);
}

/// The words of a macro's call are arguments; those beside a call of a subprogram, or of an alias that takes none, move.
#[test]
fn arguments_move_no_rotary_axis() {
    let parameters = "6071 = 8\n6080 = 50\n";
    let profile = format!("dialect = \"fanuc\"\n[parameters]\n{parameters}");
    let control = Control::from_profile(&profile).unwrap();
    let rotary = |block: &str| {
        let text = format!("O1\nG90G17\n{block}\nM30\nO2\nG0X#1Y#2\nM99\n");
        on(&control, &text, |side| side.links().rotary())
    };
    for arguments in ["G65P2A1.B2.C3.", "G66P2A1.B2.\nX1.\nG67", "M50A1.B2.", "G65P7C1.", "G0X1."] {
        assert_eq!(rotary(arguments), [false; 3], "{arguments}");
    }
    assert_eq!(rotary("G0A90."), [true, false, false]);
    assert_eq!(rotary("G1B9.C9.F9."), [false, true, true]);
    assert_eq!(rotary("M98P2A90."), [true, false, false]);
    assert_eq!(rotary("G0C90.M8"), [false, false, true]);
    assert_eq!(rotary("G65P2A1.\nG0B90."), [false, true, false]);
}

/// All axes return, of which arguments show none: the rotary ones stand at their reference position.
#[test]
fn a_return_of_all_axes_beside_a_macro() {
    let source = "O1\nG20G90G17G40G80G94G49\nG54\nG0X1.\nG65P2A1.B2.\nG28\nM30\nO2\nG0Y#1\nM99\n";
    let target = source.replace("G28\n", "G91G28X0.Y0.Z0.\nG90\n");
    let judged =
        |source: &str, target: &str| programs(("haas", source), ("fanuc", target), &[]).remove(0).outcome;
    assert_ne!(judged(source, &target), Outcome::Different);
    assert_eq!(judged(source, &target.replace("Z0.", "")), Outcome::Different);
    // Where a program has a rotary axis, it is to return too.
    let [source, target] = [source, target.as_str()].map(|text| text.replace("G0X1.", "G0X1.A90."));
    assert_eq!(judged(&source, &target), Outcome::Different);
}
