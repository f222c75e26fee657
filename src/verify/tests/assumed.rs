//! What a conversion supposes, tried on the runs of both sides: what it excuses, and what not.

use super::{SymbolMap, between, supposing};
use crate::assume::{Assumption, Domain, Numbers, Predicate, Subscripts};
use crate::canon::{Func, Op};
use crate::dialect::Control;
use crate::text::Span;
use crate::verify::{Outcome, ProgramCertificate, Why};

/// An assumption about the first program of a file.
pub fn assumption(predicate: Predicate) -> (usize, Assumption) {
    (0, Assumption { place: Span::default(), text: "so it is".into(), predicate })
}

/// Where a block stands that stands once.
pub fn place(source: &str, block: &str) -> Vec<Span> {
    assert_eq!(source.matches(block).count(), 1, "{block} in {source}");
    let at = source.find(block).unwrap();
    vec![Span::new(at as u32, (at + block.len()) as u32)]
}

/// That the numbers which a block computes are these.
fn numbers(source: &str, block: &str, safe: &[(u32, u32)]) -> (usize, Assumption) {
    let (places, safe) = (place(source, block), Numbers::new(safe.iter().copied()));
    assumption(Predicate::Subscripts(Subscripts { places, safe, bases: vec![0.0] }))
}

/// What becomes of the programs of a file.
fn all(
    source: &str,
    target: &str,
    names: &[(&str, u32)],
    supposed: &[(usize, Assumption)],
) -> Vec<ProgramCertificate> {
    let variables = names.iter().map(|(name, number)| ((*name).to_owned(), *number)).collect();
    supposing(("fanuc", source), ("haas", target), SymbolMap { variables, ..SymbolMap::default() }, supposed)
}

fn one(source: &str, target: &str, supposed: &[(usize, Assumption)]) -> ProgramCertificate {
    all(source, target, &[], supposed).remove(0)
}

fn has(found: &ProgramCertificate, why: Why) -> bool {
    found.reasons.iter().any(|reason| reason.why == why)
}

/// A variable by its number, and a move by it.
const INDEXED: &str = "O1\nG21G90\nG0X5.\n#1=#[#500]\nG0Y[FIX[#1]]\nM30\n";

#[test]
fn an_assumption_that_holds_is_counted_and_is_no_reason() {
    let found = one(INDEXED, INDEXED, &[numbers(INDEXED, "#1=#[#500]", &[(1, 33), (100, 199), (500, 999)])]);
    let [assumed] = &found.assumptions[..] else { panic!("{found:#?}") };
    assert_eq!((assumed.kind, &*assumed.text, assumed.line), ("subscripts", "so it is", 1));
    assert!(assumed.kept.unwrap() > 0, "{assumed:?}");
    assert!(!has(&found, Why::NoRunKept));
}

#[test]
fn what_no_run_keeps_is_undecided() {
    // No run computes one of these numbers.
    let source = INDEXED.replace("#[#500]", "#[500]");
    let source = source.replace("#1=#[500]", "#2=500\n#1=#[#2]");
    let found = one(&source, &source, &[numbers(&source, "#1=#[#2]", &[(900, 901)])]);
    assert_eq!(found.assumptions[0].kept, Some(0));
    assert!(found.assumptions[0].broken.unwrap() > 0);
    assert!(has(&found, Why::NoRunKept) && found.outcome == Outcome::Undecided, "{:?}", found.reasons);
    // A place that no run comes to.
    let source = "O1\nG21G90\nG0X5.\nM30\n#1=#[#500]\nM30\n";
    let found = one(source, source, &[numbers(source, "#1=#[#500]", &[(500, 501)])]);
    assert_eq!((found.assumptions[0].kept, found.assumptions[0].broken), (Some(0), Some(0)));
    assert!(has(&found, Why::NoRunKept), "{:?}", found.reasons);
}

