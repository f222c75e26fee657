//! The registers of the target that are free.

use super::locked::{Effective, Locked};
use super::names::pool_name;
use super::needs::is_general;
use crate::dialect::{Control, Question, VariableClass};
use crate::ir::analysis::Numbers;
use crate::ir::{Class, Var};
use crate::legalize::Context;
use std::collections::{BTreeMap, BTreeSet};

/// The registers of the target and which of them are taken.
#[derive(Clone)]
pub(super) struct Pool<'a> {
    pub name: String,
    /// Rows to take from, those that keep their values first.
    rows: Vec<&'a VariableClass>,
    pub used: BTreeSet<u32>,
    /// Registers of classes that some places ask for.
    apart: BTreeSet<(String, u32)>,
    locked: &'a BTreeMap<String, u32>,
    /// Where temporaries go first, and nothing else ever.
    scratch: BTreeSet<u32>,
    /// Those of programs of earlier runs whose values outlive calls.
    over_calls: BTreeSet<u32>,
    /// Those that other libraries have on the same machine: taken where nothing else is free.
    elsewhere: &'a BTreeSet<u32>,
    /// True if no program of an earlier run stays as it is.
    alone: bool,
    /// What heads of an earlier conversion say of the source's registers.
    held: &'a BTreeMap<String, String>,
    /// Numbers that computed ones reach.
    reached: Numbers,
    /// Numbers that computed ones are supposed to be: taken where nothing else is free.
    supposed: Numbers,
    target: &'a Control,
}

impl<'a> Pool<'a> {
    pub fn new(
        context: &Context<'a>,
        effective: &'a Effective,
        locked: &Locked<'a>,
        held: &'a BTreeMap<String, String>,
    ) -> Self {
        let target = context.target;
        let supposed = context.reached.supposed();
        let mut reached = context.reached.sure.clone();
        reached.join(&locked.reached);
        let mut rows: Vec<&VariableClass> =
            target.classes().iter().filter(|row| is_general(row, target)).collect();
        // What every control of the kind has comes before what must be bought.
        rows.sort_by_key(|row| (row.option.is_some(), row.first));
        let name = pool_name(target);
        let used = effective.variables.values().chain(locked.own).copied().collect();
        let scratch = effective.scratch.clone();
        let elsewhere = &locked.elsewhere.registers;
        let (over_calls, alone) = (locked.over_calls.iter().copied().collect(), locked.others.is_empty());
        Self {
            over_calls,
            elsewhere,
            alone,
            name,
            rows,
            used,
            apart: BTreeSet::new(),
            locked: &effective.variables,
            scratch,
            held,
            reached,
            supposed,
            target,
        }
    }

    fn free(&self, number: u32) -> bool {
        !self.used.contains(&number)
            && !self.scratch.contains(&number)
            && !self.reached.contains(number)
            && !self.target.is_reserved(&self.name, number)
    }

    /// Where the variable was on this control, if a head of an earlier conversion says so.
    fn was_at(&self, name: &str) -> Option<u32> {
        self.held.get(name)?.strip_prefix(self.name.as_str())?.parse().ok()
    }

    /// Where a variable that no earlier run has a register for can go back to, if it was on this control.
    pub fn back_to(&self, Var { class, .. }: Var, name: &str) -> Option<u32> {
        let there = self.was_at(name).filter(|_| !self.locked.contains_key(name));
        there.filter(|number| self.fits(class, *number))
    }

    /// True for a free register that a variable of the class may have.
    fn fits(&self, class: Class, number: u32) -> bool {
        let keeps = |row: &&VariableClass| row.retained != Some(false);
        let row = self.rows.iter().copied().find(|row| (row.first..=row.last).contains(&number));
        row.is_some_and(|row| keeps(&row) || is_volatile(class))
            && self.free(number)
            && !self.supposed.contains(number)
    }

    /// How far a register is from the number of a variable that keeps its value, where the numbers of both controls are alike: those
    /// above come first, so that variables beside each other stay in their order, and what must be bought comes last. A number
    /// that the target has not at all is near to none below: the first is taken. Where the variable is none of those, all are as near.
    fn distance(&self, var: Var, number: u32) -> (bool, bool, u32) {
        if var.class != Class::Retained || !self.target.is(Question::Vacancy) {
            return (false, false, 0);
        }
        let row = self.rows.iter().find(|row| (row.first..=row.last).contains(&number));
        let bought = row.is_some_and(|row| row.option.is_some());
        let below = number < var.number;
        let there = self.rows.iter().any(|row| (row.first..=row.last).contains(&var.number));
        (bought, below, if below && !there { number } else { number.abs_diff(var.number) })
    }

