//! What random programs showed, as small as it goes.

use super::*;

/// One third is 0.333 where words are rounded, and stays what it is where they are not.
#[test]
fn what_is_read_back_of_a_word_hangs_on_whether_words_are_rounded() {
    let source = "G90\nG1 F100\nV31=1\nV33=V31/3\nX=V33\nV32=X\nM30\n";
    let with = |read: &str| {
        let target = format!("O1\nG21G90G1F100.\n#501=1\n#503=#501/3\nX#503\n#502={read}\nM30\n");
        run("cc100", source, "fanuc", &target, &[("V31", 501), ("V32", 502), ("V33", 503)])
    };
    let found = with("#5041");
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert!(found.reasons.iter().any(|reason| reason.text.contains("word.rounds.to.increment")));
    assert_eq!(with("#5041+0.0005").outcome, Outcome::Different);
    assert_eq!(with("#5042").outcome, Outcome::Different);
}

/// O2 is run on a way that no caller's run goes: what it reads there is a number on the source, of all that `V(..)` names.
#[test]
fn what_a_called_program_finds_among_numbered_variables_is_never_vacant() {
    let o2 = "#IF V13>=4 THEN GOTO :L11\n#V3=R8\n#GOTO :L10\n#:L11\n#R9=V3\nG90 G0 Z+R9\n#:L10\nM99\n";
    let source = format!("O1\n#V(2)=R8\nM98 P2\nM2\nO2\n{o2}");
    let o1 = "#602=#508\nIF[#613EQ#0]THEN#613=0\nIF[#603EQ#0]THEN#603=0\n";
    let o2 = "IF[#613GE4]GOTO11\n#603=#508\nGOTO10\nN11#509=#603\nG90G0Z#509\nN10M99\n";
    let target = format!("O1\nIF[#508EQ#0]THEN#508=0\n{o1}M98P2\nM2\nO2\n{o2}");
    let names = [("V(..)", 600), ("R8", 508), ("R9", 509)];
    let found = programs(("fadal", &source), ("fanuc", &target), &names);
    assert!(found[1].witness.is_none(), "{:#?}", found[1]);
}

/// A computed angle is rounded to thousandths of a degree, or is not: a position twelve inches from the centre tells.
#[test]
fn what_is_read_back_of_a_rotation_hangs_on_whether_its_angle_is_rounded() {
    let source = "O1\nG20 G90 G0 X12. Y0\n#R9=17/7\nG68 X0 Y0 R+R9\nG0 X-12. Y-12.\nG69\n#V1=AX\nM30\n";
    let with = |read: &str| {
        let target =
            format!("O1\nG20G90G0X12.Y0\n#509=17/7\nG68X0Y0R#509\nG0X-12.Y-12.\nG69\n#501={read}\nM30\n");
        run("fadal", source, "fanuc", &target, &[("R9", 509), ("V1", 501)])
    };
    let found = with("#5041");
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert!(
        found.reasons.iter().any(|reason| reason.text.contains("word.rounds.to.increment")),
        "{found:#?}"
    );
    assert_eq!(with("#5041+0.0005").outcome, Outcome::Different);
}

/// O2 hands on a variable before it writes it: what its callers left there is a number on the source.
#[test]
fn what_a_called_program_hands_on_is_never_vacant() {
    let source = "O1\nM98 P2\nM2\nO2\nM98 P3\n#R7=1\nM98 P3\nM99\nO3\nG90 G0 Y+R7\nM99\n";
    let target =
        "O1\nIF[#507EQ#0]THEN#507=0\nM98P2\nM2\nO2\nM98P3\n#507=1\nM98P3\nM99\nO3\nG90G0Y#507\nM99\n";
    let found = programs(("fadal", source), ("fanuc", target), &[("R7", 507)]);
    assert!(found.iter().all(|program| program.witness.is_none()), "{found:#?}");
    // O1 is not called: it has to see to the variable itself.
    let found = programs(
        ("fadal", source),
        ("fanuc", &target.replace("IF[#507EQ#0]THEN#507=0\n", "")),
        &[("R7", 507)],
    );
    assert_eq!(found[0].outcome, Outcome::Different);
}

