//! Lathes: what the lists of `tests/motions/` do not hold. Rows are those of docs/lathe.md.

use super::run_on;
use crate::control::trace::EventKind;
use crate::control::{End, Run, Scenario};
use crate::dialect::Control;

const FANUC: &str = "dialect = \"fanuc\"\nmachine = \"lathe\"\nunits = \"metric\"\n";
const HAAS: &str = "dialect = \"haas\"\nmachine = \"lathe\"\nunits = \"metric\"\n";

fn run(profile: &str, text: &str) -> Run {
    let control = Control::from_profile(profile).expect("a profile");
    let mut scenario = Scenario::default();
    (scenario.start[0], scenario.start[2]) = (100.0, 50.0);
    run_on(&control, &[text], &scenario)
}

fn moves(run: &Run) -> Vec<[f64; 2]> {
    let ends = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Rapid { to, .. }
        | EventKind::Feed { to, .. }
        | EventKind::Arc { to, .. }
        | EventKind::Thread { to, .. } => Some(to),
        _ => None,
    });
    ends.map(|to| [to.0[0], to.0[2]]).collect()
}

/// The number and the text of the alarm that ends it.
fn alarm(run: &Run) -> (String, String) {
    match &run.end {
        End::Alarm { stop, .. } => (stop.number.clone(), stop.text.clone()),
        other => panic!("{other:?}"),
    }
}

fn refusal(profile: &str, block: &str) -> String {
    alarm(&run(profile, &format!("O1\nG0 X60. Z2.\n{block}\nM30\n"))).1
}

fn variable(run: &Run, name: &str) -> f64 {
    run.variables.get(name).copied().unwrap_or(f64::NAN)
}

#[test]
fn increments_are_differences_of_diameters() {
    // D1: U of X, W of Z, also beside an absolute word of the other axis.
    let run = run(FANUC, "O1\nG0 X60. Z2.\nU-4. Z0.\nX50. W-3.\nM30\n");
    assert_eq!(moves(&run), [[60.0, 2.0], [56.0, 0.0], [50.0, -3.0]]);
}

#[test]
fn what_the_page_does_not_describe_is_refused_by_name() {
    // D1, Q3, and codes of measuring.
    for (block, names) in [
        ("G0 X40. U-2.", "place and its increment"),
        ("G1 X40. C2. F.1", "the C axis"),
        ("G1 X40. R2. F.1\nG0 X50.", "no straight feed move"),
        ("G1 ,A45. F.1", "by its angle alone"),
        ("G1 X40. A45. F.1", "the A axis"),
        ("G36 X40.", "G36"),
        // V2 and V4: polar interpolation.
        ("G12.1 X40.", "not alone in its block"),
        ("G42\nG12.1", "radius of the tool is compensated"),
        ("G12.1\nG0 X40.", "rapid traverse in polar interpolation"),
        ("G12.1\nG1 X40. F9.\nG54", "wcs.select in polar interpolation"),
        ("G12.1\nG1 X40. F9.\nT0202", "tool.turret.index in polar interpolation"),
        ("G12.1\nG1 X40. ,R1. F9.", "corner.radius in polar interpolation"),
        ("G12.1\nG1 X40. F9.\nG12.1", "in force already"),
        ("G12.1\nG7.1 C0", "that another code began"),
        ("G12.1\nG3 X40. C2. K3. F9.", "arc.k in polar interpolation"),
        // V6 to V8: cylinders.
        ("G7.1 C-3.", "left out, or negative"),
        ("G7.1 C30.\nG0 Z-2.", "rapid traverse in cylindrical interpolation"),
        ("G7.1 C30.\nG3 Z-2. C9. I1. F9.", "arc.i in cylindrical interpolation"),
        ("G17\nG7.1 C30.\nG3 Z-2. C9. R9. F9.", "outside the plane"),
        ("G7.1 C30.\nG3 X50. C9. R9. F9.", "X in an arc"),
        ("G83.5 Z-10. R2. F50.", "G83.5"),
        ("G68", "G68"),
        ("G1 X40. L2 F.1", "no L"),
    ] {
        let text = refusal(FANUC, block);
        assert!(text.contains(names), "{block}: {text}");
    }
    // D2: U and W are no words of motion in system B.
    let system_b = format!("{FANUC}[settings]\ngcode_system = \"B\"\n");
    assert!(refusal(&system_b, "G0 U-4.").contains("no U"));
    // Z2 and Z4.
    assert!(refusal(FANUC, "G28").contains("without an axis"));
    assert!(refusal(FANUC, "G53 U10.").contains("increments"));
    assert!(refusal(HAAS, "G1 X50. F.1\nG53 X10.").contains("rapid"));
    // V1, V3 and V6 on the other lathe.
    assert!(refusal(HAAS, "G0 C30.\nG112").contains("does not stand at 0"));
    assert!(refusal(HAAS, "G112\nG1 X20. C3. F9.").contains("axis.c in polar"));
    assert!(refusal(HAAS, "G112\nG1 U-4. F9.").contains("step.x in polar"));
    assert!(refusal(HAAS, "G112\nG1 X20. F9.\nG3 X0. Y20. R20.").contains("outside the plane"));
    assert!(refusal(HAAS, "G107").contains("G107"));
}

