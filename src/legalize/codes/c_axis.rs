//! What engages the C axis of a lathe.
//!
//! Law: where the return of C to its reference position engages it and a start of the spindle lets it go, a target with codes for both
//! gets the one before that return, and the other before that start. Side condition: the source's profile says that the return does
//! it; what engages C is asked where nothing of the source is known to, and C moves.
//! Counter-example: a machine whose C is engaged by a code of its builder, and that only goes to its reference position by `G28 H0`.

use crate::canon::{Act, Op, Role};
use crate::diag::{Asks, Code, Diagnostic};
use crate::dialect::{CodeMeaning, Control, Machine, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, Stmt, Stmts};
use crate::legalize::Context;
use crate::legalize::codes::ahead::ahead;
use crate::legalize::features::Features;
use crate::text::Span;

/// True where C of a lathe goes to a lathe.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let lathe = |control: &Control| control.machine() == Machine::Lathe;
    (features.role(Role::C) || features.role(Role::StepC)) && lathe(context.source) && lathe(context.target)
}

/// True where the return of C engages it.
fn by_return(control: &Control) -> bool {
    control.behaviour(Question::CAxisEngages).is_some_and(|row| row.value == "return")
}

/// Engages C by the target's code, and asks what does it on the source.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    match (by_return(context.source), by_return(context.target)) {
        (true, false) => write(module, context),
        (false, _) => ask(module, context),
        (true, true) => {}
    }
}

/// Lays the codes down.
fn write(module: &mut Module, context: &mut Context<'_>) {
    let engaged = OverCalls::of(module, &Engagement);
    let there = Act::C_AXIS.map(|name| context.target.code_of(Act::named(name)).is_some());
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = engaged.at(index, BlockId(at as u32)).copied().unwrap_or(Engaged(false));
            for mut stmt in std::mem::take(&mut block.stmts) {
                let before = state;
                state.step(&stmt);
                let code = match stmt.kind.nc() {
                    Some(nc) if returns(nc) => Some(0),
                    Some(nc) if starts(nc) && before.0 => Some(1),
                    _ => None,
                };
                match code {
                    Some(code) if there[code] => put(&mut stmt, Act::C_AXIS[code], &mut block.stmts),
                    Some(code) => lacks(Act::C_AXIS[code], index, stmt.site.span, context),
                    None => {}
                }
                block.stmts.push(stmt);
            }
        }
    }
}

/// Puts a code into a block before this one, which takes its number.
fn put(stmt: &mut Stmt, name: &str, out: &mut Stmts) {
    let number = Expr::Number(Act::named(name).number());
    let items = vec![NcItem::Op(Op::Act), NcItem::Word(Role::Act, number)];
    out.push(ahead(stmt, items));
}

fn lacks(name: &str, index: usize, span: Span, context: &mut Context<'_>) {
    let does = if name == Act::C_AXIS[0] { "engages the C axis" } else { "lets the C axis go" };
    let what = format!("this block {does}, as the source's profile says, and no code of the target does");
    let help =
        format!("put the target's code into its profile: M154 = {{ name = \"{name}\" }}, with its number");
    let told = Diagnostic::new(Code::NoEquivalent, span, what.as_str()).with_help(help);
    context.add_once(index, &what, told.asking_for(Asks::There { name: name.into() }));
}