/// After six questions, two numbers of one block: each is held against its own numbers alone, and the search finds an
/// argument that makes both.
#[test]
fn two_numbers_of_one_block_are_searched_for_together() {
    let block = "#31=#[130+#7]+#[500+#8]";
    let asks: String = [24, 25, 18, 9, 2, 19]
        .map(|number| format!("IF[#{number}EQ#0]GOTO8\nIF[#{number}LT10]GOTO8\n"))
        .concat();
    let source =
        format!("O1\nG21G90\n{asks}{block}\nG0X[FIX[#31]]\nGOTO9\nN8\n#3000=1(ARGUMENTS)\nN9\nM99\n");
    let both = |first: (u32, u32), second: (u32, u32)| {
        let supposed = [numbers(&source, block, &[first]), numbers(&source, block, &[second])];
        let found = one(&source, &source, &supposed);
        let kept: Vec<bool> = found.assumptions.iter().map(|one| one.kept.unwrap() > 0).collect();
        (kept, has(&found, Why::NoRunKept))
    };
    assert_eq!(both((131, 149), (501, 530)), (vec![true, true], false));
    // No argument makes a number of both.
    assert!(!both((2_000_001, 2_000_002), (501, 530)).0[0]);
}

/// A control without mist: flood coolant instead is no reason to be undecided, if the conversion told of it.
#[test]
fn a_substitute_that_was_told_is_no_reason() {
    let source = "O1\nG21G90\nM7\nG0X5.\nM9\nM30\n";
    let flood = source.replace("M7", "M8");
    let substituted = |supposed: &[Op]| {
        let supposed: Vec<_> = supposed.iter().map(|op| assumption(Predicate::Substitute(*op))).collect();
        has(&one(source, &flood, &supposed), Why::Substituted)
    };
    assert!(substituted(&[]) && substituted(&[Op::ExactStop]));
    assert!(!substituted(&[Op::Mist]));
    let dry = one(source, &source.replace("M7\n", ""), &[assumption(Predicate::Substitute(Op::Mist))]);
    assert_eq!(dry.outcome, Outcome::Different);
}

/// A wait at the bottom of a bore, beside whose code the target takes none: left out there, and nowhere else.
#[test]
fn a_wait_of_a_bore_that_was_told_is_no_reason() {
    let bore = "O1\nG21G90G17G94G54\nS500M3\nG0X0.Y0.Z50.\nG98G87X30.Z5.R-20.Q.3P300F50.\nG80\nM30\n";
    let there = bore.replace("G87", "G77").replace("P300", "");
    let told = [assumption(Predicate::Substitute(Op::CycleBackBore))];
    let found = one(bore, &there, &told);
    assert!(found.outcome != Outcome::Different && !has(&found, Why::Substituted), "{found:#?}");
    assert!(has(&one(bore, &there, &[]), Why::Substituted));
    // What else differs in the bore is seen, and so is the wait of another hole.
    assert_eq!(one(bore, &there.replace("Z5.", "Z6."), &told).outcome, Outcome::Different);
    let hole = bore.replace("G87", "G82").replace("Q.3", "");
    assert_eq!(one(&hole, &hole.replace("P300", ""), &told).outcome, Outcome::Different);
    let wait = bore.replace("G80", "G80\nG4P300");
    assert_eq!(one(&wait, &there, &told).outcome, Outcome::Different);
}

#[test]
fn what_is_not_seen_in_runs_is_listed_and_decides_nothing() {
    let source = "O1\nG21G90\nG0X5.\nM30\n";
    let found = one(source, source, &[assumption(Predicate::Unseen)]);
    assert_eq!((found.assumptions[0].kind, found.assumptions[0].kept), ("unseen", None));
    assert!(!has(&found, Why::NoRunKept));
    // Nor does it excuse anything.
    let found = one(source, &source.replace("X5.", "X6."), &[assumption(Predicate::Unseen)]);
    assert_eq!(found.outcome, Outcome::Different);
}

