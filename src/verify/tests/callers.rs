//! Called programs: what their callers show of them, and what they do not.

use super::programs;
use crate::control::LoadedFile;
use crate::dialect::{Control, Profile, registry};
use crate::syntax::parse_file;
use crate::verify::{
    Assumptions, Effort, Job, Outcome, ProgramCertificate, Side, Spent, SymbolMap, Why, verify,
};

/// O2 rests on the mode that its caller is in.
#[test]
fn what_callers_give_a_program_is_not_missed_from_it() {
    let library = |moves: &str| format!("O1\nG90G0X1.\nG91\nM98P2\nM30\nO2\n{moves}\nM99\n");
    let source = library("G0X5.");
    let outcomes = |moves: &str| {
        let found = programs(("fanuc", &source), ("fanuc", &library(moves)), &[]);
        let alone = found[1].reasons.iter().any(|reason| reason.why == Why::NotByItself);
        (found[0].outcome == Outcome::Different, found[1].outcome, alone)
    };
    assert_eq!(outcomes("G91G0X5."), (false, Outcome::Undecided, true));
    assert_eq!(outcomes("G91G0X6."), (true, Outcome::Different, false));
}

/// A library of programs in one file, changed in one place; the outcomes of its programs, and what excuses them.
#[track_caller]
fn library(source: &str, from: &str, to: &str) -> Vec<(Outcome, String)> {
    assert_eq!(source.matches(from).count(), 1, "{from} stands once");
    let found = programs(("fanuc", source), ("fanuc", &source.replace(from, to)), &[]);
    let excuse = |program: &ProgramCertificate| {
        let reasons = program.reasons.iter().filter(|reason| reason.why == Why::NotByItself);
        reasons.map(|reason| reason.text.clone()).collect::<String>()
    };
    found.iter().map(|program| (program.outcome, excuse(program))).collect()
}

