//! JSON that may be shown on a terminal: what would act there is written as its escape, which means the same.

use super::shown::acts;
use foldhash::HashMap;
use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter};
use serde_json::value::RawValue;
use std::io::{self, Write};
use std::rc::Rc;

/// Texts as JSON: one that comes again, as those of findings do, is not escaped again.
#[derive(Default)]
pub struct Texts<'t>(HashMap<&'t str, Rc<RawValue>>);

/// More texts than this are not kept.
const MOST_KEPT: usize = 2048;

impl<'t> Texts<'t> {
    /// A text as it is written.
    ///
    /// # Errors
    /// None that a text can have.
    pub fn escaped(&mut self, text: &'t str) -> serde_json::Result<Rc<RawValue>> {
        if let Some(known) = self.0.get(text) {
            return Ok(Rc::clone(known));
        }
        let made: Rc<RawValue> = RawValue::from_string(json(&text))?.into();
        if self.0.len() >= MOST_KEPT {
            self.0.clear();
        }
        self.0.insert(text, Rc::clone(&made));
        Ok(made)
    }
}

/// A value on one line. Empty if it has what JSON cannot say.
pub fn json(value: &impl Serialize) -> String {
    let mut out = Vec::new();
    text(write(value, &mut out, CompactFormatter), out)
}

/// A value on many lines. Empty if it has what JSON cannot say.
pub fn json_pretty(value: &impl Serialize) -> String {
    let mut out = Vec::new();
    text(write_json_pretty(value, &mut out), out)
}

/// Writes a value on one line.
///
/// # Errors
/// Those of `out`.
pub fn write_json(value: &impl Serialize, out: impl Write) -> io::Result<()> {
    write(value, out, CompactFormatter)
}

/// Writes a value on many lines.
///
/// # Errors
/// Those of `out`.
pub fn write_json_pretty(value: &impl Serialize, out: impl Write) -> io::Result<()> {
    write(value, out, PrettyFormatter::new())
}

fn write<F: Formatter>(value: &impl Serialize, out: impl Write, layout: F) -> io::Result<()> {
    Ok(value.serialize(&mut Serializer::with_formatter(out, Shown(layout)))?)
}

fn text(written: io::Result<()>, bytes: Vec<u8>) -> String {
    written.ok().and_then(|()| String::from_utf8(bytes).ok()).unwrap_or_default()
}

/// A layout, with what acts escaped.
struct Shown<F>(F);

/// Leaves a method to the layout.
macro_rules! as_laid_out {
    ($($method:ident($($argument:ident: $kind:ty),*))*) => {$(
        fn $method<W: ?Sized + Write>(&mut self, out: &mut W $(, $argument: $kind)*) -> io::Result<()> {
            self.0.$method(out $(, $argument)*)
        }
    )*};
}

impl<F: Formatter> Formatter for Shown<F> {
    as_laid_out! {
        begin_array()
        end_array()
        begin_array_value(first: bool)
        end_array_value()
        begin_object()
        end_object()
        begin_object_key(first: bool)
        end_object_key()
        begin_object_value()
        end_object_value()
    }

    fn write_string_fragment<W: ?Sized + Write>(&mut self, out: &mut W, fragment: &str) -> io::Result<()> {
        // Nearly all text is plain, and the bytes of plain text are told faster than its characters.
        if fragment.bytes().fold(true, |plain, byte| plain & matches!(byte, b' '..=b'~')) {
            return out.write_all(fragment.as_bytes());
        }
        let mut rest = fragment;
        while let Some((at, c)) = rest.char_indices().find(|(_, c)| acts(*c)) {
            out.write_all(&rest.as_bytes()[..at])?;
            write!(out, "\\u{:04x}", u32::from(c))?;
            rest = &rest[at + c.len_utf8()..];
        }
        out.write_all(rest.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_comes_again_is_written_alike() {
        let texts: Vec<String> = (0..3 * MOST_KEPT).map(|at| format!("\"\u{9b}\" {}", at % 3000)).collect();
        let mut known = Texts::default();
        for text in &texts {
            assert_eq!(known.escaped(text).unwrap().get(), json(text));
        }
    }

    #[test]
    fn what_acts_is_escaped_and_means_the_same() {
        let text = "a\x1b[31m\u{9b}2J\u{202e}\n\x7f\u{feff}Ø";
        let out = json(&[text]);
        assert_eq!(out, r#"["a\u001b[31m\u009b2J\u202e\n\u007f\ufeffØ"]"#);
        assert_eq!(serde_json::from_str::<Vec<String>>(&out).unwrap(), [text]);
        assert_eq!(json_pretty(&[1]), "[\n  1\n]");
    }
}
