//! What the tests of the parsers share: the corpus, and blocks in short form.

use super::*;
use crate::diag::Severity;
use crate::text::Span;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A runner of random cases; always the same ones, its seed printed where a test fails.
pub fn runner(cases: u32) -> TestRunner {
    let seed = [7; 32];
    eprintln!("seed {seed:?}");
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &seed))
}

/// One row of a `fragments.tsv`.
pub struct Fragment {
    pub text: String,
    pub status: String,
}

fn corpus(dialect: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(dialect)
}

/// The dialect's fragments.
pub fn fragments(dialect: &str) -> Vec<Fragment> {
    let table = std::fs::read_to_string(corpus(dialect).join("fragments.tsv")).unwrap();
    let rows = table.lines().skip(1).map(|row| {
        let mut cells = row.split('\t').skip(1).map(str::to_owned);
        Fragment { text: cells.next().unwrap(), status: cells.next().unwrap() }
    });
    rows.collect()
}

/// The dialect's programs, with their file names.
pub fn programs(dialect: &str) -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(corpus(dialect)).unwrap().map(|entry| entry.unwrap().path());
    let programs = entries.filter(|path| path.extension().is_some_and(|end| end == "nc"));
    programs
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&path).unwrap()))
        .collect()
}

/// The blocks of one line.
pub fn parse(parser: Parser, line: &[u8]) -> Vec<Block> {
    let mut out = Vec::new();
    parser(line, Span::new(0, line.len() as u32), &mut out);
    out
}

/// Panics unless the blocks of the line tile it and print it.
pub fn assert_lossless(parser: Parser, line: &[u8]) {
    let blocks = parse(parser, line);
    assert!(blocks.iter().all(Block::is_tiled), "{:?} does not tile", line.escape_ascii().to_string());
    assert_eq!(print_blocks(&blocks, line), line);
    for error in blocks.iter().flat_map(|block| &block.errors) {
        assert!(error.span.start <= error.span.end && error.span.end as usize <= line.len());
    }
}

/// True when every block was read and none holds an error that refuses it.
pub fn is_clean(blocks: &[Block]) -> bool {
    blocks.iter().all(|block| {
        !block.items.iter().any(|item| item.kind == ItemKind::Unparsed)
            && !block.errors.iter().any(|error| error.code.severity() == Severity::Error)
    })
}

/// Every program of the dialect's corpus is read without a fault and prints back.
pub fn read_all_programs(dialect: &str, parser: Parser) {
    let programs = programs(dialect);
    assert!(programs.len() > 20);
    for (name, source) in programs {
        let file = parse_file(&source, parser);
        for block in &file.blocks {
            let text = block.span.of(&source).escape_ascii().to_string();
            assert!(is_clean(std::slice::from_ref(block)), "{name}: {text}");
            assert_eq!(block.errors, [], "{name}: {text}");
        }
        assert_eq!(file.print(), source, "{name}");
    }
}

/// Every fragment is read where the table says `ok`, refused where it says `error`;
/// `faulty` holds each one that has a fault at all, with its code and column.
pub fn check_fragments(dialect: &str, parser: Parser, faulty: &[(&str, &str, u32)]) {
    let mut seen = 0;
    for Fragment { text, status } in fragments(dialect) {
        assert_lossless(parser, text.as_bytes());
        if status == "part" {
            continue;
        }
        let clean = is_clean(&parse(parser, text.as_bytes()));
        assert_eq!(clean, status == "ok", "{text}");
        let found = faults(parser, &text);
        let expected: Vec<(String, u32)> = faulty
            .iter()
            .filter(|row| row.0 == text)
            .map(|(_, code, column)| ((*code).to_owned(), *column))
            .collect();
        seen += expected.len();
        assert_eq!(found, expected, "{text}");
    }
    assert_eq!(seen, faulty.len(), "a row of the test stands for no fragment");
}

/// Lines of random bytes, lines of the dialect's own characters and damaged lines of
/// its corpus all print back.
pub fn lossless_under_mutation(dialect: &str, parser: Parser) {
    use proptest::prelude::*;
    let lines: Vec<Vec<u8>> = programs(dialect)
        .iter()
        .flat_map(|(_, source)| source.split(|byte| matches!(byte, b'\n' | b'\r')).map(<[u8]>::to_vec))
        .filter(|line| !line.is_empty())
        .collect();
    let noise = proptest::collection::vec(any::<u8>(), 0..60);
    let shaped = "[ #A-Z0-9.+*/=<>()'\",:;$%-]{0,60}".prop_map(String::into_bytes);
    let damage = proptest::collection::vec((any::<u16>(), any::<u8>(), 0..4u8), 1..6);
    let damaged = (any::<u16>(), damage).prop_map(move |(line, damage)| {
        let mut line = lines[usize::from(line) % lines.len()].clone();
        for (at, byte, how) in damage {
            let at = usize::from(at) % (line.len() + 1);
            match how {
                0 => line.insert(at, byte),
                1 => line.truncate(at),
                2 if at < line.len() => line[at] = byte & 0x7f,
                _ if at < line.len() => drop(line.remove(at)),
                _ => {}
            }
        }
        line
    });
    let line = prop_oneof![noise, shaped, damaged]
        .prop_map(|line| line.into_iter().filter(|byte| !matches!(byte, b'\n' | b'\r')).collect::<Vec<u8>>());
    runner(3_000)
        .run(&line, |line| {
            assert_lossless(parser, &line);
            Ok(())
        })
        .unwrap();
}

