//! A conversion as SARIF 2.1.0, which code hosts show beside the lines.

use super::Part;
use crate::diag::{ALL, Severity};
use serde_json::{Value, json};

/// The conversions as SARIF text.
pub fn conversion(parts: &[Part<'_>]) -> String {
    let rules: Vec<Value> = ALL
        .iter()
        .map(|code| {
            json!({
                "id": code.number(),
                "shortDescription": { "text": code.title() },
                "fullDescription": { "text": code.page() },
                "defaultConfiguration": { "level": level(code.severity()) },
            })
        })
        .collect();
    let results: Vec<Value> = parts.iter().flat_map(results).collect();
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "macroglot",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    });
    serde_json::to_string_pretty(&log).unwrap_or_default() + "\n"
}

fn results(part: &Part<'_>) -> Vec<Value> {
    let indexes = part.indexes();
    let findings =
        part.conversion.programs.iter().flat_map(|p| p.diagnostics.iter().map(move |d| (p.file, d)));
    let results = findings.map(|(file, d)| {
        let (line, column) = indexes[file].place(d.span.start);
        let (end_line, end_column) = indexes[file].place(d.span.end.max(d.span.start));
        json!({
            "ruleId": d.code.number(),
            "ruleIndex": ALL.iter().position(|code| *code == d.code),
            "level": level(d.severity()),
            "message": { "text": &*d.message },
            "locations": [{ "physicalLocation": {
                "artifactLocation": { "uri": part.inputs[file].path.to_string_lossy().replace('\\', "/") },
                "region": {
                    "startLine": line, "startColumn": column,
                    "endLine": end_line, "endColumn": end_column,
                },
            }}],
        })
    });
    results.collect()
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Review => "warning",
        Severity::Note => "note",
    }
}
