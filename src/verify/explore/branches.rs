//! The branches of a program, and which ways they went.

use super::constants::{Given, impossible};
use crate::control::{ProgramRef, Run};
use crate::syntax::{ItemKind, Target, for_each_item};
use crate::text::Span;
use crate::verify::sides::Side;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// A way that a branch never went.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NotReached {
    /// The line of the branch.
    pub line: u32,
    /// Its column.
    pub column: u32,
    /// What it says.
    pub text: String,
    /// The way: `true`, `false`, or `taken` for a computed jump.
    pub way: &'static str,
}

/// A branch: its file and place.
pub(super) type Place = (usize, Span);

/// The branches of one program, or of several that count as one.
#[derive(Clone)]
pub struct Coverage {
    branches: BTreeMap<Place, (bool, BTreeSet<i64>)>,
    /// The bytes of the longest branch.
    longest: u32,
    /// All ways that were seen anywhere, those of called programs too.
    seen: BTreeSet<(usize, Span, i64)>,
    /// Ways that constants make impossible.
    impossible: BTreeSet<(Place, i64)>,
    /// Ways that were compared by reading both texts.
    read: BTreeSet<(Place, i64)>,
    /// Ways that only other numbers in the program itself would go.
    own: BTreeSet<(Place, i64)>,
}

impl Coverage {
    /// The branches that stand in programs of a side; which ways are impossible is told `as_run` on its emulated control, or
    /// by what sources confirm.
    pub fn new(side: &Side<'_>, programs: &[ProgramRef], as_run: bool) -> Self {
        let (mut branches, mut never) = (BTreeMap::new(), BTreeSet::new());
        for program in programs {
            for block in side.text(*program) {
                for_each_item(&block.items, &mut |item| {
                    let (span, computed) = match &item.kind {
                        ItemKind::If { condition, .. } => (condition.span, false),
                        ItemKind::Do { condition: Some(condition), .. } => (condition.span, false),
                        ItemKind::Branch { .. } => (item.span, false),
                        ItemKind::Goto(Target::Computed(target)) => (target.span, true),
                        _ => return,
                    };
                    branches.insert((program.file, span), (computed, BTreeSet::new()));
                });
            }
            never.extend(
                impossible(side, *program, as_run, &Given::default())
                    .into_iter()
                    .map(|(span, way)| ((program.file, span), way)),
            );
        }
        let longest =
            branches.keys().map(|(_, span): &Place| span.end.saturating_sub(span.start)).max().unwrap_or(0);
        Self {
            branches,
            longest,
            seen: BTreeSet::new(),
            impossible: never,
            read: BTreeSet::new(),
            own: BTreeSet::new(),
        }
    }

    /// Takes out what a program never does with what is `given` to it.
    pub fn given(&mut self, side: &Side<'_>, program: ProgramRef, given: &Given<'_>) {
        let never = impossible(side, program, false, given).into_iter();
        let never = never.map(|(span, way)| ((program.file, span), way));
        self.impossible.extend(never.filter(|(place, _)| self.branches.contains_key(place)));
    }

    /// Notes where a run went. True where that was new.
    pub fn add(&mut self, run: &Run) -> bool {
        self.add_moved(run, &|_, span| span)
    }

    /// The ways that were gone there and not here.
    pub fn lacks(&self, other: &Self) -> Vec<(Place, i64)> {
        let of = |(place, (_, gone)): (&Place, &(bool, BTreeSet<i64>))| {
            let own = self.branches.get(place).map(|(_, own)| own);
            let lacks = gone.iter().filter(|way| !own.is_some_and(|own| own.contains(way)));
            lacks.map(|way| (*place, *way)).collect::<Vec<_>>()
        };
        other.branches.iter().flat_map(of).collect()
    }

    /// True for a run that goes somewhere new.
    pub fn has_new(&self, run: &Run) -> bool {
        run.branches.iter().any(|(branch, ways)| {
            let program = run.programs.get(branch.at.program as usize);
            let seen = |way: &i64| {
                program.is_none_or(|program| self.seen.contains(&(program.file, branch.at.span, *way)))
            };
            !ways.iter().all(seen)
        })
    }

    /// As [`Coverage::add`], for a text whose places stood elsewhere before it was edited.
    pub fn add_moved(&mut self, run: &Run, place: &dyn Fn(usize, Span) -> Span) -> bool {
        let before = self.seen.len();
        for (branch, ways) in run.branches.iter() {
            let Some(program) = run.programs.get(branch.at.program as usize) else { continue };
            let span = place(program.file, branch.at.span);
            for way in ways {
                self.seen.insert((program.file, span, *way));
            }
            for seen in self.touched(program.file, span) {
                seen.extend(ways);
            }
        }
        self.seen.len() > before
    }

