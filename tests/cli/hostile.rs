//! Folders, names and places that are made to lose something: nothing is written but what was asked for, where it was.

use super::{CLEAN, REFUSED, Shop, names};

const TO: &str = "--from fanuc --to haas";

fn numbered(number: u32) -> String {
    CLEAN.replace("O1234", &format!("O{number}"))
}

/// What file systems of shop computers take for one name, or for a name with others in it.
#[cfg(target_os = "linux")]
#[test]
fn two_names_for_one_place() {
    for (one, other) in [
        ("a/b.nc", "a\\b.nc"),
        ("sub/A.nc", "SUB/a.nc"),
        ("sub/a.nc", "sub. /a.nc"),
        ("a.nc", "A.nc/b.nc"),
        ("a.nc", "a.nc.certificate.json/b.nc"),
        ("a.nc", "macroglot.lock/b.nc"),
    ] {
        let files = [(format!("one/{one}"), numbered(1)), (format!("two/{other}"), numbered(2))];
        let shop = Shop::with(&[(&files[0].0, &files[0].1), (&files[1].0, &files[1].1)]);
        let words = ["would both be written to", "nothing was written"];
        let run = shop.run(&format!("convert one two {TO} --out out"));
        assert_eq!(run.code, 2, "{one} {other}: {}", run.out);
        words.iter().for_each(|word| assert!(run.err.contains(word), "{one} {other}: {}", run.err));
        assert!(!shop.path("out").exists());
    }
}

/// A link in the output folder may lead to another place in it.
#[cfg(unix)]
#[test]
fn two_ways_to_one_place() {
    for (to, one) in [(".", "in/a.nc"), ("y", "in/y/a.nc")] {
        let shop = Shop::with(&[(one, CLEAN), ("in/sub/a.nc", &numbered(2)), ("out/y/x", "")]);
        std::os::unix::fs::symlink(to, shop.path("out/sub")).unwrap();
        let run = shop.run(&format!("convert in {TO} --out out"));
        assert!(run.code == 2 && run.err.contains("would both be written to"), "{}{}", run.out, run.err);
        assert!(!shop.path("out/macroglot.lock").exists() && !shop.path("out/a.nc").exists());
    }
}

#[test]
fn a_folder_in_another_library_s_folder() {
    let project = "[machines.f]\ndialect = \"fanuc\"\n[machines.h]\ndialect = \"haas\"\n\
        [libraries.one]\npath = \"one\"\nmachine = \"f\"\ntargets = { h = \"out\" }\n\
        [libraries.two]\npath = \"two\"\nmachine = \"f\"\ntargets = { h = \"out/sub\" }\n";
    let files = [("macroglot.toml", project), ("one/sub/a.nc", CLEAN), ("two/a.nc", &numbered(2))];
    let shop = Shop::with(&files);
    shop.fails("convert", &["out/sub/a.nc", "two libraries", "nothing was written"]);
    std::fs::rename(shop.path("two/a.nc"), shop.path("two/b.nc")).unwrap();
    assert_eq!(shop.run("convert").code, 0);
    assert!(shop.read("out/sub/a.nc").contains("O1234") && shop.read("out/sub/b.nc").contains("O0002"));
}

/// A manifest may come from elsewhere, or be edited: what it names goes only if it is in the folder.
#[cfg(unix)]
#[test]
fn a_forged_manifest_removes_nothing_elsewhere() {
    for (name, word) in [
        ("../else/keep", "not a file of the folder"),
        ("PLACE/else/keep", "not a file of the folder"),
        ("x/../../else/keep", "not a file of the folder"),
        ("", "not a file of the folder"),
        ("told/keep", "outside the output folder"),
    ] {
        let shop = Shop::with(&[("in/a.nc", CLEAN), ("else/keep", "KEEP"), ("out/x/y", "")]);
        std::os::unix::fs::symlink(shop.path("else"), shop.path("out/told")).unwrap();
        let name = name.replace("PLACE", &shop.path("").display().to_string());
        let entry = "kind = \"program\"\nsource = \"gone.nc\"\nat = \"../gone.nc\"\nsha256 = \"00\"";
        shop.write(
            "out/macroglot.manifest",
            format!("version = 1\n[files.\"{name}\"]\n{entry}\n").as_bytes(),
        );
        shop.fails(&format!("convert in {TO} --out out --prune"), &[word]);
        assert_eq!(shop.read("else/keep"), "KEEP");
    }
}

/// A report goes to no place that a program has, or had from an earlier run, nor among the files of a run under way.
#[test]
fn a_report_is_kept_apart() {
    let shop = Shop::with(&[("in/a.txt", CLEAN), ("in/b.txt", &numbered(2))]);
    assert_eq!(shop.run(&format!("convert in {TO} --out out")).code, 0);
    for (report, word) in [
        ("out/a.txt", "where a program goes"),
        ("out/sub/../A.txt", "where a program goes"),
        ("out/a.txt.certificate.json", "where a program goes"),
        ("out/.macroglot/r.json", "while it writes"),
        ("out/.macroglot/sub/r.json", "while it writes"),
        (".macroglot-1-0.json", "while it writes"),
    ] {
        shop.fails(&format!("convert in/b.txt {TO} --out out --report {report}"), &[word]);
    }
    let twice = format!("convert in {TO} --out out --report r.json --report sub/../R.json");
    shop.fails(&twice, &["named twice"]);
    shop.fails(&format!("verify in out {TO} --certificate .macroglot-1-0"), &["while it writes"]);
}

