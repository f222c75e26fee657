//! Diagnostics drawn at their source, and summaries, for people.

use super::asked::asked;
use super::{Part, Questions, Totals};
use crate::diag::{Code, Diagnostic, Severity};
use crate::library::{LeftOut, Outcome, Told, WhyNot};
use crate::syntax::ProgramName;
use crate::text::{shown, shown_lines};
use miette::{GraphicalReportHandler, LabeledSpan, MietteDiagnostic, MietteError, MietteSpanContents};
use miette::{Report, SourceCode, SourceSpan, SpanContents};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::sync::Arc;

/// A source file to draw diagnostics on.
pub struct Sheet<'b> {
    name: String,
    bytes: &'b [u8],
    starts: Arc<Starts>,
    handler: GraphicalReportHandler,
}

/// Where each line of a file begins.
struct Starts(Vec<u32>);

impl Starts {
    fn of(bytes: &[u8]) -> Self {
        // A CR alone ends a line too.
        let ends = |at: &usize| bytes[*at] == b'\n' || bytes.get(at + 1) != Some(&b'\n');
        let ends = || memchr::memchr2_iter(b'\n', b'\r', bytes).filter(ends);
        let mut starts = Vec::with_capacity(1 + ends().count());
        starts.push(0);
        starts.extend(ends().map(|at| at as u32 + 1));
        Self(starts)
    }

    /// The line of an offset, from 0.
    fn line(&self, offset: usize) -> usize {
        self.0.partition_point(|start| *start as usize <= offset).saturating_sub(1)
    }

    fn get(&self, line: usize) -> Option<usize> {
        self.0.get(line).map(|start| *start as usize)
    }
}

/// What stands about a place of a file that is found by its lines, as it is drawn.
struct Lines {
    name: String,
    /// The bytes of the file from `first` on.
    text: Vec<u8>,
    first: usize,
    /// The length of the file.
    length: usize,
    starts: Arc<Starts>,
}

impl Lines {
    /// Bytes of the file, as they are drawn.
    fn part(&self, start: usize, end: usize) -> Result<&[u8], MietteError> {
        let at = |offset: usize| offset.checked_sub(self.first);
        let part = at(start).zip(at(end)).and_then(|(start, end)| self.text.get(start..end));
        part.ok_or(MietteError::OutOfBounds)
    }

    /// What stands about a place on its line, and no other line: a line may have as many places as bytes.
    fn window<'a>(
        &'a self,
        span: &SourceSpan,
        before: bool,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let line = self.starts.line(span.offset());
        let first = self.starts.get(line).unwrap_or(0);
        let last = self.starts.get(line + 1).map_or(self.length, |next| next - 1);
        let start = if before { span.offset().saturating_sub(ABOUT).max(first) } else { span.offset() };
        let end = span.offset().saturating_add(span.len().saturating_add(ABOUT)).min(last).max(start);
        let data = self.part(start, end)?;
        let at = SourceSpan::from((start, data.len()));
        let name = self.name.clone();
        Ok(Box::new(MietteSpanContents::new_named(name, data, at, line, start - first, 1)))
    }
}

/// Bytes about a place from which on it is drawn with what stands next to it, not with its lines.
const LONG: usize = 4000;

/// How much of a long line is drawn before a place and after it, and of a place itself: bytes.
const ABOUT: usize = 120;

impl SourceCode for Lines {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        // An empty place at the start of a line is looked for from the end of the one before.
        let first = self.starts.line(span.offset()).saturating_sub(before + 1);
        let start = self.starts.get(first).unwrap_or(0);
        let last = self.starts.line(span.offset().saturating_add(span.len())).saturating_add(after + 2);
        let end = self.starts.get(last).unwrap_or(self.length);
        if end.saturating_sub(start) > LONG {
            return self.window(span, before > 0);
        }
        let around = self.part(start, end)?;
        let inside = SourceSpan::from((span.offset().saturating_sub(start), span.len()));
        let (at, line, column, count) = {
            let found = around.read_span(&inside, before, after)?;
            (*found.span(), found.line(), found.column(), found.line_count())
        };
        let data = around.get(at.offset()..at.offset() + at.len()).ok_or(MietteError::OutOfBounds)?;
        let at = SourceSpan::from((at.offset() + start, at.len()));
        let name = self.name.clone();
        Ok(Box::new(MietteSpanContents::new_named(name, data, at, line + first, column, count + first)))
    }
}

impl<'b> Sheet<'b> {
    /// The file of this name.
    pub fn new(name: &str, bytes: &'b [u8]) -> Self {
        let starts = Arc::new(Starts::of(bytes));
        Self { name: shown(name).into(), bytes, starts, handler: handler() }
    }

    /// The file's name, as it is drawn.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The line that a diagnostic begins on, from 0.
    pub fn line(&self, diagnostic: &Diagnostic) -> usize {
        self.starts.line(diagnostic.span.start as usize)
    }

