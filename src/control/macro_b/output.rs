//! Formatted output.

use super::code::Part;
use super::run::Runner;
use crate::control::session::Halt;
use crate::control::trace::EventKind;
use std::fmt::Write;

impl Runner<'_> {
    /// A line of output: text, and values with their places before and after the point.
    ///
    /// Leading places are blank, the fraction is rounded and its zeros are printed; a value too
    /// long for its places takes more.
    pub fn output(&mut self, binary: bool, parts: &[Part]) -> Result<(), Halt> {
        if !self.port_open {
            // Whether the text is lost then is not stated: it is printed, and the doubt is kept.
            self.rules.output_needs_port.ask(&mut self.session.trace);
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
