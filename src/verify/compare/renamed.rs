//! Texts that name a variable: on the target they name the register that holds it.

use crate::control::trace::EventKind;
use crate::dialect::Control;
use crate::text::variable_names;
use crate::verify::sides::SymbolMap;

/// What the variables of the source are called on the target.
pub(super) struct Renaming<'n> {
    pub names: &'n SymbolMap,
    pub source: &'n Control,
    pub target: &'n Control,
}

impl Renaming<'_> {
    /// What the source shows, with those names of the target that the target shows too; none if it names no variable.
    pub fn event(&self, source: &EventKind, target: &EventKind) -> Option<EventKind> {
        let other = match target {
            EventKind::Message { text } | EventKind::Output { text } => text,
            EventKind::Alarm(stop) => &stop.text,
            _ => return None,
        };
        Some(match source {
            EventKind::Message { text } => EventKind::Message { text: self.text(text, other)? },
            EventKind::Output { text } => EventKind::Output { text: self.text(text, other)? },
            EventKind::Alarm(stop) => {
                let mut stop = stop.clone();
                stop.text = self.text(&stop.text, other)?;
                EventKind::Alarm(stop)
            }
            _ => return None,
        })
    }

    /// Only what the target's text has in its place among the names is taken over: another register is a difference.
    fn text(&self, text: &str, other: &str) -> Option<String> {
        let (ours, theirs) = (self.source.prefixes(), self.target.prefixes());
        let found = variable_names(text, &ours);
        // Formatted output has no sign for a variable: it spells `NO.`.
        let spelled = variable_names(other, &["NO."]).into_iter();
        let spelled = spelled.filter_map(|name| Some(format!("{}{}", theirs.first()?, name.number)));
        let there: Vec<String> = variable_names(other, &theirs)
            .into_iter()
            .map(|name| format!("{}{}", name.prefix, name.number))
            .chain(spelled)
            .collect();
        let mut out = text.to_owned();
        for name in found.into_iter().rev() {
            let own = format!("{}{}", name.prefix, name.number);
            let local = self.source.classes().iter().any(|row| {
                row.class == "local"
                    && row.name == name.prefix
                    && (row.first..=row.last).contains(&name.number)
            });
            let register =
                self.names.variable(&own, self.source, self.target).filter(|to| there.contains(to));
            // Locals share the registers for values in between; which of them has which the map does not say.
            let shared = || there.iter().find(|to| self.is_scratch(to)).cloned().filter(|_| local);
            if let Some(register) = register.or_else(shared) {
                out.replace_range(name.at, &register);
            }
        }
        (out != text).then_some(out)
    }

    fn is_scratch(&self, register: &str) -> bool {
        let digits = register.trim_start_matches(|sign: char| !sign.is_ascii_digit());
        self.names.of_words.contains(register)
            || digits.parse().is_ok_and(|number: u32| self.names.scratch.contains(&number))
    }
}
