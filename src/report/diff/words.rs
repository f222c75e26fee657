//! A diff in the words of a machinist.

use crate::control::trace::{AXIS_NAMES, EventKind, FeedMode, Position, Spindle};
use crate::diff::{Diff, ProgramDiff, Verdict};
use crate::report::trace::number;
use crate::verify::{Change, Listing, Seen};

/// The whole diff in one line.
pub fn headline(diff: &Diff) -> String {
    let count = |verdict| diff.programs.iter().filter(|program| program.verdict == verdict).count();
    let of = |count: usize| format!("{count} {}", if count == 1 { "program" } else { "programs" });
    match diff.verdict {
        Verdict::Same if diff.files.is_empty() && diff.programs.is_empty() => "Nothing changed.".into(),
        Verdict::Same => "No effect on the machine.".into(),
        Verdict::Undecided => format!(
            "No difference was found for the machine, but {} could not be looked at in every way.",
            of(count(Verdict::Undecided))
        ),
        Verdict::Different => format!("The machine does something else: {}.", of(count(Verdict::Different))),
    }
}

/// The programs of which there is something to be read.
pub fn told(diff: &Diff) -> impl Iterator<Item = &ProgramDiff> {
    diff.programs.iter().filter(|program| !is_silent(program))
}

fn is_silent(program: &ProgramDiff) -> bool {
    let structure = program.structure.as_ref().is_none_or(Vec::is_empty);
    program.verdict == Verdict::Same && program.why.is_empty() && structure
}

/// How many others there are, where others are read of.
pub fn silent(diff: &Diff) -> Option<String> {
    let count = diff.programs.iter().filter(|program| is_silent(program)).count();
    let programs = if count == 1 { "program" } else { "programs" };
    (count > 0 && diff.verdict != Verdict::Same)
        .then(|| format!("{count} other {programs}: no effect on the machine"))
}

/// What a program amounts to.
pub fn verdict(program: &ProgramDiff) -> &'static str {
    match program.verdict {
        Verdict::Same => "no effect on the machine",
        Verdict::Undecided => "no difference found, not shown in every way",
        Verdict::Different => "different for the machine",
    }
}

/// A program by its name and files.
pub fn title(program: &ProgramDiff) -> String {
    let name = program.program.as_deref().unwrap_or("program without a name");
    match (&program.old, &program.new) {
        (Some(old), Some(new)) if old != new => format!("{name} ({old} -> {new})"),
        (_, Some(file)) | (Some(file), None) => format!("{name} ({file})"),
        (None, None) => name.to_owned(),
    }
}

/// What is to be known of a listing before it is read.
pub fn about(listing: &Listing, tolerance: f64) -> String {
    let unit = if listing.inch { "inches" } else { "millimetres" };
    let tolerance = match tolerance > 0.0 {
        true => format!("; up to {} mm counts as the same", number(tolerance)),
        false => String::new(),
    };
    format!("in {} of {} scenarios, {unit}{tolerance}", listing.differing, listing.scenarios)
}

/// The lines of a change, as people name them.
pub fn lines(change: &Change) -> String {
    let at = |seen: &Seen| seen.moment.line;
    match (&change.old, &change.new) {
        (Some(old), Some(new)) if at(old) == at(new) => format!("line {}", at(new)),
        (Some(old), Some(new)) => format!("line {} -> {}", at(old), at(new)),
        (Some(old), None) => format!("old line {}", at(old)),
        (None, Some(new)) => format!("new line {}", at(new)),
        (None, None) => String::new(),
    }
}

