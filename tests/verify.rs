//! Pairs of programs by hand, handed to the verifier as if one were the conversion of the other: those that
//! differ in one place must be told apart there, those that are only written otherwise must not.

use machine::machine;
use macroglot::control::LoadedFile;
use macroglot::dialect::registry;
use macroglot::syntax::parse_file;
use macroglot::verify::{Assumptions, Certificate, Effort, Job, Outcome, Side, Spent, SymbolMap, verify};
use std::path::PathBuf;

#[path = "support/machine.rs"]
mod machine;

/// A pair, and what of the target is changed.
struct Pair<'p> {
    name: &'p str,
    from: &'p str,
    to: &'p str,
    lock: Vec<(&'p str, u32)>,
    source: &'p str,
    target: String,
    /// What stands there once, what instead, and what the witness says of it.
    changes: Vec<(String, String, &'p str)>,
    /// What stands there once, and what instead, where it cannot be said to be the same.
    doubts: Vec<(String, String)>,
}

fn read(text: &str) -> Vec<Pair<'_>> {
    text.split("\n=== ").skip(1).map(pair).collect()
}

fn pair(text: &str) -> Pair<'_> {
    let (head, rest) = text.split_once('\n').unwrap();
    let (name, how) = head.rsplit_once(", ").unwrap();
    let mut how = how.split(' ');
    let (from, to) = (how.next().unwrap(), how.next().unwrap());
    let lock =
        how.map(|row| row.split_once('=').unwrap()).map(|(name, number)| (name, number.parse().unwrap()));
    let (source, rest) = rest.split_once("---\n").unwrap();
    let lines = || rest.lines().take_while(|line| !line.is_empty());
    let line = |text: &str| text.replace("\\n", "\n");
    let change = |change: &str| {
        let (old, new) = change.split_once(" => ").unwrap();
        (line(old), line(new.trim_end_matches(' ')))
    };
    let changes = lines().filter_map(|line| line.strip_prefix("~ ")).map(|text| {
        let (text, what) = text.rsplit_once('|').unwrap();
        let (old, new) = change(text);
        (old, new, what.trim())
    });
    let doubts = lines().filter_map(|line| line.strip_prefix("? ")).map(change);
    let is_text = |line: &&str| !line.starts_with("~ ") && !line.starts_with("? ");
    Pair {
        name,
        from,
        to,
        lock: lock.collect(),
        source,
        target: lines().filter(is_text).flat_map(|line| [line, "\n"]).collect(),
        changes: changes.collect(),
        doubts: doubts.collect(),
    }
}

/// Verifies a target of a pair.
fn judge(pair: &Pair<'_>, target: &str) -> Certificate {
    let controls = [pair.from, pair.to].map(|spec| machine(spec).unwrap());
    let execute = [0, 1].map(|at: usize| registry::find(controls[at].name()).unwrap().execute.unwrap());
    let parsed = [(pair.source, &controls[0]), (target, &controls[1])]
        .map(|(text, control)| parse_file(text.as_bytes(), control.entry().parse));
    let ours = [LoadedFile { name: "a.nc", parsed: &parsed[0] }];
    let theirs = [LoadedFile { name: "a.nc", parsed: &parsed[1] }];
    let source = Side::new(&controls[0], execute[0], &ours);
    let target = Side::new(&controls[1], execute[1], &theirs);
    let variables = pair.lock.iter().map(|(name, number)| ((*name).to_owned(), *number)).collect();
    let names = SymbolMap { variables, ..SymbolMap::default() };
    let (assumptions, effort) = (Assumptions::new(), Effort::default());
    verify(
        &Job {
            source: &source,
            target: &target,
            names: &names,
            assumptions: &assumptions,
            effort,
            spent: &Spent::default(),
        },
        &[],
    )
}

/// The pairs of all files.
fn text() -> String {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/verify");
    let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|e| e == "txt")).collect();
    files.sort();
    files.iter().map(|path| std::fs::read_to_string(path).unwrap() + "\n").collect()
}

