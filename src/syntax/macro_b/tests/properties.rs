//! Laws over random input.

use super::super::{bits_among_arithmetic, blocks, lexeme::Row, scanner, shape, tree};
use super::{BOTH, Dialect};
use crate::syntax::Block;
use crate::text::{Lines, Span};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Runs a property over `cases` values from a fixed seed.
fn over<S: Strategy>(cases: u32, values: &S, law: impl Fn(S::Value)) {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]));
    runner
        .run(values, |value| {
            law(value);
            Ok(())
        })
        .unwrap_or_else(|error| panic!("seed [7; 32]: {error}"));
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

/// The blocks of a line by the grammar alone.
fn by_grammar(dialect: &Dialect, source: &[u8], block: Span, line: Span) -> Block {
    let mut shape = shape::outline(line.of(source), (block.start - line.start) as usize);
    shape.end = (block.end - line.start) as usize;
    blocks::grammar_block(dialect.rules, source, block, line.start, &shape, &mut Row::new())
}

/// On every block that the scanner accepts it agrees with the grammar; returns how many those were.
fn scanner_agrees(dialect: &Dialect, source: &[u8]) -> usize {
    let mut accepted = 0;
    for line in Lines::new(source) {
        let mut blocks = Vec::new();
        (dialect.parse_line)(source, line.text, &mut blocks);
        if blocks::is_plain(source, line.text) {
            assert!(blocks.len() <= 1 && blocks.iter().all(|block| block.errors.is_empty()), "{blocks:?}");
        }
        let plain = blocks::read_plain(source, line.text);
        assert_eq!(plain.is_some(), !line.text.is_empty() && blocks::is_plain(source, line.text));
        if let Some(items) = plain {
            assert_eq!(blocks.iter().map(|block| &block.items).collect::<Vec<_>>(), [&items]);
        }
        for block in blocks {
            let mut row = Row::new();
            let rest = Span::new(block.span.start, line.text.end);
            let Some(end) = scanner::scan(source, rest, &mut row) else { continue };
            accepted += 1;
            assert!(tree::build(source, &row, bits_among_arithmetic).is_ok());
            assert_eq!(end, block.span.end, "{}", String::from_utf8_lossy(line.text.of(source)));
            assert_eq!(block, by_grammar(dialect, source, block.span, line.text));
        }
    }
    accepted
}

#[test]
fn the_scanner_agrees_with_the_grammar() {
    for dialect in BOTH {
        let corpus: usize = dialect.corpus().iter().map(|(_, source)| scanner_agrees(&dialect, source)).sum();
        assert!(corpus > 0);
        let accepted = std::cell::Cell::new(0);
        over(4000, &plain(), |source| accepted.set(accepted.get() + scanner_agrees(&dialect, &source)));
        assert!(accepted.get() > 1000, "only {} blocks were accepted", accepted.get());
    }
}
