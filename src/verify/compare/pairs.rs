//! Whether two runs amount to the same.

use super::arcs::joined;
use super::builders;
use super::differ::{ANOTHER_FEED, differ, told};
use super::exit_state::{left_differs, outside_differs};
use super::found::{Comparison, Difference};
use super::kinds::is_cut;
use super::lengths::{brought, is_told_of_same_tool, shown_by_moves};
use super::letters;
use super::loose::{Found, Order, farthest};
use super::observe::{Act, observed};
use super::paths::{apart, ends, goes_nowhere, leaves};
use super::pauses::{Runs, ends_cycle, ends_earlier, may_do_so, may_turn};
use super::renamed::Renaming;
use super::roughing;
use super::shown::{as_messages, end_differs, lacks_messages, texts, without_outputs};
use super::substitutes::{
    cannot_cancel, goes_on, has_no_feed, is_builders, is_idle, is_left_out, makes_ready, returns_to_caller,
    stands_for,
};
use super::threads;
use super::tolerance::Tolerance;
use super::unseen::{before_alarm, told_at};
use super::variables::variables_differ;
use super::waits::as_long;
use crate::canon::Op;
use crate::control::Run;
use crate::control::trace::{EventKind, Position, Told};
use crate::verify::sides::{Side, SymbolMap};

/// Least increments by which two arcs may lie apart between their ends, where the words of both rounded:
/// the end, and the centre in two axes, each by a half.
const ARC_ROUNDINGS: f64 = 2.0;

/// Compares what an observer could tell of two runs, and the variables that outlive them.
pub fn compare<'r>(
    source: (&Side<'_>, &'r Run),
    target: (&Side<'_>, &'r Run),
    names: &SymbolMap,
    tolerance: Tolerance,
) -> Comparison<'r> {
    let cut = is_cut(source.1) || is_cut(target.1);
    let mut found = farthest([source.1, target.1], |orders| {
        let [ours, theirs] = acts(source, target, orders);
        let mut pairs = Pairs::new((source.0, target.0), names, tolerance);
        let (i, j) = pairs.walk(&ours, &theirs, cut);
        let (far, what) = (i + j, pairs.found);
        let blocks = what.difference.as_ref().map(|found| [found.source, found.target]);
        let blocks = blocks.unwrap_or_default().map(|event| event.map(|event| event.at));
        Found { pairs: what.difference.is_some().then_some(far), blocks, what }
    });
    if found.difference.is_some() || cut || found.stopped.is_some() {
        return found;
    }
    let left = left_differs(source, target, tolerance, &mut found.substituted, &mut found.replaced);
    let seen = |what| Difference::new(None, None, what);
    let end = end_differs(&source.1.end, &target.1.end).map(seen);
    let variable = end.or_else(|| variables_differ(source, target, names));
    // What a place may have put off says less than anything else.
    found.difference = match (variable, left.map(seen)) {
        (Some(variable), Some(left)) if variable.by_place => Some(left),
        (variable, left) => variable.or(left),
    };
    found
}

/// What an observer could tell of each of two runs, in these orders.
pub(super) fn acts<'r>(
    source: (&Side<'_>, &'r Run),
    target: (&Side<'_>, &'r Run),
    [ours, theirs]: &[Order<'r>; 2],
) -> [Vec<Act<'r>>; 2] {
    let left = |what: &EventKind| {
        builders::is_left_out(source.0, target.0, what).is_some() || builders::is_switch(target.0, what)
    };
    let [mut ours, mut theirs] = observed(source, target, [ours, theirs], &left);
    if !std::ptr::eq(source.0, target.0) && [source, target].iter().any(|one| lacks_messages(one.0.control)) {
        (ours, theirs) = (as_messages(ours, source.0.control), as_messages(theirs, target.0.control));
    }
    if target.0.control.profile().outputs.is_some() {
        (ours, theirs) = without_outputs(ours, theirs);
    }
    if roughing::differs(source.0.control, target.0.control) {
        (ours, theirs) = (roughing::without_passes(ours), roughing::without_passes(theirs));
    }
    if brought(source.0.control, target.0.control) {
        (ours, theirs) = (shown_by_moves(ours), shown_by_moves(theirs));
    }
    let [ours, theirs] = threads::passes(ours, theirs);
    [joined(ours, is_cut(source.1)), joined(theirs, is_cut(target.1))]
}

