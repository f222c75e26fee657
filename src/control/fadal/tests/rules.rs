//! Rules of the language that no program of the manual shows alone.

use crate::canon::Op;
use crate::control::testing::*;
use crate::control::trace::EventKind;
use crate::control::{End, Run, Scenario};

fn lines(text: &str) -> Run {
    run("fadal", &[("t.nc", text.as_bytes())], &given(&[]))
}

#[test]
fn of_two_labels_the_first_counts() {
    let run = lines("#V1=0\n#:A\n#V1=V1+1\n#IF V1>2 THEN GOTO :B\n#GOTO :A\n#:A\n#V1=99\n#:B\n");
    assert_eq!(run.variables["V1"], 3.0);
}

#[test]
fn then_may_be_any_statement() {
    let run = lines("#V7=-1\n#IF V7<=0 THEN V7=ABS(V7)\n#IF V7=0 THEN GOTO :X\n#V2=5\n#:X\n");
    assert_eq!((run.variables["V7"], run.variables["V2"]), (1.0, 5.0));
}

#[test]
fn clears_one_a_range_a_list_or_all() {
    let set = "#V1=1\n#V2=1\n#V3=1\n#V9=1\nR1+4.\n";
    let left = |statement: &str| {
        let run = lines(&format!("{set}#{statement}\n"));
        ["V1", "V2", "V3", "V9", "R1"].map(|name| run.variables[name])
    };
    assert_eq!(left("CLEAR V1"), [0.0, 1.0, 1.0, 1.0, 4.0]);
    assert_eq!(left("CLEAR V1-V3"), [0.0, 0.0, 0.0, 1.0, 4.0]);
    assert_eq!(left("CLEAR V1,V3-V9"), [0.0, 1.0, 0.0, 0.0, 4.0]);
    assert_eq!(left("CLEAR"), [0.0, 0.0, 0.0, 0.0, 4.0]);
}

/// L102 runs L100 twice; the definitions end at the next one and at M17.
#[test]
fn the_last_digits_of_a_call_count() {
    let text = "L100\n#V1=V1+1\nL200\n#V2=V2+1\nL103\nM17\nM30\n#CLEAR\nL102\nR2+201.\nL+R2\nM2\n";
    let run = lines(text);
    ended(&run);
    assert_eq!((run.variables["V1"], run.variables["V2"]), (5.0, 1.0));
}

#[test]
fn an_l_below_100_repeats_a_move() {
    let run = lines("G91 G1 F10. X.5 L20\n");
    assert_eq!(feeds(&run).len(), 20);
    near(*feeds(&run).last().unwrap(), [10.0, 0.0, 0.0]);
}

/// Format 1: H is for length and diameter; a D after it counts (D-hole macro), G49 leaves it (slot program).
#[test]
fn the_length_picks_the_cutter_too() {
    let cutter = |before: &str| {
        let run = lines(&format!("G90 G17 G0 {before}\nG41 X1.\nM2\n"));
        let offset = run.events.iter().find_map(|event| match &event.what {
            EventKind::CutterRadius { offset, .. } => Some(*offset),
            _ => None,
        });
        (offset, doubts(&run).contains(&"behaviour:length.word.picks.radius"))
    };
    assert_eq!(cutter("H2 Z.1"), (Some(2), true));
    assert_eq!(cutter("H2 Z.1\nD7"), (Some(7), false));
    assert_eq!(cutter("D7 H2"), (Some(7), false));
    assert_eq!(cutter("D7\nH2"), (Some(2), true));
    assert_eq!(cutter("H2\nG49"), (Some(2), true));
}

#[test]
fn a_program_that_is_called_shares_all_variables() {
    let main = b"O1\n#V1=2\nM98 P20 L3\nM2\n";
    let called = b"O20\n#V1=V1*2\nM99\n";
    let run = run("fadal", &[("a", main), ("b", called)], &given(&[]));
    ended(&run);
    assert_eq!(run.variables["V1"], 16.0);
}

#[test]
fn what_is_not_there_is_an_error_at_its_block() {
    for text in ["M98 P77\n", "#START 7\n", "G10 L13 P1\n"] {
        assert!(matches!(lines(text).end, End::Error { .. }), "{text}");
    }
    // No call is open that the subroutine's end could go back from.
    for end in ["M17\nM30\n", "L200\nM17\nM30\n", "M30\n"] {
        let text = format!("L100\nN5 G0 X1.\n{end}#GOTO N5\n");
        assert!(matches!(lines(&text).end, End::Error { .. }), "{text}");
    }
    assert!(matches!(lines("M17\n").end, End::Error { .. }));
    // No source says that it is an alarm: the run says what it rests on.
    for text in ["#GOTO :NO\n", "#GOTO N7\n", "L101\n"] {
        let run = lines(text);
        assert!(matches!(&run.end, End::Alarm { stop, .. } if stop.for_all), "{text}");
        let unsure = |what: &EventKind| matches!(what, EventKind::Unsure { fact } if fact.ends_with("goto.missing.alarms"));
        assert!(run.events.iter().any(|event| unsure(&event.what)), "{text}");
    }
    assert!(matches!(lines("#V101=1\n").end, End::Alarm { .. } | End::Error { .. }));
    assert!(matches!(lines("#V1=1/0\n").end, End::Alarm { .. }));
    assert!(matches!(lines("#AX=1\n").end, End::Alarm { .. } | End::Error { .. }));
}

