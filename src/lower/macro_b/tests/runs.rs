//! What lowered programs do when they are run, against the makers' figures
//! (`corpus/fanuc/values.tsv`, `corpus/haas/values.tsv`) and counts made by hand.

use super::lowered;
use crate::canon::Sys;
use crate::ir::eval::{Ending, Memory, Trace, run};
use crate::ir::{Class, Module, Var};

/// Runs the first program of a source.
fn trace(control: &str, source: &str, memory: &mut Memory) -> Trace {
    let programs = lowered(control, source).programs.into_iter().map(|(program, _)| program).collect();
    run(&Module { programs, ..Module::default() }, 0, memory, &[], 100_000)
}

fn corpus(name: &str) -> String {
    std::fs::read_to_string(format!("{}/corpus/fanuc/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn var(number: u32) -> Var {
    let class = match number {
        1..=33 => Class::Local,
        500.. => Class::Retained,
        _ => Class::Common,
    };
    Var { class, number }
}

/// Statements, a variable, and what it holds then; none for vacant.
const VALUES: &[(&str, u32, Option<f64>)] = &[
    ("#2=#1", 2, None),
    ("#2=[#1]", 2, None),
    ("#2=#1+#1", 2, Some(0.0)),
    ("#2=#1*5", 2, Some(0.0)),
    ("#2=0\nIF[#1EQ0]THEN#2=1", 2, Some(0.0)),
    ("#2=0\nIF[#1NE0]THEN#2=1", 2, Some(1.0)),
    ("#2=0\nIF[#1EQ#0]THEN#2=1", 2, Some(1.0)),
    ("#3=0\nIF[#2NE#0]THEN#3=1", 3, Some(0.0)),
    ("#2=0\nIF[#1LT0]THEN#2=1", 2, Some(0.0)),
    ("#2=0\nIF[#1LE0]THEN#2=1", 2, Some(1.0)),
    ("#2=0\nIF[#1GT0]THEN#2=1", 2, Some(0.0)),
    ("#2=0\nIF[#1GE0]THEN#2=1", 2, Some(1.0)),
    ("#1=123", 1, Some(123.0)),
    ("#1=ATAN[-1]/[-1]", 1, Some(225.0)),
    ("#100=[ATAN[1]]/10", 100, Some(4.5)),
    ("#100=ATAN[1]/[10]", 100, Some(5.710593)),
    ("#2=1.2345\n#1=ROUND[#2]", 1, Some(1.0)),
    ("#1=1.2\n#3=FUP[#1]", 3, Some(2.0)),
    ("#2=-1.2\n#3=FUP[#2]", 3, Some(-2.0)),
    ("#2=-1.2\n#3=FIX[#2]", 3, Some(-1.0)),
    ("#1=7.5MOD2", 1, Some(0.0)),
    ("#1=2\n#2=5\n#100=#1*[#2-3]", 100, Some(4.0)),
    ("#100=506\n#[#100]=2.\n#[#100]=#[#100]+3", 506, Some(5.0)),
    ("#10=60\n#20=30\nIF[#10GT#20]THEN#1=#10-#20", 1, Some(30.0)),
];

#[test]
fn values_are_the_makers() {
    for (source, number, expected) in VALUES {
        let mut memory = Memory::new();
        let trace = trace("fanuc", &format!("O1\n{source}\nM30\n"), &mut memory);
        assert_eq!(trace.ending, Ending::End, "{source}");
        let got = memory.vars.get(&var(*number)).copied().flatten();
        let near = got.zip(*expected).is_some_and(|(got, wanted)| (got - wanted).abs() < 1e-6);
        assert!(near || (got, *expected) == (None, None), "{source}: {got:?}");
    }
}

#[test]
fn sums_of_one_to_ten() {
    for name in ["o9500-sum-goto.nc", "o0001-sum-while.nc"] {
        let mut memory = Memory::new();
        assert_eq!(trace("fanuc", &corpus(name), &mut memory).ending, Ending::End);
        assert_eq!(memory.vars.get(&var(1)), Some(&Some(55.0)), "{name}");
    }
}

/// The last value of an argument that each call sees, by what the called program copies.
#[test]
fn arguments_arrive() {
    let seen = |control: &str, call: &str, local: u32| {
        let mut memory = Memory::new();
        let source = format!("O1\n#{local}=99\n{call}\nM30\nO1000\n#100=#{local}\nM99\n");
        assert_eq!(trace(control, &source, &mut memory).ending, Ending::End, "{call}");
        memory.vars.get(&var(100)).copied().flatten()
    };
    assert_eq!(seen("fanuc", "G65A1.0B2.0I-3.0I4.0D5.0P1000", 7), Some(5.0));
    assert_eq!(seen("fanuc", "G65A1.0B2.0I-3.0I4.0D5.0P1000", 4), Some(-3.0));
    assert_eq!(seen("fanuc", "G65P1000K1.J2.I3.", 10), Some(3.0));
    // An argument that is left out is vacant, whatever the caller's local holds.
    assert_eq!(seen("fanuc", "G65P1000A1.", 26), None);
    // A subprogram sees the caller's locals.
    assert_eq!(seen("fanuc", "M98P1000", 26), Some(99.0));
}

/// U6 V5 along a frame: six holes a row and five a column, 18 in all, by the corpus. The first
/// is drilled where the frame begins, and the last move returns near it.
#[test]
fn the_frame_has_eighteen_holes() {
    let mut memory = Memory::new();
    memory.state.insert((Sys::Modal, vec![3]), Some(90.0));
    let source = format!("{}\n{}", corpus("o0023-frame-main.nc"), corpus("o8103-frame-macro.nc"));
    let trace = trace("fanuc:decimal_point = \"calculator\"", &source, &mut memory);
    let start = trace.events.iter().position(|event| event.contains("distance.absolute axis.x=10")).unwrap();
    let holes = trace.events[start..]
        .iter()
        .take_while(|event| !event.contains("cycle.off") && !event.contains("axis.z"))
        .filter(|event| event.contains("axis.x") || event.contains("axis.y"))
        .count();
    assert_eq!(holes, 18, "{:#?}", trace.events);
}
