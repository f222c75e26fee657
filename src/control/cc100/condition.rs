//! The condition register: the sign of the last result.

use crate::control::trace::Trace;
use crate::dialect::Question;
use crate::syntax::BinaryOp;

/// The register. Arithmetic, INC, DEC and TST set it; whether a plain load or a function does
/// is not stated, so both readings are kept until one matters.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Condition {
    result: Option<f64>,
    loaded: Option<f64>,
}

impl Condition {
    /// A result that sets the register.
    pub fn set(&mut self, result: f64) {
        *self = Condition { result: Some(result), loaded: None };
    }

    /// A load, or a function, which may set it.
    pub fn load(&mut self, value: f64) {
        self.loaded = Some(value);
    }

    /// Whether the register stands in a relation to zero.
    pub fn holds(&self, relation: BinaryOp, trace: &mut Trace) -> bool {
        let result = self.result.unwrap_or_else(|| {
            trace.doubt("machine:condition.at.start");
            0.0
        });
        let holds = stands(result, relation);
        trace.compared(result, 0.0, holds);
        if self.loaded.is_some_and(|loaded| stands(loaded, relation) != holds) {
            trace.doubt(Question::LoadSetsCondition.fact());
        }
        holds
    }
}

fn stands(value: f64, relation: BinaryOp) -> bool {
    match relation {
        BinaryOp::Equal => value == 0.0,
        BinaryOp::NotEqual => value != 0.0,
        BinaryOp::Less => value < 0.0,
        BinaryOp::LessEqual => value <= 0.0,
        BinaryOp::Greater => value > 0.0,
        BinaryOp::GreaterEqual => value >= 0.0,
        _ => false,
    }
}