/// Each line that is read without the grammar, of the corpus and of random words, is the
/// block that the grammar reads.
pub fn assert_plain_blocks_agree(dialect: &str, grammar: Parser) {
    let word = "[A-Za-z][+-]?([0-9]{1,3}\\.?[0-9]{0,4}|\\.[0-9]{0,2}|[0-9]{10,18})";
    let shape = format!("[ \t]?([Nn][0-9]{{1,5}})?([ \t]{{0,2}}{word}){{0,4}}([ \t=#%;V/-]?)");
    assert_reader_agrees(dialect, plain::plain_block, grammar, (&shape, 300));
}

/// Each line that `reader` takes, of the corpus and of random ones of a shape, is the block that the grammar reads; without
/// its tokens it is the same. It takes more than so many of the random ones.
pub fn assert_reader_agrees(
    dialect: &str,
    reader: fn(&[u8], Span, bool) -> Option<Block>,
    grammar: Parser,
    (shape, least): (&str, usize),
) {
    use proptest::prelude::*;
    let agree = |line: &[u8]| {
        let span = Span::new(0, line.len() as u32);
        let read = reader(line, span, true);
        if let Some(read) = &read {
            assert_eq!([read.clone()].as_slice(), parse(grammar, line), "{}", line.escape_ascii());
            let bare = Block { tokens: Vec::new(), ..read.clone() };
            assert_eq!(reader(line, span, false), Some(bare), "{}", line.escape_ascii());
        }
        read.is_some()
    };
    let programs = programs(dialect);
    let lines = programs.iter().flat_map(|(_, source)| source.split(|byte| matches!(byte, b'\n' | b'\r')));
    let taken = lines.filter(|line| !line.is_empty() && agree(line)).count();
    assert!(taken > 100, "only {taken} lines of the corpus are taken");
    let taken = std::cell::Cell::new(0);
    let lines = proptest::string::string_regex(shape).unwrap().prop_filter("a line", |line| !line.is_empty());
    runner(3_000)
        .run(&lines, |line| {
            taken.set(taken.get() + usize::from(agree(line.as_bytes())));
            Ok(())
        })
        .unwrap();
    assert!(taken.get() > least, "only {} random lines are taken", taken.get());
}

/// The names of the codes of a line's faults, each with its column from 1.
pub fn faults(parser: Parser, line: &str) -> Vec<(String, u32)> {
    let blocks = parse(parser, line.as_bytes());
    let errors = blocks.iter().flat_map(|block| &block.errors);
    errors.map(|error| (format!("{:?}", error.code), error.span.start + 1)).collect()
}

/// A line's items in short form: words as `X=1.`, expressions with their operator
/// in front.
pub fn show(parser: Parser, line: &str) -> String {
    let blocks = parse(parser, line.as_bytes());
    let items = blocks.iter().flat_map(|block| &block.items);
    items.map(|item| show_item(item, line)).collect::<Vec<_>>().join(" ")
}

