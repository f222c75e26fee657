//! Laws over random input.

use super::statements::{damaged, doubtful, valid, with_longer_numbers};
use super::{BOTH, Dialect, inputs};
use crate::syntax::macro_b::blocks::{Keep, by_grammar, by_hand, read_line};
use crate::syntax::parse_faults;
use crate::text::{Lines, Span};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::cell::Cell;

/// A number from the environment; `.ci/nightly` gives a new seed and more cases.
fn given(name: &str, otherwise: u64) -> u64 {
    std::env::var(name)
        .map_or(otherwise, |value| value.parse().unwrap_or_else(|_| panic!("{name} is {value}")))
}

/// Runs a property over `cases` values, times `MACROGLOT_CASES`, from the seed `MACROGLOT_SEED`.
fn over<S: Strategy>(cases: u32, values: &S, law: impl Fn(S::Value)) {
    let (seed, times) = (given("MACROGLOT_SEED", 7), given("MACROGLOT_CASES", 1));
    let cases = cases.saturating_mul(times.try_into().unwrap_or(u32::MAX));
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes));
    runner
        .run(values, |value| {
            law(value);
            Ok(())
        })
        .unwrap_or_else(|error| panic!("MACROGLOT_SEED={seed}: {error}"));
}

/// What programs are made of, so that random text often comes near to a legal block.
const PIECES: &[&str] = &[
    "G1", "X1.", "Y-.5", "N10", "#1", "#[", "[", "]", "=", "+", "-", "*", "/", "IF", "THEN", "GOTO", "WHILE",
    "DO1", "END1", "SIN[", "ATAN[", ",R", "(A;B)", "(", ")", ";", " ", "%", "O12", "EQ", "NE", "AND", "MOD",
    "DPRNT[", "[44]", "0", "7.25", ".", "\u{e9}", "\0", "M98", "P[#2]", "G65", "POPEN", "SETVN", "#0", "\t",
    "x", "<A>", ":", "1",
];

fn text() -> impl Strategy<Value = Vec<u8>> {
    let piece = proptest::sample::select(PIECES).prop_map(|piece| piece.as_bytes().to_vec());
    let byte = any::<u8>().prop_map(|byte| vec![byte]);
    let parts = prop_oneof![9 => piece, 1 => byte, 1 => Just(b"\n".to_vec())];
    proptest::collection::vec(parts, 0..24).prop_map(|parts| parts.concat())
}

fn plain() -> impl Strategy<Value = Vec<u8>> {
    proptest::string::bytes_regex("([NGXYZFMST]-?[0-9.]{1,5}|[A-Z]|[ \t]|\\([A-Z; (]{0,4}\\)|;| ;? |\0){1,9}")
        .unwrap()
}

#[test]
fn any_bytes_are_kept() {
    for dialect in BOTH {
        over(1500, &proptest::collection::vec(any::<u8>(), 0..200), |source| {
            dialect.file(&source);
        });
        over(3000, &text(), |source| {
            dialect.file(&source);
        });
    }
}

#[test]
fn mutated_programs_are_kept() {
    let files: Vec<Vec<u8>> = BOTH.iter().flat_map(Dialect::corpus).map(|(_, source)| source).collect();
    let mutation = (proptest::sample::select(files), any::<(u16, u16)>(), text());
    for dialect in BOTH {
        over(400, &mutation, |(mut source, (from, len), insert)| {
            let from = usize::from(from) % (source.len() + 1);
            let to = (from + usize::from(len % 8)).min(source.len());
            source.splice(from..to, insert);
            dialect.file(&source);
        });
    }
}

/// What the reader made of blocks.
#[derive(Clone, Copy, Default)]
struct Tally {
    blocks: usize,
    by_hand: usize,
    faulty: usize,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.blocks += other.blocks;
        self.by_hand += other.by_hand;
        self.faulty += other.faulty;
    }
}

/// Each block that is read by hand is what the grammar reads: its end, items, tokens and faults.
fn line_agrees(dialect: &Dialect, source: &[u8], line: Span) -> Tally {
    let mut tally = Tally::default();
    let mut at = line.start;
    while at < line.end {
        let (mut expected, mut read) = (Vec::new(), Vec::new());
        let end = by_grammar(dialect.rules, source, line, at, &mut expected);
        if by_hand(dialect.rules, source, Span::new(at, line.end), Keep::Tokens, &mut read).is_some() {
            let text = Span::new(at, line.end).of(source).escape_ascii();
            assert_eq!(read, expected, "{}: {text}", dialect.name);
            tally.by_hand += 1;
        }
        tally.blocks += 1;
        tally.faulty += usize::from(!expected[0].errors.is_empty());
        at = end;
    }
    tally
}

/// As [`line_agrees`], for all lines; and what is read without tokens, or for its faults alone, is the same.
fn agrees(dialect: &Dialect, source: &[u8]) -> Tally {
    let (mut tally, mut faults) = (Tally::default(), Vec::new());
    for line in Lines::new(source).map(|line| line.text) {
        tally += line_agrees(dialect, source, line);
        let (mut items, mut read) = (Vec::new(), Vec::new());
        read_line(dialect.rules, source, line, Keep::Items, &mut items);
        (dialect.parse_line)(source, line, &mut read);
        for block in &mut read {
            block.tokens.clear();
            faults.extend(block.errors.clone());
        }
        assert_eq!(items, read, "{}: {}", dialect.name, line.of(source).escape_ascii());
    }
    assert_eq!(parse_faults(source, dialect.parse_faults), faults, "{}", source.escape_ascii());
    tally
}

