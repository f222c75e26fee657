//! Puts the parts of an expression that stand in temporaries together again.
//!
//! **Law.** `t = e` before an assignment, with `t` read in it once and nowhere after it, is that assignment with `e`: between
//! the two nothing is written that `e` reads. Two signs are none, and a number times 2 over 2 is that number, as it is below
//! 2^1023.
//!
//! **Side condition.** `t` is a temporary. Between the two stand comments and assignments of temporaries alone. `e` is
//! never vacant, and reads no state of the machine. Nothing else in the assignment can stop the run; nor can what stands
//! between, unless `e` cannot, so that what stops it is what did. No statement of them may be skipped by the operator, and
//! the first has no comment. Not after legalization: the target may not take expressions.
//!
//! **Counter-examples.** `tmp.1 = #2; #3 = tmp.1` with `#2` vacant: `#3` is 0. `tmp.1 = #1/#2; #3 = tmp.1 + SQRT[#4]`, where
//! both may stop the run: which one does is what the operator reads.

use super::pass::{Level, Library, Pass};
use super::retarget::drop_statements;
use super::set_before::{MOST_PARTS, is_computed, parts, run_before, set};
use crate::canon::Func;
use crate::ir::analysis::Liveness;
use crate::ir::{BinOp, BlockId, Expr, Place, Program, Stmt, StmtKind, Var};

/// The pass.
pub struct Nested;

impl Pass for Nested {
    fn name(&self) -> &'static str {
        "nested"
    }

    fn keeps_legal(&self) -> bool {
        false
    }

    fn run(&self, program: &mut Program, library: &Library, _: Level) {
        if program.temporaries().next().is_none() {
            return;
        }
        let pairs = pairs(program, &Liveness::of(program, library.ways));
        let mut gone: Vec<(BlockId, usize)> = Vec::new();
        for Pair { id, from, to } in pairs {
            let Some(block) = program.blocks.get_mut(id.index()) else { continue };
            // What stood between may be in a later one by now, and hold more.
            let between = (from + 1..to).filter(|at| !gone.contains(&(id, *at)));
            let stays = |(temp, value): (Var, &Expr)| {
                between.into_iter().all(|at| keeps(&block.stmts[at], temp, value))
                    && whole_of(&block.stmts[to]).is_some_and(|whole| {
                        stops_alone(whole, temp) && parts(value) + parts(whole) <= MOST_PARTS
                    })
            };
            let Some((temp, value)) = set(&block.stmts[from]) else { continue };
            if stays((temp, value)) {
                let value = value.clone();
                if let StmtKind::Assign { value: whole, .. } = &mut block.stmts[to].kind {
                    put(whole, temp, &value);
                }
                gone.push((id, from));
            }
        }
        drop_statements(program, &gone);
    }
}

/// An assignment whose value goes into a later one.
struct Pair {
    id: BlockId,
    from: usize,
    to: usize,
}

/// All of them, those that are read first before the others.
fn pairs(program: &Program, live: &Liveness) -> Vec<Pair> {
    let mut found = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        let start = found.len();
        live.backward(id, &mut |to, is_live| {
            let reader = block.stmts.get(to).filter(|stmt| stmt.site.skip.is_none());
            let Some(StmtKind::Assign { target: Place::Var(written), value: whole }) =
                reader.map(|stmt| &stmt.kind)
            else {
                return;
            };
            for from in run_before(block, to) {
                let Some((temp, value)) = set(&block.stmts[from]) else { continue };
                let fits = reads(whole, temp) == 1
                    && block.stmts[from + 1..to].iter().all(|stmt| keeps(stmt, temp, value))
                    && is_plain(value)
                    && stops_alone(whole, temp)
                    && (*written == temp || !is_live(&temp));
                if fits {
                    found.push(Pair { id, from, to });
                }
            }
        });
        found[start..].sort_by_key(|pair| (pair.to, pair.from));
    }
    found
}

/// How often an expression reads a variable.
fn reads(e: &Expr, var: Var) -> usize {
    let mut count = 0;
    e.variables(&mut |read| count += usize::from(read == var));
    count
}

/// True where a statement neither reads nor writes the temporary, writes nothing that the value reads, and one of the two cannot
/// stop the run.
fn keeps(stmt: &Stmt, temp: Var, value: &Expr) -> bool {
    let Some((written, other)) = set(stmt) else { return stmt.kind == StmtKind::Comment };
    let goes_on = is_sure(other) || is_sure(value);
    goes_on && written != temp && reads(other, temp) == 0 && reads(value, written) == 0
}

/// True for what has a value whatever its variables hold.
fn is_sure(e: &Expr) -> bool {
    let mut sure = true;
    e.walk(&mut |part| {
        sure &= match part {
            Expr::Var(_) | Expr::Number(_) | Expr::Negate(_) | Expr::Call(Func::Fix, _) => true,
            Expr::Binary(BinOp::Add | BinOp::Sub | BinOp::Mul, _) => true,
            Expr::Binary(BinOp::Div, operands) => operands[1].constant().is_some_and(|by| by != 0.0),
            _ => false,
        };
    });
    sure
}

/// True for an expression that is computed, and never vacant.
fn is_plain(value: &Expr) -> bool {
    is_computed(value) && !value.may_be_vacant()
}

/// True if nothing beside the temporary is computed before it is used.
fn stops_alone(whole: &Expr, temp: Var) -> bool {
    match whole {
        Expr::Var(_) | Expr::Number(_) => true,
        Expr::Negate(inner) => stops_alone(inner, temp),
        Expr::Binary(op, operands) => {
            let simple = |e: &Expr| reads(e, temp) == 0 && matches!(e, Expr::Var(_) | Expr::Number(_));
            let within = operands.iter().all(|e| simple(e) || stops_alone(e, temp));
            within && !matches!(op, BinOp::And | BinOp::Or | BinOp::Xor)
        }
        Expr::Call(_, arguments) => matches!(arguments.as_slice(), [only] if stops_alone(only, temp)),
        _ => false,
    }
}

fn whole_of(stmt: &Stmt) -> Option<&Expr> {
    if let StmtKind::Assign { value, .. } = &stmt.kind { Some(value) } else { None }
}

/// Twice a number, halved; none for anything else. Other factors round.
fn halved(e: &Expr) -> Option<&Expr> {
    let two = |e: &Expr| e.constant() == Some(2.0);
    let Expr::Binary(BinOp::Div, outer) = e else { return None };
    match &outer[0] {
        Expr::Binary(BinOp::Mul, inner) if two(&outer[1]) && two(&inner[1]) && !inner[0].may_be_vacant() => {
            Some(&inner[0])
        }
        _ => None,
    }
}

fn put(e: &mut Expr, temp: Var, value: &Expr) {
    match e {
        Expr::Negate(inner) if **inner == Expr::Var(temp) => {
            *e = match value {
                Expr::Negate(twice) if !twice.may_be_vacant() => (**twice).clone(),
                value => Expr::Negate(Box::new(value.clone())),
            };
        }
        Expr::Var(var) if *var == temp => *e = value.clone(),
        _ => e.exprs_mut(&mut |operand| put(operand, temp, value)),
    }
    if let Some(number) = halved(e).cloned() {
        *e = number;
    }
}
