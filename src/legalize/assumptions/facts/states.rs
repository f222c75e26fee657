//! Reads of the machine's state that passes put in: which variable holds a state may be unconfirmed.

use super::Found;
use crate::canon::Sys;
use crate::ir::Expr;
use crate::text::Span;

impl Found<'_> {
    /// The run that holds a state of the machine.
    pub(super) fn state(&mut self, state: Sys, subscripts: &[Expr], span: Span) {
        let all: Option<Vec<u32>> =
            subscripts.iter().map(|e| e.constant().filter(|n| *n >= 0.0).map(|n| n as u32)).collect();
        let row = match all {
            Some(all) => self.control.system_address(state, &all).map(|(_, _, row)| row),
            None => self.control.system_run(state),
        };
        if let Some(row) = row {
            self.row(row, span);
        }
    }
}
