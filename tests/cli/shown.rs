//! What acts on a terminal stands in names, comments and messages, and is shown.
#![cfg(unix)]

use super::Shop;
use serde_json::Value;

/// Names that forge a line, erase the screen, and turn the direction of writing.
const NAMES: [&str; 3] = ["a\nconverted  b.nc", "c\x1b[2J\td.nc", "e\u{202e}f<b>&'.nc"];

/// A comment, a message, an alarm and an unknown code, with the controls that begin with one byte more.
const TEXT: &str = "O1\n(A\u{202e}B \u{9b}2J <script>)\nG20 G17 G90 G40 G80 G94\n#3006=1(M\u{9d}0;T|`x`)\nM38\n\
    #3000=1(S\u{9b}5m)\nM30\n";

/// What may not come out: all controls but blanks, and marks of direction.
fn acts(text: &str) -> Option<&str> {
    let at = text.find(|c: char| {
        (c.is_control() && !matches!(c, '\n' | '\t')) || matches!(c, '\u{2028}'..='\u{202e}')
    })?;
    text.get(at..)
}

#[test]
fn nothing_acts_on_a_terminal() {
    let mut files: Vec<(String, String)> = NAMES.map(|name| (format!("in/{name}"), TEXT.to_owned())).to_vec();
    for (at, (_, text)) in files.iter_mut().enumerate() {
        *text = text.replace("O1", &format!("O{}", at + 1));
    }
    files.push(("in/g\n\x1b[2J.nc".into(), "\0\x01\x02\0\0".into()));
    let shop =
        Shop::with(&files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect::<Vec<_>>());
    let reports = ["r.html", "r.md", "r.txt", "r.json", "r.sarif"];
    let wanted: String = reports.iter().map(|name| format!(" --report {name}")).collect();
    for line in [
        "convert in --from fanuc --to haas --out out".to_owned() + &wanted,
        "convert in --from fanuc --to haas --out out --draft".into(),
        "convert in --from fanuc --to haas --out out --format json".into(),
        "convert in --from fanuc --to haas --out out --format sarif".into(),
        "parse in --dialect fanuc --faults --verbose".into(),
        "parse in --dialect fanuc --format json".into(),
        "verify in in --from fanuc --to fanuc".into(),
    ] {
        let run = shop.run(&line);
        assert_eq!((acts(&run.out), acts(&run.err)), (None, None), "{line}");
        // A line that a name forged begins as one of macroglot's.
        let forged = |text: &str| text.lines().any(|line| line.starts_with("converted  b.nc"));
        assert!(!forged(&run.out) && !forged(&run.err), "{line}: {}{}", run.out, run.err);
    }
    reports.iter().for_each(|name| assert_eq!(acts(&shop.read(name)), None, "{name}"));
    // Readers of data get the names as they are.
    let json: Value = serde_json::from_str(&shop.read("r.json")).unwrap();
    let sources: Vec<&str> = json["programs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|program| program["source"].as_str().unwrap())
        .collect();
    assert_eq!(sources, NAMES.map(|name| format!("in/{name}")));
    let html = shop.read("r.html");
    assert!(html.contains("e\\u{202e}f&lt;b&gt;&amp;&#39;.nc") && html.matches("<script").count() == 2);
}

/// A megabyte of words that no table has: of each line some are drawn, and all are counted.
#[test]
fn no_more_is_drawn_than_a_person_reads() {
    let line = format!("G0 {}\n", "Q1".repeat(125_000));
    let shop = Shop::with(&[("a.nc", &format!("O1\n{line}{line}{line}{line}M30\n"))]);
    for (line, hint) in [
        ("ir a.nc --dialect fanuc", ""),
        ("convert a.nc --from fanuc --to haas --no-verify --verbose", "; `--report FILE.json` has all"),
    ] {
        let run = shop.run(line);
        assert_eq!(run.code, 1, "{line}");
        assert!(run.err.len() < 64 * 1024, "{line}: {} bytes", run.err.len());
        let drawn = run.err.matches("[a.nc:").count();
        assert_eq!(drawn, 40, "{line}: ten of each line");
        // Every word is one finding.
        let told =
            format!("macroglot: a.nc: {0} more findings not drawn: {0} of MG0301{hint}\n", 500_000 - 40);
        assert!(run.err.contains(&told), "{line}: {}", run.err);
    }
}
