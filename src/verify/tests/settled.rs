//! Whether every run takes the way that one of them took.

use super::{Outcome, named, within};
use crate::control::{LoadedFile, ProgramRef, Scenario};
use crate::dialect::{Control, registry};
use crate::syntax::parse_file;
use crate::verify::explore::is_settled;
use crate::verify::{Side, SymbolMap};
use std::collections::BTreeMap;

/// Whether that is said of a program that begins so, where scenarios start `#500` with one value or another.
fn settled(blocks: &str) -> bool {
    settled_on("fanuc", blocks)
}

fn settled_on(dialect: &str, blocks: &str) -> bool {
    let control = Control::plain(dialect).unwrap();
    let entry = registry::find(dialect).unwrap();
    let text = format!("O1\nG21G17G90\n{blocks}\nG0Y1.\nN5M30\nO2\nIF[#1GT3]GOTO5\nG0X#2\nN5M99\n");
    let parsed = parse_file(text.as_bytes(), entry.parse);
    let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
    let side = Side::new(&control, entry.execute.unwrap(), &files);
    let variables = BTreeMap::from([("#500".to_owned(), 1.0), ("#101".to_owned(), 102.0)]);
    let scenario = Scenario { variables, ..Scenario::default() };
    let run = (side.execute)(&side.library, ProgramRef { file: 0, program: 0 }, &control, &scenario);
    is_settled(&side, &run, &|name| name == "#500")
}

#[test]
fn what_a_program_makes_itself_is_the_same_in_every_run() {
    for blocks in [
        "G0X1.",
        "#1=5\nIF[#1GT3]GOTO5",
        "#100=5\n#102=#100*2\nWHILE[#100LT#102]DO1\n#100=#100+1\nEND1",
        "G65P2A1.B2.",
        "G65P2A5.",
        // The codes in force are what the blocks before make them.
        "#10=#4003\nIF[#10EQ90]GOTO5\nG#10X1.",
        // It moves, and no more.
        "#100=#500\nG0X#100\n#101=5\nIF[#101GT3]GOTO5",
        "#3000=7(STOP)",
        // The statement alone makes it stop.
        "#100=1/0",
        // What stood there at first is read by none.
        "#500=5\nIF[#500GT3]GOTO5",
        "#500=3\nN1IF[#500LE0]GOTO5\n#500=#500-1\nGOTO1",
        "#500=3\nWHILE[#500GT0]DO1\n#500=#500-1\nEND1",
        "#100=5\nIF[#100GT3]GOTO7\n#500=1\nGOTO8\nN7#500=2\nN8IF[#500GT1]GOTO5",
    ] {
        assert!(settled(blocks), "{blocks}");
    }
}