/// Which settings stand before a code that the target lacks, and which after it, nobody could tell.
#[test]
fn settings_are_told_apart_across_a_code_that_is_left_out() {
    let program = |ramps: &str| format!("O1\nG90 G0 X1.\nS800 M3\n{ramps}S1200 M3\nG1 X2. F10.\nM2\n");
    let across = |target: &str| run("fadal", &program("G8\n"), "fanuc", target, &[]);
    let found = across(&program(""));
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert!(found.reasons.iter().any(|reason| reason.text.contains("is dropped")), "{found:#?}");
    assert_eq!(across(&program("").replace("S1200 ", "")).outcome, Outcome::Different);
}

#[test]
fn a_move_where_no_feed_was_given_says_nothing_of_feeds() {
    let across = |source: &str, target: &str| run("fadal", source, "fanuc", target, &[]);
    let found = across("G90 G1 X1.\nM2\n", "G90 G1 X1. F100.\nM2\n");
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert!(
        found.reasons.iter().any(|reason| reason.text.contains("moves at feed without a feed")),
        "{found:#?}"
    );
    let other = across("G90 G1 X1. F50.\nM2\n", "G90 G1 X1. F100.\nM2\n");
    assert_eq!(other.outcome, Outcome::Different);
    assert_eq!(across("G90 G1 X1.\nM2\n", "G90 G1 X2. F100.\nM2\n").outcome, Outcome::Different);
}

/// The moves show it: with offsets of their own, a move under G53 and one under G54 end in two places.
#[test]
fn which_work_offset_is_selected_shows_in_the_moves_alone() {
    let source = "G90\nG53\nG0 X1\nY2\nG54\nG0 X2\nM30\n";
    let across = |target: &str| run("cc100", source, "fanuc", target, &[]);
    let found = across("G90G0G53X1.\nG53Y2.\nG54X2.\nM30\n");
    assert_ne!(found.outcome, Outcome::Different, "{:#?}", found.witness);
    assert_eq!(across("G90G0G53X1.\nY2.\nG54X2.\nM30\n").outcome, Outcome::Different);
}

/// A register for values in between has the number of a variable that the source never touches.
#[test]
fn registers_for_values_in_between_are_not_compared() {
    let (source, target) = ("O1\n#502=5\nM30\n", "O1\n#501=4\n#502=#501+1\nM30\n");
    assert_eq!(run("fanuc", source, "haas", target, &[]).outcome, Outcome::Different);
    let scratch = [501].into();
    let found = named(("fanuc", source), ("haas", target), SymbolMap { scratch, ..SymbolMap::default() });
    assert_eq!(found[0].witness, None);
}

/// O1 calls O2 in inches, where a count is 0.0001: 13 of them are 0.0013. Started in millimetres O2 does something
/// else by itself, and its caller never gives it the argument that it would take for that.
#[test]
fn a_called_program_is_run_in_the_unit_of_its_callers() {
    let library =
        |way: &str| format!("O1\nG20 G90 G0 X1.\nG65 P2\nM30\nO2\nIF [#1 EQ #0] GOTO 9\nG0 Y{way}\nN9 M99\n");
    let across = |way: &str| programs(("haas", &library("13")), ("haas", &library(way)), &[]);
    let found = across("0.0013");
    assert_eq!((found[0].outcome, found[1].outcome), (Outcome::Same, Outcome::Undecided), "{found:#?}");
    assert!(found[1].reasons.iter().any(|reason| reason.text.contains("in inches")), "{found:#?}");
    assert_eq!(across("0.013")[1].outcome, Outcome::Different);
}

/// The place where the tool stands before its first move is no whole number of increments: the word rounds it.
#[test]
fn a_first_move_that_goes_nowhere_is_none() {
    let source = "O1\nG90 G81 G99 Z-1. R0+.1 F5.\nM45\nG80\nM2\n";
    let across = |y: &str| {
        let target = format!("O1\nG90G81G99Z-1.R.1F5.L0\nX#5041Y{y}\nG80\nM2\n");
        run("fadal", source, "fanuc", &target, &[])
    };
    assert_eq!(across("#5042").witness, None);
    assert_eq!(across("[#5042+0.01]").outcome, Outcome::Different);
}

