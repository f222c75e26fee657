//! One map of registers for a library: kept by its lock, and never against the machine.

use macroglot::dialect::{Control, Profile, registry};
use macroglot::library::{Conversion, Input, Lock, Options, Outcome, convert};
use std::path::PathBuf;

const MAIN: (&str, &str) = ("a.nc", "O1\n#V5=1\n#V9=2\nR3+1.\nM98 P2\nM2\n");
const SUB: (&str, &str) = ("b.nc", "O2\n#V5=V5+1\nG0 X+R3\nM99\n");

fn converted(files: &[(&str, &str)], lock: Lock, profile: &str) -> Conversion {
    let source = Control::plain("fadal").unwrap();
    let profile = Profile::read(&format!("dialect = \"fanuc\"\n{profile}")).unwrap();
    let target = Control::new(registry::find("fanuc").unwrap(), profile).unwrap();
    convert(&inputs(files), &source, &target, lock, Options::default())
}

fn inputs(files: &[(&str, &str)]) -> Vec<Input> {
    let input = |(name, text): &(&str, &str)| Input {
        path: PathBuf::from(name),
        name: (*name).into(),
        bytes: text.as_bytes().to_vec(),
    };
    files.iter().map(input).collect()
}

fn empty() -> Lock {
    Lock::new("fadal", "fanuc")
}

fn refused(made: &Conversion) -> Vec<bool> {
    made.programs.iter().map(|program| program.outcome == Outcome::Refused).collect()
}

#[test]
fn a_later_file_moves_no_variable() {
    let before = converted(&[MAIN, SUB], empty(), "").lock;
    let grown = [("0.nc", "O3\n#V1=1\n#V7=2\nM2\n"), MAIN, SUB];
    let after = converted(&grown, before.clone(), "").lock;
    for (name, number) in &before.variables {
        assert_eq!(after.variables.get(name), Some(number), "{name}");
    }
    let alone = converted(&[SUB], after.clone(), "").lock;
    assert_eq!(alone.variables, after.variables);
}

#[test]
fn a_lock_does_not_override_the_shop() {
    let lock = converted(&[MAIN, SUB], empty(), "").lock;
    let reserved = format!("reserved = [\"#{}\"]", lock.variables["V5"]);
    assert_eq!(refused(&converted(&[MAIN, SUB], lock, &reserved)), [true, true]);
    assert_eq!(refused(&converted(&[MAIN, SUB], empty(), &reserved)), [false, false]);
}

#[test]
fn a_lock_that_puts_two_variables_in_one_register_is_refused() {
    let mut lock = converted(&[MAIN, SUB], empty(), "").lock;
    let taken = lock.variables["R3"];
    lock.variables.insert("V9".into(), taken);
    assert_eq!(refused(&converted(&[MAIN, SUB], lock, "")), [true, true]);
}

#[test]
fn too_few_registers_are_an_error() {
    let made = converted(&[MAIN, SUB], empty(), "reserved = [\"#100-#199\", \"#502-#999\"]");
    assert!(refused(&made).contains(&true));
}

/// A program that alone needs more than the target has takes nothing from the others; what it is told, it is told once.
#[test]
fn a_program_that_needs_too_many_registers_is_set_aside() {
    let [fanuc, fadal] = ["fanuc", "fadal"].map(|name| Control::plain(name).unwrap());
    let numbers = (100..200).chain(510..516);
    let greedy: String = numbers.map(|n| format!("#{n}=#{n}+1\n")).collect();
    let greedy = format!("O1\nG65P2A1.\n{greedy}M30\n");
    let files = [
        ("1.nc", greedy.as_str()),
        ("2.nc", "O2\nG0X#1\n#500=#500+#1\nM99\n"),
        ("3.nc", "O3\nG65P2A2.\nM30\n"),
    ];
    let converted = |files: &[(&str, &str)]| {
        convert(&inputs(files), &fanuc, &fadal, Lock::new("fanuc", "fadal"), Options::default())
    };
    let told = |made: &Conversion| -> Vec<String> {
        let all = made.programs[0].diagnostics.iter().filter(|d| d.code.number() == "MG0403");
        all.map(|d| d.message.to_string()).collect()
    };
    let made = converted(&files);
    assert_eq!(refused(&made), [true, false, false]);
    let names = "#100, #101, #102, #103, #104, #105, #106, #107 and 98 more";
    let wanted = format!(
        "the target has no register left for {names}, which only this program uses; the other programs of the library \
         have theirs"
    );
    assert_eq!(told(&made), [wanted]);
    assert!(!codes(&made).contains(&"MG0501"));
    // Alone it has nobody to compete with: what has the registers is told.
    let told = told(&converted(&files[..1]));
    assert!(matches!(&told[..], [one] if one.contains("the registers are taken by #100, #101")), "{told:?}");
}