#[test]
fn what_comes_from_outside_sends_runs_elsewhere() {
    for blocks in [
        "IF[#500GT3]GOTO5",
        "#100=5\nIF[#100GT#500]THEN#102=1",
        "#100=#500+1\n#102=#100*2\nIF[#102GT3]GOTO5",
        "WHILE[#500GT3]DO1\n#500=#500-1\nEND1",
        "GOTO[#500+4]",
        "G#500X1.F9.",
        "M98P[#500+1]",
        "M98P2L#500",
        // By a number that is computed, it may be any variable.
        "#[#101]=#500\nIF[#100GT3]GOTO5",
        "#[#500+100]=1\nIF[#100GT3]GOTO5",
        "#100=#[#101]\nIF[#100GT3]GOTO5",
        // An argument, and what any word of a block is.
        "G65P2A#500",
        "#100=#500\nG65P2A[#100+1]",
        // The machine.
        "#100=#5041\nIF[#100GT3]GOTO5",
        "IF[#2001GT3]GOTO5",
        "IF[#1000EQ1]GOTO5",
        "/G0X1.",
        "#3006=1(#100 DEPTH)\nIF[#100GT3]GOTO5",
        "IF[#100GT3]GOTO7\n#500=1\nN7IF[#500GT1]GOTO5",
        "N1IF[#500GT1]GOTO5\n#500=3\nGOTO1",
        "IF[#100GT3]THEN#500=1\nIF[#500GT1]GOTO5",
        "WHILE[#100GT0]DO1\n#500=1\nEND1\nIF[#500GT1]GOTO5",
        "/#500=1\nIF[#500GT1]GOTO5",
        "#500=1\n#100=4\nGOTO#100\nN4IF[#500GT1]GOTO5",
        // The control stops it: another run may go on.
        "#100=1/[#500-1]",
        "G1X1.F#0\nG999",
    ] {
        assert!(!settled(blocks), "{blocks}");
    }
    // It jumps where an input is off.
    assert!(settled_on("haas", "G0X1."));
    assert!(!settled_on("haas", "M96P5Q8\nG0X1."));
    // L is a count, and no subroutine: what the called blocks write is written.
    assert!(settled_on("haas", "M97P7L2\nGOTO5\nN7#500=2\nIF[#500GT1]GOTO8\nN8M99"));
    assert!(!settled_on("haas", "M97P7L2\nGOTO5\nN7IF[#500GT1]GOTO8\nN8M99"));
    // Words are arguments only where a call takes them.
    assert!(settled_on("haas", "#1=5\nG0X#500\nIF[#1GT3]GOTO5"));
    assert!(!settled_on("haas", "G65P2A#500"));
    assert!(!settled_on("haas", "#501=65\n#1=5\nG#501P2A#500\nIF[#1GT3]GOTO5"));
}

/// A macro that checks its arguments, and a caller that gives it right ones.
const SOURCE: &str = "O1\nG20G90G17G40G80G94G54\nG0X1.\nG65P2A1.B3.\nM30\nO2\nIF[#1LE0]GOTO9\nIF[#2LT2]GOTO9\n#3=0\n\
    WHILE[#3LT#2]DO1\nG1X[#1+#3]F10.\n#3=#3+1\nEND1\nM99\nN9#3000=1(ARGUMENT)\n";

const TARGET: &str = "\
N1 O1
N4 G20 G90 G17 G40 G80 G94 E1
N5 G0 X1.
N6 #V2=1.
N7 #V3=3.
N8 M98 P2
N9 M2
N1 O2
N4 #IF V2 LE 0 THEN GOTO :N9
N5 #IF V3 LT 2. THEN GOTO :N9
N6 #V4=0
N7 #:LOOP
N8 #IF V4 GE V3 THEN GOTO :OUT
N9 #R5=V2+V4
N10 G1 X+R5 F10.
N11 #V4=V4+1
N12 #GOTO :LOOP
N13 #:OUT
N14 M99
N15 #:N9
N16 #WAIT
N17 #PRINT \"ALARM 1 ARGUMENT\"
N18 #R9=SQR(0.-1.)
";

#[test]
fn a_search_ends_where_nothing_sends_runs_elsewhere() {
    let judged = |target: &str| {
        let names = SymbolMap {
            scratch: [2, 3, 4].into(),
            of_words: ["R5".to_owned(), "R9".to_owned()].into(),
            ..SymbolMap::default()
        };
        named(("fanuc", SOURCE), ("fadal", target), names)
    };
    let found = judged(TARGET).remove(1);
    // What no caller trips is left on both sides, as after a long search.
    let missing: Vec<(u32, &str)> = found.not_reached.iter().map(|way| (way.line, way.way)).collect();
    assert_eq!(missing, [(8, "true")], "{found:#?}");
    assert_eq!(found.outcome, Outcome::Undecided);
    assert!(found.scenarios_tried < 120, "{}", found.scenarios_tried);
    // What its caller's runs show is found all the same.
    for (from, to) in [("V4+1", "V4+2"), ("F10.", "F11."), ("V3=3.", "V3=4."), ("GE V3", "GT V3")] {
        assert_eq!(TARGET.matches(from).count(), 1, "{from}");
        let outcomes: Vec<Outcome> =
            judged(&TARGET.replace(from, to)).iter().map(|found| found.outcome).collect();
        assert_eq!(outcomes[0], Outcome::Different, "{from} made {to}");
        assert_ne!(outcomes[1], Outcome::Same, "{from} made {to}");
    }
}

