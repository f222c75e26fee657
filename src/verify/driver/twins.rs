//! Literals at the heads of programs, and those of the target that are the same.

use super::summary::lacks_locals;
use super::verifier::Verifier;
use crate::control::ProgramRef;
use crate::dialect::Control;
use crate::syntax::{Expr, ExprKind, Item, ItemKind, VarRef};
use crate::text::Span;
use crate::verify::explore::ends_head;
use crate::verify::sides::{Job, Side, name_of, of_target};
use std::collections::BTreeSet;

/// Constants of a program that are edited, at the most.
const CONSTANTS: usize = 32;

/// Registers that are tried where the lock does not say which holds a constant, at the most.
const TWINS: usize = 4;

/// The first assignment of a variable, where it is a literal.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Constant {
    pub(super) name: String,
    pub(super) value: f64,
    pub(super) span: Span,
}

/// A literal of the source, and the one of the target that is the same.
#[derive(Clone, Debug)]
pub(super) struct Twins {
    pub(super) ours: Constant,
    /// The program of the target that has it.
    pub(super) part: ProgramRef,
    pub(super) theirs: Constant,
    /// True if the lock has named its register: then a difference counts.
    pub(super) is_named: bool,
}

impl Verifier<'_, '_> {
    /// The constants at the head, each with those of the target that may be the same.
    pub(super) fn all_twins(&self, there: ProgramRef) -> Vec<(Constant, Vec<Twins>)> {
        let Job { source, target, names, .. } = self.job;
        // What the source calls by a block number of its own may be a program of its own there.
        let others = of_target(self.job, self.program).into_iter().filter(|part| *part != there);
        let parts = std::iter::once(there).chain(others);
        let theirs: Vec<(ProgramRef, Constant)> = parts
            .flat_map(|part| constants(target, part, false).into_iter().map(move |twin| (part, twin)))
            .collect();
        let of = |constant: &Constant| {
            let named = names.variable(&constant.name, source.control, target.control);
            let (is_named, alike) = (named.is_some(), |twin: &Constant| twin.value == constant.value);
            let found: Vec<&(ProgramRef, Constant)> = match named {
                Some(named) => {
                    let twin = theirs.iter().find(|(_, twin)| twin.name == named);
                    twin.filter(|(_, twin)| alike(twin)).into_iter().collect()
                }
                // The registers of locals have no names in the lock: each that has the value may be it.
                None if lacks_locals(self.job) => {
                    let held = |twin: &Constant| names.of_source(&twin.name, source.control, target.control);
                    let unnamed = theirs.iter().filter(|(_, twin)| alike(twin) && held(twin).is_none());
                    unnamed.take(TWINS).collect()
                }
                None => Vec::new(),
            };
            let twins = |(part, theirs): &(ProgramRef, Constant)| Twins {
                ours: constant.clone(),
                part: *part,
                theirs: theirs.clone(),
                is_named,
            };
            found.into_iter().map(twins).collect::<Vec<_>>()
        };
        let all = constants(source, self.program, true).into_iter().take(CONSTANTS);
        all.map(|constant| (constant.clone(), of(&constant))).filter(|(_, found)| !found.is_empty()).collect()
    }
}

/// The variables whose first assignment in a program's text is a literal; of a head, those before anything can branch.
pub(super) fn constants(side: &Side<'_>, program: ProgramRef, head: bool) -> Vec<Constant> {
    let (mut written, mut found) = (BTreeSet::new(), Vec::new());
    for block in side.text(program) {
        let skipped = block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_)));
        for item in &block.items {
            if head && ends_head(item) {
                return found;
            }
            for (name, value) in writes(item, side.control) {
                // What may be anything may be this variable.
                let Some(name) = name else { return found };
                let first = written.insert(name.clone());
                if let Some(value) = value.filter(|_| first && !skipped)
                    && let Some(number) = literal(value)
                {
                    found.push(Constant { name, value: number, span: value.span });
                }
            }
        }
    }
    found
}

/// What an item writes: the variable's name where that is written, and the value where it is an assignment for sure.
fn writes<'t>(item: &'t Item, control: &Control) -> Vec<(Option<String>, Option<&'t Expr>)> {
    let name_of = |variable: &VarRef| name_of(variable, control);
    match &item.kind {
        ItemKind::Assign { target, value, by_sign: false } => vec![(name_of(target), Some(value))],
        ItemKind::Assign { target, .. } | ItemKind::Step { target, .. } | ItemKind::Timer(target) => {
            vec![(name_of(target), None)]
        }
        ItemKind::Input { targets, .. } => targets.iter().map(|target| (name_of(target), None)).collect(),
        ItemKind::Transfer { cells, .. } => {
            cells.iter().filter(|cell| !cell.store).map(|cell| (name_of(&cell.variable), None)).collect()
        }
        ItemKind::If { body, .. } => {
            body.iter().flat_map(|item| writes(item, control)).map(|(name, _)| (name, None)).collect()
        }
        _ => Vec::new(),
    }
}

fn literal(e: &Expr) -> Option<f64> {
    match &e.kind {
        ExprKind::Number(number) => Some(number.value),
        ExprKind::Negate(inner) => match &inner.kind {
            ExprKind::Number(number) => Some(-number.value),
            _ => None,
        },
        _ => None,
    }
}
