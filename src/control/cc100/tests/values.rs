//! The rows of `corpus/cc100/values.tsv` that running can check.

use super::corpus;
use crate::control::scenario::{Scenario, Tool};
use crate::control::testing::*;
use crate::control::{End, Run};

fn lines(text: &str, variables: &[(&str, f64)]) -> Run {
    run("cc100", &[("t.nc", text.as_bytes())], &given(variables))
}

#[track_caller]
fn gives(given: &[(&str, f64)], text: &str, expected: &[(&str, f64)]) {
    let run = lines(text, given);
    ended(&run);
    for (name, value) in expected {
        let found = run.variables.get(*name).copied().unwrap_or(f64::NAN);
        assert!((found - value).abs() < 5e-7, "{text}: {name} is {found}, expected {value}");
    }
}

#[test]
fn words_take_variables() {
    let run = lines("G1 F100\nX=V1\nX=V3 Y=V2\n", &[("V1", 50.0), ("V2", 25.0), ("V3", 40.0)]);
    near(feeds(&run)[0], [50.0, 0.0, 0.0]);
    near(feeds(&run)[1], [40.0, 25.0, 0.0]);
}

#[test]
fn statements_go_from_left_to_right() {
    gives(&[("V1", 15.0)], "V1=V1+1 VZ=V1* -1", &[("V1", 16.0), ("VZ", -16.0)]);
}

/// The auto offset cycle, with the values of its table.
#[test]
fn the_cycle_sets_three_shifts() {
    let alone = corpus("cycle20-auto-offset.nc", &given(&[("VX", 340.0), ("VY", 265.0)]));
    assert_eq!((alone.variables["V22"], alone.variables["V23"]), (500.0, 180.0));
    let read = "VX=340 VY=265\nG820\nTRF=G54 V1=X V2=Y\nTRF=G55 V3=X V4=Y\nV9=56\nTRF=V9 V5=X V6=Y\nM30\n";
    let cycle = std::fs::read("corpus/cc100/cycle20-auto-offset.nc").unwrap();
    let run = run("cc100", &[("t.nc", read.as_bytes()), ("cycle20.nc", &cycle)], &given(&[]));
    ended(&run);
    let shifts = ["V1", "V2", "V3", "V4", "V5", "V6"].map(|name| run.variables[name]);
    assert_eq!(shifts, [340.0, 265.0, 500.0, 265.0, 180.0, 265.0]);
}

#[test]
fn inc_and_dec_drop_the_fraction_and_set_the_register() {
    let count = "V1=0\n$1\nV1=V1+1\nDEC VC\nBGT P1\n";
    gives(&[("VC", 3.0)], count, &[("VC", 0.0), ("V1", 3.0)]);
    gives(&[("VC", 1.0)], "DEC VC\nBEQ P9\nV1=5\n$9\nV2=7\n", &[("VC", 0.0), ("V2", 7.0)]);
    gives(&[("V12", 6.4)], "INC V12\nDEC V12", &[("V12", 6.0)]);
}

/// Each branch against a register below, at and above zero.
#[test]
fn six_branches() {
    let goes = [
        ("BEQ", [false, true, false]),
        ("BNE", [true, false, true]),
        ("BGT", [false, false, true]),
        ("BLT", [true, false, false]),
        ("BGE", [false, true, true]),
        ("BLE", [true, true, false]),
    ];
    for (name, expected) in goes {
        for (value, goes) in [-2.0, 0.0, 2.0].into_iter().zip(expected) {
            let text = format!("TST V1\n{name} P5\nV2=1\nG24 P6\n$5\nV2=2\n$6\nM30\n");
            gives(&[("V1", value)], &text, &[("V2", if goes { 2.0 } else { 1.0 })]);
        }
    }
    for (angle, jumps) in [(360.0, true), (362.0, false)] {
        let text = "V14=V13-V7\nBGE P2\nV1=1\nM30\n$2\nV1=2\nM30\n";
        gives(&[("V13", 360.0), ("V7", angle)], text, &[("V1", if jumps { 2.0 } else { 1.0 })]);
    }
    for (flag, difference, climbs) in [(1.0, 0.0, true), (0.0, 1.0, false)] {
        let text = "V25=V24-VC\nBEQ P3\nV1=1\nM30\n$3\nV1=2\nM30\n";
        let after = [("V25", difference), ("V1", if climbs { 2.0 } else { 1.0 })];
        gives(&[("V24", 1.0), ("VC", flag)], text, &after);
    }
}

#[test]
fn functions_in_degrees_up_to_a_turn() {
    gives(&[("V2", 76.0)], "V3=SIN V2\nV4=COS V2\nV5=V3/V4", &[("V5", 4.0107809)]);
    gives(&[("V2", -360.0)], "V1=COS V2", &[("V1", 1.0)]);
    for beyond in [360.5, -361.0] {
        assert!(matches!(lines("V1=SIN V2", &[("V2", beyond)]).end, End::Alarm { .. }));
    }
    let root = lines("V1=SQR V2", &[("V2", -1.0)]);
    assert!(matches!(root.end, End::Alarm { .. }));
}

#[test]
fn tool_store_by_tool_number() {
    let tool = Tool { radius: 6.0, length: 80.0, ..Tool::default() };
    let scenario = Scenario { tool: 4, tools: [(4, tool)].into(), ..Scenario::default() };
    let run = corpus("finish-cut.nc", &scenario);
    ended(&run);
    assert_eq!((run.variables["V50"], run.variables["V51"]), (4.0, 6.0));
    assert!((run.variables["V53"] - 5.9).abs() < 1e-12);
    let read = "COR=T10 R=V1 L=V2\nCOR=T10 V3=R V4=L";
    gives(&[("V1", 3.0), ("V2", 70.0)], read, &[("V3", 3.0), ("V4", 70.0)]);
}

#[test]
fn time_between_two_readings() {
    // 100 mm at 6000 mm/min are a second.
    let run = lines("G1 F6000\nTIM VR\nX100\nTIM VS\nVT=VS-VR\n", &[]);
    assert!((run.variables["VT"] - 1.0).abs() < 0.01, "{:?}", run.variables);
}

#[test]
fn worked_examples() {
    let run = corpus("example3-calc.nc", &given(&[]));
    let found = ["V12", "V16", "V19", "V20"].map(|name| run.variables[name]);
    for (found, expected) in found.into_iter().zip([50.0, 24.0, 32.0, 18.0]) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    let run = corpus("example2.nc", &given(&[]));
    assert!((run.variables["V7"] - 50.0).abs() < 1e-9 && (run.variables["V12"] - 40.0).abs() < 1e-9);
}
