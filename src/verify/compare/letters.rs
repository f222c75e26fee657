//! Letters outside ASCII as an operator reads them, and those of which nobody knows whether the target shows them.

use crate::control::trace::EventKind;
use crate::dialect::{Control, Question};

/// Letters with an accent, after the one that is read where it is missing.
const ACCENTED: &[(char, &str)] = &[
    ('A', "ÀÁÂÃÄÅĄàáâãäåą"),
    ('C', "ÇĆČçćč"),
    ('E', "ÈÉÊËĘĚèéêëęě"),
    ('I', "ÌÍÎÏİìíîïı"),
    ('L', "Łł"),
    ('N', "ÑŃŇñńň"),
    ('O', "ÒÓÔÕÖØŐòóôõöøő"),
    ('R', "Řř"),
    ('S', "ŚŠŞśšş"),
    ('U', "ÙÚÛÜŮŰùúûüůűµμ"),
    ('X', "×"),
    ('Y', "ÝŸýÿ"),
    ('Z', "ŹŻŽźżž"),
    ('2', "²"),
    ('3', "³"),
    ('-', "–—‐‑−"),
];

/// Signs that are read as several.
const SPELLED: &[(char, &str)] = &[
    ('%', "PCT"),
    ('Æ', "AE"),
    ('æ', "AE"),
    ('Œ', "OE"),
    ('œ', "OE"),
    ('ß', "SS"),
    ('°', " DEG"),
    ('º', " DEG"),
    ('±', "+/-"),
    ('⌀', "DIA "),
    ('€', "EUR"),
    ('½', "1/2"),
    ('¼', "1/4"),
    ('¾', "3/4"),
];

/// How letters with two dots are written without them.
#[derive(Clone, Copy, PartialEq)]
pub enum Form {
    /// With an E after them; and the sign of a diameter is a word.
    Long,
    /// As the letter alone.
    Short,
}

/// A text without letters outside ASCII; those that nothing looks like are left out.
pub fn plain(text: &str, form: Form) -> String {
    let mut out = String::with_capacity(text.len());
    let mut all = text.chars().peekable();
    while let Some(c) = all.next() {
        let diameter = matches!(c, 'Ø' | 'ø') && !all.peek().is_some_and(|next| next.is_alphabetic());
        if diameter && form == Form::Long {
            out.push_str("DIA ");
        } else if let Some((_, spelled)) = SPELLED.iter().find(|(sign, _)| *sign == c) {
            out.push_str(spelled);
        } else if let Some((letter, _)) = ACCENTED.iter().find(|(_, signs)| signs.contains(c)) {
            out.push(*letter);
            out.extend((form == Form::Long && "ÄÖÜäöü".contains(c)).then_some('E'));
        } else if c.is_ascii() {
            out.push(c);
        } else if c.is_whitespace() {
            out.push(' ');
        }
    }
    out
}

/// What a person must accept of a text: letters of the source for which nothing stands on the target, or letters that the
/// target is not known to show.
pub fn doubt(source: &EventKind, target: &EventKind, control: &Control) -> Option<String> {
    let (source, target) = (text(source)?, text(target)?);
    let lost = |c: char| {
        !c.is_ascii() && c.is_alphanumeric() && plain(c.encode_utf8(&mut [0; 4]), Form::Short).is_empty()
    };
    if let Some(c) = source.chars().find(|c| lost(*c)) {
        return Some(format!("the letter '{c}' of a text has no substitute"));
    }
    let capitals = control.behaviour(Question::TextLetters).is_some_and(|row| row.value == "upper");
    let unshown = |c: &char| !c.is_ascii() || (capitals && c.is_ascii_lowercase());
    let c = target.chars().find(unshown)?;
    Some(format!("the target is not known to show the letter '{c}' of a text"))
}

fn text(what: &EventKind) -> Option<&str> {
    match what {
        EventKind::Message { text } | EventKind::Output { text } => Some(text),
        EventKind::Alarm(stop) => stop.program_number.map(|_| stop.text.as_str()),
        EventKind::Stop => Some(""),
        _ => None,
    }
}
