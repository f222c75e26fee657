//! What a statement sets of the modal state.

use super::state::{DEFAULT_PLACES, State};
use crate::ir::analysis::dataflow::OneOf;
use crate::lower::common::{InForce, constant};
use crate::lower::fadal::codes::parametric;
use crate::syntax::{Index, ItemKind, SetOption, VarRef};

/// Runs an assignment, an input or a setting on the state.
pub fn statement(kind: &ItemKind, state: &mut State) {
    match kind {
        ItemKind::Assign { target, value, .. } => {
            let constant = constant(value).map(f64::to_bits);
            let copied = parametric(value).filter(|(_, minus)| !minus);
            let values = match (constant, copied) {
                (Some(bits), _) => OneOf::one(bits),
                (None, Some((number, _))) => state.r.get(number as usize).cloned().unwrap_or_else(OneOf::any),
                _ => OneOf::any(),
            };
            set(target, values, state);
        }
        ItemKind::Input { targets, .. } => {
            targets.iter().for_each(|target| set(target, OneOf::any(), state));
            state.moved = false;
        }
        ItemKind::Wait => state.moved = false,
        ItemKind::Set(options) => {
            if options.is_empty() {
                state.radians = InForce::one(false);
                state.places = InForce::one(DEFAULT_PLACES);
            }
            for option in options {
                match option {
                    SetOption::Degrees | SetOption::Radians => {
                        state.radians = InForce::one(*option == SetOption::Radians);
                    }
                    SetOption::Round(places) => state.places = InForce::one(*places),
                    SetOption::Debug | SetOption::Run => {}
                }
            }
        }
        _ => {}
    }
}

fn set(target: &VarRef, values: OneOf<u64>, state: &mut State) {
    if target.name != "R" {
        return;
    }
    match target.index {
        Index::Number(number) => {
            if let Some(slot) = state.r.get_mut(number as usize) {
                *slot = values;
            }
        }
        _ => state.r = std::array::from_fn(|_| OneOf::any()),
    }
}
