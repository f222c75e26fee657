//! Moves that are more than a line, and modes that hold moves.

use super::Writer;
use crate::generate::{Frame, Step, Value};

impl Writer<'_> {
    pub(super) fn figure(&mut self, which: usize, [a, b]: &[Value; 2]) {
        let r = |letter| self.size(letter, a);
        let w = |letter| self.word(letter, b, false);
        let lines = match which {
            // A quarter of a circle, by its centre and by its radius; the second way round, three quarters.
            0 => vec![format!("G91 G2 {} {} {} J0. Z-1.", r('X'), r('Y'), r('I')), "G90 G1".into()],
            1 => vec![format!("G91 G3 {} {} R-{}", r('X'), r('Y'), &r('R')[1..]), "G90 G1".into()],
            // Whole circles, one of them a thread.
            2 => vec![format!("G2 {}", r('I')), "G1 X1.".into()],
            3 => vec![format!("G3 {} J0. Z-2.5 F90.", r('I')), "G1".into()],
            // The other planes.
            4 => vec![
                "G18".into(),
                format!("G91 G2 {} {} {} K0.", r('X'), r('Z'), r('I')),
                "G90 G17 G1".into(),
            ],
            5 => vec![
                "G19".into(),
                format!("G91 G3 {} {} {} K0.", r('Y'), r('Z'), r('J')),
                "G90 G17 G1".into(),
            ],
            6 => vec![
                "G18".into(),
                format!("G91 G3 {} {} {}", r('X'), r('Z'), r('R')),
                "G17 G90".into(),
                "G1".into(),
            ],
            // Arcs to a place, one behind the other.
            7 => vec![
                format!("G0 {} Y0.", r('X')),
                format!("G3 X0. {} {}", r('Y'), r('R')),
                format!("X-{} Y0. I0. J-{}", &r('X')[1..], &r('J')[1..]),
                "G1".into(),
            ],
            8 => vec![
                format!("G0 {} Y0.", r('X')),
                format!("G2 X-{} {} Z-1.", &r('X')[1..], r('R')),
                format!("G1 {}", w('X')),
            ],
            9 => vec![format!("G1 {} Y5. F[ABS[{}]+50]", w('X'), self.value(a, 0))],
            10 => vec![format!("G0 {} A[ROUND[{}]]", w('X'), self.value(a, 0))],
            11 => vec!["G91 G28 X0. Y0.".into(), "G90".into(), format!("G0 {}", w('X'))],
            12 => vec![
                format!("G31 Z-{} F50.", &r('Z')[1..]),
                "#105=#5063".into(),
                format!("G0 Z[#105+ABS[{}]]", self.value(b, 0)),
            ],
            13 => vec!["G53 G0 X-100. Y-50.".into(), format!("G0 {}", w('Y'))],
            14 if !self.haas => {
                vec!["G16".into(), format!("G0 {} Y30.", r('X')), format!("{} Y60.", r('X')), "G15".into()]
            }
            _ => vec![format!("G1 {} ,R0.5 F100.", w('X')), format!("{}", r('Y')), "X3. Y3.".into()],
        };
        lines.iter().for_each(|line| self.line(line));
    }

    pub(super) fn within(&mut self, frame: Frame, [a, b]: &[Value; 2], body: &[Step]) {
        let w = |letter, value| self.word(letter, value, false);
        let (before, behind) = match frame {
            Frame::Rotated => (format!("G68 X0. Y0. {}", w('R', a)), "G69"),
            Frame::Mirrored if self.haas => ("G101 X0.".into(), "G100 X0."),
            Frame::Mirrored => (format!("G51.1 {}", w('X', a)), "G50.1 X0."),
            Frame::Scaled => (format!("G51 X0. Y0. Z0. P{}", if self.haas { "2." } else { "2000" }), "G50"),
            Frame::Left => (format!("G41 D3 G1 {} {} F100.", w('X', a), w('Y', b)), "G40 G1 X0. Y0."),
            Frame::Right => (format!("G42 D4 {} {}", w('X', a), w('Y', b)), "G40 X-20."),
            Frame::Long => (format!("G43 H5 Z[ABS[{}]+10]", self.value(a, 0)), "G49 Z100."),
            Frame::Shifted => (format!("G52 {} {}", w('X', a), w('Z', b)), "G52 X0. Y0. Z0."),
            Frame::Incremental => ("G91".into(), "G90"),
        };
        self.line(&before);
        self.steps(body);
        self.line(behind);
    }
}
