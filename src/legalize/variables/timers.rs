//! A millisecond timer that programs set, on a target that tells the seconds since the start of the cycle alone.
//!
//! Law: the timer is the milliseconds since the start less those at which it would have stood at 0, which a register
//! keeps: setting it to v sets the register to the milliseconds of now less v. Side conditions: the program, or what
//! called it, sets the timer in the same cycle before it reads it; the target counts parts of a second, which a reviewer
//! must see on the machine. Counter-example: a program that reads how long the control has been on.

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::upward_exposed::{UpwardExposed, roots};
use crate::ir::{BinOp, Class, Expr, Module, Place, StmtKind, Var};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Position, Rewriter, rewrite_program};
use thin_vec::ThinVec;

/// The milliseconds at which the timer stood at 0.
const START: Var = Var { class: Class::Register, number: 8 };

/// True if the library uses state, and the target has seconds in place of the timer.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let target = context.target;
    features.has(Feature::System)
        && target.system_run(Sys::TimerMs).is_none()
        && target.system_run(Sys::CycleSeconds).is_some()
}

fn is_timer(e: &Expr) -> bool {
    matches!(e, Expr::System(Sys::TimerMs, _))
}

fn now() -> Expr {
    Expr::binary(BinOp::Mul, Expr::System(Sys::CycleSeconds, ThinVec::new()), Expr::Number(1000.0))
}

/// Replaces the timer by the seconds since the start.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let mut uses = Vec::new();
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut used =
            rewrite_program(program, is_timer, &mut |_, _: Position, rewriter: &mut Rewriter<'_>| {
                let temp = rewriter.materialize(now());
                Expr::binary(BinOp::Sub, Expr::Var(temp), Expr::Var(START))
            });
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            if let StmtKind::Assign { target, value } = &mut stmt.kind
                && matches!(target, Place::System(Sys::TimerMs, _))
            {
                used = true;
                let set = std::mem::replace(value, Expr::Vacant);
                *value = match set {
                    Expr::Number(0.0) | Expr::Vacant => now(),
                    set => Expr::binary(BinOp::Sub, now(), set),
                };
                *target = Place::Var(START);
            }
        }
        uses.extend(used.then_some((index, program.site.span)));
    }
    for (index, span) in &uses {
        let what = "the millisecond timer becomes the seconds since the start of the program, times 1000: check that the \
                    control counts parts of a second, and that no other program goes on with what this one timed";
        context.add(*index, Diagnostic::new(Code::Conditional, *span, what));
    }
    if uses.is_empty() {
        return;
    }
    let exposed = UpwardExposed::of(module);
    for index in roots(module) {
        if exposed.at_entry(index).into_iter().any(|var| var == START) {
            let what = "the millisecond timer may be read here before the program has set it, and the target knows no \
                        time from before the start: set it to 0 first, or convert the program together with its callers";
            let span = module.programs[index].site.span;
            context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what));
        }
    }
}
