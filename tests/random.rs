//! Random programs of every dialect and policy, converted and verified.
//!
//! `MACROGLOT_PROGRAMS=1000 MACROGLOT_SEED=7 cargo test --test random -- --nocapture` tries so many programs
//! of each dialect and policy. A program that shows a fault is made smaller, then printed with its seed.
//! `MACROGLOT_KINDS="fadal DeepDo"` tries that kind alone, `MACROGLOT_KINDS=fadal` those of one dialect.
//! `MACROGLOT_SMALLER=0` prints programs with faults as they were drawn.
//! `MACROGLOT_REASONS=1` prints why each conversion is undecided, and why programs are refused.

#[path = "support/generate/mod.rs"]
mod generate;

use generate::trial::{self, Judgement, Trial};
use generate::{DIALECTS, Policy, Program, Source};
use macroglot::verify::Reason;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::panic::catch_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How many programs of each dialect and policy are tried where nothing else is said.
const PROGRAMS: u64 = 2;
const SEED: u64 = 20_261;
/// Programs with faults that are printed.
const SHOWN: usize = 24;
/// Smaller programs that are tried for one with a fault.
const SMALLER: u64 = 400;
/// Reasons of undecided conversions that are printed.
const REASONS: usize = 25;
/// Reasons of refusals that are printed, if they are asked for.
const REFUSALS: usize = 80;
/// The time that a program may take: more is a fault of its own. Small programs take milliseconds.
const BUDGET: Duration = Duration::from_secs(20);

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

fn drawn(dialect: &'static str, policy: Policy, seed: u64) -> Program {
    generate::program(dialect, policy, &mut Source::Seed(seed))
}

/// Tries a program; a panic is a fault like others.
fn tried(program: &Program) -> Trial {
    catch_unwind(|| trial::run(program))
        .unwrap_or_else(|_| Trial { faults: vec!["panicked".into()], ..Trial::default() })
}

/// The programs that are being tried, by seed, and since when.
#[derive(Default)]
struct Running {
    since: Mutex<BTreeMap<u64, Instant>>,
    done: AtomicBool,
}

impl Running {
    /// Tries a program; one that takes too long has a fault.
    fn tried(&self, seed: u64, program: &Program) -> Trial {
        self.since.lock().expect("nobody panics with it").insert(seed, Instant::now());
        let mut trial = tried(program);
        self.since.lock().expect("nobody panics with it").remove(&seed);
        if trial.took > BUDGET {
            trial.faults.push(format!("takes too long: {:?}", trial.took));
        }
        for fault in &trial.faults {
            eprintln!("seed {seed}: {}", fault.lines().next().unwrap_or_default());
        }
        trial
    }

    /// Names the programs that take too long while they run, so that an endless one is known by its seed.
    fn watch(&self) {
        while !self.done.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(200));
            let mut since = self.since.lock().expect("nobody panics with it");
            for (seed, start) in since.iter_mut().filter(|(_, start)| start.elapsed() > BUDGET) {
                eprintln!("seed {seed} still runs");
                *start = Instant::now();
            }
        }
    }
}

/// A reason without its numbers, names and places.
fn sort_of(reason: &Reason) -> String {
    let text = match reason.text.split_once(" was never ") {
        Some(_) => "a branch went one way only".into(),
        None => reason.text.chars().filter(|sign| !sign.is_ascii_digit()).take(90).collect::<String>(),
    };
    format!("{:?}: {text}", reason.why)
}

/// The first words of a fault without its target and numbers: what kind of fault it is.
fn kind(fault: &str) -> String {
    let first = fault.lines().next().unwrap_or_default();
    let first = first.split_once(": ").map_or(first, |(_, what)| what);
    first.chars().filter(|sign| !sign.is_ascii_digit() && !"-.".contains(*sign)).collect()
}

/// The smallest program found that shows a fault of the same kind.
fn smallest(program: Program, wanted: &str) -> Program {
    let (mut program, mut left) = (program, setting("MACROGLOT_SMALLER", SMALLER));
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
    let running = Running::default();
    std::thread::scope(|scope| {
        scope.spawn(|| running.watch());
        let found = catch_unwind(|| search(&running, programs, seed));
        running.done.store(true, Ordering::Relaxed);
        if let Err(what) = found {
            std::panic::resume_unwind(what);
        }
    });
}

