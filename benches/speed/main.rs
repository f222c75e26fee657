//! `cargo bench`: speed and memory of every stage, as ratios of one run. BENCHMARKS.md has the figures.
//!
//! Every case runs in a process of its own, which is this one again with the case's name in the environment: so its
//! peak memory is its own, and its processor time does not hang on what else the machine does. Rounds of all cases are
//! interleaved, and medians printed.

extern crate alloc; // what pest derives names it

mod inputs;
#[path = "../measured/mod.rs"]
mod measured;
#[allow(dead_code, reason = "the other bench measures the rest")]
#[path = "../shapes/inputs.rs"]
mod shapes;
mod targets;

use macroglot::control::{Library, LoadedFile, ProgramRef, Scenario};
use macroglot::dialect::Control;
use macroglot::syntax::ParsedFile;
use measured::Use;
use pest::Parser;
use std::ffi::OsStr;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The grammar without the hand reader beside it.
#[allow(missing_docs)]
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "grammar/macro_b.pest"]
    #[grammar = "grammar/fanuc.pest"]
    pub struct Grammar;
}
use grammar::{Grammar, Rule};

/// A case: its name, its input, and the arguments of the command where it is one.
const CASES: &[(&str, &str, &[&str])] = &[
    ("newlines", "surface.nc", &[]),
    ("newlines", "macros.nc", &[]),
    ("parse", "surface.nc", &["parse", "--dialect", "fanuc"]),
    ("parse", "macros.nc", &["parse", "--dialect", "fanuc"]),
    ("parse", "unlike.nc", &["parse", "--dialect", "fanuc"]),
    ("grammar alone", "surface.nc", &[]),
    ("grammar alone", "macros.nc", &[]),
    ("convert to haas", "surface.nc", &["convert", "--from", "fanuc", "--to", "haas"]),
    ("convert to haas", "macros.nc", &["convert", "--from", "fanuc", "--to", "haas"]),
    ("convert to fanuc", "fadal.nc", &["convert", "--from", "fadal", "--to", "fanuc"]),
    ("verify", "small", &["convert", "--from", "fanuc", "--to", "haas"]),
    ("run", "counting-100k.nc", &[]),
    ("run", "counting-1M.nc", &[]),
    ("run", "moving-100k.nc", &[]),
    ("run", "moving-1M.nc", &[]),
    ("print", "moving-1M.nc", &["run", "--dialect", "fanuc", "--steps", "10000000"]),
];

/// A folder with files to measure in the place of those that are written here, by the same names.
const FILES: &str = "MACROGLOT_FILES";

const ROUNDS: usize = 3;
/// Bytes of a program that are read at a time while it runs.
const PIECE: usize = 32 << 10;
/// How often lines are counted in a round: once is too short for the clock.
const COUNTS: usize = 100;

fn main() -> ExitCode {
    if let Some(case) = measured::case() {
        return measured::tell(|| work(&case));
    }
    let folder = std::env::temp_dir().join(format!("macroglot-speed-{}", std::process::id()));
    let done = generate(&folder).and_then(|()| measure(&folder));
    let _ = fs::remove_dir_all(&folder);
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn generate(folder: &Path) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    let given = std::env::var_os(FILES).map(PathBuf::from);
    let write = |name: &str, text: String| match given.as_ref().map(|given| given.join(name)) {
        Some(given) if given.is_file() => fs::copy(given, folder.join(name)).map(drop),
        _ => fs::write(folder.join(name), text),
    };
    write("surface.nc", inputs::surface(50_000_000))?;
    write("macros.nc", inputs::macros(10_000_000))?;
    write("unlike.nc", inputs::unlike(10_000_000))?;
    write("fadal.nc", inputs::fadal(2_000_000))?;
    measured::files(&shapes::library(targets::SMALL), &folder.join("small"))?;
    for (name, steps) in [("100k", 100_000), ("1M", 1_000_000)] {
        write(&format!("counting-{name}.nc"), inputs::counting(steps))?;
        write(&format!("moving-{name}.nc"), inputs::moving(steps))?;
    }
    Ok(())
}

