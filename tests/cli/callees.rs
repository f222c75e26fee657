//! Certificates of programs that call one another: each rests on the others' texts.

use super::stale::{TO, in_out};
use super::{REFUSED, Shop};

const MAIN: &str = "O1\nG21 G90 G54 G0 X0 Y0\nM98 P2\nM30\n";
const CALLED: &str = "O2\nG1 X10. F100.\nM98 P3\nM99\n";
const DEEPER: &str = "O3\nG1 Y10. F100.\nM99\n";
const OTHERS: &str = "programs that it calls, or that call it, have changed since it was verified";
const ALONE: &str = "O4\nG21 G90 G54 G0 X5. Y0\nM30\n";

/// Four programs in files of their own, converted: a calls b, b calls c, and d calls nothing.
fn calling() -> Shop {
    let shop = Shop::with(&[("in/a.nc", MAIN), ("in/b.nc", CALLED), ("in/c.nc", DEEPER), ("in/d.nc", ALONE)]);
    assert_eq!(shop.run(&format!("convert in {TO} --out out")).code, 0);
    assert!(shop.read("out/a.nc.certificate.json").contains("\"outcome\": \"same\""));
    shop
}

fn certified(shop: &Shop) -> Vec<String> {
    let programs = in_out(shop).into_iter();
    programs.filter_map(|name| Some(name.strip_suffix(".nc.certificate.json")?.to_owned())).collect()
}

/// A certificate says what was found of a program together with what it calls, and as its callers come to it. Where one of
/// these is another text now, it goes.
#[test]
fn a_certificate_goes_when_what_its_program_calls_is_another() {
    let shop = calling();
    // The same text again changes nothing.
    assert!(!shop.run(&format!("convert in/c.nc {TO} --out out")).out.contains("unverified"));
    assert_eq!(certified(&shop), ["a", "b", "c", "d"]);
    shop.write("in/c.nc", DEEPER.replace("Y10.", "Y11.").as_bytes());
    let run = shop.run(&format!("convert in/c.nc {TO} --out out"));
    for name in ["a", "b"] {
        let told = format!("unverified {name}.nc: {OTHERS}: c.nc; ");
        assert!(run.out.contains(&told), "{}", run.out);
    }
    assert!(!run.out.contains("d.nc"), "{}", run.out);
    assert_eq!(certified(&shop), ["c", "d"]);
    // The programs themselves stay, and it is told once.
    assert!(in_out(&shop).contains(&"a.nc".to_owned()));
    assert!(!shop.run(&format!("convert in/c.nc {TO} --out out")).out.contains("unverified"));
    assert_eq!(shop.run(&format!("convert in {TO} --out out")).code, 0);
    assert_eq!(certified(&shop), ["a", "b", "c", "d"]);
}

/// A called program was begun in what its callers gave it.
#[test]
fn a_certificate_goes_when_its_caller_is_another() {
    let shop = calling();
    assert!(!shop.run(&format!("convert in/a.nc {TO} --out out")).out.contains("unverified"));
    shop.write("in/a.nc", MAIN.replace("G90", "G91").as_bytes());
    let run = shop.run(&format!("convert in/a.nc {TO} --out out"));
    for name in ["b", "c"] {
        assert!(run.out.contains(&format!("unverified {name}.nc: {OTHERS}: a.nc; ")), "{}", run.out);
    }
    assert_eq!(certified(&shop), ["a", "d"]);
    // One callee of a caller may leave the machine otherwise to the next.
    let shop = calling();
    shop.write("in/a.nc", MAIN.replace("M98", "M98 P4\nM98").as_bytes());
    shop.write("in/d.nc", b"O4\nG90\nM99\n");
    assert_eq!(shop.run(&format!("convert in {TO} --out out")).code, 0);
    shop.write("in/d.nc", b"O4\nG91\nM99\n");
    shop.run(&format!("convert in/d.nc {TO} --out out"));
    assert_eq!(certified(&shop), ["d"]);
}

