//! What only this dialect has.

use super::Writer;
use super::spelling::text;
use crate::generate::Value;

impl Writer {
    pub(super) fn own(&mut self, which: usize, value: &Value) {
        let word = |writer: &mut Self| writer.word(value);
        match which {
            0 => self.line("#PRINT \"AT\",V1"),
            1 => self.line("#INPUT V6"),
            2 => self.line("#CLEAR V5-V6"),
            3 => self.line("#SET RND2"),
            4 => self.line(&format!("#V5=SGN({})", text(value, 0))),
            5 => self.line("#WAIT"),
            6 => {
                let word = word(self);
                self.line(&format!("G91 G0 X{word} L2"));
                self.line("G90");
            }
            7 => self.line("#V6=V(60)+V(60+1)"),
            8 => self.line("G5 X1."),
            9 => self.line("G9"),
            10 => self.line("G8"),
            11 => {
                let word = word(self);
                self.line(&format!("/X{word}"));
            }
            12 => self.line("M49"),
            13 => self.line("#SPRINT \"X\",R5"),
            14 => self.line("R6+R5"),
            _ => self.line("(A COMMENT"),
        }
    }
}