#[test]
fn calls_without_end_are_an_alarm() {
    let run = run("fadal", &[("a", b"O1\nM98 P1\nM2\n")], &given(&[]));
    assert!(matches!(run.end, End::Alarm { .. }));
}

/// R0 is the plane of cycles: a cycle without it takes what R0 holds.
#[test]
fn a_cycle_takes_its_plane_from_r0() {
    let plane = |text: &str| {
        let run = lines(text);
        // The first rapid move down ends on the plane.
        let down = run.events.iter().find_map(|event| match &event.what {
            EventKind::Rapid { from, to } if to.0[2] < from.0[2] => Some(to.0[2]),
            _ => None,
        });
        (down, doubts(&run).contains(&"behaviour:cycle.r0.kept"))
    };
    let head = "G90 G0 Z5.\n";
    assert_eq!(plane(&format!("{head}G81 X1. Z-1. R0+.5 F10.\n")), (Some(0.5), false));
    assert_eq!(plane(&format!("{head}R0+.25\nG81 X1. Z-1. F10.\n")), (Some(0.25), true));
}

/// G10 L100 to L109 set R0 to R9; L10 takes its value from R0.
#[test]
fn g10_sets_tables_and_variables() {
    let run = lines("G10 L105 P7.5\nG10 L10 P3 R0+4.25\n#V1=H3\nG10 L2 P1 X1. Y2.\n#V2=FY1\n");
    ended(&run);
    assert_eq!((run.variables["R5"], run.variables["V1"], run.variables["V2"]), (7.5, 4.25, 2.0));
}

#[test]
fn a_modal_subroutine_runs_after_each_move_until_g67() {
    let text =
        "L100\n#V1=V1+1\nG1 Z-1. F10.\nM17\nM30\n#CLEAR\nG0 X0\nL101 G66\nM45\nX1.\nX2. L2\nG67\nX9.\nM2\n";
    let run = lines(text);
    ended(&run);
    // At once by M45, at X1, and twice at X2; its own moves call nothing.
    assert_eq!(run.variables["V1"], 4.0);
    // The manual says from where on it runs (seed 000:1673).
    assert!(!doubts(&run).contains(&"behaviour:call.modal.block.calls"));
}

#[test]
fn m30_ends_a_program_without_subroutines() {
    let run = lines("#V1=1\nM30\n#V1=2\n");
    assert_eq!((run.end.clone(), run.variables["V1"]), (End::Ended, 1.0));
    assert!(!doubts(&run).contains(&"behaviour:end.alone"));
    assert!(run.events.iter().any(|event| event.what == EventKind::End { by: Op::EndRewind }));
}

#[test]
fn m99_p_jumps_in_the_program() {
    let run = lines("#V1=V1+1\n#IF V1>3 THEN GOTO N9\nM99 P5\n#V1=50\nN5 #V1=V1+10\nN9 M2\n");
    assert_eq!(run.variables["V1"], 11.0);
}

/// What nobody set, and what nobody states, is said where it mattered.
#[test]
fn doubts_stand_at_their_blocks() {
    let run = lines("#V2=V1\n#V3=RND(1.4)\n#V4=V(1.5)\n");
    for fact in
        ["behaviour:common.at.power.on", "behaviour:round.places.default", "behaviour:index.of.fraction"]
    {
        assert!(doubts(&run).contains(&fact), "{fact} in {:?}", doubts(&run));
    }
}

#[test]
fn start_goes_over_for_good() {
    let run = run("fadal", &[("a", b"O1\n#V1=1\n#START 7\n#V1=5\n"), ("b", b"O7\n#V2=2\nM2\n")], &given(&[]));
    ended(&run);
    assert_eq!((run.variables["V1"], run.variables["V2"]), (1.0, 2.0));
    assert_eq!(run.programs.len(), 2);
}

/// Fewer digits change what arithmetic keeps, and nothing else.
#[test]
fn keeps_the_digits_that_the_scenario_leaves() {
    let scenario = Scenario { digits: Some(4), ..Scenario::default() };
    let run = run("fadal", &[("t.nc", b"#V1=1/3\n#V2=1.23456")], &scenario);
    assert_eq!((run.variables["V1"], run.variables["V2"]), (0.3333, 1.23456));
}

