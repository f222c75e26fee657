//! Cycles and compensation of mills, where controls part or a program slips.

use super::*;

fn arcs(run: &Run) -> usize {
    run.events.iter().filter(|event| matches!(event.what, EventKind::Arc { .. })).count()
}

/// True where a run rests on a fact.
fn doubts(run: &Run, fact: &str) -> bool {
    run.events.iter().any(|event| matches!(&event.what, EventKind::Unsure { fact: found } if found == fact))
}

const ARC: &str = "O1\nG21G90G17\nG0X0Y0Z5.\nG81X1.Y1.Z-5.R1.F10.\nG2X2.Y2.R1.\nM30\n";

#[test]
fn an_arc_ends_a_drilling_cycle_on_a_fanuc_and_nobody_says_it_of_a_haas() {
    let ends = "behaviour:cycle.ends.by.arc";
    assert_eq!((arcs(&fanuc(ARC)), doubts(&fanuc(ARC), ends)), (1, false));
    assert_eq!((arcs(&haas(ARC)), doubts(&haas(ARC), ends)), (0, true));
}

#[test]
fn a_haas_drills_under_g17_alone() {
    let text = |plane: &str| format!("O1\nG21G90{plane}\nG0X0Y5.Z5.\nG81X1.Z1.Y-5.R1.F10.\nG80\nM30\n");
    assert_eq!(fanuc(&text("G18")).end, End::Ended);
    assert_eq!(haas(&text("G17")).end, End::Ended);
    assert!(matches!(haas(&text("G18")).end, End::Alarm { .. }));
    assert!(matches!(haas(&text("G19")).end, End::Alarm { .. }));
}

/// The waits at the bottoms of holes, seconds.
fn waits(run: &Run) -> Vec<f64> {
    let waits = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Dwell { seconds } => Some(*seconds),
        _ => None,
    });
    waits.collect()
}

#[test]
fn a_wait_inside_a_drilling_cycle_is_the_cycles_too_on_a_haas_by_a_report() {
    let text = "O1\nG21G90G17\nG0X0Y0Z5.\nG82X1.Y1.Z-5.R1.P500F10.\nG4P2000\nX2.\nG80\nM30\n";
    let shared = "behaviour:cycle.dwell.shared";
    assert_eq!((waits(&fanuc(text)), doubts(&fanuc(text), shared)), (vec![0.5, 2.0, 0.5], false));
    assert_eq!((waits(&haas(text)), doubts(&haas(text), shared)), (vec![0.5, 2.0, 2.0], true));
}

#[test]
fn words_of_a_cycle_that_drill_nothing_are_doubted() {
    let text = "O1\nG21G90G17\nG0X0Y0Z5.\nG82X1.Y1.Z-5.R1.P500F10.\nP2000\nX2.\nG80\nM30\n";
    let alone = "behaviour:cycle.words.alone";
    assert!(doubts(&fanuc(text), alone) && doubts(&haas(text), alone));
    let profile = "dialect = \"fanuc\"\n[behaviours]\n\"cycle.words.alone\" = \"ignored\"\n";
    let control = Control::from_profile(profile).expect("a profile");
    let run = run_on(&control, &[text], &Scenario::default());
    assert_eq!((waits(&run), doubts(&run, alone)), (vec![0.5, 0.5], false));
}

#[test]
fn a_length_without_a_number_is_doubted() {
    let never = "behaviour:length.never.named";
    for (blocks, doubted) in [("T3M6\nG43Z1.", true), ("T3M6\nG43H3Z1.\nG49\nG43Z2.", false)] {
        let text = format!("O1\nG21G90\n{blocks}\nM30\n");
        assert_eq!((doubts(&fanuc(&text), never), doubts(&haas(&text), never)), (doubted, doubted));
    }
}

#[test]
fn compensation_begins_and_ends_on_straight_moves() {
    let stops = |blocks: &str| {
        let text = format!("O1\nG21G90G17G40\nG0X0Y0\n{blocks}\nM30\n");
        [fanuc(&text), haas(&text)].map(|run| matches!(run.end, End::Alarm { .. }))
    };
    assert_eq!(stops("G41D1G1X2.F10.\nG2X4.R1.\nG40G1X6."), [false; 2]);
    assert_eq!(stops("G41D1G3X2.R1.F10."), [true; 2]);
    assert_eq!(stops("G41D1G1X2.F10.\nG40G2X4.R1."), [true; 2]);
    assert_eq!(stops("G41D1\nZ1.\nG3X2.R1.F10."), [true; 2]);
}

