//! What only this dialect has.

use super::{Writer, name};
use crate::generate::Value;

impl Writer {
    pub(super) fn own(&mut self, which: usize, value: &Value) {
        match which {
            0..3 => self.line(&format!("INC {}", name(which))),
            3..6 => self.line(&format!("DEC {}", name(which - 3))),
            6 => {
                self.line("G20 X0 Y0");
                let a = self.variable(value);
                self.line("V77=10");
                self.line("G91");
                self.line(&format!("A={a} D=V77"));
                self.line("G90");
            }
            7 => {
                self.line("M0");
                self.line("(LOOK AT THE PART)");
            }
            8 => self.line("V30=V30+1 V31=V30*2"),
            9 => {
                let past = self.labels(1);
                self.line(&format!("V30=V30-1 BLT P{past}"));
                self.line("V31=V30");
                self.place(past);
            }
            10 => {
                let f = self.variable(&Value::Number(700.0));
                self.line(&format!("F={f}"));
            }
            11 => {
                // The time of moves that were rounded is no number to compare.
                self.line("TIM V36");
                self.line("V36=0");
            }
            12 => self.line("G62"),
            13 => self.line("V31=F"),
            14 => self.line("COR=T3 V30=R V31=L"),
            _ => self.line("(A COMMENT)"),
        }
    }
}
