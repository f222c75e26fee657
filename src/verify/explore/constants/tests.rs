use super::{Given, impossible};
use crate::control::{LoadedFile, ProgramRef};
use crate::dialect::Control;
use crate::syntax::parse_file;
use crate::verify::sides::Side;

/// The ways that conditions of the first program never go, each with its text.
fn never(dialect: &str, text: &str) -> Vec<(String, i64)> {
    ways(dialect, text, true)
}

fn ways(dialect: &str, text: &str, as_run: bool) -> Vec<(String, i64)> {
    ways_on(&Control::plain(dialect).unwrap(), text, as_run)
}

fn ways_on(control: &Control, text: &str, as_run: bool) -> Vec<(String, i64)> {
    let parsed = parse_file(text.as_bytes(), control.entry().parse);
    let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
    let side = Side::new(control, control.entry().execute.unwrap(), &files);
    let found = impossible(&side, ProgramRef { file: 0, program: 0 }, as_run, &Given::default());
    found.into_iter().map(|(span, way)| (text[span.range()].trim().to_owned(), way)).collect()
}

/// Whether it is known that `[#100GE0]` at the end is never false.
fn is_shown(between: &str) -> bool {
    let text = format!("O1\n#100=6000\n{between}\nIF[#100GE0]GOTO5\nG0X2.\nN5M30\nO2\nM99\n");
    never("fanuc", &text).iter().any(|(text, way)| text.contains("#100GE0") && *way == 0)
}

#[test]
fn what_jumps_come_by_with_is_known() {
    for between in [
        "N3",
        "G0X1.",
        "IF[#101GT5]GOTO7\nG0X1.\nN7",
        "IF[#100LT0]GOTO7\n#102=1\nN7#102=2",
        "IF[#100LT0]GOTO7\nGOTO8\nN7#100=-1\nN8",
        "IF[#100GT0]GOTO8\n#100=-1\nN8",
        "IF[#101GT5]GOTO7\n#100=3\nN7",
        "#100=#100*#100",
        "IF[#101GT5]THEN#100=1",
        // Round a loop, and round one in another.
        "N3\n#102=#102+1\nIF[#102LT#101]GOTO3",
        "N3\n#100=#100+1\nIF[#101GT5]GOTO3",
        "N2\n#102=0\nN3\n#102=#102+1\nIF[#102LT#101]GOTO3\n#103=#103+1\nIF[#103LT#101]GOTO2",
        "GOTO4\nN3\n#102=#102+1\nN4\nIF[#102LT#101]GOTO3",
        // No control rounds so far off.
        "#100=ROUND[#100*3.7]/7-0.5",
        "#100=ABS[0-#100]-5999",
    ] {
        assert!(is_shown(between), "{between}");
    }
}

#[test]
fn what_may_come_by_otherwise_is_not() {
    for between in [
        "N3\n#100=#100-1\nIF[#101GT5]GOTO3",
        "N2\n#102=0\nN3\n#102=#102+1\nIF[#102LT#101]GOTO3\n#100=#100-#102\nIF[#103LT#101]GOTO2",
        "IF[#101GT5]GOTO4\nN3\n#100=-1\nN4\nIF[#102LT#101]GOTO3",
        "#100=#100/7-857.142",
        "#100=#100/[#101*#101-1]",
        "GOTO#103\nN6#100=-1\nN7",
        "G65P2",
        "G65P2\nN3",
        "G66P2\nG0X1.\nG67",
        "M0",
        "M777",
        "G#103",
        "#3006=1(SET #100)",
        "#[#101]=1",
        "IF[#101GT5]THEN#100=-1",
        "IF[#101GT5]GOTO7\n#100=-1\nN7",
        "/GOTO7\n#100=-1\nN7",
        "/#100=-1",
        "WHILE[#101GT5]DO1\n#100=#100-1\nEND1",
        "#102=#100*#101\n#100=#102",
        "G4P3\nN3",
    ] {
        assert!(!is_shown(between), "{between}");
    }
}

/// The ways that conditions of a source never go, whatever its literals are.
fn never_of_source(text: &str) -> Vec<(String, i64)> {
    ways("fanuc", text, false)
}

