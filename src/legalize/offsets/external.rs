//! The shift of all work offsets, the local shift and the set position, which some controls keep in one register.
//!
//! Laws: where the source keeps the local shift in the register of the shift of all offsets, to write that register is
//! the local shift of the axis. Where the target does and the source does not, a library that uses one of the two alone
//! says the same there. Side conditions: nothing reads the register in the first case; in the second it holds nothing
//! that the end of the program would clear. Where it ends: a library that uses both is refused, but for a block that sets the shift of
//! all offsets to 0, which a person looks at.

use crate::canon::{Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::behind::behind;
use crate::ir::{Expr, Module, Nc, NcItem, Place, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Feature;
use crate::text::Span;

const ONE: Question = Question::ShiftLocalIsExternal;
const ENDS: Question = Question::SetPositionEndsLocal;
const CLEARS: Question = Question::EndClearsLocal;
const AXES: [Role; 6] = [Role::X, Role::Y, Role::Z, Role::A, Role::B, Role::C];

/// Keeps the shifts apart, or together; true if that changed anything.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    set_positions(module, context);
    match (context.source.is(ONE), context.target.is(ONE)) {
        (true, false) => to_local(module, context),
        (false, true) => {
            to_one(module, context);
            false
        }
        _ => false,
    }
}

/// True where the register may be used.
fn may_use(index: usize, context: &Context<'_>) -> bool {
    context.may_concern(index, |features| features.has(Feature::System) || features.op(Op::WriteWork))
}

/// A position that is set while a local shift may be in force.
fn set_positions(module: &Module, context: &mut Context<'_>) {
    let answer = |control: &crate::dialect::Control| {
        let row = control.behaviour(ENDS).filter(|row| row.origin.is_confirmed() && row.value != "unknown");
        row.map(|row| row.value.clone())
    };
    if answer(context.source).is_some_and(|ours| answer(context.target) == Some(ours))
        || context.source.behaviour(ENDS) == context.target.behaviour(ENDS)
    {
        return;
    }
    behind(
        module,
        |stmt| stmt.kind.has_op(Op::LocalShift),
        |_| false,
        |index, stmt| {
            if stmt.kind.has_op(Op::SetPosition) {
                context.rests_on_source(index, stmt.site.span, ENDS);
                context.rests_on_target(index, stmt.site.span, ENDS);
                if context.source.is(ENDS) != context.target.is(ENDS) {
                    let what = "a position is set while a local shift may be in force: one control ends \
                                the shift here, the other keeps it";
                    let help = "end the local shift (0 for its axes) before setting the position";
                    let finding = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help);
                    context.add_once(index, what, finding);
                }
            }
        },
    );
}

/// The source has one register, the target two: what is written into it is a local shift.
fn to_local(module: &mut Module, context: &mut Context<'_>) -> bool {
    let stmts = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    // What a block adds under incremental coordinates no local shift adds.
    let adds = stmts().any(|stmt| stmt.kind.nc().is_some_and(|nc| nc.has(Op::Incremental)));
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        if !may_use(index, context) {
            continue;
        }
        for block in &mut program.blocks {
            let mut reads = None;
            block.term.kind.exprs(&mut |e| read(e, block.term.site.span, &mut reads));
            for stmt in &mut block.stmts {
                let span = stmt.site.span;
                stmt.kind.exprs(&mut |e| read(e, span, &mut reads));
                match &mut stmt.kind {
                    StmtKind::Assign { target: Place::System(Sys::ExternalShift, axis), value } => {
                        let role = axis.first().and_then(Expr::constant).map(|axis| axis as usize);
                        let role = role.and_then(|axis| AXES.get(axis.wrapping_sub(1)));
                        let Some(role) = role.filter(|_| !value.may_be_vacant()) else {
                            reads = Some(span);
                            continue;
                        };
                        let word = NcItem::Word(*role, std::mem::replace(value, Expr::Vacant));
                        context.rests_on_source(index, span, ONE);
                        changed = true;
                        stmt.kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::LocalShift), word] });
                    }
                    StmtKind::Nc(nc) if adds && writes(nc) == Some(true) => reads = Some(span),
                    StmtKind::Nc(nc) if writes(nc) == Some(true) => {
                        context.rests_on_source(index, span, ONE);
                        changed = true;
                        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::OffsetRow, _)));
                        for item in &mut nc.items {
                            if *item == NcItem::Op(Op::WriteWork) {
                                *item = NcItem::Op(Op::LocalShift);
                            }
                        }
                    }
                    _ => {}
                }
            }
            if let Some(span) = reads {
                let what = "the shift of all work offsets is read here, or written in a form that a local \
                            shift does not have: on the source both are one register, on the target they \
                            are two";
                context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what));
            }
        }
    }
    changed
}

fn read(e: &Expr, span: Span, found: &mut Option<Span>) {
    e.walk(&mut |e| {
        if matches!(e, Expr::System(Sys::ExternalShift, _)) {
            found.get_or_insert(span);
        }
    });
}

/// Whether a block writes the shift of all offsets; none if it may.
fn writes(nc: &Nc) -> Option<bool> {
    if !nc.has(Op::WriteWork) {
        return Some(false);
    }
    nc.word(Role::OffsetRow)?.constant().map(|row| row == 0.0)
}

const CLEARED: &str = "this sets the shift of all work offsets to 0, and on the target the local shift is the same register: make sure that no \
                       local shift is in force here";

/// True where all that a block writes is 0.
fn writes_zeros(nc: &Nc) -> bool {
    let mut places = nc.items.iter().filter_map(|item| match item {
        NcItem::Word(role, value) if role.is_axis() => Some(value),
        _ => None,
    });
    places.all(|value| value.constant() == Some(0.0))
}

/// The target has one register, the source two.
fn to_one(module: &Module, context: &mut Context<'_>) {
    let stmts = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let local = stmts().any(|stmt| stmt.kind.nc().is_some_and(|nc| nc.has(Op::LocalShift)));
    for (index, program) in module.programs.iter().enumerate() {
        if !may_use(index, context) {
            continue;
        }
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let mut reads = None;
            stmt.kind.exprs(&mut |e| read(e, stmt.site.span, &mut reads));
            let written = match &stmt.kind {
                StmtKind::Assign { target: Place::System(Sys::ExternalShift, _), .. } => true,
                StmtKind::Nc(nc) => writes(nc) == Some(true),
                _ => false,
            };
            let mixed = local && reads.is_some();
            if !written && !mixed {
                continue;
            }
            let clears = stmt.kind.nc().is_some_and(|nc| writes(nc) == Some(true) && writes_zeros(nc));
            let (code, what) = if local && clears && !mixed {
                (Code::Conditional, CLEARED)
            } else if local {
                let what = "the library uses the shift of all work offsets and the local shift: on the \
                            target both are one register";
                (Code::NoEquivalent, what)
            } else {
                let what = "the target keeps this shift in the register of the local shift: the end of \
                            the program or a reset may clear it, but the source keeps it for the next \
                            program";
                (Code::Conditional, what)
            };
            context.add_once(index, what, Diagnostic::new(code, stmt.site.span, what));
            context.rests_on_target(index, stmt.site.span, CLEARS);
        }
    }
}
