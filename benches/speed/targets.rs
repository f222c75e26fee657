//! What is wanted of one core, and how far it is reached.

use super::measured::Use;

/// How many small programs are converted and verified.
pub const SMALL: usize = 1000;

/// Blocks a second that LinuxCNC's interpreter ran at the most, on the same kind of machine: it cannot be run in a bench.
const LINUXCNC: f64 = 125_000.0;

/// What is compared of a case: MB/s, blocks a second, seconds, or bytes a byte of its input.
#[derive(Clone, Copy)]
enum What {
    Speed,
    Blocks,
    Seconds,
    Memory,
}
use What::{Blocks, Memory, Seconds, Speed};

/// The case, its input, and what is wanted: the least of speeds, the most of seconds and memory.
const WANTED: &[(&str, &str, What, f64)] = &[
    ("parse", "surface.nc", Speed, 135.0),
    ("parse", "macros.nc", Speed, 30.0),
    ("parse", "unlike.nc", Speed, 25.0),
    ("convert to haas", "surface.nc", Speed, 60.0),
    ("convert to haas", "macros.nc", Speed, 10.0),
    ("convert to haas", "surface.nc", Memory, 10.0),
    ("convert to haas", "macros.nc", Memory, 10.0),
    ("verify", "small", Seconds, 15.0),
    ("run", "moving-1M.nc", Blocks, 3.0 * LINUXCNC),
    ("print", "moving-1M.nc", Memory, 10.0),
];

/// Prints each target with what was measured, and a ratio that is 1 or more where it is reached. Of a case the length of
/// its input, in MB, stands in the place of its wall time.
pub fn print(cases: &[(&str, &str, Use)]) {
    println!("\n| target | input | wanted | measured | reached |\n|---|---|---|---|---|");
    for (case, input, what, wanted) in WANTED {
        let Some((.., used)) = cases.iter().find(|(name, of, _)| (name, of) == (case, input)) else {
            continue;
        };
        let (unit, measured) = match what {
            Speed => ("MB/s", used.wall / used.cpu),
            Blocks => ("blocks/s", used.steps / used.cpu),
            Seconds => ("s", used.cpu),
            Memory => ("times the input", used.peak / 1e6 / used.wall),
        };
        let ratio = match what {
            Speed | Blocks => measured / wanted,
            Seconds | Memory => wanted / measured,
        };
        println!("| {case} | {input} | {wanted:.0} {unit} | {measured:.1} | {ratio:.2} |");
    }
}
