//! What machines with a profile of their own do in another way, and what is the same all the same.

use super::*;

/// How a pair of programs comes out between two machines, and why it is open.
fn judged(profiles: [&str; 2], source: &str, target: &str) -> (Outcome, String) {
    renamed(profiles, source, target, &[])
}

/// The same, with the registers of variables.
fn renamed(profiles: [&str; 2], source: &str, target: &str, variables: &[(&str, u32)]) -> (Outcome, String) {
    let variables = variables.iter().map(|(name, number)| ((*name).to_owned(), *number)).collect();
    let controls = profiles.map(|text| Control::from_profile(text).unwrap());
    let texts = [source, target];
    let parsed: [_; 2] =
        std::array::from_fn(|at| parse_file(texts[at].as_bytes(), controls[at].entry().parse));
    let files: [_; 2] = std::array::from_fn(|at| [LoadedFile { name: "a.nc", parsed: &parsed[at] }]);
    let side = |at: usize| Side::new(&controls[at], controls[at].entry().execute.unwrap(), &files[at]);
    let (source, target) = (side(0), side(1));
    let job = Job {
        source: &source,
        target: &target,
        names: &SymbolMap { variables, ..SymbolMap::default() },
        assumptions: &Assumptions::new(),
        effort: Effort::default(),
        spent: &Spent::default(),
    };
    let found = verify(&job, &[]).programs.remove(0);
    let reasons = found.reasons.iter().map(|reason| reason.text.clone()).collect::<Vec<_>>().join("; ");
    (found.outcome, found.witness.map_or(reasons, |witness| witness.what))
}

const FANUC: &str = "dialect = \"fanuc\"\nunits = \"metric\"\n";
const FADAL: &str = "dialect = \"fadal\"\nunits = \"metric\"\n";
const CC100: &str = "dialect = \"cc100\"\nunits = \"metric\"\n";

/// 66 seconds, which a Fadal takes in two waits.
#[test]
fn waits_in_a_row_are_one() {
    let source = "O1\nG21G90G54G0X0.Y0.\nG4P66000\nX1.\nM30\n";
    let target = |second: u32| {
        format!("N1 O1\nN2 G21 G90 E1 G0 X0. Y0.\nN3 G4 P33000\nN4 G4 P{second}\nN5 X1.\nN6 M2\n")
    };
    let with = |second| judged([FANUC, FADAL], source, &target(second));
    assert_ne!(with(33000).0, Outcome::Different, "{}", with(33000).1);
    assert_eq!(with(32000), (Outcome::Different, "the wait differs".into()));
}

/// A loop of waits that is cut says nothing of how long it would go on.
#[test]
fn waits_of_a_run_that_is_cut_are_no_difference() {
    let source = "O1\nG21G90G54G0X0.Y0.\nN10G4P100\nIF[#1000EQ0]GOTO10\nX5.\nM30\n";
    let target = "O1\nG21 G90 G54 G0 X0. Y0.\nN10 G4 P100\nG90\nIF [#1000 EQ 0] GOTO 10\nX5.\nM30\n";
    let found = judged([FANUC, FANUC], source, target);
    assert_ne!(found.0, Outcome::Different, "{}", found.1);
}

/// A Fadal shows 40 letters of a message: what it had no room for is missed by nobody, and what it had room for is.
#[test]
fn a_message_is_as_long_as_a_screen_line() {
    let source = "O1\n#3006=1(TURN THE PART OVER AND CLAMP IT AGAIN WITH CARE)\nM30\n";
    let with = |text: &str| {
        let target = format!("N1 O1\nN2 #WAIT\nN3 #PRINT \"{text}\"\nN4 M0\nN5 M2\n");
        judged([FANUC, FADAL], source, &target)
    };
    let whole = "TURN THE PART OVER AND CLAMP IT AGAIN WI";
    assert_eq!(whole.len(), 40);
    assert_ne!(with(whole).0, Outcome::Different, "{}", with(whole).1);
    assert_eq!(with("TURN THE PART OVER"), (Outcome::Different, "the text differs".into()));
}

/// What a Fadal shows before a stop is output, where nothing waits for it to be read.
#[test]
fn output_before_a_stop_may_be_left_out() {
    let source = "N1 O1\nN2 #PRINT \"READY\"\nN3 M0\nN4 G90 G0 X1.\nN5 M2\n";
    let target = "N1 G90\nN2 M0\nN3 G0 X1\nN4 M30\n";
    let omits = format!("{CC100}outputs = \"omit\"\n");
    let found = judged([FADAL, &omits], source, target);
    assert_ne!(found.0, Outcome::Different, "{}", found.1);
    let (outcome, what) = judged([FADAL, CC100], source, target);
    assert_eq!(
        (outcome, what.as_str()),
        (Outcome::Different, "they do different things: the source stops with a message, the target stops")
    );
}

/// A value in a question's text goes with the output that the profile leaves out, and the question is asked without it.
#[test]
fn a_question_may_be_asked_without_its_text() {
    let source = "O1\n#PRINT \"DEPTH \",V1\n#INPUT V2\nG90 G0 X1.\nM2\n";
    let target = "N1 V32=0\nN2 M0\nN3 (SET V32)\nN4 G90 G0 X1\nN5 M30\n";
    let found =
        |profile: &str, target: &str| renamed([FADAL, profile], source, target, &[("V1", 31), ("V2", 32)]);
    let omits = format!("{CC100}outputs = \"omit\"\n");
    assert_ne!(found(&omits, target).0, Outcome::Different, "{}", found(&omits, target).1);
    assert_eq!(found(CC100, target).0, Outcome::Different);
    assert_eq!(found(&omits, &target.replace("SET V32", "SET V31")).0, Outcome::Different);
}

