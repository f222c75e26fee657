//! Puts a value straight into the word that its temporary was set for.
//!
//! **Law.** `t = e` before a block of words, with `t` read in one of its words alone and nowhere after it, is that word
//! with `e`: all words of a block are evaluated before it acts.
//!
//! **Side condition.** `t` is a temporary. Between the two stand comments and assignments of temporaries alone, none of which writes what
//! `e` reads. `e` reads a variable, no state of the machine, and is never vacant. No statement of them may be skipped by the
//! operator, and the assignment has no comment. Not after legalization: the target's words may not take expressions.
//!
//! **Counter-examples.** `tmp.1 = #2; X tmp.1` with `#2` vacant is a move to 0, and `X #2` is no X at all. A constant may
//! be an input that an operator edits, and a word that becomes one may no longer stand beside words that are variables.

use super::pass::{Level, Library, Pass};
use super::retarget::drop_statements;
use super::set_before::{MOST_PARTS, is_computed, parts, run_before, set};
use crate::ir::analysis::Liveness;
use crate::ir::{BlockId, Expr, NcItem, Place, Program, Stmt, StmtKind, Var};

/// The pass.
pub struct WordValues;

impl Pass for WordValues {
    fn name(&self) -> &'static str {
        "word-values"
    }

    fn keeps_legal(&self) -> bool {
        false
    }

    fn run(&self, program: &mut Program, library: &Library, _: Level) {
        if program.temporaries().next().is_none() {
            return;
        }
        let found = places(program, &Liveness::of(program, library.ways));
        for Found { block, from, to } in &found {
            let Some(block) = program.blocks.get_mut(block.index()) else { continue };
            let Some(StmtKind::Assign { target: Place::Var(temp), value }) =
                block.stmts.get(*from).map(|stmt| &stmt.kind)
            else {
                continue;
            };
            let (temp, value) = (*temp, value.clone());
            if let Some(stmt) = block.stmts.get_mut(*to) {
                put(&mut stmt.kind, temp, &value);
            }
        }
        let from: Vec<(BlockId, usize)> = found.iter().map(|found| (found.block, found.from)).collect();
        drop_statements(program, &from);
    }
}

/// An assignment whose value goes into a word.
struct Found {
    block: BlockId,
    /// The assignment.
    from: usize,
    /// The block of words.
    to: usize,
}

fn places(program: &Program, live: &Liveness) -> Vec<Found> {
    let mut found = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        live.backward(id, &mut |to, is_live| {
            let Some(words) = block.stmts.get(to).filter(|stmt| stmt.site.skip.is_none()) else { return };
            let StmtKind::Nc(nc) = &words.kind else { return };
            for from in run_before(block, to) {
                let Some((temp, value)) = set(&block.stmts[from]) else { continue };
                let in_words = nc.items.iter().filter(|item| holds(item, temp)).count();
                let fits = in_words == 1
                    && reads(words, temp) == 1
                    && block.stmts[from + 1..to].iter().all(|stmt| keeps(stmt, temp, value))
                    && is_plain(value)
                    && !is_live(&temp);
                if fits {
                    found.push(Found { block: id, from, to });
                }
            }
        });
    }
    found
}

/// True where the whole of a word is the temporary, whatever its sign.
fn holds(item: &NcItem, temp: Var) -> bool {
    let NcItem::Word(_, value) = item else { return false };
    let value = match value {
        Expr::Negate(inner) => inner,
        value => value,
    };
    *value == Expr::Var(temp)
}

/// How often a statement reads a variable.
fn reads(stmt: &Stmt, var: Var) -> usize {
    let mut count = 0;
    stmt.kind.exprs(&mut |e| e.variables(&mut |read| count += usize::from(read == var)));
    count
}

/// True where a statement neither reads nor writes the temporary, and writes nothing that the value reads.
fn keeps(stmt: &Stmt, temp: Var, value: &Expr) -> bool {
    let Some((written, _)) = set(stmt) else { return stmt.kind == StmtKind::Comment };
    let mut read = false;
    value.variables(&mut |var| read |= var == written);
    reads(stmt, temp) == 0 && written != temp && !read
}

/// True for an expression of a few variables and numbers that is never vacant.
fn is_plain(value: &Expr) -> bool {
    // A word with a minus is not there where what follows is vacant.
    let inner = if let Expr::Negate(inner) = value { inner } else { value };
    is_computed(value) && parts(value) <= MOST_PARTS && !inner.may_be_vacant()
}

fn put(kind: &mut StmtKind, temp: Var, value: &Expr) {
    let StmtKind::Nc(nc) = kind else { return };
    for item in nc.items.iter_mut().filter(|item| holds(item, temp)) {
        let NcItem::Word(_, word) = item else { continue };
        *word = match (&*word, value) {
            // Two signs are none.
            (Expr::Negate(_), Expr::Negate(inner)) => (**inner).clone(),
            (Expr::Negate(_), value) => Expr::Negate(Box::new(value.clone())),
            (_, value) => value.clone(),
        };
    }
}
