//! Words of a tap that change its time alone, where the target has none for them: how much faster it comes out than it goes in,
//! the speed at which it comes out, and how near an axis must be to its place before the next step begins.
//!
//! Law: without them the thread is the same: the tap comes out as fast as it went in, or as the target is set to. A speed that is a whole
//! number of times the one in force becomes that number where the target has a word for it. What is left out is asked once; how near an
//! axis must be, a note tells. Side condition: no code of the target takes the word. Counter-example: a target whose code takes it.

use super::tap_leads::{Speed, Speeds};
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

const WORDS: [Role; 4] = [Role::TapRetract, Role::TapOutSpeed, Role::InPosition, Role::InPositionSpindle];

const LEFT_OUT: &str = "how much faster the tap comes out than it goes in is left out: on the target it comes out as fast as it went in, or as that machine \
     is set to";

const NEAR: &str = "how near an axis must be to its place before the next step of a tap begins (its in-position width) is left out: it is a setting of the \
     target";

/// True where a tap has such a word, and no code of the target takes it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    WORDS.iter().any(|role| features.role(*role) && !takes(context.target, *role))
}

fn takes(control: &Control, role: Role) -> bool {
    control.dialect().codes.iter().any(|row| row.takes(role))
}

/// Takes the words out; true where there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let speeds = OverCalls::of(module, &Speeds);
    let lacks = WORDS.map(|role| (role, !takes(context.target, role)));
    let is_it = |item: &NcItem| matches!(item, NcItem::Word(role, _) if lacks.contains(&(*role, true)));
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut speed = speeds.at(index, BlockId(at as u32)).copied().unwrap_or(Speed::Unknown);
            for stmt in &mut block.stmts {
                speed.step(stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if !nc.items.iter().any(is_it) {
                    continue;
                }
                let times = times(nc, speed).filter(|_| takes(context.target, Role::TapRetract));
                let near = nc.word(Role::InPosition).is_some() || nc.word(Role::InPositionSpindle).is_some();
                let slower = nc.word(Role::TapOutSpeed).is_some() && times.is_none()
                    || nc.word(Role::TapRetract).is_some() && !takes(context.target, Role::TapRetract);
                nc.items.retain(|item| !is_it(item));
                nc.items.extend(times.map(|times| NcItem::Word(Role::TapRetract, Expr::Number(times))));
                changed = true;
                if slower {
                    let finding = Diagnostic::new(Code::Conditional, span, LEFT_OUT);
                    context.add_once(index, LEFT_OUT, finding.asked_once());
                }
                if near {
                    context.add_once(index, NEAR, Diagnostic::new(Code::QualityDropped, span, NEAR));
                }
            }
        }
    }
    changed
}

/// How many times as fast a tap comes out, where its speed is a whole number of times the one that it goes in with.
fn times(nc: &Nc, speed: Speed) -> Option<f64> {
    let (out, Speed::Known(speed)) = (nc.word(Role::TapOutSpeed)?.constant()?, speed) else { return None };
    let times = out / speed;
    (speed > 0.0 && (1.0..=9.0).contains(&times) && times.fract() == 0.0 && nc.ops().any(Op::is_tap))
        .then_some(times)
}
