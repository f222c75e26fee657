//! What becomes of programs whose callees are not written.
//!
//! A program that the verifier finds different is withdrawn, and what calls it was verified with a text that is not
//! written: it is withdrawn too, and so on up. A program that was refused before was never there to be called: its
//! callers are reviewed, who may supply it, and their certificates say that they were not run with it.

use super::refused_calls::{Link, Linked};
use super::{Conversion, Outcome};
use crate::control::ProgramRef;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::dataflow::reached;
use crate::text::Span;
use crate::verify::{self, ProgramCertificate, Reason, Why};
use std::collections::{BTreeMap, BTreeSet};

/// Why a program is withdrawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Withdrawn {
    /// It differs.
    Differs,
    /// It calls this one, which is withdrawn.
    Calls(usize),
}

/// The calls of a library, and which of its programs are not written.
pub struct Callees {
    /// By index among the reports.
    pub withdrawn: BTreeMap<usize, Withdrawn>,
    names: Vec<String>,
    links: Vec<Link>,
    reports: BTreeMap<ProgramRef, usize>,
    refused: BTreeSet<usize>,
    /// Where each program begins, and what its runs came through.
    places: BTreeMap<usize, Span>,
    entered: BTreeMap<usize, BTreeSet<usize>>,
    /// By program, what calls it and where: by its name first, then by a computed number in some run.
    callers: BTreeMap<usize, Vec<(usize, Span)>>,
    /// By program, why its runs do not show what the library does.
    missing: BTreeMap<usize, BTreeSet<String>>,
}

/// The report of each program, where both sides cut its file alike.
pub fn programs_of(conversion: &Conversion, all: &[ProgramRef]) -> BTreeMap<ProgramRef, usize> {
    let mut by_file: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (at, program) in conversion.programs.iter().enumerate() {
        by_file.entry(program.file).or_default().push(at);
    }
    let pairs = by_file.into_iter().flat_map(|(file, reports)| {
        let sections: Vec<ProgramRef> = all.iter().filter(|program| program.file == file).copied().collect();
        let alike = sections.len() == reports.len();
        sections.into_iter().zip(reports).filter(move |_| alike)
    });
    pairs.collect()
}

/// The files besides the `named` ones whose conversions must stand where those of the named ones do: what they call and what
/// calls them, however far. A program that holds a copy of what it calls needs no other file.
pub fn linked_files(conversion: &Conversion, named: &[bool]) -> BTreeSet<usize> {
    let programs = &conversion.programs;
    let calls = |link: &Link| match link.callee {
        Linked::Program { at, made: false, .. } => Some((link.caller, at)),
        _ => None,
    };
    let calls: Vec<(usize, usize)> = conversion.links.iter().filter_map(calls).collect();
    let is_named = |at: &usize| named.get(programs[*at].file).is_none_or(|named| *named);
    let above = reached((0..programs.len()).filter(is_named), |at, go| {
        calls.iter().filter(|(_, callee)| *callee == at).for_each(|(caller, _)| go(*caller));
    });
    let all = reached(above, |at, go| {
        calls.iter().filter(|(caller, _)| *caller == at).for_each(|(_, callee)| go(*callee));
    });
    all.into_iter().filter(|at| !is_named(at)).map(|at| programs[at].file).collect()
}

impl Callees {
    /// The calls of a conversion, of whose programs some were `refused`.
    pub fn of(
        conversion: &Conversion,
        reports: BTreeMap<ProgramRef, usize>,
        refused: BTreeSet<usize>,
    ) -> Self {
        let name =
            |program: &super::ProgramReport| program.name.clone().unwrap_or_else(|| "a program".into());
        Self {
            withdrawn: BTreeMap::new(),
            names: conversion.programs.iter().map(name).collect(),
            links: conversion.links.clone(),
            reports,
            refused,
            places: BTreeMap::new(),
            entered: BTreeMap::new(),
            callers: BTreeMap::new(),
            missing: BTreeMap::new(),
        }
    }

    /// Takes note of what was found of a program, which begins at a place.
    pub fn look(&mut self, at: usize, place: Span, found: &ProgramCertificate) {
        if found.outcome == verify::Outcome::Different {
            self.withdrawn.insert(at, Withdrawn::Differs);
        }
        self.places.insert(at, place);
        let entered = found.entered.iter().filter_map(|program| self.reports.get(program).copied());
        self.entered.insert(at, entered.filter(|other| *other != at).collect());
    }

    /// Where a program begins.
    pub fn place(&self, at: usize) -> Span {
        self.places.get(&at).copied().unwrap_or_default()
    }

