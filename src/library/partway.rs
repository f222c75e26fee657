//! A library partway through the passes, for whoever wants to see what they do.

use super::Input;
use super::compile::context;
use super::prepare::{Prepared, prepare};
use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::Module;
use crate::ir::Var;
use crate::legalize::pipeline::{Broken, run_first};
use crate::legalize::{Locked, Modal, Register};
use crate::opt::Level;
use std::collections::BTreeMap;

/// A library after some passes.
#[derive(Clone, Debug)]
pub struct Partway {
    /// The programs.
    pub module: Module,
    /// What was found so far, by program of the source.
    pub found: Vec<Vec<Diagnostic>>,
    /// The register of each variable, if those were chosen by then.
    pub registers: BTreeMap<Var, Register>,
}

/// Takes a library through the first so many passes of [`crate::legalize::pipeline::GROUPS`], without a lock.
///
/// # Errors
/// In checked builds, the pass that broke the contract of the IR.
pub fn partway(
    inputs: &[Input],
    source: &Control,
    target: &Control,
    level: Level,
    count: usize,
) -> Result<Partway, Broken> {
    let Prepared { mut module, mut found, .. } = prepare(inputs, source, target);
    let mut context = context(&found, source, target, level, Locked::default(), Modal::unknown());
    run_first(count, &mut module, &mut context)?;
    let registers = std::mem::take(&mut context.registers).of;
    found.resize_with(module.programs.len().max(found.len()), Vec::new);
    found.iter_mut().zip(context.into_findings()).for_each(|(all, more)| super::compile::add_new(all, more));
    Ok(Partway { module, found, registers })
}
