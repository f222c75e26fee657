//! Programs of one shape, as long as wanted: each is what some step of the way may be slow at.

use std::fmt::Write;

/// What stands at the head of programs on a mill.
const HEAD: &str = "%\nO0001\nG20 G17 G90 G40 G80 G94\n";
const END: &str = "M30\n%\n";

/// A program that is a row of pieces.
fn row(pieces: usize, piece: impl Fn(&mut String, usize) -> std::fmt::Result) -> String {
    let mut out = String::from(HEAD);
    for at in 0..pieces {
        // A string takes all that is written.
        let _ = piece(&mut out, at);
    }
    out + END
}

/// Programs that each call the next one: `n` lines, deeper than any control nests calls.
pub fn chain(n: usize) -> String {
    calls(n, |_| true)
}

/// Programs that call the next one, two of three: `n` lines in chains that every control nests.
pub fn short_chains(n: usize) -> String {
    calls(n, |at| at % 3 != 2)
}

fn calls(n: usize, goes_on: impl Fn(usize) -> bool) -> String {
    let programs = (n / 5).min(9990);
    let mut out = String::new();
    for at in 0..programs {
        let call = if goes_on(at) { format!("M98 P{}\n", at + 2) } else { String::new() };
        let _ = write!(out, "O{:04}\nG20 G90\nG0 X{}.\n{call}M99\n", at + 1, at % 50);
    }
    let _ = write!(out, "O{:04}\nG0 X1.\nM99\n", programs + 1);
    out
}

/// Loops one after the other, `n` lines.
pub fn whiles(n: usize) -> String {
    row(n / 5, |out, _| out.write_str("#1=0\nWHILE [#1 LT 3] DO 1\nG0 X#1\n#1=#1+1\nEND 1\n"))
}

/// Conditions with an assignment each, `n` lines.
pub fn ifs(n: usize) -> String {
    row(n, |out, at| writeln!(out, "IF [#{} GT {at}] THEN #{}={at}", 500 + at % 20, 600 + at % 20))
}

/// Conditions with a jump each, `n` lines.
pub fn jumps(n: usize) -> String {
    row(n / 3, |out, at| {
        let (to, from) = (at + 1, 500 + at % 20);
        writeln!(out, "IF [#{from} EQ {at}] GOTO {to}\nG0 X{}.\nN{to} G0 Y{}.", at % 50, at % 7)
    })
}

/// Calls of 80 subroutines in the head of a program, `n` lines.
pub fn subs(n: usize) -> String {
    let mut out = String::from("%\nO1(SUBS\n");
    for at in 0..80 {
        let _ = write!(out, "L{}\nG1 X{at}. F10.\nM17\n", (at + 1) * 100);
    }
    out += "M30\nG90 G0 X0\n";
    for at in 0..n {
        let _ = writeln!(out, "L{}", (at % 80 + 1) * 100 + 1);
    }
    out + "M2\n%\n"
}

/// Loops in loops in loops, `n` lines.
pub fn nested(n: usize) -> String {
    let one = "WHILE [#1 LT 3] DO 1\nWHILE [#2 LT 3] DO 2\nWHILE [#3 LT 3] DO 3\n\
               #3=#3+1\nEND 3\n#2=#2+1\nEND 2\n#1=#1+1\nEND 1\n";
    row(n / 9, |out, _| out.write_str(one))
}

/// `n` lines that nobody can read.
pub fn faulty(n: usize) -> String {
    row(n, |out, at| writeln!(out, "G0 X{at}. [[ #=]"))
}

/// `n` codes that the machine does not have, on one line.
pub fn findings(n: usize) -> String {
    let codes: Vec<String> = (0..n).map(|at| format!("M{}", 200 + at % 700)).collect();
    format!("{HEAD}G0 X1. {}\n{END}", codes.join(" "))
}

/// A comment of `n` bytes.
pub fn comment(n: usize) -> String {
    format!("{HEAD}({})\n{END}", "A".repeat(n))
}

/// Twenty comments of `n` bytes each.
pub fn comments(n: usize) -> String {
    row(20, |out, _| writeln!(out, "({})", "A".repeat(n)))
}

/// A line of `n` bytes.
pub fn line(n: usize) -> String {
    format!("{HEAD}G0 {}\n{END}", "X1.".repeat(n / 3))
}

/// A file of `n` programs.
pub fn programs(n: usize) -> String {
    let mut out = String::from("%\n");
    for at in 0..n {
        let _ = write!(out, "O{:04}\nG20 G90 G17\n#1=#500\nIF [#1 GT {at}] GOTO 10\nG0 X#1\n", at + 1);
        let _ = write!(out, "N10 G1 Y{}. F10.\nM99\n", at % 50);
    }
    out + "%\n"
}
