//! The rows of `corpus/fadal/values.tsv` that running can check.
#![allow(clippy::approx_constant)] // the manual's own digits

use crate::canon::Sys;
use crate::control::scenario::StateValue;
use crate::control::testing::*;
use crate::control::trace::EventKind;
use crate::control::{End, Scenario};

/// Runs macro lines from given values and looks at one variable.
#[track_caller]
fn gives(given_values: &[(&str, f64)], lines: &str, name: &str, expected: f64) {
    let run = run("fadal", &[("t.nc", lines.as_bytes())], &given(given_values));
    ended(&run);
    let found = run.variables.get(name).copied().unwrap_or(f64::NAN);
    assert!((found - expected).abs() < 5e-7, "{lines}: {name} is {found}, expected {expected}");
}

#[test]
fn functions() {
    gives(&[("V1", -2.3)], "#V2 = ABS (V1)", "V2", 2.3);
    gives(&[("V1", 2.3)], "#V2 = ABS (V1)", "V2", 2.3);
    for (given, expected) in [(12.345, 12.0), (-12.345, -12.0), (12.513, 12.0), (-12.513, -12.0)] {
        gives(&[("V23", given)], "#V100 = INT(V23)", "V100", expected);
    }
    for (given, expected) in [(5.0, 1.0), (4.0, 1.0), (3.0, -1.0)] {
        gives(&[("V77", given), ("V78", 4.0)], "#V50 = SGN (V77 - V78)", "V50", expected);
    }
    gives(&[], "#V46 = SQR(9)", "V46", 3.0);
    gives(&[], "#V12 = SIN(30) / COS(30)", "V12", 0.577350269);
    gives(&[("V1", 1.23456)], "#SET RND4\n#V1 = RND(V1)", "V1", 1.2346);
    gives(&[("V5", 1.23456)], "#V1=INT(V5 * 10000)/10000", "V1", 1.2345);
}

#[test]
fn the_root_of_a_negative_number_halts() {
    let text = b"#V45 = SQR(V1 - (V63 * V29))\n#V1=99";
    let run = run("fadal", &[("t.nc", text)], &given(&[("V1", 1.0), ("V63", 2.0), ("V29", 3.0)]));
    assert!(matches!(run.end, End::Alarm { .. }));
    assert_eq!(run.variables.get("V1"), Some(&1.0));
}

#[test]
fn subscripts() {
    gives(&[], "#V(5)=1", "V5", 1.0);
    let two = [("V1", 5.0), ("V2", 1.0)];
    for line in ["#V(V1)=1", "#V(V1+V2-1)=1", "#V(V1/V2)=1", "#V(V(SQR(V2)))=1"] {
        gives(&two, line, "V5", 1.0);
    }
}

#[test]
fn angles() {
    let (half, third) = (std::f64::consts::FRAC_PI_6, std::f64::consts::FRAC_PI_3);
    let radians = |line: &str| format!("#SET RADIANS\n#V2=.5\n{line}");
    gives(&[], &radians("#V1 = 1.570796 - ATN(V2 / SQR(1 - V2 * V2))"), "V1", third - 3.27e-7);
    gives(&[], &radians("#V1 = ATN(V2 / SQR(1 - V2 * V2))"), "V1", half);
    gives(&[], "#SET RADIANS\n#SET DEGREES\n#V1 = ATN(1)", "V1", 45.0);
    gives(&[], "#SET RADIANS\n#SET\n#V1 = ATN(1)", "V1", 45.0);
    gives(&[("V2", 180.0)], "#V1 = ((V2 * 3.14159265) / 180)", "V1", 3.14159265);
    gives(&[("V2", 3.14159265)], "#V1 = ((V2 * 180) / 3.14159265)", "V1", 180.0);
}

#[test]
fn arithmetic_of_the_programs() {
    // To the four places that are printed.
    let printed = |line: &str, expected: f64| {
        let text = format!("#SET RND4\n#V1=RND({line})");
        gives(&[], &text, "V1", expected);
    };
    printed(".1875 / COS(5)", 0.1882);
    printed("SIN(5)/COS(5) * .1875", 0.0164);
    printed(".1882 - .0164", 0.1718);
    printed("3.1416 * 1.5", 4.7124);
    printed("4.7124 / 180", 0.0262);
    printed("1.25 / 2", 0.625);
    gives(&[("V2", 1000.0)], "#V1=(6000/V2)*.75", "V1", 4.5);
    gives(&[("V3", 0.05)], "#V4=V3*.3", "V4", 0.015);
    gives(&[], "R5+10.\n#R7=360/R5", "R7", 36.0);
    gives(&[("V1", 2.5)], "R3+30.\n#R9=SIN(R3)*V1", "R9", 1.25);
    gives(&[("V1", 2.5)], "R3+30.\n#R8=COS(R3)*V1", "R8", 2.165064);
    gives(&[], "#V1=5", "V1", 5.0);
    gives(&[], "#V1=2+3*4-6/2", "V1", 11.0);
    gives(&[], "#V1=-2*3+1", "V1", -5.0);
    gives(&[], "#V1=1\n#IF (1=2) OR (2=2) AND (3=3) THEN V1=7", "V1", 7.0);
}

