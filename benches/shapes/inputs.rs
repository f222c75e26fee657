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

/// Small macro programs as shops have them; `@a` to `@d` are numbers, `@o` is a program's own, `@p` that of the one before.
const SMALL: [&str; 8] = [
    "O@o(SUM)\n#1=0\n#2=1\nN1 IF[#2 GT @d] GOTO 2\n#1=#1+#2\n#2=#2+@b\nGOTO 1\nN2 #50@b=#1\nM30\n",
    "O@o(BOLT CIRCLE)\n@s#101=@a.\n#102=@b\n#103=@c.\n#104=0\nT@b M6\nS1@a0 M3\nG54 G0 X0 Y0\nG43 H@b Z25. M8\n\
     WHILE[#104 LT #102]DO1\n#105=#103+#104*360/#102\nG0 X[#101*COS[#105]] Y[#101*SIN[#105]]\nZ2.\n\
     G1 Z-@b. F1@a.\nG0 Z2.\n#104=#104+1\nEND1\nG0 Z25. M9\nM5\nG91 G28 Z0\nG90\nM30\n",
    "O@o(GRID)\n@s#1=@e\n#2=@f\nT@b M6\nS1@d0 M3\nG54 G0 X0 Y0\nG43 H@b Z10.\n#3=0\nWHILE[#3 LT #1]DO1\n#4=0\n\
     WHILE[#4 LT #2]DO2\nG81 X[#3*@a.] Y[#4*@d.] Z-@b. R1. F1@a.\n#4=#4+1\nEND2\n#3=#3+1\nEND1\nG80\nM5\nM30\n",
    "O@o(CHECK)\n#10=@a\n#20=@d\nIF [#10 GT #20] THEN #1=#10-#20\nIF [#500 EQ #0] GOTO 9\nIF [#500 LT @a.] GOTO 8\n\
     #501=#500/@b\nGOTO 9\nN8 #3000=@b(TOO SMALL)\nN9 M30\n",
    "O@o(PECK)\n@s#110=@a.\n#111=@b.\n#112=0.@b\n#113=@d./4\nS1@a0 M3\nG54 G0 X@a. Y@d.\nG43 H@b Z5.\n\
     N10 IF[#112 GE #110]GOTO20\nG0 Z[1.-#112]\nG1 Z[-#112-#113] F#111\nG0 Z5.\n#112=#112+#113\n#113=#113*.8\n\
     IF[#113 LT 1.]THEN #113=1.\nGOTO10\nN20 G0 Z-#112\nG1 Z-#110\nG4 P@c\nG0 Z25.\nM5\nM30\n",
    "O@o(SLOT)\nG90\n#30=#4003\nIF[#26 EQ #0]GOTO90\nG0 X#24 Y#25\nG1 Z-#26 F#9\n#31=0\nWHILE[#31 LT #11]DO1\n\
     G91 G1 X@b. F[#9*2]\nY@e.\nX-@b.\nY-@e.\n#31=#31+1\nEND1\nG90 G0 Z5.\nG#30\nM99\nN90 #3000=@b(NO DEPTH)\n",
    "O@o(SLOTS)\n@sT@b M6\nS1@d0 M3\nG54 G0 X0 Y0\nG43 H@b Z10.\nG65 P@p X@a. Y@d. Z@b. F1@a. H@e\n\
     G65 P@p X-@a. Y@d. Z@b.5 F1@a. H@f\nM5\nM30\n",
    "O@o(ELLIPSE)\n@s#1=@a.\n#2=@d.\n#3=0\nS1@a0 M3\nG54 G0 X#1 Y0\nG43 H@b Z2.\nG1 Z-@b. F100.\nN5 #3=#3+1@b.\n\
     IF[#3 GE 360.]GOTO6\n#24=#1*COS[#3]\n#25=#2*SIN[#3]\nG1 X#24 Y#25 F1@a.\nGOTO5\nN6 G1 X#1 Y0\nG0 Z25.\nM5\nM30\n",
];

/// `n` small programs; of each eight one is a macro that the next one calls.
pub fn library(n: usize) -> String {
    let one = |at: usize| {
        let numbers = [
            ("@a", 10 + at * 7 % 40),
            ("@b", 1 + at * 5 % 9),
            ("@c", 1 + at * 11 % 360),
            ("@d", 10 + at * 3 % 20),
            ("@e", 2 + at * 5 % 3),
            ("@f", 2 + at * 7 % 4),
            ("@o", at + 1),
            ("@p", at),
        ];
        let text = SMALL[at % SMALL.len()].replace("@s", "G21 G17 G40 G49 G80 G90 G94\n");
        numbers.iter().fold(text, |text, (name, number)| text.replace(name, &number.to_string()))
    };
    format!("%\n{}%\n", (0..n).map(one).collect::<String>())
}