/// Over random input; says what became of its blocks.
fn agrees_over(dialect: &Dialect, cases: u32, input: &impl Strategy<Value = Vec<u8>>) -> Tally {
    let all = Cell::new(Tally::default());
    over(cases, input, |source| {
        let mut tally = all.get();
        tally += agrees(dialect, &source);
        all.set(tally);
    });
    all.get()
}

/// True where at least so many of a hundred blocks are read by hand.
fn reads(tally: Tally, percent: usize) -> bool {
    println!("{} of {} blocks are read by hand, {} have faults", tally.by_hand, tally.blocks, tally.faulty);
    tally.by_hand * 100 >= tally.blocks * percent
}

#[test]
fn the_reader_agrees_with_the_grammar_on_programs() {
    for dialect in BOTH {
        let mut tally = Tally::default();
        for (_, source) in BOTH.iter().flat_map(Dialect::corpus) {
            tally += agrees(&dialect, &source);
        }
        assert!(reads(tally, 90));
        let mut tally = Tally::default();
        for text in [inputs::macros(150_000), inputs::unlike(60_000), inputs::surface(60_000)] {
            tally += agrees(&dialect, text.as_bytes());
        }
        assert!(reads(tally, 99));
    }
}

#[test]
fn the_reader_agrees_with_the_grammar_on_fragments() {
    for dialect in BOTH {
        let mut tally = Tally::default();
        for fragment in BOTH.iter().flat_map(Dialect::fragments) {
            tally += agrees(&dialect, fragment.text.as_bytes());
        }
        assert!(reads(tally, 50));
        for line in TRICKY {
            agrees(&dialect, line);
        }
    }
}

#[test]
fn the_reader_agrees_with_the_grammar_on_valid_statements() {
    for dialect in BOTH {
        assert!(reads(agrees_over(&dialect, 1500, &valid()), 95));
        assert!(reads(agrees_over(&dialect, 1000, &plain()), 25));
    }
}

#[test]
fn the_reader_agrees_with_the_grammar_on_damaged_statements() {
    for dialect in BOTH {
        assert!(reads(agrees_over(&dialect, 3000, &damaged()), 20));
        assert!(reads(agrees_over(&dialect, 1000, &text()), 5));
    }
}

#[test]
fn the_reader_agrees_with_the_grammar_on_what_may_be_wrong() {
    for dialect in BOTH {
        let mut tally = agrees_over(&dialect, 1000, &doubtful());
        tally += agrees_over(&dialect, 1000, &with_longer_numbers(doubtful()));
        assert!(reads(tally, 40));
        assert!(tally.faulty > 250);
    }
}

/// Lines in which a byte decides more than it seems.
const TRICKY: &[&[u8]] = &[
    b"X1 G#1 #2=-65",
    b"X1 G- 65.",
    b"G 1",
    b"N 10 X1",
    b"# 1 = 2",
    b"#1 .5=2",
    b"#1=# [2]",
    b"/12",
    b"/1 X1",
    b"X1 /2 Y1",
    b"#1=#2/(A)",
    b"#1=#2/00",
    b"#1=ATAN[1] / [2]/[3]",
    b"#1=ATAN[1]/2",
    b"#1=SIN[1]/[2]",
    b"#1=SIN[1,2]",
    b"#1=PRM[1]/\x0c[2]",
    b"IF[1]/[2]",
    b"IF[1]+[2]GOTO1",
    b"IF[1]AND[2]OR[3]XOR[4]GOTO1",
    b"IF[1](A)(B)THEN(C)#1=2;X1",
    b"IF[1]THENTHEN#1=2",
    b"IF[1]GOTO1THEN#1=2",
    b"IF[1];X1",
    b"WHILE[1](A)DO1",
    b"WH[1]DO1",
    b"DO 2",
    b"DO 12",
    b"DO1END1",
    b"END\x003",
    b"D04",
    b"GOTO 1.5",
    b"GOTO-1",
    b"GOTO[#1]X1",
    b"#0.5=1",
    b"#10=1",
    b"#1=5GOTO10",
    b"#1=5GE10",
    b"#1=5OR",
    b"#1=5O10",
    b"SQRT[-00]",
    b"#1=SQRT[-10]",
    b"#1=SQR[2]",
    b"#1=SQRTX[2]",
    b"#1=1.",
    b"#1=.",
    b"#1=1.2.3",
    b"#1=- -1",
    b"#1=[#A]",
    b"X-SIN[1]",
    b"X-[SIN[1]]",
    b"M6.",
    b"O<1>",
    b"O1(A)",
    b":5",
    b",R 1",
    b",N1",
    b"DPRNT[A1#1[53]]",
    b"(1;2)X1",
    b"(\xe9\x00\x7f)X1 ;\x00",
    b"X1; ",
    b"X1; Y1",
    b"X1;\t\x7f",
    b"\x00X1",
    b"&F=A",
];
