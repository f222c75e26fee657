//! `cargo bench --bench shapes`: how the time of shapes grows that are hard on some step. BENCHMARKS.md has the figures.
//!
//! Each shape is measured at a size and at ten times that, on one thread. The growth exponent is the power of the size that
//! the time goes by: 1 where it goes by the size, 2 where by its square. Budgets of a verification (runs, blocks, time) may
//! stop it early; then it is less than 1.

mod inputs;
#[path = "../measured/mod.rs"]
mod measured;

use measured::Use;
use std::path::Path;
use std::process::ExitCode;
use std::{fs, io};

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// A shape: its name, the smaller size and what that counts, its program, and what is done with it.
type Shape = (&'static str, usize, &'static str, fn(usize) -> String, Done);

/// What is done with a program.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Done {
    /// Converted between two dialects, and verified.
    Verified(&'static str, &'static str),
    /// Converted, with a report as a page.
    Converted,
    /// The same of a folder, each program a file of its own.
    Library(&'static str, &'static str),
    /// Verified against itself.
    Itself,
}

/// The largest growth exponent that is wanted.
const MOST: f64 = 1.05;

const MILL: Done = Done::Verified("fanuc", "haas");

const SHAPES: &[Shape] = &[
    ("a chain of calls", 1_000, "lines", inputs::chain, MILL),
    ("chains of three calls", 1_000, "lines", inputs::short_chains, MILL),
    ("WHILE one after the other", 10_000, "lines", inputs::whiles, MILL),
    ("IF-THEN one after the other", 10_000, "lines", inputs::ifs, MILL),
    ("IF-GOTO one after the other", 10_000, "lines", inputs::jumps, MILL),
    ("calls of subroutines", 10_000, "lines", inputs::subs, Done::Verified("fadal", "fanuc")),
    ("small programs, each a file", 100, "programs", inputs::library, Done::Library("fanuc", "haas")),
    ("the same for a Fadal", 100, "programs", inputs::library, Done::Library("fanuc", "fadal")),
    ("small programs in one file", 100, "programs", inputs::library, MILL),
    ("programs verified against themselves", 37, "programs", inputs::programs, Done::Itself),
    ("nested DO", 10_000, "lines", inputs::nested, Done::Converted),
    ("lines that cannot be read", 10_000, "lines", inputs::faulty, Done::Converted),
    ("findings on one line", 1_000, "findings", inputs::findings, Done::Converted),
    ("a comment", 1_000_000, "bytes", inputs::comment, Done::Converted),
    ("twenty comments, each", 26_000, "bytes", inputs::comments, Done::Converted),
    ("a line", 2_000_000, "bytes", inputs::line, Done::Converted),
];

fn main() -> ExitCode {
    if measured::case().is_some() {
        return measured::tell(|| {
            let _ = macroglot::cli::main();
            (1, 0)
        });
    }
    let folder = std::env::temp_dir().join(format!("macroglot-shapes-{}", std::process::id()));
    let done = fs::create_dir_all(&folder).and_then(|()| measure(&folder));
    let _ = fs::remove_dir_all(&folder);
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn measure(folder: &Path) -> io::Result<()> {
    println!(
        "| shape | n | seconds | 10 n | seconds | growth exponent | over {MOST} | peak memory at 10 n, MB |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|");
    for (name, n, unit, program, done) in SHAPES {
        let [small, large] = [*n, 10 * n].map(|n| run(name, &program(n), *done, folder));
        let (small, large) = (small?, large?);
        let exponent = (large.cpu / small.cpu).log10();
        println!(
            "| {name} | {n} {unit} | {:.2} | {} {unit} | {:.2} | {exponent:.2} | {:.2} | {:.0} |",
            small.cpu,
            10 * n,
            large.cpu,
            exponent / MOST,
            large.peak / 1e6
        );
    }
    Ok(())
}

/// What a program takes.
fn run(name: &str, text: &str, done: Done, folder: &Path) -> io::Result<Use> {
    let folder = folder.join(name.replace(' ', "-")).join(text.len().to_string());
    fs::create_dir_all(&folder)?;
    let input = match done {
        Done::Library(..) => measured::files(text, &folder.join("in"))?,
        _ => {
            fs::write(folder.join("shape.nc"), text)?;
            folder.join("shape.nc")
        }
    };
    let path = |path: &Path| path.to_string_lossy().into_owned();
    let (input, out, page) = (path(&input), path(&folder.join("out")), path(&folder.join("report.html")));
    let (input, out, page) = (input.as_str(), out.as_str(), page.as_str());
    let arguments = match done {
        Done::Verified(from, to) | Done::Library(from, to) => {
            vec!["convert", input, "--from", from, "--to", to, "--out", out]
        }
        Done::Converted => {
            let to = ["convert", input, "--from", "fanuc", "--to", "haas", "--no-verify"];
            to.into_iter().chain(["--out", out, "--report", page]).collect()
        }
        Done::Itself => vec!["verify", input, input, "--from", "haas", "--to", "haas"],
    };
    measured::run(name, &arguments, 1)
}
