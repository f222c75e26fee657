//! The commands beside `convert`.

use super::{CLEAN, REFUSED, Shop, repository};
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::time::Duration;

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

/// What is printed piece by piece is what is printed at once: a drawing needs the whole trace.
#[test]
fn a_long_trace_is_printed_whole() {
    let calls =
        "O1\nG21 G90\nM98 P2 L2500\nM98 P3 L2500\nM30\nO2\nG0 X1.\nG0 X2.\nM99\nO3\nG0 Y1.\nG0 Y2.\nM99\n";
    let shop = Shop::with(&[("a.nc", calls)]);
    for trace in ["text", "json"] {
        let pieces = shop.run(&format!("run a.nc --dialect fanuc --trace {trace}"));
        let whole = shop.run(&format!("run a.nc --dialect fanuc --trace {trace} --plot a.svg"));
        assert_eq!((pieces.code, whole.code), (0, 0), "{}", pieces.err);
        assert!(pieces.out.lines().count() > 10_000, "{}", pieces.out.lines().count());
        assert!(pieces.out == whole.out, "{trace}");
    }
}

/// A program that is longer than a run says so, and by which option it comes to its end.
#[test]
fn a_run_that_is_cut_short_names_the_option_that_allows_more() {
    let shop = Shop::with(&[("a.nc", "O1\n#1=0\nN1 #1=#1+1\nIF[#1LT50]GOTO1\nM30\n")]);
    let run = |steps: u32| shop.run(&format!("run a.nc --dialect fanuc --steps {steps}"));
    let (cut, whole) = (run(60), run(103));
    assert_eq!((cut.code, whole.code), (1, 0), "{}", whole.err);
    assert!(cut.out.ends_with("60 blocks; the program goes on, and --steps allows more\n"), "{}", cut.out);
    assert!(cut.err.contains("after 60 blocks the program is still running; --steps allows"), "{}", cut.err);
    assert!(whole.out.ends_with("\n103 blocks\n"), "{}", whole.out);
}

/// A run without end, of which the reader has seen one, fill no memory.
#[test]
#[cfg(target_os = "linux")]
fn a_long_trace_is_not_kept() {
    let shop = Shop::with(&[("a.nc", "O1\nG21 G90\nN1 G0 X1.\nG0 X2.\nGOTO 1\n")]);
    let mut child = Command::new(env!("CARGO_BIN_EXE_macroglot"))
        .args(["run", "a.nc", "--dialect", "fanuc"])
        .current_dir(shop.path(""))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let first = lines.next().unwrap().unwrap();
    // It would be in the middle of its run, or done and full.
    std::thread::sleep(Duration::from_secs(2));
    let facts = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
    let count = 1 + lines.count();
    let code = child.wait().unwrap().code();
    assert!(first.contains("O1:3  rapid   X1"), "{first}");
    let peak = facts.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    let peak: u64 = peak.trim().trim_end_matches(" kB").parse().unwrap();
    assert!(peak < 100_000, "{peak} kB");
    assert!(code == Some(1) && count > 20_000, "{code:?}, {count} lines");
}

/// On a terminal people read words; what scripts read is the certificate.
#[test]
fn a_certificate_is_printed_in_words_on_request() {
    let shop = Shop::with(&[("a.nc", CLEAN), ("b.nc", &CLEAN.replace("X2.", "X2.5"))]);
    let line = "verify a.nc a.nc --from fanuc --to fanuc";
    let words = shop.run(&format!("{line} --format text"));
    assert_eq!(words.code, 0);
    assert!(words.out.starts_with("O1234 (a.nc and a.nc)\n  The same: in no scenario"), "{}", words.out);
    assert!(words.out.ends_with("\n\n1 program: 1 the same, 0 undecided, 0 different\n"), "{}", words.out);
    assert!(shop.run(line).out.starts_with("{\n  \"format\""));
    let words = shop.run("verify a.nc b.nc --from fanuc --to fanuc --format text");
    assert_eq!(words.code, 1);
    let differ =
        "    source: G1 X2. F10., line 5 of a.nc O1234\n    target: G1 X2.5 F10., line 5 of b.nc O1234\n";
    assert!(words.out.contains("  Where they differ: ") && words.out.contains(differ), "{}", words.out);
}

/// Two controls of a family read most texts alike: the target is not the source, and without one the user says which it is.
#[test]
fn of_two_controls_that_read_a_text_alike_the_target_is_not_the_source() {
    let text = "O1234\nG20 G17 G90 G40 G80 G94\n#101=1.\nWHILE [#101 LT 3.] DO1\nG1 X#101 F10.\n#101=#101+1.\nEND1\nM30\n";
    let shop = Shop::with(&[("a.nc", text)]);
    let run = shop.run("convert a.nc --to haas");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("the programs are read as fanuc; they may be haas as well"), "{}", run.err);
    let run = shop.run("convert a.nc --to fanuc");
    assert!(run.err.contains("the programs are read as haas; they may be fanuc as well"), "{}", run.err);
    shop.fails("convert a.nc --to fadal", &["it may be fanuc or haas", "--from"]);
}
