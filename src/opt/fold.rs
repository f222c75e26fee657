//! Constant folding.
//!
//! **Law.** An operation on constants is the constant that it evaluates to.
//!
//! **Side condition.** The operation raises no alarm, and its result is written with at most eight
//! digits and is not -0. At `-O1` it must stand in what lowering or legalization put in.
//!
//! **Counter-examples.** `1/3`: the target would read a literal cut short where it would have
//! computed all the digits it has. `ATAN[-1]/[-1]` is 225 on one control and -135 on another. `SQRT[-1]`: the alarm would be lost. `-(0)`: a control that
//! writes it as `-0` may not read it back. `#1 + 0` is not `#1`: where `#1` is vacant the sum is 0.

use super::pass::{Level, Library, Pass};
use crate::ir::eval::{AtanRange, Memory, eval};
use crate::ir::{Class, Expr, Place, Program, SourceInfo, Stmt, StmtKind, Var, is_finer_than_words};

/// The pass.
pub struct Fold;

/// Digits that every control keeps.
const DIGITS: usize = 8;

impl Pass for Fold {
    fn name(&self) -> &'static str {
        "fold"
    }

    fn run(&self, program: &mut Program, _: &Library, level: Level) {
        for block in &mut program.blocks {
            for stmt in &mut block.stmts {
                if level >= Level::O2 || is_introduced(stmt) {
                    let is_source = matches!(stmt.kind, StmtKind::Nc(_)) && !is_introduced(stmt);
                    stmt.kind.exprs_mut(&mut |e| if is_source { fold_word(e) } else { fold(e) });
                }
            }
            if level >= Level::O2 || block.term.site == SourceInfo::default() {
                block.term.kind.exprs_mut(&mut fold);
            }
        }
    }
}

/// True for a statement that no source block stands behind.
fn is_introduced(stmt: &Stmt) -> bool {
    let temp = |target: &Place| matches!(target, Place::Var(Var { class: Class::Temp, .. }));
    stmt.site == SourceInfo::default()
        || matches!(&stmt.kind, StmtKind::Assign { target, .. } if temp(target))
}

/// Folds the operations in a word of the source. What a control computes for it is rounded, and a number that is written with so many places
/// may be read in another way, so the last operation stays where the number would have more than an increment.
fn fold_word(e: &mut Expr) {
    if matches!(e, Expr::Number(_) | Expr::Var(_) | Expr::Vacant) {
        return;
    }
    let was = e.clone();
    fold(e);
    if *e != was && matches!(e, Expr::Number(number) if is_finer_than_words(*number)) {
        *e = was;
    }
}

/// Folds the operations of an expression, innermost first.
pub fn fold(e: &mut Expr) {
    e.exprs_mut(&mut fold);
    let constant = match e {
        Expr::Negate(_) | Expr::Binary(..) | Expr::Call(..) | Expr::Truth(_) => true,
        Expr::Number(_) | Expr::Increments(_) | Expr::Vacant => false,
        Expr::Var(_) | Expr::Indirect(..) | Expr::System(..) => false,
    };
    let mut numbers = true;
    e.exprs(&mut |operand| numbers &= matches!(operand, Expr::Number(_)));
    // A switch is no constant.
    let switch = matches!(e, Expr::Truth(cond) if cond.has_switch());
    if constant
        && numbers
        && !switch
        && let Some(value) = settled(e)
        && is_short(value)
    {
        *e = Expr::Number(value);
    }
}

/// What a constant operation evaluates to on every control.
fn settled(e: &Expr) -> Option<f64> {
    let [full, signed] = [AtanRange::Full, AtanRange::Signed].map(|atan| {
        let value = eval(e, &Memory { atan, ..Memory::new() });
        value.ok().flatten()
    });
    full.filter(|_| full.map(f64::to_bits) == signed.map(f64::to_bits))
}

/// True where a literal of [`DIGITS`] digits, without an exponent, is the number.
fn is_short(value: f64) -> bool {
    let text = value.abs().to_string();
    let digits = text.strip_prefix("0.").unwrap_or(&text).bytes().filter(u8::is_ascii_digit).count();
    digits <= DIGITS && !(value == 0.0 && value.is_sign_negative())
}
