//! Every program and fragment of the corpus.

use super::{BOTH, Dialect, FANUC, Fragment, HAAS};
use crate::diag::Code;
use crate::syntax::SyntaxError;

/// Errors in the blocks of a file.
fn faults(dialect: &Dialect, source: &[u8]) -> Vec<SyntaxError> {
    dialect.file(source).iter().flat_map(|block| block.errors.clone()).collect()
}

#[test]
fn programs_of_the_corpus_have_no_fault() {
    for dialect in BOTH {
        for (path, source) in dialect.corpus() {
            let blocks = dialect.file(&source);
            for block in &blocks {
                assert_eq!(block.errors, [], "{path}: {}", String::from_utf8_lossy(block.span.of(&source)));
            }
        }
    }
}

/// Skeletons of the manuals, with their open places filled in.
fn filled(text: &str) -> String {
    text.replace("[...]", "[#1 LT 2]")
        .replace("GOTO n", "GOTO 5")
        .replace("Nn ...", "N5 #2=1")
        .replace("Nn", "N5")
}

#[test]
fn fragments_that_are_right_have_no_fault() {
    for dialect in BOTH {
        for Fragment { text, meaning, .. } in dialect.fragments().iter().filter(|f| f.status == "ok") {
            for block in dialect.file(text.as_bytes()) {
                assert_eq!(block.errors, [], "{}: {text}: {meaning}", dialect.name);
            }
        }
    }
}

#[test]
fn parts_are_read_in_their_place() {
    for dialect in BOTH {
        for Fragment { text, .. } in dialect.fragments().iter().filter(|f| f.status == "part") {
            let wrapped = match text.as_str() {
                text if text.ends_with("THEN") || text.starts_with("IF") => format!("{text} #1=2"),
                text if text.contains("...") || text.starts_with(['D', 'G']) => filled(text),
                text => format!("#1=[{text}]"),
            };
            for block in dialect.file(wrapped.as_bytes()) {
                assert_eq!(block.errors, [], "{}: {wrapped}", dialect.name);
            }
        }
    }
}

/// Fragments that are wrong between their blocks: lowering says what of them.
const BETWEEN_BLOCKS: [&str; 3] = [
    "WHILE [...] DO 1 ; WHILE [...] DO 2 ; END 1 ; END 2 ;",
    "IF [...] GOTO n ; WHILE [...] DO 1 ; Nn ... ; END 1 ;",
    "G67",
];

/// Each other fragment that a manual calls wrong: what is said of it, and at which text.
const WRONG: &[(&str, &str, Code, &str)] = &[
    ("fanuc", "#510 = 12345.6789", Code::TooManyDigits, "12345.6789"),
    ("fanuc", "#510 = 0.12345678", Code::TooManyDigits, "0.12345678"),
    ("fanuc", "O#100", Code::VariableProgramNumber, "#"),
    ("fanuc", "N#100", Code::VariableProgramNumber, "#"),
    ("fanuc", "M03 S1001.5", Code::NotInteger, "S1001.5"),
    ("fanuc", "M03 S2000.5", Code::NotInteger, "S2000.5"),
    ("fanuc", "M05.5", Code::NotInteger, "M05.5"),
    ("fanuc", "#0 = #1", Code::NullAssigned, "#0"),
    ("fanuc", "#100 = ATAN[1]/10 ;", Code::AtanDivision, "10"),
    ("fanuc", "#1=#2/0", Code::DivisionByZero, "0"),
    ("fanuc", "#1=ASIN[2]", Code::FunctionDomain, "2"),
    ("fanuc", "IF [#1 > 10] GOTO 2", Code::RelationalSign, ">"),
    ("fanuc", "WHILE [#1 LT 10] DO 4", Code::LoopNumber, "4"),
    ("fanuc", "G01 X100.0 G65 P9010", Code::MacroCallNotAlone, "G01"),
    ("fanuc", "A1.0 G65 P1000", Code::ArgumentBeforeCall, "A1.0"),
    ("fanuc", "#0=1", Code::NullAssigned, "#0"),
    ("fanuc", "N#1", Code::VariableProgramNumber, "#"),
    ("haas", "((text)text)", Code::NestedComment, "("),
    ("haas", "DO4", Code::LoopNumber, "4"),
];

#[test]
fn fragments_that_are_wrong_say_why() {
    for dialect in [FANUC, HAAS] {
        let fragments = dialect.fragments();
        let wrong = fragments.iter().filter(|f| f.status == "error");
        for fragment in wrong.filter(|f| !BETWEEN_BLOCKS.contains(&f.text.as_str())) {
            let row = WRONG.iter().find(|(name, text, ..)| *name == dialect.name && *text == fragment.text);
            let (_, _, code, place) = row.unwrap_or_else(|| panic!("no expectation for {}", fragment.text));
            let text = filled(&fragment.text);
            let found = faults(&dialect, text.as_bytes());
            let fault = found.iter().find(|fault| fault.code == *code);
            let fault = fault.unwrap_or_else(|| panic!("{text}: expected {code:?}, found {found:?}"));
            let at = text.rfind(place).filter(|_| *place == "0" || *place == "2" || *place == "10");
            let at = at.or_else(|| text.find(place)).unwrap();
            let at = if *code == Code::NestedComment { 1 } else { at };
            assert_eq!((fault.span.start as usize, fault.span.len()), (at, place.len()), "{text}: {fault:?}");
        }
    }
}

