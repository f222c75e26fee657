//! Where the control keeps the state of the machine.

use super::{Control, SystemVariable};
use crate::canon::Sys;

impl Control {
    /// What a system variable is, with the subscripts that its number stands for.
    pub fn read_system(&self, name: &str, number: Option<u32>) -> Option<(Sys, Vec<u32>, &SystemVariable)> {
        let holds = |first: u32, last: u32| number.is_none_or(|n| (first..=last).contains(&n));
        let rows = self.system.get(name)?.iter().filter(|(_, first, last)| holds(*first, *last));
        rows.filter_map(|(at, ..)| self.dialect.system.get(*at)).find_map(|row| {
            let subscripts = match number {
                Some(number) => row.subscripts_of(number)?,
                None if row.first.is_none() => [row.fixed.as_slice(), &row.after].concat(),
                None => return None,
            };
            Some((row.state, subscripts, row))
        })
    }

    /// The setting, and its value, under which a number would be a system variable, where it is none as the control is set;
    /// true where the profile says another value.
    pub fn system_under(&self, name: &str, number: u32) -> Option<(&str, &str, bool)> {
        let rows = self.dialect.other_system.iter();
        let rows = rows.filter(|row| row.name == name && row.subscripts_of(number).is_some());
        let open = rows.filter_map(|row| {
            let (setting, value) = self.first_open(row.when.as_deref()?)?;
            let profile = self.profile();
            let stated = match setting.split_once('.') {
                Some(("parameter", short)) => profile.parameters.contains_key(short),
                Some(("setting", short)) => profile.settings.contains_key(short),
                _ => false,
            };
            Some((setting, value, stated))
        });
        open.min_by_key(|(.., stated)| *stated)
    }

    /// As [`Control::read_system`], of all numbers of a name up to a last one: in one walk over the rows.
    pub fn read_all_system(&self, name: &str, last: u32) -> Vec<Option<(Sys, Vec<u32>, &SystemVariable)>> {
        let mut all = vec![None; last as usize + 1];
        for (at, first, end) in self.system.get(name).into_iter().flatten() {
            let Some(row) = self.dialect.system.get(*at) else { continue };
            for number in *first..=last.min(*end) {
                // The first row that has the number counts.
                if let Some(slot @ None) = all.get_mut(number as usize) {
                    *slot = row.subscripts_of(number).map(|subscripts| (row.state, subscripts, row));
                }
            }
        }
        all
    }

    /// Where what a number means may change: between two of these numbers, only variables of the system differ.
    pub fn numbered_bounds(&self) -> Vec<u32> {
        let Some(name) = self.numbered() else { return Vec::new() };
        let classes = self.classes().iter().filter(|row| row.name == name).map(|row| (row.first, row.last));
        let states = self.system.get(name).into_iter().flatten().map(|(_, first, last)| (*first, *last));
        let reserved = self.reserved.iter().map(|run| (run.first, run.last));
        let same = self.dialect().same_cells.iter().filter(|row| row.name == name);
        let same = same.map(|row| (row.first, row.last));
        let runs = classes.chain(states).chain(reserved).chain(same);
        let bounds: Vec<u32> = runs.flat_map(|(first, last)| [first, last.saturating_add(1)]).collect();
        // What is counted as the number of a cell may be written with the second number.
        let second = self.dialect().same_cells.iter().filter_map(|row| row.first.checked_sub(row.cell));
        let second = second.flat_map(|apart| bounds.iter().filter_map(move |bound| bound.checked_sub(apart)));
        second.chain(bounds.iter().copied()).collect()
    }

    /// True if a row of the system's begins at or before a number, and ends at or after it.
    pub fn holds_states(&self, number: u32) -> bool {
        let runs = self.numbered().and_then(|name| self.system.get(name)).into_iter().flatten();
        runs.into_iter().any(|(_, first, last)| (*first..=*last).contains(&number))
    }

    /// A system variable by its fixed name: `_EMPTY`.
    pub fn system_named(&self, alias: &str) -> Option<&SystemVariable> {
        self.dialect
            .system
            .iter()
            .find(|row| row.alias.as_deref().is_some_and(|name| name.eq_ignore_ascii_case(alias)))
    }

    /// The number of the system variable with a fixed name and a subscript: `_ABSIO[1]`, `_WZG55[1]`.
    pub fn number_named(&self, name: &str, subscript: u32) -> Option<u32> {
        // A run over the axes of a machine is a row an axis: the first of them has the first number.
        let rows = self.dialect.system.iter().filter(|row| row.run_named(name).is_some());
        let row = rows.min_by_key(|row| row.first)?;
        let (outer, inner) = row.run_named(name)?;
        let at = subscript.checked_sub(row.subscripts.get(inner).map_or(1, |inner| inner.from))?;
        let number = row.first?.checked_add(outer)?.checked_add(at)?;
        let (.., found) = self.read_system(&row.name, Some(number))?;
        (found.alias == row.alias).then_some(number)
    }

    /// The variable that holds a state: its name, and its number where it has one.
    pub fn system_address(
        &self,
        state: Sys,
        subscripts: &[u32],
    ) -> Option<(&str, Option<u32>, &SystemVariable)> {
        self.system_runs(state).find_map(|row| Some((row.name.as_str(), row.number_of(subscripts)?, row)))
    }

    /// The first run of variables that holds a state, for subscripts that are computed.
    pub fn system_run(&self, state: Sys) -> Option<&SystemVariable> {
        self.system_runs(state).next()
    }

    /// All runs of variables that hold a state.
    pub fn system_runs(&self, state: Sys) -> impl Iterator<Item = &SystemVariable> {
        self.states.get(&state).into_iter().flatten().filter_map(|&at| self.dialect.system.get(at))
    }
}
