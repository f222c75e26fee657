//! Pairs of programs written by hand: what differs in one place only must be told apart, and how.

mod alarms;
mod arguments;
mod as_called;
mod assumed;
mod callers;
mod codes;
mod cycle_settings;
mod edited;
mod ends;
mod links;
mod names;
mod nesting;
mod outside;
mod pairs;
mod random;
mod running;
mod said;
mod settled;
mod skips;
mod started;
mod steered;
mod stops;
mod waiting;

use super::{Assumptions, Effort, Job, Outcome, ProgramCertificate, Side, Spent, SymbolMap, Why, verify};
use crate::assume::Assumption;
use crate::control::LoadedFile;
use crate::dialect::{Control, registry};
use crate::syntax::parse_file;
use pairs::between;

/// Verifies a pair of single programs, registers by their own names or by `variables`.
fn run(from: &str, source: &str, to: &str, target: &str, variables: &[(&str, u32)]) -> ProgramCertificate {
    let mut all = programs((from, source), (to, target), variables);
    assert_eq!(all.len(), 1, "one program");
    all.remove(0)
}

/// Verifies a pair of files.
fn programs(
    (from, source): (&str, &str),
    (to, target): (&str, &str),
    variables: &[(&str, u32)],
) -> Vec<ProgramCertificate> {
    let variables = variables.iter().map(|(name, number)| ((*name).to_owned(), *number)).collect();
    named((from, source), (to, target), SymbolMap { variables, ..SymbolMap::default() })
}

/// Verifies a pair of files, with what a conversion tells of its names.
fn named(source: (&str, &str), target: (&str, &str), names: SymbolMap) -> Vec<ProgramCertificate> {
    supposing(source, target, names, &[])
}

/// The same, with what a conversion supposes of the programs, by their places in the file.
fn supposing(
    (from, source): (&str, &str),
    (to, target): (&str, &str),
    names: SymbolMap,
    supposed: &[(usize, Assumption)],
) -> Vec<ProgramCertificate> {
    let controls = [from, to].map(|name| Control::plain(name).unwrap());
    between(&controls, [source, target], &names, supposed)
}