/// Slips of real programs.
const SLIPS: &[(&str, Code, u32)] = &[
    ("G90G00X-[[#524/2]+0.125]]Y[#1]", Code::UnbalancedBracket, 24),
    ("X[#1+[#2]", Code::UnbalancedBracket, 1),
    ("WHILE[#1LT2]D02", Code::LoopWordSlip, 12),
    ("#19=#17/SIN(ACOS((#20-2.0*#124)/#20))", Code::RoundBrackets, 11),
    ("#1=#2*(#3+1)", Code::RoundBrackets, 6),
    ("N1 M6 T1 (LOAD PROBE", Code::UnclosedComment, 9),
    ("G0 X Y5", Code::WordWithoutValue, 3),
    ("G1Z-0.5.F0.03", Code::Unreadable, 7),
    ("TO303", Code::WordWithoutValue, 1),
    ("#1=#1-#11:", Code::Unreadable, 9),
    ("##1=2", Code::BareIndirection, 1),
    ("M98 P#1.#2", Code::Unreadable, 7),
    ("IF[#1 EQ 2]", Code::NothingConditional, 0),
    ("DPRNT[X#1[54]]", Code::OutputFormat, 7),
    ("#1=SQRT[-1]", Code::FunctionDomain, 8),
    ("IF[#1GT9]THEN#2=SQRT[-1]", Code::AlarmIfRun, 21),
    ("IF[#1GT9]THEN#2=#1/0", Code::AlarmIfRun, 19),
    ("IF[#1/0GT9]THEN#2=1", Code::DivisionByZero, 6),
    ("G1 X1.0 *", Code::Unreadable, 8),
    ("N99999999999", Code::TooManyDigits, 1),
];

#[test]
fn slips_are_named_at_their_column() {
    for dialect in BOTH {
        for (text, code, at) in SLIPS {
            let found = faults(&dialect, text.as_bytes());
            let places: Vec<(Code, u32)> = found.iter().map(|fault| (fault.code, fault.span.start)).collect();
            assert_eq!(places, [(*code, *at)], "{}: {text}: {found:?}", dialect.name);
        }
    }
}

#[test]
fn text_after_the_end_of_a_block_is_told_to_be_a_remark() {
    for dialect in BOTH {
        let found = faults(&dialect, b"#101=0 ; Centre of rotation X");
        let [fault] = found.as_slice() else { panic!("{found:?}") };
        assert_eq!((fault.code, fault.span.start), (Code::WordWithoutValue, 8));
        assert!(fault.message.contains("write a remark in `(` and `)`"), "{}", fault.message);
        assert_eq!(faults(&dialect, b"#101=0 ; G54"), []);
        assert!(!faults(&dialect, b"#101=0 ; #102=")[0].message.contains("remark"));
    }
}

#[test]
fn fanuc_nests_brackets_five_deep() {
    let five = "#1=[[[[[1]]]]]";
    let six = "#1=SIN[[[[[[1]]]]]]";
    assert_eq!(faults(&FANUC, five.as_bytes()), []);
    let found = faults(&FANUC, six.as_bytes());
    assert_eq!(found.iter().map(|f| (f.code, f.span.start)).collect::<Vec<_>>(), [(Code::BracketDepth, 11)]);
    assert_eq!(faults(&HAAS, six.as_bytes()), []);
}

#[test]
fn depth_is_an_error_and_no_overflow() {
    let deep = format!("#1={}1{}", "[".repeat(5000), "]".repeat(5000));
    let long = format!("#1=1{}", "+1".repeat(50_000));
    let signs = format!("#1={}1", "-".repeat(50_000));
    let conditions = format!("{}GOTO1", "IF[1]".repeat(10_000));
    let variables = format!("{}1=1", "#".repeat(50_000));
    let indirect = format!("#1={}1{}", "#[".repeat(200), "]".repeat(200));
    for dialect in BOTH {
        for text in [&deep, &long, &signs, &conditions, &variables, &indirect] {
            assert_eq!(faults(&dialect, text.as_bytes()).len(), 1, "{}", &text[..20]);
        }
    }
}

/// Fanuc 30i: M98 <NAME> calls the program of that file.
#[test]
fn a_call_by_the_name_of_a_file_is_told() {
    for block in ["M98<PART_1>", "M98 <PART_1> L2", "G65 <PART_1> A1."] {
        let fault = &faults(&FANUC, block.as_bytes())[0];
        assert!(fault.message.contains("by the name of its file"), "{block}: {}", fault.message);
    }
    for block in ["M98 <", "X5. <A>", "IF[#1 <2]GOTO3", "#1=<2>", "IF[#1 < #2 > 3]GOTO3"] {
        let found = faults(&FANUC, block.as_bytes());
        assert!(!found[0].message.contains("file"), "{block}: {}", found[0].message);
    }
}