    /// The ways seen of the branches that share bytes with a place: those that begin before its end, and no farther
    /// before its start than the longest is long.
    fn touched(&mut self, file: usize, span: Span) -> impl Iterator<Item = &mut BTreeSet<i64>> {
        let first = span.start.saturating_sub(self.longest).min(span.end);
        let near = (file, Span::new(first, 0))..(file, Span::new(span.end, 0));
        let near = self.branches.range_mut(near).filter(move |((_, other), _)| span.start < other.end);
        near.map(|(_, (_, seen))| seen)
    }

    /// Takes in the ways that were gone in a text whose places stood elsewhere before it was edited. True
    /// where one of them was missing.
    pub fn add_gone(&mut self, other: &Self, place: &dyn Fn(usize, Span) -> Span) -> bool {
        let before = self.missing().count();
        for ((file, span), (_, gone)) in &other.branches {
            if let Some((_, seen)) = self.branches.get_mut(&(*file, place(*file, *span))) {
                seen.extend(gone);
            }
        }
        self.missing().count() < before
    }

    /// How many ways there are, and how many of them were gone.
    pub fn totals(&self) -> (usize, usize) {
        let ways = |computed: bool| if computed { 1 } else { 2 };
        let all: usize = self.branches.values().map(|(computed, _)| ways(*computed)).sum();
        let total = all - self.impossible.len() - self.read.len();
        (total, total - self.missing().count())
    }

    /// True where nothing is left to be reached.
    pub fn is_complete(&self) -> bool {
        self.missing().next().is_none()
    }

    fn missing(&self) -> impl Iterator<Item = (Place, &'static str)> + '_ {
        self.branches.iter().flat_map(|(place, (computed, seen))| {
            let none = (*computed && seen.is_empty()).then_some((*place, "taken"));
            let settled = |way: i64| {
                [&self.impossible, &self.read, &self.own].iter().any(|ways| ways.contains(&(*place, way)))
            };
            let lacks = |way: i64| !computed && !seen.contains(&way) && !settled(way);
            let no = lacks(0).then_some((*place, "false"));
            let yes = lacks(1).then_some((*place, "true"));
            none.into_iter().chain(no).chain(yes)
        })
    }

    /// The ways that conditions have left, by file and place, and 0 for false or 1 for true.
    pub fn left(&self) -> Vec<((usize, Span), i64)> {
        let way = |(place, way): (Place, &'static str)| match way {
            "false" => Some((place, 0)),
            "true" => Some((place, 1)),
            _ => None,
        };
        self.missing().filter_map(way).collect()
    }

    /// True for a branch that was come to, and that never went this one of its ways.
    pub(super) fn lacks_one_way(&self, place: Place, way: i64) -> bool {
        let other = self.branches.get(&place).is_some_and(|(_, seen)| seen.contains(&(1 - way)));
        other && self.left().contains(&(place, way))
    }

    /// Takes a way for compared, because both texts say the same there.
    pub(super) fn read(&mut self, place: Place, way: i64) {
        self.read.insert((place, way));
    }

    /// Sets the ways aside that branches have left which the program's own numbers decide: those at these places, but for
    /// some.
    pub fn set_aside(&mut self, file: usize, own: &BTreeSet<Span>, but: &BTreeSet<(Place, i64)>) {
        let left = self.left().into_iter().filter(|way| !but.contains(way));
        let ours = left.filter(|((of, span), _)| *of == file && own.contains(span));
        self.own = ours.collect();
    }

    /// The ways that were set aside.
    pub fn aside(&self, side: &Side<'_>) -> Vec<NotReached> {
        let named = |way: i64| if way == 0 { "false" } else { "true" };
        self.own.iter().map(|(place, way)| told(side, *place, named(*way))).collect()
    }

    /// The ways that were compared by reading both texts.
    pub fn by_text(&self, side: &Side<'_>) -> Vec<NotReached> {
        let named = |way: i64| if way == 0 { "false" } else { "true" };
        self.read.iter().map(|(place, way)| told(side, *place, named(*way))).collect()
    }

    /// The ways that were never gone.
    pub fn not_reached(&self, side: &Side<'_>) -> Vec<NotReached> {
        self.missing().map(|(place, way)| told(side, place, way)).collect()
    }
}

/// A way as it is reported.
fn told(side: &Side<'_>, (file, span): Place, way: &'static str) -> NotReached {
    let source = side.files.get(file).map_or(&[][..], |file| file.parsed.source);
    let (line, column) = side.line_of(file, span.start);
    let text = source.get(span.range()).map(String::from_utf8_lossy).unwrap_or_default();
    NotReached { line, column, text: text.into_owned(), way }
}
