//! `macroglot check`: what a repository runs before each commit.

use super::{CLEAN, REFUSED, Run, Shop};
use serde_json::Value;

const PROJECT: &str = "[machines.fv]\ndialect = \"fanuc\"\n\n[machines.vf2]\ndialect = \"haas\"\n\n\
                       [libraries.mill]\npath = \"programs\"\nmachine = \"fv\"\n\n[libraries.mill.targets]\n\
                       vf2 = \"haas\"\n\n[checks]\nround_trip = [\"vf2\"]\n";

/// A main program, the macro that it calls, and a program that has nothing to do with them.
const MAIN: &str = "O1000\nG21 G17 G90 G40 G80 G94 G54\nG0 X0. Y0.\nG65 P2000 A10.\nM30\n";
const MACRO: &str = "O2000\nG1 X#1 F100.\nG0 X0.\nM99\n";
const ALONE: &str = "O3000\nG21 G17 G90 G40 G80 G94 G54\nG0 X1.\nM30\n";

fn shop() -> Shop {
    Shop::with(&[
        ("macroglot.toml", PROJECT),
        ("programs/main.nc", MAIN),
        ("programs/macro.nc", MACRO),
        ("programs/alone.nc", ALONE),
        ("README.txt", "Not a program.\n"),
    ])
}

/// A check that keeps its answers in the shop.
fn check(shop: &Shop, line: &str) -> Run {
    shop.run(&format!("check --cache cache {line}"))
}

fn json(shop: &Shop, line: &str) -> Value {
    serde_json::from_str(&check(shop, &format!("{line} --format json")).out).unwrap()
}

/// The code, file and line of each finding.
fn found(report: &Value) -> Vec<(String, String, u64)> {
    let one = |finding: &Value| {
        let text = |key: &str| finding[key].as_str().unwrap().to_owned();
        (text("code"), text("file"), finding["line"].as_u64().unwrap())
    };
    report["findings"].as_array().unwrap().iter().map(one).collect()
}

fn at(code: &str, file: &str, line: u64) -> (String, String, u64) {
    (code.into(), file.into(), line)
}

#[test]
fn a_sound_library_passes() {
    let shop = shop();
    let run = check(&shop, "");
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    let expected = "3 files checked, nothing found\nnot looked at: haas has no macroglot.manifest: nothing was \
                    converted there\n";
    assert_eq!(run.out, expected);
}

#[test]
fn what_is_wrong_is_told_at_its_place_and_of_the_named_files_alone() {
    let shop = shop();
    shop.write("programs/macro.nc", MACRO.replace("F100.", "F[100.").as_bytes());
    shop.write("programs/alone.nc", ALONE.replace("M30", "M38").as_bytes());
    let run = check(&shop, "programs/alone.nc --only read");
    assert_eq!(run.code, 1);
    let lines: Vec<&str> = run.out.lines().collect();
    assert!(lines[0].starts_with("programs/alone.nc:4:1: MG0301 "), "{}", run.out);
    assert_eq!(lines[1], "    | M38");
    assert!(lines.last().unwrap().starts_with("1 finding in 1 file; 1 file checked"), "{}", run.out);
    let both = found(&json(&shop, "--only read"));
    assert_eq!(both, [at("MG0301", "programs/alone.nc", 4), at("MG0112", "programs/macro.nc", 2)]);
}

#[test]
fn other_files_are_left_alone() {
    let shop = shop();
    shop.write("programs/notes.md", b"# Notes\n");
    shop.write("other/x.nc", REFUSED.as_bytes());
    shop.write("other.toml", b"[a]\n");
    let run = check(&shop, "README.txt programs/notes.md other/x.nc other.toml");
    assert_eq!((run.code, run.out.as_str()), (0, "0 files checked, nothing found\n"), "{}", run.err);
    shop.fails("check --cache cache gone.nc", &["gone.nc", "no such file"]);
}