/// What changed there.
pub fn what(change: &Change, inch: bool) -> String {
    let unit = Unit { inch, plain: change.plain };
    let mut text = match (&change.old, &change.new) {
        (Some(old), Some(new)) => unit.pair(old, new, &change.what),
        (Some(old), None) => format!("taken out: {}", unit.alone(old)),
        (None, Some(new)) => format!("added: {}", unit.alone(new)),
        (None, None) => change.what.clone(),
    };
    if change.times > 1 {
        text += &format!("; {} times in a run", change.times);
    }
    if change.alike > 0 {
        let places = if change.alike == 1 { "place that follows" } else { "places that follow" };
        text += &format!("; and by just as much at {} {places}", change.alike);
    }
    text
}

struct Unit {
    inch: bool,
    /// True where positions are those of the program.
    plain: bool,
}

impl Unit {
    /// Two that belong together.
    fn pair(&self, old: &Seen, new: &Seen, what: &str) -> String {
        let (a, b) = (&old.what, &new.what);
        let mut out = Vec::new();
        let moves = is_move(a) && is_move(b);
        if moves && old.work != new.work {
            out.push(format!("work offset {} -> {}", old.work, new.work));
        }
        if moves && old.length != new.length {
            out.push(format!("tool length {} -> {}", old.length, new.length));
        }
        if let (Some(from), Some(to)) = (to(a), to(b))
            && (self.plain || out.is_empty())
        {
            out.extend(self.axes("", &from, &to));
        }
        out.extend(self.others(a, b));
        let kind = kind(a);
        if out.is_empty() { format!("{kind}: {what}") } else { format!("{kind}: {}", out.join(", ")) }
    }

    /// The axes at which two places differ.
    fn axes(&self, before: &str, from: &Position, to: &Position) -> Vec<String> {
        let all = AXIS_NAMES.iter().enumerate().filter_map(|(axis, name)| {
            let (a, b) = (from.0[axis], to.0[axis]);
            let name = format!("{before}{}", name.to_ascii_uppercase());
            let linear = !(3..6).contains(&axis);
            let by = self.length(b - a, linear);
            ((a - b).abs() > 5e-7).then(|| match self.plain {
                true => format!(
                    "{name} {} -> {} ({})",
                    self.length(a, linear),
                    self.length(b, linear),
                    signed(&by)
                ),
                false => format!("{name} by {}", signed(&by)),
            })
        });
        all.collect()
    }

    /// A length, with the places that a drawing has; with more where these would show nothing.
    fn length(&self, value: f64, linear: bool) -> String {
        let value = if self.inch && linear { value / 25.4 } else { value };
        let places = if self.inch && linear { 4 } else { 3 };
        let text = format!("{value:.places$}");
        let shows = text.bytes().any(|digit| (b'1'..=b'9').contains(&digit)) || value.abs() < 5e-7;
        let text = if shows { text } else { format!("{value:.6}") };
        match text.strip_prefix('-') {
            Some(rest) if !rest.bytes().any(|digit| (b'1'..=b'9').contains(&digit)) => rest.to_owned(),
            _ => text,
        }
    }

    fn feed(&self, feed: f64, mode: FeedMode) -> String {
        let by = if self.inch && mode != FeedMode::Inverse { feed / 25.4 } else { feed };
        let unit = match (mode, self.inch) {
            (FeedMode::PerMinute, false) => "mm/min",
            (FeedMode::PerMinute, true) => "in/min",
            (FeedMode::PerTurn, false) => "mm/turn",
            (FeedMode::PerTurn, true) => "in/turn",
            (FeedMode::Inverse, _) => "by inverse time",
        };
        format!("{} {unit}", number(by))
    }

