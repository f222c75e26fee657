//! What a conversion asks a person: each thing once in each program, or once in the library.

use super::entry::{Entry, acceptable};
use super::scope::{Scope, Scopes, line_at};
use crate::diag::{Code, Diagnostic, Severity};
use crate::library::{Conversion, Input, Outcome};
use crate::text::LineIndex;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path};
use std::sync::Arc;
use toml::Spanned;
use toml::value::Datetime;

/// Letters of a line that are told.
const SHOWN: usize = 60;

/// A code, and what is said under it.
pub(super) type Said = (Code, Arc<str>);

/// Something that is asked at one or more places of a program, or once for the library.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The program, by its place among the reports; none for what is asked once for the library.
    pub program: Option<usize>,
    /// The file, seen from the project file; empty for what is asked once.
    pub file: String,
    /// The program's name; none for one without.
    pub name: Option<String>,
    /// Its code.
    pub code: Code,
    /// What is asked.
    pub says: Arc<str>,
    /// Where, as a person reads it.
    pub at: String,
    /// The hash of what it concerns.
    pub hash: String,
}

impl Question {
    /// Its answer, as it is to stand in the project file.
    pub fn entry(&self, [library, target]: [&str; 2], who: &str, when: Datetime, why: Option<&str>) -> Entry {
        let text = |text: &str| Spanned::new(0..0, text.to_owned());
        Entry {
            library: text(library),
            target: text(target),
            file: self.program.map(|_| text(&self.file)),
            program: self.name.as_deref().map(text),
            code: text(self.code.number()),
            says: text(&self.says),
            at: self.program.map(|_| text(&self.at)),
            who: text(who),
            when: Spanned::new(0..0, when),
            why: why.map(text),
            hash: text(&self.hash),
        }
    }
}

/// What is asked of the programs that have a conversion. Files are seen from `root`.
pub fn questions(inputs: &[Input], conversion: &Conversion, scopes: &Scopes, root: &Path) -> Vec<Question> {
    let mut counts = vec![0; inputs.len()];
    let mut totals = vec![0; inputs.len()];
    for program in &conversion.programs {
        totals.get_mut(program.file).into_iter().for_each(|total| *total += 1);
    }
    let mut lines: Option<(usize, LineIndex)> = None;
    let mut all = once(conversion, scopes);
    for (at, program) in conversion.programs.iter().enumerate() {
        let file = program.file;
        let (Some(input), Some(nth)) = (inputs.get(file), counts.get_mut(file)) else { continue };
        let scope = scopes.program(file, *nth, totals.get(file).copied().unwrap_or_default());
        *nth += 1;
        let Some(scope) = scope.filter(|_| program.outcome != Outcome::Refused) else { continue };
        let asked = program.diagnostics.iter().filter(|finding| asks(finding) && !finding.once);
        let mut asked = asked.peekable();
        if asked.peek().is_none() {
            continue;
        }
        if lines.as_ref().is_none_or(|(of, _)| *of != file) {
            lines = Some((file, LineIndex::new(&input.bytes)));
        }
        let Some((_, lines)) = &lines else { continue };
        let seen = seen_from(&input.path, root);
        all.extend(of_program(asked, (input, lines), (scopes, scope)).into_iter().map(
            |(key, at_line, hash)| {
                let ((code, says), name) = (key, program.name.clone());
                Question { program: Some(at), file: seen.clone(), name, code, says, at: at_line, hash }
            },
        ));
    }
    all
}

/// What is asked once for the library.
fn once(conversion: &Conversion, scopes: &Scopes) -> Vec<Question> {
    let written = conversion.programs.iter().filter(|program| program.outcome != Outcome::Refused);
    let findings = written.flat_map(|program| &program.diagnostics).filter(|f| f.once && asks(f));
    let said: BTreeSet<Said> = findings.map(|f| (f.code, Arc::clone(&f.message))).collect();
    let question = |(code, says): Said| {
        let hash = scopes.hash_once(code.number(), &says);
        Question { program: None, file: String::new(), name: None, code, says, at: String::new(), hash }
    };
    said.into_iter().map(question).collect()
}

/// True if a conversion asks anything that can be accepted.
pub fn asks_any(conversion: &Conversion) -> bool {
    conversion.programs.iter().flat_map(|program| &program.diagnostics).any(asks)
}

/// True for what is asked of a person who looks at the program, or of the library once.
pub(super) fn asks(finding: &Diagnostic) -> bool {
    finding.severity() == Severity::Review && finding.accepted.is_none() && acceptable(finding.code).is_ok()
}

/// What is asked of a program, each thing with the places as a person reads them and its hash.
pub(super) fn of_program<'d>(
    asked: impl Iterator<Item = &'d Diagnostic>,
    (input, lines): (&Input, &LineIndex),
    (scopes, scope): (&Scopes, &Scope),
) -> Vec<(Said, String, String)> {
    let mut places: BTreeMap<Said, BTreeSet<(i64, u32)>> = BTreeMap::new();
    for finding in asked {
        let line = i64::from(lines.place(finding.span.start).0);
        let places = places.entry((finding.code, Arc::clone(&finding.message))).or_default();
        places.insert((line, finding.span.start));
    }
    let all = places.into_iter().map(|(key, places)| {
        let relative = places.iter().map(|(line, _)| line - i64::from(scope.line)).collect();
        let hash = scopes.hash(scope, key.0.number(), &key.1, &relative);
        let first = places.first().map(|(line, start)| {
            let text: String = line_at(&input.bytes, *start).chars().take(SHOWN).collect();
            format!("line {line}: {text}")
        });
        let distinct: BTreeSet<i64> = places.iter().map(|(line, _)| *line).collect();
        let more = match distinct.len().saturating_sub(1) {
            0 => String::new(),
            more => format!(" (and {more} more)"),
        };
        (key, first.unwrap_or_default() + &more, hash)
    });
    all.collect()
}

/// A file as it is seen from a folder, with `/` between parts.
pub fn seen_from(file: &Path, root: &Path) -> String {
    let whole = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let real = || std::fs::canonicalize(file).ok()?.strip_prefix(root).ok().map(Path::to_owned);
    let seen = whole.strip_prefix(root).ok().map(Path::to_owned).or_else(real);
    let seen = seen.as_deref().unwrap_or(file);
    let parts = seen.components().filter(|part| !matches!(part, Component::CurDir));
    let parts: Vec<String> = parts.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    parts.join("/").replacen("//", "/", 1)
}
