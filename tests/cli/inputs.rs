//! What is read, and what is not.

use super::{CLEAN, Shop, names, repository};

#[test]
fn what_cannot_be_read_is_said() {
    let shop = Shop::with(&[("empty.nc", ""), ("docs/notes.pdf", "x"), ("a.nc", CLEAN)]);
    shop.write("binary.nc", b"\x7fELF\x02\x01\x01\0\0\0\0\0\0\0\0\0\x03\0\0\0");
    let to = "--from fanuc --to haas --out out";
    shop.fails(&format!("convert nowhere {to}"), &["nowhere", "no such file or folder"]);
    shop.fails(&format!("convert a.nc nowhere {to}"), &["nowhere"]);
    shop.fails(&format!("convert empty.nc {to}"), &["empty.nc", "empty"]);
    shop.fails(&format!("convert binary.nc {to}"), &["binary.nc", "binary file"]);
    shop.fails(&format!("convert docs {to}"), &["docs", "no program files", ".nc"]);
    for command in ["parse", "ir"] {
        shop.fails(&format!("{command} nowhere --dialect fanuc"), &["nowhere"]);
        shop.fails(&format!("{command} empty.nc --dialect fanuc"), &["empty"]);
        shop.fails(&format!("{command} binary.nc --dialect fanuc"), &["binary"]);
        shop.fails(&format!("{command} docs --dialect fanuc"), &["no program files"]);
    }
}

/// A folder of programs may hold a file that is none; it is named and left out.
#[test]
fn a_folder_is_converted_without_what_is_no_program() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/empty.nc", ""), ("in/sub/b.txt", CLEAN)]);
    let run = shop.run("convert in --from fanuc --to haas --out out --quiet");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("empty.nc"), "{}", run.err);
    let all = shop.files();
    let written: Vec<&str> = names(&all).into_iter().filter(|name| name.starts_with("out/")).collect();
    assert_eq!(
        written,
        [
            "out/a.nc",
            "out/a.nc.certificate.json",
            "out/macroglot.lock",
            "out/macroglot.manifest",
            "out/sub/b.txt",
            "out/sub/b.txt.certificate.json"
        ]
    );
}

#[test]
fn standard_input_to_standard_output() {
    let run = Shop::empty().run_on("convert - --from fanuc --to haas", CLEAN);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.starts_with("%\nO1234\n") && run.out.ends_with("M30\n%\n"), "{}", run.out);
    assert!(run.err.contains("1 program in 1 file"), "{}", run.err);
    Shop::empty().fails("convert - --from fanuc --to haas", &["empty"]);
}

#[test]
fn the_control_is_recognized_where_the_text_shows_it() {
    let shop = Shop::empty();
    for dialect in ["fadal", "cc100"] {
        let folder = repository(&format!("corpus/{dialect}"));
        let named = shop.run(&format!("ir {folder}/{} --dialect {dialect}", first(dialect)));
        let found = shop.run(&format!("ir {folder}/{}", first(dialect)));
        assert_eq!(found.out, named.out, "{dialect}: {}", found.err);
    }
}

/// A program that only its own control reads.
fn first(dialect: &str) -> &'static str {
    match dialect {
        "fadal" => "o800-dhole.nc",
        _ => "example10-ellipse.nc",
    }
}

#[test]
fn a_control_that_is_not_certain_is_asked_for() {
    let shop = Shop::with(&[("a.nc", "O1\nG0 X1. Y2.\nM30\n")]);
    shop.fails("convert a.nc --to haas", &["not certain", "--from"]);
    shop.fails("parse a.nc", &["not certain", "--dialect"]);
}

#[test]
fn a_machine_of_the_source_says_its_control() {
    let shop = Shop::with(&[
        ("a.nc", "O1\nG0 X1. Y2.\nM30\n"),
        ("vf.toml", "dialect = \"haas\"\n"),
        ("own.toml", "dialect = \"fanuc\"\n"),
        ("third.toml", "dialect = \"fadal\"\n"),
    ]);
    for line in [
        "run a.nc --machine vf.toml",
        "ir a.nc --machine vf.toml",
        "diff --normalise a.nc --machine own.toml",
        "survey a.nc --machine own.toml",
        "convert a.nc --to haas --machine vf.toml --machine own.toml --out to-haas",
        "convert a.nc --to fanuc --machine own.toml --machine own.toml --out to-fanuc",
    ] {
        let run = shop.run(line);
        assert_ne!(run.code, 2, "{line}: {}", run.err);
        assert!(!run.err.contains("not certain"), "{line}: {}", run.err);
    }
    // The target's machine alone says nothing of the source.
    shop.fails("convert a.nc --to haas --machine vf.toml --out out", &["not certain", "--from"]);
    shop.fails("convert a.nc --to haas --machine own.toml --machine third.toml --out out", &["not certain"]);
    // It is not passed over where the program is said to be another's.
    shop.fails("run a.nc --dialect fanuc --machine vf.toml", &["profile for 'haas'", "'fanuc'"]);
}

