//! The path of a run, as it is drawn.

use super::{Coordinates, Drawing, Point};
use crate::control::Run;
use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, MOST_ZEROS, Place, Plane, Position, Side, Zero};
use std::mem::discriminant;

/// Millimetres of an inch.
const INCH: f64 = 25.4;

/// A stretch of the path.
#[derive(Clone)]
pub(super) struct Stroke {
    pub kind: Kind,
    /// The tool, counted in [`Path::tools`].
    pub tool: usize,
    /// How far the middle of the cutter lies to the left of the way.
    pub aside: f64,
    /// The plane that left and right are seen in.
    pub plane: Plane,
    pub points: Vec<Point>,
}

/// A place that something is said of.
pub(super) struct Mark {
    pub at: Point,
    pub name: String,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Rapid,
    Cut,
}

/// A name for something that happens in a run.
pub(super) struct Name<'n> {
    pub at: Place,
    pub what: &'n EventKind,
    pub name: String,
}

/// A run, and names for some of the things that happen in it.
pub(super) type Named<'n> = (&'n Run, &'n [Name<'n>]);

/// What is drawn.
#[derive(Default)]
pub(super) struct Path {
    pub strokes: Vec<Stroke>,
    pub holes: Vec<Point>,
    pub touches: Vec<Point>,
    /// The tools that moved; none for the one that nobody called.
    pub tools: Vec<Option<f64>>,
    /// True where the lengths are inches.
    pub inch: bool,
    /// True where X was told as a diameter: it is drawn as a radius.
    pub diameters: bool,
    /// True where they count from the work zero.
    pub from_work: bool,
    /// True where moves count from more than one work zero.
    pub many_zeros: bool,
    /// Places that something is said of.
    pub marks: Vec<Mark>,
    /// True where cutter compensation was in force with a radius of 0.
    pub no_radius: bool,
    /// Whether something moved in millimetres, and in inches.
    units: [bool; 2],
    tool: Option<f64>,
    side: (Side, f64),
    plane: Plane,
}

impl Path {
    /// As the program runs: in its unit, and from its work zero. A run with more changes of the zero than are
    /// remembered is drawn in machine coordinates.
    pub fn of(run: &Run, coordinates: Coordinates) -> Self {
        let path = Path::in_millimetres(run, &[], coordinates == Coordinates::Work && has_zeros(run));
        if path.units == [false, true] { path.in_inches() } else { path }
    }

    /// The paths of two runs, both in the unit of the first and from zeros of one kind.
    pub fn of_both(
        (source, ours): Named<'_>,
        target: Option<Named<'_>>,
        coordinates: Coordinates,
    ) -> (Self, Option<Self>) {
        let all_known = has_zeros(source) && target.is_none_or(|(run, _)| has_zeros(run));
        let from_work = coordinates == Coordinates::Work && all_known;
        let source = Path::in_millimetres(source, ours, from_work);
        let target = target.map(|(run, theirs)| Path::in_millimetres(run, theirs, from_work));
        match source.units {
            [false, true] => (source.in_inches(), target.map(Path::in_inches)),
            _ => (source, target),
        }
    }

