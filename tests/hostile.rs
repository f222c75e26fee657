//! Programs that are built to make a compiler hang, or to make its output explode.
//!
//! Each is of a size that a debug build must be done with in seconds; something that doubles with each operand,
//! or that grows with the square of the program, is not.

use macroglot::diag::Severity;
use macroglot::dialect::{Control, registry};
use macroglot::library::{Conversion, Input, Lock, Options, convert};
use macroglot::syntax::parse_file;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// A hundred times what any of these takes on a busy machine; one that explodes never ends.
const LIMIT: Duration = Duration::from_secs(300);

/// Converts a file and sees that it took no longer than it may.
fn converted(source: &str, target: &str, program: String) -> (Conversion, String) {
    let control = |name: &str| Control::plain(name).unwrap_or_else(|| panic!("no control {name}"));
    let (source, target) = (control(source), control(target));
    let inputs =
        [Input { path: PathBuf::from("case.nc"), name: "case.nc".into(), bytes: program.into_bytes() }];
    let lock = Lock::new(source.name(), target.name());
    let begun = Instant::now();
    let made = convert(&inputs, &source, &target, lock, Options::default());
    assert!(begun.elapsed() < LIMIT, "{:?}", begun.elapsed());
    let text = made.texts.first().cloned().flatten().unwrap_or_default();
    (made, text)
}

fn codes(made: &Conversion) -> Vec<&'static str> {
    let mut codes: Vec<&str> =
        made.programs.iter().flat_map(|p| &p.diagnostics).map(|d| d.code.number()).collect();
    codes.sort_unstable();
    codes.dedup();
    codes
}

fn refused(made: &Conversion) -> bool {
    let mut all = made.programs.iter().flat_map(|p| &p.diagnostics);
    all.any(|d| d.code.severity() == Severity::Error)
}

#[test]
fn thirty_joined_conditions() {
    for join in ["AND", "OR", "XOR"] {
        let conditions: Vec<String> = (0..30).map(|i| format!("[#{}EQ{i}]", 500 + i)).collect();
        let program = format!("O1\nIF[{}]GOTO10\nG0X1.\nN10M30\n", conditions.join(join));
        let (made, text) = converted("haas", "fanuc", program);
        assert!(!refused(&made), "{join}: {:?}", codes(&made));
        assert!(text.len() < 4000, "{join}: {} bytes", text.len());
    }
    let nested = (0..40).fold("[#500EQ1]".to_owned(), |inner, i| format!("[{inner}XOR[#{}EQ{i}]]", 500 + i));
    let (made, text) = converted("haas", "fanuc", format!("O1\nIF{nested}GOTO10\nG0X1.\nN10M30\n"));
    assert!(!refused(&made), "{:?}", codes(&made));
    assert!(text.len() < 4000, "{} bytes", text.len());
}

/// Two thousand jumps that each may go to five thousand blocks.
#[test]
fn computed_jumps_over_many_numbers() {
    let mut program = "O1\n".to_owned();
    for i in 0..5000 {
        let _ = writeln!(program, "N{}G0X{i}.", i + 1);
        if i % 2 == 0 && i < 4000 {
            let _ = writeln!(program, "GOTO#{}", 500 + i % 20);
        }
    }
    let (made, text) = converted("fanuc", "haas", program + "M30\n");
    assert!(!refused(&made), "{:?}", codes(&made));
    assert!(text.lines().count() < 12_000);
    assert!(text.contains("\nN5000 G0 X4999.\n"));
}

#[test]
fn returns_to_many_blocks_of_many_callers() {
    let mut program = "O1\n".to_owned();
    for n in 1..=300 {
        let _ = writeln!(program, "N{n}M98P2");
    }
    program += "M30\nO2\n";
    for n in 1..=300 {
        let _ = writeln!(program, "IF[#500NE{n}]GOTO{}\nM99P{n}\nN{}", n + 1000, n + 1000);
    }
    let (made, text) = converted("fanuc", "haas", program + "M99\n");
    assert!(!refused(&made), "{:?}", codes(&made));
    assert!(text.lines().count() < 5000, "{}", text.lines().count());
}

#[test]
fn programs_that_call_one_another_and_themselves() {
    let mut program = String::new();
    for i in 1..=200 {
        let _ = writeln!(program, "O{i}");
        for step in [0, 1, 7, 31] {
            let callee = (i + step - 1) % 200 + 1;
            let _ = writeln!(program, "M98P{callee}\nG65P{callee}A#{}B#100", step + 1);
            let _ = writeln!(program, "#{}=#{}+1", 100 + i % 50, step + 1);
        }
        program += "M99\n";
    }
    for (source, target) in [("fanuc", "haas"), ("haas", "fanuc")] {
        let (made, _) = converted(source, target, program.clone());
        assert!(!refused(&made), "{:?}", codes(&made));
        assert_eq!(made.programs.len(), 200);
    }
}

