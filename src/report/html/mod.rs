//! A conversion as one HTML file that needs nothing beside it: to read, print and sign.
//!
//! The first page says what was converted and what a person must answer; then comes each program. `docs/report.md`
//! explains it, and the block of JSON in it.

mod aligned;
mod asked;
mod certificate;
mod data;
mod first;
mod pages;
mod program;
mod registers;
mod sides;

use super::{Date, Part};
use crate::diag::Code;
use crate::library::{Pairs, with_pairs};
use crate::text::acts;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fmt::Write;

const STYLE: &str = include_str!("report.css");
const SCRIPT: &str = include_str!("report.js");

/// Programs that are written at once; what is made of them is held in memory until the page takes it.
const AT_ONCE: usize = 16;

/// The conversions as HTML.
pub fn conversion(parts: &[Part<'_>], date: Date) -> String {
    let mut out = String::new();
    head(&mut out);
    let numbers = Numbers::of(parts);
    first::first(&mut out, parts, date, &numbers);
    asked::questions(&mut out, parts, &numbers);
    first::index(&mut out, parts, &numbers);
    out.push_str("<h2 id=\"programs\">Programs</h2>\n");
    if parts.iter().all(|part| part.programs().next().is_none()) {
        out.push_str("<p>There is no program.</p>\n");
    }
    for (at, part) in parts.iter().enumerate() {
        let (inputs, controls) = (part.inputs, (part.controls[0], part.controls[1]));
        let written =
            with_pairs(inputs, part.conversion, controls, |pairs| programs(part, at, &numbers, Some(pairs)));
        out.push_str(&written.unwrap_or_else(|| programs(part, at, &numbers, None)));
    }
    registers::registers(&mut out, parts);
    first::files(&mut out, parts);
    let codes: BTreeSet<Code> = parts
        .iter()
        .flat_map(Part::programs)
        .flat_map(|(_, program)| program.diagnostics.iter().map(|finding| finding.code))
        .collect();
    pages::pages(&mut out, &codes);
    let _ = writeln!(
        out,
        "<script type=\"application/json\" id=\"macroglot\">\n{}</script>",
        data::data(parts, date)
    );
    let _ = writeln!(out, "<script>{SCRIPT}</script>\n</body>\n</html>");
    out
}

/// The head of the page: nothing but its own style and script is ever loaded or run.
fn head(out: &mut String) {
    let _ = writeln!(
        out,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'sha256-{}'; \
         script-src 'sha256-{}'; base-uri 'none'; form-action 'none'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Conversion report</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>",
        data::base64_sha256(STYLE),
        data::base64_sha256(SCRIPT),
    );
}

/// The programs of a library.
fn programs(part: &Part<'_>, at: usize, numbers: &Numbers, pairs: Option<&Pairs<'_>>) -> String {
    let mut out = String::new();
    let all: Vec<usize> = part.programs().map(|(index, _)| index).collect();
    let lines = part.indexes();
    for some in all.chunks(AT_ONCE) {
        let made = some.par_iter().map(|index| {
            let number = numbers.number(at, *index);
            program::program(&program::Shown { part, index: *index, number, lines: &lines, pairs })
        });
        made.collect::<Vec<String>>().iter().for_each(|section| out.push_str(section));
    }
    out
}

/// The numbers of programs in the page.
struct Numbers(Vec<usize>);

impl Numbers {
    fn of(parts: &[Part<'_>]) -> Self {
        let mut next = 1;
        let first = |part: &Part<'_>| {
            let first = next;
            next += part.conversion.programs.len();
            first
        };
        Self(parts.iter().map(first).collect())
    }

    /// The number of a program of a library.
    fn number(&self, part: usize, program: usize) -> usize {
        self.0.get(part).map_or(0, |first| first + program)
    }
}

/// The name of a program in the page.
fn id(number: usize) -> String {
    format!("p{number}")
}

/// A link to something in the page. Both are HTML already.
fn link(id: &str, text: &str) -> String {
    format!("<a href=\"#{id}\">{text}</a>")
}

/// A link to the page of a code.
fn code(code: Code) -> String {
    link(code.number(), code.number())
}

/// `1 program`, `2 programs`.
fn plural(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// Text as HTML shows it, in elements and in quoted attributes.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for sign in text.chars() {
        match sign {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            sign if acts(sign) && sign != '\t' => out.extend(sign.escape_default()),
            sign => out.push(sign),
        }
    }
    out
}

/// Words of macroglot's own: what stands between two back ticks is code.
fn ticked(text: &str) -> String {
    let pieces: Vec<String> = text.split('`').map(escaped).collect();
    if pieces.len().is_multiple_of(2) {
        return pieces.join("`");
    }
    let piece =
        |(at, piece): (usize, String)| if at % 2 == 0 { piece } else { format!("<code>{piece}</code>") };
    pieces.into_iter().enumerate().map(piece).collect()
}

/// The same of a text of which no more than so many letters are shown.
fn cut(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => escaped(text),
        Some((at, _)) => {
            let rest = text[at..].chars().count();
            format!("{} <i>and {}</i>", escaped(&text[..at]), plural(rest, "more letter"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{cut, escaped, ticked};

    #[test]
    fn nothing_of_a_program_is_read_as_html() {
        assert_eq!(escaped("(<script>'x\"&\0)"), "(&lt;script&gt;&#39;x&quot;&amp;\\u{0})");
    }

    #[test]
    fn what_stands_in_ticks_is_code() {
        assert_eq!(ticked("put `<a>` and `b` in"), "put <code>&lt;a&gt;</code> and <code>b</code> in");
        assert_eq!(ticked("one ` alone"), "one ` alone");
    }

    #[test]
    fn a_long_text_is_cut_between_letters() {
        assert_eq!(cut("äöü", 3), "äöü");
        assert_eq!(cut("ä<öü", 2), "ä&lt; <i>and 2 more letters</i>");
    }
}
