//! Arguments of programs that are not in the library: which of them some call may not give.
//!
//! What such a program asks nobody knows here. So an argument has a flag wherever one call may leave it vacant, or does
//! not name it, and no flag where every call gives it a number.

use super::marks::Names;
use crate::ir::analysis::Holds;
use crate::ir::{Argument, Call, Callee, Expr};
use crate::syntax::ProgramName;
use std::collections::BTreeMap;

/// What all calls of such programs give.
#[derive(Default)]
pub(super) struct Outside {
    /// By program, how many calls there are.
    calls: BTreeMap<ProgramName, usize>,
    /// By program and local, how many calls give it a number for sure.
    sure: BTreeMap<ProgramName, BTreeMap<u32, usize>>,
}

impl Outside {
    /// Notes a call, if it is one of a program outside the library that opens a level.
    pub fn note(&mut self, call: &Call, names: &Names, may: Holds<'_, Expr>) -> bool {
        let Callee::Program(name) = &call.callee else { return false };
        if !call.level || names.find(name).is_some() {
            return false;
        }
        *self.calls.entry(name.clone()).or_default() += 1;
        let sure = self.sure.entry(name.clone()).or_default();
        for argument in &call.arguments {
            let given = sure.entry(argument.local).or_default();
            let counts = given_by(call, argument.local).is_some_and(|last| std::ptr::eq(last, argument));
            *given += usize::from(counts && !may(&argument.value));
        }
        true
    }

    /// The locals that need a flag in each call of this program.
    pub fn flagged(&self, call: &Call) -> Vec<u32> {
        let Callee::Program(name) = &call.callee else { return Vec::new() };
        let Some(calls) = self.calls.get(name).filter(|_| call.level) else { return Vec::new() };
        let sure = self.sure.get(name).into_iter().flatten();
        sure.filter(|(_, given)| *given < calls).map(|(local, _)| *local).collect()
    }
}

/// The argument of a local, the last one where several give it.
pub(super) fn given_by(call: &Call, local: u32) -> Option<&Argument> {
    call.arguments.iter().rfind(|argument| argument.local == local)
}
