//! Programs to measure with, the same on every machine: a 64-bit LCG of a fixed seed says what stands in them.

/// What the generators start from; printed with the figures.
pub const SEEDS: [(&str, u64); 3] = [("surface", 1), ("macros", 2), ("fadal", 3)];

struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    fn of<'t>(&mut self, all: &[&'t str]) -> &'t str {
        all[self.below(all.len() as u64) as usize]
    }
}

/// A number as CAM writes it: four digits, no zero before the point: `1.2345`, `-.5`, `3.`.
fn four(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0');
    match text {
        "0." | "-0." => "0.".into(),
        _ if text.starts_with("0.") => text[1..].into(),
        _ if text.starts_with("-0.") => format!("-{}", &text[2..]),
        _ => text.into(),
    }
}

/// 3-D surfacing of about `size` bytes: plain words, hardly ever a comment, an arc at the end of each pass.
pub fn surface(size: usize) -> String {
    let mut r = Random(SEEDS[0].1);
    let mut out = String::from(
        "%\nO1234 (SURFACING TEST PART)\n(MATERIAL - ALUMINUM 6061)\nN10 G20 G17 G40 G49 G80 G90 G94\n",
    );
    let (mut n, mut tool) = (20, 0usize);
    while out.len() < size {
        tool = tool % 20 + 1;
        let (mill, dia) = (["1/2", "3/8", "1/4", "1/8"][tool % 4], four(0.5 / (tool % 4 + 1) as f64));
        out += &format!("(TOOL {tool} - {mill} BALL ENDMILL - DIA {dia})\nN{n} T{tool} M6\n");
        out += &format!("N{} S{} M3\nN{} G0 G90 G54 X0. Y0.\n", n + 10, 3000 + tool * 250, n + 20);
        out += &format!("N{} G43 H{tool} Z1. M8\nG1 Z.5 F30.\n", n + 30);
        n += 40;
        let (mut y, mut forth) = (0.0, true);
        for pass in 0..60 {
            let mut xs: Vec<f64> =
                (1..300).map(|i| f64::from(i) * 0.013 + r.below(40) as f64 * 0.0001).collect();
            if !forth {
                xs.reverse();
            }
            for (at, &x) in xs.iter().enumerate() {
                let z = four(0.5 * (x * 1.7 + y).sin() * (y * 2.3).cos() - 0.25);
                let (x, k) = (four(x), r.below(100));
                out += &match k {
                    _ if at == 0 => format!("G1 X{x} Y{} Z{z} F{}.\n", four(y), [30, 45, 60][pass % 3]),
                    0..70 => format!("X{x} Z{z}\n"),
                    70..96 => format!("X{x} Y{} Z{z}\n", four(y)),
                    96..98 => {
                        let at = n;
                        n = n % 99_990 + 10;
                        format!("N{at} X{x} Z{z}\n")
                    }
                    98 => format!("G1 X{x} Z{z} F{}.\n", 30 + r.below(40)),
                    _ => format!("X{x} Z{z} (PASS {pass})\n"),
                };
            }
            let (x, to) = (four(xs[xs.len() - 1]), four(y + 0.02));
            out += &format!("G{} X{x} Y{to} I0. J.01\nG1\n", if forth { 3 } else { 2 });
            (y, forth) = (y + 0.02, !forth);
            if out.len() >= size {
                break;
            }
        }
        out += "G0 Z1.\nM9\nM5\nG91 G28 Z0.\nG90\n";
    }
    out + "M30\n%\n"
}

/// Statements of a macro program, each with its number.
const STATEMENTS: u64 = 40;

/// Macro statements of every kind, of about `size` bytes.
pub fn macros(size: usize) -> String {
    let mut m = Macros(Random(SEEDS[1].1));
    let mut out = String::from("%\nO1000 (MACRO LIBRARY)\n");
    let mut program = 1001;
    while out.len() < size {
        out += &format!("O{program}(MACRO {program})\n");
        program = if program < 9999 { program + 1 } else { 1001 };
        for n in 1..=STATEMENTS {
            out += &format!("N{}{}\n", 10 * n, m.statement());
        }
        out += "M99\n";
    }
    out + "%\n"
}

/// Assignments no two of which differ in digits alone, of about `size` bytes: what was read before is of no use for the
/// next.
pub fn unlike(size: usize) -> String {
    let mut m = Macros(Random(SEEDS[1].1));
    let mut out = String::from("%\nO1\n");
    let mut seen = std::collections::HashSet::new();
    while out.len() < size {
        let line = format!("#{}={}\n", 100 + m.0.below(60), m.expr(4));
        let shape: String = line.split(|sign: char| sign.is_ascii_digit()).collect();
        // Longer ones are no line of a program.
        if line.len() < 120 && seen.insert(shape) {
            out += &line;
        }
    }
    out + "M30\n%\n"
}

struct Macros(Random);

impl Macros {
    fn var(&mut self) -> String {
        let many = self.0.below(3) > 0;
        format!("#{}", if many { 100 + self.0.below(60) } else { 1 + self.0.below(33) })
    }