/// Fifty questions, two more than the operator has answers for: the rest are 0 on both sides.
#[test]
fn questions_beyond_the_answers_are_answered_on_both_sides() {
    let source = "O1\n#V2=50\n#:A\n#INPUT V1\n#V3=V3+V1\n#V2=V2-1\n#IF V2>0 THEN GOTO :A\nM2\n";
    let target = "O1\n#502=50\nN1 #501=0\n#3006=1(SET #501)\n#503=#503+#501\n#502=#502-1\n\
                  IF[#502GT0]GOTO1\nM2\n";
    let names = [("V1", 501), ("V2", 502), ("V3", 503)];
    assert_eq!(run("fadal", source, "fanuc", target, &names).witness, None);
}

/// `M99 P` is a matter of whoever called: O1 goes on at N20 on both sides, O2 alone only says where to.
#[test]
fn a_return_to_a_block_shows_in_callers_alone() {
    let source = "O1\nM98P2\nG90G0X1.\nN20G90G0X2.\nM30\nO2\nG90G0Y1.\nM99P20\n";
    let with = |register: u32| {
        let target = format!(
            "O1\nM98P2\nIF[#501EQ20]GOTO20\nG90G0X1.\nN20G90G0X2.\nM30\nO2\nG90G0Y1.\n#{register}=20\nM99\n"
        );
        let names = SymbolMap { scratch: [501, 502].into(), ..SymbolMap::default() };
        named(("fanuc", source), ("haas", &target), names)
    };
    let found = with(501);
    assert!(found.iter().all(|program| program.witness.is_none()), "{found:#?}");
    assert!(found[1].reasons.iter().any(|reason| reason.text.contains("block P20 of its caller")));
    assert_eq!(with(502)[0].outcome, Outcome::Different);
}

/// The target calls a program that has no conversion: which speed that one sets, its run cannot show.
#[test]
fn settings_before_a_call_that_cannot_run_are_not_compared() {
    let source = "O1\nG90G0X1.\nS800M3\nM98P2\nG0X2.\nM30\nO2\nS700M3\nM99\n";
    let across = |speed: u32| {
        let target = format!("O1\nG90G0X1.\nS{speed}M3\nM98P2\nG0X2.\nM30\n");
        programs(("fanuc", source), ("haas", &target), &[])[0].clone()
    };
    let found = across(800);
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert!(found.reasons.iter().any(|reason| reason.why == Why::CannotRun));
}

/// The word of the angle is 0.333: 200 mm from the centre that is 0.0012 mm, on the first move already.
#[test]
fn the_far_end_of_a_turned_move_is_off_by_what_the_angle_rounds() {
    let source = "O1\nG90 G0 X0 Y0\n#R9=1/3\nG68 X0 Y0 R+R9\nX200. Y20.\nG69\nM2\n";
    let across = |x: &str| {
        let target = format!("O1\nG90G0X0.Y0.\n#509=1/3\nG68X0.Y0.R#509\nX{x}Y20.\nG69\nM2\n");
        run("fadal", source, "fanuc", &target, &[("R9", 509)])
    };
    assert_eq!(across("200.").witness, None);
    assert_eq!(across("200.01").outcome, Outcome::Different);
    // An axis that no word names: where it stands in turned coordinates hangs on the angle too.
    let source = "O1\n#R9=COS(1)\nG90 G68 X0 Y0 R+R9\nG1 X-100. F100.\nG69\nM2\n";
    let target = "O1\n#509=COS[1]\nG90G68X0.Y0.R#509\nG1X-100.F100.\nG69\nM2\n";
    assert_eq!(run("fadal", source, "fanuc", target, &[("R9", 509)]).witness, None);
}

/// A third of a degree is rounded by a 3000th of one: at 2000 mm that is 0.012 mm, also where the rotation has ended.
#[test]
fn where_a_rotation_put_the_machine_it_stays() {
    let source = "O1\nG90 G0 X0 Y0\n#R9=1/3\nG68 X0 Y0 R+R9\nX2000. Y0\nG69\nM2\n";
    let ends = |angle: &str| {
        let target = format!("O1\nG90G0X0.Y0.\n#509=1/3\nG68X0.Y0.R{angle}\nX2000.Y0.\nG69\nM2\n");
        run("fadal", source, "fanuc", &target, &[("R9", 509)])
    };
    assert_eq!(ends("#509").witness, None);
    assert_eq!(ends("0.335").outcome, Outcome::Different);
}

