//! Programs of the manuals, with places computed by their geometry.

use super::*;

fn holes(run: &Run) -> Vec<(f64, f64)> {
    let holes = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Hole { at, .. } => Some((at.0[0], at.0[1])),
        _ => None,
    });
    holes.collect()
}

#[test]
fn sums_to_fifty_five_by_jumps_and_by_a_loop() {
    for file in ["fanuc/o9500-sum-goto.nc", "fanuc/o0001-sum-while.nc"] {
        let run = fanuc(&corpus(file));
        assert_eq!((value(&run, "#1"), &run.end), (Some(55.0), &End::Ended), "{file}");
    }
}

#[test]
fn the_frame_macro_drills_eighteen_holes_round_its_frame() {
    let profile =
        "dialect = \"fanuc\"\nmachine = \"mill\"\nunits = \"metric\"\ndecimal_point = \"calculator\"\n";
    let control = Control::from_profile(profile).expect("a profile");
    let texts = [corpus("fanuc/o0023-frame-main.nc"), corpus("fanuc/o8103-frame-macro.nc")];
    let scenario = Scenario::default();
    let run = run_on(&control, &[&texts[0], &texts[1]], &scenario);
    assert_eq!(run.end, End::Ended);
    // Six by five holes, 16 and 14 apart, from (10, 9.5): along the bottom, up, back, down.
    let (columns, rows) = (6, 5);
    let mut expected = Vec::new();
    let place = |column: i32, row: i32| (10.0 + 16.0 * f64::from(column), 9.5 + 14.0 * f64::from(row));
    expected.extend((0..columns).map(|column| place(column, 0)));
    expected.extend((1..rows).map(|row| place(columns - 1, row)));
    expected.extend((0..columns - 1).rev().map(|column| place(column, rows - 1)));
    expected.extend((1..rows - 1).rev().map(|row| place(0, row)));
    assert_eq!(expected.len(), 18);
    assert_eq!(holes(&run), expected);
    // G90 was in force and is again: the bottom of every hole is absolute.
    let bottoms: Vec<f64> = run
        .events
        .iter()
        .filter_map(|event| match &event.what {
            EventKind::Hole { bottom, .. } => Some(*bottom),
            _ => None,
        })
        .collect();
    assert!(bottoms.iter().all(|bottom| *bottom == -14.7), "{bottoms:?}");
}

#[test]
fn nested_modal_calls_run_in_the_order_of_the_rule() {
    let texts = ["g66-nesting-main", "o9100-g66-nesting", "o9200-g66-nesting"]
        .map(|name| corpus(&format!("fanuc/{name}.nc")));
    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
    let run = run_on(&Control::plain("fanuc").expect("the table loads"), &texts, &Scenario::default());
    // (1-1) (2-1) (1-2) (3-1) (2-1) (3-2) (2-1) (1-3); zero-length moves leave no trace.
    let expected = [
        [10.0, 0.0, 0.0],
        [10.0, 0.0, 50.0],
        [15.0, 0.0, 50.0],
        [60.0, 0.0, 50.0],
        [60.0, 70.0, 50.0],
        [-25.0, 70.0, 50.0],
    ];
    assert_eq!(moves(&run), expected);
    let enters: Vec<&str> = run
        .events
        .iter()
        .filter_map(|event| match event.what {
            EventKind::Enter { program, .. } => Some(run.programs[program as usize].name.as_str()),
            _ => None,
        })
        .collect();
    assert_eq!(enters, ["O9100", "O9200", "O9100", "O9100"]);
}

#[test]
fn a_repeated_macro_moves_each_time() {
    let texts = [corpus("fanuc/o0001-g65-l2.nc"), corpus("fanuc/o9010-g65-l2.nc")];
    let control = Control::plain("fanuc").expect("the table loads");
    let run = run_on(&control, &[&texts[0], &texts[1]], &Scenario::default());
    assert_eq!(moves(&run), [[3.0, 0.0, 0.0], [6.0, 0.0, 0.0]]);
}

#[test]
fn the_groove_macro_cuts_at_each_place() {
    let texts = [corpus("fanuc/o0003-g66-groove.nc"), corpus("fanuc/o9110-g66-groove.nc")];
    let control = Control::from_profile("dialect = \"fanuc\"\nmachine = \"lathe\"\n").expect("a profile");
    let mut scenario = Scenario::default();
    (scenario.start[0], scenario.start[2]) = (100.0, 200.0);
    let run = run_on(&control, &[&texts[0], &texts[1]], &scenario);
    assert_eq!(run.end, End::Ended);
    let at = |x: f64, z: f64| [x, 0.0, z];
    // At each of three places 5 in and 5 out.
    let expected = [
        at(60.0, 80.0),
        at(55.0, 80.0),
        at(60.0, 80.0),
        at(60.0, 50.0),
        at(55.0, 50.0),
        at(60.0, 50.0),
        at(60.0, 30.0),
        at(55.0, 30.0),
        at(60.0, 30.0),
        at(0.0, 200.0),
    ];
    assert_eq!(moves(&run), expected);
}

#[test]
fn the_timer_macro_splits_tool_and_offset() {
    // T0303: offset 3, tool 3; #4120 reads 303.
    let control = Control::from_profile("dialect = \"fanuc\"\nmachine = \"lathe\"\n").expect("a profile");
    let text = format!("O1\nT0303\nM98 P9002\nM30\n{}", corpus("fanuc/o9002-accumulate.nc"));
    let run = run_on(&control, &[&text], &Scenario::default());
    let found = ["#103", "#102", "#100"].map(|name| value(&run, name));
    assert_eq!(found, [3.0, 6.0, 506.0].map(Some), "{:?}", run.end);
}

#[test]
fn codes_that_the_profile_makes_calls_pass_their_arguments() {
    // Parameter 6080 is 910: M910 calls O9020; I is #4, T is #20, S is #19.
    let profile = format!("{}/machines/fanuc-0i.toml", env!("CARGO_MANIFEST_DIR"));
    let profile = std::fs::read_to_string(profile).expect("the profile");
    let control = Control::from_profile(&profile).expect("a profile");
    let macro_ = "O9020\n#101=#4\n#102=#20\n#103=#19\nM99\n";
    let run = run_on(&control, &[&corpus("fanuc/call-m910.nc"), macro_], &Scenario::default());
    let found = ["#101", "#102", "#103"].map(|name| value(&run, name));
    assert_eq!(found, [69.0, 7.0, 400.0].map(Some), "{:?}", run.end);
}