/// A program goes with what it calls; a macro that changes concerns the programs that call it.
#[test]
fn a_change_of_a_macro_concerns_its_callers() {
    let shop = shop();
    // An output that no Haas has: the macro is refused there, and so is its caller.
    shop.write(
        "programs/macro.nc",
        MACRO.replace("G0 X0.", "#2=#5421\nPOPEN\nBPRNT[A#1[2]]\nPCLOS").as_bytes(),
    );
    let report = json(&shop, "programs/macro.nc --only round");
    let codes: Vec<String> =
        found(&report).into_iter().map(|(code, file, _)| format!("{code} {file}")).collect();
    assert!(codes.contains(&"MG0902 programs/macro.nc".to_owned()), "{codes:?}");
    assert!(codes.iter().all(|found| !found.contains("alone")), "{codes:?}");
    assert_eq!(report["totals"]["round_trips"]["taken"], 1, "one group: {report}");
}

#[test]
fn what_is_known_is_not_done_again() {
    let shop = shop();
    let taken = |shop: &Shop, line: &str| {
        let trips = json(shop, line)["totals"]["round_trips"].clone();
        (trips["taken"].as_u64().unwrap(), trips["from_cache"].as_u64().unwrap())
    };
    assert_eq!(taken(&shop, ""), (2, 0), "main with its macro, and the one alone");
    assert_eq!(taken(&shop, ""), (0, 2));
    assert_eq!(taken(&shop, "programs/alone.nc"), (0, 1));
    shop.write("programs/macro.nc", MACRO.replace("F100.", "F200.").as_bytes());
    assert_eq!(taken(&shop, ""), (1, 1), "the macro's text counts for main");
    assert_eq!(taken(&shop, "--no-cache"), (2, 0));
    assert_eq!(taken(&shop, "--program-seconds 3"), (2, 0), "another effort is another question");
    // Whatever stands there, the answer is right.
    for entry in
        std::fs::read_dir(shop.path("cache")).unwrap().flatten().filter(|entry| entry.path().is_dir())
    {
        for file in std::fs::read_dir(entry.path()).unwrap().flatten() {
            std::fs::write(file.path(), "[{\"code\":1}]").unwrap();
        }
    }
    assert_eq!(taken(&shop, ""), (2, 0));
}

#[test]
fn a_conversion_is_to_be_of_the_text_that_stands_there() {
    let shop = shop();
    assert_eq!(shop.run("convert --quiet").code, 0);
    assert_eq!(check(&shop, "").out, "3 files checked, nothing found\n");
    shop.write("programs/alone.nc", ALONE.replace("X1.", "X2.").as_bytes());
    shop.write("haas/macro.nc", b"O2000\nM99\n");
    shop.write("programs/new.nc", ALONE.replace("O3000", "O3001").as_bytes());
    let now = found(&json(&shop, "--only fresh"));
    let expected = [
        at("MG0908", "haas/macro.nc", 1),
        at("MG0906", "programs/alone.nc", 1),
        at("MG0907", "programs/new.nc", 1),
    ];
    // A certificate of main rests on its macro.
    let (main, others): (Vec<_>, Vec<_>) =
        now.into_iter().partition(|(_, file, _)| file == "programs/main.nc");
    assert_eq!(others, expected);
    assert_eq!(main, [at("MG0906", "programs/main.nc", 1)]);
    // A conversion that is named stands for its source.
    assert_eq!(found(&json(&shop, "haas/macro.nc --only fresh")), [at("MG0908", "haas/macro.nc", 1)]);
    assert_eq!(shop.run("convert --quiet").code, 0);
    assert_eq!(check(&shop, "").code, 0);
    std::fs::remove_file(shop.path("programs/new.nc")).unwrap();
    assert_eq!(found(&json(&shop, "")), [at("MG0909", "haas/new.nc", 1)]);
    assert_eq!(found(&json(&shop, "programs/alone.nc")), []);
    shop.run("convert --quiet --prune");
    assert_eq!(check(&shop, "").code, 0);
}