    /// What differs besides places.
    fn others(&self, a: &EventKind, b: &EventKind) -> Vec<String> {
        use EventKind::*;
        let mut out = Vec::new();
        if let (Some((feed, mode)), Some((other, other_mode))) = (feed_of(a), feed_of(b))
            && ((feed - other).abs() > 1e-4 * feed.abs() || mode != other_mode)
        {
            out.push(format!("feed {} -> {}", self.feed(feed, mode), self.feed(other, other_mode)));
        }
        match (a, b) {
            (Arc { centre, sweep, radius, .. }, Arc { centre: there, sweep: other, radius: r2, .. }) => {
                if self.plain {
                    out.extend(self.axes("centre ", centre, there));
                }
                let turn = |sweep: f64| if sweep > 0.0 { "counter-clockwise" } else { "clockwise" };
                if turn(*sweep) != turn(*other) {
                    out.push(format!("{} -> {}", turn(*sweep), turn(*other)));
                } else if (sweep - other).abs() > 1e-3 {
                    out.push(format!("angle {} -> {} degrees", number(sweep.abs()), number(other.abs())));
                }
                if (radius - r2).abs() > 5e-7 {
                    out.push(format!("radius {} -> {}", self.length(*radius, true), self.length(*r2, true)));
                }
            }
            (Rapid { .. } | Feed { .. } | Probe { .. } | Thread { .. }, _) => {}
            _ => {
                let (a, b) = (self.told(a), self.told(b));
                if a != b {
                    out.push(format!("{a} -> {b}"));
                }
            }
        }
        out
    }

    /// One that has no counterpart.
    fn alone(&self, seen: &Seen) -> String {
        let kind = kind(&seen.what);
        let to = to(&seen.what).filter(|_| self.plain).map(|to| {
            let from = from(&seen.what).unwrap_or_default();
            let moved = AXIS_NAMES.iter().enumerate().filter(|(axis, _)| from.0[*axis] != to.0[*axis]);
            let all = moved.map(|(axis, name)| {
                format!("{} {}", name.to_ascii_uppercase(), self.length(to.0[axis], !(3..6).contains(&axis)))
            });
            all.collect::<Vec<_>>().join(" ")
        });
        let feed = feed_of(&seen.what).map(|(feed, mode)| format!("at {}", self.feed(feed, mode)));
        match (to, is_move(&seen.what)) {
            (Some(to), _) => {
                let parts = [format!("{kind} to {to}"), feed.unwrap_or_default()];
                parts.join(" ").trim().to_owned()
            }
            (None, true) => kind.to_owned(),
            (None, false) => match self.told(&seen.what) {
                told if told.is_empty() => kind.to_owned(),
                told => format!("{kind} {told}"),
            },
        }
    }

    /// What an event that moves nothing says.
    fn told(&self, what: &EventKind) -> String {
        use EventKind::*;
        match what {
            Dwell { seconds } => format!("{} s", number(*seconds)),
            Spindle { direction, speed, surface } => {
                let unit = if *surface { "surface speed" } else { "turns" };
                match direction {
                    self::Spindle::Stopped => "stopped".into(),
                    self::Spindle::Clockwise => format!("clockwise, {} {unit}", number(*speed)),
                    self::Spindle::CounterClockwise => {
                        format!("counter-clockwise, {} {unit}", number(*speed))
                    }
                    self::Spindle::Oriented => "held at an angle".into(),
                }
            }
            SpeedLimit { speed } => format!("{} turns", number(*speed)),
            Coolant { state } => state.to_string(),
            ToolReady { tool } | ToolChange { tool } => number(*tool),
            ToolLength { offset, .. } => format!("number {offset}"),
            CutterRadius { side, offset, .. } => format!("{side:?}, number {offset}").to_lowercase(),
            ToolOffset { offset, x, z } => {
                format!("number {offset}, X {} Z {}", self.length(*x, true), self.length(*z, true))
            }
            WorkOffset { number } => number.to_string(),
            Write { state, subscripts, value } => {
                let of: Vec<String> = subscripts.iter().map(ToString::to_string).collect();
                format!("{state} {} = {}", of.join(" "), number(*value)).replace("  ", " ")
            }
            Message { text } | Output { text } => format!("'{text}'"),
            Alarm(stop) => {
                let number = stop.program_number.map(number).unwrap_or_else(|| stop.number.clone());
                format!("{number} {}", stop.text).trim().to_owned()
            }
            Asked { answer } => number(*answer),
            Act { name, words, surface } => crate::report::trace::act(name, words, *surface),
            Other { operation, code } => code.clone().unwrap_or_else(|| operation.to_string()),
            Corner { chamfer, size } => {
                format!("{} {}", if *chamfer { "chamfer" } else { "radius" }, self.length(*size, true))
            }
            End { by } => by.to_string(),
            _ => String::new(),
        }
    }
}