#[test]
fn milling_with_c_takes_the_time_of_its_way() {
    // V4: from x 30 to 20 and y 0 to 10, a hypotenuse of sqrt(200) at 60 a minute; V7: 90 degrees round a radius of 20 are 10 pi.
    let text = "O1\nG98\nG0 X60. Z2. C0.\nG12.1\n#1=#3001\nG1 X40. F60.\n#100=#3001-#1\n#1=#3001\nX20. C10.\n#101=#3001-#1\nX40. C0.\nG13.1\n\
                G7.1 C20.\n#1=#3001\nG1 C90.\n#102=#3001-#1\nG7.1 C0\nG0 X70.\nM30\n";
    let run = run(FANUC, text);
    let near = |name: &str, seconds: f64| {
        let took = variable(&run, name);
        assert!((took - 1000.0 * seconds).abs() < 5.0, "{name}: {took}");
    };
    near("#100", 10.0);
    near("#101", 200.0_f64.sqrt());
    near("#102", 10.0 * std::f64::consts::PI);
}

#[test]
fn a_way_through_the_centre_is_not_sure() {
    let doubts = |text: &str| {
        let run = run(FANUC, text);
        let is_it = |what: &EventKind| matches!(what, EventKind::Unsure { fact } if fact == "machine:lathe.face.centre");
        run.events.iter().any(|event| is_it(&event.what))
    };
    assert!(doubts("O1\nG98\nG0 X60. C0.\nG12.1\nG1 X-40. F60.\nG13.1\nM30\n"));
    assert!(doubts("O1\nG98\nG0 X60. C0.\nG12.1\nG1 X0. F60.\nC5.\nG13.1\nM30\n"));
    assert!(!doubts("O1\nG98\nG0 X60. C0.\nG12.1\nG1 X40. C-9. F60.\nG13.1\nM30\n"));
}

#[test]
fn a_tool_word_turns_the_turret_and_takes_its_offset() {
    let text =
        "O1\n#2003=-4.\n#2103=2.\nT303\nG0 X60. Z2.\n#100=#5041\n#101=#5021\nT0300\nG0 X60.\nT0303\nM30\n";
    let run = run(FANUC, text);
    assert_eq!(moves(&run), [[56.0, 4.0], [60.0, 4.0]]);
    // The work coordinate holds the offset, the machine's does not; both are diameters.
    assert_eq!((variable(&run, "#100"), variable(&run, "#101")), (60.0, 56.0));
    let told: Vec<String> = run
        .events
        .iter()
        .filter_map(|event| match &event.what {
            EventKind::ToolChange { tool } => Some(format!("station {tool}")),
            EventKind::ToolOffset { offset, x, z } => Some(format!("offset {offset}: {x} {z}")),
            _ => None,
        })
        .collect();
    // T2: the station in its place is not changed to again.
    assert_eq!(told, ["station 3", "offset 3: -4 2", "offset 0: 0 0", "offset 3: -4 2"]);
}