#[test]
fn a_certificate_goes_when_what_its_program_calls_goes() {
    for (text, more, what) in
        [(REFUSED, "", "refused"), (REFUSED, "--draft", "a draft"), ("", "--prune", "gone")]
    {
        let shop = calling();
        let path = match text {
            "" => {
                std::fs::remove_file(shop.path("in/b.nc")).unwrap();
                "in/d.nc"
            }
            _ => {
                shop.write("in/b.nc", text.as_bytes());
                "in/b.nc"
            }
        };
        let run = shop.run(&format!("convert {path} {TO} --out out --format json {more}"));
        let json: serde_json::Value = serde_json::from_str(&run.out).unwrap();
        assert_eq!(
            json["folders"][0]["uncertified"],
            serde_json::json!({ "a.nc": ["b.nc"], "c.nc": ["b.nc"] }),
            "{what}"
        );
        assert_eq!(certified(&shop), ["d"], "{what}");
    }
}

/// What a person changed in the folder is found by `verify`, in what calls it too.
#[test]
fn verify_tells_whose_callees_are_others_now() {
    let shop = calling();
    assert!(!shop.run(&format!("verify in out {TO}")).err.contains("certificate"));
    shop.write("out/b.nc", shop.read("out/b.nc").replace("X10.", "X12.").as_bytes());
    let run = shop.run(&format!("verify in out {TO}"));
    assert!(run.err.contains("b.nc: was changed since macroglot wrote it"), "{}", run.err);
    for name in ["a", "c"] {
        let told =
            "a program that it calls, or that calls it, has changed since its certificate was made: b.nc";
        assert!(run.err.contains(&format!("{name}.nc: {told}")), "{}", run.err);
    }
    assert!(!run.err.contains("d.nc"), "{}", run.err);
}

/// Manifests of earlier versions do not say what certificates rest on.
#[test]
fn a_manifest_that_says_nothing_of_callees_is_read() {
    let shop = calling();
    let manifest = shop.read("out/macroglot.manifest");
    let lines = |text: &str, word: &str| {
        let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with(word)).collect();
        lines.join("\n")
    };
    let blocks = manifest.split("\n\n").filter(|block| !block.contains("[together."));
    let silent = lines(&blocks.collect::<Vec<_>>().join("\n\n"), "rests_on");
    assert!(silent.len() + 200 < manifest.len());
    shop.write("out/macroglot.manifest", silent.as_bytes());
    shop.write("in/c.nc", DEEPER.replace("Y10.", "Y11.").as_bytes());
    let run = shop.run(&format!("convert in/c.nc {TO} --out out"));
    assert_eq!((run.code, certified(&shop).len()), (0, 4), "{}", run.err);
}

/// Many programs that call the same ones do not each have a list of all.
#[test]
fn the_manifest_grows_with_the_library() {
    let size = |mains: usize| {
        let shop = Shop::empty();
        for at in 0..mains + 4 {
            let calls = if at < 4 { "M99\n" } else { "M98 P1\nM98 P2\nM98 P3\nM98 P4\nM30\n" };
            shop.write(&format!("in/{at:03}.nc"), format!("O{}\nG21 G90\n{calls}", at + 1).as_bytes());
        }
        shop.run(&format!("convert in {TO} --out out --quiet"));
        assert_eq!(certified(&shop).len(), mains + 4);
        shop.read("out/macroglot.manifest").len()
    };
    let (few, more) = (size(6), size(36));
    // Thirty programs more: each has two entries, and stands in the list of the four that all call, or in its own.
    assert!(more - few < 30 * 2_000, "{few} {more}");
    assert!(more < 6 * few, "{few} {more}");
}

const CALLER: &str = "O1\nG21 G90 G17 G54\n#101=20.\nG0 Z50.\nM98 P2\nG0 X#102\nM30\n";
const SUM: &str = "O2\n#102=#101*2\nG1 X#102 F100.\nM99\n";

