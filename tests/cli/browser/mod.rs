//! Reports in a real browser: they open, filter, link and print, and nothing of a program acts in them.

mod driver;

use crate::{CLEAN, REFUSED};
use assert_cmd::Command;
use driver::Browser;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// No block has the number that it jumps to, so that it is for review.
const REVIEW: &str = "%\nO1236\nG17 G90 G40 G80 G94\n#500=#501+1.\nIF[#501EQ9.]GOTO30\nG0 X#500\nG1 Y2. F10.\nG2 X3. Y1. I1. J0.\nM30\n%\n";

/// Markup, quotes, signs that act in a terminal, and an end of a comment of HTML.
const HOSTILE: &str = "%\nO1237\n(</td></table><script>window.acted=1</script><img src=x onerror=window.acted=2>)\n\
                       (--></style><svg onload=window.acted=3> \u{202e}\u{1b}[31m ' \" &amp;)\nG20 G17 G90 G40 G80 G94\nG0 X1.\nM30\n%\n";

fn convert(folder: &Path, arguments: &str) {
    let mut command = Command::cargo_bin("macroglot").unwrap();
    let line = format!("convert in --from fanuc --to haas --out out --report r.html {arguments}");
    let output =
        command.args(line.split_whitespace()).current_dir(folder).env("SOURCE_DATE_EPOCH", "0").output();
    let output = output.unwrap();
    assert!(output.status.code().unwrap() < 2, "{}", String::from_utf8_lossy(&output.stderr));
}

fn shop(files: &[(&str, &str)]) -> TempDir {
    let shop = TempDir::new().unwrap();
    fs::create_dir(shop.path().join("in")).unwrap();
    files.iter().for_each(|(name, text)| fs::write(shop.path().join("in").join(name), text).unwrap());
    shop
}

fn four() -> TempDir {
    shop(&[
        ("a.nc", CLEAN),
        ("b.nc", REFUSED),
        ("c.nc", REVIEW),
        ("<img src=x onerror=window.acted=4>.nc", HOSTILE),
    ])
}

/// The programs that show, by their names.
const SHOWN: &str = "[...document.querySelectorAll('details.program')].filter(p => p.checkVisibility()).map(p => \
                     p.querySelector('h3').textContent.slice(-5)).join()";

#[test]
fn a_report_opens_filters_and_links() {
    let shop = four();
    convert(shop.path(), "");
    let page = shop.path().join("r.html");
    let browser = Browser::start();
    browser.open(&page);
    assert_eq!(browser.value("document.title"), "Conversion report");
    assert_eq!(browser.value(SHOWN), "O1237,O1234,O1235,O1236");
    assert!(browser.value("document.body.textContent").as_str().unwrap().contains("1970-01-01 00:00 UTC"));

    // Each way to filter, and back.
    browser.write("#text", "m38");
    browser.wait(&format!("{SHOWN} === 'O1235'"));
    assert_eq!(
        browser.value("document.querySelectorAll('#index ~ table tr[data-of]:not([hidden])').length"),
        1
    );
    browser.click("#reset");
    browser.write("#outcome", "review");
    browser.wait(&format!("{SHOWN} === 'O1236'"));
    browser.click("#reset");
    browser.write("#code", "MG0301");
    browser.wait(&format!("{SHOWN} === 'O1235'"));
    browser.click("#reset");
    browser.wait(&format!("{SHOWN} === 'O1237,O1234,O1235,O1236'"));

    // By keys: to the first program, to the next, to the filter and away from it.
    browser.click("h1");
    browser.press("n");
    browser.press("n");
    assert_eq!(browser.value("document.querySelector('.here').id"), "p2");
    browser.press("p");
    assert_eq!(browser.value("document.querySelector('.here').id"), "p1");
    browser.press("/");
    assert_eq!(browser.value("document.activeElement.id"), "text");
    browser.press("\u{e00c}");
    assert_eq!(browser.value("document.activeElement.id"), "");

    // Every link leads somewhere, and one into what is folded and filtered away opens it.
    let broken =
        "[...document.querySelectorAll('a')].filter(a => !document.getElementById(a.hash.slice(1))).length";
    assert_eq!(browser.value(broken), 0);
    assert_eq!(
        browser.value("[...document.querySelectorAll('a')].filter(a => a.hash === '#MG0301').length > 2"),
        true
    );
    browser.click("#fold");
    browser.write("#outcome", "converted");
    browser.wait(&format!("{SHOWN} === 'O1237,O1234'"));
    browser.click(".question a[href='#p3']");
    browser.wait("document.getElementById('p3').open && document.getElementById('p3').checkVisibility()");

    let asks = "performance.getEntriesByType('resource').length";
    assert_eq!(browser.value(asks), 0, "nothing beside the file is asked for");
    assert_eq!(browser.value("window.acted === undefined"), true);
    assert_eq!(browser.complaints(), Vec::<Value>::new());
}

