//! PRINT, SPRINT and the lines that they make.

use super::Interpreter;
use crate::control::session::Flow;
use crate::control::trace::EventKind;
use crate::dialect::Question;
use crate::syntax::PrintPart;
use crate::text::decode;

/// The longest line that commas at the end of PRINT can build.
const LONGEST: usize = 10_000;

impl Interpreter<'_, '_> {
    /// Prints; with `stay` the next one goes on after it.
    pub(super) fn print(&mut self, parts: &[PrintPart], stay: bool) -> Flow<()> {
        // A text alone, shown when the moves are done: that is how a message with which the machine stops is written.
        let waited = std::mem::take(&mut self.waited);
        let asks = waited && !stay && self.line.is_empty() && matches!(parts, [PrintPart::Text(_)]);
        for part in parts {
            let is_value = matches!(part, PrintPart::Value(_));
            // How a value is set off from the one before it is not stated. Run together, two would read as one number.
            if is_value && self.line_ends_in_value {
                self.line.push(' ');
            }
            self.line_ends_in_value = is_value;
            match part {
                PrintPart::Text(span) => {
                    let source = self.session.source(self.at.section);
                    let text = source.get(span.start as usize..span.end as usize).unwrap_or_default();
                    self.line.push_str(&decode(text));
                }
                PrintPart::Value(expr) => {
                    let value = self.value(expr)?;
                    self.session.rest_on(Question::PrintFormat);
                    self.line.push_str(&digits(value));
                }
            }
        }
        if !stay || self.line.len() > LONGEST {
            self.put_out(asks);
        }
        Ok(())
    }

    /// Puts out what is left on the line.
    pub(super) fn flush(&mut self) {
        if !self.line.is_empty() {
            self.put_out(false);
        }
    }

    fn put_out(&mut self, asks: bool) {
        let text = std::mem::take(&mut self.line);
        self.line_ends_in_value = false;
        if asks && self.session.scenario.sets_named {
            self.printed = Some(text.clone());
        }
        self.session.trace.push(EventKind::Output { text });
    }
}

/// A number as the manual shows it printed: no zeros at its end (`25.45`, `36920`).
fn digits(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