#[test]
fn two_projects_in_one_folder() {
    let shop = Shop::with(&[("one/a.nc", CLEAN), ("two/a.nc", &numbered(2))]);
    let of_one = format!("convert one {TO} --out out --quiet");
    let of_two = format!("convert two {TO} --out out --quiet");
    assert_eq!(shop.run(&of_one).code, 0);
    let run = shop.run(&of_two);
    let told =
        |at: &str| format!("replaced   a.nc: it was converted from ../{at}/a.nc, which still exists\n");
    assert!(run.code == 0 && run.out.contains(&told("one")), "{}", run.out);
    // It is told once, and not of a source that has another name now.
    assert!(!shop.run(&of_two).out.contains("replaced"));
    shop.write("one/a.nc", REFUSED.as_bytes());
    let run = shop.run(&format!("{of_one} --format json"));
    let json: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(json["folders"][0]["replaced"]["a.nc"], "../two/a.nc", "{}", run.out);
    assert_eq!(json["folders"][0]["removed"][0], "a.nc");
    assert_eq!(shop.run(&of_two).code, 0);
    std::fs::rename(shop.path("two"), shop.path("three")).unwrap();
    shop.write("three/a.nc", numbered(3).as_bytes());
    let run = shop.run(&of_two.replace("two", "three"));
    assert!(run.code == 0 && !run.out.contains("replaced"), "{}", run.out);
}

/// What stands beside a program that macroglot did not write is somebody's, too.
#[test]
fn somebodys_certificate_stays_with_somebodys_text() {
    let beside = ["out/b.nc", "out/b.nc.certificate.json", "out/b.nc.not-written.json"];
    let shop = Shop::with(&[("b.nc", REFUSED), (beside[0], "A"), (beside[1], "B"), (beside[2], "C")]);
    assert_eq!(shop.run(&format!("convert b.nc {TO} --out out")).code, 1);
    assert_eq!(beside.map(|name| shop.read(name)), ["A", "B", "C"]);
    // Beside a text of macroglot's it would be taken for the certificate of that.
    shop.write("b.nc", CLEAN.as_bytes());
    assert_eq!(shop.run(&format!("convert b.nc {TO} --out out --no-verify")).code, 0);
    assert!(!shop.path(beside[1]).exists() && !shop.path(beside[2]).exists());
}

/// A certificate whose program somebody deleted goes with `--prune` when its source is gone, too.
#[test]
fn what_is_left_of_a_conversion_is_pruned() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/b.nc", &numbered(2))]);
    let line = format!("convert in {TO} --out out --quiet");
    assert_eq!(shop.run(&line).code, 0);
    std::fs::remove_file(shop.path("out/b.nc")).unwrap();
    std::fs::remove_file(shop.path("in/b.nc")).unwrap();
    let run = shop.run(&line);
    assert!(run.out.contains("no source  b.nc.certificate.json: "), "{}", run.out);
    let run = shop.run(&format!("{line} --prune"));
    assert!(run.out.contains("removed    b.nc.certificate.json: "), "{}", run.out);
    let files = shop.files();
    assert!(!names(&files).iter().any(|name| name.contains("b.nc")), "{:?}", names(&files));
    assert!(!shop.read("out/macroglot.lock").contains("b.nc"));
}

/// The place of a source whose name is no text cannot be written down, so nothing shows that it is gone.
#[cfg(target_os = "linux")]
#[test]
fn names_that_are_no_text() {
    use std::os::unix::ffi::OsStrExt;
    let shop = Shop::with(&[("in/b.nc", CLEAN)]);
    let odd = shop.path("in").join(std::ffi::OsStr::from_bytes(b"a\xff.nc"));
    std::fs::write(&odd, numbered(2)).unwrap();
    let line = format!("{TO} --out out --quiet");
    assert_eq!(shop.run(&format!("convert in {line}")).code, 0);
    let run = shop.run(&format!("convert in/b.nc --prune {line}"));
    assert!(run.code == 0 && !run.out.contains("removed"), "{}", run.out);
    assert!(shop.read("out/a\u{fffd}.nc").contains("O0002"));
    let mut command = assert_cmd::Command::cargo_bin("macroglot").unwrap();
    command.args(format!("convert in {line} --report").split_whitespace()).current_dir(shop.path(""));
    let output = command.arg(std::ffi::OsStr::from_bytes(b"r\xff.json")).output().unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(2) && err.contains("r\u{fffd}.json") && err.contains("UTF-8"),
        "{err}"
    );
}

#[test]
fn names_that_no_conversion_has() {
    let shop = Shop::with(&[("in/.macroglot", CLEAN), ("in/a.nc", CLEAN)]);
    shop.fails(&format!("convert in/.macroglot {TO} --out out"), &[".macroglot", "while it writes"]);
    #[cfg(unix)]
    {
        shop.write("in/c:d.nc", CLEAN.as_bytes());
        shop.fails(&format!("convert in/c:d.nc {TO} --out out"), &["c:d.nc", "colon", "Rename"]);
    }
    // A folder that is missing may be named with a dot.
    assert_eq!(shop.run(&format!("convert in/a.nc {TO} --out new/.")).code, 0);
    assert!(shop.read("new/a.nc").contains("O1234"));
}
