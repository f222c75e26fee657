//! What holds of all holes of a program.

use super::drills;
use super::waits::names_offset;
use crate::canon::Role;
use crate::ir::{Expr, Program};
use crate::legalize::Modal;

/// What holds of all holes of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct All {
    /// The waits that are told, each once.
    pub dwells: Vec<Expr>,
    /// The pecks.
    pub pecks: Vec<Expr>,
    /// True where some hole has no peck.
    pub without_peck: bool,
    /// True where a letter that lasts across codes as the wait may have been told by another code.
    pub other_waits: bool,
    /// True where nothing of the library turns the spindle.
    pub stands: bool,
}

/// Looks at all holes of a program.
pub(super) fn all(program: &Program, states: &[Modal]) -> All {
    let mut all = All::default();
    let keep = |list: &mut Vec<Expr>, value: Option<&Expr>| {
        if let Some(value) = value.filter(|value| !list.contains(value)) {
            list.push(value.clone());
        }
    };
    for (block, state) in program.blocks.iter().zip(states) {
        let mut state = state.clone();
        for stmt in &block.stmts {
            state.step(stmt);
            let Some(nc) = stmt.kind.nc() else { continue };
            all.other_waits |= names_offset(nc);
            if drills(nc, &state).is_some() {
                keep(&mut all.dwells, nc.word(Role::CycleDwell));
                keep(&mut all.pecks, nc.word(Role::CycleQ));
                all.without_peck |= nc.word(Role::CycleQ).is_none();
            }
        }
    }
    all.dwells.retain(|dwell| dwell.constant() != Some(0.0));
    all
}