    /// A register for a variable: the one that the lock has under its name, the one where it was on
    /// this control before, or the best that is free. What is needed
    /// `over` calls shares none with programs of earlier runs that stay as they are: a call may run them.
    pub fn take(&mut self, var: Var, name: Option<&str>, over: bool) -> Option<u32> {
        let class = var.class;
        let before = name.and_then(|name| self.was_at(name));
        if let Some(&number) = name.and_then(|name| self.locked.get(name)) {
            return Some(number);
        }
        let keeps = |row: &&&VariableClass| row.retained != Some(false);
        let volatile = is_volatile(class);
        let preferred = self.rows.iter().filter(|row| keeps(row) != volatile);
        let rest = self.rows.iter().filter(|row| keeps(row) == volatile && (volatile || keeps(row)));
        let alone = over && !self.alone;
        let again = |number: &u32| {
            if alone || self.over_calls.contains(number) {
                return false;
            }
            let taken = self.used.contains(number) || self.target.is_reserved(&self.name, *number);
            matches!(class, Class::Temp | Class::Static) && !taken && !self.reached.contains(*number)
        };
        let free: Vec<u32> = preferred
            .chain(rest)
            .flat_map(|row| row.first..=row.last)
            .filter(|number| self.free(*number))
            .collect();
        let in_use = |number: u32| self.target.is_in_use(&self.name, number);
        let best = || {
            let shunned = |n: u32| (self.supposed.contains(n), in_use(n), self.elsewhere.contains(&n));
            let key = |n: &u32| (shunned(*n), self.distance(var, *n));
            free.iter().copied().min_by_key(key)
        };
        let apart = |number: &u32| !self.supposed.contains(*number);
        let scratch = || self.scratch.iter().copied().filter(again);
        let back = before.filter(|number| self.fits(class, *number));
        let number = back
            .or_else(|| scratch().find(apart))
            .or_else(|| best().filter(apart))
            .or_else(|| scratch().next())
            .or_else(best)?;
        self.used.insert(number);
        Some(number)
    }

    /// A register of a class that some places ask for, the first in the table that nothing else has.
    pub fn take_of(&mut self, class: &str) -> Option<(String, u32)> {
        let rows = self.target.classes().iter().filter(|row| row.class == class);
        let mut all = rows.flat_map(|row| (row.first..=row.last).map(|number| (&row.name, number)));
        let (name, number) = all.find(|(name, number)| {
            let taken = self.apart.contains(&((*name).clone(), *number));
            !taken && !self.target.is_reserved(name, *number) && !self.target.is_in_use(name, *number)
        })?;
        self.apart.insert((name.clone(), number));
        Some((name.clone(), number))
    }

    /// A base so that `base + first ..= base + last` are free registers of one kind that keep their values.
    pub fn run(&mut self, first: u32, last: u32, name: &str) -> Option<u32> {
        if let Some(&base) = self.locked.get(name) {
            return Some(base);
        }
        let keeps = |row: &&&VariableClass| row.retained != Some(false);
        let mut numbers: Vec<u32> =
            self.rows.iter().filter(keeps).flat_map(|row| row.first..=row.last).collect();
        numbers.sort_unstable();
        let all: BTreeSet<u32> = numbers.iter().copied().collect();
        let fits = |base: &u32| (base + first..=base + last).all(|n| all.contains(&n) && self.free(n));
        // Round bases read best: V12 in #512 or #612.
        let bases = numbers.iter().filter_map(|n| n.checked_sub(first));
        let shunned = |number| self.supposed.contains(number) || self.target.is_in_use(&self.name, number);
        let apart = |base: &u32| !(base + first..=base + last).any(shunned);
        let round = bases.clone().filter(|base| base % 100 == 0).find(|base| fits(base) && apart(base));
        let base = round
            .or_else(|| bases.clone().find(|base| fits(base) && apart(base)))
            .or_else(|| bases.clone().find(&fits))?;
        self.used.extend(base + first..=base + last);
        Some(base)
    }
}

/// True for a class whose values may end at power-off.
fn is_volatile(class: Class) -> bool {
    matches!(class, Class::Temp | Class::Static | Class::Register | Class::Common | Class::Local)
}
