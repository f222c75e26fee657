//! Variables, jumps and calls by computed numbers: bounded ones, and such as circumstances alone bound.

use super::Writer;
use crate::generate::draw::GIVEN;
use crate::generate::{Source, Step, Value};

/// Where computed variables begin: the program's own, ends of classes, and what a compiler may take for itself.
const BASES: [u32; 10] = [1, 27, 100, 100, 130, 150, 190, 500, 560, 600];

impl Writer<'_> {
    pub(super) fn cells(&mut self, which: usize, value: &Value, choices: &mut Source<'_>) {
        let gap = self.gap;
        let (text, given) = (self.value(value, 0), self.name(GIVEN + which % 4));
        let base = choices.pick(&BASES);
        let write = format!("#[{base}+{given}]={text}");
        let lines = match which {
            // Bounded by arithmetic, by conditions, by a counter, by what is assigned.
            0 => vec![
                format!("#118=FIX[ABS[{text}]] AND 7"),
                format!("#[{base}+#118]={text}"),
                format!("G0 X#[{base}+#118]"),
            ],
            1 | 2 => {
                let end = self.labels(1);
                vec![
                    format!("IF{gap}[{given} LT 0]{gap}GOTO{gap}{end}"),
                    format!("IF{gap}[{given} GT 9]{gap}GOTO{gap}{end}"),
                    format!("#[{base}+FIX[{given}]]={text}"),
                    format!("N{end}"),
                ]
            }
            3 if self.loops < 3 => {
                let number = self.loops + 1;
                vec![
                    "#117=0".into(),
                    format!("WHILE{gap}[#117 LT 6]{gap}DO{number}"),
                    format!("#[{base}+#117]={text}"),
                    "#117=#117+1".into(),
                    format!("END{number}"),
                ]
            }
            4 => vec![
                format!("#118=FIX[ABS[{text}]] AND 3"),
                "#117=FIX[ABS[#2]] AND 3".into(),
                format!("#[{base}+#118*4+#117]=#3"),
                format!("#105=#[{base}+#117*4+#118]"),
            ],
            5 => {
                vec![
                    "#118=2".into(),
                    format!("IF{gap}[{given} GT 3]{gap}THEN #118=4"),
                    format!("#[{base}+#118]={text}"),
                ]
            }
            // Bounded by circumstances alone.
            6 | 7 => vec![write, format!("#105=#[{base}+1]")],
            8 => vec![format!("#105=#[{base}+{given}]"), "G0 X#105".into()],
            9 => vec![format!("#[ROUND[{given}]]={text}")],
            10 => vec![format!("G0 X#[{base}+FIX[{given}]]")],
            11 => vec![format!("#[{base}+ROUND[ABS[#5041]]]={text}")],
            12 => vec![format!("#[{base}+{given}]=#0")],
            13 => vec![format!("#118={given}"), "#[#118]=#[#118]+1".into()],
            // Runs of system variables.
            14 => vec![
                format!("#118=FIX[ABS[{text}]] AND 3"),
                format!("#[5221+20*#118]={text}"),
                format!("#105=#[5222+20*#118]"),
            ],
            _ => vec![write],
        };
        lines.iter().for_each(|line| self.line(line));
    }

    /// A computed jump is taken three times at most, wherever it goes: a number that circumstances name may stand above.
    pub(super) fn jump(&mut self, given: usize, form: usize, arms: &[Vec<Step>], choices: &mut Source<'_>) {
        let (gap, name) = (self.gap, self.name(given));
        let (many, counter) = (arms.len() as u32, self.counter());
        let first = self.labels(many + 1);
        let end = first + 10 * many;
        self.line(&format!("{counter}={counter}+1"));
        self.line(&format!("IF{gap}[{counter}{gap}GT{gap}3]{gap}GOTO{gap}{end}"));
        match form {
            0 | 1 => self.line(&format!("GOTO{gap}{name}")),
            2 => self.line(&format!("GOTO{gap}[{name}*10]")),
            3 => self.line(&format!("IF{gap}[{name}{gap}GT{gap}2]{gap}GOTO{gap}{name}")),
            4 => {
                self.line(&format!("#118={first}"));
                self.line(&format!("IF{gap}[{name}{gap}GT{gap}4]{gap}THEN #118={}", first + 10));
                self.line(&format!("GOTO{gap}#118"));
            }
            // A subprogram goes on at a number of whatever called it.
            _ if self.part > 0 && choices.one_in(2) => {
                let line = format!("IF{gap}[{name}{gap}GT{gap}4]{gap}THEN #118={first}");
                self.line(&format!("#118={}", first + 10));
                self.line(&line);
                self.line("M99 P#118");
            }
            _ => self.line(&format!("GOTO{gap}[{first}+10*[FIX[ABS[{name}]]{gap}AND{gap}1]]")),
        }
        self.arms(arms, first, end);
    }

    /// A computed call: of one of two subprograms, or of the program that circumstances name.
    pub(super) fn far(&mut self, subs: [usize; 2], given: usize, form: usize) {
        let (gap, name) = (self.gap, self.name(given));
        let [one, other] = subs.map(|sub| self.number(sub));
        if form < 5 {
            self.line(&format!("#118={one}"));
            self.line(&format!("IF{gap}[{name}{gap}GT{gap}4]{gap}THEN #118={other}"));
            let line = ["M98 P#118", "G65 P#118 A2. B#1", "G65 P#118", "M98 P#118", "G65 P[#118] C1."][form];
            return self.line(line);
        }
        // What is called may call on: no deeper than three times.
        let (end, counter) = (self.labels(1), self.counter());
        self.line(&format!("{counter}={counter}+1"));
        self.line(&format!("IF{gap}[{counter}{gap}GT{gap}3]{gap}GOTO{gap}{end}"));
        let line = match form {
            5 => format!("M98 P{name}"),
            6 => format!("G65 P{name} A1."),
            _ => format!("M98 P[1000+{name}]"),
        };
        self.line(&line);
        self.line(&format!("N{end}"));
    }

    /// What counts the computed jumps and calls of this program that nothing else bounds.
    fn counter(&self) -> String {
        format!("#{}", 110 + self.part)
    }
}