#[test]
fn signs_before_r_multiply() {
    let run_line = |line: &[u8]| run("fadal", &[("t.nc", line)], &given(&[]));
    let run = run_line(b"R1+10. R2+5.\nG1 X - R1 Y + R2. F10.");
    near(feeds(&run)[0], [-10.0, 5.0, 0.0]);
    let run = run_line(b"R3+7.5 R4+5.5 R5+0\nX + R3. I - R4 J - R5 G3 F10.");
    let arc = run.events.iter().find_map(|event| match &event.what {
        EventKind::Arc { to, centre, .. } => Some((xyz(to), xyz(centre))),
        _ => None,
    });
    let (to, centre) = arc.unwrap();
    near(to, [7.5, 0.0, 0.0]);
    near(centre, [-5.5, 0.0, 0.0]);
    let run = run_line(b"R8+50.0\nN13 F+R8\nG1 X1.");
    assert!(run.events.iter().any(|event| matches!(event.what, EventKind::Feed { feed: 50.0, .. })));
}

#[test]
fn lines_of_output() {
    let cell =
        |axis: u32, value: f64| StateValue { state: Sys::ProbePoint, subscripts: vec![axis, 1], value };
    let scenario = Scenario { state: vec![cell(1, 18.5), cell(2, 17.65)], ..given(&[("V1", 1.0)]) };
    let point = run("fadal", &[("t.nc", br##"# PRINT "POINT #",V1," IS X",PX1," Y",PY1"##)], &scenario);
    assert_eq!(output(&point), ["POINT #1 IS X18.5 Y17.65"]);
    let printed = |line: &str, variables: &[(&str, f64)]| {
        let run = run("fadal", &[("t.nc", line.as_bytes())], &given(variables));
        output(&run).iter().map(|line| (*line).to_owned()).collect::<Vec<_>>()
    };
    let parts = [("V4", 98645.0), ("V10", 36920.0)];
    assert_eq!(printed(r##"# SPRINT "PART NUMBER ",V4," DATA""##, &parts), ["PART NUMBER 98645 DATA"]);
    assert_eq!(printed("#PRINT V10", &parts), ["36920"]);
    assert_eq!(printed(r##"#PRINT "THIS IS PART NUMBER ",V10"##, &parts), ["THIS IS PART NUMBER 36920"]);
    assert_eq!(printed("#PRINT \"A\",\n#PRINT \"B\"\n#PRINT \"C\",", &[]), ["AB", "C"]);
    // Two values are two numbers, on one line or by two commands.
    assert_eq!(printed(r##"#PRINT "H",V4,V10,"!""##, &parts), ["H98645 36920!"]);
    assert_eq!(printed("#PRINT V4,\n#PRINT V10", &parts), ["98645 36920"]);
}

#[test]
fn machine_state() {
    for (code, expected) in [("G0", 1.0), ("G1", 2.0), ("G2", 3.0), ("G3", 4.0)] {
        gives(&[], &format!("{code}\n#V1=G(1)"), "V1", expected);
    }
    let one = |state: Sys, number: u32, value: f64| Scenario {
        state: vec![StateValue { state, subscripts: vec![number], value }],
        ..Scenario::default()
    };
    let read = |line: &[u8], scenario: Scenario| run("fadal", &[("t.nc", line)], &scenario).variables["V1"];
    assert_eq!(read(b"#V1=TU5", one(Sys::ToolTimeUsed, 5, 10.0)), 10.0);
    assert_eq!(read(b"#TU(5)=TU(5)+7\n#V1=TU5", one(Sys::ToolTimeUsed, 5, 10.0)), 17.0);
    assert_eq!(read(b"#V1=TT3", one(Sys::ToolTimeLimit, 3, 25.0)), 25.0);
    assert_eq!(read(b"#V1=I(3)", one(Sys::InputInverted, 3, 1.0)), 1.0);
    // An input that nothing switches on is off, which reads 1 (seed 000:378).
    assert_eq!(read(b"#V1=I(3)", Scenario::default()), 1.0);
    assert_eq!(read(b"#V1=I(3)", one(Sys::Input, 3, 1.0)), 0.0);
    let run = run("fadal", &[("t.nc", b"#O(1) = 0")], &Scenario::default());
    let low = |what: &EventKind| matches!(what, EventKind::Write { state: Sys::Output, value: 1.0, .. });
    assert!(run.events.iter().any(|event| low(&event.what)));
}

#[test]
fn an_empty_answer_is_zero() {
    gives(&[("V1", 3.0)], "#INPUT V1", "V1", 0.0);
    let answered = run("fadal", &[("t.nc", b"#INPUT V1\n#SINPUT V2")], &answering(&[4.0, 5.0]));
    assert_eq!((answered.variables["V1"], answered.variables["V2"]), (4.0, 5.0));
}
