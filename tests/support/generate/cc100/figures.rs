//! Moves that are more than a line, and modes that hold moves.

use super::Writer;
use crate::generate::{Frame, Step, Unary, Value};

impl Writer {
    /// A variable that holds a value of at least 1.
    fn size(&mut self, value: &Value) -> String {
        let positive = Value::Unary(Unary::Abs, Box::new(value.clone()));
        let name = self.variable(&positive);
        let out = self.temporary();
        self.line(&format!("{out}={name}+1"));
        out
    }

    pub(super) fn figure(&mut self, which: usize, [a, b]: &[Value; 2]) {
        let r = self.size(a);
        let minus = self.temporary();
        self.line(&format!("{minus}={r}* -1"));
        let w = self.variable(b);
        let lines = match which {
            // A negative radius is the short arc.
            0 | 1 => vec!["G91".into(), "G2".into(), format!("X={r} Y={r} R={minus}"), "G90 G1".into()],
            2 => vec!["G91".into(), "G3".into(), format!("X={minus} Y={r} R={minus}"), "G90 G1".into()],
            3 => vec!["G0 X10 Y0".into(), "G3 X0 Y10 R-10".into(), "X-10 Y0 R-10".into(), "G1".into()],
            4 => vec!["G0 X0 Y0".into(), "G2 X10 Y10 R-10 Z-2".into(), "G1".into(), format!("X={w}")],
            5 => vec!["G0 X10 Y0".into(), "G3 X0 Y10 I-10 J0".into(), "G1 X1".into()],
            6 => vec!["G91".into(), "G2".into(), format!("X={r} Y={r} R={r}"), "G90 G1".into()],
            7 => vec!["G18".into(), "G0 X10 Z0".into(), "G2 X0 Z10 R-10".into(), "G17 G1".into()],
            8 => vec!["V77=300".into(), "F=V77".into(), "G1".into(), format!("X={w} Y={r}")],
            9 => vec!["G61".into(), "G1".into(), format!("Z={minus}"), "G62".into()],
            10 => vec!["G0".into(), format!("X={w} Y={r} Z={r}")],
            11 => vec!["G20 X5 Y5".into(), "V76=30".into(), "G0".into(), format!("A=V76 D={r}")],
            12 => vec!["G81 V1=5 V2=-10".into(), "G0".into(), format!("X={w}"), "G80".into()],
            13 => vec![
                format!("V30=X"),
                "V31=V30+1".into(),
                "G0".into(),
                "X=V31".into(),
                "V30=0".into(),
                "V31=0".into(),
            ],
            14 => vec!["G92 X0".into(), "G0".into(), format!("X={w}"), "G54".into()],
            _ => vec!["G0 X5.5 Y-2.25".into(), "G1 X7".into(), format!("Y={w}")],
        };
        lines.iter().for_each(|line| self.line(line));
    }

    pub(super) fn within(&mut self, frame: Frame, [a, _]: &[Value; 2], body: &[Step]) {
        let (before, behind) = match frame {
            Frame::Left | Frame::Rotated => ("G41 T03", "G40"),
            Frame::Right => ("G42", "G40"),
            Frame::Long => ("G0 Z30 T05", "T00"),
            Frame::Shifted | Frame::Mirrored => ("G55", "G54"),
            Frame::Scaled => ("G61", "G62"),
            Frame::Incremental => ("G91", "G90"),
        };
        self.line(before);
        let first = self.variable(a);
        self.line("G1");
        self.line(&format!("X={first}"));
        self.steps(body);
        self.line(behind);
        self.line("G0 X0 Y0");
    }
}
