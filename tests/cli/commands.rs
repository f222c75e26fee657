//! The commands beside `convert`.

use super::{CLEAN, REFUSED, Shop, repository};
use std::io::Read;
use std::process::{Command, Stdio};

#[test]
fn parse_counts_blocks_and_says_what_is_lost() {
    let shop = Shop::with(&[("a.nc", "O1\nG0 X1.\nM30\n"), ("b.nc", "O2\nG0 X1.2.3\nM30\n")]);
    let run = shop.run("parse a.nc --dialect fanuc --format json");
    let json: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    for (key, value) in [("files", 1), ("bytes", 14), ("blocks", 3), ("unparsed", 0), ("lossless", 1)] {
        assert_eq!(json[key], value, "{key}");
    }
    assert!(json["seconds"].is_f64());
    let run = shop.run("parse . --dialect fanuc --format json");
    let json: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(run.code, 1, "a block that is not read");
    assert_eq!((&json["files"], &json["unparsed"], &json["lossless"]), (&2.into(), &1.into(), &2.into()));
    let run = shop.run("parse . --dialect fanuc --faults");
    assert!(run.err.contains("b.nc:2:") && run.out.contains("1 unparsed"), "{}{}", run.err, run.out);
}

#[test]
fn ir_prints_text_that_parses_back() {
    let shop = Shop::with(&[("a.nc", CLEAN), ("b.nc", REFUSED)]);
    let run = shop.run("ir a.nc --dialect fanuc");
    assert_eq!(run.code, 0, "{}", run.err);
    let module = macroglot::ir::text::parse(&run.out).unwrap();
    assert_eq!(module.to_string(), run.out);
    let run = shop.run("ir b.nc --dialect fanuc");
    assert_eq!(run.code, 1);
    assert!(run.err.contains("M38"), "{}", run.err);
    assert_eq!(shop.run_on("ir - --dialect haas", CLEAN).code, 0);
}

#[test]
fn dialects_are_shown_side_by_side_and_one_by_one() {
    let shop = Shop::empty();
    let all = shop.run("dialects");
    assert_eq!(all.code, 0);
    for name in ["fadal", "fanuc", "haas", "cc100"] {
        assert!(all.out.contains(name), "{name}");
        let one = shop.run(&format!("dialects {name}"));
        assert_eq!(one.code, 0);
        assert!(one.out.lines().count() > 100 && one.out.contains("seed"), "{name}");
    }
    let plain = shop.run("dialects haas").out;
    let machine = shop.run(&format!("dialects haas --machine {}", repository("machines/haas-vf.toml"))).out;
    assert_ne!(plain, machine, "a profile changes the page");
}

#[test]
fn explain_prints_pages() {
    let shop = Shop::empty();
    let page = shop.run("explain MG0401");
    assert_eq!(page.code, 0);
    assert!(page.out.starts_with("MG0401: ") && page.out.contains("refused"), "{}", page.out);
    for spelling in ["0401", "mg0401"] {
        assert_eq!(shop.run(&format!("explain {spelling}")).out, page.out);
    }
    let all = shop.run("explain");
    assert_eq!((all.code, all.out.lines().count()), (0, macroglot::diag::ALL.len()));
}

#[test]
fn completions_name_the_commands() {
    let shop = Shop::empty();
    for shell in ["bash", "zsh", "fish"] {
        let run = shop.run(&format!("completions {shell}"));
        assert_eq!(run.code, 0, "{shell}");
        for word in ["macroglot", "convert", "draft", "explain"] {
            assert!(run.out.contains(word), "{shell}: {word}");
        }
    }
}

/// Whoever reads only a part, as `head` does, is not told of a fault.
#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_macroglot"))
        .args(["dialects", "fanuc"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let mut err = String::new();
    child.stderr.take().unwrap().read_to_string(&mut err).unwrap();
    assert_eq!((child.wait().unwrap().code(), err.as_str()), (Some(0), ""));
}