#[test]
fn a_program_keeps_the_number_that_it_was_given() {
    let (source, target) = (Control::plain("haas").unwrap(), Control::plain("fanuc").unwrap());
    let text = "O1\nM98P30002\nM30\nO30002\nG0X1.\nM99\n";
    let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
    let run = |lock: Lock| convert(&inputs, &source, &target, lock, Options::default());
    let first = run(Lock::new("haas", "fanuc"));
    let number = first.lock.programs["O30002"];
    assert!((1..=9999).contains(&number));
    let again = run(first.lock.clone());
    assert_eq!(again.lock.programs["O30002"], number);
    assert_eq!(again.texts, first.texts);
}

/// A library of Fanuc programs, for the Haas, whose numbers end at #699 and begin again at #800.
fn to_haas(files: &[(&str, &str)], lock: Lock) -> Conversion {
    let (source, target) = (Control::plain("fanuc").unwrap(), Control::plain("haas").unwrap());
    convert(&inputs(files), &source, &target, lock, Options::default())
}

fn codes(made: &Conversion) -> Vec<&'static str> {
    let all = made.programs.iter().flat_map(|program| &program.diagnostics);
    all.map(|diagnostic| diagnostic.code.number()).filter(|code| code.starts_with("MG061")).collect()
}

const MACRO: (&str, &str) = ("macro.nc", "O9000\nG21\n#700=1.5\nG0 X#700\nM99\n");
const CALLER: (&str, &str) = ("main.nc", "O1000\nG21\n#800=50.\nM98 P9000\nG0 X#800\nM30\n");

#[test]
fn a_register_of_an_earlier_run_is_not_the_callers_own() {
    let first = to_haas(&[MACRO], Lock::new("fanuc", "haas"));
    assert_eq!(first.lock.variables["#700"], 800);
    // The macro is on the machine with #700 in #800: its caller must not have #800 itself.
    let alone = to_haas(&[CALLER], first.lock.clone());
    assert_eq!((refused(&alone), alone.lock.variables["#700"]), (vec![true], 800));
    assert!(codes(&alone).contains(&"MG0610"));
    // Both together: the macro is written anew, with another register.
    let both = to_haas(&[MACRO, CALLER], first.lock);
    assert_eq!(refused(&both), [false, false]);
    let told: Vec<&str> = both.programs[1].diagnostics.iter().map(|d| &*d.message).collect();
    assert!(told.contains(&"#700 moves from #800 to #801: this program uses #800 itself"), "{told:?}");
    assert_eq!(both.lock.variables["#700"], 801);
    assert_eq!(both.texts[1].as_deref(), Some("O1000\nG21\n#800=50\nM98 P9000\nG0 X#800\nM30\n"));
}

/// A program that wants many registers of another library is told of them in one finding, and the files are not all listed.
#[test]
fn all_that_stands_in_the_way_of_a_program_is_one_finding() {
    let lines = |numbers: std::ops::Range<u32>| -> String { numbers.map(|n| format!("#{n}=1.\n")).collect() };
    let names: Vec<String> = (1..=12).map(|n| format!("m{n:02}.nc")).collect();
    let texts: Vec<String> = (1..=12).map(|n| format!("O{n}\nG21\n{}M99\n", lines(700..720))).collect();
    let files: Vec<(&str, &str)> =
        names.iter().map(String::as_str).zip(texts.iter().map(String::as_str)).collect();
    let first = to_haas(&files, Lock::new("fanuc", "haas"));
    assert_eq!(first.lock.variables.values().copied().collect::<Vec<_>>(), (800..820).collect::<Vec<_>>());
    let own = format!("O1000\nG21\n{}M30\n", lines(800..810));
    let made = to_haas(&[("main.nc", &own)], first.lock);
    assert_eq!(codes(&made), ["MG0610"]);
    let told = &made.programs[0].diagnostics.iter().find(|d| d.code.number() == "MG0610").unwrap().message;
    let parts =
        ["#807 for #707 and 2 more, and m01.nc", "m08.nc and 4 more rely on them", "#807 and 2 more itself"];
    assert!(parts.iter().all(|part| told.contains(part)), "{told}");
}