#[test]
fn an_offset_beside_a_zero_is_an_alarm() {
    assert_eq!(alarm(&run(FANUC, "O1\nG50 S2000 T0101\nM30\n")).0, "PS0245");
    assert_eq!(alarm(&run(FANUC, "O1\nG4 X1. T0101\nM30\n")).0, "PS0245");
}

#[test]
fn a_feed_by_the_turn_takes_its_time() {
    // S5: 20 mm at .2 a turn are 100 turns, at 600 a minute 10 s. C5: U-4. is 2 mm.
    let text = "O1\nG97 S600 M3\nG0 X60. Z20.\n#1=#3001\nG1 Z0. F.2\n#100=#3001-#1\n#1=#3001\nU-4.\n#101=#3001-#1\nM30\n";
    let run = run(FANUC, text);
    assert!((variable(&run, "#100") - 10_000.0).abs() < 5.0, "{}", variable(&run, "#100"));
    assert!((variable(&run, "#101") - 1000.0).abs() < 5.0, "{}", variable(&run, "#101"));
}

#[test]
fn a_wait_or_a_feed_makes_no_pass_and_a_code_makes_one_more() {
    // B9, and B7: a pass comes back to where it began.
    let text = "O1\nG0 X60. Z2.\nG90 X50. Z-10. F.2\nG4 X1.\nM8\nF.1\nX46.\nM30\n";
    let cut = |x: f64| [[x, 2.0], [x, -10.0], [60.0, -10.0], [60.0, 2.0]];
    let expected: Vec<[f64; 2]> =
        [[60.0, 2.0]].into_iter().chain(cut(50.0)).chain(cut(50.0)).chain(cut(46.0)).collect();
    assert_eq!(moves(&run(FANUC, text)), expected);
}

#[test]
fn a_pass_without_its_other_word_is_refused() {
    // B8, and B7: the code again takes all afresh.
    assert!(refusal(FANUC, "G90 X50. F.2").contains("without X or without Z"));
    assert!(refusal(FANUC, "G90 X50. Z-10. F.2\nG90 X46.").contains("without X or without Z"));
    assert_eq!(alarm(&run(FANUC, "O1\nG0 X60. Z2.\nG90 X50. Z-10. Y1. F.2\nM30\n")).0, "PS0330");
}

/// A roughing of one step from 60 to 40, and blocks around it.
fn roughing(before: &str, inside: &str) -> String {
    format!(
        "O1\nG97 S500 M3\nG0 X60. Z2.\nG71 U20. R1.\nG71 P10 Q20 U0 W0 F.2\n{before}N10 G0 X40.\n{inside}G1 Z-10.\nN20 X60.\n\
         G0 X70.\nM30\n"
    )
}

#[test]
fn a_contour_is_passed_over_and_what_it_says_does_nothing() {
    // R8, K12: F, S, M and waits of the profile do nothing while roughing.
    let run = run(FANUC, &roughing("(COMMENT)\n", "G4 X5.\nM8\nS900\nF.5\n"));
    let expected = [[60.0, 2.0], [40.0, 2.0], [40.0, -10.0], [60.0, -10.0], [60.0, 2.0], [70.0, 2.0]];
    assert_eq!(moves(&run), expected);
    let acts = |what: &EventKind| matches!(what, EventKind::Dwell { .. } | EventKind::Coolant { .. });
    assert!(!run.events.iter().any(|event| acts(&event.what)));
    let feeds = run.events.iter().filter_map(|event| match event.what {
        EventKind::Feed { feed, .. } => Some(feed),
        _ => None,
    });
    assert_eq!(feeds.collect::<Vec<_>>(), [0.2, 0.2]);
}

