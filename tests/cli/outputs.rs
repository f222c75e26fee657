//! What is written, and what never is.

use super::{CLEAN, REFUSED, Shop, names, repository};

const TO: &str = "--from fanuc --to haas";

#[test]
fn a_clean_program_is_0_and_a_refused_one_is_1() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/b.nc", REFUSED)]);
    let run = shop.run(&format!("convert in/a.nc {TO} --out out"));
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert!(run.out.ends_with("1 program in 1 file: 1 converted, 0 for review, 0 refused; 1 verified, 0 undecided, 0 different\n"), "{}", run.out);
    let run = shop.run(&format!("convert in {TO} --out both"));
    assert_eq!(run.code, 1);
    assert!(
        run.out.contains("error MG0301: ") && run.out.contains("      b.nc:5\n      5 | "),
        "{}",
        run.out
    );
    let run = shop.run(&format!("convert in {TO} --out both --verbose"));
    assert!(run.err.contains("in/b.nc:5:1") && run.err.contains("MG0301"), "{}", run.err);
    let all = shop.files();
    let written: Vec<&str> = names(&all).into_iter().filter(|name| name.starts_with("both/")).collect();
    assert_eq!(
        written,
        ["both/a.nc", "both/a.nc.certificate.json", "both/macroglot.lock", "both/macroglot.manifest"],
        "a refused program is not written"
    );
    let run = shop.run(&format!("convert in/b.nc {TO}"));
    assert_eq!((run.code, run.out.as_str()), (1, ""));
}

/// Programs without a number stay apart, and each is verified against its own source.
#[test]
fn programs_without_a_number_stay_apart() {
    let shop = Shop::with(&[("in/a.nc", "%\nG0X1.\nM30\n%\nG0X2.\nM30\n%\n")]);
    let run = shop.run(&format!("convert in {TO} --out out"));
    assert_eq!(super::unmarked(&shop.read("out/a.nc")), "%\nG0 X1.\nM30\n%\nG0 X2.\nM30\n%\n");
    assert!(run.out.contains("2 verified"), "{}", run.out);
}

/// A draft stops the machine at the hole, keeps what stands around it, and stays refused.
#[test]
fn a_draft_has_an_alarm_at_the_hole() {
    let shop = Shop::with(&[("b.nc", REFUSED)]);
    let run = shop.run(&format!("convert b.nc {TO} --draft"));
    assert_eq!(run.code, 1);
    let lines: Vec<&str> = run.out.lines().collect();
    let hole = lines.iter().position(|line| line.contains("NOT CONVERTED MG0301")).expect("an alarm");
    assert!(lines[hole].starts_with("#3000="), "{}", lines[hole]);
    assert_eq!((lines[hole - 1], lines[hole + 1]), ("G0 X1.", "G1 X2. F10."));
    assert!(!run.out.contains("M38"));
}

/// The unit is named by what the first block calls, six levels deep, one more than the target has: the alarm in the
/// call's place leaves the program without it, which says nothing about the program.
#[test]
fn a_draft_is_not_blamed_for_its_holes() {
    let nested = "O1\nG65 P2\nG0 X1.\nM30\nO2\nG20\nG65 P3\nM99\nO3\nG65 P4\nM99\nO4\nG65 P5\nM99\nO5\nG65 P6\nM99\nO6\nG65 P7\nM99\nO7\nG0 X1.\nM99\n";
    let shop = Shop::with(&[("a.nc", nested)]);
    let run = shop.run("convert a.nc --from haas --to fanuc --draft");
    let draft = super::unmarked(&run.out);
    assert!(draft.starts_with("O0001\n#3000=99 (NOT CONVERTED MG0401)\nG0 X1.\nM30\n"), "{}", run.out);
    assert!(run.err.contains("MG0401") && !run.err.contains("MG0405"), "{}", run.err);
}

/// What the program asks to be looked at stays told: here after a cycle that is not given, and after which no work offset
/// is sure. The alarm in its place makes that sure in the draft alone.
#[test]
fn a_draft_keeps_its_conditions() {
    let shop = Shop::with(&[("a.nc", "N1 G90\nN2 G53\nN3 G820\nN4 G0 X1 T01\nN5 M30\n")]);
    let told = |draft: &str| {
        let line = format!("convert a.nc --from cc100 --to haas --no-verify --format json --out out {draft}");
        let json: serde_json::Value = serde_json::from_str(&shop.run(&line).out).unwrap();
        json["programs"][0]["diagnostics"].clone()
    };
    let plain = told("");
    assert!(plain.to_string().contains("the work offset in force here"), "{plain}");
    assert_eq!(told("--draft"), plain);
}