fn show_item(item: &Item, line: &str) -> String {
    let text = |span: Span| line[span.range()].to_owned();
    match &item.kind {
        ItemKind::Skip(level) => level.map_or("skip".into(), |level| format!("skip{level}")),
        ItemKind::Tape => "%".into(),
        ItemKind::EndOfBlock => ";".into(),
        ItemKind::Program(ProgramName::Number(number)) => format!("O{number}"),
        ItemKind::Program(ProgramName::Name(name)) => format!("O<{name}>"),
        ItemKind::Sequence { number, inserted } => format!("N{}{number}", if *inserted { "+" } else { "" }),
        ItemKind::Label(label) => show_label(label),
        ItemKind::MacroMark => "#".into(),
        ItemKind::Comment(comment) => format!("{:?}[{}]", comment.fence, text(comment.text)),
        ItemKind::Word(word) => {
            let value = word.value.as_ref().map(show_expr).unwrap_or_default();
            format!("{}{}{}", word.letter, if word.equals { "=" } else { "" }, value)
        }
        ItemKind::Assign { target, value, by_sign } => {
            let sign = if *by_sign { "<-" } else { ":=" };
            format!("{}{sign}{}", show_var(target), show_expr(value))
        }
        ItemKind::If { condition, body, .. } => {
            let body = body.iter().map(|item| show_item(item, line)).collect::<Vec<_>>().join(" ");
            format!("if({} {body})", show_expr(condition))
        }
        ItemKind::Goto(target) => format!("goto({})", show_target(target)),
        ItemKind::Branch { relation, target } => format!("{relation:?}({})", show_target(target)),
        ItemKind::Test(TestSubject::Variable(variable)) => format!("test({})", show_var(variable)),
        ItemKind::Test(TestSubject::Code(code)) => format!("test(G{code})"),
        ItemKind::Test(TestSubject::Flag(flag)) => format!("test(Q{flag})"),
        ItemKind::Step { target, down } => {
            format!("{}({})", if *down { "dec" } else { "inc" }, show_var(target))
        }
        ItemKind::Timer(variable) => format!("tim({})", show_var(variable)),
        ItemKind::Transfer { table, cells } => {
            let row = match &table.row {
                TableRow::Word(letter, number) => format!("{letter}{number}"),
                TableRow::Variable(variable) => show_var(variable),
            };
            let mut out = format!("{}[{row}](", table.name);
            for cell in cells {
                let arrow = if cell.store { "<-" } else { "->" };
                let _ = write!(out, "{}{arrow}{};", cell.letter, show_var(&cell.variable));
            }
            out + ")"
        }
        ItemKind::Print { serial, parts, stay } => {
            let parts = parts.iter().map(|part| match part {
                PrintPart::Text(span) => format!("\"{}\"", text(*span)),
                PrintPart::Value(value) => show_expr(value),
            });
            let parts = parts.collect::<Vec<_>>().join(",");
            format!("{}({parts}{})", if *serial { "sprint" } else { "print" }, if *stay { "..." } else { "" })
        }
        ItemKind::Input { serial, targets } => {
            let targets = targets.iter().map(show_var).collect::<Vec<_>>().join(",");
            format!("{}({targets})", if *serial { "sinput" } else { "input" })
        }
        ItemKind::Clear(ranges) => {
            let ranges = ranges.iter().map(|(from, to)| match to {
                Some(to) => format!("{}..{}", show_var(from), show_var(to)),
                None => show_var(from),
            });
            format!("clear({})", ranges.collect::<Vec<_>>().join(","))
        }
        ItemKind::Set(options) => format!("set{options:?}"),
        ItemKind::Wait => "wait".into(),
        ItemKind::Start(value) => format!("start({})", show_expr(value)),
        ItemKind::Index(text) => format!("index({text})"),
        ItemKind::Unparsed => "unparsed".into(),
        other => format!("{other:?}"),
    }
}

fn show_label(label: &Label) -> String {
    match label {
        Label::Number(number) => format!("${number}"),
        Label::Name(name) => format!(":{name}"),
    }
}

fn show_target(target: &Target) -> String {
    match target {
        Target::Sequence(number) => format!("N{number}"),
        Target::Label(label) => show_label(label),
        Target::Computed(value) => show_expr(value),
    }
}

fn show_var(variable: &VarRef) -> String {
    let index = match &variable.index {
        Index::None => String::new(),
        Index::Number(number) => number.to_string(),
        Index::Bit(number, bit) => format!("{number}.{bit}"),
        Index::Letter(letter) => letter.to_string(),
        Index::Name(name) => format!("<{name}>"),
        Index::Computed(inner) => format!("[{}]", show_expr(inner)),
    };
    variable.name.to_string() + &index
}

fn show_expr(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Number(number) => {
            let point = number.point && number.value.fract() == 0.0;
            format!("{}{}", number.value, if point { "." } else { "" })
        }
        ExprKind::Variable(variable) => show_var(variable),
        ExprKind::Negate(inner) => format!("-{}", show_expr(inner)),
        ExprKind::Plus(inner) => format!("+{}", show_expr(inner)),
        ExprKind::Not(inner) => format!("(Not {})", show_expr(inner)),
        ExprKind::Binary(op, operands) => {
            let [a, b] = &**operands;
            format!("({op:?} {} {})", show_expr(a), show_expr(b))
        }
        ExprKind::Call { function, arguments, .. } => {
            let arguments = arguments.iter().map(show_expr).collect::<Vec<_>>().join(" ");
            format!("{function:?}({arguments})")
        }
        ExprKind::Group(inner) => format!("{{{}}}", show_expr(inner)),
    }
}
