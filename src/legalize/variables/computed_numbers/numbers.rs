//! What both controls mean by the numbers of variables.

use super::Finding;
use super::alike::{Run, compared};
use super::meaning::{Meaning, meaning};
use super::shift::walks;
use crate::canon::Sys;
use crate::dialect::{Control, SystemVariable};
use crate::ir::analysis;
use crate::ir::eval::whole;
use crate::ir::{Expr, constant_part};
use crate::legalize::offsets::position_length;
use crate::legalize::variables::state::{SCALED, tables_differ};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// Numbers of axes repeat at this distance.
const GAP: u32 = 20;

/// What both controls mean by the numbers of variables.
pub(super) struct Numbers<'c> {
    source: &'c Control,
    target: &'c Control,
    table: Table,
    /// By the constant part of a number.
    known: BTreeMap<u32, Finding>,
}

/// What is known of all numbers of two controls.
pub(super) type Table = Arc<Compared>;

/// How two controls compare, each part made when it is first asked for: most programs compute no number.
#[derive(Debug, Default)]
pub(super) struct Compared {
    alike: OnceLock<Vec<Run>>,
    runs: OnceLock<Vec<(u32, u32)>>,
    listed: OnceLock<analysis::Numbers>,
}

impl<'c> Numbers<'c> {
    /// `table` is of the same two controls.
    pub(super) fn new(source: &'c Control, target: &'c Control, table: Table) -> Self {
        Self { source, target, table, known: BTreeMap::new() }
    }

    fn table(&self) -> &[Run] {
        self.table.alike.get_or_init(|| compared(self.source, self.target))
    }

    /// The runs of the table that hold any of these numbers.
    fn touching(&self, first: u32, last: u32) -> impl Iterator<Item = &Run> {
        let table = self.table();
        let at = table.partition_point(|run| run.last < first);
        table.iter().skip(at).take_while(move |run| run.first <= last)
    }

    /// What is known of a computed number that may be one of some, `exact` where it is each of them; true where they all
    /// lie in what is known, so that nothing is supposed.
    pub(super) fn judge(
        &mut self,
        number: &Expr,
        may_be: &analysis::Numbers,
        exact: bool,
    ) -> (Option<Finding>, bool) {
        let known = may_be.last().is_none_or(|last| self.table().last().is_some_and(|run| last <= run.last));
        let finding = self.of(number).clone();
        let moves = finding.moves();
        // What neither control has stops both.
        let differs = |(first, last): &(u32, u32)| {
            let run = self.touching(*first, *last).find(|run| run.alike == Some(false))?;
            Some(run.first.max(*first))
        };
        let other = may_be.runs().iter().filter(|_| known).find_map(differs);
        if known && other.is_none() && !moves {
            return (None, true);
        }
        let inside = finding.run().is_some_and(|run| analysis::Numbers::of([run]).holds(may_be));
        match may_be.runs().first() {
            _ if known && inside => (Some(finding), true),
            // It would be moved, and is none of those that are.
            Some((first, _)) if known && exact && moves => (Some(Finding::Other(*first)), false),
            _ if known && exact => (other.map(Finding::Other), false),
            _ => (Some(finding), false),
        }
    }

    fn alike(&self, number: u32) -> bool {
        self.touching(number, number).any(|run| run.alike == Some(true))
    }

    /// True where no number of the source means another thing on the target.
    pub(super) fn all_alike(&self) -> bool {
        self.table().iter().all(|run| run.alike != Some(false) || !run.here)
    }

    /// What is known of a computed number by its constant part: the run that it lies in, or that begins after it.
    pub(super) fn of(&mut self, number: &Expr) -> &Finding {
        let start = constant_part(number).filter(|start| *start >= 100.0);
        let start = start.and_then(whole);
        let key = start.unwrap_or(0);
        if !self.known.contains_key(&key) {
            let finding = start.map_or(Finding::Any, |start| self.look_up(start));
            self.known.insert(key, finding);
        }
        match self.known.get(&key).unwrap_or(&Finding::Any) {
            // It walks out of the run that it starts in.
            Finding::Alike(..) if walks(number, f64::from(GAP)) => &Finding::Any,
            finding => finding,
        }
    }

    fn look_up(&self, start: u32) -> Finding {
        // People count from 1: `#[2400+#1]` means the run from #2401, though #2400 ends another.
        let next = start.saturating_add(1);
        let first = match (self.begins(start), self.begins(next)) {
            (None, None) => return Finding::Other(start),
            // The source has no such run.
            (Some(false), None) if self.ends_table(start) => return Finding::Other(next),
            (None, _) | (Some(false), Some(true)) => next,
            _ => start,
        };
        if self.alike(first) {
            let around = self.runs().iter().find(|(from, to)| (*from..=*to).contains(&first));
            return around.map_or(Finding::Any, |(from, to)| Finding::Alike(*from, *to));
        }
        self.distance(first).or_else(|| self.counted(first)).unwrap_or(Finding::Other(first))
    }