#[test]
fn local_subroutines_that_call_one_another() {
    let mut program = "O1\nM97P10000\nM30\n".to_owned();
    for i in 0..200 {
        let _ = writeln!(program, "N{}G0X{i}.\nM97P{}\nM99", 10_000 + 10 * i, 10_000 + 10 * ((i + 1) % 200));
    }
    let (made, text) = converted("haas", "fanuc", program);
    assert!(!refused(&made), "{:?}", codes(&made));
    // The main program stands first, behind no line.
    assert_eq!(text.matches("\nO").count(), 200);
}

/// What no control reads is refused at its place, and never a fault of the compiler.
#[test]
fn deep_expressions_are_refused() {
    let sum = format!("O1\n#1={}\nM30\n", vec!["#2"; 280].join("+"));
    let brackets = format!("O1\n#1={}1{}\nM30\n", "[".repeat(250), "]".repeat(250));
    let words = format!("O1\nX{}#1{}\nM30\n", "[".repeat(2000), "]".repeat(2000));
    for program in [sum, brackets, words] {
        for (source, target) in [("fanuc", "haas"), ("haas", "fanuc")] {
            let (made, _) = converted(source, target, program.clone());
            assert!(refused(&made) && !codes(&made).contains(&"MG0599"), "{:?}", codes(&made));
        }
    }
}

#[test]
fn functions_by_emulation_and_computed_variables() {
    let mut program = "O1\n".to_owned();
    for i in 0..500 {
        let _ = writeln!(
            program,
            "#{}=ATAN[#{}]/[#{}]+#500MOD7\n#[#{}]=#[500+#{}]",
            500 + i % 90,
            500 + (i + 1) % 90,
            500 + (i + 2) % 90,
            i % 30 + 1,
            i % 30 + 2
        );
    }
    let (made, _) = converted("fanuc", "haas", program + "M30\n");
    assert!(!refused(&made), "{:?}", codes(&made));
}

/// A line that no control takes is one finding, and stays as it was: its parts would fill the memory.
#[test]
fn lines_of_megabytes_are_kept_and_not_read() {
    let units = ["X1Y1", "(a)", "+#2", "1", "A", " ", ";", "[", "\"", "G1X1.;", "\u{1}"];
    for (unit, entry) in units.iter().flat_map(|unit| registry::all().iter().map(move |entry| (unit, entry)))
    {
        let program = format!("O1\nG0 X1.\n{}\nM30\n", unit.repeat((1 << 20) / unit.len()));
        let parsed = parse_file(program.as_bytes(), entry.parse);
        assert!(parsed.print() == program.as_bytes(), "{unit} of {}", entry.name);
        let faults: Vec<_> = parsed.blocks.iter().flat_map(|block| &block.errors).collect();
        let codes: Vec<_> = faults.iter().map(|fault| fault.code.number()).collect();
        assert_eq!((codes, parsed.blocks.len()), (vec!["MG0150"], 4), "{unit} of {}", entry.name);
        assert!(faults[0].message.contains("1048"), "{}", faults[0].message);
    }
}

/// A part that is read in two ways is read four times one level deeper: brackets that are never closed show it.
#[test]
fn brackets_that_are_not_closed() {
    let nested = [
        ("fadal", "#V2=", "V(2+1="),
        ("fadal", "#IF ", "R(1+"),
        ("fadal", "#PRINT ", "ABS("),
        ("fanuc", "#1=", "PRM[1]/["),
        ("fanuc", "IF[", "#[1+"),
        ("fanuc", "WHILE[", "ATAN[1]/["),
        ("haas", "#1=", "ATAN[1]/["),
        ("haas", "X", "FIX[#["),
    ];
    for (dialect, head, part) in nested {
        let parse = registry::find(dialect).unwrap().parse;
        let close = if dialect == "fadal" { ")" } else { "]" };
        for end in [String::new(), close.repeat(39), format!("1{}", close.repeat(40)), close.repeat(40)] {
            let program = format!("{head}{}{end}\nM30\n", part.repeat(40));
            let begun = Instant::now();
            assert_eq!(parse_file(program.as_bytes(), parse).print(), program.as_bytes());
            assert!(begun.elapsed() < LIMIT, "{program}: {:?}", begun.elapsed());
        }
    }
}
