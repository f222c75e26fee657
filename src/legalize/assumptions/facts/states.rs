//! Reads of places that the passes of lathes put in: which variable holds a state may be unconfirmed.

use super::Found;
use crate::canon::Sys;
use crate::dialect::Machine;
use crate::ir::Expr;
use crate::text::Span;

impl Found<'_> {
    /// The run that holds a state of a lathe; what the source's programs read was looked at before.
    pub(super) fn state(&mut self, state: Sys, subscripts: &[Expr], span: Span) {
        if self.control.machine() != Machine::Lathe {
            return;
        }
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
