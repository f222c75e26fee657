//! What a statement sets of the modal state.

use super::state::{DEFAULT_PLACES, State, Values};
use crate::lower::common::constant;
use crate::lower::fadal::codes::parametric;
use crate::syntax::{Index, ItemKind, SetOption, VarRef};

/// Runs an assignment, an input or a setting on the state.
pub fn statement(kind: &ItemKind, state: &mut State) {
    match kind {
        ItemKind::Assign { target, value, .. } => {
            let constant = constant(value).map(f64::to_bits);
            let copied = parametric(value).filter(|(_, minus)| !minus);
            let values = match (constant, copied) {
                (Some(bits), _) => Values::one(bits),
                (None, Some((number, _))) => {
                    state.r.get(number as usize).cloned().unwrap_or_else(Values::any)
                }
                _ => Values::any(),
            };
            set(target, values, state);
        }
        ItemKind::Input { targets, .. } => {
            targets.iter().for_each(|target| set(target, Values::any(), state));
            state.moved = false;
        }
        ItemKind::Wait => state.moved = false,
        ItemKind::Set(options) => {
            if options.is_empty() {
                state.radians = Values::one(false);
                state.radians_outside = false;
                state.places = Values::one(DEFAULT_PLACES);
                state.places_called = false;
            }
            for option in options {
                match option {
                    SetOption::Degrees | SetOption::Radians => {
                        state.radians = Values::one(*option == SetOption::Radians);
                        state.radians_outside = false;
                    }
                    SetOption::Round(places) => {
                        state.places = Values::one(*places);
                        state.places_called = false;
                    }
                    SetOption::Debug | SetOption::Run => {}
                }
            }
        }
        _ => {}
    }
}

fn set(target: &VarRef, values: Values<u64>, state: &mut State) {
    if target.name != "R" {
        return;
    }
    match target.index {
        Index::Number(number) => {
            if let Some(slot) = state.r.get_mut(number as usize) {
                *slot = values;
            }
        }
        _ => state.r = std::array::from_fn(|_| Values::any()),
    }
}