/// O2 is called with 1 and with 4, from O1 and by way of O3.
const CALLED: &str = "\
O1
G90G0X1.
G65P2A1.B2.
G65P3
G0X2.
G91
M98P5
G90
M30
O3
#1=4
G65P2A#1B#101
M99
O2
G0X#1Y#2Z5.
IF[#1GT3]GOTO5
G1Z-1.F100.
N5G17G2X0Y0R50.
#503=#1
M99
O5
G0X5.
M99
";

#[test]
fn what_callers_can_show_is_different() {
    use Outcome::Different;
    // By an argument that one of the callers gives, a sign, a plane, a local, a value kept.
    for (from, to) in [
        ("X#1Y#2Z5.", "X#1Y-#2Z5."),
        ("#1GT3]", "#1GT4]"),
        ("N5G17", "N5G18"),
        ("#503=#1", "#503=#2"),
        ("G1Z-1.F100.", "G1Z-1.F110."),
        ("G1Z-1.", "G1Z-1.001"),
    ] {
        let found = library(CALLED, from, to);
        assert_eq!(found[2].0, Different, "{from} made {to}: {}", found[2].1);
    }
}

#[test]
fn what_no_caller_shows_is_excused_only_where_they_come_by() {
    use Outcome::{Different, Undecided};
    // The caller is in G91 already.
    let (outcome, excuse) = &library(CALLED, "O5\nG0X5.", "O5\nG91G0X5.")[3];
    assert_eq!(*outcome, Undecided, "{excuse}");
    assert!(excuse.contains("in distance.incremental, as its callers run it, it does the same"), "{excuse}");
    // The caller gives that number.
    let (outcome, excuse) = &library("O1\nG65P2A5.\nM30\nO2\nG0X#1\nM99\n", "X#1", "X5.")[1];
    assert_eq!(*outcome, Undecided, "{excuse}");
    assert!(excuse.contains("O0001") && excuse.contains("may still give it something else"), "{excuse}");
    // It is in G91, and the fault shows there only: G90 stays the same by itself.
    let found = library(CALLED, "O5\nG0X5.", "O5\nG90G0X5.");
    assert_eq!((found[0].0, found[3].0), (Different, Different));
    // No caller gives 9: but none came that way either, so nothing excuses it.
    let never = CALLED.replace("#503=#1\n", "#503=#1\nIF[#1NE9]GOTO6\nG0Z9.\nN6\n");
    assert_eq!(library(&never, "G0Z9.", "G0Z8.")[2].0, Different);
    // Nor where a way to it was not gone and no block of it shows: a value that is kept.
    let kept = CALLED.replace("#503=#1\n", "#503=#1\nIF[#1NE9]GOTO6\n#504=1\nN6\n");
    assert_eq!(library(&kept, "#504=1", "#504=2")[2].0, Different);
}

#[test]
fn callers_that_cannot_be_run_excuse_nothing() {
    use Outcome::{Different, Undecided};
    // Nothing calls it.
    let alone = "O1\nM30\nO5\nG0X5.\nM99\n";
    assert_eq!(library(alone, "O5\nG0", "O5\nG91G0")[1].0, Different);
    // Its one caller has no conversion.
    let lost = |callers: &str, wanted: Outcome| {
        let source = format!("{callers}O5\nG0X#1\nM99\n");
        let target = source.replace("O7\nG65P5A5.\nM30\n", "").replace("X#1", "X5.");
        let found = programs(("fanuc", &source), ("fanuc", &target), &[]);
        let called = found.iter().find(|program| program.program.as_deref() == Some("O0005")).unwrap();
        assert_eq!(called.outcome, wanted, "{:?}", called.reasons);
        assert_eq!(called.run_alone, wanted == Different, "{:?}", called.reasons);
        called.reasons.iter().map(|reason| reason.text.as_str()).collect::<String>()
    };
    lost("O7\nG65P5A5.\nM30\n", Different);
    // One of two is there, and the other is named.
    let text = lost("O7\nG65P5A5.\nM30\nO1\nG65P5A5.\nM30\n", Undecided);
    assert!(text.contains("O0007, which also calls it, could not be run"), "{text}");
    // A caller that goes on for ever on the target shows nothing.
    let source = "O1\nG65P5A5.\nM30\nO5\nG0X#1\nM99\n";
    let target = "O1\nG65P5A5.\nN1X1.\nX-1.\nGOTO1\nO5\nG0X5.\nM99\n";
    let found = programs(("fanuc", source), ("fanuc", target), &[]);
    assert_eq!(found[1].outcome, Different, "{:?}", found[1].reasons);
    // An alarm of the program's own counts as any end.
    let source = "O1\nG65P5A#101\nM30\nO5\nIF[#1GT3]GOTO9\nG0X#1\nM99\nN9#3000=1(TOO FAR)\n";
    assert_eq!(library(source, "TOO FAR", "TOO NEAR")[1].0, Different);
}

/// A called program is run as its callers come to it; the certificate says how.
#[test]
fn called_programs_begin_as_their_callers_let_them() {
    let given = |source: &str, at: usize| {
        let found = programs(("fanuc", source), ("fanuc", source), &[]);
        assert!(found.iter().all(|program| program.witness.is_none()), "{found:#?}");
        found[at].given.join(" ")
    };
    let one = "O1\nG20G91G18G1X1.F9.\nM98P2\nM30\nO2\nG1X5.\nM99\n";
    assert_eq!(given(one, 1), "units.inch motion.linear distance.incremental plane.zx feed.per.minute");
    // Two callers agree in the plane alone.
    let two = format!("{one}O3\nG21G90G18G95G1X1.F9.\nM98P2\nM30\n");
    assert_eq!(given(&two, 1), "motion.linear plane.zx");
    // By way of another program, which nothing but its caller puts into G91.
    let way = "O1\nG21G91\nM98P2\nM30\nO2\nM98P3\nM99\nO3\nG0X5.\nM99\n";
    assert_eq!(given(way, 2), "units.metric motion.rapid distance.incremental plane.xy feed.per.minute");
    // The first runs never get there.
    let rare = "O1\nG21G91\nIF[#101NE#102]GOTO9\nIF[#101LT6]GOTO9\nIF[#101GT49]GOTO9\nM98P2\nN9M30\nO2\nG0X5.\nM99\n";
    let found = given(rare, 1);
    assert!(found.is_empty() || found.contains("distance.incremental"), "{found}");
    // Nobody calls a main program.
    assert_eq!(given(one, 0), "");
}

/// A list of holes that is called under drilling cycles alone: without one, a count is a repeat of the move on the target.
#[test]
fn a_list_of_holes_is_run_in_a_cycle() {
    let library = |hole: &str, second: &str| {
        format!(
            "O1\nG21G90G54G0X0Y0\nG99G81Z-5.R2.F100.\nM98P2\nG80\nG0Z50.\n{second}M98P2\nG80\nM30\nO2\n{hole}\nG90\nM99\n"
        )
    };
    let drills = "G99G82Z-7.R2.P100F80.\n";
    let judged = |second: &str, wrong: &str| {
        let (source, target) = (library("G91X40.K5", second), library(&format!("G91X40.L5{wrong}"), second));
        programs(("fanuc", &source), ("haas", &target), &[]).remove(1)
    };
    let found = judged(drills, "");
    assert_eq!(found.outcome, Outcome::Undecided, "{found:#?}");
    let texts: Vec<&str> = found.reasons.iter().map(|reason| reason.text.as_str()).collect();
    assert!(texts.iter().any(|text| text.contains("with a drilling cycle in force")), "{texts:?}");
    // Called without a cycle too, or with another count, it is another program.
    assert_eq!(judged("", "").outcome, Outcome::Different);
    assert_eq!(judged(drills, "\nX1.").outcome, Outcome::Different);
}

/// O3 is come to in inches by way of O2, which by itself would be in the machine's millimetres.
#[test]
fn units_are_handed_on() {
    let library = |way: &str| {
        format!(
            "O1\nG20G90G0X1.\nIF[#101EQ7]GOTO9\nG65P2\nN9M30\nO2\nG65P3\nM99\nO3\nIF[#1EQ#0]GOTO9\nG0Y{way}\nN9M99\n"
        )
    };
    let found = programs(("haas", &library("13")), ("haas", &library("0.0013")), &[]);
    assert!(found.iter().all(|program| program.outcome != Outcome::Different), "{found:#?}");
    assert_eq!(found[2].given[0], "units.inch");
}

/// The caller stops before it comes to O2, which it calls in inches: there a count is 0.0001, in millimetres 0.001.
#[test]
fn programs_that_no_run_comes_to_are_in_the_unit_of_their_library() {
    let library = |words: &str| format!("O1\nG20G90G0X1.\n#3000=1(STOP)\nM98P2\nM30\nO2\nG0Y{words}\nM99\n");
    let tried = |source: &str, target: &str| programs(("haas", source), ("haas", target), &[]);
    let judged = |words: &str| tried(&library("13"), &library(words)).remove(1);
    let right = judged("0.0013");
    assert_eq!((right.outcome, right.never_come_to), (Outcome::Undecided, true), "{right:#?}");
    let excuse = |program: &ProgramCertificate| {
        program.reasons.iter().find(|reason| reason.why == Why::NotByItself).map(|reason| reason.text.clone())
    };
    let text = excuse(&right).unwrap();
    assert!(text.contains("in inches, in which the runs of its callers end"), "{text}");
    let wrong = judged("0.013");
    assert_eq!((wrong.outcome, wrong.run_alone), (Outcome::Different, true), "{wrong:#?}");
    let same = judged("13");
    assert_eq!((excuse(&same), same.witness), (None, None));
    // What it calls itself is in that unit as well.
    let way = |words: &str| library("1.\nM98P3") + &format!("O3\nG0Z{words}\nM99\n");
    assert_eq!(tried(&way("13"), &way("0.0013"))[2].outcome, Outcome::Undecided);
    assert_eq!(tried(&way("13"), &way("0.013"))[2].outcome, Outcome::Different);
}

/// What no run shows of the modes is a guess: a difference counts that shows in those of power-on too.
#[test]
fn modes_of_runs_that_do_not_come_to_a_program_decide_nothing() {
    let library = |words: &str| format!("O1\nG21G91\n#3000=1(STOP)\nG90\nM98P2\nM30\nO2\n{words}\nM99\n");
    let judged = |words: &str| {
        let found = programs(("haas", &library("G0X5.")), ("haas", &library(words)), &[]).remove(1);
        (found.outcome, found.reasons.iter().map(|reason| reason.text.clone()).collect::<String>())
    };
    let (outcome, text) = judged("G90G0X5.");
    assert_eq!(outcome, Outcome::Undecided);
    assert!(
        text.contains("as after power-on it does the same, in distance.incremental it does not"),
        "{text}"
    );
    assert_eq!(judged("G91G0X5.").0, Outcome::Undecided);
    assert_eq!(judged("G0X6.").0, Outcome::Different);
}

/// O2 is called in millimetres and in inches: it is run in both.
#[test]
fn programs_that_are_called_in_both_units_are_run_in_both() {
    let library = |words: &str| {
        format!(
            "O1\nG21G90G0X1.\nG65P2A1.\nM30\nO3\nG20G90G0X1.\nG65P2A1.\nM30\nO2\nIF[#1NE7]GOTO9\nG0Y{words}\nN9M99\n"
        )
    };
    for words in ["0.013", "0.0013"] {
        let found = programs(("haas", &library("13")), ("haas", &library(words)), &[]);
        assert_eq!(found[2].outcome, Outcome::Different, "{words}: {found:#?}");
    }
}

/// A control whose machine is set to a unit.
fn control(dialect: &str, units: &str) -> Control {
    let profile = Profile::read(&format!("dialect = \"{dialect}\"\nunits = \"{units}\"")).unwrap();
    Control::new(registry::find(dialect).unwrap(), profile).unwrap()
}

/// Which programs of two libraries differ, given by the names of their files and their texts.
fn judged(controls: &[Control; 2], texts: &[Vec<(&str, String)>; 2], names: SymbolMap) -> Vec<bool> {
    let parsed: [Vec<_>; 2] = std::array::from_fn(|at| {
        let parse = controls[at].entry().parse;
        texts[at].iter().map(|(name, text)| (*name, parse_file(text.as_bytes(), parse))).collect()
    });
    let files: [Vec<LoadedFile<'_>>; 2] = std::array::from_fn(|at| {
        parsed[at].iter().map(|(name, parsed)| LoadedFile { name, parsed }).collect()
    });
    let side = |at: usize| Side::new(&controls[at], controls[at].entry().execute.unwrap(), &files[at]);
    let (source, target) = (side(0), side(1));
    let (assumptions, effort) = (Assumptions::new(), Effort::default());
    let spent = &Spent::default();
    let job =
        Job { source: &source, target: &target, names: &names, assumptions: &assumptions, effort, spent };
    verify(&job, &[]).programs.iter().map(|program| program.outcome == Outcome::Different).collect()
}