#[test]
fn what_is_written_otherwise_is_the_same() {
    let text = text();
    let pairs = read(&text);
    assert!(pairs.len() >= 15, "{}", pairs.len());
    for pair in &pairs {
        let found = judge(pair, &pair.target);
        let witness = found.programs.iter().find_map(|program| program.witness.as_ref());
        assert_ne!(found.outcome, Outcome::Different, "{}: {witness:#?}", pair.name);
        for program in &found.programs {
            let reasons: Vec<_> = program.reasons.iter().map(|reason| reason.why).collect();
            let unconfirmed = |why: &macroglot::verify::Why| *why == macroglot::verify::Why::Unconfirmed;
            assert!(reasons.iter().all(unconfirmed), "{}: {:?}", pair.name, program.reasons);
        }
    }
}

#[test]
fn what_differs_in_one_place_is_told_apart() {
    let text = text();
    let (mut count, mut missed) = (0, Vec::new());
    for pair in read(&text) {
        for (old, new, what) in &pair.changes {
            count += 1;
            let (place, found) = changed(&pair, old, new);
            let mut witnesses = found.programs.iter().filter_map(|program| program.witness.as_ref());
            if found.outcome != Outcome::Different {
                let reasons = found.programs.iter().flat_map(|program| &program.reasons);
                let reasons: Vec<_> = reasons.map(|reason| (reason.why, &reason.text)).collect();
                missed.push(format!("{place} is {:?}: {reasons:?}", found.outcome));
            } else if !witnesses.any(|witness| witness.what.contains(what)) {
                missed.push(format!("{place}: not {what}"));
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
    assert!(count >= 180, "{count} changes");
}

#[test]
fn what_cannot_be_told_is_not_called_the_same() {
    let text = text();
    let mut same = Vec::new();
    for pair in read(&text) {
        for (old, new) in &pair.doubts {
            let (place, found) = changed(&pair, old, new);
            // A fact that no source confirms would hide what this is about.
            let reasons = found.programs.iter().flat_map(|program| &program.reasons);
            let mut others = reasons.filter(|reason| reason.why != macroglot::verify::Why::Unconfirmed);
            if found.outcome != Outcome::Different && others.next().is_none() {
                same.push(place);
            }
        }
    }
    assert!(same.is_empty(), "{}", same.join("\n"));
}

/// A pair with one place of the target changed: which, and what is found.
fn changed(pair: &Pair<'_>, old: &str, new: &str) -> (String, Certificate) {
    assert_eq!(pair.target.matches(old).count(), 1, "{}: {old:?} stands once", pair.name);
    (format!("{}: {old:?} made {new:?}", pair.name), judge(pair, &pair.target.replace(old, new)))
}

/// What is found of a pair without any changes, and why it is not decided.
fn found(from: &str, to: &str, source: &str, target: &str) -> (Outcome, Vec<macroglot::verify::Why>) {
    let target = target.to_owned();
    let pair = Pair { name: "", from, to, lock: Vec::new(), source, target, changes: vec![], doubts: vec![] };
    let found = judge(&pair, &pair.target);
    (found.outcome, found.programs.iter().flat_map(|p| &p.reasons).map(|reason| reason.why).collect())
}

#[test]
fn what_the_target_lacks_is_neither_the_same_nor_a_fault() {
    use macroglot::verify::Why::Substituted;
    let mist = "O1\nM7\nG0 X1.\nM2\n";
    let (outcome, why) = found("fadal", "haas", mist, "O00001\nM8\nG0 X1.\nM2\n");
    assert_eq!((outcome, why.contains(&Substituted)), (Outcome::Undecided, true));
    // Left out, or where the target has it, it is a fault.
    assert_eq!(found("fadal", "haas", mist, "O00001\nG0 X1.\nM2\n").0, Outcome::Different);
    assert_eq!(found("fadal", "fanuc", mist, "O0001\nM8\nG0 X1.\nM2\n").0, Outcome::Different);
    let ramps = "O1\nG8\nG0 X1.\nM2\n";
    let (outcome, why) = found("fadal", "fanuc", ramps, "O0001\nG0 X1.\nM2\n");
    assert_eq!((outcome, why.contains(&Substituted)), (Outcome::Undecided, true));
    assert_eq!(found("fadal", "fanuc", ramps, "O0001\nG0 X2.\nM2\n").0, Outcome::Different);
    // A code that only the builder knows says nothing on either side.
    let builders = "O1\nM77\nG0X1.\nM30\n";
    assert_ne!(found("fanuc", "haas", builders, "O1\nM77\nG0X1.\nM30\n").0, Outcome::Same);
    assert_eq!(found("fanuc", "haas", builders, "O1\nM78\nG0X1.\nM30\n").0, Outcome::Different);
}

#[test]
fn small_moves_do_not_add_up_unseen() {
    let source = format!("O1\nG90 G0 X1.\nG91\nG1 F10.\n{}G90\nM2\n", "X.0004\n".repeat(10));
    assert_eq!(found("fadal", "fanuc", &source, "O0001\nG90 G0 X1.\nM2\n").0, Outcome::Different);
}

#[test]
fn scratch_registers_hold_nothing_and_others_do() {
    let source = "O1\n#101=1\nG0X#101\nM30\n";
    let target = "O1\n#101=1\n#140=#101\nG0X#140\nM30\n";
    assert_eq!(found("fanuc", "haas", source, target).0, Outcome::Different);
}

/// A loop that adds a step until a limit, by dialect; it moves one millimetre or inch each time.
fn counting(dialect: &str, step: &str, limit: &str) -> String {
    match dialect {
        "fadal" => {
            format!("O1\n#V1=0\n#:A\n#V1=V1+{step}\nG91 G1 X1. F100.\n#IF V1<{limit} THEN GOTO :A\nG90\nM2\n")
        }
        "cc100" => format!("V31=0\n$1\nV31=V31+{step}\nG91 G1 X1 F100\nV32=V31-{limit}\nBLT P1\nG90\nM30\n"),
        _ => {
            format!("O1\n#501=0\nWHILE[#501LT{limit}]DO1\n#501=#501+{step}\nG91G1X1.F100.\nEND1\nG90\nM30\n")
        }
    }
}

/// By `rounding.tsv`, which `rounding.py` works out: the last digit decides where binary and decimal counts differ, and where
/// other errors than those of doubles would count otherwise.
#[test]
fn what_the_last_digit_decides_is_marked_and_nothing_else() {
    let table = include_str!("verify/rounding.tsv");
    for (from, to) in [
        ("fadal", "fanuc"),
        ("fadal", "haas"),
        ("cc100", "fanuc"),
        ("cc100", "haas"),
        ("fanuc", "haas"),
        ("haas", "fanuc"),
    ] {
        let mut marked = 0;
        for row in table.lines() {
            let [step, limit, binary, decimal, decides] = row.split('\t').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            let source = counting(from, step, limit);
            let lock = match from {
                "fadal" => vec![("V1", 501)],
                "cc100" => vec![("V31", 501), ("V32", 502)],
                _ => vec![],
            };
            let mut target = counting(to, step, limit);
            if from == "cc100" {
                target = target.replace("END1", &format!("#502=#501-{limit}\nEND1"));
            }
            let pair = Pair {
                name: row,
                from,
                to,
                lock,
                source: &source,
                target: String::new(),
                changes: vec![],
                doubts: vec![],
            };
            let found = judge(&pair, &target);
            let [program] = &found.programs[..] else { panic!("one program") };
            assert!(program.witness.is_none(), "{from} {to} {row}: {:#?}", program.witness);
            assert!(decides == "yes" || binary == decimal, "{row}");
            assert_eq!(program.rounding_sensitive, Some(decides == "yes"), "{from} {to} {row}");
            marked += usize::from(decides == "yes");
        }
        assert!(marked > 3 && marked < table.lines().count() - 3, "{marked} rows are marked");
    }
}
