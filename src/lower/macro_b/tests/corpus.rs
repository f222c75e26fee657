//! Every program of the corpus is lowered; which are refused, and why, is listed here.

use super::{Code, errors_of, lowered};
use std::collections::BTreeSet;

/// The refused programs of a dialect with their codes.
fn refused(dialect: &str, control: &str) -> Vec<(String, BTreeSet<Code>)> {
    let folder = format!("{}/corpus/{dialect}", env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "nc"))
        .collect();
    files.sort();
    assert!(!files.is_empty());
    let mut refused = Vec::new();
    for file in files {
        let source = String::from_utf8_lossy(&std::fs::read(&file).unwrap()).into_owned();
        let lowered = lowered(control, &source);
        let errors = errors_of(&lowered);
        if !errors.is_empty() {
            let name = file.file_stem().unwrap().to_string_lossy().into_owned();
            refused.push((name, errors.into_iter().collect()));
        }
    }
    refused
}

#[test]
fn haas() {
    assert_eq!(refused("haas", "haas"), []);
}

/// What a refused program is refused for.
type Why<'a> = (&'a str, &'a [Code]);

#[track_caller]
fn are_refused(control: &str, expected: &[Why<'_>]) {
    let expected: Vec<_> =
        expected.iter().map(|(name, codes)| (name.to_string(), codes.iter().copied().collect())).collect();
    assert_eq!(refused("fanuc", control), expected);
}

/// Under the table of a mill: lathe programs, codes that only a profile makes call
/// something, and one program that the manual prints in part.
#[test]
fn fanuc_mill() {
    use Code::*;
    are_refused(
        "fanuc",
        &[
            ("call-m910", &[NotUnderstood]),
            ("family-groove", &[LatheProgram]),
            ("groove-width", &[LatheProgram]),
            ("o0003-g66-groove", &[LatheProgram]),
            ("o1204-tool-life-change", &[LatheProgram]),
            ("o1204-tool-life", &[LatheProgram]),
            ("o1234-alternate-tool", &[NotUnderstood, LatheProgram]),
            ("o1234-conveyor", &[NotUnderstood]),
            ("o1234-tool-life-time", &[NotUnderstood, LatheProgram]),
            ("o9014-groove-macro", &[LatheProgram]),
            ("o9018-g383-peck", &[LatheProgram]),
            ("o9019-g183-angled", &[LatheProgram]),
            ("o9020-auto-cutoff", &[LatheProgram]),
            ("o9110-g66-groove", &[LatheProgram]),
        ],
    );
}

/// Under the seminar's lathe: mill programs (G91, M6), and a P of a twin lathe's spindle that no text explains. A lathe of the
/// maker may have G43 and G81, which are named and have no equal elsewhere.
#[test]
fn fanuc_lathe() {
    use Code::*;
    are_refused(
        "fanuc:machine = \"lathe\"\naxes = [\"X\", \"Y\", \"Z\", \"B\", \"C\"]\n[parameters]\n6058 = 383\n6059 = 183\n\
         6071 = 201\n6072 = 202\n6073 = 203\n6075 = 2900\n6080 = 910",
        &[
            ("o1234-alternate-tool", &[NotUnderstood]),
            ("o8103-frame-macro", &[NotUnderstood]),
            ("o9010-g65-l2", &[NotUnderstood]),
            ("probe-o8010-call", &[NotUnderstood]),
            ("round-return", &[NotUnderstood]),
        ],
    );
}

/// Lines of the corpus, cut and joined at random: nothing panics, and what comes out keeps
/// the IR's contract. The seed is printed.
#[test]
fn shuffled_pieces_keep_the_contract() {
    let mut state: u64 = 0x5eed_2026;
    println!("seed {state:#x}");
    let mut next = move |bound: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % bound.max(1)
    };
    let mut lines: Vec<String> = PIECES.iter().map(|piece| (*piece).to_owned()).collect();
    for dialect in ["fanuc", "haas"] {
        let folder = format!("{}/corpus/{dialect}", env!("CARGO_MANIFEST_DIR"));
        for entry in std::fs::read_dir(folder).unwrap() {
            let text = std::fs::read(entry.unwrap().path()).unwrap();
            lines.extend(String::from_utf8_lossy(&text).lines().map(str::to_owned));
        }
    }
    lines.sort();
    for round in 0..400 {
        let mut source = String::new();
        for _ in 0..next(30) {
            let line = lines[next(lines.len())].as_str();
            let cut: String = line.chars().skip(next(3) * next(4)).collect();
            source.push_str(&cut);
            source.push_str(if next(8) == 0 { "" } else { "\n" });
        }
        // `lowered` validates.
        lowered(["fanuc", "haas", "fanuc:machine = \"lathe\""][round % 3], &source);
    }
}

/// What the corpus has little of.
const PIECES: &[&str] = &[
    "N10",
    "GOTO10",
    "GOTO#1",
    "DO1",
    "END1",
    "WHILE[#1LT2]DO2",
    "END2",
    "/GOTO10",
    "/2N10#1=1",
    "X1./M8",
    "M99P10",
    "M98Q10",
    "M97P10",
    "M98P#1",
    "G66P1",
    "G67",
    "M30",
    "O5",
    "%",
    "IF[#1EQ1]THEN",
    "[#1]GOTO10",
    "#[#1]=#[#2]",
    "G65P1I1J2I3K#0D5",
    "#3000=1(A)",
    "X#1X#2",
    "G0G1G2",
    "/10M8",
    "#0=1",
    "SETVN500[A,B]",
    "[#A]=1",
    "DPRNT[A#1[53]]",
];