/// A place that is read back can be said again: 0.127 mm are 0.005 inch, a whole number of increments in both.
#[test]
fn the_machine_stands_where_words_of_either_unit_can_say() {
    use crate::verify::explore::{Inputs, Proposals};
    let inputs = Inputs { rotary: [true; 3], ..Inputs::default() };
    let mut proposals = Proposals::new(&inputs, Effort::default());
    for _ in 0..24 {
        let scenario = proposals.next().unwrap();
        let lengths = scenario.tools.values().flat_map(|tool| [tool.length, tool.length_wear]);
        let places = scenario.start.into_iter().chain(scenario.references.into_iter().flatten());
        let offsets = scenario.work_offsets.values().flatten().copied();
        for value in places.chain(offsets).chain(lengths) {
            let thousandths = (value * 1000.0).round();
            assert!((value * 1000.0 - thousandths).abs() < 1e-9 && thousandths % 127.0 == 0.0, "{value}");
        }
    }
}

/// Five at 30 degrees from (10, 20) are 14.330127 and 22.5: whether the machine stands at 14.33 no source says.
#[test]
fn what_is_read_back_behind_a_polar_move_hangs_on_rounding() {
    let source = "G90\nG0 X0 Y0\nG20 X10 Y20\nG0 A30 D5\nV32=X\nM30\n";
    let with = |x: &str| {
        let target = format!("O1\nG21G90G0X0.Y0.\nX[{x}+5*COS[30]]Y[20+5*SIN[30]]\n#502=#5041\nM30\n");
        run("cc100", source, "fanuc", &target, &[("V32", 502)])
    };
    let found = with("10");
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert!(found.reasons.iter().any(|reason| reason.text.contains("word.rounds.to.increment")));
    assert_eq!(with("10.001").outcome, Outcome::Different);
}

/// A diameter that a word rounds to .001 mm is a radius of half of that; 0.003 mm are more than any increment.
#[test]
fn a_tool_size_may_be_off_by_what_its_word_rounds() {
    let program = |write: &str| {
        format!("O1\nG21 G90 G0 X0. Y0.\n{write}\nG41 D3 G1 X5. Y5. F100.\nG40 G1 X0. Y0.\nM30\n")
    };
    let source = program("G10 L12 P3 R10.003");
    let found = |target: &str| run("haas", &source, "fanuc", &program(target), &[]);
    assert_eq!(found("#1=10.003/2\nG10 L12 P3 R#1").witness, None);
    assert_eq!(found("#1=10.009/2\nG10 L12 P3 R#1").outcome, Outcome::Different);
}

/// The source's length stays where its control has no machine move; whether the target's is back shows where it counts.
#[test]
fn a_length_that_may_be_lost_is_the_same_at_a_return() {
    let source = "O1\nG90G17G40G49G80E1\nM98P2\nM2\nO2\nH2G0Z20.\nE0G0X0Y0\nE1\nM99\n";
    let found = |length: &str| {
        let target =
            format!("O1\nG90G17G40G49G80G54\nM98P2\nM2\nO2\nG43{length}G0Z20.\nG53G0X0.Y0.\nG54\nM99\n");
        programs(("fadal", source), ("fanuc", &target), &[])[1].outcome
    };
    assert_ne!(found("H2"), Outcome::Different);
    assert_eq!(found("H3"), Outcome::Different);
}

/// A rotation puts Y at 1/2*sqrt(3) inches, which no word says: a cycle that is run there rounds it, and what is read after
/// it is half a ten-thousandth off at the most.
#[test]
fn a_place_that_is_read_behind_a_rounded_word_is_as_far_off() {
    let source = "O1\nG20\nG90 G17 G0 X0 Y0 E1\nG68 X0 Y0 R30.\nG1 Y1. F30.\nG69\nG81 G98 Z-7. R0+.1 F30.\nM45\nG80\n#V5=AY\nM2\n";
    let with = |read: &str| {
        let target = format!(
            "O1\nG20\nG90G17G54\nG0X0.Y0.\nG68X0Y0R30.\nG1Y1.F30.\nG69\nG81G98Z-7.R0.1F30.L0\nX#5001Y#5002\nG80\n#505={read}\nM2\n"
        );
        run("fadal", source, "fanuc", &target, &[("V5", 505)])
    };
    let found = with("#5042");
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert!(
        found.reasons.iter().any(|reason| reason.text.contains("a position that was read")),
        "{found:#?}"
    );
    assert_eq!(with("#5042+0.0002").outcome, Outcome::Different);
}

