//! Sequence numbers at the head of what became of their blocks.
//!
//! Law: where a block of the source became several statements, its number stands at the first of them, once: whoever
//! starts there by the number starts at its beginning. What only computes a temporary for a statement after it is its
//! beginning, too. Side condition: a number that is a label stays with the block that it finds, and one that ends a contour of a lathe
//! with the last of its statements that has it. Counter-example: `#101=0`, `N8 #504=#101`, of which a start at N8 leaves out the first.

use crate::canon::Role;
use crate::ir::{Class, Expr, Module, Place, Program, SourceInfo, StmtKind, TermKind, Var};
use crate::legalize::Context;
use crate::syntax::Label;

/// A statement by block and place; the end of a block stands behind its last one.
type At = (usize, usize);

/// Moves the numbers.
pub fn run(module: &mut Module, _: &mut Context<'_>) {
    for program in &mut module.programs {
        for ((block, stmt), number) in moves(program) {
            let Some(block) = program.blocks.get_mut(block) else { continue };
            let site = match block.stmts.get_mut(stmt) {
                Some(stmt) => &mut stmt.site,
                None => &mut block.term.site,
            };
            site.sequence = number.into();
        }
    }
}

/// What stands at a place.
#[derive(Clone, Copy)]
enum Thing<'p> {
    Stmt(&'p StmtKind),
    Term(&'p TermKind),
}

impl Thing<'_> {
    fn reads(self) -> Vec<Var> {
        let mut read = Vec::new();
        let mut note = |e: &Expr| {
            e.walk(&mut |e| {
                if let Expr::Var(var) = e {
                    read.push(*var);
                }
            });
        };
        match self {
            Thing::Stmt(kind) => kind.exprs(&mut note),
            Thing::Term(kind) => kind.exprs(&mut note),
        }
        read
    }

    fn temporary(self) -> Option<Var> {
        match self {
            Thing::Stmt(StmtKind::Assign { target: Place::Var(var), .. }) => {
                Some(*var).filter(|var| var.class == Class::Temp)
            }
            _ => None,
        }
    }
}

/// Where the numbers go, and where they no longer stand.
fn moves(program: &Program) -> Vec<(At, Option<u32>)> {
    let mut found = Vec::new();
    let mut head: Option<(At, &SourceInfo, Option<u32>)> = None;
    // What stands directly before and comes from no block of its own.
    let mut before: Vec<(At, Thing<'_>)> = Vec::new();
    let ends = ends_of_contours(program);
    for (at, block) in program.blocks.iter().enumerate() {
        if block.labels.iter().any(|label| matches!(label, Label::Number(_))) {
            head = None;
            before.clear();
        }
        let stmts = block.stmts.iter().map(|stmt| (&stmt.site, Thing::Stmt(&stmt.kind)));
        let all = stmts.chain([(&block.term.site, Thing::Term(&block.term.kind))]);
        for (place, (site, thing)) in all.enumerate() {
            let here = (at, place);
            if site.span.is_empty() && site.sequence.is_none() {
                match thing {
                    Thing::Term(TermKind::Jump(_) | TermKind::Branch { .. }) => before.push((here, thing)),
                    _ if thing.temporary().is_some() => before.push((here, thing)),
                    _ => before.clear(),
                }
                continue;
            }
            match &mut head {
                Some((first, one, number)) if one.span == site.span && !site.span.is_empty() => {
                    let own = site.sequence.get().filter(|own| !ends.contains(own));
                    if own.is_some() && number.is_none() {
                        *number = own;
                        found.push((*first, own));
                    }
                    if own.is_some() {
                        found.push((here, None));
                    }
                }
                _ => {
                    let first = first_of(&before, thing).unwrap_or(here);
                    if first != here && site.sequence.is_some() {
                        found.extend([(first, site.sequence.get()), (here, None)]);
                    }
                    head = Some((first, site, site.sequence.get()));
                }
            }
            before.clear();
        }
    }
    found
}

/// The numbers of the last blocks of contours: a cycle reads no further.
fn ends_of_contours(program: &Program) -> Vec<u32> {
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    let ends = stmts.filter_map(|stmt| stmt.kind.nc()?.word(Role::ContourLast)?.constant());
    ends.map(|number| number as u32).collect()
}

/// The first of what stands before that computes temporaries for a statement alone.
fn first_of(before: &[(At, Thing<'_>)], thing: Thing<'_>) -> Option<At> {
    if before.is_empty() {
        return None;
    }
    let (mut wanted, mut first) = (thing.reads(), None);
    for &(at, thing) in before.iter().rev() {
        match thing.temporary() {
            Some(var) if !wanted.contains(&var) => break,
            Some(_) => first = Some(at),
            None => {}
        }
        wanted.extend(thing.reads());
    }
    first
}