/// A cycle stands in a file of its own, and is called by its code: it is in the unit of its caller, to which the target
/// is not set.
#[test]
fn a_cycle_is_called_by_its_code() {
    let controls = [control("cc100", "metric"), control("haas", "inch")];
    let tried = |head: &str, way: &str| {
        let source =
            vec![("a.nc", "G90\nG54\nG0 X1\nG820\nM30\n".into()), ("cycle20.nc", "G0\nZ-1.5\nM2\n".into())];
        let main = format!("O1000\n{head}G90G54\nG0X1.\nM98P8000\nM30\n");
        let target = vec![("a.nc", main), ("cycle20.nc", format!("O8000\nG0\nZ{way}\nM99\n"))];
        let programs = [("a.nc".to_owned(), 1000), ("cycle20.nc".to_owned(), 8000)].into();
        judged(&controls, &[source, target], SymbolMap { programs, ..SymbolMap::default() })
    };
    assert_eq!(tried("G21\n", "-1.5"), [false, false]);
    assert!(tried("", "-1.5")[0] && tried("G21\n", "-1.6")[1]);
}

/// O2 is called in both units after an alarm, and writes an offset: the unit that it is tried in is that of both sides.
#[test]
fn what_no_run_comes_to_is_in_one_unit_on_both_sides() {
    let controls = [("fanuc", "metric"), ("haas", "inch")].map(|(dialect, units)| control(dialect, units));
    let library = |value: &str| {
        format!("O1\nG20\nIF[#500GT9]GOTO5\nG21\nN5#3000=1(STOP)\nM98P2\nM30\nO2\nG90G10L11P3R{value}\nM99\n")
    };
    let judged = |value: &str| {
        let texts = [vec![("a.nc", library("0.05"))], vec![("a.nc", library(value))]];
        judged(&controls, &texts, SymbolMap::default())[1]
    };
    assert_eq!((judged("0.05"), judged("0.06")), (false, true));
}

