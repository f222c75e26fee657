//! Words by R variables, numbers in all forms, spacing, tables written by words.

use super::Writer;
use super::spelling::{name, text};
use crate::generate::Value;
use crate::generate::draw::GIVEN;

impl Writer {
    pub(super) fn spelled(&mut self, which: usize, value: &Value) {
        let word = self.word(value);
        let given = name(GIVEN + which % 4);
        let short = if text(value, 0).len() < 40 { text(value, 0) } else { "V1".into() };
        let lines = match which {
            0 => vec!["R4+5. R3-2.".into(), "X+R4 Y-R3".into()],
            1 => vec!["R4+R5".into(), "R3-R4".into(), "G0 X+R3 Y+R4".into()],
            2 => vec!["R4+900.".into(), "S+R4 M3".into()],
            3 => vec!["R4+150.".into(), format!("G1 X{word} F+R4")],
            4 => vec!["R4+3.".into(), "T+R4 M6".into(), "H+R4 Z20.".into()],
            5 => vec!["R4+2.".into(), "E+R4 X0 Y0".into(), "E1 X1.".into()],
            6 => vec!["G1 X10 Y-5".into(), "X.5 Y-.25 Z+3.".into()],
            7 => vec![format!("G01X{word}Y3.F150.")],
            8 => vec!["g0 x3. y4.".into(), "G1 X5".into()],
            9 => vec!["G 1 X 5. Y -2.5".into(), "* BELOW THE PART".into()],
            10 => vec!["N7000 G00 X0.500 Z5. (OVER THE PART".into(), "X1. * NEXT".into()],
            11 => vec!["#V5 = 70".into(), format!("#V(V5)={short}"), "#V6=V(70)+1".into()],
            12 => vec!["#V5=3".into(), format!("#V(V5+68)={short}"), "#R3=V(71)".into(), "Y+R3".into()],
            13 => vec!["G10 L102 P5.".into(), "Z+R2".into()],
            14 => vec![format!("G10 L2 P3 X{word}"), "E3 X1.".into()],
            15 => vec!["G10 L10 P7 R0+5.5".into(), "H7 Z30.".into()],
            16 => vec!["G10 L12 P7 R0+0.25".into()],
            17 => vec!["#SET RADIANS".into(), format!("#V5=SIN({short})"), "#SET DEGREES".into()],
            18 => vec![format!("#SET RND3 'PLACES"), format!("#V5=RND({short})")],
            19 => vec!["T3".into(), "M6".into(), "S600 M4".into(), "M8 M3".into()],
            20 => vec!["M3 S700".into(), "M7".into(), "M5 M9".into()],
            21 => vec![format!("#IF {given} GT 3 THEN V5={short}"), "#CLEAR V5".into(), "#V6=V5+1".into()],
            22 => vec!["N7010 #V5=(1+2)*3".into(), "N7020 G0 X2.".into()],
            _ => vec!["#IF NOT(V1=2) THEN V6=1".into(), format!("G0 X{word} Z1.")],
        };
        lines.iter().for_each(|line| self.line(line));
    }
}
