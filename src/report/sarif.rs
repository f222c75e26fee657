//! A conversion as SARIF 2.1.0, which code hosts show beside the lines.

use super::Part;
use crate::diag::{ALL, Code, Severity};
use crate::text::{CodePoints, json_pretty};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;

/// The conversions as SARIF text.
pub fn conversion(parts: &[Part<'_>]) -> String {
    let results: Vec<Value> = parts.iter().flat_map(results).collect();
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "macroglot",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules(),
            }},
            // Columns count what a reader sees that takes every file for UTF-8, and lines end as controls end them.
            "columnKind": "unicodeCodePoints",
            "defaultEncoding": "UTF-8",
            "newlineSequences": ["\r\n", "\n", "\r"],
            "results": results,
        }],
    });
    json_pretty(&log) + "\n"
}

/// Every code of the catalogue, with its page.
pub(super) fn rules() -> Vec<Value> {
    let rule = |code: &Code| {
        json!({
            "id": code.number(),
            "shortDescription": { "text": code.title() },
            "fullDescription": { "text": code.page() },
            "defaultConfiguration": { "level": level(code.severity()) },
        })
    };
    ALL.iter().map(rule).collect()
}

fn results(part: &Part<'_>) -> Vec<Value> {
    let indexes: Vec<CodePoints> = part.inputs.iter().map(|input| CodePoints::new(&input.bytes)).collect();
    let findings =
        part.conversion.programs.iter().flat_map(|p| p.diagnostics.iter().map(move |d| (p.file, d)));
    let results = findings.map(|(file, d)| {
        let [(line, column), (end_line, end_column)] = indexes[file].region(d.span);
        json!({
            "ruleId": d.code.number(),
            "ruleIndex": ALL.iter().position(|code| *code == d.code),
            "level": level(d.severity()),
            "message": { "text": &*d.message },
            "locations": [{ "physicalLocation": {
                "artifactLocation": { "uri": uri(&part.inputs[file].path) },
                "region": {
                    "startLine": line, "startColumn": column,
                    "endLine": end_line, "endColumn": end_column,
                },
            }}],
        })
    });
    results.collect()
}

/// A path as a relative reference: what has a meaning there, or none, is written as its bytes.
pub(super) fn uri(path: &Path) -> String {
    let path = path.to_string_lossy().replace(std::path::MAIN_SEPARATOR, "/");
    let mut out = String::with_capacity(path.len());
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' => out.push(char::from(byte)),
            b'/' | b'-' | b'.' | b'_' | b'~' => out.push(char::from(byte)),
            // Writing to memory cannot fail.
            _ => drop(write!(out, "%{byte:02X}")),
        }
    }
    out
}

pub(super) fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Review => "warning",
        Severity::Note => "note",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_a_reference() {
        assert_eq!(uri(Path::new("in/O1 (a)\n#2%.nc")), "in/O1%20%28a%29%0A%232%25.nc");
        assert_eq!(uri(Path::new("in/ä.nc")), "in/%C3%A4.nc");
    }
}
