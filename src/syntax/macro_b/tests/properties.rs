//! Laws over random input.

use super::super::{
    bits_among_arithmetic, blocks, blocks::Keep, cache_key::LONGEST, cache_key::cache_key, lexeme::Lexemes,
    parse_cache, read_line, scanner, shape, tree,
};
use super::{BOTH, Dialect};
use crate::syntax::support::readable;
use crate::syntax::{Block, ItemKind, parse_faults};
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
    blocks::grammar_block(dialect.rules, source, block, line.start, &shape, Keep::Tokens)
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
        for block in blocks {
            let mut row = Lexemes::new();
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

/// Statements that can be wrong in what the grammar lets pass: divisors, arguments, digits, loops, calls.
fn statements() -> impl Strategy<Value = Vec<u8>> {
    let call = r"(SQRT|ASIN|LN|ATAN|SIN|FIX) ?\[(-?[0-2]|#1|#1-1|\[0\])\](/\[2\])?";
    let operand = format!(r"(#[0-3]|-?0|0\.0|2\.5|-1|123456789|\[-?0\]|\[-#1\]|#\[#1\]|{call})");
    let value = format!(r"{operand}((\+|-|\*|/| ?MOD ?| EQ | AND ){operand}){{0,3}}");
    let word = format!(r"(G65|G66|G1|G\[65\]|G#1|M6|M6\.|S1\.5|T#1|X-1\.|P1|Y\[{value}\]|,R1\.)");
    let then = format!(r"(GOTO ?10|THEN ?#1={value}|\(A\)|THEN|IF\[#1 LT 2\] ?(GOTO1)?|X1)?");
    let statement = format!(
        r"(#[0-2] ?={value}|{word}{{1,4}}|(IF ?)?\[{value}\] ?{then}|(WHILE\[{value}\])?DO[0-4]|END[0-4])"
    );
    proptest::string::bytes_regex(&format!(
        r"(N[0-9]{{1,3}} ?|/2)?{statement}( ?\(A\)){{0,2}}(;{statement})?;?"
    ))
    .unwrap()
}

/// Lines whose numbers decide more than it seems.
const TRICKY: &[&[u8]] = &[
    b"X1 G#1 #2=-65",
    b"X1 G- 65.",
    b"/12",
    b"/1 X1",
    b"#1=#2/00",
    b"DO 2",
    b"DO 12",
    b"END\x003",
    b"D04",
    b"#0.5=1",
    b"#10=1",
    b"SQRT[-00]",
    b"#1=SQRT[-10]",
    b"#1=1.",
    b"#1=1.2.3",
    b"M6.",
    b"O<1>",
    b"DPRNT[A1#1[53]]",
    b"(1;2)X1",
];

/// Statements whose numbers have more digits.
fn numbers() -> impl Strategy<Value = Vec<u8>> {
    let digits = proptest::string::bytes_regex("0{0,2}[0-9]{1,3}(0{6}|3{37})?").unwrap();
    (statements(), proptest::collection::vec(digits, 12)).prop_map(|(line, digits)| {
        let mut digits = digits.into_iter().cycle();
        let longer = |byte: u8| match byte {
            b'0'..=b'9' => digits.next().unwrap_or_default(),
            _ => vec![byte],
        };
        line.into_iter().flat_map(longer).collect()
    })
}

/// What is remembered of a block's likeness is what the grammar makes of the block.
fn alike_is_read_alike(dialect: &Dialect, block: &[u8]) {
    let mut key = [0; LONGEST];
    let Some(like) = cache_key(block, &mut key, &mut [0; LONGEST]) else { return };
    let mut row = Lexemes::new();
    let mut read = |text: &[u8], by: &dyn Fn(Span, &mut Lexemes) -> bool| {
        row.clear();
        by(Span::new(0, text.len() as u32), &mut row).then(|| row.clone())
    };
    let remember = |span, row: &mut Lexemes| parse_cache::read(dialect.rules, like, span, row).is_ok();
    let remembered = |span, row: &mut Lexemes| parse_cache::read(dialect.rules, block, span, row).is_ok();
    let by_grammar = |_, row: &mut Lexemes| (dialect.rules.read)(&readable(block), 0, row).is_ok();
    let is_read = read(like, &remember).is_some();
    let expected = read(block, &by_grammar);
    assert_eq!(is_read, expected.is_some(), "{}: {}", dialect.name, block.escape_ascii());
    assert_eq!(read(block, &remembered), expected, "{}: {}", dialect.name, block.escape_ascii());
}

/// What is read without tokens or not at all is what is read; returns how many lines are sound, and how many have faults.
fn shortcuts_agree(dialect: &Dialect, source: &[u8]) -> (usize, usize) {
    let is_sound = |source: &[u8], line: Span| blocks::is_sound(dialect.rules, source, line);
    let (mut precheck, mut faulty, mut faults) = (0, 0, Vec::new());
    for line in Lines::new(source).map(|line| line.text) {
        let mut read = Vec::new();
        (dialect.parse_line)(source, line, &mut read);
        let text = line.of(source).escape_ascii();
        let errors: Vec<_> = read.iter().flat_map(|block| block.errors.clone()).collect();
        if is_sound(source, line) {
            let unread = |block: &Block| block.items.iter().any(|item| item.kind == ItemKind::Unparsed);
            assert!(errors.is_empty() && !read.iter().any(unread), "{}: {text}: {errors:?}", dialect.name);
            precheck += usize::from(!blocks::is_plain(source, line));
        }
        read.iter().for_each(|block| alike_is_read_alike(dialect, block.span.of(source)));
        let mut key = [0; LONGEST];
        if let Some(like) = cache_key(line.of(source), &mut key, &mut [0; LONGEST]) {
            let whole = Span::new(0, like.len() as u32);
            let found = |source: &[u8], line: Span| blocks::is_found_sound(dialect.rules, source, line);
            assert_eq!(found(like, whole), found(source, line), "{}: {text}", dialect.name);
            assert_eq!(cache_key(like, &mut [0; LONGEST], &mut [0; LONGEST]), Some(like), "{text}");
        }
        faulty += usize::from(!errors.is_empty());
        faults.extend(errors);
        let mut items = Vec::new();
        read_line(dialect.rules, source, line, Keep::Items, &mut items);
        read.iter_mut().for_each(|block| block.tokens.clear());
        assert_eq!(items, read, "{}: {text}", dialect.name);
    }
    for _ in 0..2 {
        let found = parse_faults(source, dialect.parse_line, dialect.is_sound);
        assert_eq!(found, faults, "{}: {}", dialect.name, source.escape_ascii());
    }
    (precheck, faulty)
}

#[test]
fn what_is_not_read_has_no_fault() {
    for dialect in BOTH {
        let (precheck, faulty) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
        let agree = |source: &[u8]| {
            let (more_sound, more_faulty) = shortcuts_agree(&dialect, source);
            precheck.set(precheck.get() + more_sound);
            faulty.set(faulty.get() + more_faulty);
        };
        let files: Vec<Vec<u8>> = dialect.corpus().into_iter().map(|(_, source)| source).collect();
        files.iter().for_each(|source| agree(source));
        dialect.fragments().iter().for_each(|fragment| agree(fragment.text.as_bytes()));
        TRICKY.iter().for_each(|line| agree(line));
        over(1500, &text(), |source| agree(&source));
        precheck.set(0);
        faulty.set(0);
        over(4000, &statements(), |source| agree(&source));
        over(4000, &numbers(), |source| agree(&source));
        assert!(precheck.get() > 1000, "only {} lines are sound", precheck.get());
        assert!(faulty.get() > 1000, "only {} lines have faults", faulty.get());
        let damaged = (proptest::sample::select(files), any::<(u16, u16)>(), text());
        over(60, &damaged, |(mut source, (from, len), insert)| {
            let from = usize::from(from) % (source.len() + 1);
            let to = (from + usize::from(len % 8)).min(source.len());
            source.splice(from..to, insert);
            agree(&source);
        });
    }
}