    /// Withdraws what calls a program that is withdrawn, until nothing more does.
    pub fn withdraw(&mut self) {
        self.callers = self.called_from();
        let differ: Vec<usize> = self.withdrawn.keys().copied().collect();
        reached(differ, |callee, go| {
            let callers = self.callers.get(&callee).into_iter().flatten();
            for (caller, _) in callers.filter(|(caller, _)| !self.refused.contains(caller)) {
                self.withdrawn.entry(*caller).or_insert(Withdrawn::Calls(callee));
                go(*caller);
            }
        });
        self.missing = self.find_missing();
    }

    fn called_from(&self) -> BTreeMap<usize, Vec<(usize, Span)>> {
        let mut callers: BTreeMap<usize, Vec<(usize, Span)>> = BTreeMap::new();
        for link in &self.links {
            if let Linked::Program { at, .. } = link.callee {
                callers.entry(at).or_default().push((link.caller, link.span));
            }
        }
        for link in self.links.iter().filter(|link| link.callee == Linked::Computed) {
            for callee in self.entered.get(&link.caller).into_iter().flatten() {
                callers.entry(*callee).or_default().push((link.caller, link.span));
            }
        }
        callers
    }

    /// Why a program's runs do not show what the library does: what it calls is not written.
    pub fn reasons(&self, at: usize, found: &mut ProgramCertificate) {
        let mut texts = BTreeSet::new();
        if let Some(Withdrawn::Calls(callee)) = self.withdrawn.get(&at) {
            texts.insert(format!(
                "it calls {}, which is withdrawn, so it is not written either",
                self.names[*callee]
            ));
        } else if !self.withdrawn.contains_key(&at) {
            texts.extend(self.missing.get(&at).into_iter().flatten().cloned());
        }
        for text in texts {
            found.reasons.push(Reason { why: Why::Callee, text });
            found.outcome = found.outcome.max(verify::Outcome::Undecided);
        }
    }

    /// What each program calls: by its name, or in some run.
    pub fn all(&self) -> BTreeMap<usize, BTreeSet<usize>> {
        let mut all = self.entered.clone();
        for link in &self.links {
            if let Linked::Program { at, .. } = link.callee {
                all.entry(link.caller).or_default().insert(at);
            }
        }
        all
    }

    /// What is not written and called from a program, or from what it calls. From each call of such a one upwards: so a
    /// library in which all is written is not walked.
    fn find_missing(&self) -> BTreeMap<usize, BTreeSet<String>> {
        let gone = |at: usize| self.refused.contains(&at) || self.withdrawn.contains_key(&at);
        let (mut faults, mut above) =
            (BTreeMap::<usize, Vec<_>>::new(), BTreeMap::<usize, Vec<usize>>::new());
        for link in &self.links {
            match &link.callee {
                Linked::Program { at, name, .. } if gone(*at) => {
                    faults.entry(link.caller).or_default().push(Some(name))
                }
                Linked::Program { at, .. } => above.entry(*at).or_default().push(link.caller),
                Linked::Computed if self.refused.is_empty() && self.withdrawn.is_empty() => {}
                Linked::Computed => faults.entry(link.caller).or_default().push(None),
            }
        }
        let mut missing: BTreeMap<usize, BTreeSet<String>> = BTreeMap::new();
        for (caller, callees) in faults {
            reached([caller], |at, go| {
                missing.entry(at).or_default().extend(callees.iter().map(|name| {
                    match name {
                        Some(name) => {
                            let by = if caller == at { "it" } else { &self.names[caller] };
                            format!("{by} calls {name}, which is refused: it was not run with that")
                        }
                        None => "the number of the called program is computed, and some programs of the \
                             library are refused"
                            .into(),
                    }
                }));
                // What is gone is not come through.
                above.get(&at).into_iter().flatten().for_each(|above| go(*above));
            });
        }
        missing
    }

    /// Says at each call of what is withdrawn why the caller is not written.
    pub fn tell(&self, conversion: &mut Conversion) {
        let mut told = BTreeSet::new();
        for callee in self.withdrawn.keys() {
            let name = &self.names[*callee];
            let what = format!(
                "calls {name}, which is withdrawn because its conversion differs from its \
                                source"
            );
            for (caller, span) in self.callers.get(callee).into_iter().flatten() {
                if self.withdrawn.contains_key(caller) && told.insert((*caller, *callee)) {
                    let program = &mut conversion.programs[*caller];
                    program.diagnostics.push(Diagnostic::new(Code::CalleeWithdrawn, *span, what.clone()));
                    program.outcome = Outcome::Refused;
                }
            }
        }
    }
}