    /// What stands about a place: as much as may be drawn of it.
    fn about(&self, start: usize, end: usize) -> Lines {
        let length = self.bytes.len();
        let (first, last) = (start.saturating_sub(LONG), end.saturating_add(LONG).min(length));
        let text = (first..last).map(|at| drawn(self.bytes, at)).collect();
        Lines { name: self.name.clone(), text, first, length, starts: Arc::clone(&self.starts) }
    }

    /// A diagnostic, drawn.
    pub fn draw(&self, diagnostic: &Diagnostic) -> String {
        let (span, length) = (diagnostic.span, self.bytes.len());
        let start = (span.start as usize).min(length);
        // Only the first line of a place is drawn.
        let next = self.starts.get(self.starts.line(start) + 1).map_or(length, |next| next - 1);
        let end = (span.end as usize).clamp(start, length).min(next.max(start)).min(start + 4 * ABOUT);
        let severity = match diagnostic.in_program() {
            Severity::Error => miette::Severity::Error,
            Severity::Review => miette::Severity::Warning,
            Severity::Note => miette::Severity::Advice,
        };
        let mut drawn = MietteDiagnostic::new(diagnostic.code.title())
            .with_code(diagnostic.code.number())
            .with_severity(severity)
            .with_label(LabeledSpan::new(Some(shown(&diagnostic.message).into()), start, end - start));
        let accepted = diagnostic.accepted.as_ref().map(|accepted| shown(&accepted.to_string()).into_owned());
        // Who has looked knows what to do about it.
        let help = diagnostic.help.as_ref().map(|help| shown_lines(help).into_owned());
        if let Some(help) = accepted.or(help) {
            drawn = drawn.with_help(help);
        }
        let report = Report::new(drawn).with_source_code(self.about(start, end));
        let mut out = String::new();
        match self.handler.render_report(&mut out, report.as_ref()) {
            Ok(()) => out,
            Err(_) => format!("{}: {}: {}\n", self.name, diagnostic.code.number(), diagnostic.message),
        }
    }
}

/// A byte of a file, as it is drawn: bytes that are no ASCII as `?`, so that columns stay.
fn drawn(bytes: &[u8], at: usize) -> u8 {
    // Line ends other than LF would be drawn as part of the line; NUL draws as nothing.
    match bytes[at] {
        b'\r' if bytes.get(at + 1) == Some(&b'\n') => b' ',
        b'\r' => b'\n',
        byte @ (b'\n' | b'\t' | 0x20..=0x7e) => byte,
        _ => b'?',
    }
}

fn handler() -> GraphicalReportHandler {
    use std::io::IsTerminal;
    let colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let theme =
        if colour { miette::GraphicalTheme::unicode() } else { miette::GraphicalTheme::unicode_nocolor() };
    GraphicalReportHandler::new_themed(theme).with_width(100).with_context_lines(1)
}

/// The page of a code.
pub fn explain(code: Code) -> String {
    let severity = match code.severity() {
        Severity::Error => "error: the program is refused",
        Severity::Review => "review: a person must look at the place",
        Severity::Note => "note: the outcome stands",
    };
    format!("{}: {}\n({severity})\n\n{}\n", code.number(), code.title(), code.page())
}

