//! What random programs showed of spindle and coolant, as small as it goes.

use super::*;

/// The target has one coolant, and its end ends that; mist in place of flood shows nowhere.
#[test]
fn the_other_coolant_before_an_end_is_the_one_that_is_on() {
    let head = "O1\nG21G90G94G54\nS800M3\nM8\nG1X5.F100.\n";
    let found =
        |last: &str| run("fanuc", &format!("{head}M7\nM30\n"), "haas", &format!("{head}{last}M30\n"), &[]);
    assert_eq!(found("").outcome, Outcome::Undecided);
    assert_eq!(found("X6.\n").outcome, Outcome::Different);
}

/// G86 and G76 stop the spindle and let it turn again, which says nothing where the change may have stopped it.
#[test]
fn a_cycle_says_nothing_of_a_spindle_that_may_stand() {
    for cycle in ["G86", "G76Q.2"] {
        let text = format!("O1\nG21G90G17G54\nS800M3\nG0X0.Y0.Z20.\nT2M6\nG99{cycle}X4.Z-3.R2.F120.\nG80\n");
        let found = |target: &str| {
            let target = format!("{text}{target}M5\nM30\n");
            run("haas", &format!("{text}M30\n"), "fanuc", &target, &[]).outcome
        };
        assert_ne!(found(""), Outcome::Different, "{cycle}");
        assert_eq!(found("M3\nG1X5.\n"), Outcome::Different, "{cycle}");
    }
}

/// A spindle that is held at an angle stands: an end that is known to stop one shows nothing.
#[test]
fn an_end_stops_no_spindle_that_is_held() {
    let text = "O1\nG21G90G17G54\nS800M3\nG1F300.X9.\nT2M6\nM19\n";
    let found = |source: &str, target: &str| {
        run("haas", &format!("{text}{source}M30\n"), "fanuc", &format!("{text}{target}M30\n"), &[]).outcome
    };
    assert_ne!(found("", ""), Outcome::Different);
    // Where another way has it turning, the conversion stops it.
    assert_ne!(found("", "M5\n"), Outcome::Different);
    assert_eq!(found("", "M5\nM0\n"), Outcome::Different);
    assert_eq!(found("", "M3\nX5.\n"), Outcome::Different);
    assert_eq!(found("M3\nX5.\n", "X5.\n"), Outcome::Different);
}

/// A new speed alone starts nothing: one that a stop ends before anything is cut shows on neither side.
#[test]
fn a_speed_that_a_stop_ends_says_nothing_of_a_spindle_that_may_stand() {
    let text = "O1\nG21G90G17G54\nS800M3\nG1F300.X9.\nT2M6\n";
    let found = |source: &str, target: &str| {
        let end = "M5\nG65P2\nM30\nO2\nG1F200.S1500\nM99\n";
        let (source, target) = (format!("{text}{source}{end}"), format!("{text}{target}{end}"));
        programs(("haas", &source), ("fanuc", &target), &[])[0].outcome
    };
    assert_ne!(found("S600\n", "S600\n"), Outcome::Different);
    assert_eq!(found("S600\n", "S600M3\nX5.\n"), Outcome::Different);
    assert_eq!(found("S600M3\nX5.\n", "S600\nX5.\n"), Outcome::Undecided);
}

/// A speed that the next block's M3 replaces: the Haas starts the spindle at the end of that block, which cuts nothing.
#[test]
fn a_speed_that_is_replaced_beside_a_rapid_move_shows_on_neither_side() {
    let source = "O1\nG90G17G49G80\nG0X1.M3S900M8\nS1500\nG28X0Y0M3S900\nG1X2.F9.\nM2\n";
    let found = |speeds: &str| {
        let target = format!("O1\nG90G17G49G80\nM3S900\nG0X1.M8\n{speeds}G1X2.F9.\nM2\n");
        run("fadal", source, "haas", &target, &[]).outcome
    };
    assert_ne!(found("S1500\nG28X0.Y0.M3S900\n"), Outcome::Different);
    assert_eq!(found("S1500\nG28X0.Y0.\n"), Outcome::Different);
    assert_eq!(found("S1500\nG28X0.Y0.M3S800\n"), Outcome::Different);
}

/// A speed after a cycle that stops the spindle and lets it turn again starts nothing that may stand.
#[test]
fn a_speed_behind_a_cycle_starts_nothing() {
    let text = "O1\nG21G90G17G54\nS800M3\nG0X0.Y0.Z20.\nM1\nG99G86X4.Z-3.R2.F120.\nG80\n";
    let found = |speed: &str| {
        let end = "G1X9.F99.\nM30\n";
        run("fanuc", &format!("{text}S500\n{end}"), "haas", &format!("{text}{speed}{end}"), &[]).outcome
    };
    assert_ne!(found("S500\n"), Outcome::Different);
    assert_eq!(found("S400\n"), Outcome::Different);
    assert_eq!(found("S500M4\n"), Outcome::Different);
}

