//! Several runs into one folder, one at a time.

use super::{Files, Shop, leavings};
use std::process::Stdio;

fn program(number: usize) -> Vec<u8> {
    format!("%\nO{number:04}\nG20 G17 G90 G40 G80 G94\nG0 X{number}.\n#101=#100\nG1 X#101 F10.\nM30\n%\n")
        .into_bytes()
}

fn line(at: usize) -> String {
    format!("convert in{at} --from fanuc --to haas --out out --quiet")
}

/// What runs of different libraries leave does not hang on which of them was first: all of each is there.
#[test]
fn at_once() {
    for runs in [2, 4] {
        let files: Files = (0..runs).map(|at| (format!("in{at}/p{at}.nc"), program(at + 1))).collect();
        let one_by_one = Shop::with(&files);
        for at in 0..runs {
            assert_eq!(one_by_one.run(&line(at), "").code, Some(0));
        }
        let shop = Shop::with(&files);
        let spawn = |at| {
            let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_macroglot"));
            command.args(line(at).split_whitespace()).current_dir(shop.path("")).stdout(Stdio::piped());
            command.stderr(Stdio::piped()).spawn().unwrap()
        };
        let started: Vec<_> = (0..runs).map(spawn).collect();
        for run in started {
            let output = run.wait_with_output().unwrap();
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        }
        let (found, wanted) = (shop.files(), one_by_one.files());
        assert!(leavings(&found).is_empty());
        assert!(found == wanted, "{:?}", super::parted(&found, &wanted));
    }
}

/// A folder that is held is waited for, and who waits says so; what is interrupted meanwhile leaves nothing.
#[cfg(unix)]
#[test]
fn held_by_another() {
    use std::io::{BufRead, BufReader, Read};
    let files: Files = [("in0/p.nc".to_owned(), program(1)), ("out/x".to_owned(), Vec::new())].into();
    let shop = Shop::with(&files);
    let held = std::fs::File::open(shop.path("out")).unwrap();
    held.lock().unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_macroglot"));
    command.args(line(0).split_whitespace()).current_dir(shop.path(""));
    let mut run = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut told = BufReader::new(run.stderr.take().unwrap());
    let mut first = String::new();
    told.read_line(&mut first).unwrap();
    assert_eq!(first, "macroglot: another run is writing to out; waiting for it to end\n");
    assert_eq!(shop.files(), files, "it waits");
    drop(held);
    let mut rest = String::new();
    told.read_to_string(&mut rest).unwrap();
    assert!(run.wait().unwrap().success(), "{rest}");
    assert!(shop.files().contains_key("out/p.nc"));
}
