//! What a conversion supposes of the machines and of what is found there, as scenarios have it.

use super::verifier::Verifier;
use crate::assume::{Assumption, Predicate};
use crate::canon::{CycleSetting, Group, Op};
use crate::control::Scenario;
use std::collections::{BTreeMap, BTreeSet};

/// What is supposed of all runs of a program.
pub(super) struct Supposed {
    main: bool,
    loaded: Option<u32>,
    held: BTreeMap<String, f64>,
    as_stated: Vec<Group>,
    settings: BTreeMap<String, f64>,
    left: BTreeSet<CycleSetting>,
    set_to_inch: Option<bool>,
}

impl Supposed {
    /// Puts all of it into a scenario.
    pub(super) fn of_run(&self, scenario: &mut Scenario) {
        scenario.called &= !self.main;
        scenario.tool = self.loaded.unwrap_or(scenario.tool);
        scenario.variables.extend(self.held.clone());
        scenario.as_stated.clone_from(&self.as_stated);
        self.of_machine(scenario);
    }

    /// Puts in what is supposed of the machines alone.
    pub(super) fn of_machine(&self, scenario: &mut Scenario) {
        scenario.settings.clone_from(&self.settings);
        scenario.left.clone_from(&self.left);
        scenario.set_to_inch = self.set_to_inch;
    }
}

impl Verifier<'_, '_> {
    /// What is supposed of the program, and of all that it calls.
    pub(super) fn supposed(&self) -> Supposed {
        let assumed = || self.job.assumptions.get(&self.program).into_iter().flatten();
        let loaded = assumed().rev().find_map(|one| match one.predicate {
            Predicate::Loaded(tool) => Some(tool),
            _ => None,
        });
        Supposed {
            main: assumed().any(|one| one.predicate == Predicate::Main),
            loaded,
            held: self.held(),
            as_stated: self.job.as_stated(self.program),
            settings: self.settings(),
            left: self.left(),
            set_to_inch: self.set_to_inch(),
        }
    }

    /// The variables that the program's callers are known to have set, and what they hold.
    pub(super) fn held(&self) -> BTreeMap<String, f64> {
        let assumed = self.job.assumptions.get(&self.program).into_iter().flatten();
        let held = assumed.filter_map(|one| match &one.predicate {
            Predicate::Holds(name, value) => Some((name.to_string(), *value)),
            _ => None,
        });
        held.collect()
    }

    /// What the target's settings are supposed to be: while this program runs, and so what it calls.
    fn settings(&self) -> BTreeMap<String, f64> {
        let mut settings = BTreeMap::new();
        for one in self.assumed_below() {
            if let Predicate::Setting(name, value) | Predicate::TurnedSetting(name, value) = &one.predicate {
                settings.entry(name.to_string()).or_insert(*value);
            }
        }
        settings
    }

    /// What cycles take from settings of the target, whatever those say.
    fn left(&self) -> BTreeSet<CycleSetting> {
        let assumed = self.assumed_below().into_iter();
        let left = assumed.filter_map(|one| match one.predicate {
            Predicate::OfMachine(what) => Some(what),
            _ => None,
        });
        left.collect()
    }

    /// The unit that the target is supposed to be set to, where that is not the one of its profile: true for inches.
    fn set_to_inch(&self) -> Option<bool> {
        self.assumed_below().into_iter().find_map(|one| match one.predicate {
            Predicate::SetTo(unit) => Some(unit == Op::Inch),
            _ => None,
        })
    }

    /// What is assumed of this program, and of all that it calls.
    fn assumed_below(&self) -> Vec<&Assumption> {
        let called = self.job.source.links().called_from(self.program, |_| true);
        let programs = std::iter::once(&self.program).chain(&called);
        programs.filter_map(|program| self.job.assumptions.get(program)).flatten().collect()
    }
}