/// The source ends with an alarm, the target at its end, where the Haas stops the spindle: the coolant is on by then.
#[test]
fn what_an_end_stops_comes_after_what_was_started() {
    let text = "O1\nG21G90G54\nS800M3\nM8\n";
    let found = run("fanuc", &format!("{text}#3000=1(STOP)\nM30\n"), "haas", &format!("{text}M30\n"), &[]);
    assert_eq!(found.outcome, Outcome::Different);
    let first = found.witness.and_then(|witness| witness.source).map(|moment| moment.block);
    assert_eq!(first.as_deref(), Some("#3000=1(STOP)"));
    let text = format!("{text}X5.\nM9\n");
    let found =
        |end: &str| run("haas", &format!("{text}M30\n"), "fanuc", &format!("{text}{end}"), &[]).outcome;
    assert_ne!(found("M5\nM30\n"), Outcome::Different);
    assert_eq!(found("M3\nM30\n"), Outcome::Different);
}

/// A loop with an optional stop that one control is known to stop the spindle at: what is said of it there stays open.
#[test]
fn a_speed_behind_a_cycle_in_a_loop_starts_nothing() {
    let text = |speed: &str| {
        format!(
            "O1\nG90G17G40G49G80G94G54\nS800M3\nG1F300.\n#20=0\nWHILE[#20LT3]DO1\n#21=0\nWHILE[#21LT2]DO2\n\
             G99G86Z-4.9R2.F120.\nG80\n{speed}\n#21=#21+1\nEND2\nM1\n#20=#20+1\nEND1\nM30\n"
        )
    };
    let found = |speed: &str| run("fanuc", &text("S500"), "haas", &text(speed), &[]).outcome;
    assert_ne!(found("S500"), Outcome::Different);
    assert_eq!(found("S400"), Outcome::Different);
}

/// The conversion stops what another way has turning; where M19 holds the spindle, the stop lets it go before an M0.
#[test]
fn a_stop_before_an_m0_lets_go_of_a_spindle_that_is_held() {
    let text = "O1\nG21G90G17G54\nS800M3\nG1F300.X9.\nM19\n";
    let found = |before: &str, after: &str| {
        let source = format!("{text}M0\n{after}M30\n");
        run("haas", &source, "fanuc", &format!("{text}{before}M0\n{after}M30\n"), &[]).outcome
    };
    assert_eq!(found("M5\n", ""), Outcome::Undecided);
    assert_eq!(found("M5\n", "G0X5.\n"), Outcome::Undecided);
    assert_ne!(found("M5\n", "S900M3\nX5.\nM5\n"), Outcome::Different);
    assert_eq!(found("M3\n", "S900M3\nX5.\n"), Outcome::Different);
    assert_eq!(found("M5\nG4P500\n", "S900M3\nX5.\n"), Outcome::Different);
}

/// The operator's answer leaves open whether the target's spindle turns, and a speed says nothing of it before a stop.
#[test]
fn a_speed_before_a_stop_says_nothing_of_a_spindle_that_may_stand() {
    let found = |speed: &str| {
        let source = "O1\nG90G17G40G49G80E1\nS800M3\nG1F300.\n#INPUT V5\nS500\nM1\nM2\n";
        let target =
            format!("O1\nG90G17G40G49G80G54\nS800M3\nG1F300.\n#550=0\n#3006=1(SET #550)\n{speed}\nM1\nM2\n");
        programs(("fadal", source), ("fanuc", &target), &[("V5", 550)])[0].outcome
    };
    assert_ne!(found("S500"), Outcome::Different);
    assert_eq!(found("S500M4"), Outcome::Different);
    assert_eq!(found("S500M3\nG1X5."), Outcome::Different);
}

/// The target's question stops the spindle and the target starts it again; after that both stop it by a code.
#[test]
fn an_end_after_a_question_is_not_the_end_by_the_question() {
    let found = |after: &str| {
        let start = |offset: &str| format!("O1\nG90G17G40G49G80{offset}\nS800M3\nG1F300.\nX1.\n");
        let source = format!("{}#INPUT V5\nG1X1.\nM5\n#PRINT \"DONE\"\nM2\n", start("E1"));
        let target =
            format!("{}#550=0\n#3006=1(SET #550)\n{after}POPEN\nDPRNT[DONE]\nPCLOS\nM2\n", start("G54"));
        programs(("fadal", &source), ("haas", &target), &[("V5", 550)])[0].outcome
    };
    assert_ne!(found("M3\nG1X1.\nM5\n"), Outcome::Different);
    assert_ne!(found("M5\n"), Outcome::Different);
    assert_eq!(found("M3\nG1X1.\n"), Outcome::Different);
    assert_eq!(found("M4\nG1X1.\nM5\n"), Outcome::Different);
}

