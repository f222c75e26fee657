//! What lowered programs do when they are run, against the manual's figures and
//! counts made by hand.

use super::control;
use crate::ir::eval::{Ending, Memory, Trace, run};
use crate::ir::{Class, Module, Var};
use crate::syntax::{fadal::parse_line, parse_file};

/// Runs the first program of a source.
fn trace(source: &str, answers: &[f64]) -> (Trace, Memory) {
    let parsed = parse_file(source.as_bytes(), parse_line);
    let lowered = super::lower(&parsed, 0, "test", &control(""));
    let programs = lowered.programs.into_iter().map(|(program, _)| program).collect();
    let module = Module { programs, ..Module::default() };
    let mut memory = Memory::new();
    let trace = run(&module, 0, &mut memory, answers, 100_000);
    (trace, memory)
}

fn corpus(name: &str) -> String {
    std::fs::read_to_string(format!("{}/corpus/fadal/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn value(memory: &Memory, name: &str) -> f64 {
    let (class, number) = name.split_at(1);
    let class = if class == "R" { Class::Parametric } else { Class::Global };
    let var = Var { class, number: number.parse().unwrap() };
    memory.vars.get(&var).copied().flatten().unwrap_or(0.0)
}

/// Statements, a variable, and what the manual says that it holds then.
#[allow(clippy::approx_constant)] // the manual prints six places
const VALUES: &[(&str, &str, f64)] = &[
    ("#V1=-2.3\n#V2=ABS(V1)", "V2", 2.3),
    ("#V23=12.345\n#V99=INT(V23)", "V99", 12.0),
    ("#V23=-12.513\n#V99=INT(V23)", "V99", -12.0),
    ("#V77=1\n#V50=SGN(V77-V78)", "V50", 1.0),
    ("#V50=SGN(V77-V78)", "V50", 1.0),
    ("#V78=1\n#V50=SGN(V77-V78)", "V50", -1.0),
    ("#V46=SQR(9)", "V46", 3.0),
    ("#V12=SIN(30)/COS(30)", "V12", 0.577350),
    ("#V1=.5\n#V2=ATN(V1/SQR(1-V1*V1))", "V2", 30.0),
    ("#SET RAD\n#V1=.5\n#V2=1.570796-ATN(V1/SQR(1-V1*V1))", "V2", 1.047198),
    ("#SET RAD\n#V1=SIN(.523599)", "V1", 0.5),
    ("#V5=2.34567\n#SET RND4\n#V1=RND(V5)", "V1", 2.3457),
    ("#V5=2.34567\n#V1=INT(V5*10000)/10000", "V1", 2.3456),
    ("#V1=.1875/COS(5)", "V1", 0.188216),
    ("#V1=SIN(5)/COS(5)*.1875", "V1", 0.016404),
    ("#V2=1000\n#R4=(6000/V2)*.75", "R4", 4.5),
    ("#V3=.05\n#V4=V3*.3", "V4", 0.015),
    ("R5+10.\n#R7=360/R5", "R7", 36.0),
    ("R3+30.\n#V1=2.5\n#R9=SIN(R3)*V1", "R9", 1.25),
    ("R3+30.\n#V1=2.5\n#R8=COS(R3)*V1", "R8", 2.165064),
    ("#V1=5\n#V2=1\n#V(V1+V2-1)=7", "V5", 7.0),
    ("#V1=5\n#V2=1\n#V(V(SQR(V2)))=7", "V5", 7.0),
    ("#V1=5\n#CLEAR\n#V2=V1+1", "V2", 1.0),
    ("#V1=-1\n#IF (V1 + V6) <= 0 THEN V7 = ABS(V1 + V6)", "V7", 1.0),
    ("R7-2.5 R6-R7", "R6", 2.5),
];

#[test]
fn values_are_the_manuals() {
    for (source, name, expected) in VALUES {
        let (trace, memory) = trace(&format!("O1\n{source}\nM2\n"), &[]);
        assert_eq!(trace.ending, Ending::End, "{source}");
        let got = value(&memory, name);
        assert!((got - expected).abs() < 1e-6, "{source}: {got}");
    }
}

#[test]
fn rotation_by_a_quarter_turn() {
    let source = format!("O1\nR3+1. R4+0 R9+90.\n#V1=10\n#V2=20\nM98 P900\nM2\n{}", corpus("o900-rotate.nc"));
    let (trace, memory) = trace(&source, &[]);
    assert_eq!(trace.ending, Ending::End);
    assert!((value(&memory, "R5") - 10.0).abs() < 1e-12 && (value(&memory, "R6") - 21.0).abs() < 1e-12);
}

fn count(trace: &Trace, what: &str) -> usize {
    trace.events.iter().filter(|event| event.contains(what)).count()
}

#[test]
fn loops_and_subroutines_run_as_often_as_they_should() {
    // L301 three times; each runs L200 twice by L102, once, and twice by R2=202; three arcs each.
    let (slot, _) = trace(&corpus("slot-parametric.nc"), &[]);
    assert_eq!((slot.ending.clone(), count(&slot, "motion.arc.ccw")), (Ending::End, 45));
    // 1.687 in steps of .01 down to zero or below: 169 steps.
    let (taper, _) = trace(&corpus("o7-taper-rectangle.nc"), &[]);
    assert_eq!((taper.ending.clone(), count(&taper, "axis.y")), (Ending::End, 2 + 3 * 169));
    // 10 by 10 places, and the one of the cycle's own block.
    let (grid, _) = trace(&corpus("o1234-drill-grid.nc"), &[]);
    let first = grid.events.iter().position(|event| event.contains("cycle.drill")).unwrap();
    let last = grid.events.iter().position(|event| event.starts_with("nc cycle.off spindle")).unwrap();
    assert_eq!((grid.ending, last - first), (Ending::End, 101));
    // Turned by 36 to 288 degrees: 8 places, 9 holes with the cycle's own (the manual means 10).
    let (bolts, _) = trace(&corpus("o5-bolt-pattern.nc"), &[]);
    assert_eq!((bolts.ending.clone(), count(&bolts, "rotate.on")), (Ending::End, 8));
}

#[test]
fn the_ellipse_halts_at_a_root_below_zero() {
    // Its last step passes the end by a rounding error.
    let (ellipse, _) = trace(&corpus("o9-ellipse.nc"), &[-1.0, 4.0, 2.0]);
    assert!(matches!(ellipse.ending, Ending::Alarm(_)), "{:?}", ellipse.ending);
    assert_eq!(ellipse.events.iter().filter(|event| event.contains("X DIMENSION")).count(), 2);
}
