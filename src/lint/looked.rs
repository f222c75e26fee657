//! What rules see, and where they put what they find.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::Module;
use crate::library::Input;
use crate::text::Span;
use std::sync::Arc;

/// A library as rules see it: lowered, not changed by any pass.
pub struct Looked<'a> {
    /// The files.
    pub inputs: &'a [Input],
    /// Their control.
    pub control: &'a Control,
    /// All programs.
    pub module: &'a Module,
}

impl<'a> Looked<'a> {
    /// Looks at a library.
    pub fn new(inputs: &'a [Input], control: &'a Control, module: &'a Module) -> Self {
        Self { inputs, control, module }
    }
}

/// What rules found.
#[derive(Default)]
pub struct Findings {
    all: Vec<(usize, Diagnostic)>,
}

impl Findings {
    /// Adds a finding in a file.
    pub fn add(&mut self, file: usize, code: Code, span: Span, message: impl Into<Arc<str>>) {
        self.all.push((file, Diagnostic::new(code, span, message)));
    }

    /// All of them, in the order of files, places and codes, each once.
    pub(super) fn sorted(mut self) -> Vec<(usize, Diagnostic)> {
        let key = |(file, found): &(usize, Diagnostic)| (*file, found.span.start, found.span.end, found.code);
        self.all.sort_by_key(key);
        self.all.dedup_by(|a, b| key(a) == key(b) && a.1.message == b.1.message);
        self.all
    }
}