/// G74 leaves the spindle turned round: what goes on is that.
#[test]
fn a_cycle_leaves_the_spindle_turned_round() {
    let text = |last: &str| {
        format!(
            "O1\nG21G90G17G40G49G80G54\nS800M3\nG1F300.\nG99G74X5.Z-8.R2.F120.\nX7.\nG80\nM1\nG1X1.F100.\n{last}\nM30\n"
        )
    };
    let found = |last: &str| run("fanuc", &text("S600"), "haas", &text(last), &[]).outcome;
    assert_ne!(found("S600"), Outcome::Different);
    assert_eq!(found("S600M3\nX3."), Outcome::Different);
}

/// A stop leaves open whether the spindle turns on one side; a tap after it starts or turns it on both.
#[test]
fn a_tap_after_a_stop_says_nothing_of_a_spindle_that_may_stand() {
    let text = |cycle: &str, end: &str| {
        format!("O1\nG21G90G17G40G49G80G54\nS800{cycle}\nG1F300.\nM0\nG99G84Y1.Z-9.R2.F120.\nG80\n{end}M30\n")
    };
    let found =
        |cycle: &str, end: &str| run("fanuc", &text(cycle, "M5\n"), "haas", &text(cycle, end), &[]).outcome;
    assert_ne!(found("M3", "M5\n"), Outcome::Different);
    assert_ne!(found("M4", "M5\n"), Outcome::Different);
    assert_eq!(found("M3", "X5.\nM5\n"), Outcome::Different);
}

/// The source's alarm comes before the coolant that it has said is on for anything; the target has no such alarm.
#[test]
fn what_waits_at_an_alarm_of_the_source_shows_nowhere() {
    let text = |at: &str| format!("O1\nG21G90G17G40G49G80G54\nS800M3\n{at}\nS900\nM8\nM30\n");
    let found = |at: &str| run("fanuc", &text("#1=#[99999]"), "haas", &text(at), &[]).outcome;
    assert_eq!(found("#1=0"), Outcome::Undecided);
    assert_eq!(run("fanuc", &text(""), "haas", &text("G1X5.F100."), &[]).outcome, Outcome::Different);
}

/// The first run finds #1 vacant, where both sides go to 0, and takes over 60,000 blocks.
#[test]
fn a_long_program_is_compared_with_other_values_too() {
    let program =
        |by: u32| format!("O1\nG90\nG0X[#1*{by}.]\n#2=0\nWHILE[#2LT30000]DO1\n#2=#2+1\nEND1\nM30\n");
    differs("fanuc", &program(2), &program(3), "the rapid move goes elsewhere");
}

/// Two programs between machines of which the source leaves a builder's code out.
fn leaving_out(source: &str, target: &str) -> Vec<ProgramCertificate> {
    let site = "[[site]]\ncode = \"M31\"\nname = \"conveyor\"\ndo = \"omit\"\ntext = \"conveyor\"\n";
    let profile = format!("dialect = \"haas\"\n{site}");
    let controls = [Control::from_profile(&profile).unwrap(), Control::plain("fanuc").unwrap()];
    let execute = ["haas", "fanuc"].map(|name| registry::find(name).unwrap().execute.unwrap());
    let parsed = [(source, &controls[0]), (target, &controls[1])]
        .map(|(text, control)| parse_file(text.as_bytes(), control.entry().parse));
    let files = [0, 1].map(|at| [LoadedFile { name: "a.nc", parsed: &parsed[at] }]);
    let [source, target] = [0, 1].map(|at| Side::new(&controls[at], execute[at], &files[at]));
    verified([&source, &target], &SymbolMap::default(), &Assumptions::new())
}

/// A builder's code that the source's profile leaves out finds nothing on the target: a spindle that runs when the program
/// begins is told by what ends it, on both sides alike.
#[test]
fn a_code_that_is_left_out_finds_no_spindle_running() {
    let found = |target: &str| leaving_out("O1\nM31\nM5\nM30\n", target).remove(0);
    let rests = |found: &ProgramCertificate| found.reasons.iter().any(|reason| reason.why == Why::EntryState);
    assert!(!rests(&found("O1\nM5\nM30\n")));
    assert_eq!(found("O1\nG4P1.\nM5\nM30\n").outcome, Outcome::Different);
}

/// The spindle is started and stopped on both sides before the alarm. That the code stood between shows on the source alone.
#[test]
fn settings_before_a_code_that_is_left_out_count_after_it() {
    let program = |start: &str, code: &str, stop: &str| {
        format!(
            "O1\nG21G90G17G54G40G49G80\nT1M6\n{start}\n{code}G65P2\nM30\n\
             O2\nM9\n{code}{stop}IF[#522EQ5]GOTO900\nM99\nN900#3000=51(SETTER)\n"
        )
    };
    let source = program("S500M3", "M31\n", "M5\n");
    let found = |target: &str| leaving_out(&source, target)[0].outcome;
    assert_ne!(found(&program("S500M3", "", "M5\n")), Outcome::Different);
    assert_eq!(found(&program("S500M3", "", "")), Outcome::Different);
    assert_eq!(found(&program("S500M4\nG1Z5.F90.", "", "M5\n")), Outcome::Different);
}