fn search(running: &Running, programs: u64, seed: u64) {
    let start = Instant::now();
    let wanted = std::env::var("MACROGLOT_KINDS").unwrap_or_default();
    let kinds = DIALECTS.iter().flat_map(|dialect| Policy::ALL.map(|policy| (*dialect, policy)));
    // Left out, a kind keeps its place: the seeds of the others stay what they are.
    let kinds: Vec<(usize, (&str, Policy))> = kinds
        .enumerate()
        .filter(|(_, (dialect, policy))| format!("{dialect} {policy:?}").contains(&wanted))
        .collect();
    let mut table = String::new();
    let (mut all, mut useful) = (0, 0);
    let mut judgements: BTreeMap<(&str, Judgement), usize> = BTreeMap::new();
    let mut refusals: BTreeMap<(&str, String), usize> = BTreeMap::new();
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    let mut longest = (Duration::ZERO, 0);
    let mut faulty: Vec<(&str, Policy, u64, String)> = Vec::new();
    let verbose = std::env::var_os("MACROGLOT_REASONS").is_some();
    // All kinds at once: a slow program of one would else leave cores idle.
    let trials = kinds.par_iter().map(|(at, (dialect, policy))| {
        let trials = (0..programs).into_par_iter().map(|number| {
            let seed = seed.wrapping_add(((*at as u64) << 32) + number);
            (seed, running.tried(seed, &drawn(dialect, *policy, seed)))
        });
        trials.collect()
    });
    let trials: Vec<Vec<(u64, Trial)>> = trials.collect();
    for ((_, (dialect, policy)), trials) in kinds.into_iter().zip(trials) {
        let share = trials.iter().filter(|(_, trial)| trial.useful).count();
        let mut verdicts: BTreeMap<Judgement, usize> = BTreeMap::new();
        for (target, judgement) in trials.iter().flat_map(|(_, trial)| &trial.judged) {
            *verdicts.entry(*judgement).or_default() += 1;
            *judgements.entry((target, *judgement)).or_default() += 1;
        }
        for (seed, trial) in &trials {
            longest = longest.max((trial.took, *seed));
            let sorts: BTreeSet<_> = trial.refusals.iter().cloned().collect();
            sorts.into_iter().for_each(|sort| *refusals.entry(sort).or_default() += 1);
            if verbose {
                let told = trial.reasons.iter().map(|reason| format!("{:?}: {}", reason.why, reason.text));
                told.for_each(|reason| eprintln!("{dialect} {policy:?} seed {seed} undecided: {reason}"));
            }
            let sorts: BTreeSet<String> = trial.reasons.iter().map(sort_of).collect();
            sorts.into_iter().for_each(|sort| *reasons.entry(sort).or_default() += 1);
        }
        (all, useful) = (all + trials.len(), useful + share);
        let _ = writeln!(table, "{dialect:6} {policy:12?} useful {share:6}/{programs} {verdicts:?}");
        for (seed, trial) in trials {
            faulty.extend(trial.faults.into_iter().map(|fault| (dialect, policy, seed, fault)));
        }
        eprintln!("{dialect} {policy:?}: {} faults, {:?}", faulty.len(), start.elapsed());
    }
    println!(
        "{table}seed {seed}, {programs} programs of each: {useful} of {all} useful, {judgements:?}, {:?}; longest {:?}, seed {}",
        start.elapsed(),
        longest.0,
        longest.1,
    );
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by_key(|(_, times)| std::cmp::Reverse(*times));
    for (reason, times) in reasons.iter().take(REASONS) {
        println!("{times:7} programs undecided: {reason}");
    }
    let mut refusals: Vec<_> = refusals.into_iter().collect();
    refusals.sort_by_key(|(_, times)| std::cmp::Reverse(*times));
    for ((target, why), times) in refusals.iter().take(if verbose { REFUSALS } else { 0 }) {
        println!("{times:7} programs refused for {target}: {why}");
    }
    let mut shown = String::new();
    let mut seen: BTreeMap<(&str, String, String), usize> = BTreeMap::new();
    for (dialect, policy, seed, fault) in &faulty {
        let times = seen.entry((dialect, format!("{policy:?}"), kind(fault))).or_default();
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
        assert!(trial::run(&program).faults.is_empty());
    }
}

/// Five brackets are what one of the controls takes: two for each root, so that roots in roots are spelled otherwise.
#[test]
fn programs_are_spelled_in_five_brackets() {
    let mut deepest = 0;
    for dialect in ["fanuc", "haas"] {
        for (policy, seed) in
            [Policy::DeepDo, Policy::NearRounding].into_iter().zip([34_359_759_964, 42_949_695_699])
        {
            for seed in seed..seed + 400 {
                for line in drawn(dialect, policy, seed).text().lines() {
                    let mut depth = 0;
                    for sign in line.chars() {
                        depth += i32::from(sign == '[') - i32::from(sign == ']');
                        deepest = deepest.max(depth);
                        assert!(depth <= 5, "{dialect} {policy:?} seed {seed}: {line}");
                    }
                }
            }
        }
    }
    assert!(deepest >= 4, "roots in roots are drawn");
}
