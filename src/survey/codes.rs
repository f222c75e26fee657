//! Codes of which a machine profile must say what the builder made of them.

use super::beside::{Beside, beside, most};
use super::shape::{NAMED, Places};
use crate::canon::Op;
use crate::diag::{Asks, Diagnostic, Severity};
use crate::dialect::Control;
use crate::library::{Input, Outcome, ProgramReport};
use crate::text::Span;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// A code of which a machine profile must say what the builder made of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AskedCode {
    /// The code: `M14`.
    pub code: String,
    /// How many programs have it.
    pub programs: usize,
    /// How many of them are refused for nothing else.
    pub frees: usize,
    /// The first places, as `file:line`.
    pub places: Vec<String>,
    /// The comment that stands beside it most often, and how often.
    pub comment: Option<(String, usize)>,
    /// The first block that has it.
    pub block: String,
    /// The letters that stand with it in blocks of its own: its words, as far as one can see.
    pub words: Vec<char>,
    /// What it is likely to do, where a word of the builder stands beside a code of the control: `M3 P11`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub op: Option<Op>,
}

/// True of a finding that waits for what a code does.
pub(super) fn asks_code(finding: &Diagnostic) -> bool {
    matches!(finding.asks.as_deref(), Some(Asks::Code { .. }))
}

/// The codes that programs wait for; what frees most programs is first.
pub(super) fn asked(
    inputs: &[Input],
    lines: &Places<'_>,
    source: &Control,
    programs: &[ProgramReport],
) -> Vec<AskedCode> {
    let mut found: BTreeMap<String, Vec<(usize, Span)>> = BTreeMap::new();
    let mut frees: BTreeMap<String, usize> = BTreeMap::new();
    let mut ops: BTreeMap<String, Op> = BTreeMap::new();
    for (at, program) in programs.iter().enumerate() {
        let mut asks = BTreeSet::new();
        for finding in &program.diagnostics {
            if let Some(Asks::Code { code, op }) = finding.asks.as_deref() {
                let code = code.to_string();
                ops.extend(op.map(|op| (code.clone(), op)));
                found.entry(code.clone()).or_default().push((at, finding.span));
                asks.insert(code);
            }
        }
        let other =
            |finding: &&crate::diag::Diagnostic| finding.severity() == Severity::Error && !asks_code(finding);
        let alone = !program.diagnostics.iter().any(|finding| other(&finding));
        if let (Some(code), true) = (asks.pop_first(), alone && program.outcome == Outcome::Refused)
            && asks.is_empty()
        {
            *frees.entry(code).or_default() += 1;
        }
    }
    let file = |at: &usize| programs[*at].file;
    // Each file is read once.
    let mut spans: BTreeMap<usize, Vec<Span>> = BTreeMap::new();
    for (at, span) in found.values().flatten() {
        spans.entry(file(at)).or_default().push(*span);
    }
    let mut texts: BTreeMap<(usize, u32), Beside> = BTreeMap::new();
    for (file, spans) in &spans {
        let looked = beside(&inputs[*file], source, spans);
        texts.extend(spans.iter().map(|span| (*file, span.start)).zip(looked));
    }
    let asked = found.into_iter().map(|(code, all)| {
        let text = |(at, span): &(usize, Span)| texts.get(&(file(at), span.start));
        let mut places: Vec<String> = Vec::new();
        for (at, span) in &all {
            if places.len() == NAMED {
                break;
            }
            let place = lines.at(file(at), *span);
            if !places.contains(&place) {
                places.push(place);
            }
        }
        AskedCode {
            programs: all.iter().map(|(at, _)| at).collect::<BTreeSet<_>>().len(),
            frees: frees.get(&code).copied().unwrap_or_default(),
            comment: most(all.iter().filter_map(|one| text(one)?.comment.clone())),
            block: all.first().and_then(text).map(|beside| beside.block.clone()).unwrap_or_default(),
            op: ops.get(&code).copied(),
            // What stands in the code's own name is no word of it.
            words: if ops.contains_key(&code) {
                Vec::new()
            } else {
                let letters = all.iter().filter_map(text).flat_map(|beside| beside.letters.iter().copied());
                letters.collect::<BTreeSet<_>>().into_iter().collect()
            },
            places,
            code,
        }
    });
    let mut asked: Vec<AskedCode> = asked.collect();
    asked.sort_by_key(|code| std::cmp::Reverse((code.frees, code.programs)));
    asked
}
