//! Source and target side by side, with the findings at their lines.

use super::super::grade;
use super::aligned::{Page, Row, rows};
use super::program::Shown;
use super::{code, cut, escaped, plural, ticked};
use crate::diag::Diagnostic;
use crate::text::{Span, decode};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Rows that are shown of a program.
const ROWS: usize = 1500;

/// Rows from which on runs of lines that stayed as they were are folded.
const LONG: usize = 300;

/// Such lines that are shown beside others.
const ABOUT: usize = 3;

/// Findings that are shown of a line, and of a program.
const OF_A_LINE: usize = 8;
const OF_A_PROGRAM: usize = 300;

/// Letters of a line.
const LETTERS: usize = 600;

/// The findings of a program that no line of it shows, and the two texts.
pub fn sides(out: &mut String, shown: &Shown<'_, '_>) {
    let Shown { part, index, .. } = *shown;
    let program = &part.conversion.programs[index];
    let bytes: &[u8] = part.inputs.get(program.file).map_or(&[], |input| &input.bytes);
    let whole = 0..bytes.len();
    let extent = shown.pairs.and_then(|pairs| pairs.extent(index)).map(|s| s.start as usize..s.end as usize);
    let source = Page::new(bytes, extent.clone().unwrap_or(whole));
    let text = part.conversion.texts.get(program.file).and_then(Option::as_deref).unwrap_or_default();
    let target = Page::new(text.as_bytes(), program.range.clone());
    let mut by_line: BTreeMap<Option<usize>, Vec<&Diagnostic>> = BTreeMap::new();
    for finding in &program.diagnostics {
        let line = source.line(finding.span.start).filter(|_| finding.span != Span::default());
        by_line.entry(line).or_default().push(finding);
    }
    let mut writer = Writer { source, target, by_line, left: OF_A_PROGRAM, first: [0, 0], last: None };
    let start = extent.map_or(0, |extent| extent.start);
    writer.first[0] = shown.lines[program.file].place(start as u32).0 as usize;
    let before = text.as_bytes().get(..program.range.start).unwrap_or_default();
    writer.first[1] = 1 + memchr::memchr_iter(b'\n', before).count();
    writer.write(out, &rows(&writer.source, &writer.target, &program.map));
}

struct Writer<'w> {
    source: Page<'w>,
    target: Page<'w>,
    by_line: BTreeMap<Option<usize>, Vec<&'w Diagnostic>>,
    /// Findings that there is room for.
    left: usize,
    /// The number of the first line of each side.
    first: [usize; 2],
    /// The last line of the source that was written.
    last: Option<usize>,
}