#[test]
fn a_register_of_values_in_between_is_not_the_callers_own_either() {
    // The remainder takes a temporary.
    let between = ("macro.nc", "O9000\nG21\n#1=#2 MOD 3\nG0 X#1\nM99\n");
    let caller = ("main.nc", "O1000\nG21\n#100=50.\nM98 P9000\nG0 X#100\nM30\n");
    let first = to_haas(&[between], Lock::new("fanuc", "haas"));
    assert_eq!(first.lock.scratch, [100]);
    let alone = to_haas(&[caller], first.lock.clone());
    assert_eq!((refused(&alone), &alone.lock.scratch), (vec![true], &vec![100]));
    let both = to_haas(&[between, caller], first.lock);
    assert_eq!((refused(&both), &both.lock.scratch), (vec![false, false], &vec![101]));
}

/// Counts repeats under a modal call, whose macro calls a program of another file.
const COUNTS: (&str, &str) = (
    "main.nc",
    "N1 O1\nN2 L100\nN3 M98 P9\nN4 M17\nN5 M30\nN6 G0 G90 G20 E1\nN7 L101 G66\nN8 G91\nN9 X1. Y1. L3\nN10 G90\nN11 G67\nN12 M2\n",
);

/// Needs a temporary.
const ROUNDS: (&str, &str) = ("sub.nc", "N1 O9\nN2 #SET RND3\nN3 #R5=RND(R6)\nN4 M99\n");

#[test]
fn what_outlives_a_call_stays_apart_from_callees_that_are_converted_later() {
    let lock = empty();
    let first = converted(&[COUNTS], lock.clone(), "");
    let counter = first.lock.over_calls.clone();
    assert_eq!(counter.len(), 1);
    let later = converted(&[ROUNDS], first.lock, "");
    assert!(!later.texts[0].as_deref().unwrap().contains(&format!("#{}=", counter[0])), "{:?}", later.texts);
    assert_eq!(later.lock.over_calls, counter);
    // The other way round.
    let first = converted(&[ROUNDS], lock.clone(), "");
    let later = converted(&[COUNTS], first.lock.clone(), "");
    assert_eq!((first.lock.scratch.len(), later.lock.over_calls.len()), (1, 1));
    assert!(!first.lock.scratch.contains(&later.lock.over_calls[0]));
    // Both in one run: callees are known.
    let both = converted(&[COUNTS, ROUNDS], lock, "");
    assert!(both.lock.over_calls.len() == 1 && both.lock.scratch.len() == 2);
}

#[test]
fn what_earlier_programs_use_themselves_is_not_taken() {
    let first = to_haas(&[CALLER], Lock::new("fanuc", "haas"));
    assert_eq!(first.lock.own, [800]);
    let second = to_haas(&[MACRO], first.lock);
    assert_eq!(second.lock.variables["#700"], 801);
    assert_eq!(second.lock.files, ["macro.nc", "main.nc"]);
    // #800 to #803 by a computed number, which has its bounds from AND.
    let computed = ("main.nc", "O1000\nG21\n#[800+[#1 AND 3]]=50.\nM30\n");
    let first = to_haas(&[computed], Lock::new("fanuc", "haas"));
    assert_eq!(to_haas(&[MACRO], first.lock).lock.variables["#700"], 804);
}

