//! Calls of programs that are refused.
//!
//! Nothing is written for a refused program. What calls one that the source has by that number needs it on the target,
//! which a reviewer is told; what calls a copy that the conversion would have made of one is refused too, for nobody
//! else can supply that.

use crate::diag::{Code, Diagnostic, Severity};
use crate::ir::{Callee, Module};
use crate::legalize::{calls_of, span_of};
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A call between two programs of the source, by what either became.
pub(super) struct Link {
    caller: usize,
    callee: usize,
    /// The callee's name on the source, as it is written there.
    name: String,
    /// True where what is called is a copy or a part of it.
    made: bool,
    span: Span,
}

/// The calls of a library; `origins` says of which program of the source each of its programs is a part.
pub(super) fn links(module: &Module, origins: &[usize]) -> Vec<Link> {
    let mut first = BTreeMap::new();
    origins.iter().enumerate().for_each(|(at, origin)| {
        first.entry(*origin).or_insert(at);
    });
    let names = module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.as_ref()?, at)));
    let by_name: BTreeMap<&ProgramName, usize> = names.collect();
    let mut links = Vec::new();
    for (program, &caller) in module.programs.iter().zip(origins) {
        for block in &program.blocks {
            for call in calls_of(block) {
                let Callee::Program(name) = &call.callee else { continue };
                let Some(&at) = by_name.get(name) else { continue };
                let Some(&callee) = origins.get(at).filter(|callee| **callee != caller) else { continue };
                let primary = first.get(&callee).copied().unwrap_or(at);
                let name = match module.programs.get(primary).and_then(|program| program.name.as_ref()) {
                    Some(ProgramName::Number(number)) => format!("O{number}"),
                    Some(ProgramName::Name(name)) => name.clone(),
                    None => continue,
                };
                links.push(Link { caller, callee, name, made: primary != at, span: span_of(block, call) });
            }
        }
    }
    links
}

/// Says what calls a refused program, until nothing more is refused for it.
pub(super) fn report(links: &[Link], found: &mut [Vec<Diagnostic>]) {
    let is_error = |d: &Diagnostic| d.code.severity() == Severity::Error;
    let mut refused: BTreeSet<usize> =
        (0..found.len()).filter(|at| found[*at].iter().any(is_error)).collect();
    if refused.is_empty() {
        return;
    }
    let mut told = BTreeSet::new();
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for link in links {
            if !refused.contains(&link.callee) || !told.insert((link.caller, link.callee, link.made)) {
                continue;
            }
            let Link { name, span, .. } = link;
            let (code, what) = if link.made {
                changed |= refused.insert(link.caller);
                (Code::NoEquivalent, format!("calls a copy of {name}, which is refused"))
            } else {
                let what = format!(
                    "{name} is refused: the target needs a program of that number that does the same"
                );
                (Code::OutsideLibrary, what)
            };
            found[link.caller].push(Diagnostic::new(code, *span, what));
        }
    }
}
