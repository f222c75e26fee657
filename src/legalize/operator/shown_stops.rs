//! A text that is shown right before a stop or a fault, where the target shows texts at stops only.
//!
//! Law: the text is shown, and the machine stops when the moves before it are done: the operator reads it there, as a message
//! with which the machine stops. A control that reads ahead may show the text while those moves run still; what it says is the same. A
//! control that prints on its screen is told a message so. `ALARM 1 TEXT` before
//! `R9=SQR(0.-1.)`, which no control computes, is an alarm: that is how one is written where programs raise none of
//! their own.
//!
//! Side condition: the text is no value and ends its line, and nothing stands between the text and the stop; between a wait, the text
//! and a fault.
//! None of them may be skipped. What the fault is written into is never set, as the run ends there. Counter-example:
//! `#PRINT "READY"` with a move before the stop, which the operator reads while it runs; `R9=SQR(V1)`, which may go on.

use crate::canon::{Func, Op};
use crate::dialect::Control;
use crate::ir::{BinOp, Expr, Module, NcItem, Place, PrintPart, Program, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::text::variable_to_set;

/// True if texts are shown, and the target has messages and no screen for others.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::Print) && shows_at_stops(context.target)
}

fn shows_at_stops(target: &Control) -> bool {
    target.statement("print").is_none()
}

/// Makes messages of them; true if there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut changed = false;
    let prefixes = context.source.prefixes();
    let message = |stmts: &[Stmt]| message(stmts, &prefixes);
    // A line that is gone on with is longer than its last text.
    let whole = module.programs.iter_mut().filter(|program| !goes_on(program));
    for block in whole.flat_map(|program| &mut program.blocks) {
        if [2, 3].iter().all(|count| block.stmts.windows(*count).all(|some| message(some).is_none())) {
            continue;
        }
        changed = true;
        let mut out = Stmts::with_capacity(block.stmts.len());
        let mut rest = std::mem::take(&mut block.stmts);
        while !rest.is_empty() {
            let found = [3, 2].into_iter().find_map(|count| Some((count, message(rest.get(..count)?)?)));
            match found {
                Some((count, kind)) => {
                    let mut all = rest.drain(..count);
                    // The comments of the wait and of the text stay before the stop.
                    out.extend(all.by_ref().take(count - 1).filter_map(comments));
                    out.extend(all.map(|stop| Stmt { kind: kind.clone(), site: stop.site }));
                }
                None => out.push(rest.remove(0)),
            }
        }
        block.stmts = out;
    }
    changed
}

/// True for a program that shows a part of a line.
fn goes_on(program: &Program) -> bool {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| matches!(stmt.kind, StmtKind::Print { serial: false, stay: true, .. }))
}

/// The message or the alarm that a text and a stop make, with a wait before them or without.
fn message(stmts: &[Stmt], prefixes: &[&str]) -> Option<StmtKind> {
    let (waits, two) = match stmts {
        [wait, two @ ..] if wait.kind == StmtKind::Sync => (true, two),
        two => (false, two),
    };
    let [shown, stop] = two else { return None };
    let StmtKind::Print { serial: false, parts, stay: false } = &shown.kind else { return None };
    let [PrintPart::Text(text)] = parts.as_slice() else { return None };
    // A message that names a variable is a question on some controls.
    let asks = !waits && variable_to_set(text, prefixes).is_some();
    if asks || stmts.iter().any(|stmt| stmt.site.skip.is_some()) {
        return None;
    }
    let (number, text, fault) = match &stop.kind {
        StmtKind::Nc(nc) if nc.items.as_slice() == [NcItem::Op(Op::Stop)] => (1.0, text.trim(), false),
        StmtKind::Assign { target: Place::Var(_), value } if waits && never_computed(value) => {
            let (number, text) = text.strip_prefix("ALARM ")?.split_once(' ')?;
            let digits = number.bytes().all(|digit| digit.is_ascii_digit());
            (number.parse().ok().filter(|_| digits)?, text.trim(), true)
        }
        _ => return None,
    };
    let (number, kept) = (Expr::Number(number).into(), text.into());
    let kind = match fault {
        true => StmtKind::Alarm { number, text: kept },
        false => StmtKind::StopMessage { number, text: kept },
    };
    (!text.is_empty()).then_some(kind)
}

/// True for the root of 0 less 1, as a fault is written.
fn never_computed(value: &Expr) -> bool {
    let Expr::Call(Func::Sqrt, arguments) = value else { return false };
    let Some(Expr::Binary(BinOp::Sub, of)) = arguments.first() else { return false };
    (of[0].constant(), of[1].constant()) == (Some(0.0), Some(1.0))
}

/// What is left of a statement.
fn comments(stmt: Stmt) -> Option<Stmt> {
    (!stmt.site.comments.is_empty()).then_some(Stmt { kind: StmtKind::Comment, site: stmt.site })
}