    fn num(&mut self) -> String {
        if self.0.below(2) > 0 {
            let (n, scale) = (self.0.below(20_000) as f64 - 10_000.0, 10f64.powi(self.0.below(4) as i32));
            return four(n / scale);
        }
        self.0.below(1000).to_string()
    }

    fn atom(&mut self, depth: u32) -> String {
        const FUNCTIONS: [&str; 14] = [
            "SIN", "COS", "TAN", "SQRT", "ABS", "ROUND", "FIX", "FUP", "ACOS", "ASIN", "LN", "EXP", "BIN",
            "BCD",
        ];
        match self.0.below(10) {
            k if k < 4 || depth == 0 => self.var(),
            4..6 => self.num(),
            6 => format!("#[{}+500]", self.var()),
            // A number alone may lie outside of what the function takes.
            7..9 => format!("{}[{}+{}]", self.0.of(&FUNCTIONS), self.var(), self.expr(depth - 1)),
            _ => format!("[{}]", self.expr(depth - 1)),
        }
    }

    fn expr(&mut self, depth: u32) -> String {
        let mut out = self.atom(depth);
        for _ in 0..self.0.below(3) {
            let all = ["+", "-", "*", "/", "*", "+", " MOD ", " AND ", " OR ", " XOR "];
            let some = if self.0.below(4) == 0 { &all[..] } else { &all[..6] };
            let operator = self.0.of(some);
            out += operator;
            out += &if operator == "/" { self.var() } else { self.atom(depth) };
        }
        out
    }

    fn compare(&mut self) -> &'static str {
        self.0.of(&["EQ", "NE", "GT", "GE", "LT", "LE"])
    }

    fn statement(&mut self) -> String {
        match self.0.below(20) {
            0..5 => format!("{}={}", self.var(), self.expr(2)),
            5 => "#101=[#100+#[#2+500]]*SIN[#3] (SCALE)".into(),
            6 => format!("{}={}", self.var(), self.num()),
            7..9 => {
                let (var, compare, num) = (self.var(), self.compare(), self.num());
                format!("IF[{var} {compare} {num}]GOTO{}", 10 * (1 + self.0.below(STATEMENTS)))
            }
            9 => {
                let (a, compare, b) = (self.expr(1), self.compare(), self.expr(1));
                format!("IF [{a} {compare} {b}] THEN {}={}", self.var(), self.expr(1))
            }
            10..12 => {
                let (depth, var) = (1 + self.0.below(3), self.var());
                let head = format!("WHILE[{} LE {}]DO{depth}", self.var(), self.num());
                let body = format!("G1 X[{}] Y{} F#9\n{var}={var}+1", self.expr(1), self.var());
                format!("{head}\n{body}\nEND{depth}")
            }
            12..14 => {
                let (program, a, b) = (1010 + self.0.below(20), self.num(), self.num());
                format!("G65 P{program} A{a} B{b} C{}", self.var())
            }
            14..17 => {
                let var = self.var();
                format!("G1 X[{var}*{}] Y{} F#9", 1 + self.0.below(9), self.var())
            }
            17 => format!("G0 X{} Y{} Z[{}]", self.num(), self.num(), self.expr(1)),
            18 => format!("(CHECK TOOL {} AND WEAR OFFSET)", self.0.below(99)),
            _ => match self.0.below(4) {
                0 => format!("GOTO {}", 10 * (1 + self.0.below(STATEMENTS))),
                1 => "/M8".into(),
                2 => "#3000=1 (TOOL BROKEN)".into(),
                _ => "G#4 X-#5 Y-[#6+#7]".into(),
            },
        }
    }
}

/// Fadal's macro language among moves, of about `size` bytes in one program.
pub fn fadal(size: usize) -> String {
    let mut r = Random(SEEDS[2].1);
    let mut out = String::from("%\nO1\nN1 G90 G17 G40 G80\n#V1=0\n");
    let mut label = 0;
    while out.len() < size {
        let (a, b, c) = (1 + r.below(30), 1 + r.below(30), r.below(1000) as f64 / 8.0);
        out += &match r.below(8) {
            0 => format!("#V{a}=V{b}*{}+SIN(V{a})\n", four(c)),
            1 => format!("#R{}=V{b}\n", 1 + r.below(8)),
            2 => {
                label += 1;
                format!("#IF V{a} > {} THEN GOTO :L{label}\n#V{a}=V{a}+1\n#:L{label}\n", four(c))
            }
            3 => format!("G1 X+R{} Y-R{} F{}.\n", 1 + r.below(8), 1 + r.below(8), 1 + r.below(90)),
            _ => format!("G1 X{} Y{}\n", four(c), four(-c)),
        };
    }
    out + "M30\n%\n"
}

/// A program that counts to `steps` in a loop of two blocks.
pub fn counting(steps: u64) -> String {
    format!("O1\n#1=0\nN10 #1=#1+1\nIF[#1 LT {}]GOTO10\nM30\n", steps / 2)
}

/// A program of `steps` straight moves.
pub fn moving(steps: u64) -> String {
    let mut out = String::from("O1\nG21 G90 G1 F100.\n");
    for n in 0..steps {
        out += &format!("X{}. Y{}.\n", n % 97, n % 53);
    }
    out + "M30\n"
}