#[test]
fn increments_right_after_a_rotation_turn_about_the_tool() {
    let text = "O1\nG21G90G17\nG0X3.Y0\nG68X1.Y1.R90.\nG91G1X1.F10.\nG69\nM30\n";
    let increments = "behaviour:rotation.increments";
    // From (3, 0) one along X, turned by 90 degrees: one along Y.
    let end = moves(&fanuc(text)).pop().expect("a move");
    assert!((end[0] - 3.0).abs() < 1e-9 && (end[1] - 1.0).abs() < 1e-9, "{end:?}");
    assert_eq!((doubts(&fanuc(text), increments), doubts(&haas(text), increments)), (false, true));
}

#[test]
fn polar_coordinates_count_from_the_zero_and_under_g91_from_the_tool() {
    // Worked out by hand: 10 at 30 degrees is (8.660, 5); at 30 + 60 it is (0, 10). 4 at 180 from there is (-4, 10).
    let text = "O1\nG21G90G17\nG0X0Y0Z5.\nG16X10.Y30.\nG91Y60.\nG90Y90.\nG91X4.Y90.\nG90G15X1.Y2.\nM30\n";
    let run = fanuc(text);
    let ends = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Rapid { to, .. } => Some([to.0[0], to.0[1]]),
        _ => None,
    });
    let places: Vec<[f64; 2]> = ends.collect();
    let wanted = [[0.0, 0.0], [8.66, 5.0], [0.0, 10.0], [-4.0, 10.0], [1.0, 2.0]];
    assert_eq!(places.len(), wanted.len(), "{places:?}");
    for (place, wanted) in places.iter().flatten().zip(wanted.iter().flatten()) {
        assert!((place - wanted).abs() < 1e-9, "{places:?}");
    }
    // In inches a place ends on 0.0001: 1 at 30 degrees is (0.8660, 0.5), 21.9964 and 12.7 millimetres.
    let inch = fanuc("O1\nG20G90G17\nG0X0Y0Z5.\nG16X1.Y30.\nM30\n");
    let last = inch.events.iter().rev().find_map(|event| match &event.what {
        EventKind::Rapid { to, .. } => Some([to.0[0], to.0[1]]),
        _ => None,
    });
    let [x, y] = last.unwrap_or_default();
    assert!((x - 21.9964).abs() < 1e-9 && (y - 12.7).abs() < 1e-9, "{x} {y}");
    let unsaid = "machine:polar.word.left.out";
    assert!(!doubts(&run, unsaid));
    assert!(doubts(&fanuc("O1\nG21G90G17\nG0X0Y0Z5.\nG16Y30.\nM30\n"), unsaid));
}

/// The Z of each cut that goes down, millimetres.
fn bottoms(run: &Run) -> Vec<f64> {
    let cuts = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Feed { from, to, .. } if to.0[2] < from.0[2] => Some((to.0[2] * 1e6).round() / 1e6),
        _ => None,
    });
    cuts.collect()
}

#[test]
fn a_code_of_a_cycle_without_a_word_drills_on_a_haas_alone() {
    let text = "O1\nG21G90G17\nG0X0Y0Z5.\nG99G81X1.Y1.Z-5.R1.F10.\nG82G98\nX2.\nG80\nM30\n";
    assert_eq!(bottoms(&fanuc(text)).len(), 2);
    assert_eq!(bottoms(&haas(text)).len(), 3);
    let deeper = text.replace("G82G98", "G82G98Z-6.");
    assert_eq!(bottoms(&fanuc(&deeper)).len(), 3);
}

#[test]
fn a_bottom_stays_where_it_was_when_the_retract_plane_moves_by_increments() {
    // From 20: the plane at 2 and the bottom at -4, then the plane at 3, then both anew.
    let text =
        "O1\nG21G90G17\nG0X0Y0Z20.\nG91\nG98G81X1.R-18.Z-6.F10.\nR-17.X1.\nR-16.Z-6.X1.\nX1.\nG80\nM30\n";
    let first = bottoms(&fanuc(text));
    let steps: Vec<f64> = first.iter().map(|bottom| ((bottom - first[0]) * 1e6).round() / 1e6).collect();
    assert_eq!(steps, [0.0, 0.0, 2.0, 2.0]);
}

/// At Z31 R-8 is a plane of 23 and Z-10 a bottom of 13, a place once its block is read (facts/ambiguities.md 2): a plane of 20 leaves it,
/// and so does one under G90 that an increment of Z counted from.
#[test]
fn a_bottom_that_an_increment_told_stays_under_a_plane_that_is_a_place() {
    let text = "O1\nG21G90G17\nG0X0Y0Z31.\nG91G99G81X1.R-8.Z-10.F10.\nG90X2.R20.\nG80\nM30\n";
    assert_eq!(bottoms(&fanuc(text)), [13.0, 13.0]);
    let text =
        "O1\nG21G90G17\nG0X0Y0Z31.\nG99G81X1.R5.Z-5.F10.\nG91X1.Z-12.\nG90X3.R2.\nX4.R1.Z-9.\nG80\nM30\n";
    assert_eq!(bottoms(&fanuc(text)), [-5.0, -7.0, -7.0, -9.0]);
}
