//! What only these dialects have.

use super::Writer;
use crate::generate::{Source, Value};

impl Writer<'_> {
    pub(super) fn own(&mut self, which: usize, value: &Value, choices: &mut Source<'_>) {
        let gap = self.gap;
        let text = self.value(value, 0);
        match which {
            0 => {
                // What stands behind a jump is never run.
                let end = self.labels(1);
                self.line(&format!("GOTO{gap}{end}"));
                self.line(&format!("G1 X[{text}]"));
                self.line(&format!("N{end}"));
            }
            1 => {
                let end = self.labels(1);
                self.line(&format!("IF{gap}[{}{gap}LE{gap}60]{gap}GOTO{gap}{end}", self.name(1)));
                self.line("#3000=12(TOO FAR)");
                self.line(&format!("N{end}"));
            }
            2 => self.line("#3006=1(LOOK)"),
            3 => {
                let name = self.name(choices.below(crate::generate::draw::SLOTS));
                self.line(&format!("{name}=#0"));
            }
            4 => {
                self.line("POPEN");
                let line = format!("DPRNT[X{}[43]]", self.name(2));
                self.line(&line);
                self.line("PCLOS");
            }
            5 => self.line(&format!("/G0 X[{text}]")),
            6 => self.line(&format!("G1 X[ROUND[{text}]]")),
            7 => {
                self.line(&format!("#118=[{text}]*10+200"));
                self.line("F#118");
            }
            8 => self.line("G61"),
            9 => self.line("G64"),
            10 => self.line("G9 G1 X3."),
            11 => {
                let name = self.name(3);
                self.line(&format!("#[151]={name}+1"));
                self.line("#105=#[150+1]");
            }
            12 => self.line(&format!("G1 X#0 Z[{text}]")),
            13 => self.line("G18"),
            14 => self.line("G17"),
            _ => self.line("(A COMMENT)"),
        }
    }
}