#[test]
fn words_stand_before_the_dwell_and_the_gear_suffix_is_no_speed() {
    let run = lines("M3 S500.1\nG4 P1500\n");
    let speed = |what: &EventKind| matches!(what, EventKind::Spindle { speed: 500.0, .. });
    assert!(run.events.iter().any(|event| speed(&event.what)));
    assert!(run.events.iter().any(|event| event.what == EventKind::Dwell { seconds: 1.5 }));
}

/// The cycle takes its speed from F and its lead from Q: 400 turns of 0.05 are 20 a minute.
#[test]
fn a_tap_advances_its_lead_each_turn_and_leaves_the_feed_alone() {
    let run = lines("G90 G1 F300. X1. S500 M3\nG84 G99 Z-1. R0+.1 F400. Q.05 X2.\nG80\nG1 X5.\nM2\n");
    let feeds: Vec<f64> = run
        .events
        .iter()
        .filter_map(|event| match &event.what {
            EventKind::Feed { feed, .. } => Some(*feed),
            _ => None,
        })
        .collect();
    assert_eq!(feeds, [300.0, 20.0, 20.0, 300.0]);
}

/// G(2) planes, G(3) compensation, G(5) absolute or incremental: each its own group.
#[test]
fn reads_what_is_in_force_by_group() {
    let run = lines("G90 G17 G40 G1 F300.\n#V1=G(1)\n#V2=G(2)\n#V3=G(3)\nG91\n#V5=G(5)\nM2\n");
    assert_eq!(["V1", "V2", "V3", "V5"].map(|name| run.variables[name]), [2.0, 17.0, 40.0, 91.0]);
}

/// A modal call in the subroutine of another, by each of its moves, is for somebody to look up.
#[test]
fn a_modal_call_in_a_modal_subroutine_runs_for_its_moves() {
    let subs = "L100\n#V1=V1+1\nL201 G66\nX1.\nX2.\nG67\nX3.\nL200\n#V2=V2+1\nM17\nM30\n";
    let run = lines(&format!("{subs}#CLEAR\nG0 X0\nL101 G66\nX4.\nX5.\nG67\nX6.\nM2\n"));
    ended(&run);
    assert_eq!((run.variables["V1"], run.variables["V2"]), (2.0, 4.0));
    assert!(doubts(&run).contains(&"behaviour:call.modal.nested"));
}

/// R0 is the retract plane of each hole: what gives it another value moves the plane, whichever way it is written.
#[test]
fn a_hole_begins_at_the_plane_that_r0_holds() {
    let planes = |between: &str| {
        let run = lines(&format!("G90 G81 G99 X1. Y1. R0+.2 Z-.5 F5.\n{between}X2.\nG80\nM2\n"));
        let holes = run.events.iter().filter_map(|event| match &event.what {
            EventKind::Hole { at, .. } => Some(at.0[2]),
            _ => None,
        });
        holes.map(|z| (z * 1e6).round() / 1e6).collect::<Vec<_>>()
    };
    assert_eq!(planes(""), [0.2, 0.2]);
    assert_eq!(planes("#R0=.1\n"), [0.2, 0.1]);
    assert_eq!(planes("R0+.15\n"), [0.2, 0.15]);
    assert_eq!(planes("G10 L100 P.3\n"), [0.2, 0.3]);
    assert_eq!(planes("#R1=.1\n"), [0.2, 0.2]);
}

/// X1. places, then Y1. an increment; the next block counts in increments, and its G90 from the block after it on.
#[test]
fn g90_and_g91_count_for_the_words_after_them() {
    let run = lines("G0 X0. Y5.\nG1 F9. G90 X2. G91 Y1.\nX1. G90\nX0. Y0.");
    let places = feeds(&run);
    let expected = [[2.0, 6.0, 0.0], [3.0, 6.0, 0.0], [0.0, 0.0, 0.0]];
    assert_eq!(places.len(), expected.len());
    places.iter().zip(expected).for_each(|(found, expected)| near(*found, expected));
    // Two sources agree on it: it is a note of the conversion, and no doubt.
    assert!(!doubts(&run).contains(&"behaviour:distance.code"));
}

/// The manual's examples (section 12, p. 266), and how far each block turns: 90, then by + to 45, back to 0, by - to 90.
#[test]
fn the_sign_of_an_angle_is_its_way() {
    let run = lines("G90 G0 A90.\nA45.\nA-0\nA-90.\nG91 A-30.\nG90 A60.");
    let places: Vec<f64> = run
        .events
        .iter()
        .filter_map(|event| match &event.what {
            EventKind::Rapid { to, .. } => Some(to.0[3]),
            _ => None,
        })
        .collect();
    // The last block finds the axis at 60 already.
    assert_eq!(places, [90.0, 405.0, 360.0, 90.0, 60.0]);
}
