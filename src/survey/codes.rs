//! Codes of which a machine profile must say what the builder made of them.

use super::beside::{Beside, beside, most, switch};
use super::callers::{self, MayCall};
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
    /// These, by their places in the library.
    #[serde(skip)]
    pub of: BTreeSet<usize>,
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
    /// The programs of the library that it may call, for parameters of the control give such programs a code.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub calls: Vec<MayCall>,
}

/// True of a finding that waits for what a code does.
pub(super) fn asks_code(finding: &Diagnostic) -> bool {
    matches!(finding.asks.as_deref(), Some(Asks::Code { .. } | Asks::Output { .. }))
}

/// The code that a finding waits for, and what it is likely to do.
fn code_of(finding: &Diagnostic, input: &Input, source: &Control) -> Option<(String, Option<Op>)> {
    match finding.asks.as_deref()? {
        Asks::Code { code, op } => Some((code.to_string(), *op)),
        Asks::Output { op } => Some((switch(input, source, finding.span, *op)?, None)),
        _ => None,
    }
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
            if let Some((code, op)) = code_of(finding, &inputs[program.file], source) {
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
            of: all.iter().map(|(at, _)| *at).collect(),
            frees: frees.get(&code).copied().unwrap_or_default(),
            comment: most(all.iter().filter_map(|one| text(one)?.comment.clone())),
            block: all.first().and_then(text).map(|beside| beside.block.clone()).unwrap_or_default(),
            op: ops.get(&code).copied(),
            calls: callers::may_call(&code, inputs, source, programs),
            // What stands in the code's own name is no word of it.
            words: if ops.contains_key(&code) {
                Vec::new()
            } else {
                let letters = all.iter().filter_map(text).flat_map(|beside| beside.letters.iter().copied());
                let own = |letter: &char| code.split(' ').skip(1).any(|word| word.starts_with(*letter));
                letters.filter(|letter| !own(letter)).collect::<BTreeSet<_>>().into_iter().collect()
            },
            places,
            code,
        }
    });
    let mut asked: Vec<AskedCode> = asked.collect();
    asked.sort_by_key(|code| std::cmp::Reverse((code.frees, code.programs)));
    asked
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    /// An output is wired to something else on another machine, and a code of its builder may switch what it did.
    #[test]
    fn outputs_are_asked_by_the_code_that_switches_them() {
        let plain = "dialect = \"haas\"\nmachine = \"mill\"\n";
        let target = Control::from_profile("dialect = \"fanuc\"\nmachine = \"mill\"\n").unwrap();
        let text = "O1\nG21\nM59 P1134 (PROBE ON)\nG4 P1.\nM69 P1134\nM30\n";
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let source = Control::from_profile(plain).unwrap();
        let made = survey(&inputs, &source, Some(&target));
        assert_eq!((made.now.refused, made.answered.map(|then| then.refused)), (1, Some(0)));
        let asked = filled(&made, Side::Source, Some(plain)).unwrap();
        for line in [
            "#? \"M59 P1134\" = { target = \"\", text = \"PROBE ON\" } # a.nc:3; as in: M59 P1134 (PROBE ON)",
            "#? \"M69 P1134\" = { target = \"\" } # a.nc:5; as in: M69 P1134",
        ] {
            assert!(asked.lines().any(|found| found == line), "{line} in {asked}");
        }
        let answered = asked
            .replace("#? \"M59 P1134\" = { target = \"\"", "\"M59 P1134\" = { target = \"M62\"")
            .replace("#? \"M69 P1134\" = { target = \"\"", "\"M69 P1134\" = { target = \"M63\"");
        let (source, target) = Control::meeting(Control::from_profile(&answered).unwrap(), target).unwrap();
        assert_eq!(survey(&inputs, &source, Some(&target)).now.refused, 0);
    }
}