#[test]
fn a_break_excuses_what_comes_after_it_and_nothing_before() {
    // Every run breaks it: the register is none of these.
    let source = "O1\nG21G90\nG0X5.\n#1=7\n#2=#[#1+493]\nG0X8.\nM30\n";
    let supposed = [numbers(source, "#2=#[#1+493]", &[(100, 199)])];
    let found = |from: &str, to: &str| one(source, &source.replace(from, to), &supposed);
    let behind = found("X8.", "X9.");
    assert_eq!(behind.outcome, Outcome::Undecided);
    assert!(has(&behind, Why::Condition) && behind.scenarios_compared == 0, "{behind:#?}");
    assert!(has(&behind, Why::NothingCompared));
    assert_eq!(found("X5.", "X6.").outcome, Outcome::Different, "before: {:#?}", found("X5.", "X6."));
    assert_eq!(found("G0X5.", "G0X6.\nG0X5.").outcome, Outcome::Different, "before the break");
    assert_eq!(found("#1=7", "#1=7\nG0X6.").outcome, Outcome::Different, "before the target comes to it");
    assert_eq!(found("G0X8.", "G0X6.\nG0X8.").outcome, Outcome::Undecided);
}

#[test]
fn only_what_the_source_breaks_excuses() {
    // The target alone computes another register, and moves by it.
    let source = "O1\nG21G90\n#510=3\n#511=4\n#1=510\nG0X[#[#1]]\nM30\n";
    let target = source.replace("#1=510", "#1=511");
    let supposed = [numbers(source, "G0X[#[#1]]", &[(510, 510)])];
    let found = one(source, source, &supposed);
    assert_ne!(found.outcome, Outcome::Different, "{:?}", found.witness);
    assert_eq!(one(source, &target, &supposed).outcome, Outcome::Different);
    // A code of which only the target says another.
    let source = "O1\nG21G90\n#1=1\nG#1X5.F100.\nM30\n";
    let places = place(source, "G#1X5.F100.");
    let codes = [assumption(Predicate::Codes { letter: 'G', places, same: vec![1.0] })];
    let found = one(source, &source.replace("#1=1", "#1=0"), &codes);
    assert_eq!((found.outcome, found.assumptions[0].broken), (Outcome::Different, Some(1)));
}

#[test]
fn a_break_in_a_callee_counts_for_the_callers_run() {
    let source = "O1\nG21G90\n#500=150\nG65P2\nG0X5.\nM30\nO2\n#501=#[#500+0]\nM99\n";
    let target = source.replace("X5.", "X6.");
    let (_, subscripts) = numbers(source, "#501=#[#500+0]", &[(510, 599)]);
    let found = all(source, &target, &[], &[(1, subscripts.clone())]);
    assert!(has(&found[0], Why::Condition), "{:?}", found[0]);
    assert!(found[0].assumptions.is_empty() && found[1].assumptions.len() == 1, "each lists its own");
    // The same of a program that did not run says nothing.
    let source = source.replace("G65P2", "");
    let (_, elsewhere) = numbers(&source, "#501=#[#500+0]", &[(510, 599)]);
    let found = all(&source, &source.replace("X5.", "X6."), &[], &[(1, elsewhere)]);
    assert_eq!(found[0].outcome, Outcome::Different);
}

#[test]
fn an_assumption_is_about_its_program_and_its_block() {
    // Another block computes a register outside, and nothing is said of it.
    let source = "O1\nG21G90\n#1=510\n#2=#[#1]\n#3=150\n#4=#[#3+0]\nG0X5.\nM30\n";
    let target = source.replace("X5.", "X6.");
    let supposed = [numbers(source, "#2=#[#1]", &[(510, 510)])];
    assert_eq!(one(source, &target, &supposed).outcome, Outcome::Different);
    let supposed = [numbers(source, "#4=#[#3+0]", &[(510, 510)])];
    assert!(has(&one(source, &target, &supposed), Why::Condition));
    // The same text in another program of the file.
    let source = "O1\nG21G90\n#3=150\n#4=#[#3+0]\nG0X5.\nM30\nO2\n#4=#[#3+1]\nM30\n";
    let (_, other) = numbers(source, "#4=#[#3+1]", &[(510, 510)]);
    let found = all(source, &source.replace("X5.", "X6."), &[], &[(1, other)]);
    assert_eq!(found[0].outcome, Outcome::Different);
}

