//! What a run leaves of the runs before it: nothing that is stale, and nothing of a person's lost.

use super::{CLEAN, REFUSED, Shop, names};

pub const TO: &str = "--from fanuc --to haas";

pub fn in_out(shop: &Shop) -> Vec<String> {
    let files = shop.files();
    names(&files).into_iter().filter_map(|name| name.strip_prefix("out/")).map(str::to_owned).collect()
}

#[test]
fn a_conversion_goes_when_its_program_is_refused() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/sub/b.nc", &CLEAN.replace("O1234", "O1235"))]);
    assert_eq!(shop.run(&format!("convert in {TO} --out out")).code, 0);
    shop.write("in/sub/b.nc", REFUSED.as_bytes());
    let run = shop.run(&format!("convert in {TO} --out out --quiet"));
    assert_eq!(run.code, 1);
    assert!(run.out.contains("removed    sub/b.nc: an earlier run converted it"), "{}", run.out);
    assert_eq!(in_out(&shop), ["a.nc", "a.nc.certificate.json", "macroglot.lock", "macroglot.manifest"]);
    // It is told once.
    let run = shop.run(&format!("convert in {TO} --out out --quiet --format json"));
    assert!(!run.out.contains("folders"), "{}", run.out);
}

/// A certificate is of the text beside it, whatever the run was asked for.
#[test]
fn a_certificate_goes_with_its_text() {
    let shop = Shop::with(&[("a.nc", CLEAN)]);
    let certified = ["a.nc", "a.nc.certificate.json", "macroglot.lock", "macroglot.manifest"];
    let bare = ["a.nc", "macroglot.lock", "macroglot.manifest"];
    assert_eq!(shop.run(&format!("convert a.nc {TO} --out out")).code, 0);
    assert_eq!(in_out(&shop), certified);
    assert_eq!(shop.run(&format!("convert a.nc {TO} --out out --no-verify")).code, 0);
    assert_eq!(in_out(&shop), bare);
    assert_eq!(shop.run(&format!("convert a.nc {TO} --out out")).code, 0);
    shop.write("a.nc", REFUSED.as_bytes());
    assert_eq!(shop.run(&format!("convert a.nc {TO} --out out --draft")).code, 1);
    assert_eq!(in_out(&shop), bare);
    assert!(shop.read("out/a.nc").contains("NOT CONVERTED"));
    assert!(shop.read("out/macroglot.manifest").contains("kind = \"draft\""));
}

#[test]
fn what_a_person_changed_is_kept() {
    let shop = Shop::with(&[("a.nc", CLEAN)]);
    let line = format!("convert a.nc {TO} --out out");
    assert_eq!(shop.run(&line).code, 0);
    let written = shop.read("out/a.nc");
    for (edit, kept) in [("(FIRST)", "a.nc.kept"), ("(SECOND)", "a.nc.kept-2")] {
        shop.write("out/a.nc", edit.as_bytes());
        let looked = shop.run(&format!("verify a.nc out/a.nc {TO}"));
        assert!(looked.err.contains("a.nc: was changed since macroglot wrote it"), "{}", looked.err);
        let run = shop.run(&line);
        assert!(
            run.out.contains(&format!("kept       a.nc as {kept}: macroglot did not write the earlier file")),
            "{}",
            run.out
        );
        assert_eq!(
            (shop.read("out/a.nc"), shop.read(&format!("out/{kept}"))),
            (written.clone(), edit.to_owned())
        );
    }
    // What would be the same is left alone.
    let run = shop.run(&line);
    assert!(!run.out.contains("kept"), "{}", run.out);
    shop.write("out/a.nc", b"(THIRD)");
    shop.write("a.nc", REFUSED.as_bytes());
    let run = shop.run(&line);
    assert!(run.out.contains("removed    a.nc") && run.out.contains("a.nc as a.nc.kept-3"), "{}", run.out);
    assert_eq!(shop.read("out/a.nc.kept-3"), "(THIRD)");
    let there = in_out(&shop);
    assert!(!there.contains(&"a.nc".to_owned()), "{there:?}");
}

