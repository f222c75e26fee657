//! Roughing of contours by a control that ends it otherwise.
//!
//! Law: both leave the allowances on the contour, go as deep each pass, and come back to where they began. What differs is which passes there are:
//! one control ends along the contour, the other level by level, which may leave steps for the finishing. A person must accept that.

use super::contours::{contour, facts_uncompensated, has_valleys};
use super::settings::takes;
use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Setting};
use crate::ir::{Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The cycles whose passes may differ.
const CYCLES: [Op; 2] = [Op::RoughTurning, Op::RoughFacing];

/// The codes that begin compensation of the nose radius.
const COMPENSATED: [Op; 2] = [Op::RadiusLeft, Op::RadiusRight];

/// True where contours are roughed, and the controls do not end that alike.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let skips = [false, true].into_iter().any(|valleys| apart(context, valleys));
    let nose = COMPENSATED.iter().any(|op| features.op(*op)) && !context.agree(Question::RoughingNose);
    CYCLES.iter().any(|op| features.op(*op)) && (!context.agree(Question::RoughingEnds) || skips || nose)
}

/// True where one control alone leaves out the pass along such a contour.
fn apart(context: &Context<'_>, valleys: bool) -> bool {
    context.source.skips_along(valleys).is_some() != context.target.skips_along(valleys).is_some()
}

/// Says which roughing ends otherwise.
pub fn run(module: &Module, context: &mut Context<'_>) {
    noses(module, context);
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            let Some(op) = nc.ops().find(|op| CYCLES.contains(op)) else { continue };
            let Some(what) = otherwise(has_valleys(program, nc), context) else { continue };
            let told = Diagnostic::new(Code::Conditional, stmt.site.span, what.clone())
                .with_help("run one such cycle in the air or on the screen, and look at its last passes")
                .assuming(Predicate::Substitute(op))
                .asked_once();
            context.add_once(index, &format!("{what} {op}"), told);
        }
    }
}

/// Says where the radius of the nose is compensated while a contour is roughed: the controls are not known to do the same then.
fn noses(module: &Module, context: &mut Context<'_>) {
    let begins = COMPENSATED.iter().any(|op| context.features.op(*op));
    if !begins || context.agree(Question::RoughingNose) {
        return;
    }
    let facts = facts_uncompensated(module, context);
    facts.each(module, &mut |index, stmt, before, _| {
        let Some(nc) = stmt.kind.nc() else { return };
        if !nc.ops().any(|op| CYCLES.contains(&op)) {
            return;
        }
        let in_force = before.op(Group::RadiusComp) != Some(Op::RadiusOff);
        let inside = module.programs.get(index).is_some_and(|program| {
            let mut blocks = contour(program, nc);
            blocks.any(|nc| nc.ops().any(|op| COMPENSATED.contains(&op)))
        });
        if in_force || inside {
            context.rests_on_source(index, stmt.site.span, Question::RoughingNose);
            context.rests_on_target(index, stmt.site.span, Question::RoughingNose);
            let told = Diagnostic::new(Code::Conditional, stmt.site.span, NOSE).with_help(NOSE_HELP);
            context.add_once(index, NOSE, told.with_fact(ROUGHED).asked_once());
        }
    });
}

/// What the emulated controls do there.
const ROUGHED: &str = "machine:lathe.nose.roughing";

const NOSE: &str = "the nose radius is compensated (G41, G42) while this contour is roughed: one of the two controls is taken to change the allowance by the \
                    radius then, and the other one not";
const NOSE_HELP: &str = "make sure that the roughing leaves enough; or write G40 before it, and G41 or G42 before G70 alone. 'roughing.nose' under \
                         [behaviours] of the machine's profile says what it does";

/// How the target ends the roughing of such a contour otherwise. None if it ends it alike. If nobody knows whether the contour has
/// valleys, what holds for either counts.
fn otherwise(valleys: Option<bool>, context: &Context<'_>) -> Option<String> {
    let kinds = valleys.map_or(vec![false, true], |valleys| vec![valleys]);
    let of = |control: &Control| kinds.iter().find_map(|kind| Some(skip_of(control.skips_along(*kind)?)));
    let is_apart = kinds.iter().any(|kind| apart(context, *kind));
    let agree = context.agree(Question::RoughingEnds);
    match (of(context.source), of(context.target)) {
        (_, Some(name)) if is_apart => Some(format!(
            "the target leaves out the pass along the contour at the end of this roughing, by {name}, and the source does not: steps may \
             be left for the finishing tool, up to the depth of a pass"
        )),
        (Some(name), _) if is_apart => Some(format!(
            "the source leaves out the pass along the contour at the end of this roughing, by {name}, and the target does not"
        )),
        _ if agree => None,
        _ if context.target.behaviour(Question::RoughingEnds).is_some_and(|row| row.value == "along") => {
            Some(ALONG.into())
        }
        _ => Some(LEVELS.into()),
    }
}

/// A setting as people name it.
fn skip_of(row: &Setting) -> String {
    row.name.replacen('.', " ", 1)
}

const ALONG: &str = "the target ends this roughing with a pass along the contour, which the source has only with I or K, and takes no I and K: \
                     without them the levels lie otherwise";
const LEVELS: &str = "the target is not known to end this roughing with a pass along the contour, as the source does: steps may be left for \
                      the finishing tool, up to the depth of a pass";

/// A control that always ends roughing with a pass along the contour has no words for what that pass takes: words of 0 go,
/// as without them. False where one is not known to be 0: the levels lie nearer by it, and the last pass takes it.
pub(super) fn drop_rough(nc: &mut Nc, target: &Control) -> bool {
    let is_along =
        |control: &Control| control.behaviour(Question::RoughingEnds).is_some_and(|row| row.value == "along");
    let along = is_along(target);
    let Some(op) = nc.ops().find(|op| matches!(op, Op::RoughTurning | Op::RoughFacing)) else { return true };
    let rough = |role: Role| matches!(role, Role::RoughX | Role::RoughZ) && !takes(target, op, role);
    let mut nothing = true;
    if along {
        nc.items.retain(|item| match item {
            NcItem::Word(role, value) if rough(*role) => {
                nothing &= value.constant() == Some(0.0);
                false
            }
            _ => true,
        });
    }
    nothing
}

pub(super) const ALLOWANCES: &str = "this roughing leaves I and K for a last pass along the contour: its levels lie farther out by them, and the target has no such words";
pub(super) const ALLOWANCES_HELP: &str =
    "take I and K out; the pass along the contour then takes what is left, up to the depth of a pass";