#[test]
fn what_is_written_into_a_report_is_kept_in_it() {
    let shop = four();
    convert(shop.path(), "");
    let browser = Browser::start();
    browser.open(&shop.path().join("r.html"));
    browser.click(".question input[type=checkbox]");
    browser.write(".question .fields input.wide", "inch, <b>by the door</b>");
    let saved =
        format!("<!doctype html>\n{}", browser.value("document.documentElement.outerHTML").as_str().unwrap());
    fs::write(shop.path().join("saved.html"), saved).unwrap();
    browser.open(&shop.path().join("saved.html"));
    assert_eq!(browser.value("document.querySelector('.question input[type=checkbox]').checked"), true);
    let answer = "document.querySelector('.question .fields input.wide').value";
    assert_eq!(browser.value(answer), "inch, <b>by the door</b>");
    browser.write("#text", "m38");
    browser.wait(&format!("{SHOWN} === 'O1235'"));
    assert_eq!(browser.complaints(), Vec::<Value>::new());
}

/// Without its script everything shows; printed, it is a document of several pages.
#[test]
fn a_report_is_read_without_its_script_and_printed() {
    let shop = four();
    convert(shop.path(), "");
    let text = fs::read_to_string(shop.path().join("r.html")).unwrap();
    let start = text.rfind("<script>").unwrap();
    fs::write(shop.path().join("still.html"), &text[..start]).unwrap();
    let browser = Browser::start();
    browser.open(&shop.path().join("still.html"));
    assert_eq!(browser.value(SHOWN), "O1237,O1234,O1235,O1236");
    assert_eq!(browser.value("document.getElementById('tools').checkVisibility()"), false);
    let picture = "(path => (path.scrollIntoView(), path.getBoundingClientRect().height > 100))(document.querySelector('#p4 svg path.tc'))";
    assert_eq!(browser.value(picture), true);
    for name in ["still.html", "r.html"] {
        browser.open(&shop.path().join(name));
        let pdf = browser.printed();
        // "%PDF-" in base 64; an empty page has a few thousand letters.
        assert!(pdf.starts_with("JVBERi0") && pdf.len() > 60_000, "{name}: {}", pdf.len());
    }
}

/// The hashes in the page are those of the files, and the same inputs give the same bytes.
#[test]
fn a_program_reads_the_hashes_of_a_report() {
    let shop = four();
    convert(shop.path(), "");
    let text = fs::read_to_string(shop.path().join("r.html")).unwrap();
    let browser = Browser::start();
    browser.open(&shop.path().join("r.html"));
    let block = browser.value("JSON.parse(document.getElementById('macroglot').textContent)");
    assert_eq!((&block["format"], &block["date"]), (&1.into(), &"1970-01-01 00:00 UTC".into()));
    let library = &block["libraries"][0];
    assert_eq!((&library["from"]["control"], &library["to"]["control"]), (&"fanuc".into(), &"haas".into()));
    let files = library["files"].as_array().unwrap();
    assert_eq!(files.len(), 4);
    let mut written = 0;
    for file in files {
        for (name, hash) in [("source", "source_sha256"), ("target", "target_sha256")] {
            let Some(path) = file[name].as_str() else { continue };
            let bytes = fs::read(shop.path().join(path)).unwrap();
            let digits: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
            assert_eq!(file[hash], digits, "{path}");
            written += usize::from(name == "target");
        }
    }
    assert_eq!(written, 3);
    assert_eq!(library["programs"][2]["outcome"], "refused");
    convert(shop.path(), "");
    assert_eq!(fs::read_to_string(shop.path().join("r.html")).unwrap(), text);
}

/// A library of 100 programs. How long it takes to open is printed.
#[test]
fn a_large_report_opens() {
    let shop = TempDir::new().unwrap();
    fs::create_dir(shop.path().join("in")).unwrap();
    for number in 1..=100 {
        let moves: String =
            (1..40).map(|at| format!("G1 X{at}. Y#50{} F{number}.\n(LINE {at})\n", at % 10)).collect();
        let text = format!("%\nO{number:04}\nG17 G90 G40 G80 G94\nG0 X0 Y0\n{moves}M30\n%\n");
        fs::write(shop.path().join(format!("in/o{number:04}.nc")), text).unwrap();
    }
    convert(shop.path(), "--no-verify --quiet");
    let browser = Browser::start();
    browser.open(&shop.path().join("r.html"));
    let loaded = "performance.getEntriesByType('navigation')[0].loadEventEnd";
    browser.wait(&format!("{loaded} > 0"));
    println!("100 programs open in {} ms", browser.value(loaded));
    assert_eq!(browser.value("document.querySelectorAll('details.program').length"), 100);
    browser.write("#text", "o0044");
    browser.wait("document.getElementById('count').textContent === '1 of 100 programs'");
}