/// Two runs side by side.
pub(super) struct Pairs<'p, 'r> {
    source: &'p Side<'p>,
    target: &'p Side<'p>,
    /// What variables are called in texts.
    renaming: Renaming<'p>,
    /// True if the target ends the roughing of a contour otherwise.
    roughs_otherwise: bool,
    /// True for two runs of one side, of which all that differs is told.
    one_side: bool,
    /// True where the target's tool word brings a length that the source takes up without one.
    brings_lengths: bool,
    tolerance: Tolerance,
    pub(super) found: Comparison<'r>,
    /// True where a hair is a difference like any other.
    pub(super) strict: bool,
    /// True where a message may stand for a stop.
    pub(super) shows_more: bool,
    /// Where each side's tool is, and how far that may be off by rounding; none before its first move.
    at: [Option<(Position, f64)>; 2],
    /// What runs on each side.
    runs: [Runs; 2],
    /// True where the source returns without a work offset, which the target cannot.
    uncancelled: bool,
    /// True where the source has left for a block of its caller. Where there is none it is a main program, which may go on
    /// at a block of its own: what it does there only a run that goes on there shows.
    left: bool,
}

impl<'p, 'r> Pairs<'p, 'r> {
    /// Nothing is paired yet.
    pub(super) fn new(
        (source, target): (&'p Side<'p>, &'p Side<'p>),
        names: &'p SymbolMap,
        tolerance: Tolerance,
    ) -> Self {
        Self {
            source,
            target,
            renaming: Renaming { names, source: source.control, target: target.control },
            brings_lengths: brought(source.control, target.control),
            roughs_otherwise: roughing::differs(source.control, target.control),
            one_side: std::ptr::eq(source, target),
            tolerance,
            found: Comparison::default(),
            strict: false,
            shows_more: true,
            at: [None; 2],
            runs: [Runs::new(), Runs::new()],
            uncancelled: false,
            left: false,
        }
    }

