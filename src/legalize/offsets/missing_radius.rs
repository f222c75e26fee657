//! Cutter compensation in programs that name no cutter radius at all.
//!
//! Law: none. A code of cutter compensation without a number takes up the one that was named last. Where neither the program, nor what it
//! calls, nor what calls it names one, the radius is what another program left, or none: nothing in the library says it, and the
//! target's may be another one. Such a program is for review. Side condition: a control that takes the radius of the tool
//! in the spindle, or of the number of the length, needs no word. Counter-example: `G41 D5` in a macro, `G40`, `G41` in its caller.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Machine, Question};
use crate::ir::analysis::calls_of;
use crate::ir::{Callee, Module, Nc, Program};
use crate::legalize::Context;
use crate::legalize::calls::standing::tied_to;
use crate::legalize::features::Features;

/// True for a mill's library with codes of cutter compensation, which a word gives its number.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let of_tool = context.source.is(Question::RadiusOffsetActiveTool)
        || context.source.is(Question::LengthWordPicksRadius) && features.role(Role::LengthOffset);
    context.source.machine() == Machine::Mill
        && !of_tool
        && !context.source.is_same_machine(context.target)
        && features.any_op(begins)
}

fn begins(op: Op) -> bool {
    matches!(op, Op::RadiusLeft | Op::RadiusRight)
}

/// Tells of the first such code of each program.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let names = |program: &Program| {
        blocks(program).any(|nc| nc.word(Role::RadiusOffset).is_some()) || calls_unknown(program)
    };
    let naming = module.programs.iter().enumerate().filter(|(_, program)| names(program));
    let named = tied_to(naming.map(|(index, _)| index), &context.called(module).pairs(module));
    for (index, program) in module.programs.iter().enumerate().filter(|(index, _)| !named.contains(index)) {
        let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        let mut codes = stmts.filter(|stmt| stmt.kind.nc().is_some_and(|nc| nc.ops().any(begins)));
        if let Some(stmt) = codes.next() {
            let told = Diagnostic::new(Code::Conditional, stmt.site.span, UNNAMED);
            context.add_once(index, UNNAMED, told.with_help(HELP));
        }
    }
}

const UNNAMED: &str = "cutter compensation begins here, and no program that runs with this one names the number of a cutter radius: the one that \
                       another program left in force counts, or none";
const HELP: &str = "write D with the number of the tool's radius beside the code";

fn blocks(program: &Program) -> impl Iterator<Item = &Nc> {
    program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc())
}

/// True for a program that calls what the library may not have.
fn calls_unknown(program: &Program) -> bool {
    let mut calls = program.blocks.iter().flat_map(calls_of);
    calls.any(|call| matches!(call.callee, Callee::Computed(_)))
}