/// Asks what engages C on the source, where the target has a code for it, C moves, and nothing is known to have engaged it.
fn ask(module: &Module, context: &mut Context<'_>) {
    let on = Act::named(Act::C_AXIS[0]);
    let named = |row: &&CodeMeaning| row.op == Op::Act && row.fixed.get(&Role::Act) == Some(&on.number());
    if context.source.dialect().codes.iter().any(|row| named(&row)) {
        return;
    }
    orients(module, context);
    let Some(code) = context.target.code_of(on).map(|row| row.code.clone()) else { return };
    let known = context.source.behaviour(Question::CAxisEngages).is_some_and(|row| row.value == "code");
    for (index, program) in module.programs.iter().enumerate() {
        let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        let Some(stmt) = stmts.into_iter().find(|stmt| stmt.kind.nc().is_some_and(moves)) else { continue };
        let span = stmt.site.span;
        if !known {
            context.rests_on_source(index, span, Question::CAxisEngages);
            continue;
        }
        let what = format!(
            "C moves here, which {code} of the target must engage, and no code of the source is named that does"
        );
        let help = format!(
            "name the source's code in its profile: M35 = {{ name = \"{}\" }}, with its number",
            Act::C_AXIS[0]
        );
        let told = Diagnostic::new(Code::Conditional, span, what.as_str()).with_help(help);
        context.add_once(index, &what, told.asked_once());
    }
}

/// Asks whether the code of an oriented stop is the one that engages C, where C moves after it and the source's profile does not say what it does.
fn orients(module: &Module, context: &mut Context<'_>) {
    let row = context.source.code_for(Op::SpindleOrient, &Default::default());
    let Some(head) = row.and_then(|row| row.head()) else { return };
    if context.source.site_code(head.letter, head.number()).is_some() {
        return;
    }
    for (index, program) in module.programs.iter().enumerate() {
        let mut stands = None;
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let Some(nc) = stmt.kind.nc() else { continue };
            if starts(nc) {
                stands = None;
            } else if nc.has(Op::SpindleOrient) {
                stands = Some(stmt.site.span);
            }
            let Some(span) = stands.filter(|_| moves(nc)) else { continue };
            let code = format!("{}{}", head.letter, head.number());
            let what = format!(
                "C moves after {code}, and no code of the source is named that engages C: on many lathes {code} does it, and here it is taken as \
                 an oriented stop of the spindle"
            );
            let help = format!(
                "write what it is into the source's profile: {code} = {{ name = \"{}\" }}, or {code} = {{ op = \"{}\" }}",
                Act::C_AXIS[0],
                Op::SpindleOrient
            );
            let asks = Asks::Code { code: code.into(), op: None };
            let told = Diagnostic::new(Code::Conditional, span, what.as_str()).with_help(help);
            context.add_once(index, &what, told.asking_for(asks));
            break;
        }
    }
}

/// True for a block that returns C to its reference position.
fn returns(nc: &Nc) -> bool {
    nc.has(Op::ReferenceReturn) && names_c(nc)
}

fn starts(nc: &Nc) -> bool {
    nc.has(Op::SpindleCw) || nc.has(Op::SpindleCcw)
}

fn names_c(nc: &Nc) -> bool {
    nc.word(Role::C).is_some() || nc.word(Role::StepC).is_some()
}

/// True for a block that moves C.
fn moves(nc: &Nc) -> bool {
    let tells = |op: Op| {
        matches!(op, Op::WriteWork | Op::WriteTurret | Op::WriteOffset | Op::SetPosition | Op::LocalShift)
    };
    names_c(nc) && !nc.ops().any(tells)
}

/// True where a return may have engaged C, and no spindle started since.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Engaged(bool);

impl Engaged {
    fn step(&mut self, stmt: &Stmt) {
        let Some(nc) = stmt.kind.nc() else { return };
        self.0 &= !starts(nc) || stmt.site.skip.is_some();
        self.0 |= returns(nc);
    }
}

impl Lattice for Engaged {
    fn join(&mut self, other: &Self) -> bool {
        let was = self.0;
        self.0 |= other.0;
        was != self.0
    }
}

/// Follows a library.
struct Engagement;

impl Follow for Engagement {
    type Known = Engaged;

    fn outside(&self, _: usize) -> Engaged {
        Engaged(false)
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, known: &mut Engaged) {
        block.stmts.iter().for_each(|stmt| known.step(stmt));
    }

    fn lose(&self, _: &mut Engaged) {}
}