impl Writer<'_> {
    fn write(&mut self, out: &mut String, rows: &[Row]) {
        if let Some(whole) = self.by_line.remove(&None) {
            out.push_str("<h4>Of the program as a whole</h4>\n<table class=\"lines\">\n");
            self.findings(out, &whole, None);
            out.push_str("</table>\n");
        }
        out.push_str(
            "<h4>Source and target</h4>\n<p class=\"small\">~ changed, ≈ other blanks alone, + added, − dropped, of 5: comes from line 5, \
             in 5: went into line 5</p>\n<table class=\"lines\">\n<colgroup><col class=\"n\"><col><col class=\"m\"><col \
             class=\"n\"><col></colgroup>\n<thead><tr><th><th>Source<th><th><th>Target</thead>\n",
        );
        let plain: Vec<bool> = rows.iter().map(|row| self.is_plain(*row)).collect();
        let (mut at, mut shown) = (0, 0);
        while at < rows.len() && shown < ROWS {
            let run = plain[at..].iter().take_while(|plain| **plain).count();
            // The rows about others stay.
            let before = if at == 0 { 0 } else { ABOUT };
            let after = if at + run == rows.len() { 0 } else { ABOUT };
            if rows.len() > LONG && run > before + after + 2 {
                rows[at..at + before].iter().for_each(|row| self.row(out, *row));
                let folded = run - before - after;
                let _ = writeln!(out, "<tr class=f><td><td colspan=4>{} as before", plural(folded, "line"));
                rows[at + run - after..at + run].iter().for_each(|row| self.row(out, *row));
                (at, shown) = (at + run, shown + before + after + 1);
                continue;
            }
            for row in &rows[at..at + run.max(1)] {
                self.row(out, *row);
            }
            (at, shown) = (at + run.max(1), shown + run.max(1));
        }
        let rest = rows.len() - at;
        if rest > 0 {
            let _ = writeln!(
                out,
                "<tr class=f><td><td colspan=4>and {}, which the files have; the findings in them:",
                plural(rest, "more line")
            );
        }
        let beyond: Vec<(Option<usize>, Vec<&Diagnostic>)> =
            std::mem::take(&mut self.by_line).into_iter().collect();
        for (line, findings) in beyond {
            self.findings(out, &findings, line);
        }
        out.push_str("</table>\n");
    }

    /// True for a row that says nothing new: the same on both sides, or of a source without any target.
    fn is_plain(&self, row: Row) -> bool {
        let is_quiet = |line: usize| !self.by_line.contains_key(&Some(line));
        match row {
            Row::Both(s, t) => is_quiet(s) && self.is_same(s, t),
            Row::Source(s, _) => {
                is_quiet(s) && (self.target.len() == 0 || self.source.text(s).trim_ascii().is_empty())
            }
            Row::Target(..) => false,
        }
    }

    fn is_same(&self, s: usize, t: usize) -> bool {
        self.source.text(s).trim_ascii() == self.target.text(t).trim_ascii()
    }

    /// True where only blanks differ, and the sign that ends a block.
    fn is_spaced(&self, s: usize, t: usize) -> bool {
        let signs = |text: &[u8]| {
            let text = text.trim_ascii();
            let text = text.strip_suffix(b";").unwrap_or(text);
            text.iter().copied().filter(|sign| !sign.is_ascii_whitespace()).collect::<Vec<u8>>()
        };
        signs(self.source.text(s)) == signs(self.target.text(t))
    }

    fn row(&mut self, out: &mut String, row: Row) {
        let (s, t, class, sign) = match row {
            Row::Both(s, t) if self.is_same(s, t) => (Some(s), Some(t), "", String::new()),
            Row::Both(s, t) if self.is_spaced(s, t) => (Some(s), Some(t), "", "≈".into()),
            Row::Both(s, t) => (Some(s), Some(t), " class=c", "~".into()),
            Row::Source(s, Some(to)) => {
                (Some(s), None, " class=c", format!("<small>in {}</small>", self.first[1] + to))
            }
            Row::Source(s, None) if self.target.len() == 0 || self.source.text(s).trim_ascii().is_empty() => {
                (Some(s), None, "", String::new())
            }
            Row::Source(s, None) => (Some(s), None, " class=d", "−".into()),
            Row::Target(t, Some(from)) if self.last == Some(from) => (None, Some(t), " class=a", "+".into()),
            Row::Target(t, Some(from)) => {
                (None, Some(t), " class=a", format!("<small>of {}</small>", self.first[0] + from))
            }
            Row::Target(t, None) => (None, Some(t), " class=a", "+".into()),
        };
        self.last = s.or(self.last);
        let line = |page: &Page<'_>, at: Option<usize>, first: usize| match at {
            Some(at) => format!("<td>{}<td>{}", first + at, cut(&decode(page.text(at)), LETTERS)),
            None => "<td><td>".to_owned(),
        };
        let (ours, theirs) = (line(&self.source, s, self.first[0]), line(&self.target, t, self.first[1]));
        let _ = writeln!(out, "<tr{class}>{ours}<td>{sign}{theirs}");
        if let Some(findings) = s.and_then(|s| self.by_line.remove(&Some(s))) {
            self.findings(out, &findings, s);
        }
    }

    /// Findings below their line.
    fn findings(&mut self, out: &mut String, findings: &[&Diagnostic], line: Option<usize>) {
        let room = self.left.min(OF_A_LINE);
        for finding in findings.iter().take(room) {
            let severity = grade(finding.in_program());
            let at = line.map(|line| format!(", line {}", self.first[0] + line)).unwrap_or_default();
            let accepted = finding.accepted.as_ref().map(|accepted| escaped(&accepted.to_string()));
            let help = accepted.or_else(|| finding.help.as_deref().map(ticked));
            let help = help.map(|help| format!("<br>{help}"));
            let _ = writeln!(
                out,
                "<tr class=\"g {severity}\"><td colspan=5>{} {severity}{at}: {}{}",
                code(finding.code),
                ticked(&finding.message),
                help.unwrap_or_default()
            );
        }
        self.left -= findings.len().min(room);
        if findings.len() > room {
            let more = findings.len() - room;
            let _ = writeln!(out, "<tr class=\"g\"><td colspan=5>and {} here", plural(more, "more finding"));
        }
    }
}