/// No run comes to O2, and the runs of its caller end in G0: that it is called in G1, as the text has it, is not known.
#[test]
fn what_no_run_comes_to_is_begun_in_a_straight_cut_too() {
    use Outcome::{Different, Undecided};
    let source = "O1\nG90G1F100.\nGOTO5\nM98P2\nN5G0\nM30\nO2\nX1.\nM99\n";
    let (outcome, excuse) = &library(source, "\nX1.", "\nG1X1.")[1];
    assert_eq!(*outcome, Undecided);
    assert!(excuse.contains("in motion.linear it does the same, as after power-on it does not"), "{excuse}");
    assert_eq!(library(source, "\nX1.", "\nG1X2.")[1].0, Different);
}

/// O2 is called in G2 on the source, where a block without a centre moves straight on one control, and in G1 on the
/// target: each moves straight as it is called, and by itself in G2 the target stops.
#[test]
fn each_side_is_begun_as_its_own_callers_do() {
    use Outcome::{Different, Undecided};
    let source = "O1\nG90 G17 G0 X0 Y0\nG1 F300.\nG2 I5.\nX16. Y3.\nM98 P2\nM2\nO2\nZ1.\nM99\n";
    let judged = |depth: &str| {
        let target = format!("O1\nG90G17G0X0Y0\nG1F300.\nG2I5.\nG1X16.Y3.\nM98P2\nM2\nO2\nZ{depth}\nM99\n");
        let found = programs(("fadal", source), ("fanuc", &target), &[]);
        let reasons = found[1].reasons.iter().filter(|reason| reason.why == Why::NotByItself);
        (found[1].outcome, reasons.map(|reason| reason.text.clone()).collect::<String>())
    };
    let (outcome, why) = judged("1.");
    assert_eq!(outcome, Undecided, "{why}");
    assert!(why.contains("in motion.arc.cw on the source and in motion.linear on the target"), "{why}");
    assert_eq!(judged("2.").0, Different);
}

/// The callers of a program have cancelled all zero shifts, and the target, which cannot, moves in machine coordinates.
#[test]
fn a_called_program_finds_no_offset_if_its_callers_have_none() {
    let found = |zero: &str, there: &str| {
        let source = format!(
            "O1\nG0G90G17G40G49G80{zero}\nG20\nX0Y0\nM98P2\nM98P3\nM2\nO2\nG0Z+R7\nM99\nO3\nG0Z1.\nM99\n"
        );
        let target = format!(
            "O1\nIF[#550EQ#0]THEN#550=0\nG20\nG0G90G17G40G49G80G54\n{there}X0.Y0.\nM98P2\nM98P3\nM2\nO2\nG0{there}Z#550\nM99\nO3\nG0{there}Z1.\nM99\n"
        );
        let all = programs(("fadal", &source), ("fanuc", &target), &[("R7", 550)]);
        all.into_iter().map(|program| program.outcome == Outcome::Different).collect::<Vec<_>>()
    };
    assert_eq!(found("E0", "G53"), [false; 3]);
    assert_eq!(found("E1", ""), [false; 3]);
    assert_eq!(found("E0", ""), [true; 3]);
    assert_eq!(found("E1", "G53"), [true; 3]);
}