/// One alarm stands for all that a block that has no equivalent would have become.
#[test]
fn a_hole_has_one_alarm() {
    let shop = Shop::with(&[("a.nc", "O1\nG90 G0\nL9101 R1+1. X1. Y1. Z1. F10. P1\nM2\n")]);
    let run = shop.run("convert a.nc --from fadal --to fanuc --draft");
    assert_eq!(run.out.matches("#3000=").count(), 1, "{}", run.out);
}

#[test]
fn an_input_is_never_overwritten() {
    let shop = Shop::with(&[("in/a.nc", CLEAN)]);
    shop.fails(&format!("convert in {TO} --out in"), &["a.nc", "overwritten"]);
    shop.fails(&format!("convert in/a.nc {TO} --out in"), &["overwritten"]);
    shop.fails(&format!("convert in {TO} --out in/../in"), &["overwritten"]);
    shop.fails(&format!("convert in {TO} --out out --report in/a.nc"), &["a.nc"]);
    // Certificates go beside programs.
    shop.write("out/a.nc.certificate.json", CLEAN.as_bytes());
    shop.fails(&format!("convert in/a.nc out/a.nc.certificate.json {TO} --out out"), &["overwritten"]);
    shop.write("a.nc.certificate.json", CLEAN.as_bytes());
    shop.fails(&format!("convert in/a.nc a.nc.certificate.json {TO} --out o"), &["certificate", "a.nc"]);
    shop.write("in/b.txt", CLEAN.replace("O1234", "O1235").as_bytes());
    shop.fails(&format!("convert in {TO} --out out --report in/../in/b.txt"), &["b.txt", "overwritten"]);
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_to_an_input_or_out_of_the_folder() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("out/x", ""), ("else/secret.nc", "KEEP")]);
    std::os::unix::fs::symlink(shop.path("in"), shop.path("link")).unwrap();
    shop.fails(&format!("convert in {TO} --out link"), &["overwritten"]);
    std::os::unix::fs::symlink(shop.path("else/secret.nc"), shop.path("out/a.nc")).unwrap();
    shop.fails(&format!("convert in {TO} --out out"), &["outside the output folder"]);
}

/// File systems of shop computers do not tell `a.nc` from `A.NC`.
#[cfg(target_os = "linux")]
#[test]
fn two_inputs_for_one_place() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/A.NC", CLEAN)]);
    shop.fails(&format!("convert in {TO} --out out"), &["a.nc", "A.NC", "nothing was written"]);
}

/// Some file systems write `ü` as one character, some as two, and some do not tell the two apart. On a screen they look alike.
#[cfg(target_os = "linux")]
#[test]
fn names_that_look_alike_are_spelled() {
    let other = CLEAN.replace("O1234", "O1235");
    let shop = Shop::with(&[("in/f\u{fc}r.nc", CLEAN), ("in/fu\u{308}r.nc", &other)]);
    let words = ["f\\u{fc}r.nc", "fu\\u{308}r.nc", "nothing was written"];
    shop.fails(&format!("convert in {TO} --out out"), &words);
    assert_eq!(shop.run(&format!("convert in/f\u{fc}r.nc {TO} --out out")).code, 0);
    shop.fails(&format!("convert in/fu\u{308}r.nc {TO} --out out"), &words);
}

/// A folder never holds two conversions that are one file where it is copied to, whichever runs wrote them.
#[cfg(target_os = "linux")]
#[test]
fn a_conversion_of_an_earlier_run_counts_too() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/A.NC", &CLEAN.replace("O1234", "O1235"))]);
    assert_eq!(shop.run(&format!("convert in/A.NC {TO} --out out")).code, 0);
    shop.fails(&format!("convert in/a.nc {TO} --out out"), &["a.nc", "A.NC", "--prune"]);
    // A program that was given another name, too.
    std::fs::remove_file(shop.path("in/A.NC")).unwrap();
    shop.fails(&format!("convert in/a.nc {TO} --out out"), &["a.nc", "A.NC", "--prune"]);
    assert_eq!(shop.run(&format!("convert in/a.nc {TO} --out out --prune")).code, 0);
    assert!(shop.files().keys().all(|name| !name.starts_with("out/A.NC")));
}