/// What is found of two sides, with the usual effort.
fn verified(
    [source, target]: [&Side<'_>; 2],
    names: &SymbolMap,
    assumptions: &Assumptions,
) -> Vec<ProgramCertificate> {
    let (effort, spent) = (Effort::default(), Spent::default());
    verify(&Job { source, target, names, assumptions, effort, spent: &spent }, &[]).programs
}

/// Within one dialect.
fn within(dialect: &str, source: &str, target: &str) -> ProgramCertificate {
    run(dialect, source, dialect, target, &[])
}

#[track_caller]
fn differs(dialect: &str, source: &str, target: &str, what: &str) {
    let unchanged = within(dialect, source, source);
    assert_ne!(unchanged.outcome, Outcome::Different, "{:?}", unchanged.witness);
    let found = within(dialect, source, target);
    assert_eq!(found.outcome, Outcome::Different, "{source}\nagainst\n{target}\n{found:#?}");
    let witness = found.witness.unwrap();
    assert!(witness.what.contains(what), "{}", witness.what);
}

/// A macro that drills a row of holes, with most of what macros do.
const ROW: &str = "\
O9100
IF[#24EQ#0]GOTO90
IF[#11LE0]GOTO90
#1=#24
#2=0
G90G98G81Z-5.R2.F100.L0
WHILE[#2LT#11]DO1
#3=ROUND[#1*10.]/10.
G90X#3Y#25
#1=#1+#9
#2=#2+1
END1
G80
IF[#7EQ#0]GOTO80
G4P1500
N80G0Z50.
#500=#2
M99
N90#3000=1(ARGUMENT)
";

/// [`ROW`] with one place written otherwise.
#[track_caller]
fn row_differs(from: &str, to: &str, what: &str) {
    assert_eq!(ROW.matches(from).count(), 1, "{from} stands once");
    differs("fanuc", ROW, &ROW.replace(from, to), what);
}

#[test]
fn what_is_unchanged_is_the_same() {
    for dialect in ["fanuc", "haas"] {
        let found = within(dialect, ROW, ROW);
        let undecided: Vec<Why> = found.reasons.iter().map(|reason| reason.why).collect();
        assert!(undecided.iter().all(|why| *why == Why::Unconfirmed), "{found:#?}");
        assert_eq!(found.branches_covered, found.branches_total, "{:#?}", found.not_reached);
        // Four conditions, each with two ways.
        assert_eq!(found.branches_total, 8);
        assert_eq!(found.largest_difference_mm, 0.0);
        assert!(found.scenarios_compared >= 8);
    }
    let plain = "O1\nG90G17G54\nS800M3\nG0X1.Y1.\nIF[#101GT5.]GOTO1\nG1X5.F100.\nN1M5\nM30\n";
    let found = within("fanuc", plain, plain);
    assert_eq!(found.outcome, Outcome::Same, "{found:#?}");
}

#[test]
fn one_sign() {
    row_differs("Z-5.", "Z5.", "");
    row_differs("#1=#1+#9", "#1=#1-#9", "elsewhere");
}

#[test]
fn one_rounding() {
    row_differs("ROUND[#1*10.]", "FIX[#1*10.]", "elsewhere");
    row_differs("ROUND[#1*10.]", "FUP[#1*10.]", "elsewhere");
}

#[test]
fn one_comparison() {
    row_differs("#2LT#11", "#2LE#11", "");
    row_differs("#11LE0", "#11LT0", "");
    row_differs("#7EQ#0", "#7NE#0", "");
}

#[test]
fn one_vacancy() {
    row_differs("#24EQ#0", "#24EQ0", "");
    row_differs("#7EQ#0", "#7EQ0", "");
}

#[test]
fn one_plane() {
    row_differs("G98", "G99", "");
    // The R plane from where the tool is, not from the zero of the work.
    row_differs("G90G98G81Z-5.R2.", "G91G98G81Z-5.R2.", "");
    let arc = "O1\nG90G17G0X0Y0Z0\nG2X10.Z#101I5.F100.\nM30\n";
    differs("fanuc", arc, &arc.replace("G17", "G18").replace("I5.", "I5.K0"), "");
    differs("fanuc", arc, &arc.replace("G2X", "G3X"), "the other way");
}

#[test]
fn one_end() {
    row_differs("M99", "M30", "returns");
    differs("fanuc", "O1\nG0X1.\nM30\n", "O1\nG0X1.\nM99\n", "returns");
}

#[test]
fn one_dwell() {
    row_differs("P1500", "P1.5", "");
    row_differs("P1500", "X1500.", "wait");
}

#[test]
fn one_offset() {
    let program = "O1\nG90G54G0X1.\nG43H2Z5.\nG1G41D3X10.F100.\nG40\nG49\nM30\n";
    for (from, to) in [("H2", "H3"), ("D3", "D4"), ("G54", "G55"), ("G41", "G42")] {
        differs("fanuc", program, &program.replace(from, to), "");
    }
}

#[test]
fn one_final_value() {
    row_differs("#500=#2", "#500=#2+0.5", "#500");
    row_differs("#500=#2", "#501=#2", "#50");
}

#[test]
fn machine_functions() {
    let program = "O1\nS500M3\nM8\nG90G0X1.\nG1X2.F100.\nT2M6\nM9\nM5\nM1\nM0\nM30\n";
    let others = [
        ("S500", "S600"),
        ("M3", "M4"),
        ("M8", "M7"),
        ("F100.", "F200."),
        ("T2", "T3"),
        ("M0\n", ""),
        ("G0X", "G1X"),
        ("X2.", "Y2."),
        ("M9\n", ""),
    ];
    for (from, to) in others {
        differs("fanuc", program, &program.replace(from, to), "");
    }
}

#[test]
fn an_endless_loop_is_undecided_after_few_runs() {
    let program = "O1\nN1G91G1X1.F100.\nX-1.\nGOTO1\nM30\n";
    let found = within("fanuc", program, program);
    assert_eq!(found.outcome, Outcome::Undecided);
    assert!(found.reasons.iter().any(|reason| reason.why == Why::Endless), "{found:#?}");
    assert!(found.scenarios_tried <= 4, "{}", found.scenarios_tried);
    // What differs before that is a difference all the same.
    differs("fanuc", program, &program.replace("X-1.", "X-2."), "elsewhere");
}

#[test]
fn what_was_not_seen_is_said() {
    // No start value makes a square negative.
    let program = "O1\nIF[#101*#101LT-1]GOTO5\nG0X1.\nN5M30\n";
    let found = within("fanuc", program, program);
    assert_eq!(found.outcome, Outcome::Undecided);
    assert_eq!((found.branches_covered, found.branches_total), (1, 2));
    assert_eq!((found.not_reached[0].line, found.not_reached[0].way), (2, "true"));
    let calls = "O1\nG0X1.\nG65P9999\nM30\n";
    let found = within("fanuc", calls, calls);
    assert_eq!(found.outcome, Outcome::Undecided);
    assert!(found.reasons.iter().any(|reason| reason.why == Why::CannotRun), "{found:#?}");
}

#[test]
fn what_hangs_on_the_last_digit_is_marked() {
    // In binary ten times 0.1 is a little less than 1, so the loop runs once more or not.
    let program = "O1\n#1=0\nWHILE[#1LT1.]DO1\n#1=#1+0.1\nG91G1X1.F100.\nEND1\nM30\n";
    assert_eq!(within("fanuc", program, program).rounding_sensitive, Some(true));
    assert_eq!(within("fanuc", ROW, ROW).rounding_sensitive, Some(false));
}

/// 7.3 squared less 7.3 squared: 4.1e-13 in doubles and 0 in decimals, so that neither is an alarm; errors of other signs
/// are less than 0. The arc ends 2 mm off its circle, so that nothing counts where it goes.
#[test]
fn other_errors_than_those_of_doubles_decide_too() {
    let program = |a: &str, x: &str| {
        format!("O1\n#1={a}-122.9\n#2=130.2-122.9\n#3=SQRT[#1*#1-#2*#2]\nG90G17G0X{x}\nM30\n")
    };
    let sensitive = |source: &str, target: &str| within("fanuc", source, target).rounding_sensitive;
    let root = program("115.6", "#3");
    assert_eq!(sensitive(&root, &root), Some(true));
    let clear = program("110.5", "#3");
    assert_eq!(sensitive(&clear, &clear), Some(false));
    let arc = |x: &str| root.replace("X#3", &format!("X0Y0\nG2X5.I{x}J0F100."));
    let found = within("fanuc", &arc("1.5"), &arc("1.4"));
    assert_eq!((found.outcome, found.rounding_sensitive), (Outcome::Undecided, Some(true)), "{found:#?}");
}

#[test]
fn certificates_are_the_same_each_time() {
    let again = || serde_json::to_string(&within("fanuc", ROW, ROW)).unwrap();
    assert_eq!(again(), again());
}

#[test]
fn fadal_programs() {
    let program = "%\nO1\nG90 G80 G40 G17\nS1000 M3\nG0 X1. Y1.\n#V1=3\n#IF V2 GT 2 THEN GOTO :A\n\
        #V1=V1+1\n#:A\n#R1=V1\nG1 X+R1 F10.\nM5\nM30\n%\n";
    differs("fadal", program, &program.replace("G1 X+R1", "G1 X-R1"), "elsewhere");
    differs("fadal", program, &program.replace("GT 2", "GE 2"), "elsewhere");
}

#[test]
fn a_stop_may_show_more_and_not_less() {
    let program = "O1\nG0X1.\nM0\nG0X2.\nM30\n";
    let found = within("fanuc", program, &program.replace("M0\n", "M0(TURN)\n"));
    assert_eq!(found.witness, None);
    assert_eq!(found.texts, [(String::new(), "TURN".to_owned())]);
    differs("fanuc", &program.replace("M0\n", "M0(TURN)\n"), program, "different things");
    differs("fanuc", &program.replace("M0\n", "M0(TURN)\n"), &program.replace("M0\n", "M0(HOLD)\n"), "text");
    differs("fanuc", program, &program.replace("M0\n", "(TURN)\n"), "");
}

#[test]
fn a_return_without_a_work_offset_is_the_callers_matter() {
    let across = |source: &str, target: &str| run("cc100", source, "fanuc", target, &[]);
    let found = across("G53\nM2\n", "O1\nM99\n");
    assert_eq!(found.outcome, Outcome::Undecided, "{found:#?}");
    assert!(found.reasons.iter().any(|reason| reason.text.contains("cancelled")), "{found:#?}");
    // Any other work offset that the caller would get is a difference, and so are the moves here.
    for (source, target) in [
        ("G55\nM2\n", "O1\nM99\n"),
        ("G54\nM2\n", "O1\nG55\nM99\n"),
        ("G90\nG53\nG0 X1\nM2\n", "O1\nG90G0X1.\nM99\n"),
        ("G90\nG53\nG0 X1\nM2\n", "O1\nM99\n"),
    ] {
        assert_eq!(across(source, target).outcome, Outcome::Different, "{source}{target}");
    }
    // On a control that can do without one it is to do without.
    differs("cc100", "G53\nM2\n", "G90\nM2\n", "different things");
}

/// One third is 0.333 in a word: twelve of them lie 0.004 apart, each of them 0.0003.
#[test]
fn what_incremental_moves_round_adds_up() {
    let with = |last: &str| {
        let source = format!("#R1=1/3\nG90 G0 X0\nG91\n{}G10 L2 P5 Z+R1\nM2\n", "X+R1\n".repeat(13));
        let target =
            format!("#501=1/3\nG90G0X0.\nG91\n{}X[#501{last}]\nG10L2P5Z#501\nM2\n", "X#501\n".repeat(12));
        run("fadal", &source, "fanuc", &target, &[("R1", 501)])
    };
    let found = with("");
    // Whether it was roundings that added up, a person must say.
    assert_eq!(found.outcome, Outcome::Undecided, "{:#?}", found.witness);
    assert!(found.largest_difference_mm > 0.004, "{}", found.largest_difference_mm);
    assert_eq!(with("-0.01").outcome, Outcome::Different);
    // A scale that is off by a hair adds up as well, and is never the same.
    let moves = |step: f64| (1..40).map(|n| format!("X{:.4}\n", f64::from(n) * step)).collect::<String>();
    let program = |step: f64| format!("G90 G0 X0\n{}M2\n", moves(step));
    let scaled = run("fadal", &program(1.0), "fanuc", &program(1.0001), &[]);
    assert_ne!(scaled.outcome, Outcome::Same);
}

#[test]
fn a_machine_is_set_to_the_unit_that_a_program_checks() {
    for code in ["G20", "G21"] {
        let source = format!("O1\nN1 {code} G90 G80 G40 E1\nN2 G0 X1.25 Y0\nN3 M2\n");
        let judge = |x: &str| {
            let target = format!("O1\nN1 {code} G90 G80 G40 G54\nN2 G0 X{x} Y0.\nN3 M30\n");
            run("fadal", &source, "fanuc", &target, &[])
        };
        assert_eq!(judge("1.26").outcome, Outcome::Different, "{code}");
        let same = judge("1.25");
        assert!(same.reasons.iter().all(|reason| !reason.text.contains("set to")), "{same:#?}");
    }
}

#[test]
fn ways_that_constants_exclude_are_not_missed() {
    let ways = |program: &str| {
        let found = within("fanuc", program, program);
        (found.branches_covered, found.branches_total, found.not_reached.len())
    };
    assert_eq!(ways("O1\n#100=6000\nIF[#100GT2500]GOTO5\nG0X1.\nN5M30\n"), (1, 1, 0));
    assert_eq!(ways("O1\n#100=#0\nIF[#100EQ#0]GOTO5\nG0X1.\nN5M30\n"), (1, 1, 0));
    assert_eq!(ways("O1\n#100=#0\nIF[#100GT1]GOTO5\nG0X1.\nN5M30\n"), (1, 1, 0));
    let alarm = "IF[#100GT1]THEN#3000=1(HIGH)\n";
    assert_eq!(ways(&format!("O1\n#100=#0\n{alarm}IF[#100EQ#0]GOTO5(NONE)\nG0X1.\nN5M30\n")), (2, 2, 0));
    assert_eq!(ways("O1\n#100=FIX[#101]\nIF[#100EQ#0]GOTO5\nG0X1.\nN5M30\n"), (1, 1, 0));
    // What a condition writes may be either: 1 and 6000 go one way, -1 the other.
    for (value, all) in [("1", (3, 3, 0)), ("-1", (4, 4, 0))] {
        let set = format!("#100=6000\nIF[#101GT5]THEN#100={value}\n");
        assert_eq!(ways(&format!("O1\n{set}IF[#100GE0]GOTO5\nG0X2.\nN5M30\n")), all);
    }
    // What is not shown: a jump comes in between, a call, a subscript that is computed, a loop.
    for between in ["N3", "G65P2", "#[#101]=1", "WHILE[#101GT5]DO1\nEND1", "G0X1."] {
        let program = format!("O1\n#100=6000\n{between}\nIF[#100GE0]GOTO5\nG0X2.\nN5M30\nO2\nM99\n");
        let parsed = programs(("fanuc", &program), ("fanuc", &program), &[]);
        let missed = parsed[0].not_reached.iter().filter(|way| way.text.contains("GE0")).count();
        // Nor with the constant edited, where that is at the head.
        let shown = missed > 0 || !parsed[0].edits.is_empty() || between.contains("#101]=1");
        assert!(shown, "{between}: {:#?}", parsed[0].not_reached);
    }
}

/// Without a conversion's report every fact that mattered is a reason, with what it asks and where.
#[test]
fn facts_are_reasons_that_say_where() {
    let program = "O1\nG0X1.\n#100=500\nG4P#100\nM30\n";
    let found = within("haas", program, program);
    let texts: Vec<&str> = found.reasons.iter().map(|reason| reason.text.as_str()).collect();
    assert!(
        texts.iter().any(|text| {
            text.starts_with("no manual confirms 'behaviour:dwell.expression' (")
                && text.ends_with("the source depends on it in line 4 of cycle1.nc, 'G4P#100'")
        }),
        "{texts:#?}"
    );
    // Both machines are asked.
    assert_eq!(texts.len(), 2 * found.unconfirmed.len());
}