/// One program of a library goes where it goes with the whole, and the rest stays as it is.
#[test]
fn a_program_is_converted_with_its_library() {
    let shop = Shop::with(&[("lib/main.nc", CALLER), ("lib/sub/o2.nc", SUM), ("lib/other.nc", "O7\nM30\n")]);
    let whole = shop.run("convert lib --from fanuc --to haas --out whole --quiet");
    assert_eq!(whole.code, 0, "{}", whole.out);
    let one = shop.run("convert lib/main.nc --library lib --from fanuc --to haas --out one --quiet");
    assert_eq!(one.code, 0, "{}", one.err);
    assert_eq!(shop.read("one/main.nc"), shop.read("whole/main.nc"));
    assert!(!shop.path("one/sub").exists() && !shop.path("one/other.nc").exists());
    // What it calls must stand there too; what it does not call need not.
    assert!(one.err.contains("one/sub/o2.nc is not there yet: convert lib/sub/o2.nc"), "{}", one.err);
    assert!(!one.err.contains("other.nc"), "{}", one.err);
    assert!(one.out.contains("1 program in 1 file") && one.out.contains("1 verified"), "{}", one.out);
    let both = shop.run("convert lib/sub/o2.nc --library lib --from fanuc --to haas --out one --quiet");
    assert_eq!((both.code, both.err.as_str()), (0, ""));
    assert_eq!(shop.read("one/sub/o2.nc"), shop.read("whole/sub/o2.nc"));
    assert_eq!(shop.read("one/macroglot.lock"), shop.read("whole/macroglot.lock"));
    // Its certificate rests on what it was verified with, and goes when that changes.
    assert!(shop.path("one/main.nc.certificate.json").exists());
    // The source of the callee changes: its conversion is the old one.
    shop.write("lib/sub/o2.nc", SUM.replace("*2", "*3").as_bytes());
    let again = shop.run("convert lib/main.nc --library lib --from fanuc --to haas --out one --quiet");
    let what =
        "one/sub/o2.nc is not what this conversion goes with: convert lib/sub/o2.nc into the same folder too";
    assert!(again.err.contains(what), "{}", again.err);
    shop.write("lib/sub/o2.nc", SUM.replace("*2", "*4").as_bytes());
    let other = shop.run("convert lib/sub/o2.nc --library lib --from fanuc --to haas --out one --quiet");
    assert!(other.out.contains("unverified main.nc: "), "{}", other.out);
    assert!(!shop.path("one/main.nc.certificate.json").exists());
}

/// The library is read and never written, whatever is named.
#[test]
fn a_library_is_never_written() {
    let shop = Shop::with(&[("main.nc", CALLER), ("lib/o2.nc", SUM)]);
    // A file that does not stand in the library goes with it all the same; alone it goes to standard output.
    let run = shop.run("convert main.nc --library lib --from fanuc --to haas --quiet");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("M98 P2") && !run.out.contains("O0002"), "{}", run.out);
    // Without the library nothing is known of what it calls.
    let alone = shop.run("convert main.nc --from fanuc --to haas --quiet");
    assert!(alone.err.contains("0 verified"), "{}", alone.err);
    shop.fails(
        "convert main.nc --library lib --from fanuc --to haas --out lib",
        &["lib/o2.nc", "overwritten"],
    );
    assert_eq!(shop.read("lib/o2.nc"), SUM);
    shop.fails("convert main.nc --library lib --from fanuc --to haas --out .", &["main.nc", "overwritten"]);
    shop.fails("convert --library lib", &["--library goes with files"]);
    shop.write("lib/main.nc", b"O9\nM30\n");
    let twice = ["main.nc and lib/main.nc would both be written to main.nc"];
    shop.fails("convert main.nc --library lib --from fanuc --to haas --out out", &twice);
}

/// Reports tell of the named programs, and show them with what they call.
#[test]
fn a_report_tells_of_the_named_programs() {
    let shop = Shop::with(&[("lib/main.nc", CALLER), ("lib/o2.nc", SUM)]);
    let line = "convert lib/main.nc --library lib --from fanuc --to haas --out out --report r.html --report r.json --report r.md";
    assert_eq!(shop.run(line).code, 0);
    let json: serde_json::Value = serde_json::from_str(&shop.read("r.json")).unwrap();
    assert_eq!(json["programs"].as_array().map(Vec::len), Some(1));
    assert_eq!(json["programs"][0]["verdict"], "same");
    let (html, markdown) = (shop.read("r.html"), shop.read("r.md"));
    assert!(!markdown.contains("o2.nc"), "{markdown}");
    // The path goes to X40 in the callee: the run of the picture had it. The hash of its source is in the report.
    assert!(html.contains("In this run no move, feed, wait or stop differs") && html.contains("lib/o2.nc"));
}
