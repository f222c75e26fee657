//! Builders' codes that turn a live tool at S: the word lasts, whatever block it stands in.

use super::{Command, Machine};
use crate::canon::{Act, Op, Role};
use crate::control::trace::{EventKind, Trace};
use crate::dialect::{Control, SiteCode};
use std::collections::BTreeMap;

/// What such codes go by.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spoken {
    /// The last S, if it counts turns.
    speed: Option<f64>,
    /// The code that turns a tool, while nothing came that may have stopped it.
    turns: Option<Act>,
}

impl Spoken {
    /// Takes an S.
    pub(super) fn says(&mut self, speed: f64, surface: bool) {
        self.speed = (!surface).then_some(speed);
    }

    /// The tool may stand from here on.
    pub(super) fn doubt(&mut self) {
        self.turns = None;
    }
}

/// A builder's code: gives it the last S where it reads S and has none. True where its S counts what the surface does.
pub(super) fn beside(
    machine: &mut Machine,
    command: &Command,
    act: Act,
    words: &mut BTreeMap<String, f64>,
) -> bool {
    let Some(role) = machine.rules.speaks.get(&act).copied() else {
        machine.spoken.doubt();
        return false;
    };
    let said = command.word(role);
    match said {
        Some(speed) => machine.spoken.says(speed, machine.surface_speed),
        None => {
            let last = machine.spoken.speed.filter(|_| command.word(Role::Speed).is_none());
            words.extend(act.word_name(role).zip(last));
        }
    }
    machine.spoken.turns = Some(act);
    said.is_some() && machine.surface_speed
}

/// An S by itself while such a tool turns: it turns at that from here on.
pub(super) fn again(machine: &Machine, command: &Command, trace: &mut Trace) {
    let (Some(act), Some(speed)) = (machine.spoken.turns, command.word(Role::Speed)) else { return };
    let other = command.has(Op::RigidTaps) || command.has(Op::SpindleStop);
    if other || command.words.iter().any(|(role, _)| *role == Role::Act) || machine.surface_speed {
        return;
    }
    let name = machine.rules.speaks.get(&act).and_then(|role| act.word_name(*role));
    trace.push(EventKind::Act {
        name: act.name(),
        words: name.into_iter().map(|name| (name, speed)).collect(),
        surface: false,
    });
}

/// The word that is S of each of a control's builders' codes that reads it.
pub(super) fn all(control: &Control) -> BTreeMap<Act, Role> {
    let sites = control.profile().site.iter().filter_map(|site| control.act_of(site));
    sites.filter_map(|act| Some((act, control.speed_word(act)?))).collect()
}

/// The variables that builders' codes set, by the numbers of their names.
pub(super) fn sets(control: &Control) -> BTreeMap<Act, Vec<u32>> {
    let of = |site: &SiteCode| {
        let sets = site.sets.values().map(|name| Act::named(name).number() as u32);
        Some((control.act_of(site)?, sets.collect()))
    };
    control.profile().site.iter().filter_map(of).collect()
}
