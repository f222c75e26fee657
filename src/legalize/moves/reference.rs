//! The return to the reference position without axes, where the target needs them named.
//!
//! Law: a return of all axes by way of the place where the tool stands is a return that names every axis at an
//! incremental distance of 0. Side condition: absolute or incremental is known, to be restored. Which
//! axes the machine has is taken from the moves of the library: X, Y, Z and the rotary ones it moves; of those the target
//! has no letter for, the ones that the program itself moves.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Axis, Control, Question};
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::{Context, replace_statements};

const AT_ONCE: &str = "all axes return at the same time; no source says in which order the source moves them";
const ROTARY: &str = "this return takes the rotary axes of the source along, and the target has none of their letters: make sure that they \
                      stand at their reference position, or that the target's machine has no such axes";

/// Names the axes of returns that name none.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let ncs = || {
        module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts).filter_map(|stmt| {
            match &stmt.kind {
                StmtKind::Nc(nc) => Some(nc),
                _ => None,
            }
        })
    };
    let (here, there) =
        (context.source.is(Question::ReferenceAllAxes), context.target.is(Question::ReferenceAllAxes));
    if here && there
        || context.source.name() == context.target.name()
        || !ncs().any(|nc| bare(nc) || empty(nc))
    {
        return;
    }
    if !here {
        return doubt(module, there, context);
    }
    let rotary = [Role::A, Role::B, Role::C];
    let moved = rotary.into_iter().filter(|role| ncs().any(|nc| nc.word(*role).is_some()));
    let axes: Vec<Role> = [Role::X, Role::Y, Role::Z].into_iter().chain(moved).collect();
    // What the target has no letter for is named where the program moves it, and refused there.
    let target = context.target;
    let own: Vec<Vec<Role>> = module
        .programs
        .iter()
        .map(|program| {
            let ncs = || program.blocks.iter().flat_map(|b| &b.stmts).filter_map(|stmt| stmt.kind.nc());
            let named = |role: &Role| {
                !rotary.contains(role)
                    || target.letter(*role, None).is_some()
                    || ncs().any(|nc| nc.word(*role).is_some())
            };
            axes.iter().copied().filter(named).collect()
        })
        .collect();
    let letters = step_letters(context.source);
    let facts = context.modal_facts(module);
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        state.step(&stmt);
        let span = stmt.site.span;
        let mut restore = None;
        if let StmtKind::Nc(nc) = &mut stmt.kind
            && bare(nc)
        {
            context.rests_on_source(index, span, Question::ReferenceAllAxes);
            let (code, what) = match state.op(Group::Distance) {
                _ if !letters.is_empty() => {
                    by_letters(nc, &letters);
                    (Code::Conditional, AT_ONCE)
                }
                Some(distance) => {
                    restore = (distance == Op::Absolute).then_some(distance);
                    name(nc, &own[index]);
                    (Code::Conditional, AT_ONCE)
                }
                None => (
                    Code::NoEquivalent,
                    "a return to the reference position without axes, and it is not known whether G90 or \
                     G91 is in force: write one of them before it",
                ),
            };
            context.add(index, Diagnostic::new(code, span, what).asked_once());
            let rotary = letters.is_empty() && rotary.iter().any(|role| target.letter(*role, None).is_none());
            if rotary {
                context.add_once(
                    index,
                    ROTARY,
                    Diagnostic::new(Code::Conditional, span, ROTARY).asked_once(),
                );
            }
        }
        out.push(stmt);
        if let Some(distance) = restore {
            let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(distance)] });
            out.push(Stmt { kind, site: SourceInfo { span, ..SourceInfo::default() } });
        }
    });
}

/// The increments of the axes of a machine that has letters for them; none on others.
fn step_letters(source: &Control) -> Vec<Role> {
    let has = |role: Role| source.letter(role, None).is_some();
    let axes = source.profile().axes.clone().unwrap_or_else(|| vec![Axis::X, Axis::Z]);
    let steps =
        [(Axis::X, Role::StepX), (Axis::Y, Role::StepY), (Axis::Z, Role::StepZ), (Axis::C, Role::StepC)];
    let own = steps.into_iter().filter(|(axis, role)| axes.contains(axis) && has(*role));
    own.map(|(_, role)| role).collect()
}

fn by_letters(nc: &mut Nc, letters: &[Role]) {
    let at = nc.items.iter().position(|item| *item == NcItem::Op(Op::ReferenceReturn)).unwrap_or(0);
    let words = letters.iter().map(|role| NcItem::Word(*role, Expr::Number(0.0)));
    nc.items.splice(at + 1..at + 1, words);
}

/// What a return without axes does on the source is not known; on the target it may move all of them.
fn doubt(module: &Module, all: bool, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if bare(nc) {
                let what = "no source says what a return to the reference position without axes does on the \
                     source: name the axes";
                context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
            } else if all && empty(nc) {
                let what = "all axis words of this return may be vacant; the target then moves all axes";
                context.add_once(index, what, Diagnostic::new(Code::Conditional, stmt.site.span, what));
            }
        }
    }
}

/// True where all axes may be dropped from a return, because their values may be vacant.
fn empty(nc: &Nc) -> bool {
    let axes = |item: &NcItem| match item {
        NcItem::Word(role, value) if role.is_axis() => Some(value.may_be_vacant()),
        _ => None,
    };
    nc.has(Op::ReferenceReturn) && nc.moves() && nc.items.iter().filter_map(axes).all(|vacant| vacant)
}

fn bare(nc: &Nc) -> bool {
    nc.has(Op::ReferenceReturn) && !nc.moves()
}

fn name(nc: &mut Nc, axes: &[Role]) {
    nc.items.retain(|item| !matches!(item, NcItem::Op(Op::Absolute | Op::Incremental)));
    let at = nc.items.iter().position(|item| *item == NcItem::Op(Op::ReferenceReturn)).unwrap_or(0);
    nc.items.insert(at, NcItem::Op(Op::Incremental));
    let words = axes.iter().map(|axis| NcItem::Word(*axis, Expr::Number(0.0)));
    nc.items.splice(at + 2..at + 2, words);
}
