//! Formatted output.

use super::code::Part;
use super::run::Runner;
use crate::control::session::Halt;
use crate::control::trace::EventKind;
use crate::dialect::Question;
use std::fmt::Write;

impl Runner<'_> {
    /// A line of output: text, and values with their places before and after the point.
    ///
    /// Leading places are blank, the fraction is rounded and its zeros are printed; a value too
    /// long for its places takes more.
    pub fn output(&mut self, binary: bool, parts: &[Part]) -> Result<(), Halt> {
        // Whether the text is lost then is not stated: it is printed, and the doubt is kept.
        if !self.port_open && self.rules.output_needs_port.ask(&mut self.session.trace) {
            self.session.trace.doubt(Question::OutputNeedsPort.fact());
        }
        if binary {
            self.session.trace.doubt("statement:output.binary");
        }
        let mut text = String::new();
        for part in parts {
            match part {
                Part::Text(piece) => text.push_str(piece),
                Part::Value { value, whole, fraction } => {
                    let value = self.eval(value)?.unwrap_or(0.0);
                    let (value, is_half) = half_away(value, *fraction);
                    if is_half {
                        self.session.trace.doubt("machine:output.half");
                    }
                    let places = (*fraction).min(20) as usize;
                    let width = (*whole).min(20) as usize + if places > 0 { places + 1 } else { 0 };
                    // Writing to a string does not fail.
                    let _ = write!(text, "{value:>width$.places$}");
                }
            }
        }
        self.session.trace.push(EventKind::Output { text });
        Ok(())
    }
}

/// A number that is written with so many places, rounded to them, and true for a half: it goes away from 0, and not to the
/// even neighbour as formatting has it.
fn half_away(value: f64, places: u32) -> (f64, bool) {
    let scale = 10f64.powi(places.min(15) as i32);
    let scaled = value * scale;
    let rounded = scaled.round() / scale;
    if rounded.is_finite() { (rounded, scaled.fract().abs() == 0.5) } else { (value, false) }
}
