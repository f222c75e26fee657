//! Calls of programs that are refused.
//!
//! Nothing is written for a refused program. What calls one that the source has by that number needs it on the target,
//! which a reviewer is told; what calls a copy that the conversion would have made of one is refused too, for nobody
//! else can supply that.

use crate::diag::{Code, Diagnostic, Severity};
use crate::ir::{Callee, Module, TermKind};
use crate::legalize::{Copied, calls_of, span_of};
use crate::syntax::ProgramName;
use crate::text::Span;
use foldhash::HashMap;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A call that the conversion of a program of the source makes.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The index of that program among the reports.
    pub caller: usize,
    /// What it calls.
    pub callee: Linked,
    /// Where the call stands in the source.
    pub span: Span,
}

/// What is called.
#[derive(Clone, Debug, PartialEq)]
pub enum Linked {
    /// A program of the library.
    Program {
        /// Its index among the reports.
        at: usize,
        /// Its name on the source, as it is written there.
        name: String,
        /// True where what is called is a copy that the conversion made of it.
        made: bool,
    },
    /// The program with a number that is known only when the program runs.
    Computed,
}

impl Link {
    /// The call of a program that the caller holds a copy of.
    pub(super) fn of_copy(Copied { caller, callee, span, name }: Copied) -> Self {
        Self { caller, callee: Linked::Program { at: callee, name, made: true }, span }
    }
}

/// The calls of a library; `origins` says of which program of the source each of its programs is a part.
pub(super) fn links(module: &Module, origins: &[usize]) -> Vec<Link> {
    let mut first = BTreeMap::new();
    origins.iter().enumerate().for_each(|(at, origin)| {
        first.entry(*origin).or_insert(at);
    });
    let names = module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.as_ref()?, at)));
    let by_name: HashMap<&ProgramName, usize> = names.collect();
    let linked = |name: &ProgramName, caller: usize| {
        let at = *by_name.get(name)?;
        let callee = *origins.get(at).filter(|callee| **callee != caller)?;
        let primary = first.get(&callee).copied().unwrap_or(at);
        let name = module.programs.get(primary)?.name.as_ref()?.short().into_owned();
        Some(Linked::Program { at: callee, name, made: primary != at })
    };
    let mut links = Vec::new();
    for (program, &caller) in module.programs.iter().zip(origins) {
        for block in &program.blocks {
            for call in calls_of(block) {
                let callee = match &call.callee {
                    Callee::Program(name) => linked(name, caller),
                    Callee::Computed(_) => Some(Linked::Computed),
                    Callee::Block(_) | Callee::Cycle(_) => None,
                };
                links.extend(callee.map(|callee| Link { caller, callee, span: span_of(block, call) }));
            }
            if let TermKind::Chain(name) = &block.term.kind {
                let span = block.term.site.span;
                links.extend(linked(name, caller).map(|callee| Link { caller, callee, span }));
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
    // A program may have many callers.
    let mut texts: BTreeMap<(usize, bool), Arc<str>> = BTreeMap::new();
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for link in links {
            let Linked::Program { at, name, made } = &link.callee else { continue };
            if !refused.contains(at) || !told.insert((link.caller, *at, *made)) {
                continue;
            }
            let what = texts.entry((*at, *made)).or_insert_with(|| match made {
                true => format!("calls a copy of {name}, which is refused").into(),
                false => {
                    format!("{name} is refused: put a program {name} that does the same on the target").into()
                }
            });
            let code = if *made { Code::NoEquivalent } else { Code::OutsideLibrary };
            changed |= *made && refused.insert(link.caller);
            found[link.caller].push(Diagnostic::new(code, link.span, Arc::clone(what)));
        }
    }
}