/// `#700`, which the target keeps in `#100`, and any variable whose number is computed.
const WIDE: &str = "O1\nG21G90\n#700=2\n#[FIX[#500]]=3\nG0X#700\nM30\n";

#[test]
fn an_assumption_that_is_too_wide_is_a_difference() {
    let target = WIDE.replace("#700", "#100");
    let found = |names: &[(&str, u32)], safe: &[(u32, u32)]| {
        all(WIDE, &target, names, &[numbers(WIDE, "#[FIX[#500]]=3", safe)]).remove(0)
    };
    let wide = found(&[("#700", 100)], &[(100, 199)]);
    assert_eq!(wide.outcome, Outcome::Different, "{wide:#?}");
    // Without that register it is right.
    let right = found(&[("#700", 100)], &[(101, 199)]);
    assert_ne!(right.outcome, Outcome::Different, "{:#?}", right.witness);
    assert!(right.assumptions[0].kept.unwrap() > 0);
    // By a part that is added.
    let source = WIDE.replace("FIX[#500]", "FIX[#500]+90");
    let (places, safe) = (place(&source, "#[FIX[#500]+90]=3"), Numbers::new([(91, 199)]));
    let subscripts = Predicate::Subscripts(Subscripts { places, safe, bases: vec![90.0] });
    let found = all(&source, &source.replace("#700", "#100"), &[("#700", 100)], &[assumption(subscripts)]);
    assert_eq!(found[0].outcome, Outcome::Different);
}

#[test]
fn a_domain_that_is_too_wide_is_a_difference() {
    // The emulation of BCD is right for two digits alone.
    let source = "O1\nG21G90\n#2=FIX[ABS[#500]]\nG0X[BCD[#2]]\nM30\n";
    let target = source.replace("BCD[#2]", "#2+FIX[#2/10]*6");
    let found = |digits: u32| {
        let (places, domain) = (place(source, "G0X[BCD[#2]]"), Domain::Digits(digits));
        one(source, &target, &[assumption(Predicate::Arguments { function: Func::Bcd, places, domain })])
    };
    assert_eq!(found(3).outcome, Outcome::Different);
    assert_ne!(found(2).outcome, Outcome::Different, "{:#?}", found(2).witness);
}

#[test]
fn the_alarm_that_a_program_raises_is_an_assumption() {
    let source = "O1\nG21G90\nIF[#500LE0]GOTO9\n#3000=FIX[#500]\nN9M30\n";
    let found = one(source, source, &[assumption(Predicate::Alarms(1.0))]);
    assert!(found.assumptions[0].broken.unwrap() > 0 && found.assumptions[0].kept.unwrap() > 0, "{found:#?}");
}

#[test]
fn levels_of_the_other_kind_do_not_count() {
    let source = "O1\nG21G90\n#500=0\nM98P2\nM30\nO2\n#500=#500+1\nIF[#500GT3]GOTO9\nM98P2\nN9M99\n";
    let nesting = |counts: [bool; 2], most: u32| {
        let limit = "call.macro".into();
        let found = one(source, source, &[assumption(Predicate::Nesting { limit, counts, most })]);
        found.assumptions[0].broken.unwrap() > 0
    };
    assert_eq!([nesting([true, false], 3), nesting([true, false], 4)], [true, false]);
    assert!(!nesting([false, true], 1) && nesting([true, true], 1));
}

#[test]
fn a_moved_text_moves_the_places_of_its_assumptions() {
    let source = "O1\n#500=1 (EDIT)\nG21G90\nIF[#500EQ555]GOTO5\nG0X1.\nN5#2=#[#500+0]\nG0X5.\nM30\n";
    let supposed = [numbers(source, "N5#2=#[#500+0]", &[(1, 33), (555, 555)])];
    let found = one(source, source, &supposed);
    assert!(found.assumptions[0].broken == Some(0) && found.outcome == Outcome::Same, "{found:#?}");
}

