//! Random programs of every dialect and policy, converted and verified.
//!
//! `MACROGLOT_PROGRAMS=1000 MACROGLOT_SEED=7 cargo test --test random -- --nocapture` tries so many programs
//! of each dialect and policy. A program that shows a fault is made smaller, then printed with its seed.

#[path = "support/generate/mod.rs"]
mod generate;

use generate::trial::{self, Judgement, Trial};
use generate::{DIALECTS, Policy, Program, Source};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::panic::catch_unwind;
use std::time::Instant;

/// How many programs of each dialect and policy are tried where nothing else is said.
const PROGRAMS: u64 = 6;
const SEED: u64 = 20_261;
/// Programs with faults that are printed.
const SHOWN: usize = 8;
/// Smaller programs that are tried for one with a fault.
const SMALLER: usize = 400;

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

fn drawn(dialect: &'static str, policy: Policy, seed: u64) -> Program {
    generate::program(dialect, policy, &mut Source::Seed(seed))
}

/// Tries a program; a panic is a fault like others.
fn tried(program: &Program) -> Trial {
    let text = program.text();
    catch_unwind(|| trial::run(program.dialect, &text)).unwrap_or_else(|_| Trial {
        useful: false,
        judged: Vec::new(),
        faults: vec!["panicked".into()],
    })
}

/// The first words of a fault without its target and numbers: what kind of fault it is.
fn kind(fault: &str) -> String {
    let first = fault.lines().next().unwrap_or_default();
    let first = first.split_once(": ").map_or(first, |(_, what)| what);
    first.chars().filter(|sign| !sign.is_ascii_digit() && !"-.".contains(*sign)).collect()
}

/// The smallest program found that shows a fault of the same kind.
fn smallest(program: Program, wanted: &str) -> Program {
    let (mut program, mut left) = (program, SMALLER);
    'again: loop {
        for next in generate::smaller(&program) {
            if left == 0 {
                return program;
            }
            left -= 1;
            if tried(&next).faults.iter().any(|fault| kind(fault) == wanted) {
                program = next;
                continue 'again;
            }
        }
        return program;
    }
}

#[test]
fn random_programs_do_the_same_on_the_target() {
    let (programs, seed) = (setting("MACROGLOT_PROGRAMS", PROGRAMS), setting("MACROGLOT_SEED", SEED));
    let start = Instant::now();
    let kinds: Vec<(&str, Policy)> =
        DIALECTS.iter().flat_map(|dialect| Policy::ALL.map(|policy| (*dialect, policy))).collect();
    let mut table = String::new();
    let (mut all, mut useful) = (0, 0);
    let mut faulty: Vec<(&str, Policy, u64, String)> = Vec::new();
    for (at, (dialect, policy)) in kinds.into_iter().enumerate() {
        let trials: Vec<(u64, Trial)> = (0..programs)
            .into_par_iter()
            .map(|number| {
                let seed = seed.wrapping_add(((at as u64) << 32) + number);
                (seed, tried(&drawn(dialect, policy, seed)))
            })
            .collect();
        let share = trials.iter().filter(|(_, trial)| trial.useful).count();
        let mut verdicts: BTreeMap<Judgement, usize> = BTreeMap::new();
        for (_, judgement) in trials.iter().flat_map(|(_, trial)| &trial.judged) {
            *verdicts.entry(*judgement).or_default() += 1;
        }
        (all, useful) = (all + trials.len(), useful + share);
        let _ = writeln!(table, "{dialect:6} {policy:12?} useful {share:6}/{programs} {verdicts:?}");
        for (seed, trial) in trials {
            faulty.extend(trial.faults.into_iter().map(|fault| (dialect, policy, seed, fault)));
        }
    }
    println!(
        "{table}seed {seed}, {programs} programs of each: {useful} of {all} useful, {:?}",
        start.elapsed()
    );
    let mut shown = String::new();
    let mut seen: BTreeMap<(&str, String), usize> = BTreeMap::new();
    for (dialect, policy, seed, fault) in &faulty {
        let times = seen.entry((dialect, kind(fault))).or_default();
        *times += 1;
        if *times > 1 || shown.matches("== ").count() >= SHOWN {
            continue;
        }
        let program = smallest(drawn(dialect, *policy, *seed), &kind(fault));
        let faults = tried(&program).faults.join("\n");
        let _ = writeln!(shown, "== {dialect} {policy:?} seed {seed}\n{}-- {faults}\n", program.text());
    }
    assert!(faulty.is_empty(), "{} faults: {seen:?}\n{shown}", faulty.len());
    assert!(useful * 2 >= all, "only {useful} of {all} programs are useful\n{table}");
}

#[test]
fn the_bytes_of_a_fuzzer_make_programs_too() {
    for bytes in [&b""[..], b"\0\x06", &[255; 300], &[0x5a; 90]] {
        let program = generate::fuzzed(bytes);
        assert!(program.text().lines().count() > 5);
        assert_eq!(program.text(), generate::fuzzed(bytes).text());
        assert!(trial::run(program.dialect, &program.text()).faults.is_empty());
    }
}