#[test]
fn a_folder_of_two_kinds_is_not_guessed_and_a_wrong_name_is_told() {
    let fadal = "O2\n#V1=5\n#R1=V1\n#IF V1 GT 3 THEN GOTO :A\n#V1=1\n#:A\nG90 G0 X+R1\nM2\n";
    let fanuc =
        "O1\n#1=5\nWHILE [#1 GT 3] DO1\n#1=#1-1\nEND1\nIF [#1 EQ 3] GOTO 9\nG66 P9010 A1.\nG67\nN9 M30\n";
    let shop = Shop::with(&[("in/a.nc", fanuc), ("in/b.nc", fadal), ("in/c.nc", "O3\nG0 X1.\nM30\n")]);
    shop.fails(
        "convert in --to haas --out out",
        &["the files are for different controls", "a.nc looks like fanuc", "--from"],
    );
    let run = shop.run("convert in/b.nc --from fanuc --to haas --out out --format json");
    assert!(run.err.contains("looks like fadal"), "{}", run.err);
    let json: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert!(json["notes"][0].as_str().unwrap().contains("looks like fadal"));
    assert_eq!(json["programs"][0]["outcome"], "refused");
    let run = shop.run("convert in/b.nc in/c.nc --to haas --out out2");
    assert!(run.out.contains("2 programs in 2 files"), "{}", run.out);
    assert!(!run.err.contains("looks like"), "{}", run.err);
}

#[test]
fn one_name_in_two_folders_is_an_error_and_one_file_named_twice_is_not() {
    let shop = Shop::with(&[("one/a.nc", CLEAN), ("two/a.nc", CLEAN)]);
    shop.fails("convert one two --from fanuc --to haas --out out", &["one/a.nc", "two/a.nc"]);
    let run = shop.run("convert one one/a.nc --from fanuc --to haas --out out --quiet");
    assert_eq!(run.code, 0, "{}", run.err);
}

/// Two programs with one number: both are converted, and a person must choose which one to load. The library is asked that,
/// once.
/// A call of that number cannot be converted, because it is not known which one is meant.
#[test]
fn two_programs_with_one_number() {
    let caller = CLEAN.replace("O1234", "O1000").replace("M30", "M98 P1234\nM30");
    let sub = CLEAN.replace("M30", "M99");
    let shop = Shop::with(&[("in/a.nc", &sub), ("in/b.nc", &sub), ("in/call.nc", &caller)]);
    let run = shop.run("convert in --from fanuc --to haas --out out --format json");
    assert_eq!(run.code, 1);
    let json: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    for program in json["programs"].as_array().unwrap() {
        let codes: Vec<&str> =
            program["diagnostics"].as_array().unwrap().iter().map(|d| d["code"].as_str().unwrap()).collect();
        if program["source"] == "in/call.nc" {
            assert_eq!(program["outcome"], "refused");
            assert!(codes.contains(&"MG0603"), "{codes:?}");
        } else {
            assert_eq!(program["outcome"], "converted");
            assert!(codes.contains(&"MG0602"), "{codes:?}");
        }
    }
    let asked: Vec<_> = json["library"].as_array().unwrap().iter().map(|asked| &asked["code"]).collect();
    assert_eq!(asked, ["MG0602", "MG0602"], "a question for each file that it names");
}

