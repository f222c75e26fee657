//! A conversion as SARIF 2.1.0, which code hosts show beside the lines.

use super::Part;
use crate::diag::{ALL, Code, Diagnostic, Severity};
use crate::library::{Link, Linked, Pairs, with_pairs};
use crate::syntax::{Block, ItemKind, Label, Target, for_each_item};
use crate::text::{CodePoints, Span, json_pretty};
use crate::verify::sha256;
use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;
use std::path::Path;

/// The log. Its results are written one by one: a library of many findings makes more of them than of itself.
#[derive(Serialize)]
struct Log<'a> {
    #[serde(rename = "$schema")]
    schema: &'static str,
    runs: [Run<'a>; 1],
    version: &'static str,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Run<'a> {
    // Columns count what a reader sees that takes every file for UTF-8, and lines end as controls end them.
    column_kind: &'static str,
    default_encoding: &'static str,
    newline_sequences: [&'static str; 3],
    #[serde(serialize_with = "results")]
    results: &'a [Part<'a>],
    tool: Value,
}

/// The conversions as SARIF text.
pub fn conversion(parts: &[Part<'_>]) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let run = Run {
        column_kind: "unicodeCodePoints",
        default_encoding: "UTF-8",
        newline_sequences: ["\r\n", "\n", "\r"],
        results: parts,
        tool: json!({ "driver": { "name": "macroglot", "version": version, "rules": rules() } }),
    };
    let schema = "https://json.schemastore.org/sarif-2.1.0.json";
    json_pretty(&Log { schema, runs: [run], version: "2.1.0" }) + "\n"
}

/// Every code of the catalogue, with its page.
pub(super) fn rules() -> Vec<Value> {
    let rule = |code: &Code| {
        json!({
            "id": code.number(),
            "shortDescription": { "text": code.title() },
            "fullDescription": { "text": code.page() },
            "help": { "text": code.page(), "markdown": code.page() },
            "defaultConfiguration": { "level": level(code.severity()) },
        })
    };
    ALL.iter().map(rule).collect()
}

fn results<S: Serializer>(parts: &[Part<'_>], serializer: S) -> Result<S::Ok, S::Error> {
    let mut out = serializer.serialize_seq(None)?;
    // All results of a run say whether they are suppressed, or none does.
    let mut all = parts.iter().flat_map(Part::programs).flat_map(|(_, program)| &program.diagnostics);
    let any_accepted = all.any(|finding| finding.accepted.is_some());
    for part in parts {
        let any = part.programs().any(|(_, program)| !program.diagnostics.is_empty());
        let controls = (part.controls[0], part.controls[1]);
        let read = any.then(|| {
            with_pairs(part.inputs, part.conversion, controls, |pairs| {
                of_part(part, Some(pairs), any_accepted, &mut out)
            })
        });
        read.flatten().unwrap_or_else(|| of_part(part, None, any_accepted, &mut out))?;
    }
    out.end()
}

fn of_part<S: SerializeSeq>(
    part: &Part<'_>,
    pairs: Option<&Pairs<'_>>,
    any_accepted: bool,
    out: &mut S,
) -> Result<(), S::Error> {
    let indexes: Vec<CodePoints> = part.inputs.iter().map(|input| CodePoints::new(&input.bytes)).collect();
    let lines = part.indexes();
    let mut links: HashMap<usize, Vec<&Link>> = HashMap::new();
    part.conversion.links.iter().for_each(|link| links.entry(link.caller).or_default().push(link));
    // How often a fingerprint came before in the same file.
    let mut seen: HashMap<String, usize> = HashMap::new();
    let region = |file: usize, span: Span| {
        let [(line, column), (end_line, end_column)] = indexes[file].region(span);
        json!({
            "artifactLocation": { "uri": uri(&part.inputs[file].path) },
            "region": {
                "startLine": line, "startColumn": column,
                "endLine": end_line, "endColumn": end_column,
            },
        })
    };
    let step = |(file, span, text): &(usize, Span, &str)| json!({ "location": { "physicalLocation": region(*file, *span), "message": { "text": text } } });
    for (at, program) in part.programs() {
        let file = program.file;
        let ways = Ways::of(part, pairs, at, links.get(&at).map_or(&[], Vec::as_slice));
        for d in &program.diagnostics {
            let text = part.place(file, &lines[file], d).text.trim_ascii();
            let key = fingerprint(d, &part.inputs[file].name, text, &mut seen);
            let mut result = json!({
                "ruleId": d.code.number(),
                "ruleIndex": ALL.iter().position(|code| *code == d.code),
                "level": level(d.in_program()),
                "message": { "text": message(d) },
                "locations": [{ "physicalLocation": region(file, d.span) }],
                "partialFingerprints": { "macroglot/v1": key },
            });
            let steps: Vec<Value> = ways.from(d).iter().map(step).collect();
            if !steps.is_empty() {
                result["codeFlows"] = json!([{ "threadFlows": [{ "locations": steps }] }]);
            }
            if any_accepted {
                result["suppressions"] = d.accepted.as_ref().map_or(json!([]), |accepted| {
                    json!([{ "kind": "external", "status": "accepted", "justification": accepted.to_string() }])
                });
            }
            out.serialize_element(&result)?;
        }
    }
    Ok(())
}

/// What is the matter, and what to do about it.
fn message(finding: &Diagnostic) -> String {
    match &finding.help {
        Some(help) => format!("{}\n\n{help}", finding.message),
        None => finding.message.to_string(),
    }
}

/// What tells a finding from others and stays when lines are put before it: its code, its file, the text of its line, and
/// how many of the same came before.
fn fingerprint(finding: &Diagnostic, file: &str, text: &[u8], seen: &mut HashMap<String, usize>) -> String {
    let mut all = format!("{}\n{file}\n", finding.code.number()).into_bytes();
    all.extend_from_slice(text);
    let hash = sha256(&all);
    let count = seen.entry(hash.clone()).or_default();
    *count += 1;
    format!("{}:{count}", &hash[..32])
}

/// The jumps and calls of a program, found by their places: a program may have as many findings as letters.
struct Ways<'w> {
    part: &'w Part<'w>,
    program: usize,
    /// The blocks that jump to a written number, and those numbers, by the places of the blocks.
    jumps: BTreeMap<u32, (Span, u32)>,
    labels: HashMap<u32, Span>,
    calls: BTreeMap<u32, &'w Link>,
}

impl<'w> Ways<'w> {
    fn of(part: &'w Part<'w>, pairs: Option<&'w Pairs<'w>>, program: usize, links: &[&'w Link]) -> Self {
        let blocks = pairs.map_or(&[][..], |pairs| pairs.blocks(program));
        let mut labels = HashMap::new();
        for block in blocks {
            for item in &block.items {
                if let ItemKind::Sequence { number, .. } | ItemKind::Label(Label::Number(number)) = item.kind
                {
                    labels.entry(number).or_insert(block.span);
                }
            }
        }
        let jump = |block: &Block| Some((block.span.start, (block.span, target_of(block)?)));
        let jumps = blocks.iter().filter_map(jump).collect();
        let calls = links.iter().map(|link| (link.span.start, *link)).collect();
        Self { part, program, jumps, labels, calls }
    }

    /// The way from a jump to its label, or from a call to what keeps the called program from being converted; empty
    /// where the finding stands at neither.
    fn from(&self, finding: &Diagnostic) -> Vec<(usize, Span, &'static str)> {
        let (at, reports) = (finding.span.start, &self.part.conversion.programs);
        let file = reports[self.program].file;
        let call = self.calls.range(..=at).next_back().map(|(_, link)| *link);
        if let Some(Linked::Program { at: callee, .. }) =
            call.filter(|link| at < link.span.end).map(|link| &link.callee)
            && let Some(callee) = reports.get(*callee).filter(|_| *callee != self.program)
            && let Some(fault) = callee.diagnostics.iter().find(|d| d.severity() == Severity::Error)
        {
            let why = "why the called program is refused";
            return vec![(file, finding.span, "the call"), (callee.file, fault.span, why)];
        }
        let jump = self.jumps.range(..=at).next_back().map(|(_, jump)| *jump);
        let number = jump.filter(|(span, _)| at < span.end).map(|(_, number)| number);
        match number.and_then(|number| self.labels.get(&number)) {
            Some(label) => vec![(file, finding.span, "the jump"), (file, *label, "where it goes")],
            None => Vec::new(),
        }
    }
}

/// The number that a block jumps to, where it is written.
fn target_of(block: &Block) -> Option<u32> {
    let mut found = None;
    for_each_item(&block.items, &mut |item| match &item.kind {
        ItemKind::Goto(Target::Sequence(number))
        | ItemKind::Branch { target: Target::Sequence(number), .. } => {
            found = found.or(Some(*number));
        }
        _ => {}
    });
    found
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