#[test]
fn variables_that_come_to_need_a_row_are_moved_together_or_not_at_all() {
    let alone = ("a.nc", "O1\n#V1=1\nG0 X1.\nM2\n");
    let row = ("b.nc", "O2\n#V2=2\n#V(V2)=3\nG0 X2.\nM2\n");
    let first = converted(&[alone], empty(), "options = [\"common.variables\"]").lock;
    let options = "options = [\"common.variables\"]";
    let later = converted(&[row], first.clone(), options);
    assert_eq!((refused(&later), codes(&later).contains(&"MG0610")), (vec![true], true));
    assert_eq!(
        converted(&[alone], later.lock, options).texts,
        converted(&[alone], first.clone(), options).texts
    );
    let both = converted(&[alone, row], first, options);
    assert_eq!((refused(&both), codes(&both).contains(&"MG0611")), (vec![false, false], true));
    assert!(!both.lock.variables.contains_key("V1"));
}

#[test]
fn a_lock_of_before_is_read() {
    let text = "version = 1\nfrom = \"fanuc\"\nto = \"haas\"\nscratch = [105]\n\n[variables]\n\"#700\" = 103\n\n[programs]\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(Lock::NAME);
    std::fs::write(&path, text).unwrap();
    let lock = Lock::load(&path, "fanuc", "haas").unwrap();
    assert_eq!(to_haas(&[MACRO], lock.clone()).lock.variables["#700"], 103);
    // It does not say which files rely on it.
    let wants = ("main.nc", "O1000\nG21\n#103=50.\nM98 P9000\nG0 X#103\nM30\n");
    assert_eq!(refused(&to_haas(&[wants, MACRO], lock)), [true, false]);
}

#[test]
fn the_lock_says_which_programs_hold_copies_of_which() {
    let [source, target] = ["fanuc", "cc100"].map(|name| Control::plain(name).unwrap());
    let main = ("a.nc", "O1\nG90\nM98 P9010\nM30\n");
    let subs = ("b.nc", "O9010\nM98 P9020\nM99\nO9020\nG91\nM99\n");
    let lock = Lock::new("fanuc", "cc100");
    let made = convert(&inputs(&[main, subs]), &source, &target, lock, Options::default());
    let held = |name: &str| made.lock.parts[name].iter().map(String::as_str).collect::<Vec<_>>();
    assert_eq!(held("O9010"), ["O1"]);
    assert_eq!(held("O9020"), ["O1", "O9010"]);
    let text = made.lock.print();
    assert!(text.contains("[parts]") && text.contains("after their M30"), "{text}");
}

/// A control whose programs have no number: the one that a file's name begins with is the operator's.
#[test]
fn a_program_gets_the_number_that_its_file_begins_with() {
    let [source, target] = ["cc100", "fanuc"].map(|name| Control::plain(name).unwrap());
    let numbers = |names: &[&str], lock: Lock| {
        // The subroutine of each becomes a program after it.
        let text = "N1 G22 P7\nN2 M30\nN3 $7\nN4 G0 X1\nN5 G99\n";
        let files: Vec<(&str, &str)> = names.iter().map(|name| (*name, text)).collect();
        let made = convert(&inputs(&files), &source, &target, lock, Options::default());
        let told =
            |at: usize| made.programs[at].diagnostics.iter().any(|found| found.code.number() == "MG0605");
        let all = names.iter().enumerate().map(|(at, name)| (made.lock.programs[*name], told(at)));
        (all.collect::<Vec<_>>(), made.lock)
    };
    let empty = || Lock::new("cc100", "fanuc");
    let names = ["sub/1001.NC", "1014.NC", "1102-FLANSCH.NC", "0020_B.NC", "PLATE.NC", "3D.NC"];
    let (given, lock) = numbers(&names, empty());
    let wanted = [(1001, false), (1014, false), (1102, false), (20, false), (1000, false), (1002, false)];
    assert_eq!(given, wanted);
    // The lock keeps them, and so it does those of an earlier run that had them otherwise.
    assert_eq!(numbers(&names, lock).0, wanted);
    let mut other = empty();
    other.programs.insert("1014.NC".into(), 1003);
    assert_eq!(numbers(&["1014.NC"], other).0, [(1003, true)]);
    // Two files of one number, a number that is often locked, and one that the target does not have.
    let (given, _) = numbers(&["7-A.NC", "7-B.NC", "9001-W.NC", "20240115.NC"], empty());
    assert_eq!(given, [(1000, true), (1001, true), (1002, true), (1003, true)]);
}