/// A condition that only rare values meet is searched for as before.
#[test]
fn a_search_goes_on_where_something_may() {
    let program = "O1\nG21G17G90\n#100=#500*3\nIF[#100EQ1234.5]GOTO5\nG0X1.\nN5M30\n";
    let found = within("fanuc", program, program);
    assert_eq!((found.branches_covered, found.branches_total), (2, 2), "{found:#?}");
}

/// The ways that only other numbers in the text of a main program would go.
fn own(blocks: &str) -> Vec<String> {
    let text = format!("O1\nG20G90G17G40G80\nG0X0Y0\nIF[#500GT3]GOTO3\nN3{blocks}\nN5M30\n");
    let found = within("fanuc", &text, &text);
    found.by_own_numbers.into_iter().map(|way| format!("{} {}", way.text, way.way)).collect()
}

#[test]
fn a_way_that_only_other_numbers_would_go_is_set_aside() {
    for (blocks, ways) in [
        // A loop of fixed steps, whose last one never goes past its end.
        (
            "#100=0\nWHILE[#100LT2]DO1\n#100=#100+.5\nIF[#100GT2]THEN#100=2\nG1X#100F9.\nEND1",
            "[#100GT2] true",
        ),
        // What comes from outside is passed by before and after.
        (
            "#100=3\nIF[#501GT2]GOTO5\n#101=#100*2\nG1X1.F9.\nIF[SIN[#101]EQ.1234]GOTO5\nY1.",
            "[SIN[#101]EQ.1234] true",
        ),
    ] {
        assert_eq!(own(blocks), [ways], "{blocks}");
    }
}

#[test]
fn what_may_come_from_outside_is_not_set_aside() {
    for blocks in [
        // The machine, the operator, a switch, a mode that the program does not set.
        "#100=#5041*0+3\nIF[SIN[#100]EQ.1234]GOTO5\nG1X1.F9.",
        "#100=3\n/#100=2\nIF[SIN[#100]EQ.1234]GOTO5\nG1X1.F9.",
        "#100=3\n#3006=1(SET #100)\nIF[SIN[#100]EQ.1234]GOTO5\nG1X1.F9.",
        "IF[#4005EQ95]GOTO5\nG1X1.F9.",
        "#100=3\n#102=100\nIF[#501GT2]GOTO4\n#[#102]=2\nN4IF[SIN[#100]EQ.1234]GOTO5\nG1X1.F9.",
        // A return to a block that it names passes blocks by.
        "#100=3\n/M99P4\n#100=2\nN4IF[SIN[#100]EQ.1234]GOTO5\nG1X1.F9.",
        // A program that nobody knows.
        "#100=3\nIF[#501NE77]GOTO4\nG65P9810X1.\nN4IF[SIN[#100]EQ.1234]GOTO5\nG1X1.F9.",
        // A number that a run may pass by, or set again.
        "#100=3\nIF[#501GT2]GOTO4\n#100=2\nN4IF[SIN[#100]EQ.1234]GOTO5\nG1X1.F9.",
        "#100=3\nIF[#501GT2]THEN#100=2\nIF[SIN[#100]EQ.1234]GOTO5\nG1X1.F9.",
        "#100=0\nN4#100=#100+1\nIF[SIN[#100]EQ.1234]GOTO5\nIF[#501LT[#100-900]]GOTO4\nG1X1.F9.",
    ] {
        assert_eq!(own(blocks), [""; 0], "{blocks}");
    }
}
