//! Moves that are more than a line, modes that hold moves, and modal calls.

use super::spelling::{name, text};
use super::{Writer, pointed};
use crate::generate::{Frame, Step, Value};

impl Writer {
    /// A value of at least 1 behind a letter, held by R4.
    fn size(&mut self, value: &Value) -> String {
        match value {
            Value::Number(number) => pointed(number.abs() + 1.0),
            value => {
                self.assign("R4", value);
                self.line("#R4=ABS(R4)+1");
                "+R4".into()
            }
        }
    }

    pub(super) fn figure(&mut self, which: usize, [a, b]: &[Value; 2]) {
        let r = self.size(a);
        let minus = if r.starts_with('+') { r.replacen('+', "-", 1) } else { format!("-{r}") };
        let signed = if r.starts_with('+') { r.clone() } else { format!("+{r}") };
        let w = self.word(b);
        let lines = match which {
            0 => vec![format!("G91 G2 X{r} Y{r} I{r} J0 Z-1."), "G90 G1".into()],
            1 => vec![format!("G91 G3 X{r} Y{r} R0{signed}"), "G90 G1".into()],
            2 => vec![format!("G2 I{r}"), "G1 X1.".into()],
            3 => vec![format!("G3 I{r} J0 Z-2.5 F90."), "G1".into()],
            4 => vec!["G18".into(), format!("G91 G2 X{r} Z{r} I{r} K0"), "G90 G17 G1".into()],
            5 => vec!["G19".into(), format!("G91 G3 Y{r} Z{r} J{r} K0"), "G90 G17 G1".into()],
            6 => vec![
                format!("G0 X{r} Y0"),
                format!("G3 X0 Y{r} R0{signed}"),
                format!("X{minus} Y0 I0 J{minus}"),
                "G1".into(),
            ],
            7 => vec![format!("G0 X{r} Y0"), format!("G2 X{minus} Y0 I{minus} Z-1."), format!("G1 X{w}")],
            // Behind an arc a block without a centre.
            8 => vec![format!("G2 I{r}"), format!("X{w} Y3.")],
            9 => vec![format!("G1 X{w} Y5. F120.")],
            10 => vec![format!("G0 X{w} A10.")],
            11 => vec!["G28 X0 Y0".into(), format!("G0 X{w}")],
            12 => vec![
                format!("G31 Z{minus} F50. P1"),
                "#V6=PZ1".into(),
                "#R4=ABS(V6)+1".into(),
                "G0 Z+R4".into(),
            ],
            13 => vec!["E0 X0 Y0".into(), format!("E1 X{w}")],
            14 => vec!["G91".into(), format!("X{w} Y1. L3"), "G90".into()],
            _ => vec!["G8".into(), format!("G1 X{w} F100."), "G9".into()],
        };
        lines.iter().for_each(|line| self.line(line));
    }

    pub(super) fn within(&mut self, frame: Frame, [a, b]: &[Value; 2], body: &[Step]) {
        let (before, behind) = match frame {
            Frame::Rotated => (format!("G68 X0 Y0 R{}", self.word(a)), "G69"),
            Frame::Mirrored => ("G51.1 X0".into(), "G50.1"),
            Frame::Scaled | Frame::Left => {
                let (x, y) = (self.word(a), self.word(b));
                (format!("G41 D3 G1 X{x} Y{y} F100."), "G40 G1 X0 Y0")
            }
            Frame::Right => {
                let x = self.word(a);
                (format!("D4 G42 X{x}"), "G40 X-20.")
            }
            Frame::Long => ("H5 Z20.".into(), "H0 Z100."),
            Frame::Shifted => (format!("G92 X{}", self.word(a)), "E2 X0"),
            Frame::Incremental => ("G91".into(), "G90"),
        };
        self.line(&before);
        self.steps(body);
        self.line(behind);
    }

    /// A modal call around moves; of a program, a call behind them.
    pub(super) fn modal(&mut self, sub: usize, values: &[(usize, Value)], body: &[Step]) {
        for (slot, value) in values {
            self.assign(&name(*slot), value);
        }
        if sub >= self.split {
            self.steps(body);
            return self.line(&format!("M98 P{}", 1001 + sub));
        }
        self.line(&format!("L{} G66", 100 * (sub + 1) + 1));
        self.steps(body);
        if let Some((_, value)) = values.first() {
            let line = format!("#V6={}", text(value, 0));
            if line.len() < super::LINE {
                self.line(&line);
            }
        }
        self.line("G67");
    }
}