#[test]
fn a_conversion_whose_source_is_gone_is_told_and_pruned() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/b.nc", &CLEAN.replace("O1234", "O1235"))]);
    let line = format!("convert in {TO} --out out --quiet");
    assert_eq!(shop.run(&line).code, 0);
    // A run of one program says nothing of the others.
    let run = shop.run(&format!("convert in/a.nc {TO} --out out --quiet"));
    assert!(!run.out.contains("b.nc"), "{}", run.out);
    std::fs::remove_file(shop.path("in/b.nc")).unwrap();
    for _ in 0..2 {
        let run = shop.run(&line);
        assert_eq!(run.code, 0);
        assert!(run.out.contains("no source  b.nc: its source is gone; --prune"), "{}", run.out);
        assert!(in_out(&shop).contains(&"b.nc".into()));
    }
    let run = shop.run(&format!("{line} --prune"));
    assert!(run.out.contains("removed    b.nc: its source is gone"), "{}", run.out);
    assert_eq!(in_out(&shop), ["a.nc", "a.nc.certificate.json", "macroglot.lock", "macroglot.manifest"]);
    assert!(
        !shop.read("out/macroglot.lock").contains("b.nc")
            && !shop.read("out/macroglot.manifest").contains("b.nc")
    );
}

#[test]
fn a_file_of_that_name_that_macroglot_did_not_write_stays() {
    let shop = Shop::with(&[("b.nc", REFUSED), ("out/b.nc", "(SOMEBODY'S)")]);
    assert_eq!(shop.run(&format!("convert b.nc {TO} --out out")).code, 1);
    assert_eq!(shop.read("out/b.nc"), "(SOMEBODY'S)");
    // A conversion takes its place, and it is not lost.
    shop.write("b.nc", CLEAN.as_bytes());
    let run = shop.run(&format!("convert b.nc {TO} --out out"));
    assert!(run.out.contains("kept       b.nc as b.nc.kept: macroglot did not write"), "{}", run.out);
    assert!(shop.read("out/b.nc").contains("O1234"));
    assert_eq!(shop.read("out/b.nc.kept"), "(SOMEBODY'S)");
}

#[test]
fn a_wrong_manifest_is_named() {
    let shop = Shop::with(&[("a.nc", CLEAN), ("out/macroglot.manifest", "<<<<<<< ours\n")]);
    shop.fails(&format!("convert a.nc {TO} --out out"), &["macroglot.manifest"]);
    shop.write("out/macroglot.manifest", b"version = 99\n");
    shop.fails(&format!("convert a.nc {TO} --out out"), &["version 99"]);
}

/// Names that no file can have are found before anything is written.
#[test]
fn a_name_that_is_too_long_stops_the_run_before_it_writes() {
    let long = format!("in/{}.nc", "b".repeat(242));
    let shop = Shop::with(&[("in/a.nc", CLEAN), (&long, &CLEAN.replace("O1234", "O1235"))]);
    shop.fails(&format!("convert in {TO} --out out"), &["bbb", "cannot be written", "nothing was written"]);
}

#[cfg(unix)]
#[test]
fn read_only_files_are_replaced_by_force_alone() {
    let shop = Shop::with(&[
        ("a.nc", CLEAN),
        ("out/a.nc", "OLD"),
        ("r.json", "OLD"),
        ("c.json", "OLD"),
        ("p.svg", "OLD"),
    ]);
    for name in ["out/a.nc", "r.json", "c.json", "p.svg"] {
        let mut permissions = std::fs::metadata(shop.path(name)).unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(shop.path(name), permissions).unwrap();
    }
    shop.fails(&format!("convert a.nc {TO} --out out"), &["out/a.nc", "read-only", "--force"]);
    shop.fails(&format!("convert a.nc {TO} --out new --report r.json"), &["r.json", "read-only"]);
    assert_eq!(shop.run(&format!("convert a.nc {TO} --out out --report r.json --force")).code, 0);
    for (line, name) in [
        ("verify a.nc a.nc --from fanuc --to fanuc --certificate c.json", "c.json"),
        ("run a.nc --dialect fanuc --plot p.svg", "p.svg"),
    ] {
        let before = shop.files();
        let run = shop.run(line);
        assert!(run.code == 2 && run.err.contains("read-only"), "{line}: {}", run.err);
        assert!(shop.files() == before);
        assert_eq!(shop.run(&format!("{line} --force")).code, 0, "{line}");
        assert_ne!(shop.read(name), "OLD");
    }
}

