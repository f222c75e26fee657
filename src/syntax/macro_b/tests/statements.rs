//! Random statements: valid ones, such as may be wrong in what the grammar lets pass, and damaged ones.

use proptest::prelude::*;
use proptest::sample::select;
use proptest::string::{bytes_regex, string_regex};

fn matching(pattern: &str) -> BoxedStrategy<String> {
    string_regex(pattern).unwrap().boxed()
}

/// What may be written without an operator and without brackets.
fn operand() -> BoxedStrategy<String> {
    prop_oneof![
        3 => matching("#[1-9][0-9]{0,3}"),
        2 => matching("-?([0-9]{1,4}(\\.[0-9]{0,4})?|\\.[0-9]{1,4})"),
        1 => matching("[0-9]{1,12}\\.[0-9]{0,6}"),
    ]
    .boxed()
}

/// An expression, its brackets no deeper than any control takes.
fn expression() -> BoxedStrategy<String> {
    const OPERATORS: &[&str] = &[
        "+", "-", "*", "/", " + ", " * ", " MOD ", "MOD", " AND ", "AND", " OR ", "XOR", " EQ ", "NE",
        " GT ", "GE", " LT ", "LE",
    ];
    const FUNCTIONS: &[&str] = &[
        "SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "SQRT", "SQR", "ABS", "ROUND", "RND", "FIX", "FUP",
        "LN", "EXP", "BIN", "BCD", "ADP", "PRM", "ATN",
    ];
    operand()
        .prop_recursive(4, 20, 3, |inner| {
            let chain = (inner.clone(), proptest::collection::vec((select(OPERATORS), inner.clone()), 1..4));
            prop_oneof![
                4 => chain.prop_map(|(first, rest)| {
                    rest.into_iter().fold(first, |all, (operator, next)| all + operator + &next)
                }),
                2 => inner.clone().prop_map(|inner| format!("[{inner}]")),
                1 => inner.clone().prop_map(|inner| format!("#[{inner}]")),
                1 => inner.clone().prop_map(|inner| format!("-[{inner}]")),
                3 => (select(FUNCTIONS), inner.clone()).prop_map(|(name, inner)| format!("{name}[{inner}]")),
                1 => (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("ATAN[{a}]/[{b}]")),
                1 => (inner.clone(), inner).prop_map(|(a, b)| format!("POW[{a},{b}]")),
            ]
        })
        .boxed()
}

fn word() -> BoxedStrategy<String> {
    let letter = "[A-MP-Z]";
    prop_oneof![
        4 => matching(&format!("{letter}-?[0-9]{{1,4}}(\\.[0-9]{{0,4}})?")),
        1 => matching(&format!("{letter}[+-]?#[1-9][0-9]{{0,2}}")),
        1 => matching(",[RCA]-?[0-9]{1,3}\\.?"),
        1 => select(&["G65P1", "G66", "G#4", "M98", "M6", "G1", "S#1", "T1."][..]).prop_map(str::to_owned),
        2 => (matching(&format!("{letter}-?")), expression()).prop_map(|(head, value)| format!("{head}[{value}]")),
    ]
    .boxed()
}

fn words() -> BoxedStrategy<String> {
    let blank = select(&["", " ", "", "  "][..]);
    let some = proptest::collection::vec((word(), blank), 1..5);
    some.prop_map(|words| words.into_iter().map(|(word, blank)| word + blank).collect()).boxed()
}

fn assignment() -> BoxedStrategy<String> {
    let target =
        prop_oneof![4 => matching("#[1-9][0-9]{0,3}"), 1 => expression().prop_map(|e| format!("#[{e}]"))];
    (target, select(&["=", " = "][..]), expression()).prop_map(|(to, is, value)| to + is + &value).boxed()
}

fn condition() -> BoxedStrategy<String> {
    let join = select(&["AND", " OR ", "XOR "][..]);
    let more = proptest::collection::vec((join, expression()), 0..2);
    let joined = (expression(), more).prop_map(|(first, more)| {
        more.into_iter().fold(format!("[{first}]"), |all, (join, next)| format!("{all}{join}[{next}]"))
    });
    joined.boxed()
}

