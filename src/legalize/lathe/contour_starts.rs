//! Where the contours of a program stand, and from where their cycles begin.

use super::place::Place;
use super::straight::entered_straight;
use crate::canon::{Op, Role};
use crate::ir::{Expr, Nc, Program, Stmt};
use std::collections::BTreeMap;

/// The place of a statement: its block, and where it stands in it.
pub type At = (usize, usize);

/// The contours of a program: where they stand, and where their cycles begin.
#[derive(Default)]
pub struct Contours {
    /// The places of the first and the last block of each.
    spans: Vec<(At, At)>,
    /// Where the cycles begin that read a contour, as far as they agree, by the number of its first block: X and Z.
    pub starts: BTreeMap<u32, [Option<f64>; 2]>,
}

impl Contours {
    /// Those of a program.
    pub fn of(program: &Program) -> Self {
        let straight = entered_straight(program);
        let (mut place, mut starts) = (Place::default(), BTreeMap::<u32, [Option<f64>; 2]>::new());
        let (mut named, mut numbered) = (Vec::new(), BTreeMap::<u32, At>::new());
        for (at, (block, straight)) in program.blocks.iter().zip(straight).enumerate() {
            if !straight {
                place = Place::default();
            }
            for (count, stmt) in block.stmts.iter().enumerate() {
                place.enter(stmt);
                if let Some(number) = stmt.site.sequence.get() {
                    numbered.entry(number).or_insert((at, count));
                }
                let cycle = stmt.kind.nc().filter(|nc| nc.ops().any(Op::reads_contour));
                let number =
                    |nc: &Nc, role| nc.word(role).and_then(Expr::constant).map(|number| number as u32);
                let ends =
                    cycle.and_then(|nc| number(nc, Role::ContourFirst).zip(number(nc, Role::ContourLast)));
                if let Some(ends) = ends {
                    let here = [place.x(), place.z()];
                    let known = starts.entry(ends.0).or_insert(here);
                    for (known, here) in known.iter_mut().zip(here) {
                        *known = known.filter(|known| Some(*known) == here);
                    }
                    named.push(ends);
                }
                place.step(stmt);
            }
        }
        let span = |(first, last): (u32, u32)| Some((*numbered.get(&first)?, *numbered.get(&last)?));
        Self { spans: named.into_iter().filter_map(span).collect(), starts }
    }

    /// Where the cycles begin that read the contour which a statement begins.
    pub fn starts_at(&self, stmt: &Stmt) -> Option<[Option<f64>; 2]> {
        stmt.site.sequence.get().and_then(|number| self.starts.get(&number)).copied()
    }

    /// True inside a contour.
    pub fn inside(&self, at: At) -> bool {
        self.spans.iter().any(|(first, last)| *first <= at && at <= *last)
    }

    /// True where both stand in the same contours.
    pub fn together(&self, one: At, other: At) -> bool {
        let inside = |(first, last): &(At, At), at: At| *first <= at && at <= *last;
        self.spans.iter().all(|span| inside(span, one) == inside(span, other))
    }
}
