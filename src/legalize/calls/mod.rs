//! Calls, repeats and returns that the target can make.

pub(in crate::legalize) mod carried;
pub(in crate::legalize) mod chain;
mod defaults;
pub(in crate::legalize) mod inlined;
pub(in crate::legalize) mod jump_chains;
pub(in crate::legalize) mod link;
pub(in crate::legalize) mod main_returns;
pub(in crate::legalize) mod merged;
pub(in crate::legalize) mod modal_calls;
pub(in crate::legalize) mod modal_off;
pub(in crate::legalize) mod nesting;
pub(in crate::legalize) mod outline;
pub(in crate::legalize) mod parts;
pub(in crate::legalize) mod repeat_loops;
pub(in crate::legalize) mod repeats;
pub(in crate::legalize) mod standing;
pub(in crate::legalize) mod text_returns;

use crate::canon::{Op, Role};
use crate::dialect::Control;
use std::collections::BTreeMap;

/// True if a modal call can name a program, and not only a subroutine of the program that it stands in.
fn calls_programs(target: &Control) -> bool {
    let row = target.code_for(Op::CallModal, &BTreeMap::new());
    row.is_some_and(|row| row.words.values().any(|role| *role == Role::Program))
}