#[test]
fn what_has_no_place_in_a_contour_stops_the_run() {
    // R7, R3, K12.
    for (inside, number, names) in [
        ("M98 P2\n", "PS0210", "call"),
        ("G65 P2\n", "PS0210", "call"),
        ("G20\n", "PS0066", "Dimensions in inch"),
        ("G54\n", "PS0066", "work offset"),
        ("#1=2.\n", "", "statement"),
        ("IF[1 EQ 2] GOTO 20\n", "", "statement"),
        ("G1 X41. K2.\n", "PS0051", "another way"),
    ] {
        let found = alarm(&run(FANUC, &roughing("", inside)));
        assert!(found.0 == number && found.1.contains(names), "{inside}: {found:?}");
    }
    assert!(alarm(&run(FANUC, &roughing("M8\n", ""))).1.contains("passed over"));
    // From the cycle on the second N10 comes first, from the first block on the other one.
    let twice = "O1\nN10 G0 X60. Z2.\nG71 U2. R.5\nG71 P10 Q20 F.2\nN10 G0 X40.\nN20 G1 Z-10.\nM30\n";
    assert!(alarm(&run(FANUC, twice)).1.contains("more than once"));
    // Haas has no numbers for its alarms.
    let text = "O1\nG0 X60. Z2.\nG71 P10 Q30 D2. F.2\nN10 G0 X40.\nN20 G1 Z-10.\nM30\n";
    assert_eq!(alarm(&run(HAAS, text)).0, "");
}

#[test]
fn numbers_of_increments_are_computed_too() {
    // G1: P and Q count thousandths whatever a number without a point counts elsewhere; with a point they are an alarm.
    let profile = format!("{FANUC}[parameters]\n3401.0 = 1\n");
    let text =
        |peck: &str| format!("O1\nG97 S500 M3\nG0 X0 Z2.\nG74 R.5\n#1=4.\nG74 Z-6. Q{peck} F.1\nM30\n");
    let expected = [[0.0, 2.0], [0.0, -2.0], [0.0, -1.5], [0.0, -6.0], [0.0, 2.0]];
    assert_eq!(moves(&run(&profile, &text("4000"))), expected);
    assert_eq!(moves(&run(&profile, &text("[#1*1000]"))), expected);
    assert_eq!(alarm(&run(&profile, &text("4."))).0, "PS0007");
}

#[test]
fn a_variable_lead_has_a_longer_way_each_turn() {
    // M5: the event holds the change; a lead that becomes negative before the end is an alarm.
    let text = |k: &str| format!("O1\nG97 S500 M3\nG0 X30. Z2.\nG34 Z-38. F2. K{k} Q90000\nM30\n");
    let grows = run(FANUC, &text("0.1"));
    let found = grows.events.iter().find_map(|event| match event.what {
        EventKind::Thread { lead, change, start, .. } => Some((lead, change, start)),
        _ => None,
    });
    assert_eq!(found, Some((2.0, 0.1, 90_000.0)));
    assert_eq!(alarm(&run(FANUC, &text("-0.1"))).0, "PS0313");
}

#[test]
fn the_nose_comes_from_the_offset() {
    // Q1.
    let run = run(FANUC, "O1\n#2203=.8\n#2303=3\nT0303\nG42 G0 X60. Z2.\nG40 G0 X70.\nM30\n");
    let told: Vec<(f64, u32)> = run
        .events
        .iter()
        .filter_map(|event| match event.what {
            EventKind::CutterRadius { value, tip, .. } => Some((value, tip)),
            _ => None,
        })
        .collect();
    assert_eq!(told, [(0.8, 3), (0.0, 0)]);
}

