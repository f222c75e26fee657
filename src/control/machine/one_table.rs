//! Tables of tool offsets, where one of two machines has one number a row for lengths and radii.

use super::Machine;
use crate::canon::Sys;
use crate::control::scenario::{Scenario, SharedRows, Tool};
use crate::control::table::Table;
use crate::dialect::RowKind;

/// The table that a machine begins with: the number of a row is its length and its radius, whichever machine it is.
pub(super) fn tools(scenario: &Scenario) -> Table<Tool> {
    let mut tools = scenario.tools.clone();
    if let Some(shared) = &scenario.one_table {
        for tool in tools.values_mut() {
            *tool = Tool { length: tool.length, radius: tool.length / shared.per, ..Tool::default() };
        }
    }
    tools
}

impl Machine {
    /// What a write of the one number of a row is to a machine that holds lengths and radii apart, in millimetres.
    pub(super) fn apart(&self, state: Sys, row: u32, value: f64) -> (Sys, f64) {
        let shared = self.one_table.as_deref().filter(|_| state == Sys::ToolOffset);
        match shared.and_then(|shared| Some((shared.rows.kind(row)?, shared.per))) {
            Some((RowKind::Length, _)) => (Sys::LengthGeometry, value),
            Some((RowKind::Radius, per)) => (Sys::RadiusGeometry, value / per),
            None => (state, value),
        }
    }

    /// The table as a person could compare it with that of the other machine.
    pub(super) fn compared_tools(&self) -> Table<Tool> {
        let mut tools = self.tools.clone();
        let Some(SharedRows { per, rows }) = self.one_table.as_deref() else { return tools };
        for (row, tool) in tools.iter_mut() {
            if self.rules.shared_offsets {
                (tool.radius, tool.radius_wear) = (tool.length / per, 0.0);
            }
            match rows.kind(*row) {
                Some(RowKind::Length) => tool.radius = 0.0,
                Some(RowKind::Radius) => tool.length = 0.0,
                None => {}
            }
        }
        tools
    }
}