/// A number with its sign.
fn signed(text: &str) -> String {
    if text.starts_with('-') { text.to_owned() } else { format!("+{text}") }
}

fn is_move(what: &EventKind) -> bool {
    to(what).is_some()
}

fn from(what: &EventKind) -> Option<Position> {
    use EventKind::{Arc, Feed, Probe, Rapid, Thread};
    match what {
        Rapid { from, .. }
        | Feed { from, .. }
        | Arc { from, .. }
        | Thread { from, .. }
        | Probe { from, .. } => Some(*from),
        _ => None,
    }
}

fn to(what: &EventKind) -> Option<Position> {
    use EventKind::{Arc, Feed, Probe, Rapid, Thread};
    match what {
        Rapid { to, .. } | Feed { to, .. } | Arc { to, .. } | Thread { to, .. } => Some(*to),
        Probe { aim, .. } => Some(*aim),
        _ => None,
    }
}

fn feed_of(what: &EventKind) -> Option<(f64, FeedMode)> {
    match what {
        EventKind::Feed { feed, mode, .. } | EventKind::Arc { feed, mode, .. } => Some((*feed, *mode)),
        EventKind::Probe { feed, .. } => Some((*feed, FeedMode::PerMinute)),
        _ => None,
    }
}

/// What an event is.
fn kind(what: &EventKind) -> &'static str {
    use EventKind::*;
    match what {
        Rapid { .. } => "rapid move",
        Feed { .. } => "feed move",
        Arc { .. } => "arc",
        Thread { .. } => "thread",
        Probe { .. } => "probe move",
        Corner { .. } => "corner",
        Hole { .. } => "hole",
        Roughing { .. } => "roughing",
        Dwell { .. } => "wait",
        Spindle { .. } => "spindle",
        SpeedLimit { .. } => "limit of the spindle speed",
        Coolant { .. } => "coolant",
        ToolReady { .. } => "tool made ready",
        ToolChange { .. } => "tool change",
        ToolLength { .. } => "tool length",
        CutterRadius { .. } => "cutter radius",
        ToolOffset { .. } => "tool offset",
        WorkOffset { .. } => "work offset",
        Write { .. } => "written",
        Variable { .. } => "variable",
        Stop => "stop",
        OptionalStop => "optional stop",
        Message { .. } => "message",
        Alarm(_) => "alarm",
        Output { .. } => "output",
        Asked { .. } => "answer",
        Other { .. } | Act { .. } => "code",
        End { .. } => "end",
        Enter { .. } | Outside(_) => "call",
        Leave => "return",
        Unsure { .. } => "doubt",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_places_of_a_drawing() {
        let mm = Unit { inch: false, plain: true };
        let inch = Unit { inch: true, plain: true };
        assert_eq!((mm.length(10.0, true), mm.length(-0.0, true)), ("10.000".into(), "0.000".into()));
        assert_eq!((mm.length(0.0002, true), inch.length(25.4, true)), ("0.000200".into(), "1.0000".into()));
        // Degrees are no length.
        assert_eq!(inch.length(90.0, false), "90.000");
        let at = |x: f64| {
            let mut to = Position::default();
            to.0[0] = x;
            to
        };
        assert_eq!(mm.axes("", &at(10.0), &at(10.5)), ["X 10.000 -> 10.500 (+0.500)"]);
        let far = Unit { inch: false, plain: false };
        assert_eq!(far.axes("", &at(10.0), &at(-10.0)), ["X by -20.000"]);
    }
}
