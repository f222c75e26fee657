//! What a check found, as workflow commands: the host draws each at its line of a change.

use crate::check::{Checked, Finding};
use crate::diag::Severity;
use crate::library::slashed;
use std::fmt::Write;

/// The findings, a command a line.
pub fn check(checked: &Checked) -> String {
    let mut out = String::new();
    for finding in &checked.findings {
        let (file, (line, column)) = (slashed(&finding.file), finding.start);
        let (_, last) = finding.end;
        // Columns say where on one line; a finding over several has none at its end.
        let end =
            if finding.end.0 == line && last > column { format!(",endColumn={last}") } else { String::new() };
        // Writing to memory cannot fail.
        let _ = writeln!(
            out,
            "::{} file={},line={line},col={column}{end},title={}::{}",
            level(finding.severity),
            property(&file),
            property(&format!("{} {}", finding.code.number(), finding.code.title())),
            data(&said(finding))
        );
    }
    out
}

fn said(finding: &Finding) -> String {
    match &finding.help {
        Some(help) => format!("{}\nhelp: {help}", finding.message),
        None => finding.message.clone(),
    }
}

const fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Review => "warning",
        Severity::Note => "notice",
    }
}

/// A message: it ends with its line.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// A property: it ends with a comma or a colon too.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_of_a_program_is_a_command() {
        assert_eq!(data("50%\n::error::x"), "50%25%0A::error::x");
        assert_eq!(property("a,b:c\r"), "a%2Cb%3Ac%0D");
    }
}
