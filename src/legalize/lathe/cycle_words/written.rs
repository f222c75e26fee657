//! Cycles whose moves are written out, because the target has none that makes them.

use super::super::cycle_values::{Given, Need, Values, setting_named};
use super::super::groove_loops::Groove;
use super::super::groove_passes;
use super::super::left_settings::leaves;
use super::super::setting_values::{Instead, So, written};
use super::super::settings::{Kind, setting, stands_in};
use super::super::thread_loops::{Loop, Made};
use super::super::thread_passes::{UNKNOWN, all, finishes, runs_out as single_passes};
use super::{OTHER_UNIT, Run};
use crate::assume::Predicate;
use crate::canon::{CycleSetting, Op, Role};
use crate::dialect::Question;
use crate::ir::Stmt;
use crate::text::Span;

impl Run<'_> {
    /// What is said where moves take the place of a cycle for a setting that is known to be another one on the target, or that a
    /// cycle before needs otherwise; nothing for another setting.
    pub(super) fn set_otherwise(&self, (.., needs): &Need) -> Option<Instead> {
        let Predicate::Setting(name, value) = needs else { return None };
        let before = |(.., so): &(Span, String, String, So)| match so {
            So::Supposed(Predicate::Setting(other, before) | Predicate::TurnedSetting(other, before)) => {
                other == name && before != value
            }
            _ => false,
        };
        let stated = self.profile.setting(name);
        let there = match (stated, self.turned) {
            (Some(stated), Some(turned)) => Some(format!("{stated}, and is in {}", turned.profile)),
            (stated, _) => stated.map(str::to_owned),
        };
        (stated.is_some() || self.found.iter().any(before))
            .then(|| written((name, *value), there.as_deref(), &self.target.dialect().title))
    }

    /// True where a length of the cycle comes from a setting that is in another unit, or is to be in one.
    pub(super) fn rests_on_length(&self, kind: &Kind, setup: &Values) -> bool {
        let [source, target] = self.other_unit;
        let written = |role: &Role| setup.iter().any(|(found, _)| found == role);
        kind.roles.iter().any(|role| {
            let there = setting(self.source, kind.cycle, *role).is_some()
                || stands_in(self.source, self.features, kind.cycle, *role);
            let here = setting(self.target, kind.cycle, *role).is_some() && !written(role);
            // What is left to the machine is right in its own unit.
            let here = here && !(leaves(self.target) && CycleSetting::of(kind.cycle, *role).is_some());
            role.is_length() && ((source || target) && there || target && here)
        })
    }

    /// What the target must be set to; once its unit is turned, a number of its profile says nothing of a length.
    pub(super) fn supposed(&self, (what, help, needs): Need, why: &str) -> (String, String, So) {
        let Some((turned, Predicate::Setting(name, value))) = self.turned.zip(Some(&needs)) else {
            return (what, format!("{help}{why}"), So::Supposed(needs));
        };
        let is_length = self.target.setting_row(name).and_then(|row| row.gives.or(row.otherwise));
        if !is_length.is_some_and(Role::is_length) {
            return (what, format!("{help}{why}"), So::Supposed(needs));
        }
        let (kind, number) = setting_named(name);
        let title = &self.target.dialect().title;
        let what = format!(
            "{kind} {number} of the {title} must be {value} while this program runs, in {}: no source says what becomes of its number when the unit of \
             the machine is changed",
            turned.program
        );
        let help = format!("set the unit first, and look at {kind} {number} then{why}");
        (what, help, So::Supposed(Predicate::TurnedSetting(name.clone(), *value)))
    }

    /// The moves of a thread or a groove, in place of its cycle, or the cycle itself where a loop takes its place later; why there
    /// are none.
    pub(super) fn written_out(
        &mut self,
        (stmt, at): (&Stmt, (usize, usize)),
        values: &Values,
        kind: &Kind,
    ) -> Result<Vec<Stmt>, &'static str> {
        if self.in_steps {
            return Err("words of a place may be increments");
        }
        let by_setting = |role: &Role| role.is_length() && setting(self.source, kind.cycle, *role).is_some();
        if self.other_unit.contains(&true) && kind.roles.iter().any(by_setting) {
            return Err(OTHER_UNIT);
        }
        let flanks = self.source.behaviour(Question::ThreadFlanks).map(|row| row.value.as_str());
        let leading = match flanks {
            Some("leading.first") => Some(true),
            Some("trailing.first") => Some(false),
            _ => None,
        };
        if kind.cycle != Op::Threading {
            return match groove_passes::all(stmt, values, self.place, self.target) {
                // A word without a value would not be there, and the cycle begin elsewhere.
                Err(UNKNOWN) if !self.may_be_vacant() => {
                    let from = self.starts.at(&self.place);
                    let found = Groove::of(stmt, values, from, (self.source, self.target))?;
                    self.loops.push((at, Made::Groove(found)));
                    Ok(vec![stmt.clone()])
                }
                made => made,
            };
        }
        let passes = match all(stmt, values, leading, self.place, self.target) {
            Err(UNKNOWN) => {
                let from = self.starts.at(&self.place);
                let found = Loop::of(stmt, values, leading, from, (self.source, self.target))?;
                if self.may_be_vacant() {
                    self.found.push((stmt.site.span, VACANT.into(), VACANT_HELP.into(), So::Open));
                }
                self.loops.push((at, Made::Thread(found)));
                vec![stmt.clone()]
            }
            made => made?,
        };
        let infeed = values.iter().find(|(role, _)| *role == Role::ThreadInfeed);
        if infeed.and_then(|(_, way)| way.constant()).is_some_and(|way| way % 2.0 == 0.0) {
            self.flanks.get_or_insert(stmt.site.span);
        }
        Ok(passes)
    }

    /// True where a word of the cycle, of the block that sets it, or of where it begins may have no value.
    fn may_be_vacant(&self) -> bool {
        self.vacant || self.set_vacant || self.starts.may_be_vacant(&self.place)
    }

    /// The finishing passes that the target's cycle does not make. Nothing, if they cannot follow it.
    pub(super) fn finishing(
        &self,
        stmt: &Stmt,
        given: &Given,
        values: &Values,
        may: Result<(), &'static str>,
    ) -> Option<Vec<Stmt>> {
        let passes = (given.angle, given.finishes);
        match given.finishes {
            0 => Some(Vec::new()),
            _ if may.is_err() => None,
            // No source says by which way a pass in moves would run out: single passes do it as the cycle does.
            _ if runs_out(values) => single_passes(stmt, passes, self.place, self.target),
            _ => finishes(stmt, passes, self.place, self.target),
        }
    }
}

/// True of a thread that runs out at its end.
pub(super) fn runs_out(values: &Values) -> bool {
    values.iter().any(|(role, value)| *role == Role::ThreadRunOut && value.constant() != Some(0.0))
}

const VACANT: &str = "this thread becomes a loop of its passes, and a word of it may have no value: the source leaves the word out then, and the loop \
                      takes 0";
const VACANT_HELP: &str = "make sure that all its variables have values";
