//! Rules of the language that no program of the course shows alone.

use crate::canon::Op;
use crate::control::scenario::Tool;
use crate::control::testing::*;
use crate::control::trace::EventKind;
use crate::control::{End, Run, Scenario};
use crate::dialect::Control;

fn lines(text: &str) -> Run {
    run("cc100", &[("t.nc", text.as_bytes())], &given(&[]))
}

#[test]
fn a_subprogram_runs_once_more_than_l_says() {
    let run = lines("V1=0\nG22 P1 L2\nM30\n$1\nV1=V1+1\nG99\n");
    ended(&run);
    assert_eq!(run.variables["V1"], 3.0);
    assert!(doubts(&run).contains(&"behaviour:repeat.counts"));
    assert_eq!(lines("V1=0\nG22 P1\nM30\n$1\nV1=V1+1\nG99\n").variables["V1"], 1.0);
}

#[test]
fn branches_go_to_computed_labels() {
    let run = lines("V9=4\nTST V9\nBGT V9\nV1=1\n$4\nM30\n");
    ended(&run);
    assert!(!run.variables.contains_key("V1"));
}

/// Whether a load sets the register matters only where the branch would go the other way.
#[test]
fn a_load_between_test_and_branch_is_unsure() {
    let fact = "behaviour:load.sets.condition";
    let run = lines("V2=3\nV1=V2-3\nV3=5\nBEQ P9\nV4=1\n$9\nM30\n");
    assert!(doubts(&run).contains(&fact) && !run.variables.contains_key("V4"));
    let run = lines("V2=4\nV1=V2-3\nV3=5\nBGT P9\nV4=1\n$9\nM30\n");
    assert!(!doubts(&run).contains(&fact));
}

#[test]
fn tests_of_codes_are_zero_for_yes() {
    let text = |code: &str| format!("G91\nG54\nTST {code}\nBEQ P9\nV1=1\n$9\nM30\n");
    for (code, yes) in
        [("G91", true), ("G90", false), ("G54", true), ("G55", false), ("QM", true), ("QX", false)]
    {
        let run = lines(&text(code));
        ended(&run);
        assert_eq!(run.variables.contains_key("V1"), !yes, "{code}");
    }
}

#[test]
fn polar_words_count_from_the_pole_or_from_here() {
    let run = lines(
        "V1=20 V2=10 V3=5\nV4=90 V5=8\nG1 F100\nG=V1 X=V2 Y=V3\nA=V4 D=V5\nG91\nA=V4 D=V5\nTRF=G20 V8=X V9=Y\n",
    );
    ended(&run);
    near(feeds(&run)[0], [10.0, 13.0, 0.0]);
    near(feeds(&run)[1], [10.0, 21.0, 0.0]);
    assert_eq!((run.variables["V8"], run.variables["V9"]), (10.0, 5.0));
}

#[test]
fn shifts_are_selected_and_cancelled() {
    let run = lines("V1=10 V2=20\nTRF=G55 X=V1 Y=V2\nG55\nG1 X1 Y1 F100\nG53\nX1 Y1\n");
    near(feeds(&run)[0], [11.0, 21.0, 0.0]);
    near(feeds(&run)[1], [1.0, 1.0, 0.0]);
}

#[test]
fn what_is_not_there_is_an_error_at_its_block() {
    for text in ["G24 P7\n", "G22 P7\n", "G877\n", "V1=X\nG24\n"] {
        assert!(matches!(lines(text).end, End::Error { .. } | End::Alarm { .. }), "{text}");
    }
    // Plain and parametric words in one block.
    assert!(matches!(lines("X0 Y=V1\n").end, End::Error { .. }));
    assert!(matches!(lines("V1=V2/V3\n").end, End::Alarm { .. }));
}

#[test]
fn endless_jumps_end_at_the_budget_and_endless_calls_by_an_alarm() {
    let few = Scenario { steps: 10_000, ..given(&[]) };
    assert_eq!(run("cc100", &[("t.nc", b"$1\nG24 P1\n")], &few).end, End::StepBudget);
    assert!(matches!(lines("$1\nG22 P1\n").end, End::Alarm { .. }));
}

