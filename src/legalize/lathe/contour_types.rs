//! Contours with valleys, which one control knows by the axes that their first block names, and another by a word of the cycle.
//!
//! Law: a roughing makes the same passes if it takes the contour for the same type. Side condition: the first block of the contour is there, and
//! the word is a constant. Counter-example: a first block with X and Z under a cycle without the word, which is of the first type on the one
//! control and of the second on the other.

use super::contours::has_valleys;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Settled, Side};
use crate::ir::{Expr, Module, NcItem, Program, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::text::Span;

/// True where such a cycle stands, and the controls know the type otherwise, or a setting that nobody stated says how.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let sides = [context.source, context.target];
    let told = by_word(context.source) != by_word(context.target) || features.role(Role::ContourType);
    features.op(Op::RoughTurning) && (told || sides.into_iter().any(hangs_on_setting))
}

/// Writes the type as the target reads it.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let (source, target) = (context.source, context.target);
    let (by_word, theirs) = (by_word(source), by_word(target));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut found: Vec<(usize, usize, Span, Option<bool>)> = Vec::new();
        for (at, block) in program.blocks.iter().enumerate() {
            for (place, stmt) in block.stmts.iter().enumerate().filter(|(_, stmt)| roughs(stmt)) {
                found.push((at, place, stmt.site.span, valleys_of(program, stmt, by_word)));
            }
        }
        for (at, place, span, valleys) in found {
            if valleys != Some(false) {
                for (control, side) in [(source, Side::Source), (target, Side::Target)] {
                    match side {
                        _ if !hangs_on_setting(control) => {}
                        Side::Source => context.rests_on_source(index, span, Question::RoughingValleys),
                        Side::Target => context.rests_on_target(index, span, Question::RoughingValleys),
                    }
                }
            }
            if by_word && theirs {
                continue;
            }
            let named = program.blocks.get(at).and_then(|block| block.stmts.get(place)).and_then(|stmt| {
                let nc = stmt.kind.nc()?;
                has_valleys(program, nc)
            });
            let stmt = program.blocks.get_mut(at).and_then(|block| block.stmts.get_mut(place));
            let Some(StmtKind::Nc(nc)) = stmt.map(|stmt| &mut stmt.kind) else { continue };
            // The first block says it on both, and the word nothing else.
            if !by_word && !theirs {
                let word = nc.word(Role::ContourType).map(|value| value.constant() == Some(1.0));
                if word.is_none_or(|word| Some(word) == named) {
                    nc.items.retain(|item| !matches!(item, NcItem::Word(Role::ContourType, _)));
                } else {
                    let told = Diagnostic::new(Code::NoEquivalent, span, IDLE).with_help(IDLE_HELP);
                    context.add(index, told);
                }
                continue;
            }
            nc.items.retain(|item| !matches!(item, NcItem::Word(Role::ContourType, _)));
            let told = match (valleys, named) {
                (Some(true), _) if theirs => {
                    nc.items.push(NcItem::Word(Role::ContourType, Expr::Number(1.0)));
                    None
                }
                (Some(false), _) if theirs => None,
                (Some(wanted), Some(named)) if wanted == named => None,
                (Some(true), Some(false)) => Some((NAMES_ONE, NAMES_ONE_HELP)),
                (Some(false), Some(true)) => Some((NAMES_BOTH, NAMES_BOTH_HELP)),
                _ => Some((UNKNOWN, UNKNOWN_HELP)),
            };
            if let Some((what, help)) = told {
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
            }
        }
    }
}

fn roughs(stmt: &Stmt) -> bool {
    stmt.kind.has_op(Op::RoughTurning)
}

/// True where a word of the cycle says the type.
fn by_word(control: &Control) -> bool {
    control.behaviour(Question::RoughingValleys).is_some_and(|row| row.value == "word")
}

/// True where a setting says how the type is told, and the profile does not give it.
fn hangs_on_setting(control: &Control) -> bool {
    let open = control.behaviour(Question::RoughingValleys).is_some_and(|row| !row.origin.is_settled());
    open && matches!(control.settled_by(Question::RoughingValleys.fact()), Settled::Setting { .. })
}

/// True where the source takes the contour for one with valleys; none where that is not known.
fn valleys_of(program: &Program, stmt: &Stmt, by_word: bool) -> Option<bool> {
    let nc = stmt.kind.nc()?;
    if !by_word {
        return has_valleys(program, nc);
    }
    match nc.word(Role::ContourType) {
        None => Some(false),
        Some(value) => Some(value.constant()? == 1.0),
    }
}

const NAMES_ONE: &str = "this contour has valleys by the word R of its cycle, and the target knows it by X and Z in its first block, which names one axis";
const NAMES_ONE_HELP: &str =
    "write X and Z into the first block of the contour, Z as the place where the cycle begins";
const NAMES_BOTH: &str = "the first block of this contour names X and Z, by which the target takes it for one with valleys, and the source does \
                          not, as the word R of the cycle is missing";
const NAMES_BOTH_HELP: &str = "give the move along Z a block of its own before the cycle, or R of 1 into the cycle if the contour has valleys";
const IDLE: &str = "R of this cycle and the first block of its contour say otherwise of valleys, and no source says what R does where the first block decides";
const IDLE_HELP: &str =
    "take R out; or write X and Z into the first block of the contour, Z as the place where the cycle begins";
const UNKNOWN: &str = "whether this contour has valleys is not known here, and the target is told otherwise";
const UNKNOWN_HELP: &str =
    "write R of the cycle as a number, and the first block of the contour in the same program";
