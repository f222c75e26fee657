//! What the operator sees and switches, clocks, inputs, text output.

use super::Writer;
use crate::generate::draw::GIVEN;
use crate::generate::{Source, Value};

impl Writer<'_> {
    pub(super) fn talk(&mut self, which: usize, value: &Value, choices: &mut Source<'_>) {
        let gap = self.gap;
        let (text, given) = (self.value(value, 0), self.name(GIVEN + which % 4));
        let lines = match which {
            0 => vec!["#3006=1(MEASURE THE PART)".into()],
            1 | 2 => {
                let end = self.labels(1);
                vec![
                    format!("IF{gap}[{given} LT {}]{gap}GOTO{gap}{end}", 5 + which),
                    format!("#3000={}(TOO LARGE)", 10 + which),
                    format!("N{end}"),
                ]
            }
            3 => vec!["POPEN".into(), format!("DPRNT[X{}[43]*Y#1[33]**END]", self.name(2)), "PCLOS".into()],
            4 => vec![format!("#105={text}"), "POPEN".into(), "DPRNT[PART*#105[52]]".into(), "PCLOS".into()],
            5 => vec!["#3001=0".into(), "G4 P500".into(), format!("#106={text}"), "#3001=0".into()],
            6 => {
                let end = self.labels(2);
                vec![
                    "#3001=0".into(),
                    format!("N{end} IF{gap}[#3001 GT 5]{gap}GOTO{gap}{}", end + 10),
                    format!("GOTO{gap}{end}"),
                    format!("N{}", end + 10),
                ]
            }
            7 => vec!["M0 (TURN THE PART)".into(), format!("G0 X[{text}]")],
            8 => vec!["/M1".into(), format!("/2 G0 X[{text}]")],
            9 => vec![format!("/#106={text}"), "G0 Y#106".into()],
            10 => {
                let end = self.labels(1);
                vec![format!("/GOTO{gap}{end}"), format!("G1 X[{text}]"), format!("N{end}")]
            }
            11 => vec![choices.pick(&["G4 P500", "G4 P1500", "G4 P20"]).into()],
            12 if self.haas => vec![choices.pick(&["G4 P1.5", "G4 P2.", "G4 P0.25"]).into()],
            12 => vec![choices.pick(&["G4 X1.5", "G4 X2.", "G04 X0.25"]).into()],
            13 => vec![format!("G4 P[ABS[ROUND[{text}]]*100]")],
            14 if self.haas => vec![format!("G4 P[ABS[{text}]]")],
            14 => vec![format!("G4 X[ABS[{text}]]")],
            15 => vec!["#3003=1".into(), format!("G0 X[{text}]"), "#3003=0".into()],
            16 => {
                let end = self.labels(1);
                vec![
                    format!("IF{gap}[#1003 EQ 1]{gap}GOTO{gap}{end}"),
                    format!("G0 X[{text}]"),
                    format!("N{end}"),
                ]
            }
            17 => vec!["#1105=1".into(), format!("G1 Y[{text}]"), "#1105=0".into()],
            18 => vec!["#3901=#3901+1".into()],
            _ if self.haas => {
                let end = self.labels(1);
                vec![format!("M96 P{end} Q8"), format!("G0 X[{text}]"), format!("N{end}")]
            }
            _ => vec!["M0".into(), "(LOOK AT THE EDGE)".into()],
        };
        lines.iter().for_each(|line| self.line(line));
    }
}
