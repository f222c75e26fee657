//! What the operator sees and is asked, clocks, inputs.

use super::Writer;
use super::spelling::{name, text};
use crate::generate::draw::GIVEN;
use crate::generate::{Source, Value};

impl Writer {
    pub(super) fn talk(&mut self, which: usize, value: &Value, choices: &mut Source<'_>) {
        let word = match which {
            // Assigns a variable before the lines.
            0..10 => self.word(value),
            _ => String::new(),
        };
        let given = name(GIVEN + which % 4);
        let short = if text(value, 0).len() < 40 { text(value, 0) } else { "V1".into() };
        let lines = match which {
            0 => vec!["M0".into(), format!("G0 X{word}")],
            1 => vec![format!("/X{word}"), "/M1".into()],
            2 => vec![format!("/G0 Y{word}")],
            3 => {
                self.assign("R4", &Value::Number(250.0));
                vec!["G4 P+R4".into(), format!("G0 X{word}")]
            }
            4 => {
                let past = self.labels(1);
                self.line(&format!("#IF I(3)=0 THEN {}", Self::to(past)));
                self.line(&format!("G0 X{word}"));
                return self.place(past);
            }
            5 => vec!["#O(1)=0".into(), format!("G1 X{word}"), "#O(1)=1".into()],
            6 => vec!["#WAIT".into(), "#V6=TN".into(), "#V5=V6*2".into()],
            7 => vec!["#D7=0.5".into(), "#V6=D7+1".into(), format!("G1 X{word}")],
            8 => vec!["#INPUT V5".into(), "#R4=V5".into(), "G1 X+R4".into()],
            9 => vec!["#PRINT \"DEPTH\"".into(), "#INPUT V6".into(), "#R3=ABS(V6)".into(), "Z-R3".into()],
            10 | 11 => {
                // Asked until it is sensible: what the scenario answers gets there.
                let label = self.labels(1);
                self.place(label);
                let line = format!("#IF V5<=0 THEN {}", Self::to(label));
                self.line("#INPUT V5");
                return self.line(&line);
            }
            12 => vec![format!("#PRINT \"A\",V1,\"B\",{given}")],
            13 => vec![format!("#PRINT {},", name(1)), "#PRINT \"END\"".into()],
            14 => vec!["#SPRINT \"X\",V1,\" Y\",R6".into()],
            15 => vec!["#PRINT \"FIRST LINE\"".into(), format!("#V6={short}"), "#PRINT V6".into()],
            16 => vec!["#SINPUT V6".into(), "#V5=V6+1".into()],
            17 => vec![choices.pick(&["G4 P500", "G4 P1500", "G04 P20"]).into()],
            18 => vec!["#INPUT V5".into(), "#INPUT V6".into()],
            _ => {
                let past = self.labels(1);
                self.line(&format!("#IF {given}<7 THEN {}", Self::to(past)));
                self.line("#PRINT \"TOO LARGE\"");
                self.line("M0");
                return self.place(past);
            }
        };
        lines.iter().for_each(|line| self.line(line));
    }
}
