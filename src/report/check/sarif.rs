//! What a check found, as SARIF 2.1.0, with fingerprints by which a host knows a finding again.

use crate::check::{Checked, Finding};
use crate::diag::ALL;
use crate::report::sarif::{level, rules, uri};
use crate::text::json_pretty;
use serde_json::{Value, json};

/// The findings as SARIF text; what the project file allows is in it as suppressed.
pub fn check(checked: &Checked) -> String {
    let open = checked.findings.iter().map(result);
    let suppressed = checked.suppressed.iter().map(|suppressed| {
        let mut value = result(&suppressed.finding);
        value["suppressions"] = json!([{
            "kind": "external", "status": "accepted", "justification": suppressed.reason,
        }]);
        value
    });
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "macroglot",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules(),
            }},
            "columnKind": "unicodeCodePoints",
            "defaultEncoding": "UTF-8",
            "newlineSequences": ["\r\n", "\n", "\r"],
            "results": open.chain(suppressed).collect::<Vec<_>>(),
        }],
    });
    json_pretty(&log) + "\n"
}

fn result(finding: &Finding) -> Value {
    let text = match &finding.help {
        Some(help) => format!("{}. {help}", finding.message),
        None => finding.message.clone(),
    };
    let ((line, column), (end_line, end_column)) = (finding.start, finding.end);
    json!({
        "ruleId": finding.code.number(),
        "ruleIndex": ALL.iter().position(|code| *code == finding.code),
        "level": level(finding.severity),
        "message": { "text": text },
        "locations": [{ "physicalLocation": {
            "artifactLocation": { "uri": uri(&finding.file) },
            "region": {
                "startLine": line, "startColumn": column,
                "endLine": end_line.max(line), "endColumn": end_column,
            },
        }}],
        "partialFingerprints": { "macroglot/v1": finding.fingerprint },
    })
}
