//! Standard output that cannot be written, and standard error that nobody reads.
#![cfg(target_os = "linux")]

use super::{Files, Shop};
use std::fs::File;
use std::process::{Command, Stdio};

const CLEAN: &[u8] = b"%\nO1234\nG20 G17 G90 G40 G80 G94\nG0 X1.\nG1 X2. F10.\nM30\n%\n";
const REFUSED: &[u8] = b"%\nO1234\nG20 G17 G90 G40 G80 G94\nG0 X1.\nM38\nM30\n%\n";

fn shop(program: &[u8]) -> Shop {
    Shop::with(&Files::from([("a.nc".to_owned(), program.to_vec())]))
}

fn run(shop: &Shop, line: &str, out: Stdio, err: Stdio) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_macroglot"));
    command.args(line.split_whitespace()).current_dir(shop.path("")).stdout(out).stderr(err).output().unwrap()
}

/// Every command that prints data.
const COMMANDS: &[&str] = &[
    "convert a.nc --from fanuc --to haas",
    "convert a.nc --from fanuc --to haas --out out",
    "convert a.nc --from fanuc --to haas --out out --format json",
    "convert a.nc --from fanuc --to haas --out out --format sarif",
    "parse a.nc --dialect fanuc",
    "parse a.nc --dialect fanuc --format json",
    "run a.nc --dialect fanuc",
    "run a.nc --dialect fanuc --trace json",
    "ir a.nc --dialect fanuc",
    "verify a.nc a.nc --from fanuc --to fanuc",
    "dialects",
    "dialects haas",
    "explain",
    "explain MG0301",
    "completions bash",
    "--help",
    "convert --help",
    "--version",
];

#[test]
fn a_full_disk_is_an_error() {
    for line in COMMANDS {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let run = run(&shop(CLEAN), line, full.into(), Stdio::piped());
        let told = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{line}: {told}");
        assert!(told.contains("standard output cannot be written"), "{line}: {told}");
    }
}

/// A reader that has seen enough is no fault, and one of standard error never is.
#[test]
fn a_reader_that_is_gone_is_none() {
    let gone = || {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        writer
    };
    for line in COMMANDS {
        let run = run(&shop(CLEAN), line, gone().into(), Stdio::piped());
        assert_eq!(run.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&run.stderr));
    }
    let line = "convert a.nc --from fanuc --to haas --out out";
    for (program, code) in [(CLEAN, 0), (REFUSED, 1)] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        assert_eq!(run(&shop(program), line, Stdio::piped(), gone().into()).status.code(), Some(code));
        assert_eq!(run(&shop(program), line, Stdio::piped(), full.into()).status.code(), Some(code));
    }
}

/// What is printed to nowhere is lost.
#[test]
fn a_closed_standard_output_is_an_error() {
    for line in COMMANDS {
        let shop = shop(CLEAN);
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("exec '{}' {line} >&-", env!("CARGO_BIN_EXE_macroglot"))]);
        let run = shell.current_dir(shop.path("")).output().unwrap();
        let told = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{line}: {told}");
        assert!(told.contains("standard output is closed"), "{line}: {told}");
    }
}

/// The null device is a choice, however it was opened: many callers open it both ways.
#[test]
fn what_is_thrown_away_on_purpose_is_none() {
    for line in COMMANDS {
        for both_ways in [false, true] {
            let null = File::options().write(true).read(both_ways).open("/dev/null").unwrap();
            let run = run(&shop(CLEAN), line, null.into(), Stdio::piped());
            assert_eq!(run.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&run.stderr));
        }
    }
}
