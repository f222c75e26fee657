//! Faults of programs that a control takes all the same.
//!
//! A rule looks at a library that was lowered and that no pass has changed. It asks the common form and the tables, so one
//! rule serves all dialects. It never changes the outcome of a conversion.

mod looked;

pub use looked::{Findings, Looked};

use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::Module;
use crate::library::Input;

/// One rule.
pub struct Rule {
    /// What it finds.
    pub code: Code,
    /// Whether it runs where nobody asks for it by name.
    pub on: bool,
    run: fn(&Looked<'_>, &mut Findings),
}

/// All rules, in the order of their codes.
pub const RULES: &[Rule] = &[];

/// Finds what the wanted rules find: each finding with the index of its file among the inputs, in the order of files,
/// places and codes.
pub fn lint(
    inputs: &[Input],
    control: &Control,
    module: &Module,
    wanted: &dyn Fn(Code) -> bool,
) -> Vec<(usize, Diagnostic)> {
    let looked = Looked::new(inputs, control, module);
    let mut findings = Findings::default();
    RULES.iter().filter(|rule| wanted(rule.code)).for_each(|rule| (rule.run)(&looked, &mut findings));
    findings.sorted()
}
