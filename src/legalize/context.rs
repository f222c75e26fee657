//! What every pass is given: both controls, and a place for what it finds.

use super::Modal;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::text::Span;
use std::collections::BTreeSet;

/// The controls of a conversion and the findings so far.
pub struct Context<'a> {
    /// The control the programs were written for.
    pub source: &'a Control,
    /// The control they are to run on.
    pub target: &'a Control,
    /// The modal state in which a program starts that nothing in the library calls.
    pub entry: Modal,
    /// For each program the one of the source that it comes from: passes add programs.
    pub origins: Vec<usize>,
    findings: Findings,
}

#[derive(Debug, Default)]
struct Findings {
    by_program: Vec<Vec<Diagnostic>>,
    said: BTreeSet<(usize, String)>,
}

impl<'a> Context<'a> {
    /// A context without findings, for a library of so many programs.
    pub fn new(source: &'a Control, target: &'a Control, programs: usize) -> Self {
        let findings = Findings { by_program: vec![Vec::new(); programs], said: BTreeSet::new() };
        Self { source, target, entry: Modal::unknown(), origins: (0..programs).collect(), findings }
    }

    /// Adds a finding to a program.
    pub fn add(&mut self, program: usize, diagnostic: Diagnostic) {
        let origin = self.origins.get(program).copied().unwrap_or(program);
        if let Some(findings) = self.findings.by_program.get_mut(origin) {
            findings.push(diagnostic);
        }
    }

    /// Adds a finding unless the program has one about the same `fact` already: what
    /// a reviewer must check once is said once.
    pub fn add_once(&mut self, program: usize, fact: &str, diagnostic: Diagnostic) {
        let origin = self.origins.get(program).copied().unwrap_or(program);
        if self.findings.said.insert((origin, fact.to_owned())) {
            self.add(program, diagnostic);
        }
    }

    /// Adds, once a program, that it rests on an unconfirmed fact.
    pub fn unconfirmed(&mut self, program: usize, span: Span, fact: &str, what: impl Into<String>) {
        self.add_once(program, fact, Diagnostic::new(Code::UnconfirmedFact, span, what));
    }

    /// What was found, by program of the source.
    pub fn into_findings(self) -> Vec<Vec<Diagnostic>> {
        self.findings.by_program
    }
}