#[test]
fn a_stop_without_a_comment_is_a_plain_stop() {
    let run = lines("M0\nG1 X1 F10\nM30\n");
    assert!(run.events.iter().any(|event| event.what == EventKind::Stop));
}

/// A cycle returns by M2; elsewhere no source says what M2 is.
#[test]
fn m2_returns_from_a_cycle_only() {
    let called = Scenario { called: true, ..given(&[]) };
    let end = |file: &str, text: &str| {
        let run = run("cc100", &[(file, text.as_bytes())], &called);
        ended(&run);
        let by = run.events.iter().rev().find_map(|event| match event.what {
            EventKind::End { by } => Some(by),
            _ => None,
        });
        (by, doubts(&run).contains(&"behaviour:cycle.end.ends.program"))
    };
    assert_eq!(end("cycle7.nc", "G55\nM2\n"), (Some(Op::Return), false));
    assert_eq!(end("cycle7.nc", "G55\nM30\n"), (Some(Op::EndRewind), false));
    assert_eq!(end("part.nc", "G55\nM2\n"), (Some(Op::End), false));
    // In a called part too.
    assert_eq!(end("part.nc", "G22 P1\nG0 X1\nM30\n$1\nM2\nG99\n"), (Some(Op::End), false));
    let files: [(&str, &[u8]); 2] = [("part.nc", b"G827\nG1 X1 F100\nM30\n"), ("Cycle27b.nc", b"G91\nM2\n")];
    let run = run("cc100", &files, &given(&[]));
    ended(&run);
    near(feeds(&run)[0], [1.0, 0.0, 0.0]);
}

/// T01 adds the length of tool 1 (80), T00 takes it away and changes no tool.
#[test]
fn tool_words_bring_their_length() {
    let mut scenario = given(&[]);
    scenario.tools.insert(1, Tool { length: 80.0, ..Tool::default() });
    let run = run("cc100", &[("t.nc", b"G90\nG1 Z5 F100 T01\nZ5 T00\nV1=T\nM30\n")], &scenario);
    ended(&run);
    let heights: Vec<f64> = feeds(&run).iter().map(|at| at[2]).collect();
    assert_eq!(heights, [85.0, 5.0]);
    let changes: Vec<f64> = run
        .events
        .iter()
        .filter_map(|event| match event.what {
            EventKind::ToolChange { tool } => Some(tool),
            _ => None,
        })
        .collect();
    assert_eq!(changes, [1.0]);
    let found = doubts(&run);
    for fact in ["behaviour:tool.change.word", "behaviour:tool.word.selects.length", "machine:tool.zero"] {
        assert!(found.contains(&fact), "{fact}");
    }
}

/// Tool 1 is in the spindle as the second T01 comes: by what the profile says it is changed twice, or once.
#[test]
fn a_tool_word_for_the_tool_in_the_spindle_does_what_the_profile_says() {
    let changes = |setting: &str| {
        let text = format!("dialect = \"cc100\"\n[settings]\ntool_again = \"{setting}\"\n");
        let control = Control::from_profile(&text).unwrap();
        let run = run_on(&control, &[("t.nc", b"T01\nT01\nT02\nM30\n")], &given(&[]));
        ended(&run);
        let change = |what: &EventKind| matches!(what, EventKind::ToolChange { .. });
        run.events.iter().filter(|event| change(&event.what)).count()
    };
    assert_eq!(changes("changes"), 3);
    assert_eq!(changes("skipped"), 2);
    let run = lines("T01\nT02\nM30\n");
    assert!(!doubts(&run).contains(&"behaviour:tool.word.again"));
    let run = lines("T01\nT01\nM30\n");
    assert!(doubts(&run).contains(&"behaviour:tool.word.again"));
}

/// From (10, 0) to (0, 10) about the zero: minus is the quarter, so plus is taken for the other three.
#[test]
fn the_sign_of_a_radius_tells_two_arcs_apart() {
    let sweep = |word: &str| {
        let run = lines(&format!("G90\nG1 X10 Y0 F100\nG3 X0 Y10 {word}\nM30\n"));
        ended(&run);
        let sweep = run.events.iter().find_map(|event| match event.what {
            EventKind::Arc { sweep, .. } => Some(sweep),
            _ => None,
        });
        (sweep.unwrap().round(), doubts(&run).contains(&"behaviour:arc.radius.positive"))
    };
    assert_eq!(sweep("R-10"), (90.0, false));
    assert_eq!(sweep("R10"), (270.0, true));
}