/// A broken assumption is an alarm on the target; the work offset that the source returns in was there from the start.
#[test]
fn a_break_excuses_its_alarm_in_every_state_of_the_machine() {
    let source = "O1\nG1Z1.F9.\nIF[#142LT9]GOTO10\n#[600+#523]=7\nN10M99\n";
    let found = one(source, source, &[numbers(source, "#[600+#523]=7", &[(500, 699)])]);
    assert_ne!(found.outcome, Outcome::Different, "{:?}", found.witness);
    let there = source.replace("=7", "=8");
    let found = one(source, &there, &[numbers(source, "#[600+#523]=7", &[(500, 699)])]);
    assert_eq!(found.outcome, Outcome::Different);
}

/// The spindle that the caller has started is seen when something is done with it: on the source where the program
/// returns, after the variable that breaks the assumption.
#[test]
fn a_break_excuses_what_a_running_spindle_does_after_it() {
    let source = "O1\nG21G90G17G54\nS800M3\nG65P2\nM5\nM30\nO2\n#105=#[600+#140]\nG0X#105\nM99\n";
    let (_, supposed) = numbers(source, "#105=#[600+#140]", &[(500, 699)]);
    let of_o2 = |target: &str| all(source, target, &[], &[(1, supposed.clone())]).remove(1);
    assert_ne!(of_o2(source).outcome, Outcome::Different, "{:?}", of_o2(source).witness);
    assert_eq!(of_o2(&source.replace("#105=#[600", "G1X9.F9.\n#105=#[600")).outcome, Outcome::Different);
}

/// Who says that nothing calls the program says that its `M99 P` is a jump; else it may be one.
#[test]
fn a_program_that_is_run_by_itself_goes_on_at_its_own_block() {
    let source = "O1\nG21G90\n#1=0\nN10G0X5.\nG0X6.\n#1=#1+1\nIF[#1GT3]GOTO30\nM99P10\nN30M30\n";
    let target = source.replace("M99P10", "GOTO10");
    let found = |supposed: &[(usize, Assumption)]| one(source, &target, supposed).outcome;
    assert_eq!(found(&[]), Outcome::Undecided);
    let main = [assumption(Predicate::Main)];
    assert_eq!(found(&main), Outcome::Same);
    // Who supposes it sees a jump to another block.
    let elsewhere = source.replace("G0X6.", "N20G0X6.").replace("M99P10", "GOTO20");
    assert_eq!(one(source, &elsewhere, &main).outcome, Outcome::Different);
}

/// With parameter 5006.6 of 0 a code of the tool length moves Z where the block has no Z, and a vacant word is none.
#[test]
fn a_length_whose_place_is_vacant_is_excused_where_that_is_supposed() {
    let fanuc = "dialect = \"fanuc\"\nunits = \"metric\"\n[parameters]\n5006.6 = 0\n";
    let controls = [fanuc, "dialect = \"haas\"\nunits = \"metric\"\n"];
    let controls = controls.map(|text| Control::from_profile(text).unwrap());
    let source = "O1\nG21G90G17G49G54\nG0X0.Y0.\nG43Z#500H1\nX5.\nM30\n";
    let found = |target: &str, supposed: &[(usize, Assumption)]| {
        between(&controls, [source, target], &SymbolMap::default(), supposed).remove(0)
    };
    let supposed = [assumption(Predicate::LengthAxis(place(source, "G43Z#500H1")))];
    assert_eq!(found(source, &[]).outcome, Outcome::Different);
    let kept = found(source, &supposed);
    assert_ne!(kept.outcome, Outcome::Different, "{:?}", kept.witness);
    assert!(kept.assumptions[0].kept.unwrap() > 0 && kept.assumptions[0].broken.unwrap() > 0, "{kept:#?}");
    // What else differs is seen, before the block and where the word has a value.
    for other in [source.replace("Y0.", "Y1."), source.replace("Z#500", "Z[#500+1.]")] {
        assert_eq!(found(&other, &supposed).outcome, Outcome::Different, "{other}");
    }
}