/// What is not read is counted, with the reason, and named if that is asked for.
#[cfg(unix)]
#[test]
fn nothing_is_left_out_in_silence() {
    let shop = Shop::with(&[
        ("in/a.nc", CLEAN),
        ("in/.b.nc", CLEAN),
        ("in/.git/x/y.nc", CLEAN),
        ("in/old/c.nc", CLEAN),
        ("in/.gitignore", "old/\n"),
        ("in/d.pdf", "x"),
        ("in/e.nc", ""),
        ("in/macroglot.toml", ""),
    ]);
    shop.write("in/f.nc", b"\x7fELF\x02\x01\x01\0\0\0\0\0\0\0\0\0\x03\0\0\0");
    std::os::unix::fs::symlink(shop.path("in/a.nc"), shop.path("in/g.nc")).unwrap();
    let line = "convert in --from fanuc --to haas --out out --quiet";
    let counted = "left out: 3 hidden, 1 ignored, 1 a link, 1 with an unknown ending, 1 empty, 1 binary";
    let run = shop.run(line);
    assert!(run.out.contains(&format!("{counted}; --verbose names them\n")), "{}", run.out);
    let run = shop.run(&format!("{line} --verbose"));
    for told in [
        "in/.b.nc: hidden",
        "in/.git: hidden",
        "in/.gitignore: hidden",
        "in/old: ignored",
        "in/g.nc: a link",
        "in/d.pdf: with an unknown ending",
        "in/e.nc: empty",
        "in/f.nc: binary",
    ] {
        assert!(run.out.contains(&format!("left out   {told}\n")), "{told}: {}", run.out);
    }
    let run = shop.run(&format!("{line} --format json"));
    assert!(run.out.contains("\"path\": \"in/old\",\n      \"why\": \"ignored\""), "{}", run.out);
    let run = shop.run("parse in --dialect fanuc");
    assert!(run.out.starts_with(counted), "{}", run.out);
    let run = shop.run("parse in --dialect fanuc --format json");
    assert!(run.out.contains("{\"path\":\"in/d.pdf\",\"why\":\"unknown\"}"), "{}", run.out);
}

/// A file without an ending that begins as programs do is one; the survey names what it does not read.
#[test]
fn a_name_without_an_ending_is_no_reason_to_leave_a_program_out() {
    let shop = Shop::with(&[
        ("in/a.nc", CLEAN),
        ("in/PROBE_IN", "%\n<PROBE_IN>(PROBE)\nG21 G90 G0 X1.\nM30\n%\n"),
        ("in/SETTER", "%\nO77(SETTER)\nG21 G90 G0 X1.\nM30\n%\n"),
        ("in/LICENCE", "Anyone may use these programs.\n"),
        ("in/page", "<html>\n<p>O1</p>\n</html>\n"),
        ("in/b.bak", "O1\nM30\n"),
    ]);
    let run = shop.run("survey in --from fanuc --to haas");
    assert!(run.out.contains("library   3 programs in 3 files"), "{}", run.out);
    let told = "left out 2 files with an unknown ending: in/LICENCE, in/page; name a file itself to read it";
    assert!(run.err.contains(told) && run.err.contains("in/b.bak"), "{}", run.err);
}

/// An ignore file says what a walk passes by; a folder that is named by hand is not passed by.
#[test]
fn an_ignored_folder_that_is_named_is_read() {
    let shop = Shop::with(&[(".gitignore", "made/*\n"), ("made/a.nc", CLEAN), ("b.nc", CLEAN)]);
    for named in ["made", "made/a.nc"] {
        let run = shop.run(&format!("convert {named} --from fanuc --to haas --out out"));
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{named}");
    }
    let run = shop.run("parse . --dialect fanuc");
    assert!(run.out.starts_with("left out: 1 hidden, 1 ignored"), "{}", run.out);
}

/// A folder is converted into one below it, again and again: what a run wrote there is no source of the next.
#[test]
fn an_output_folder_below_is_no_source() {
    let shop = Shop::with(&[("a.nc", CLEAN), ("sub/b.nc", CLEAN)]);
    let line = "convert . --from fanuc --to haas --out out --verbose";
    let first = shop.run(line);
    assert!(first.code == 0 && !first.out.contains("written by"), "{}", first.out);
    let told = "out: written by macroglot\n";
    let again = shop.run(line);
    assert!(again.code == 0 && again.out.contains(told), "{}", again.out);
    assert!(again.out.contains("2 programs in 2 files"), "{}", again.out);
    // Named by hand, it is read.
    let back = shop.run("convert out --from haas --to fanuc --out back --quiet");
    assert!(back.code == 0 && shop.read("back/sub/b.nc").contains("O1234"), "{}", back.out);
}
