//! What a run makes of the leavings of one that was interrupted, be they damaged or somebody else's.

use super::{CLEAN, Shop};

const TO: &str = "--from fanuc --to haas";

/// What lies in an output folder may come from elsewhere, the journal of a run too.
#[cfg(unix)]
#[test]
fn a_forged_journal_changes_nothing_elsewhere() {
    let forged = [
        ("journal", r#"{"place":"../else/keep","new":".macroglot/new-0"}"#),
        ("journal", r#"{"place":"PLACE/else/keep","new":".macroglot/new-0"}"#),
        ("journal", r#"{"place":"PLACE/else/keep","new":"PLACE/other"}"#),
        ("journal", r#"{"place":"../else/keep"}"#),
        ("journal", r#"{"place":"x","old":"x","aside":"../else/new"}"#),
        ("journal", r#"{"place":"told/keep","new":".macroglot/new-0"}"#),
        ("journal", r#"{"place":"x","new":"../other"}"#),
        ("back", r#"{"place":"../else/keep","old":".macroglot/new-0"}"#),
        ("back", r#"{"place":"PLACE/else/keep"}"#),
        ("back", r#"{"place":"told/keep","old":".macroglot/new-0"}"#),
        ("back", r#"{"place":"x","aside":"../else/keep"}"#),
        ("done", r#"{"place":"../else/keep"}"#),
        // Nothing but the files of that run goes anywhere, and never onto the folder itself.
        ("journal", r#"{"place":"","new":".macroglot/new-0"}"#),
        ("journal", r#"{"place":".","new":".macroglot/new-0"}"#),
        ("journal", r#"{"place":".macroglot/new-0","new":".macroglot/new-0"}"#),
        ("journal", r#"{"place":"y","new":"x"}"#),
        ("journal", r#"{"place":"y","new":".macroglot/new-0","old":"x"}"#),
        ("back", r#"{"place":"y","old":"x"}"#),
    ];
    for (name, step) in forged {
        let shop = Shop::with(&[("a.nc", CLEAN), ("out/x", "X"), ("else/keep", "KEEP"), ("other", "OTHER")]);
        std::os::unix::fs::symlink(shop.path("else"), shop.path("out/told")).unwrap();
        shop.write("out/.macroglot/new-0", b"BAD");
        let step = step.replace("PLACE", &shop.path("").display().to_string());
        shop.write(&format!("out/.macroglot/{name}"), format!(r#"{{"steps":[{step}]}}"#).as_bytes());
        shop.fails(&format!("convert a.nc {TO} --out out"), &["no run of macroglot does that"]);
        let kept = ["else/keep", "other", "out/x"].map(|path| shop.read(path));
        assert_eq!(kept, ["KEEP", "OTHER", "X"], "{name} {step}");
        assert!(!shop.path("else/new").exists(), "{name} {step}");
    }
    // An old text beside a name elsewhere is not put there, and this folder is brought back.
    let shop = Shop::with(&[("a.nc", CLEAN), ("else/keep", "KEEP"), ("out/.macroglot/old-0", "BAD")]);
    let step = r#"{"place":"PLACE/else/keep","new":"PLACE/else/.macroglot-1-0","old":".macroglot/old-0"}"#;
    let step = step.replace("PLACE", &shop.path("").display().to_string());
    shop.write("out/.macroglot/back", format!(r#"{{"steps":[{step}]}}"#).as_bytes());
    assert_eq!(shop.run(&format!("convert a.nc {TO} --out out")).code, 0);
    assert_eq!(shop.read("else/keep"), "KEEP");
    assert!(!shop.path("out/.macroglot").exists());
}

/// What a run is to be finished by may be damaged: then nothing is changed, and the file is named.
#[test]
fn a_damaged_journal_is_named() {
    let texts: [&[u8]; 7] =
        [b"", b"\xff\xfe\0\x01", b"{\"steps\":[", b"null", b"{}", b"<<<<<<< ours", b"{\"steps\":7}"];
    for name in ["journal", "back", "done", "outside"] {
        for text in texts {
            let shop = Shop::with(&[("a.nc", CLEAN), ("out/a.nc", "OLD"), ("out/.macroglot/old-0", "OLDER")]);
            let path = format!("out/.macroglot/{name}");
            shop.write(&path, text);
            let words = [
                path.as_str(),
                "cannot be understood",
                "nothing was written",
                "Move out/.macroglot elsewhere",
            ];
            shop.fails(&format!("convert a.nc {TO} --out out"), &words);
        }
    }
    // What is told helps.
    let shop = Shop::with(&[("a.nc", CLEAN), ("out/a.nc", "OLD"), ("out/.macroglot/journal", "{")]);
    shop.fails(&format!("convert a.nc {TO} --out out"), &["journal"]);
    std::fs::rename(shop.path("out/.macroglot"), shop.path("saved")).unwrap();
    assert_eq!(shop.run(&format!("convert a.nc {TO} --out out")).code, 0);
    assert!(shop.read("out/a.nc").contains("O1234"));
}

/// A folder or a pipe in the place of a journal is said, not waited for, and what no run left there is not removed.
#[cfg(unix)]
#[test]
fn what_no_run_left_stays() {
    for name in ["journal", "back", "done", "outside"] {
        let shop = Shop::with(&[("a.nc", CLEAN), ("out/.macroglot/new-0", "")]);
        let made = std::process::Command::new("mkfifo").arg(shop.path("out/.macroglot").join(name)).status();
        assert!(made.unwrap().success());
        let run = shop.run(&format!("convert a.nc {TO} --out out"));
        assert!(
            run.code == 2 && run.err.contains(name) && run.err.contains("it is not a file"),
            "{}",
            run.err
        );
    }
    let line = format!("convert a.nc {TO} --out out");
    for name in ["notes.txt", "new-", "new-1x", "old", "journal/x", "new-1/x"] {
        let path = format!("out/.macroglot/{name}");
        let shop = Shop::with(&[("a.nc", CLEAN), (&path, "MINE"), ("out/.macroglot/new-0", "")]);
        shop.fails(
            &line,
            &["out/.macroglot/", "is not something that a run of macroglot leaves", "nothing was written"],
        );
        assert_eq!(shop.read(&path), "MINE");
    }
    let shop = Shop::with(&[("a.nc", CLEAN), ("out/.macroglot", "MINE")]);
    shop.fails(&line, &["out/.macroglot: cannot be written: it is not a folder"]);
    // Nor is anything written by a link there.
    let shop = Shop::with(&[("a.nc", CLEAN), ("out/x", "X"), ("else/journal", "{\"steps\":[]}")]);
    std::os::unix::fs::symlink(shop.path("else"), shop.path("out/.macroglot")).unwrap();
    shop.fails(&line, &["out/.macroglot: cannot be written: it is not a folder"]);
    let shop = Shop::with(&[("a.nc", CLEAN), ("out/x", "X")]);
    std::os::unix::fs::symlink(shop.path("nowhere"), shop.path("out/.macroglot")).unwrap();
    let run = shop.run(&line);
    assert!(run.code == 2 && run.err.contains("it is not a folder"), "{}", run.err);
    assert!(!shop.path("nowhere").exists());
}

/// A file that never went is not put back: in a shared folder it may be another user's, and stay.
#[cfg(unix)]
#[test]
fn what_never_went_is_left_alone() {
    use std::os::unix::fs::MetadataExt;
    let shop = Shop::with(&[
        ("b.nc", CLEAN),
        ("out/a.nc", "OLD"),
        ("out/.macroglot/old-0", "OLD"),
        ("out/.macroglot/old-1", "OLD"),
    ]);
    shop.write("out/c.nc", b"NEW");
    let steps = r#"{"steps":[{"place":"a.nc","new":".macroglot/new-0","old":".macroglot/old-0"},
        {"place":"c.nc","new":".macroglot/new-1","old":".macroglot/old-1"}]}"#;
    shop.write("out/.macroglot/back", steps.as_bytes());
    let number = || std::fs::metadata(shop.path("out/a.nc")).unwrap().ino();
    let before = number();
    let run = shop.run(&format!("convert b.nc {TO} --out out"));
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!((number(), shop.read("out/c.nc").as_str()), (before, "OLD"));
    assert!(!shop.path("out/.macroglot").exists());
}
