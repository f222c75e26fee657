//! What a check found, for people: each finding with its line and what to do, then how many.

use crate::check::{Checked, Finding};
use crate::diag::Code;
use crate::report::totals::plural;
use crate::text::shown;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// The findings as text, and a line that sums them up.
pub fn check(checked: &Checked) -> String {
    let mut out = String::new();
    for finding in &checked.findings {
        draw(&mut out, finding);
    }
    let files: BTreeSet<_> = checked.findings.iter().map(|finding| &finding.file).collect();
    // Writing to memory cannot fail.
    if checked.findings.is_empty() {
        let _ = write!(out, "{} checked, nothing found", plural(checked.files.len(), "file"));
    } else {
        let _ = write!(
            out,
            "{} in {}; {} checked",
            plural(checked.findings.len(), "finding"),
            plural(files.len(), "file"),
            plural(checked.files.len(), "file")
        );
    }
    let more =
        [(checked.suppressed.len(), "allowed by the project file"), (checked.known, "known to the baseline")];
    for (count, what) in more.into_iter().filter(|(count, _)| *count > 0) {
        let _ = write!(out, ", {count} {what}");
    }
    out.push('\n');
    for why in &checked.not_looked_at {
        let _ = writeln!(out, "not looked at: {}", shown(why));
    }
    out
}

fn draw(out: &mut String, finding: &Finding) {
    let (line, column) = finding.start;
    let file = finding.file.display().to_string();
    let (code, message) = (finding.code.number(), shown(&finding.message));
    let _ = writeln!(out, "{}:{line}:{column}: {code} {message}", shown(&file));
    if !finding.line.is_empty() {
        let _ = writeln!(out, "    | {}", shown(&finding.line));
    }
    if let Some(help) = &finding.help {
        let _ = writeln!(out, "    help: {}", shown(help));
    }
}

/// How often each code was found, the most frequent first.
pub fn statistics(checked: &Checked) -> String {
    if checked.findings.is_empty() {
        return check(checked);
    }
    let mut counts: BTreeMap<Code, usize> = BTreeMap::new();
    checked.findings.iter().for_each(|finding| *counts.entry(finding.code).or_default() += 1);
    let mut counts: Vec<(Code, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(code, count)| (std::cmp::Reverse(*count), *code));
    let mut out = String::new();
    for (code, count) in counts {
        let _ = writeln!(out, "{count:6} {} {}", code.number(), code.title());
    }
    out
}