#[test]
fn a_profile_that_changed_makes_conversions_stale() {
    let shop = shop();
    let profile = "dialect = \"haas\"\n";
    shop.write("vf2.toml", profile.as_bytes());
    let project = PROJECT.replace("dialect = \"haas\"\n", "dialect = \"haas\"\nprofile = \"vf2.toml\"\n");
    shop.write("macroglot.toml", project.as_bytes());
    assert_eq!(shop.run("convert --quiet").code, 0);
    assert_eq!(check(&shop, "").code, 0);
    shop.write("vf2.toml", format!("{profile}reserved = [\"#550-#599\"]\n").as_bytes());
    let run = check(&shop, "programs/alone.nc");
    assert!(run.out.contains("MG0906 a machine profile changed after"), "{}", run.out);
    // The profile, or the project file, is about all of them.
    for named in ["vf2.toml", "macroglot.toml", "haas/macroglot.manifest"] {
        assert_eq!(found(&json(&shop, &format!("{named} --only fresh"))).len(), 3, "{named}");
    }
    // So is a profile that it extends.
    shop.write("base.toml", b"dialect = \"haas\"\n");
    shop.write("vf2.toml", format!("{profile}extends = \"base.toml\"\n").as_bytes());
    assert_eq!(shop.run("convert --quiet").code, 0);
    assert_eq!(check(&shop, "").code, 0);
    shop.write("base.toml", b"dialect = \"haas\"\nreserved = [\"#550-#599\"]\n");
    assert_eq!(found(&json(&shop, "base.toml --only fresh")).len(), 3);
    // A refused program is not one that was never converted.
    shop.write("programs/alone.nc", ALONE.replace("M30", "M38").as_bytes());
    assert_eq!(shop.run("convert --quiet").code, 1);
    assert_eq!(found(&json(&shop, "--only fresh")), []);
}