/// A file that is read is never written to, whatever the path that leads to it.
#[cfg(unix)]
#[test]
fn no_input_is_written_to_by_any_name() {
    let shop = Shop::with(&[
        ("a.nc", CLEAN),
        ("m.toml", "dialect = \"haas\"\n"),
        ("s.toml", "answers = []\n"),
        ("out/x", ""),
        ("lib/sub.nc", &CLEAN.replace("O1234", "O1235")),
    ]);
    for (file, link) in
        [("a.nc", "hard.json"), ("m.toml", "hard.md"), ("s.toml", "hard.svg"), ("lib/sub.nc", "lib.svg")]
    {
        std::fs::hard_link(shop.path(file), shop.path(link)).unwrap();
    }
    std::os::unix::fs::symlink(shop.path("m.toml"), shop.path("soft.json")).unwrap();
    let words = &["an input", "overwritten"];
    shop.fails(&format!("convert a.nc {TO} --out out --report hard.json"), words);
    shop.fails(&format!("convert a.nc {TO} --machine m.toml --out out --report hard.md"), words);
    shop.fails(&format!("convert a.nc {TO} --machine m.toml --out out --report ./soft.json"), words);
    shop.fails("verify a.nc a.nc --from fanuc --to fanuc --certificate out/../a.nc", words);
    shop.fails(&format!("verify a.nc a.nc {TO} --machine m.toml --certificate soft.json"), words);
    shop.fails("run a.nc --dialect fanuc --plot hard.json", words);
    shop.fails("run a.nc --dialect fanuc --scenario s.toml --plot hard.svg", words);
    shop.fails("run a.nc --dialect fanuc --library lib --plot lib.svg", words);
    std::fs::hard_link(shop.path("a.nc"), shop.path("out/a.nc")).unwrap();
    shop.fails(&format!("convert a.nc {TO} --out out"), words);
}

/// A summary has a line for each program, and none that a file's name makes up.
#[cfg(target_os = "linux")]
#[test]
fn names_forge_nothing() {
    let shop = Shop::empty();
    shop.write("in/a\nconverted  b.nc \u{1b}[2Jc.nc", CLEAN.as_bytes());
    let run = shop.run(&format!("convert in {TO} --out out"));
    assert!(run.out.contains(r"converted  a\nconverted  b.nc \u{1b}[2Jc.nc"), "{}", run.out);
    assert!(!run.out.contains('\u{1b}') && !run.err.contains('\u{1b}'));
    shop.write("in/a\nconverted  b.nc \u{1b}[2Jc.nc", REFUSED.as_bytes());
    let run = shop.run(&format!("convert in {TO} --out out"));
    assert!(!run.out.contains('\u{1b}') && !run.err.contains('\u{1b}'), "{}", run.err);
}

/// What was changed by hand is kept under no name that the run itself writes to.
#[test]
fn a_kept_file_is_not_written_over() {
    let shop = Shop::with(&[("in/a.nc", CLEAN)]);
    let line = format!("convert in/a.nc in/a.nc.kept {TO} --out out");
    assert_eq!(shop.run(&format!("convert in/a.nc {TO} --out out")).code, 0);
    shop.write("out/a.nc", b"(BY HAND)");
    shop.write("in/a.nc.kept", CLEAN.replace("O1234", "O1235").as_bytes());
    let run = shop.run(&line);
    assert!(run.out.contains("kept       a.nc as a.nc.kept-2"), "{}{}", run.out, run.err);
    assert_eq!(shop.read("out/a.nc.kept-2"), "(BY HAND)");
    assert!(shop.read("out/a.nc.kept").contains("O1235"));
}