#[test]
fn an_offset_written_while_it_is_in_force_is_unsure_once_it_places_something() {
    let fact = "behaviour:offset.active.immediately";
    let run = lines("G90\nG54\nV1=10\nTRF=G54 X=V1\nG1 X1 F100\nM30\n");
    assert!(doubts(&run).contains(&fact));
    for text in [
        "G90\nG54\nV1=10\nTRF=G54 X=V1\nG54\nG1 X1 F100\nM30\n",
        "G90\nG55\nV1=10\nTRF=G54 X=V1\nG1 X1 F100\nM30\n",
        "G90\nG54\nG1 X1 F100\nV1=10\nTRF=G54 X=V1\nM30\n",
    ] {
        assert!(!doubts(&lines(text)).contains(&fact), "{text}");
    }
}

/// The codes of a profile: the dwell, and outputs. Each of two codes in one block switches its own.
#[test]
fn a_profile_names_the_dwell_and_outputs() {
    let profile = "dialect = 'cc100'\nsite = [{code='G4',op='dwell',words={F='dwell.s'},text='dwell'},\
        {code='M21',op='output.on',fixed={'output.bit'=24},text='on'},\
        {code='M22',op='output.off',fixed={'output.bit'=25},text='off'}]";
    let control = Control::from_profile(profile).unwrap();
    let text = "G1 X1 F100\nG4 F2\nV1=4\nV2=0.5\nG=V1 F=V2\nX3\nM21 M22\nM30\n";
    let run = run_on(&control, &[("t.nc", text.as_bytes())], &given(&[]));
    ended(&run);
    let told: Vec<&EventKind> = run.events.iter().map(|event| &event.what).collect();
    let waits: Vec<f64> = told
        .iter()
        .filter_map(|what| if let EventKind::Dwell { seconds } = what { Some(*seconds) } else { None })
        .collect();
    assert_eq!(waits, [2.0, 0.5]);
    let writes: Vec<(u32, f64)> = told
        .iter()
        .filter_map(|what| match what {
            EventKind::Write { subscripts, value, .. } => Some((subscripts[0], *value)),
            _ => None,
        })
        .collect();
    assert_eq!(writes, [(24, 1.0), (25, 0.0)]);
    assert!(told.iter().any(|what| matches!(what, EventKind::Feed { feed, .. } if *feed == 100.0)));
}

/// The block is passed over while the switch is on, and the one after it is not; both rest on the machine having the switch.
#[test]
fn a_block_with_a_skip_is_passed_over_by_the_switch() {
    let places = |switch: u32| {
        let scenario = Scenario { block_skip: switch, ..given(&[]) };
        let run = run("cc100", &[("t.nc", b"G1 F100\n/N2 X1\nN3 X2\nM30\n")], &scenario);
        ended(&run);
        assert!(doubts(&run).contains(&"statement:block.skip"));
        feeds(&run).iter().map(|at| at[0]).collect::<Vec<_>>()
    };
    assert_eq!(places(0), [1.0, 2.0]);
    assert_eq!(places(1 << 1), [2.0]);
}

#[test]
fn cycles_are_found_by_the_names_that_shops_give_their_files() {
    let far = |file: &str| {
        let run = run("cc100", &[("t.nc", b"G820\nG1 X1 F100\nM30\n"), (file, b"G91\nM2\n")], &given(&[]));
        matches!(run.end, End::Ended)
    };
    for file in
        ["cycle20.nc", "CYCLE20B.NC", "ZYK20.NC", "ZYKLUS 20.NC", "Zyk_20-offset.txt", "CYC20.NC", "G820.NC"]
    {
        assert!(far(file), "{file}");
    }
    for file in ["ZYK20B.NC", "G82.NC", "G8201.NC", "G920.NC", "CYCLE.NC", "MYCYCLE20.NC", "20.NC"] {
        assert!(!far(file), "{file}");
    }
}