#[test]
fn threads_run_out_as_the_settings_say() {
    // P9: tenths of a lead on Fanuc, leads by setting 95 on Haas, nothing after M24.
    let chamfers = |run: &Run| -> Vec<Option<f64>> {
        let threads = run.events.iter().filter_map(|event| match event.what {
            EventKind::Thread { chamfer, .. } => Some(chamfer),
            _ => None,
        });
        threads.collect()
    };
    let text = "O1\nG97 S500 M3\nG0 X30. Z2.\nG76 P011560 Q100 R0.\nG76 X27. Z-20. P1500 Q1500 F2.\nG92 X29. Z-20. F2.\nM30\n";
    assert_eq!(chamfers(&run(FANUC, text)), [Some(3.0), Some(3.0), None]);
    let profile = format!("{HAAS}[settings]\n95 = \"1\"\n96 = \"45\"\n86 = \"0\"\n99 = \"0\"\n");
    let text = "O1\nG97 S500 M3\nG0 X30. Z2.\nG92 X29. Z-20. F2.\nM24\nX28.\nM23\nX27.\nM30\n";
    assert_eq!(chamfers(&run(&profile, text)), [Some(2.0), Some(0.0), Some(2.0)]);
}

/// Q3: the words of corners without a comma, by parameter 3405.4.
#[test]
fn corners_without_a_comma() {
    let letters = format!("{FANUC}[parameters]\n\"3405.4\" = 1\n");
    let ways = |profile: &str, blocks: &str| {
        let run = run(profile, &format!("O1\nG0 X20. Z2.\n{blocks}\nM30\n"));
        assert!(!matches!(run.end, End::Alarm { .. }), "{blocks}: {:?}", run.end);
        moves(&run).into_iter().skip(1).collect::<Vec<_>>()
    };
    let signs = "G1 Z-20. R3. F.2\nX40. K-1.\nZ-40. I2.\nX50.";
    let corners = [
        [20.0, -17.0],
        [26.0, -20.0],
        [38.0, -20.0],
        [40.0, -21.0],
        [40.0, -38.0],
        [44.0, -40.0],
        [50.0, -40.0],
    ];
    assert_eq!(ways(FANUC, signs), corners);
    let back = [[20.0, -17.0], [14.0, -20.0], [12.0, -20.0], [10.0, -21.0], [10.0, -40.0]];
    assert_eq!(ways(&letters, "G1 Z-20. C-3. F.2\nX10. R-1.\nZ-40."), back);
    // As a drawing gives them, without a sign, the next line may go any way.
    assert_eq!(ways(&letters, "G1 Z-20. C3. F.2\nX10. R1.\nZ-40."), back);
}

