//! Which values have no more places than the format that they are put out in.
//!
//! Law: a whole number over a power of ten has its places, and nothing is rounded of it: an earlier conversion rounded it so.
//! Side condition: on every way to the output the temporary was last given such a quotient. Counter-example: `#100=#1/100` with
//! a fraction in #1.

use crate::ir::analysis::dataflow::{Analysis, Cursor, Direction, Steps, solve};
use crate::ir::analysis::{BitRow, Cfg, Ranges, Summaries, Universe};
use crate::ir::{BinOp, Block, BlockId, Class, Expr, OutputPart, Place, Program, Stmt, StmtKind, Var};
use std::collections::{BTreeMap, BTreeSet};

/// A part of an output, by block, statement and part.
pub(super) type PartOf = (BlockId, usize, usize);

/// Where such values stand.
pub(super) fn rounded(program: &Program, summaries: &Summaries) -> BTreeSet<PartOf> {
    // The places of each temporary that is put out with the same number of them everywhere.
    let mut places: BTreeMap<Var, Option<u32>> = BTreeMap::new();
    for part in outputs(program).flat_map(|(.., parts)| parts) {
        if let Some((temp, fraction)) = put_out(part) {
            let known = places.entry(temp).or_insert(Some(fraction));
            *known = known.filter(|known| *known == fraction);
        }
    }
    let places: BTreeMap<Var, u32> =
        places.into_iter().filter_map(|(temp, fraction)| Some((temp, fraction?))).collect();
    if places.is_empty() {
        return BTreeSet::new();
    }
    let mut vars = BTreeSet::new();
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        if let Some((_, over)) = over_scale(stmt, &places) {
            over.variables(&mut |var| _ = vars.insert(var));
        }
    }
    let ranges = Ranges::of_these(program, summaries, vars);
    let universe = Universe::new(places.keys().copied().collect());
    let rules = Unrounded { places, universe, ranges };
    let states = solve(&rules, program, &Cfg::whole(program, summaries.come_back()));
    let mut cursor = Cursor::default();
    let mut found = BTreeSet::new();
    for (id, at, parts) in outputs(program) {
        let Some(row) = cursor.seek(&rules, &states, program, (id, at)) else { continue };
        for (n, part) in parts.iter().enumerate() {
            let place = put_out(part).and_then(|(temp, _)| rules.universe.place(temp));
            if place.is_some_and(|place| !row.has(place)) {
                found.insert((id, at, n));
            }
        }
    }
    found
}

/// Every output, by block and statement.
fn outputs(program: &Program) -> impl Iterator<Item = (BlockId, usize, &[OutputPart])> {
    program.ids().zip(&program.blocks).flat_map(|(id, block)| {
        block.stmts.iter().enumerate().filter_map(move |(at, stmt)| match &stmt.kind {
            StmtKind::Output(parts) => Some((id, at, parts.as_slice())),
            _ => None,
        })
    })
}

/// The temporary that is put out, and with how many places.
fn put_out(part: &OutputPart) -> Option<(Var, u32)> {
    match part {
        OutputPart::Value { value: Expr::Var(temp), fraction, .. } if temp.class == Class::Temp => {
            Some((*temp, *fraction))
        }
        _ => None,
    }
}

/// The temporary that a statement sets to something over its power of ten, and what stands over it.
fn over_scale<'s>(stmt: &'s Stmt, places: &BTreeMap<Var, u32>) -> Option<(Var, &'s Expr)> {
    let StmtKind::Assign { target: Place::Var(temp), value: Expr::Binary(BinOp::Div, operands) } = &stmt.kind
    else {
        return None;
    };
    let scale = 10f64.powi(i32::try_from(*places.get(temp)?).ok()?);
    let is_sure = stmt.site.skip.is_none() && operands[1].constant() == Some(scale);
    is_sure.then_some((*temp, &operands[0]))
}

/// Follows which of the temporaries may have more places.
struct Unrounded<'p> {
    places: BTreeMap<Var, u32>,
    universe: Universe,
    ranges: Ranges<'p>,
}

impl Analysis for Unrounded<'_> {
    type State = BitRow;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, BitRow)> {
        cfg.roots().iter().map(|root| (*root, self.universe.all())).collect()
    }

    fn block(&self, id: BlockId, block: &Block, row: &mut BitRow) {
        self.stmts(id, block, row);
    }
}

impl Steps for Unrounded<'_> {
    fn stmt(&self, (id, at): (BlockId, usize), stmt: &Stmt, row: &mut BitRow) {
        let Some(Place::Var(target)) = stmt.kind.target() else { return };
        let Some(place) = self.universe.place(*target) else { return };
        match over_scale(stmt, &self.places) {
            Some((_, over)) if self.ranges.at(id, at, over).all_whole() => row.remove(place),
            _ => row.insert(place),
        }
    }
}
