//! A conversion as SARIF 2.1.0, which code hosts show beside the lines.

use super::Part;
use crate::diag::{ALL, Code, Diagnostic, Severity};
use crate::library::{Link, Linked, Pairs, with_pairs};
use crate::syntax::{Block, ItemKind, Label, Target, for_each_item};
use crate::text::{CodePoints, Span, json_pretty};
use crate::verify::sha256;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
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
            "help": { "text": code.page(), "markdown": code.page() },
            "defaultConfiguration": { "level": level(code.severity()) },
        })
    };
    ALL.iter().map(rule).collect()
}

fn results(part: &Part<'_>) -> Vec<Value> {
    let any = part.conversion.programs.iter().any(|program| !program.diagnostics.is_empty());
    let controls = (part.controls[0], part.controls[1]);
    let read =
        any.then(|| with_pairs(part.inputs, part.conversion, controls, |pairs| all(part, Some(pairs))));
    read.flatten().unwrap_or_else(|| all(part, None))
}

fn all(part: &Part<'_>, pairs: Option<&Pairs<'_>>) -> Vec<Value> {
    let indexes: Vec<CodePoints> = part.inputs.iter().map(|input| CodePoints::new(&input.bytes)).collect();
    let lines = part.indexes();
    let mut links: HashMap<usize, Vec<&Link>> = HashMap::new();
    part.conversion.links.iter().for_each(|link| links.entry(link.caller).or_default().push(link));
    // How often a fingerprint came before in the same file.
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut out = Vec::new();
    for (at, program) in part.conversion.programs.iter().enumerate() {
        let file = program.file;
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
        let ways = Ways::of(part, pairs, at, links.get(&at).map_or(&[], Vec::as_slice));
        for d in &program.diagnostics {
            let text = part.place(file, &lines[file], d).text.trim_ascii();
            let key = fingerprint(d, &part.inputs[file].name, text, &mut seen);
            let mut result = json!({
                "ruleId": d.code.number(),
                "ruleIndex": ALL.iter().position(|code| *code == d.code),
                "level": level(d.severity()),
                "message": { "text": message(d) },
                "locations": [{ "physicalLocation": region(file, d.span) }],
                "partialFingerprints": { "macroglot/v1": key },
            });
            let way = ways.from(d);
            if !way.is_empty() {
                let step = |(file, span, text): &(usize, Span, &str)| json!({ "location": { "physicalLocation": region(*file, *span), "message": { "text": text } } });
                let steps: Vec<Value> = way.iter().map(step).collect();
                result["codeFlows"] = json!([{ "threadFlows": [{ "locations": steps }] }]);
            }
            out.push(result);
        }
    }
    out
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
    blocks: &'w [Block],
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
        let calls = links.iter().map(|link| (link.span.start, *link)).collect();
        Self { part, program, blocks, labels, calls }
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
        let next = self.blocks.partition_point(|block| block.span.start <= at);
        let block = next.checked_sub(1).map(|block| &self.blocks[block]).filter(|block| at < block.span.end);
        match block.and_then(target_of).and_then(|number| self.labels.get(&number)) {
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