/// A pipe in the place of a file is said, not waited for.
#[test]
#[cfg(unix)]
fn a_pipe_in_the_output_folder_is_no_file() {
    for name in ["macroglot.lock", "macroglot.manifest", "a.nc", "a.nc.certificate.json"] {
        let shop = Shop::with(&[("a.nc", CLEAN)]);
        std::fs::create_dir(shop.path("out")).unwrap();
        let made = std::process::Command::new("mkfifo").arg(shop.path("out").join(name)).status();
        assert!(made.unwrap().success());
        let run = shop.run(&format!("convert a.nc {TO} --out out"));
        assert_eq!(run.code, 2, "{name}: {}", run.err);
        assert!(run.err.contains(name) && run.err.contains("it is not a file"), "{name}: {}", run.err);
    }
}

/// The lock and the manifest of a conversion stand in its output folder, however deep in that it lies.
#[test]
fn verify_finds_the_output_folder_above() {
    const WAY: &str = "--from fadal --to fanuc";
    let text = "%\nN1 O1 (A)\nN2 G90 E1\nN3 #R1=V2+1\nN5 G0 X+R1\nN6 M2\n%\n";
    let shop = Shop::with(&[("in/sub/deep/a.nc", text)]);
    shop.run(&format!("convert in {WAY} --out out"));
    let written = shop.read("out/sub/deep/a.nc");
    shop.write("out/other/a.nc", written.as_bytes());
    let outcome = |line: &str| {
        let run = shop.run(&format!("verify {line} {WAY}"));
        let json: serde_json::Value =
            serde_json::from_str(&run.out).unwrap_or_else(|_| panic!("{}", run.err));
        (json["outcome"].as_str().map(str::to_owned), run.err)
    };
    // Without the lock, nothing says that #520 is V2.
    let lines =
        ["in out", "in/sub out/sub", "in/sub/deep out/sub/../sub/deep", "in/sub/deep/a.nc out/sub/deep/a.nc"];
    for line in lines {
        assert_eq!(outcome(line), (Some("same".into()), String::new()), "{line}");
    }
    // What macroglot did not write there is none of that run's.
    assert_eq!(outcome("in/sub/deep/a.nc out/other/a.nc").0.as_deref(), Some("different"));
    shop.write("out/sub/deep/a.nc", written.replace("#521\n", "#521\n(BY HAND)\n").as_bytes());
    let told = "sub/deep/a.nc: was changed since macroglot wrote it";
    assert!(outcome("in/sub/deep/a.nc out/sub/deep/a.nc").1.contains(told));
}

/// What is pruned keeps no register from the programs that stay: the next run has nothing more to change.
#[test]
fn a_lock_forgets_what_is_pruned() {
    let own = |number: u32| format!("%\nO{number}\nG21 G90\n#{number}=5.\nG0 X#{number}\nM30\n%\n");
    let shop = Shop::with(&[("in/a.nc", &own(100)), ("in/b.nc", &own(102))]);
    shop.run(&format!("convert in {TO} --out out"));
    assert!(shop.read("out/macroglot.lock").contains("own = [100, 102]"));
    std::fs::remove_file(shop.path("in/b.nc")).unwrap();
    shop.run(&format!("convert in {TO} --out out --prune"));
    let (files, lock) = (shop.files(), shop.read("out/macroglot.lock"));
    assert!(lock.contains("files = [\"a.nc\"]") && !lock.contains("102"), "{lock}");
    shop.run(&format!("convert in {TO} --out out --prune"));
    assert!(shop.files() == files, "{lock}{}", shop.read("out/macroglot.lock"));
}
