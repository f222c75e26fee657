//! What a check found, as JSON.

use crate::check::{Checked, Finding};
use crate::library::slashed;
use crate::text::json_pretty;
use serde_json::{Value, json};

/// The findings as one object.
pub fn check(checked: &Checked) -> String {
    let suppressed = checked.suppressed.iter().map(|suppressed| {
        let mut value = finding(&suppressed.finding);
        value["reason"] = suppressed.reason.clone().into();
        value
    });
    let all = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "findings": checked.findings.iter().map(finding).collect::<Vec<_>>(),
        "suppressed": suppressed.collect::<Vec<_>>(),
        "not_looked_at": checked.not_looked_at,
        "totals": {
            "files": checked.files.len(),
            "findings": checked.findings.len(),
            "suppressed": checked.suppressed.len(),
            "in_baseline": checked.known,
            "round_trips": { "taken": checked.rounds[0], "from_cache": checked.rounds[1] },
        },
    });
    json_pretty(&all) + "\n"
}

fn finding(finding: &Finding) -> Value {
    json!({
        "code": finding.code,
        "severity": finding.severity,
        "file": slashed(&finding.file),
        "line": finding.start.0,
        "column": finding.start.1,
        "end_line": finding.end.0,
        "end_column": finding.end.1,
        "text": finding.line,
        "message": finding.message,
        "help": finding.help,
        "fingerprint": finding.fingerprint,
    })
}