/// How far over the last depth a peck begins is a setting of each machine: where one profile says it, the other is taken to be
/// set so; where both do, they are compared.
#[test]
fn a_clearance_that_one_profile_says_is_taken_of_both() {
    let text = "O1\nG21G90G17G40G49G80G54\nS800M3\nG0X0.Y0.\nG98G83X5.Z-8.R2.Q2.F100.\nG80\nM30\n";
    let haas = "dialect = \"haas\"\nunits = \"metric\"\n";
    let says = |profile: &str, clear: &str| {
        format!("{profile}[behaviours]\ncycle.peck.clearance = \"{clear}\"\n")
            .replace("cycle.peck.clearance", "\"cycle.peck.clearance\"")
    };
    let found = |ours: &str, theirs: &str| judged([ours, theirs], text, text);
    let one = found(FANUC, &says(haas, "0.5"));
    assert_ne!(one.0, Outcome::Different, "{}", one.1);
    let other = found(&says(FANUC, "0.5"), haas);
    assert_ne!(other.0, Outcome::Different, "{}", other.1);
    assert_eq!(found(&says(FANUC, "0.5"), &says(haas, "0.8")).0, Outcome::Different);
}

/// Who has said what the word of the tool in the spindle does is not asked by each program.
#[test]
fn a_settled_tool_word_is_no_question() {
    let source = "O1\nG21G90G54\nT1M6\nG0X0.Y0.\nG43H1Z5.\nM30\n";
    let target = "N1 G90 G54\nN2 T01\nN3 G0 X0 Y0\nN4 Z5\nN5 M30\n";
    let asked = |profile: &str| {
        let (outcome, what) = judged([FANUC, profile], source, target);
        assert_ne!(outcome, Outcome::Different, "{what}");
        what.contains("does not change to it again")
    };
    let skips = format!("{CC100}[settings]\ntool_again = \"skipped\"\n");
    assert!(!asked(&skips));
    let open = format!("{CC100}[behaviours]\ntool.word.again = \"skipped\"\n");
    assert!(!asked(&open));
}

/// G49 of a Fanuc with parameter 5006.6 at 0 moves Z if a length is in force; a Haas moves nothing. A machine whose profile
/// says what it begins in begins without a length; of a program that returns its callers may have one in force.
#[test]
fn a_length_that_no_start_leaves_is_no_question() {
    let moves = format!("{FANUC}[parameters]\n5006.6 = \"0\"\n");
    let begins = format!("{moves}[start]\ncodes = \"G90\"\n");
    let haas = "dialect = \"haas\"\nunits = \"metric\"\n";
    let text = |end: &str| {
        format!("O1\nG21G90G17G40G49G80G94G98G54\nM5M9\nG0X0.Y0.\nG43H1Z5.\nG1Z-1.F100.\nG0Z50.\n{end}\n")
    };
    let asks = |profile: &str, end: &str| {
        let (outcome, what) = judged([profile, haas], &text(end), &text(end));
        assert_ne!(outcome, Outcome::Different, "{what}");
        what.contains("the tool length in force at its start")
    };
    assert!(asks(&moves, "M30"));
    assert!(!asks(&begins, "M30"));
    assert!(asks(&begins, "M99"));
}

/// A program that rests on what its machine begins in says where that is to be written.
#[test]
fn what_a_profile_may_say_of_the_start_is_named() {
    let (source, target) = ("N1 G0 X0.\nN2 G1 Y1. F100.\nN3 M2\n", "O1\nG17\nG90\nG0X0.\nG1Y1.F100.\nM30\n");
    let (outcome, what) = judged([FADAL, FANUC], source, target);
    assert_ne!(outcome, Outcome::Different, "{what}");
    assert!(what.contains("absolute or incremental mode"), "{what}");
    assert!(what.contains("Say in the source's profile what its machine begins in: [start] codes"), "{what}");
}

/// No code of this control but that for it ends a drilling cycle, so a program moves in one that an earlier program left. Where no
/// program of the library leaves one, that is no question.
#[test]
fn a_cycle_that_no_program_of_the_library_leaves_is_no_question() {
    let cc100 = "dialect = \"cc100\"\nunits = \"metric\"\n";
    let haas = "dialect = \"haas\"\nunits = \"metric\"\n";
    let source = |end: &str| {
        format!("N1 G90 G54\nN2 G0 X0 Y0 Z5\nN3 G81 V1=5 V2=-10\nN4 X10 Y10\n{end}N6 G0 X5\nN7 M30\n")
    };
    let target = |end: &str| format!("O1\nG90G54\nG0X0.Y0.Z5.\nG81R5.Z-10.L0\nX10.Y10.\n{end}G0X5.\nM30\n");
    let asks = |ends: [&str; 2]| {
        let (outcome, what) = judged([cc100, haas], &source(ends[0]), &target(ends[1]));
        assert_ne!(outcome, Outcome::Different, "{what}");
        what.contains("the drilling cycle in force at its start")
    };
    assert!(!asks(["N5 G80\n", "G80\n"]));
    assert!(asks(["", "X5.\n"]));
}

#[test]
fn a_switch_of_the_operator_that_the_target_has_not_is_no_difference() {
    let source = "O1\nG21G90G17G40G49G80G94G54\n#3003=1\nG0X1.\n#3003=0\nX3.\nM30\n";
    let target = "N1 O1\nN2 G21 G90 G17 G40 G49 G80 G94 E1\nN3 G0 X1.\nN4 X3.\nN5 M2\n";
    let found = |target: &str| super::programs(("fanuc", source), ("fadal", target), &[]).remove(0);
    let same = found(target);
    assert!(same.witness.is_none(), "{same:#?}");
    assert!(found(&target.replace("X3.", "X4.")).witness.is_some());
}
