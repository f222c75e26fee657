//! What a program and its conversion do where the machine is not as after power-on.
//!
//! The telling scenarios are run once more from states in which everything is otherwise: what one side says and the other
//! leaves out shows then. Where the two differ, each state is tried alone. A difference that the source's own run does not
//! show any sign of before is one of the conversion. Where the source rests on the state itself, it says nothing of what
//! the target should do, and the two are undecided.

use super::verifier::{Pair, Verifier};
use crate::assume::Predicate;
use crate::canon::Op;
use crate::control::trace::Event;
use crate::control::{End, ProgramRef, Run, Scenario};
use crate::dialect::{Question, Units};
use crate::verify::certificate::Why;
use crate::verify::compare::{Difference, compare, is_cut, lacks};
use crate::verify::entry::{CYCLE, Start, UNIT, leaves_cycle, starts};
use crate::verify::sides::{Side, SymbolMap};
use std::collections::{BTreeMap, BTreeSet};

/// Blocks from which on a run is a long one: what each state does alone is then looked at only as far as all together
/// differ.
const LONG: u64 = 20_000;

/// Events that are looked at besides.
const BESIDES: usize = 100;

/// What runs from another state show.
enum Found {
    /// They came to their ends and did the same.
    Same,
    /// Nothing: one came to no end, or its control stopped it.
    Nothing,
    /// They did different things: what, in words, where the source's run rested on the state before.
    Rests(String),
    /// They did different things, and both take the state to be as a reset leaves it, where they do the same.
    Granted,
    /// They did different things, because a code of the tool length moves its axis on the target alone.
    RestsThere(String),
    /// They did different things: the witness is kept.
    Fault,
}

impl Verifier<'_, '_> {
    /// Starts the program in other states. What other programs call starts as those leave the machine.
    pub(super) fn entries(&mut self, there: ProgramRef) {
        if self.called || self.witness.is_some() {
            return;
        }
        let mut states: Vec<&'static Start> = self.other_units(None).map(|_| &UNIT).into_iter().collect();
        states.extend(starts(self.job, self.program));
        self.started = states.iter().map(|state| state.name).collect();
        let mut settled = BTreeSet::new();
        let groups = self.telling.clone().into_iter().flat_map(|told| [(told.clone(), false), (told, true)]);
        for ((scenario, theirs), turns) in groups {
            self.theirs = theirs;
            let open = |state: &&&Start| state.turns == turns && !settled.contains(state.name);
            let all: Vec<&'static Start> = states.iter().filter(open).copied().collect();
            settled.extend(self.start_in(&all, &scenario, there));
            if self.witness.is_some() || self.is_out_of_time() {
                break;
            }
        }
        self.theirs.clear();
    }

    /// Starts a scenario in all of these states at once, and in each alone where that shows anything but the same. Yields
    /// the names of those that need no other try: the source is found to rest on them.
    fn start_in(
        &mut self,
        all: &[&'static Start],
        scenario: &Scenario,
        there: ProgramRef,
    ) -> BTreeSet<&'static str> {
        let mut settled = BTreeSet::new();
        loop {
            let is_open = |state: &&&Start| !settled.contains(state.name);
            let open: Vec<&'static Start> = all.iter().filter(is_open).copied().collect();
            if open.is_empty() {
                return settled;
            }
            let (together, upto) = self.started_in(&open, scenario, there, None);
            let kept = (self.witness.take(), std::mem::take(&mut self.shown));
            if matches!(together, Found::Same) {
                return settled;
            }
            let before = settled.len();
            for state in &open {
                match self.started_in(&[state], scenario, there, upto).0 {
                    Found::Same | Found::Nothing => {}
                    Found::Fault => return settled,
                    Found::Granted => {
                        settled.insert(state.name);
                    }
                    Found::Rests(what) => {
                        self.rests(&[state], &what);
                        settled.insert(state.name);
                    }
                    Found::RestsThere(what) => {
                        let (noun, words) = (state.noun, state.words);
                        let text = format!(
                            "the target depends on {noun} at its start: started {words}, it does something else than the source \
                             ({what}){}",
                            none_in_force(self.job.target)
                        );
                        self.because(Why::EntryState, &text);
                        settled.insert(state.name);
                    }
                }
            }
            if settled.len() == before {
                (self.witness, self.shown) = kept;
                if let Found::Rests(what) = together {
                    self.rests(&open, &what);
                    settled.extend(open.iter().map(|state| state.name));
                }
                return settled;
            }
            if upto.is_none() {
                return settled;
            }
        }
    }