#[test]
fn a_signed_report_is_about_the_files_that_stand_there() {
    let shop = shop();
    shop.write("vf2.toml", b"dialect = \"haas\"\n");
    let project = PROJECT.replace("dialect = \"haas\"\n", "dialect = \"haas\"\nprofile = \"vf2.toml\"\n");
    shop.write(
        "macroglot.toml",
        project.replace("[checks]", "[checks]\nsigned = [\"signed.html\"]").as_bytes(),
    );
    assert_eq!(found(&json(&shop, "--only fresh")), [at("MG0910", "signed.html", 1)], "it is not there yet");
    assert_eq!(shop.run("convert --quiet --report signed.html").code, 0);
    assert_eq!(found(&json(&shop, "")), []);
    let told = |shop: &Shop| {
        let report = json(shop, "programs/alone.nc");
        let all = report["findings"].as_array().unwrap().iter().filter(|f| f["code"] == "MG0910");
        all.map(|f| f["message"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    shop.write("programs/alone.nc", ALONE.replace("X1.", "X2.").as_bytes());
    let main = shop.read("haas/main.nc");
    shop.write("haas/main.nc", b"O1000\nM30\n");
    let changed = "has changed since the report was signed";
    assert_eq!(told(&shop), [format!("haas/main.nc {changed}"), format!("programs/alone.nc {changed}")]);
    shop.write("haas/main.nc", main.as_bytes());
    shop.write("programs/alone.nc", ALONE.as_bytes());
    shop.write("vf2.toml", b"dialect = \"haas\"\nunits = \"metric\"\n");
    assert_eq!(told(&shop), [format!("the profile vf2.toml {changed}")]);
    shop.write("signed.html", b"<p>signed</p>");
    assert!(told(&shop)[0].starts_with("is no report"));
}

#[test]
fn codes_are_chosen_counted_and_allowed() {
    let shop = shop();
    let wrong = ALONE.replace("M30", "M38\nM39\nM30");
    shop.write("programs/alone.nc", wrong.as_bytes());
    let line = "--only read";
    assert_eq!(found(&json(&shop, line)).len(), 2);
    assert_eq!(found(&json(&shop, &format!("{line} --ignore MG03"))), []);
    assert_eq!(found(&json(&shop, &format!("{line} --select MG01,MG0310"))), []);
    assert_eq!(found(&json(&shop, &format!("{line} --select MG0301"))).len(), 2);
    assert_eq!(check(&shop, &format!("{line} --statistics")).out, "     2 MG0301 unknown meaning\n");
    assert_eq!(check(&shop, &format!("{line} --statistics --format sarif")).code, 2, "one or the other");
    let none = check(&shop, &format!("{line} --statistics --ignore MG0301"));
    assert!(none.out.contains("nothing found"), "{}", none.out);
    assert_eq!(check(&shop, &format!("{line} --exit-zero")).code, 0);
    shop.fails("check --cache cache --select MG77", &["'MG77' is no code"]);
    let allow =
        "\n[[checks.allow]]\ncode = \"MG0301\"\npath = \"programs/al*.nc\"\nreason = \"the builder's\"\n";
    shop.write("macroglot.toml", format!("{PROJECT}{allow}").as_bytes());
    let report = json(&shop, line);
    assert_eq!(found(&report), []);
    assert_eq!(report["suppressed"][1]["reason"], "the builder's");
    assert!(check(&shop, line).out.contains("nothing found, 2 allowed by the project file"));
    shop.write("macroglot.toml", format!("{PROJECT}{}", allow.replace("the builder's", "")).as_bytes());
    shop.fails("check --cache cache", &["macroglot.toml", "say why MG0301 is allowed"]);
    shop.write("macroglot.toml", PROJECT.replace("[\"vf2\"]", "[\"vf3\"]").as_bytes());
    shop.fails("check --cache cache", &["round trip to 'vf3'"]);
}

#[test]
fn only_what_is_new_counts_against_a_baseline() {
    let shop = shop();
    shop.write("programs/alone.nc", ALONE.replace("M30", "M38\nM30").as_bytes());
    let written = check(&shop, "--only read --write-baseline known.json");
    assert_eq!(written.code, 0, "{}", written.out);
    let run = check(&shop, "--only read --baseline known.json");
    assert_eq!(
        (run.code, run.out.as_str()),
        (0, "3 files checked, nothing found, 1 known to the baseline\n")
    );
    // The line moves, and another one comes.
    shop.write("programs/alone.nc", ALONE.replace("M30", "(NEW)\nM38\nM39\nM30").as_bytes());
    let report = json(&shop, "--only read --baseline known.json");
    assert_eq!(found(&report), [at("MG0301", "programs/alone.nc", 6)]);
    shop.fails("check --cache cache --baseline gone.json", &["gone.json", "--write-baseline"]);
    shop.fails("check --cache cache --write-baseline programs/main.nc", &["is an input"]);
}

#[test]
fn every_format_says_the_same() {
    let shop = shop();
    shop.write("programs/alone.nc", ALONE.replace("M30", "M38 (50%, ::x::)\nM30").as_bytes());
    let line = "programs/alone.nc --only read";
    let github = check(&shop, &format!("{line} --format github")).out;
    assert!(github.starts_with("::error file=programs/alone.nc,line=4,col=1,"), "{github}");
    assert_eq!(github.lines().count(), 1, "{github}");
    let sarif = crate::sarif::valid(&check(&shop, &format!("{line} --format sarif")).out);
    let result = &sarif["runs"][0]["results"][0];
    assert_eq!(result["ruleId"], "MG0301");
    assert!(result["partialFingerprints"]["macroglot/v1"].is_string(), "{result}");
    let junit = check(&shop, &format!("{line} --format junit")).out;
    let read = quick_junit::Report::deserialize_from_str(&junit).unwrap();
    assert_eq!((read.tests, read.failures), (1, 1));
    assert!(junit.contains("type=\"MG0301\"") && junit.contains("programs/alone.nc"), "{junit}");
    assert_eq!(check(&shop, "programs/main.nc --only read --format junit").code, 0);
}

#[test]
fn without_a_project_the_arguments_say_all() {
    let shop = Shop::with(&[("a.nc", CLEAN), ("b.nc", &REFUSED.replace("M38", "G1"))]);
    assert_eq!(check(&shop, "a.nc --dialect fanuc --against haas").code, 0);
    shop.fails("check --cache cache", &["no macroglot.toml"]);
    shop.fails("check --cache cache a.nc --dialect fanuc --against siemens", &["siemens"]);
    let run = shop.run_on("check --cache cache - --dialect fanuc --only read", REFUSED);
    assert_eq!(run.code, 1);
    assert!(run.out.starts_with("-:5:1: MG0301"), "{}", run.out);
}
