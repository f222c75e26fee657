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
    let input = |(name, text): &(&str, &str)| Input {
        path: PathBuf::from(name),
        name: (*name).into(),
        bytes: text.as_bytes().to_vec(),
    };
    let inputs: Vec<Input> = files.iter().map(input).collect();
    convert(&inputs, &source, &target, lock, Options::default())
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