/// What is read of a place that words rounded is off, and the next word that it makes rounds again: 5.99348 inches on one
/// side and 5.9936 on the other, where the three words alone round a ten-thousandth.
#[test]
fn a_place_that_is_read_and_written_again_is_off_twice() {
    let source = "O1\nG20 G90 G0 Z0 E1\n#R1=1.49837\nG91\nG0 Z+R1\n#R1=AZ\nG0 Z+R1\n#R1=AZ\nG0 Z+R1\nM2\n";
    let with = |last: &str| {
        let target = format!(
            "O1\nG20G90G54\nG0Z0.\n#501=1.49837\nG91\nG0Z#501\n#501=#5043\nG0Z#501\n#501=#5043\nG0Z[#501{last}]\nM2\n"
        );
        run("fadal", source, "fanuc", &target, &[("R1", 501)])
    };
    let found = with("");
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert_eq!(with("+0.01").outcome, Outcome::Different);
}

/// 2^24 + 1 is 2^24 to a control of 24 binary digits, and more than that to one of doubles.
#[test]
fn a_constant_of_more_digits_than_the_source_has_is_marked() {
    let marked = |limit: &str| {
        let program = format!("O1\nG21G90G54\n#1=16777217\nIF[#1GT{limit}]GOTO9\nG0X5.\nN9M30\n");
        let found = run("haas", &program, "fanuc", &program, &[]);
        assert_ne!(found.outcome, Outcome::Different, "{:#?}", found.witness);
        found.unconfirmed.iter().any(|fact| fact == "machine:arithmetic.last.digit")
    };
    assert!(marked("16777216"));
    assert!(!marked("16777000"));
}

/// A caller's return to the reference position leaves it to the called program whether the length is back.
#[test]
fn a_called_program_finds_the_length_that_its_caller_may_have_lost() {
    let o2 = "#IF V10<=1 THEN GOTO :L10\nG1 Z3.\n#:L10\nM99\n";
    let source = format!("O1\n#CLEAR\nG90G17G40G49G80E1\nH2G0Z30.\nG28X0Y0Z0\nG1F300.\nM98P2\nM2\nO2\n{o2}");
    let found = |length: &str| {
        let o2 = format!("IF[#510LE1]GOTO10\nG43G1Z3.{length}\nN10M99\n");
        let target = format!(
            "O1\n#510=0\nG90G17G40G49G80G54\nG43H2G0Z30.\nG28X0.Y0.Z0.\nG1F300.\nM98P2\nM2\nO2\n{o2}"
        );
        programs(("fadal", &source), ("fanuc", &target), &[("V10", 510)])[1].outcome
    };
    assert_ne!(found("H2"), Outcome::Different);
    assert_eq!(found("H3"), Outcome::Different);
}

/// A place along another axis holds no length, which a machine move may have cancelled on one control.
#[test]
fn a_position_along_another_axis_asks_for_no_length() {
    let text = "O1\nG21G90G17G40G49G80G54\nS800M3\nG43H4Z30.\nG53G0Z0.\n#140=#5002\nM5\nM30\n";
    assert_ne!(run("fanuc", text, "haas", text, &[]).outcome, Outcome::Different);
    let there = text.replace("#140=#5002", "#140=#5001");
    assert_eq!(run("fanuc", text, "haas", &there, &[]).outcome, Outcome::Different);
}

/// A cycle that only keeps its words places nothing by a length that the caller may have lost.
#[test]
fn a_cycle_that_is_kept_for_later_asks_for_no_length() {
    let head = "S800M3\nG1F300.\n";
    let found = |cycle: &str| {
        let source = format!(
            "O1\nG0G90G17G40G49G80E1\n{head}H3Z20.\nG28X0Y0\nM98P2\nM2\nO2\nG82G98Z-4.82R0+2.P250F120.\nG80\nM99\n"
        );
        let target = format!(
            "O1\nG20\nG0G90G17G40G49G80G54\n{head}G43H3Z20.\nG28X0.Y0.\nM98P2\nM2\nO2\n{cycle}\nG80\nM99\n"
        );
        programs(("fadal", &source), ("fanuc", &target), &[("R0", 550)])[1].outcome
    };
    assert_ne!(found("#550=2\nG82G98Z-4.82R2.P250F120.L0"), Outcome::Different);
    assert_eq!(found("#550=2\nG82G98X1.Z-4.82R2.P250F120."), Outcome::Different);
}