    /// The run of a state that is counted by one number, as far as the target counts too.
    fn counted(&self, number: u32) -> Option<Finding> {
        let (state, _, row) =
            self.source.numbered_state(number).filter(|(state, ..)| *state != Sys::Other)?;
        let (first, last) = (row.first?, row.last()?);
        let scaled = SCALED.iter().filter(|(from, ..)| *from == state).map(|(_, other, _)| *other);
        let states: Vec<Sys> = scaled.chain([state]).collect();
        let is_there = |number: &u32| {
            let numbers = row.subscripts_of(*number);
            let held =
                |numbers: &[u32]| states.iter().any(|s| self.target.system_address(*s, numbers).is_some());
            numbers.is_some_and(|numbers| held(&numbers))
        };
        // What the target lacks altogether is refused where it is read or written.
        let last = (first..=last).take_while(is_there).last().unwrap_or(last);
        match row.subscripts.as_slice() {
            [one] if one.step == 1 && !one.axis => Some(Finding::Counted(state, first, last, one.from)),
            _ => None,
        }
    }

    /// True for the first number of a run, false for another one in it; none outside of all.
    fn begins(&self, number: u32) -> Option<bool> {
        if let Some(row) = self.source.numbered_class(number) {
            return Some(row.first == number);
        }
        self.source.numbered_state(number).map(|(.., row)| row.first == Some(number))
    }

    /// True for the last number of a table of the system's.
    fn ends_table(&self, number: u32) -> bool {
        let is_last = |(_, _, row): (Sys, Vec<u32>, &SystemVariable)| row.last() == Some(number);
        self.source.numbered_class(number).is_none()
            && self.source.numbered_state(number).is_some_and(is_last)
    }

    /// The run of a state as far as the target has it at one distance.
    fn distance(&self, number: u32) -> Option<Finding> {
        let (state, _, row) = self.source.numbered_state(number)?;
        if tables_differ(state, self.source, self.target) {
            return None;
        }
        let (first, last) = (row.first?, row.last()?);
        let distance = |number: u32| {
            let (name, there, found) = self.target.system_address(state, &row.subscripts_of(number)?)?;
            let fits =
                Some(name) == self.target.numbered() && row.access.chars().all(|c| found.access.contains(c));
            Some(i64::from(there.filter(|_| fits)?) - i64::from(number))
        };
        let by = distance(first)?;
        let inside = |number: &u32| row.subscripts_of(*number).is_some();
        let reached =
            (first..=last).filter(inside).take_while(|number| distance(*number) == Some(by)).last()?;
        (number <= reached).then_some(Finding::Shifted(state, first, reached, by))
    }

    /// Runs of numbers that mean the same, over gaps that stand for axes that are not there.
    fn runs(&self) -> &[(u32, u32)] {
        self.table.runs.get_or_init(|| self.found_runs())
    }

    fn found_runs(&self) -> Vec<(u32, u32)> {
        let mut runs: Vec<(u32, u32)> = Vec::new();
        let mut broken = true;
        for run in self.table().iter().filter(|run| run.last > 0) {
            let first = run.first.max(1);
            match (run.alike, runs.last_mut()) {
                (Some(true), Some((_, last))) if !broken && first - *last < GAP => *last = run.last,
                (Some(true), _) => runs.push((first, run.last)),
                _ => {}
            }
            broken = run.alike == Some(false) || broken && run.alike != Some(true);
        }
        runs
    }

    /// The numbers that mean the same, whatever is in force.
    pub(super) fn list(&self) -> &analysis::Numbers {
        self.table.listed.get_or_init(|| self.made_list())
    }

    fn made_list(&self) -> analysis::Numbers {
        let runs = analysis::Numbers::of(self.runs().iter().copied());
        let [here, there] =
            [self.source, self.target].map(|control| control.behaviour(position_length::FACT));
        if here.map(|row| &row.value) == there.map(|row| &row.value) {
            return runs;
        }
        let is_depth = |number: &u32| {
            matches!(meaning(self.source, *number), Some(Meaning::State(state, axis))
                if position_length::is_position(state) && axis == [position_length::DEPTH])
        };
        let rows = self.source.dialect().system.iter().filter(|row| position_length::is_position(row.state));
        let held = rows.filter_map(|row| Some(row.first?..=row.last()?)).flatten();
        let mut depths: Vec<u32> = held.filter(is_depth).collect();
        depths.sort_unstable();
        depths.dedup();
        runs.without(depths)
    }
}