#[test]
fn several_programs_need_a_folder() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/b.nc", REFUSED)]);
    shop.fails(&format!("convert in {TO}"), &["--out"]);
}

/// When one output cannot be written, none is, and nothing lies about.
#[test]
fn outputs_are_written_all_or_none() {
    let shop =
        Shop::with(&[("in/a.nc", CLEAN), ("in/b.nc", &CLEAN.replace("O1234", "O1235")), ("file", "KEEP")]);
    shop.fails(&format!("convert in {TO} --out file"), &["file"]);
    // a.nc could be written, but what stands at b.nc is a folder.
    shop.write("out/b.nc/inside", b"KEEP");
    shop.write("out/a.nc", b"OLD");
    shop.fails(&format!("convert in {TO} --out out"), &["b.nc", "cannot be written"]);
    shop.fails(&format!("convert in {TO} --out new --report file/x.json"), &["file/x.json"]);
}

#[test]
fn from_a_control_to_itself_every_byte_stays() {
    let odd = "%\r\no0001( odd  spacing )\r\n g0x1.000 Y+02.\r\n/N0005 m30\r\n%";
    let shop = Shop::with(&[("in/a.nc", odd)]);
    let run = shop.run("convert in --from fanuc --to fanuc --out out");
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(shop.read("out/a.nc"), odd);
}

#[test]
fn the_lock_is_honoured_by_the_next_run() {
    let folder = repository("corpus/cc100");
    let shop = Shop::empty();
    let line = format!("convert {folder} --from cc100 --to haas --no-verify --out out --quiet");
    assert_eq!(shop.run(&line).code, 1);
    let before = shop.files();
    assert_eq!(shop.run(&line).code, 1);
    assert!(shop.files() == before, "a second run writes the same");
    // A register that somebody chose by hand is kept.
    let lock = shop.read("out/macroglot.lock");
    let line_before = lock.lines().find(|line| line.starts_with("V1 = ")).expect("a register for V1");
    let name = "V1";
    shop.write("out/macroglot.lock", lock.replace(line_before, &format!("{name} = 199")).as_bytes());
    assert_eq!(shop.run(&line).code, 1);
    assert!(shop.read("out/macroglot.lock").contains(&format!("{name} = 199\n")));
    let moved = shop
        .files()
        .iter()
        .any(|(name, bytes)| name.ends_with(".nc") && String::from_utf8_lossy(bytes).contains("#199"));
    assert!(moved, "no program uses #199");
}

#[test]
fn a_lock_of_another_kind_is_not_overwritten() {
    let shop = Shop::with(&[("in/a.nc", CLEAN)]);
    assert_eq!(shop.run(&format!("convert in {TO} --out out --quiet")).code, 0);
    shop.fails("convert in --from haas --to fanuc --out out", &["macroglot.lock"]);
    shop.write("out/macroglot.lock", b"version = 99\nfrom = \"fanuc\"\nto = \"haas\"\n");
    shop.fails(&format!("convert in {TO} --out out"), &["version 99"]);
    shop.write("out/macroglot.lock", b"<<<<<<< ours\n");
    shop.fails(&format!("convert in {TO} --out out"), &["macroglot.lock"]);
}

/// A folder in the output folder may be a link, to a place where nothing of that name is yet.
#[cfg(unix)]
#[test]
fn a_linked_folder_leads_out_too() {
    let shop = Shop::with(&[("in/sub/a.nc", CLEAN), ("out/x", ""), ("else/y", "")]);
    std::os::unix::fs::symlink(shop.path("else"), shop.path("out/sub")).unwrap();
    shop.fails(&format!("convert in {TO} --out out"), &["outside the output folder"]);
    // A report goes where it is asked for, by a link too.
    std::fs::remove_file(shop.path("out/sub")).unwrap();
    std::os::unix::fs::symlink(shop.path("else"), shop.path("out/told")).unwrap();
    let run = shop.run(&format!("convert in {TO} --out out --report out/told/r.json"));
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert!(shop.read("else/r.json").starts_with('{'));
}