    fn in_millimetres(run: &Run, names: &[Name<'_>], from_work: bool) -> Self {
        let mut path = Path { from_work, ..Path::default() };
        let mut marked: Vec<Option<(bool, Point)>> = vec![None; names.len()];
        let mut coming = run.zeros.iter().peekable();
        let (mut zero, mut first) = (Zero::default(), None);
        for (at, event) in run.events.iter().enumerate() {
            while let Some((_, next)) = coming.next_if(|(before, _)| *before <= at) {
                zero = *next;
            }
            if is_move(&event.what) {
                path.units[usize::from(zero.inch)] = true;
                path.plane = zero.plane;
                path.diameters |= zero.diameters;
                let above = [zero.at[0], zero.at[1]];
                path.many_zeros |= *first.get_or_insert(above) != above;
            }
            let zero = if from_work { zero.at } else { [0.0; 3] };
            path.add(&event.what, zero);
            let Some(Position(end)) = end_of(&event.what) else { continue };
            for (name, mark) in names.iter().zip(&mut marked) {
                let is_it = *name.what == event.what;
                let here = name.at == event.at && discriminant(name.what) == discriminant(&event.what);
                // A block in a loop does the same in many places: the one that was told of is meant.
                if here && mark.is_none_or(|(sure, _)| is_it && !sure) {
                    *mark = Some((is_it, std::array::from_fn(|axis| end[axis] - zero[axis])));
                }
            }
        }
        let marks = names.iter().zip(marked);
        let marks = marks.filter_map(|(name, mark)| Some(Mark { at: mark?.1, name: name.name.clone() }));
        path.marks = marks.collect();
        if path.diameters {
            path.each_point(|[x, y, z]| [x / 2.0, y, z]);
        }
        path
    }

    fn each_point(&mut self, change: impl Fn(Point) -> Point) {
        let strokes = self.strokes.iter_mut().flat_map(|stroke| &mut stroke.points);
        let marks = self.marks.iter_mut().map(|mark| &mut mark.at);
        for point in strokes.chain(&mut self.holes).chain(&mut self.touches).chain(marks) {
            *point = change(*point);
        }
    }

    fn in_inches(mut self) -> Self {
        self.inch = true;
        self.each_point(|point| point.map(|value| value / INCH));
        self.strokes.iter_mut().for_each(|stroke| stroke.aside /= INCH);
        self
    }

    /// The unit of its lengths.
    pub fn unit(&self) -> &'static str {
        if self.inch { "inch" } else { "mm" }
    }

    fn add(&mut self, what: &EventKind, zero: Point) {
        let point = |axes: &Axes| -> Point { std::array::from_fn(|axis| axes[axis] - zero[axis]) };
        match what {
            EventKind::Rapid { from, to } => self.line(Kind::Rapid, point(&from.0), point(&to.0)),
            EventKind::Feed { from, to, .. } | EventKind::Thread { from, to, .. } => {
                self.line(Kind::Cut, point(&from.0), point(&to.0));
            }
            EventKind::Probe { from, to, hit, .. } => {
                self.line(Kind::Cut, point(&from.0), point(&to.0));
                self.touches.extend(hit.then(|| point(&to.0)));
            }
            EventKind::Arc { from, to, centre, plane, sweep, diameters, .. } => {
                let scale = [if *diameters { 2.0 } else { 1.0 }, 1.0, 1.0];
                let ends = (point(&from.0), point(&to.0));
                self.arc(ends, point(&centre.0), plane.axes(), *sweep, scale);
            }
            EventKind::Hole { at, .. } => self.holes.push(point(&at.0)),
            EventKind::ToolChange { tool } => self.tool = Some(*tool),
            EventKind::CutterRadius { side, value, .. } => self.side = (*side, *value),
            _ => {}
        }
    }

    /// The drawing from above; over Z and X, if the path has depth and no Y or all cuts are made in that plane.
    pub fn flat(&self) -> Drawing {
        let moves = |axis: usize| {
            let mut values = self.points().map(|point| point[axis]);
            values.next().is_some_and(|first| values.any(|value| value != first))
        };
        let mut cuts = self.strokes.iter().filter(|stroke| stroke.kind == Kind::Cut).peekable();
        let in_zx = cuts.peek().is_some() && cuts.all(|stroke| stroke.plane == Plane::Zx);
        if in_zx || (moves(2) && !moves(1)) {
            Drawing { axes: Some(('Z', 'X')), project: |point| (point[2], point[0]) }
        } else {
            Drawing { axes: Some(('X', 'Y')), project: |point| (point[0], point[1]) }
        }
    }