    /// Notes that the source rests on states in which the target does something else.
    fn rests(&mut self, states: &[&Start], what: &str) {
        // What no program of the library leaves on, and a reset switches off, none of them is started in.
        let never = |state: &Start| state.name == CYCLE && !leaves_cycle(self.job.source);
        if states.iter().all(|state| self.is_assumed(state) || never(state)) {
            return;
        }
        let all = |word: fn(&Start) -> &'static str| {
            states.iter().map(|state| word(state)).collect::<Vec<_>>().join(", ")
        };
        let begins = if is_moved_on(self.job.source, self.job.target, states) {
            none_in_force(self.job.source)
        } else if states.iter().all(|state| state.is_stated()) {
            ". Say in the source's profile what its machine begins in: [start] codes".to_owned()
        } else {
            String::new()
        };
        let text = format!(
            "the source depends on {} at its start: started {}, the target does something else ({what}){begins}",
            all(|state| state.noun),
            all(|state| state.words),
        );
        self.because(Why::EntryState, &text);
    }

    /// Runs both sides from states of the machine, to the end or up to so many events; and tells how many events of a
    /// long run show what differs.
    fn started_in(
        &mut self,
        states: &[&'static Start],
        scenario: &Scenario,
        there: ProgramRef,
        upto: Option<usize>,
    ) -> (Found, Option<usize>) {
        let target = self.job.target;
        let is_part = upto.is_some();
        let scenario = &Scenario { events: upto.unwrap_or(scenario.events), ..scenario.clone() };
        let mut begun = scenario.clone();
        states.iter().for_each(|state| state.put(&mut begun));
        let with_unit = states.iter().any(|state| state.name == UNIT.name);
        let units = if with_unit { self.other_units(scenario.inch) } else { None };
        if let Some([ours, _]) = units {
            begun.inch = Some(ours);
        }
        let run = self.run_source(&begun);
        let mut circumstances = self.circumstances(&begun, &run);
        if let Some([_, theirs]) = units {
            circumstances.inch = Some(theirs);
        }
        let other = target.run(there, &circumstances);
        if !is_part && (is_cut(&run) || is_cut(&other)) || stopped(&run) {
            return (Found::Nothing, None);
        }
        let pair = Pair { scenario: &begun, run: &run, there, circumstances: &circumstances, other: &other };
        let fault = self.fault(&pair);
        let event = fault.as_ref().err().and_then(Option::as_ref).and_then(|difference| difference.source);
        let at = event.and_then(|event| run.events.iter().position(|other| std::ptr::eq(event, other)));
        let upto = at.filter(|_| run.steps > LONG && !is_part).map(|at| at + BESIDES);
        let found = match fault {
            Ok(()) if is_part => Found::Same,
            Ok(()) => {
                self.went_alike(&pair);
                Found::Same
            }
            Err(None) => Found::Nothing,
            Err(Some(difference)) if self.rests_on_start(scenario, &run, difference.source) => {
                let resets = states.iter().all(|state| state.resets || state.ends && !self.returns);
                let [source, target] = [self.job.source, target];
                let begins =
                    is_moved_on(source, target, states) && source.control.says_start() && !self.returns;
                match begins || resets && self.target_rests(scenario, &other, there) {
                    true => Found::Granted,
                    false => Found::Rests(difference.what),
                }
            }
            // What a machine begins in leaves no tool length in force.
            Err(Some(_)) if is_moved_on(target, self.job.source, states) && target.control.says_start() => {
                Found::Granted
            }
            Err(Some(difference)) if is_moved_on(target, self.job.source, states) => {
                Found::RestsThere(difference.what)
            }
            Err(Some(difference)) => {
                self.witnessed(&pair, &difference);
                let started: Vec<&str> = states.iter().map(|state| state.words).collect();
                if let Some(witness) = &mut self.witness {
                    witness.what = format!("started {}, {}", started.join(", "), witness.what);
                    witness.started = started;
                }
                Found::Fault
            }
        };
        (found, upto)
    }

    /// True where the source does something else than after power-on, before or when a difference shows.
    fn rests_on_start(&self, scenario: &Scenario, run: &Run, at: Option<&Event>) -> bool {
        let place = |event: Option<&Event>| {
            let is = |other: &Event| event.is_some_and(|event| std::ptr::eq(event, other));
            run.events.iter().position(is).unwrap_or(run.events.len())
        };
        // All that its block does counts: one move of a cycle may be as after power-on, and the next one not.
        let mut last = place(at);
        while run.events.get(last + 1).is_some_and(|next| next.at == run.events[last].at) {
            last += 1;
        }
        // What comes later in a long run says nothing of it.
        let events = if run.steps > LONG { scenario.events.min(last + BESIDES) } else { scenario.events };
        let plain = self.run_source(&Scenario { events, ..scenario.clone() });
        let own = self.apart(self.job.source, run, &plain);
        own.is_some_and(|own| place(own.source) <= last)
    }

    /// True where the target does something else than after power-on too.
    fn target_rests(&self, scenario: &Scenario, begun: &Run, there: ProgramRef) -> bool {
        let target = self.job.target;
        let plain = self.circumstances(scenario, &self.run_source(scenario));
        let plain = target.run(there, &plain);
        self.apart(target, begun, &plain).is_some()
    }

    /// What a run does otherwise than one of the same side after power-on.
    fn apart<'r>(&self, side: &Side<'_>, begun: &'r Run, plain: &'r Run) -> Option<Difference<'r>> {
        let found = compare((side, begun), (side, plain), &SymbolMap::default(), self.tolerance);
        found.hair.or(found.difference)
    }

    /// The other units that the source and the target may find than that of a scenario, true for inch; none if
    /// profiles state both.
    ///
    /// A unit that a profile states stays. What returns runs in the unit of its callers, on both sides the same, and so does
    /// what the conversion supposes to be run so.
    fn other_units(&self, inch: Option<bool>) -> Option<[bool; 2]> {
        let sides = [self.job.source, self.job.target].map(|side| side.control.units());
        let stated = sides.map(|units| units.map(|units| units == Units::Inch));
        let other = !inch.or(stated[0]).unwrap_or(false);
        match stated {
            _ if self.is_assumed(&UNIT) => Some([other; 2]),
            // A program that selects its unit checks it on such a target, and stops where it is not so.
            _ if lacks(self.job.target, Op::Inch) => None,
            [Some(_), Some(_)] => None,
            [Some(_), None] if self.returns => None,
            [None, _] if self.returns => Some([other; 2]),
            stated => Some(stated.map(|inch| inch.unwrap_or(other))),
        }
    }

    /// True where the conversion supposes a state of the machine, so that a person has been told.
    fn is_assumed(&self, state: &Start) -> bool {
        let mut all = self.job.assumptions.get(&self.program).into_iter().flatten();
        state.name == UNIT.name && all.any(|assumption| assumption.predicate == Predicate::Unit)
    }
}

/// True for a tool length alone, whose codes move its axis on one side and not on the other.
fn is_moved_on(side: &Side<'_>, other: &Side<'_>, states: &[&Start]) -> bool {
    let moves = |side: &Side<'_>| side.control.is(Question::LengthMoves);
    states.iter().all(|state| state.name == "length") && moves(side) && !moves(other)
}

/// What its profile says if no tool length is in force when programs begin.
fn none_in_force(side: &Side<'_>) -> String {
    let code = side.control.code_for(Op::LengthOff, &BTreeMap::new());
    let told = |code: &str| {
        format!(
            ". If none is in force when it is started, write codes = \"{code}\" under [start] of its profile"
        )
    };
    code.map_or_else(String::new, |row| told(&row.code))
}

/// True where the control stopped the program, so that it says nothing of what comes after.
fn stopped(run: &Run) -> bool {
    matches!(&run.end, End::Alarm { stop, .. } if stop.program_number.is_none())
}
