//! Outputs that the target switches by codes of its builder alone.
//!
//! Law: a number that is not 0 switches an output on, and 0 switches it off (where a control pulls it low, the other way
//! round): so does the code that the target's profile names for it, in a block of its own. Of a computed number a branch
//! asks. Side conditions: the number of the output is a constant, and the profile names the code of what is done: a
//! builder's code stands under `[[site]]` with `op = "output.on"` or `"output.off"` and the output that it fixes. Nothing
//! reads outputs there. Counter-example: `#[#1+1100]=1`, which no one code switches.

use crate::canon::{Op, Role, Sys};
use crate::dialect::Control;
use crate::ir::{
    BinOp, Builder, Cond, Expr, Nc, NcItem, Place, Program, Relation, SourceInfo, StmtKind, TermKind,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::{Part, rebuild, unless_skipped};
use std::collections::BTreeMap;

/// True if the library uses state, and the target has codes for outputs.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let has = |op| context.target.dialect().codes.iter().any(|row| row.op == op);
    features.has(Feature::System) && (has(Op::OutputOn) || has(Op::OutputOff))
}

/// Puts codes in the place of assignments.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let target = context.target;
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    if !stmts.any(|stmt| switched(&stmt.kind, target).is_some()) {
        return false;
    }
    rebuild(program, &mut |builder, part| match part {
        Part::Stmt(stmt) => match switched(&stmt.kind, target) {
            Some(switched) => write(builder, switched, stmt.site),
            None => builder.push(stmt.kind, stmt.site),
        },
        other => other.keep(builder),
    });
    true
}

/// An output, and what switches it.
struct Switched {
    number: f64,
    /// True where 0 switches it on.
    inverted: bool,
    value: Expr,
}

impl Switched {
    /// Whether the output is on then; none if the value is computed.
    fn is_on(&self) -> Option<bool> {
        let number = match &self.value {
            Expr::Vacant => 0.0,
            value => value.constant()?,
        };
        Some((number != 0.0) != self.inverted)
    }
}

/// What an assignment switches, where the target does it by codes.
fn switched(kind: &StmtKind, target: &Control) -> Option<Switched> {
    let StmtKind::Assign { target: Place::System(state, subscripts), value } = kind else { return None };
    let inverted = match state {
        Sys::Output => false,
        Sys::OutputInverted => true,
        _ => return None,
    };
    let [number] = subscripts.as_slice() else { return None };
    let number = crate::ir::eval::whole(number.constant()?)?;
    let by_variable = [Sys::Output, Sys::OutputInverted]
        .into_iter()
        .any(|state| target.system_address(state, &[number]).is_some());
    let number = f64::from(number);
    let has = |on: bool| target.code_for(code(on), &BTreeMap::from([(Role::Output, number)])).is_some();
    let found = Switched { number, inverted, value: value.clone() };
    let done = match found.is_on() {
        Some(on) => has(on),
        None => has(true) && has(false),
    };
    (done && !by_variable).then_some(found)
}

fn code(on: bool) -> Op {
    if on { Op::OutputOn } else { Op::OutputOff }
}

fn block(number: f64, on: bool) -> StmtKind {
    let items = vec![NcItem::Op(code(on)), NcItem::Word(Role::Output, Expr::Number(number))];
    StmtKind::Nc(Nc { items })
}

fn write(builder: &mut Builder, switched: Switched, site: SourceInfo) {
    if let Some(on) = switched.is_on() {
        return builder.push(block(switched.number, on), site);
    }
    let value = match switched.value {
        value if value.may_be_vacant() => Expr::binary(BinOp::Add, value, Expr::Number(0.0)),
        value => value,
    };
    let (zero, other, after) = (builder.fresh(), builder.fresh(), builder.fresh());
    unless_skipped(builder, site.skip, after);
    let place = SourceInfo { span: site.span, ..SourceInfo::default() };
    let cond = Cond::Compare(Relation::Equal, value, Expr::Number(0.0));
    builder.end(TermKind::Branch { cond: Box::new(cond), then: zero, otherwise: other }, site);
    for (start, on) in [(zero, switched.inverted), (other, !switched.inverted)] {
        builder.start(start);
        builder.push(block(switched.number, on), place.clone());
        builder.end(TermKind::Jump(after), SourceInfo::default());
    }
    builder.start(after);
}