/// What became of conversions: a line each program, each question once, and the count.
pub fn summary(parts: &[Part<'_>]) -> String {
    told(parts, true)
}

/// The programs of conversions, a line each, and their count.
pub fn outcomes(parts: &[Part<'_>]) -> String {
    told(parts, false)
}

fn told(parts: &[Part<'_>], asks: bool) -> String {
    let mut out = String::new();
    for part in parts {
        if parts.len() > 1 {
            let _ = writeln!(out, "{} to {}{}:", part.from, part.to, from_folder(part, parts));
        }
        list(&mut out, part);
        if let Some(advice) = part.advised() {
            let _ = writeln!(out, "{}: {advice}", part.to);
        }
        folder(&mut out, part.folder);
        out.push_str(&left_out_text(part.left_out, part.verbose));
    }
    if asks {
        let questions = asked(&Questions::of(parts), "--verbose draws");
        if !questions.is_empty() {
            let _ = writeln!(out, "{questions}");
        }
    }
    let _ = writeln!(out, "{}", Totals::of(parts));
    out
}

/// `, from programs/job1`: the folder of a library, where several of them go the same way.
fn from_folder(part: &Part<'_>, parts: &[Part<'_>]) -> String {
    let alike = |other: &&Part<'_>| (other.from, other.to) == (part.from, part.to);
    let folder = part.inputs.first().and_then(|input| input.path.to_str()?.strip_suffix(&input.name));
    match folder.map(|folder| folder.trim_end_matches(['/', '\\'])).filter(|folder| !folder.is_empty()) {
        Some(folder) if parts.iter().filter(alike).count() > 1 => format!(", from {}", shown(folder)),
        _ => String::new(),
    }
}

fn list(out: &mut String, part: &Part<'_>) {
    let width =
        part.programs().map(|(_, program)| part.inputs[program.file].name.len()).max().unwrap_or(0).min(48);
    for (_, program) in part.programs() {
        let outcome = match program.outcome {
            Outcome::Converted => "converted",
            Outcome::Accepted => "accepted",
            Outcome::Review => "review",
            Outcome::Refused => "REFUSED",
        };
        let codes: BTreeSet<&str> = program.diagnostics.iter().map(|d| d.code.number()).collect();
        let codes = codes.into_iter().collect::<Vec<_>>().join(" ");
        let input = &part.inputs[program.file].name;
        // A program that has no number on the source is selected by the one that it got.
        let given = part.conversion.lock.programs.get(input).filter(|_| program.outcome != Outcome::Refused);
        let given = given.map(|number| format!("as {}", ProgramName::Number(*number)));
        let name = shown(program.name.as_deref().or(given.as_deref()).unwrap_or("-"));
        let file = shown(input);
        let _ = writeln!(out, "{}", format!("{outcome:<9}  {file:<width$}  {name:<6} {codes}").trim_end());
    }
    let taken = &part.conversion.taken;
    if !taken.is_empty() {
        let ask = match part.conversion.states_reserved {
            true => "",
            false => "; if the machine uses any of them, name it in 'reserved' of its profile",
        };
        let _ = writeln!(out, "registers taken: {taken}{ask}");
    }
}

/// How many files were left out, and why; each by its name too.
pub fn left_out_text(left_out: &[LeftOut], named: bool) -> String {
    let mut out = String::new();
    // A program that is not read must not be missed.
    for left in left_out.iter().filter(|left| named || left.why == WhyNot::Program) {
        let _ = writeln!(out, "left out   {}: {}", shown(&left.path.to_string_lossy()), left.why.words());
    }
    let mut counts = BTreeMap::new();
    left_out.iter().for_each(|left| *counts.entry(left.why).or_insert(0) += 1);
    let counts: Vec<String> =
        counts.into_iter().map(|(why, n): (_, usize)| format!("{n} {}", why.words())).collect();
    if !counts.is_empty() {
        let ask = if named { "" } else { "; --verbose names them" };
        let _ = writeln!(out, "left out: {}{ask}", counts.join(", "));
    }
    out
}

/// What became of files of earlier runs.
pub(super) fn folder(out: &mut String, told: &Told) {
    for name in &told.removed {
        let _ = writeln!(
            out,
            "removed    {}: an earlier run converted it, but it has no conversion now",
            shown(name)
        );
    }
    for (name, kept) in &told.kept {
        let _ = writeln!(
            out,
            "kept       {} as {}: macroglot did not write the earlier file",
            shown(name),
            shown(kept)
        );
    }
    for (name, at) in &told.replaced {
        let (name, at) = (shown(name), shown(at));
        let _ = writeln!(out, "replaced   {name}: it was converted from {at}, which still exists");
    }
    for (name, others) in &told.uncertified {
        let others: Vec<_> = others.iter().map(|other| shown(other)).collect();
        let _ = writeln!(
            out,
            "unverified {}: programs that it calls, or that call it, have changed since it was verified: \
             {}; convert them together",
            shown(name),
            others.join(", ")
        );
    }
    for name in &told.gone {
        let _ = writeln!(out, "no source  {}: its source is gone; --prune removes it", shown(name));
    }
    for name in &told.pruned {
        let _ = writeln!(out, "removed    {}: its source is gone", shown(name));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A place on a long line is drawn with what stands next to it, and its column is the line's.
    #[test]
    fn a_long_line_is_drawn_about_its_place() {
        let text = format!("O1\n{}M38 {}\nM30\n", "X1.".repeat(2000), "Y2.".repeat(2000));
        let at = 3 + 6000;
        let finding = Diagnostic::new(Code::Unmapped, crate::text::Span::new(at, at + 3), "here");
        let drawn = Sheet::new("a.nc", text.as_bytes()).draw(&finding);
        assert!(drawn.len() < 3000, "{}", drawn.len());
        assert!(drawn.contains("[a.nc:2:6001]") && drawn.contains("X1.M38 Y2."), "{drawn}");
    }

    #[test]
    fn a_place_is_read_as_from_the_whole_text() {
        let text = "O1\n\nG1 X1.\nM98 P2 L3\n \n\nM30\n%";
        let sheet = Sheet::new("a.nc", text.as_bytes());
        let told = |contents: Result<Box<dyn SpanContents<'_> + '_>, MietteError>| {
            contents.ok().map(|found| {
                let place = (*found.span(), found.line(), found.column(), found.line_count());
                (found.data().to_vec(), place)
            })
        };
        for (start, length) in (0..=text.len()).flat_map(|at| (0..=text.len() - at).map(move |n| (at, n))) {
            for (before, after) in [(0, 0), (1, 1), (2, 0), (0, 3), (9, 9)] {
                let span = SourceSpan::from((start, length));
                let ours = told(sheet.about(start, start + length).read_span(&span, before, after));
                assert_eq!(ours, told(text.read_span(&span, before, after)), "{span:?} {before} {after}");
            }
        }
    }
}
