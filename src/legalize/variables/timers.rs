//! Timers that programs set, on a target that tells the seconds since the start of the cycle alone.
//!
//! Law: a timer is the time since the start less that at which it would have stood at 0, which a register keeps: setting
//! it to v sets the register to the time of now less v. Milliseconds are the seconds times 1000, and hours the seconds over
//! 3600. Side conditions: the program, or what called it, sets the timer in the same cycle before it reads it; the target
//! counts parts of a second, and both go on, or stand, at a stop: a reviewer must see it on the machine.
//! Counter-example: a program that reads how long the control has been on.

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::upward_exposed::{UpwardExposed, roots};
use crate::ir::{BinOp, Class, Expr, Module, Place, StmtKind, Var};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Position, Rewriter, rewrite_program};
use thin_vec::ThinVec;

/// A timer of the source, and how it counts on the target.
struct Timer {
    state: Sys,
    /// The time at which it stood at 0.
    start: Var,
    /// What makes its unit of seconds.
    op: BinOp,
    by: f64,
    name: &'static str,
    unit: &'static str,
}

const TIMERS: [Timer; 2] = [
    Timer {
        state: Sys::TimerMs,
        start: Var { class: Class::Register, number: 8 },
        op: BinOp::Mul,
        by: 1000.0,
        name: "the millisecond timer",
        unit: "times 1000",
    },
    Timer {
        state: Sys::TimerHours,
        start: Var { class: Class::Register, number: 7 },
        op: BinOp::Div,
        by: 3600.0,
        name: "the hour timer",
        unit: "over 3600",
    },
];

impl Timer {
    fn now(&self) -> Expr {
        Expr::binary(self.op, Expr::System(Sys::CycleSeconds, ThinVec::new()), Expr::Number(self.by))
    }
}

/// The timer of a state that the target has seconds in place of.
fn timer(state: Sys, context: &Context<'_>) -> Option<&'static Timer> {
    TIMERS.iter().find(|timer| timer.state == state && context.target.system_run(state).is_none())
}

/// True if the library uses state, and the target has seconds in place of a timer.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::System)
        && context.target.system_run(Sys::CycleSeconds).is_some()
        && TIMERS.iter().any(|one| timer(one.state, context).is_some())
}

/// Replaces timers by the seconds since the start.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    for one in &TIMERS {
        if timer(one.state, context).is_some() {
            replace(one, module, context);
        }
    }
}

fn replace(timer: &Timer, module: &mut Module, context: &mut Context<'_>) {
    let mut uses = Vec::new();
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut used = false;
        rewrite_program(program, is_timer, &mut |e, _: Position, rewriter: &mut Rewriter<'_>| match e {
            Expr::System(state, _) if state == timer.state => {
                used = true;
                let temp = rewriter.materialize(timer.now());
                Expr::binary(BinOp::Sub, Expr::Var(temp), Expr::Var(timer.start))
            }
            other => other,
        });
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            if let StmtKind::Assign { target, value } = &mut stmt.kind
                && matches!(target, Place::System(state, _) if *state == timer.state)
            {
                used = true;
                let set = std::mem::replace(value, Expr::Vacant);
                *value = match set {
                    Expr::Number(0.0) | Expr::Vacant => timer.now(),
                    set => Expr::binary(BinOp::Sub, timer.now(), set),
                };
                *target = Place::Var(timer.start);
            }
        }
        uses.extend(used.then_some((index, program.site.span)));
    }
    let Timer { name, unit, .. } = timer;
    for (index, span) in &uses {
        let what = format!(
            "{name} becomes the seconds since the start of the program, {unit}: check that the control counts parts of a \
             second, that both count alike at a stop, and that no other program goes on with what this one timed"
        );
        context.add(*index, Diagnostic::new(Code::Conditional, *span, what));
    }
    if uses.is_empty() {
        return;
    }
    let exposed = UpwardExposed::of(module);
    for index in roots(module) {
        if exposed.at_entry(index).into_iter().any(|var| var == timer.start) {
            let what = format!(
                "{name} may be read here before the program has set it, and the target knows no time from before the \
                 start: set it to 0 first, or convert the program together with its callers"
            );
            let span = module.programs[index].site.span;
            context.add_once(index, &what, Diagnostic::new(Code::NoEquivalent, span, what.clone()));
        }
    }
}

fn is_timer(e: &Expr) -> bool {
    matches!(e, Expr::System(Sys::TimerMs | Sys::TimerHours, _))
}