    /// Pairs the acts of both sides up to the first difference; after the last of a run that was `cut`
    /// nothing is missed. How many of each it came by.
    pub(super) fn walk(&mut self, ours: &[Act<'r>], theirs: &[Act<'r>], cut: bool) -> (usize, usize) {
        let (mut i, mut j) = (0, 0);
        loop {
            let (a, b) = (ours.get(i), theirs.get(j));
            if self.left && b.is_some_and(|b| !matches!(*b.what, EventKind::End { .. })) {
                return (i, j);
            }
            let what = match (a, b) {
                (None, None) => return (i, j),
                (Some(a), Some(b)) => match self.differ(a, b, self.near(a, b)) {
                    None => {
                        if self.roughs_otherwise {
                            self.found.replaced.extend(roughing::stands_for(&a.what));
                        }
                        self.moved(0, a);
                        self.moved(1, b);
                        (i, j) = (i + 1, j + 1);
                        if self.found.stopped.is_some() {
                            return (i, j);
                        }
                        continue;
                    }
                    Some(what) => what,
                },
                _ if cut => return (i, j),
                (Some(_), None) => "the target does less than the source".to_owned(),
                (None, Some(_)) => "the target does more than the source".to_owned(),
            };
            // Settings wait until after it, so what looks at those that come next looks past it.
            let sides = (self.source, self.target);
            if a.is_some_and(|a| builders::passes(sides, &a.what, &mut self.found.replaced)) {
                i += 1;
                continue;
            }
            let (here, there) = (ours.get(i..).unwrap_or_default(), theirs.get(j..).unwrap_or_default());
            let passed = as_long([here, there], cut).unwrap_or_else(|| before_alarm([here, there]));
            if passed != [0; 2] {
                here.iter().take(passed[0]).for_each(|act| self.moved(0, act));
                there.iter().take(passed[1]).for_each(|act| self.moved(1, act));
                (i, j) = (i + passed[0], j + passed[1]);
                continue;
            }
            let ended = |(acts, other): (&&[Act<'r>], usize)| !self.one_side && self.runs[other].ended(acts);
            if let Some(side) = [here, there].iter().zip([1, 0]).position(ended) {
                [here, there][side].iter().take(2).for_each(|act| self.moved(side, act));
                (i, j) = if side == 0 { (i + 2, j) } else { (i, j + 2) };
                continue;
            }
            // What a cycle does to a spindle that may stand on one side has no counterpart on the other.
            let cycles = [here, there].map(|acts| acts.first().is_some_and(|act| act.told == Told::Cycle));
            if cycles.contains(&true) && self.runs.iter().any(Runs::may_stand) {
                a.into_iter().filter(|_| cycles[0]).for_each(|act| self.moved(0, act));
                b.into_iter().filter(|_| cycles[1]).for_each(|act| self.moved(1, act));
                (i, j) = (i + usize::from(cycles[0]), j + usize::from(cycles[1]));
                continue;
            }
            if self.runs[1].may_be_let_go(there, here) {
                let text = "no source says whether a stop releases a held spindle";
                self.found.substituted.insert(text.to_owned());
                b.into_iter().for_each(|b| self.moved(1, b));
                j += 1;
                continue;
            }
            let runs = |side: usize, acts: &[Act<'r>], others: &[Act<'r>], runs: &[Runs; 2]| {
                acts.first().is_some_and(|act| {
                    may_do_so(act, others, side == 1)
                        || runs[side].is_told(&runs[1 - side], act, others)
                        || runs[side].lets_go(acts)
                        || runs[side].stays_open(act)
                        || runs[side].is_idle_speed(acts)
                        || ends_earlier(runs, side, [acts, others], self.target)
                })
            };
            if runs(0, here, there, &self.runs) {
                a.into_iter().for_each(|a| self.moved(0, a));
                i += 1;
            } else if a.is_some_and(|a| self.passes(0, a)) {
                i += 1;
            } else if runs(1, there, here, &self.runs) {
                b.into_iter().for_each(|b| self.moved(1, b));
                j += 1;
            } else if b.is_some_and(|b| self.passes(1, b)) {
                j += 1;
            } else {
                let difference = Difference::new(told_at(here), told_at(there), what);
                match (a, b) {
                    (Some(a), Some(b)) if self.drifts(a, b) => {}
                    (Some(a), Some(b))
                        if !self.strict && self.differ(a, b, self.tolerance.rounded).is_none() =>
                    {
                        self.found.hair.get_or_insert(difference);
                    }
                    _ => {
                        self.found.difference = Some(difference);
                        return (i, j);
                    }
                }
                a.into_iter().for_each(|a| self.moved(0, a));
                b.into_iter().for_each(|b| self.moved(1, b));
                (i, j) = (i + 1, j + 1);
            }
        }
    }

    pub(super) fn moved(&mut self, side: usize, act: &Act<'r>) {
        if let Some(to) = leaves(&act.what) {
            self.at[side] = Some((to, act.rounded));
        }
        self.runs[side].take(act);
    }

    /// How far apart two acts may lie that count as the same: what their words rounded, a least increment at the
    /// most.
    fn near(&self, source: &Act<'r>, target: &Act<'r>) -> f64 {
        self.tolerance.between(source.rounded, target.rounded).min(self.tolerance.rounded)
    }

    /// True where one side's act has no counterpart and needs none: a move within the least increment that
    /// leaves the tool where the other side's is, a limit on reading ahead, or what the target cannot do and
    /// no axis moves for.
    fn passes(&mut self, side: usize, act: &Act<'r>) -> bool {
        let what: &EventKind = &act.what;
        if let Some((from, to)) = ends(what) {
            // Before its first move a side stands where the other began.
            let began = self.at[side].is_none().then_some((from, 0.0));
            let near = self.at[1 - side].or(began).is_some_and(|(other, rounded)| {
                let allowed = self.tolerance.between(act.rounded, rounded);
                apart(&to, &other) <= allowed.min(self.tolerance.rounded)
            });
            let passes = near && goes_nowhere(what, self.tolerance.rounded);
            if passes {
                self.moved(side, act);
            }
            return passes;
        }
        if side == 1
            && self.brings_lengths
            && self.at.iter().all(Option::is_none)
            && let EventKind::ToolChange { tool } = what
        {
            let text = format!("tool {tool} is changed to before the first move, to bring its length");
            self.found.substituted.insert(text);
            self.moved(side, act);
            return true;
        }
        if side == 0
            && self.brings_lengths
            && act.told == Told::SameTool
            && let EventKind::ToolChange { tool } = what
            && self.target.control.skips_same_tool()
        {
            let text = format!("tool {tool} is in the spindle: the target does not change to it again");
            // Who has said so of the machine is not asked by each program.
            let told = is_told_of_same_tool(self.target.control);
            self.found.substituted.extend((!told).then_some(text));
            return true;
        }
        if side == 1 {
            return is_idle(what) || (self.uncancelled && matches!(what, EventKind::WorkOffset { .. }));
        }
        if let Some(text) = cannot_cancel(self.target, what) {
            self.found.substituted.insert(text);
            self.uncancelled = true;
            return true;
        }
        if let Some(replaced) = goes_on(self.target, what, self.runs[1].coolant()) {
            self.found.replaced.insert(replaced);
            self.moved(0, act);
            return true;
        }
        if let Some(replaced) = is_left_out(self.target, what, act.told) {
            self.found.replaced.insert(replaced);
            return true;
        }
        let leaves = returns_to_caller(what);
        self.left |= leaves.is_some();
        let left_out = makes_ready(self.target, what).or(leaves.map(Some));
        self.found.substituted.extend(left_out.clone().flatten());
        left_out.is_some()
    }

    /// True where two acts are the same but for what incremental words rounded, one move after the other.
    fn drifts(&mut self, source: &Act<'r>, target: &Act<'r>) -> bool {
        let allowed = self.tolerance.between(source.rounded, target.rounded);
        let same = allowed > self.tolerance.rounded && self.differ(source, target, allowed).is_none();
        if same {
            let what = "positions drift apart by more than a least increment: the rounding of incremental moves \
                 adds up";
            self.found.substituted.insert(what.into());
        }
        same
    }

    /// What differs between two acts, if anything does, where positions may lie so far apart.
    fn differ(&mut self, source: &Act<'r>, target: &Act<'r>, allowed: f64) -> Option<String> {
        let stands = stands_for(self.target, &source.what, &target.what);
        let (a, b) = (&source.what, &target.what);
        if !self.shows_more && matches!((&**a, &**b), (EventKind::Stop, EventKind::Message { .. })) {
            return Some("a message stands for a stop".to_owned());
        }
        if let Some((ends, text)) = builders::stands_for(self.source, self.target, (a, b)) {
            self.found.stopped = ends.then(|| text.clone());
            self.found.replaced.insert((Op::Act, text));
            return None;
        }
        let on = self.runs[0].goes_on(a) && self.runs[1].goes_on(b);
        if (on || ends_cycle(source, target)) && may_turn(source, target) {
            let text = "no source says whether the spindle still turns after a tool change or a stop";
            self.found.substituted.insert(text.to_owned());
            return None;
        }
        if let Some(replaced) = stands {
            self.found.replaced.insert(replaced);
            return None;
        }
        if let Some(text) = is_builders(a, b).filter(|_| a != b) {
            self.found.substituted.insert(text);
            return None;
        }
        // A size of the tool was rounded where it was written, which another block did.
        let is_size = matches!(
            **a,
            EventKind::ToolLength { .. } | EventKind::CutterRadius { .. } | EventKind::ToolOffset { .. }
        );
        let allowed = if is_size { allowed.max(self.tolerance.rounded) } else { allowed };
        let mut largest = self.found.largest;
        let paths = match source.rounded.max(target.rounded) {
            // What the words of an arc rounded moves its middle farther than its ends.
            rounded if rounded > 0.0 => ARC_ROUNDINGS * allowed.max(self.tolerance.rounded),
            _ => ARC_ROUNDINGS * allowed,
        };
        let mut what = differ((a, b), target.room, (allowed, paths), &mut largest);
        if let Some(renamed) = what.and_then(|_| self.renaming.event(a, b)) {
            what = differ((&renamed, b), target.room, (allowed, paths), &mut largest);
        }
        match what {
            None => {
                self.found.largest = largest;
                self.found.substituted.extend(letters::doubt(a, b, self.target.control));
                self.found.texts.extend(texts(&source.what, &target.what));
                outside_differs((self.source, a), (self.target, b), self.tolerance)
            }
            Some(what) => {
                let excuse = has_no_feed(a).filter(|_| what == ANOTHER_FEED);
                let what = excuse.is_none().then(|| told(what, a, b));
                self.found.substituted.extend(excuse);
                what
            }
        }
    }
}