#[test]
fn corners_that_are_alarms() {
    let number = |blocks: &str| alarm(&run(FANUC, &format!("O1\nG0 X20. Z2.\n{blocks}\nM30\n"))).0;
    for (blocks, wanted) in [
        ("G1 G42 Z-20. ,R3. F.2\nX40.", "PS0039"),
        ("G1 Z-20. R-3. F.2\nX40.", "PS0051"),
        ("G1 Z-20. R3. F.2\nX40. Z-30.", "PS0051"),
        ("G1 Z-20. R3. F.2\nG2 X40. Z-30. R10.", "PS0052"),
        ("G1 Z-20. ,R3. F.2\nG0 X40.", "PS0052"),
        ("G1 Z-20. ,C1. F.2\nM8\nX40.", "PS0052"),
        ("G1 Z-20. ,C1. F.2", "PS0052"),
        ("G1 Z-20. R3. I1. F.2\nX40.", "PS0053"),
        ("G1 Z-20. ,C1. ,R1. F.2\nX40.", "PS0053"),
        ("G1 X30. Z-20. R3. F.2\nX40.", "PS0054"),
        ("G1 Z-20. K3. F.2\nX40.", "PS0054"),
        ("G1 Z-20. R30. F.2\nX90.", "PS0055"),
        ("G1 Z-20. R12. F.2\nX40.", "PS0055"),
        ("G1 Z-20. ,C12. F.2\nX40.", "PS0055"),
        // Two corners that take more than the line between them.
        ("G1 Z-20. ,C6. F.2\nX40. ,C6.\nZ-40.", "PS0055"),
        ("G1 ,A180. F.2\nX40. Z-20.", "PS0056"),
        ("G1 ,A180. F.2\nX40. ,A120.", "PS0056"),
        ("G1 X40. ,A180. F.2", "PS0057"),
        ("G1 X40. ,A180.9 F.2", "PS0057"),
        ("G1 ,A180. F.2\nX40. Z-20. ,A0.5", "PS0058"),
        // No source says what these do.
        ("G1 Z-20. ,R3. F.2\nG2 X40. Z-30. R10.", ""),
        ("G1 Z-20. ,C-3. F.2\nX40.", ""),
        ("G0 Z-20. ,C3.\nG1 X40. F.2", ""),
        ("G1 Z-20. ,R3. F.2\nZ-30.", ""),
        ("G1 Z-20. ,R3. F.2\nG4 P500\nX40.", ""),
        ("G1 X40. Z-20. ,A135. F.2", ""),
        ("G1 ,A135. F.2\nU20. W-20. ,A180.", ""),
    ] {
        assert_eq!(number(blocks), wanted, "{blocks}");
    }
}

/// Q3: from Z, counter-clockwise, in real lengths: 10 mm of radius at 135 degrees go 10 mm toward the chuck.
#[test]
fn lines_by_their_angle() {
    let ends = |blocks: &str| {
        let all = moves(&run(FANUC, &format!("O1\nG0 X20. Z2.\n{blocks}\nM30\n")));
        all.last().map(|end| end.map(|place| (place * 1e6).round() / 1e6)).unwrap_or_default()
    };
    assert_eq!(ends("G1 X40. ,A135. F.2"), [40.0, -8.0]);
    assert_eq!(ends("G1 Z-8. ,A135. F.2"), [40.0, -8.0]);
    assert_eq!(ends("G1 W-10. ,A225. F.2"), [0.0, -8.0]);
}

/// C1: every X counts twice, and what reads a place is not known.
#[test]
fn radii() {
    let radii = format!("{FANUC}[parameters]\n\"1006.3\" = 0\n");
    let text = "O1\nG0 X30. Z2.\nG1 U-2. F.2\nX20. Z0.\nM30\n";
    assert_eq!(moves(&run(&radii, text)), [[60.0, 2.0], [56.0, 2.0], [40.0, 0.0]]);
}

/// R10: the arc of a round corner may begin a hair before its top. With R.1 from X19.98 Z0. to X20.2 Z-.11 the centre lies at radius 10.0006 and
/// Z-.0994, so the top is 0.0006 above Z0.: less than any word can say. With R.3 from X19.5 to X20.2 Z-.2 it is 0.0071 above.
#[test]
fn the_top_of_a_rounded_corner_does_not_turn_a_contour_back() {
    let text = |start: &str, arc: &str| {
        let cycle = "G71 U2. R.5\nG71 P10 Q20 U.4 W.1 F.2";
        format!(
            "O1\nG97 S500 M3\nG0 X30. Z2.\n{cycle}\nN10 G0 X{start}\nG1 Z0. F.1\n{arc}\nG1 Z-9.\nN20 X30.\nM30\n"
        )
    };
    let near = run(FANUC, &text("19.98", "G3 X20.2 Z-.11 R.1"));
    assert!(!matches!(near.end, End::Alarm { .. }), "{:?}", near.end);
    assert_eq!(alarm(&run(FANUC, &text("19.5", "G3 X20.2 Z-.2 R.3"))).0, "PS0064");
}