#[test]
fn a_source_is_followed_without_its_literals() {
    let dead = |between: &str, way: i64, tail: &str| {
        let text = format!("O1\n{between}\nIF[#24EQ#0]GOTO5\nG0X2.\nN5M99\n{tail}");
        never_of_source(&text).iter().any(|(text, at)| text.contains("#24EQ#0") && *at == way)
    };
    for between in
        ["IF[#24NE#0]GOTO4\n#24=#5041\nN4\nG31X#24", "IF[#24EQ#0]THEN#24=5.\nG0X#24", "#24=5.\nG65P2\nG1X5."]
    {
        assert!(dead(between, 1, "O2\nM99\n"), "{between}");
        assert!(!dead(between, 0, "O2\nM99\n"), "{between}");
    }
    // What is called as a subprogram has the same locals; so has what comes back to a block of its caller.
    assert!(!dead("#24=5.\nM98P2", 1, "O2\n#24=#0\nM99\n"));
    assert!(!dead("IF[#24NE#0]GOTO4\nN4", 1, ""));
    assert!(!dead("IF[#24EQ5]GOTO4\n#25=1\nN4", 1, ""));
    // A literal at the head is edited: any number may stand there.
    let edited = "O1\n#100=6000\nG0X1.\nIF[#100GT2500]GOTO5\nG0X2.\nN5M30\n";
    assert!(never_of_source(edited).is_empty());
    // One after a branch, or in what others call, is as it is written.
    let switch = "O1\nIF[#1GT2]GOTO3\nG0X1.\nN3\n#31=0(1 IS ON)\nG05.1Q0\nG65P2\nG0X2.\nIF[#31EQ0]GOTO5\nG0X3.\nN5M30\n";
    assert_eq!(never_of_source(switch), [("[#31EQ0]".to_owned(), 0)]);
    let called = "O1\n#31=0\nG0X2.\nIF[#31EQ0]GOTO5\nG0X3.\nN5M99\nO2\nG65P1\nM30\n";
    assert_eq!(never_of_source(called), [("[#31EQ0]".to_owned(), 0)]);
    let alarm = "O1\nIF[#1GT2]GOTO3\n#3000=1(NO)\nIF[#1GT4]GOTO3\nN3M30\n";
    assert_eq!(never_of_source(alarm).len(), 2);
    // Nothing comes to what stands after a jump, unless a call comes back to it.
    let after = "O1\nG65P2\nGOTO5\nIF[#1GT2]GOTO5\nN3IF[#1GT3]GOTO5\nN5M30\nO2\n";
    assert_eq!(never_of_source(&format!("{after}M99\n")).len(), 4);
    assert_eq!(never_of_source(&format!("{after}M99P3\n")).len(), 2);
}

/// By parameter 6071 a tool change calls O9001, which may set the variable.
#[test]
fn a_code_that_calls_a_program_leaves_nothing_known() {
    let text = "O1\nIF[#1GT2]GOTO3\nG0X1.\nN3\n#102=0\nM6\nIF[#102EQ0]GOTO5\nG0X3.\nN5M30\n";
    let never = |profile: &str| ways_on(&Control::from_profile(profile).unwrap(), text, false);
    assert_eq!(never("dialect = \"fanuc\"\n"), [("[#102EQ0]".to_owned(), 0)]);
    assert_eq!(never("dialect = \"fanuc\"\n[parameters]\n6071 = 6\n"), []);
}

#[test]
fn what_nothing_comes_to_goes_no_way() {
    let found = never("fanuc", "O1\nGOTO5\nIF[#1GT2]GOTO5\nG0X1.\nN5M30\n");
    assert_eq!(found.iter().filter(|(text, _)| text.contains("#1GT2")).count(), 2, "{found:?}");
}

#[test]
fn numbered_lines_and_condition_registers_are_followed_too() {
    let fadal = "N1 O1\nN2 #V62=0.\nN3 G20\nN4 #IF V62 LE 0. THEN GOTO :L1\nN5 G0 X1.\nN6 #GOTO :L2\nN7 #:L1\nN8 G0 X2.\n\
                 N9 #:L2\nN10 #IF V62 LE 0. THEN GOTO :L3\nN11 G0 Y1.\nN12 #:L3\nN13 M2\n";
    assert_eq!(
        never("fadal", fadal).iter().filter(|(text, way)| text.contains("V62") && *way == 0).count(),
        2
    );
    let cc100 = "N1 V13=0\nN2 G80\nN3 TST V13\nN4 BLE P1\nN5 G0 X1\nV13=1\nG24 P3\nN6 $1\nG0 X3\n$3\nN7 TST V13\nN8 BGT P2\nN9 G0 X2\nN10 $2\nN11 M30\n";
    let found = never("cc100", cc100);
    assert!(found.iter().any(|(text, way)| text.contains("BLE P1") && *way == 0), "{found:?}");
    assert!(found.iter().any(|(text, way)| text.contains("BGT P2") && *way == 1), "{found:?}");
}
