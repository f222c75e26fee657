//! Words by variables, numbers in all forms, spacing, tables written by words.

use super::Writer;
use crate::generate::draw::GIVEN;
use crate::generate::{Source, Value};

impl Writer<'_> {
    pub(super) fn spelled(&mut self, which: usize, value: &Value, choices: &mut Source<'_>) {
        let gap = self.gap;
        let (text, given) = (self.value(value, 0), self.name(GIVEN + which % 4));
        let lines = match which {
            // Codes by a variable.
            0 => vec!["#118=1".into(), format!("G#118 X[{text}]")],
            1 => vec![
                "#118=0".into(),
                format!("IF{gap}[{given} GT 3]{gap}THEN #118=1"),
                format!("G#118 X[{text}]"),
            ],
            2 => vec!["#118=8".into(), "M#118".into(), "M[#118+1]".into()],
            3 => vec![format!("S[ABS[{text}]*100+500] M3")],
            4 => vec!["#118=4".into(), "T#118 M6".into(), "G43 H#118 Z20.".into()],
            5 => vec!["#118=2".into(), format!("G[53+#118] G0 X[{text}]"), "G54".into()],
            // Numbers.
            6 => vec!["G1 X10 Y-5".into()],
            7 => vec!["G1 X.5 Y-.25 Z+3.".into(), "X1.000 Y02.5".into()],
            8 => vec![format!("G01X[{text}]Y3.F150.")],
            9 => vec!["g0 x3. y4.".into(), "G1 X5".into()],
            10 => vec!["G 1 X 5. Y -2.5".into()],
            11 => vec!["N7000 G00 X0.500 Z5. (OVER THE PART)".into(), String::new(), "(NEXT)".into()],
            // Variables by number.
            12 => {
                vec!["#118=130".into(), format!("#[#118]={text}"), "#105=#130+1".into(), "G0 X#[#118]".into()]
            }
            13 => vec!["#118=3".into(), format!("#[#118+128]={text}"), "G1 Y#131".into()],
            // Tables.
            14 => vec![format!("G10 L2 P0 X[{text}]"), "G0 X2.".into(), "G10 L2 P0 X0.".into()],
            15 => vec![format!("G10 L20 P2 Y[{text}]")],
            16 => vec!["G91".into(), "G10 L11 P3 R0.05".into(), "G90".into()],
            17 => vec!["#118=5".into(), format!("G10 L12 P#118 R[ABS[{text}]]")],
            18 => vec!["G91 G10 L2 P1 X0.5".into(), "G90 G54 G0 X1.".into()],
            // Tools, spindle, coolant.
            19 => vec!["T3".into(), "M6".into(), "S[500+100] M4".into(), "M19".into()],
            20 => vec!["M3 S700".into(), "M7".into(), "M9".into(), "M5".into()],
            21 => vec![choices.pick(&["M6 T2", "T5 M6", "M06 T0004"]).into(), "G43 H2 Z50.".into()],
            22 => vec!["G20".into(), format!("G0 X[{text}]"), "G21".into(), "G0 X10. Y5.".into()],
            _ => vec![format!("G9 G1 X[{text}] F[60*2]"), "G94".into(), "G98".into()],
        };
        lines.iter().for_each(|line| self.line(line));
    }
}