fn statement() -> BoxedStrategy<String> {
    let jump = || {
        let target = prop_oneof![3 => matching(" ?[0-9]{1,4}"), 1 => matching("#[0-9]{1,3}")];
        target.prop_map(|to| format!("GOTO{to}"))
    };
    let then = prop_oneof![jump(), assignment().prop_map(|to| format!("THEN {to}")), words()];
    prop_oneof![
        3 => words(),
        5 => assignment(),
        3 => (matching("IF ?"), condition(), matching(" ?"), then)
            .prop_map(|(head, condition, blank, then)| head + &condition + &blank + &then),
        2 => (condition(), matching(" ?DO ?[1-3]")).prop_map(|(condition, head)| format!("WHILE{condition}{head}")),
        1 => matching("(DO|END) ?[1-3]"),
        1 => jump(),
        1 => matching("[O:][0-9]{1,5}|%|"),
    ]
    .boxed()
}

/// Lines of one or several blocks, in letters of either case, as programmers write them.
pub fn valid() -> impl Strategy<Value = Vec<u8>> {
    let block = (matching("/?[1-9]?(N[0-9]{1,5} ?)?"), statement(), matching("( ?\\([A-Z]{0,4}\\))?;? ?"));
    let block = block.prop_map(|(head, statement, tail)| {
        // A digit without its slash is no block.
        head.trim_start_matches(|c: char| c.is_ascii_digit()).to_owned() + &statement + &tail
    });
    (block, any::<u8>()).prop_map(|(line, case)| match case % 8 {
        0 => line.to_ascii_lowercase().into_bytes(),
        _ => line.into_bytes(),
    })
}

/// Valid lines in which one to three bytes were taken out, put in or exchanged.
pub fn damaged() -> impl Strategy<Value = Vec<u8>> {
    let byte = select(b" \t#[]()=+-*/,.;:%0123456789AEFGINOTXabx<>\0\x7f\xe9".as_slice());
    let damage = proptest::collection::vec((any::<u16>(), byte, 0..3u8), 1..4);
    (valid(), damage).prop_map(|(mut line, damage)| {
        for (at, byte, how) in damage {
            let at = usize::from(at) % (line.len() + 1);
            match how {
                0 => line.insert(at, byte),
                1 if at < line.len() => drop(line.remove(at)),
                2 if at + 1 < line.len() => line.swap(at, at + 1),
                _ => {}
            }
        }
        line
    })
}

/// Statements that can be wrong in what the grammar lets pass: divisors, arguments, digits, loops, calls.
pub fn doubtful() -> impl Strategy<Value = Vec<u8>> {
    let call = r"(SQRT|ASIN|LN|ATAN|SIN|FIX) ?\[(-?[0-2]|#1|#1-1|\[0\])\](/\[2\])?";
    let operand = format!(r"(#[0-3]|-?0|0\.0|2\.5|-1|123456789|\[-?0\]|\[-#1\]|#\[#1\]|{call})");
    let value = format!(r"{operand}((\+|-|\*|/| ?MOD ?| EQ | AND ){operand}){{0,3}}");
    let word = format!(r"(G65|G66|G1|G\[65\]|G#1|M6|M6\.|S1\.5|T#1|X-1\.|P1|Y\[{value}\]|,R1\.)");
    let then = format!(r"(GOTO ?10|THEN ?#1={value}|\(A\)|THEN|IF\[#1 LT 2\] ?(GOTO1)?|X1)?");
    let statement = format!(
        r"(#[0-2] ?={value}|{word}{{1,4}}|(IF ?)?\[{value}\] ?{then}|(WHILE\[{value}\])?DO[0-4]|END[0-4])"
    );
    bytes_regex(&format!(r"(N[0-9]{{1,3}} ?|/2)?{statement}( ?\(A\)){{0,2}}(;{statement})?;?")).unwrap()
}

/// Lines whose numbers have more digits than they had.
pub fn with_longer_numbers(lines: impl Strategy<Value = Vec<u8>>) -> impl Strategy<Value = Vec<u8>> {
    let digits = bytes_regex("0{0,2}[0-9]{1,3}(0{6}|3{37})?").unwrap();
    (lines, proptest::collection::vec(digits, 12)).prop_map(|(line, digits)| {
        let mut digits = digits.into_iter().cycle();
        let longer = |byte: u8| match byte {
            b'0'..=b'9' => digits.next().unwrap_or_default(),
            _ => vec![byte],
        };
        line.into_iter().flat_map(longer).collect()
    })
}
