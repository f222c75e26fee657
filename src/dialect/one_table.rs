//! Tables of a mill that have one number a row, for tool lengths and for cutter radii.

use super::{Control, Machine};
use crate::canon::Sys;

/// The settings that say which rows of such a table hold lengths, and which hold radii.
pub const TABLE_ROWS: [&str; 2] = ["setting.offset_lengths", "setting.offset_radii"];

/// Rows of a table, as runs with both ends among them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TableRows(Vec<(u32, u32)>);

impl TableRows {
    /// Reads `1-30, 41`; none if the text is no list of rows.
    pub fn parse(text: &str) -> Option<Self> {
        let parts = text.split([',', ' ']).filter(|part| !part.is_empty());
        let run = |part: &str| {
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            let run: (u32, u32) = (first.parse().ok()?, last.parse().ok()?);
            (run.0 >= 1 && run.0 <= run.1).then_some(run)
        };
        let runs = parts.map(run).collect::<Option<Vec<_>>>()?;
        (!runs.is_empty()).then_some(Self(runs))
    }

    /// True for one of the rows.
    pub fn contains(&self, row: u32) -> bool {
        self.0.iter().any(|(first, last)| (*first..=*last).contains(&row))
    }

    fn meets(&self, other: &Self) -> bool {
        let apart = |(a, b): (u32, u32), (c, d): (u32, u32)| b < c || d < a;
        self.0.iter().any(|own| other.0.iter().any(|there| !apart(*own, *there)))
    }
}

/// What a row of such a table holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    /// A tool length.
    Length,
    /// A cutter radius, or its diameter.
    Radius,
}

/// What the profile says of such a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OneTable {
    lengths: TableRows,
    radii: TableRows,
}

impl OneTable {
    /// Reads what the settings say; the text of the one that is wrong, and what is wrong with it.
    pub fn read([lengths, radii]: [Option<&str>; 2]) -> Result<Self, (usize, &'static str)> {
        let rows = |at: usize, text: Option<&str>| match text {
            Some(text) => TableRows::parse(text).ok_or((at, "write rows and runs of rows: 1-30, 41")),
            None => Ok(TableRows::default()),
        };
        let own = Self { lengths: rows(0, lengths)?, radii: rows(1, radii)? };
        if own.lengths.meets(&own.radii) {
            return Err((1, "a row holds a length or a radius: no row may stand in both lists"));
        }
        Ok(own)
    }

    /// What a row holds; none if the profile does not say it.
    pub fn kind(&self, row: u32) -> Option<RowKind> {
        match (self.lengths.contains(row), self.radii.contains(row)) {
            (true, _) => Some(RowKind::Length),
            (_, true) => Some(RowKind::Radius),
            _ => None,
        }
    }
}

impl Control {
    /// What is said of the table of a mill that has one number a row for lengths and radii; none if its table holds them apart.
    pub fn one_table(&self) -> Option<OneTable> {
        let has = |state| self.system_runs(state).next().is_some();
        if self.machine() != Machine::Mill || !has(Sys::ToolOffset) || has(Sys::LengthGeometry) {
            return None;
        }
        let settings = TABLE_ROWS.map(|name| self.setting(name));
        Some(OneTable::read(settings).unwrap_or_default())
    }

    /// True for a mill that holds lengths and radii apart, and whose programs can name both.
    pub fn holds_offsets_apart(&self) -> bool {
        let has_lengths = self.system_runs(Sys::LengthGeometry).next().is_some();
        self.machine() == Machine::Mill && has_lengths && self.one_table().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_runs_and_no_row_stands_in_both() {
        let table = OneTable::read([Some("1-30, 41"), Some("31-40 50")]);
        let kinds = table.map(|table| [1, 30, 31, 41, 45, 50].map(|row| table.kind(row)));
        let [length, radius] = [Some(RowKind::Length), Some(RowKind::Radius)];
        assert_eq!(kinds, Ok([length, length, radius, length, None, radius]));
        for wrong in ["", "0-4", "4-1", "a", "1-", "1--2"] {
            assert_eq!(OneTable::read([Some(wrong), None]).map_err(|(at, _)| at), Err(0), "{wrong}");
        }
        assert_eq!(OneTable::read([Some("1-30"), Some("30-40")]).map_err(|(at, _)| at), Err(1));
    }
}