    /// The points that a drawing must hold: all but the way to the first cut and the way from the last.
    pub fn framed(&self) -> Vec<Point> {
        if self.strokes.iter().all(|stroke| stroke.kind == Kind::Rapid) {
            return self.points().collect();
        }
        let is_cut = |stroke: &Stroke| stroke.kind == Kind::Cut;
        let first = self.strokes.iter().position(is_cut).unwrap_or(0);
        let last = self.strokes.iter().rposition(is_cut).unwrap_or(0);
        let before = self.strokes[..first].last().and_then(|stroke| stroke.points.last());
        let behind = self.strokes[last..].get(1).and_then(|stroke| stroke.points.first());
        let within = self.strokes[first..=last].iter().flat_map(|stroke| &stroke.points);
        before.into_iter().chain(within).chain(behind).copied().collect()
    }

    pub fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.strokes.iter().flat_map(|stroke| stroke.points.iter().copied())
    }

    /// A piece of the way; it goes on with the last stroke if it is of the same kind.
    pub fn line(&mut self, kind: Kind, from: Point, to: Point) {
        let tool = self.tools.iter().position(|tool| *tool == self.tool).unwrap_or_else(|| {
            self.tools.push(self.tool);
            self.tools.len() - 1
        });
        let aside = match self.side {
            _ if kind == Kind::Rapid => 0.0,
            (Side::Off, _) => 0.0,
            (Side::Left, radius) => radius,
            (Side::Right, radius) => -radius,
        };
        self.no_radius |= kind == Kind::Cut && self.side.0 != Side::Off && aside == 0.0;
        let plane = self.plane;
        let goes_on = |stroke: &&mut Stroke| {
            let alike = stroke.kind == kind && stroke.tool == tool && stroke.aside == aside;
            alike && stroke.plane == plane && stroke.points.last() == Some(&from)
        };
        match self.strokes.last_mut().filter(goes_on) {
            Some(stroke) => stroke.points.push(to),
            None => self.strokes.push(Stroke { kind, tool, aside, plane, points: vec![from, to] }),
        }
    }

    /// An arc in pieces of at most three degrees; lengths along the axes are so many times real ones.
    fn arc(
        &mut self,
        (from, to): (Point, Point),
        centre: Point,
        (first, second, along): (usize, usize, usize),
        sweep: f64,
        scale: Point,
    ) {
        let (wide, high) = (scale[first], scale[second]);
        let (a, b) = ((from[first] - centre[first]) / wide, (from[second] - centre[second]) / high);
        let pieces = ((sweep.abs() / 3.0).ceil() as usize).clamp(1, 400);
        let mut before = from;
        for piece in 1..=pieces {
            let part = piece as f64 / pieces as f64;
            let (sin, cos) = (sweep * part).to_radians().sin_cos();
            let mut next = from;
            next[first] = centre[first] + wide * (a * cos - b * sin);
            next[second] = centre[second] + high * (a * sin + b * cos);
            next[along] = from[along] + (to[along] - from[along]) * part;
            let next = if piece == pieces { to } else { next };
            self.line(Kind::Cut, before, next);
            before = next;
        }
    }
}

/// Where a move ends.
fn end_of(what: &EventKind) -> Option<Position> {
    match what {
        EventKind::Rapid { to, .. } | EventKind::Feed { to, .. } | EventKind::Thread { to, .. } => Some(*to),
        EventKind::Probe { to, .. } | EventKind::Arc { to, .. } => Some(*to),
        EventKind::Hole { at, .. } => Some(*at),
        _ => None,
    }
}

/// True where all changes of the zero point are known.
fn has_zeros(run: &Run) -> bool {
    run.zeros.len() < MOST_ZEROS
}

fn is_move(what: &EventKind) -> bool {
    matches!(what, EventKind::Rapid { .. } | EventKind::Feed { .. } | EventKind::Thread { .. })
        || matches!(what, EventKind::Probe { .. } | EventKind::Arc { .. } | EventKind::Hole { .. })
}