fn measure(folder: &Path) -> std::io::Result<()> {
    println!("seeds: {:?}; {ROUNDS} rounds, medians", inputs::SEEDS);
    let mut found = vec![[Vec::new(), Vec::new()]; CASES.len()];
    for _ in 0..ROUNDS {
        for (at, (name, input, arguments)) in CASES.iter().enumerate() {
            for (threads, rounds) in [1, 0].into_iter().zip(&mut found[at]) {
                if threads == 1 || !arguments.is_empty() {
                    rounds.push(run(name, &folder.join(input), arguments, threads)?);
                }
            }
        }
    }
    println!(
        "| case | input | MB/s a core | times the floor | all cores over one | peak memory over input |"
    );
    println!("|---|---|---|---|---|---|");
    let mut floor = 0.0;
    let (mut runs, mut reached) = (Vec::new(), Vec::new());
    for ((name, input, _), [one, all]) in CASES.iter().zip(&found) {
        let length = length(&folder.join(input))? as f64 / 1e6;
        let median = |rounds: &[Use], of: fn(&Use) -> f64| {
            let mut all: Vec<f64> = rounds.iter().map(of).collect();
            all.sort_by(f64::total_cmp);
            all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
        };
        let (cpu, peak, steps) = (median(one, |u| u.cpu), median(one, |u| u.peak), median(one, |u| u.steps));
        reached.push((*name, *input, Use { cpu, peak, steps, wall: length }));
        if steps > 0.0 {
            runs.push(format!("| {input} | {:.2} | {:.0} |", steps / cpu / 1e6, peak / 1e6));
            continue;
        }
        let speed = length / cpu;
        if *name == "newlines" {
            floor = speed;
        }
        let scale = median(one, |u| u.wall) / median(all, |u| u.wall);
        let scale = if scale.is_nan() { String::new() } else { format!("{scale:.1}") };
        println!(
            "| {name} | {input} | {speed:.1} | {:.0} | {scale} | {:.2} |",
            floor / speed,
            peak / 1e6 / length
        );
    }
    println!("\n| run | million blocks/s a core | peak memory, MB |\n|---|---|---|");
    runs.iter().for_each(|row| println!("{row}"));
    targets::print(&reached);
    Ok(())
}

/// The bytes of a file, or of the files in a folder.
fn length(path: &Path) -> std::io::Result<u64> {
    if !path.is_dir() {
        return Ok(fs::metadata(path)?.len());
    }
    fs::read_dir(path)?.map(|file| Ok(file?.metadata()?.len())).sum()
}

/// Runs a case in a process of its own.
fn run(name: &str, input: &Path, arguments: &[&str], threads: usize) -> std::io::Result<Use> {
    let (input, out) = (input.as_os_str(), input.with_extension("out").into_os_string());
    let mut all: Vec<&OsStr> = match arguments {
        [] => vec![input],
        [first, rest @ ..] => {
            [OsStr::new(first), input].into_iter().chain(rest.iter().map(OsStr::new)).collect()
        }
    };
    if name.starts_with("convert") {
        all.push(OsStr::new("--no-verify"));
    }
    if arguments.first() == Some(&"convert") {
        all.extend(["--format", "json", "--out"].map(OsStr::new).into_iter().chain([out.as_os_str()]));
    }
    measured::run(name, &all, threads)
}

/// The work of a case: how often it was repeated, and how many blocks it ran.
fn work(case: &str) -> (usize, u64) {
    let file = || std::env::args_os().nth(1).map(PathBuf::from).and_then(|path| fs::read(path).ok());
    match case {
        "newlines" => {
            let bytes = file().unwrap_or_default();
            for _ in 0..COUNTS {
                black_box(memchr::memchr_iter(b'\n', black_box(&bytes)).count());
            }
            return (COUNTS, 0);
        }
        "grammar alone" => {
            let bytes = file().unwrap_or_default();
            for line in String::from_utf8_lossy(&bytes).lines().filter(|line| !line.is_empty()) {
                drop(black_box(Grammar::parse(Rule::block, line)));
            }
        }
        "run" => return (1, emulate(&file().unwrap_or_default()).unwrap_or(0)),
        _ => drop(macroglot::cli::main()),
    }
    (1, 0)
}

/// Runs a program on the emulated control as `macroglot run` does, but for the printing: blocks are read where the run
/// comes to them, and nobody keeps events. How many blocks it ran.
fn emulate(bytes: &[u8]) -> Option<u64> {
    let control = Control::plain("fanuc")?;
    let entry = control.entry();
    let (parsed, execute) = (ParsedFile::unread(bytes), entry.execute?);
    let files = [LoadedFile { name: "main.nc", parsed: &parsed }];
    let library = Library::read_by_need(&files, entry.parse_items, PIECE);
    let scenario = Scenario { steps: 10_000_000, events: 10_000_000, ..Scenario::default() };
    let run = std::thread::scope(|scope| {
        let (listener, heard) = std::sync::mpsc::sync_channel(4);
        scope.spawn(|| heard.into_iter().for_each(drop));
        let run = execute(&library.heard_by(&listener), ProgramRef::FIRST, &control, &scenario);
        drop(listener);
        run
    });
    Some(run.steps)
}
