//! What the operator sees, words by variables, tables.

use super::{Writer, name};
use crate::generate::Value;
use crate::generate::draw::GIVEN;

impl Writer {
    pub(super) fn talk(&mut self, which: usize, value: &Value) {
        let given = name(GIVEN + which % 4);
        let lines = match which {
            0..3 => vec!["M0", "(TURN THE PART)"],
            3..8 => {
                let past = self.labels(1);
                self.line(&format!("V79={given}-{which} BLE P{past}"));
                self.line("M0");
                self.line("(TOO LARGE)");
                return self.place(past);
            }
            8 | 9 => vec!["(ABOVE THE PART)"],
            10 => vec!["TIM V36", "V36=0"],
            11..14 => {
                let past = self.labels(1);
                self.line(["TST G17", "TST QM", "TST QX"][which - 11]);
                self.line(&format!("BNE P{past}"));
                let w = self.variable(value);
                self.line("G0");
                self.line(&format!("X={w}"));
                return self.place(past);
            }
            14 => vec!["V31=T", "V30=V31+1"],
            15 => vec!["V31=S", "V31=0"],
            _ => vec!["M0"],
        };
        lines.iter().for_each(|line| self.line(line));
    }

    pub(super) fn spelled(&mut self, which: usize, value: &Value) {
        let w = self.variable(value);
        let lines = match which {
            0 | 1 => vec!["V77=1".into(), "G=V77".into(), format!("X={w}")],
            2 => {
                let past = self.labels(1);
                self.line("V77=0");
                self.line(&format!("V79={}-3 BLE P{past}", name(GIVEN + 1)));
                self.line("V77=1");
                self.place(past);
                vec!["G=V77".into(), format!("X={w}")]
            }
            3 => vec!["V77=900".into(), "S=V77".into()],
            4 => vec!["V77=250".into(), "F=V77".into(), "G1".into(), format!("X={w}")],
            5 => vec!["V77=3".into(), "T=V77".into()],
            6 => vec!["V77=8".into(), "M=V77".into(), "M9".into()],
            7 => vec!["G1 X10 Y-5".into(), "X0.5 Y-.25".into()],
            8 => vec!["G01 X5 Y3".into(), "X2.000".into()],
            9 => vec!["V30 = V31 + 2".into(), "V30=V30 * -1".into()],
            10 => vec!["V30=V31/2 V32=V31*2".into()],
            11 => {
                let past = self.labels(1);
                self.line("V79=2");
                self.line(&format!("TST {}", name(GIVEN)));
                self.line(&format!("BEQ P{past}"));
                self.line("V30=V79*2");
                return self.place(past);
            }
            12 => {
                let (past, other) = (self.labels(2), self.label - 1);
                self.line(&format!("V78={other}"));
                self.line(&format!("TST {}", name(GIVEN + 2)));
                self.line("BGT V78");
                self.line("V30=V30+1");
                self.place(past);
                return self.place(other);
            }
            13 => vec!["V77=5".into(), format!("COR=T4 R=V77 L={w}"), "COR=T4 V31=R".into()],
            14 => vec![format!("TRF=G55 X={w} Y={w}"), "TRF=G55 V30=X".into(), "V30=0".into()],
            15 => vec!["T01 M8".into(), "S800".into(), "T02".into(), "G0 Z10 T00".into()],
            16 => vec![format!("INC {}", name(0)), format!("DEC {}", name(1))],
            17 => vec!["G92 X0 Y0".into(), "TRF=G92 V30=X".into(), "V30=0".into(), "G54".into()],
            _ => vec!["G0".into(), format!("X={w}")],
        };
        lines.iter().for_each(|line| self.line(line));
    }
}
