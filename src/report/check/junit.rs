//! What a check found, as JUnit XML: a file is a case, and each finding of it a failure.

use crate::check::{Checked, Finding};
use crate::library::slashed;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::collections::BTreeMap;
use std::path::Path;

/// The findings as XML.
pub fn check(checked: &Checked) -> String {
    let mut by_file: BTreeMap<&Path, Vec<&Finding>> = BTreeMap::new();
    by_file.extend(checked.files.iter().map(|file| (file.as_path(), Vec::new())));
    checked.findings.iter().for_each(|finding| by_file.entry(&finding.file).or_default().push(finding));
    let mut suite = TestSuite::new("macroglot check");
    for (file, findings) in by_file {
        let mut case = TestCase::new(slashed(file), status(&findings));
        case.set_classname("macroglot");
        suite.add_test_case(case);
    }
    let mut report = Report::new("macroglot");
    report.add_test_suite(suite);
    // Writing to memory cannot fail; control characters, which XML has no place for, are left out.
    report.to_string().unwrap_or_default()
}

fn status(findings: &[&Finding]) -> TestCaseStatus {
    let Some(first) = findings.first() else { return TestCaseStatus::success() };
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    let more = findings.len() - 1;
    let more = if more == 0 { String::new() } else { format!(" (and {more} more)") };
    status.set_type(first.code.number());
    status.set_message(format!("{}{more}", first.message));
    let line = |finding: &&Finding| {
        let (line, column) = finding.start;
        let help = finding.help.as_ref().map(|help| format!("\n    help: {help}")).unwrap_or_default();
        format!(
            "{line}:{column}: {} {}\n    | {}{help}",
            finding.code.number(),
            finding.message,
            finding.line
        )
    };
    status.set_description(findings.iter().map(line).collect::<Vec<_>>().join("\n"));
    status
}
