//! AND, OR and NOT of conditions by branches.
//!
//! Law: a branch on `a AND b` is a branch on `a` whose true side branches on
//! `b`; on `a OR b`, one whose false side does. Side condition: all operands of
//! the source's condition are evaluated, those of the chain only up to the one
//! that decides; that can be told apart only where evaluating one can stop the
//! machine (`[#1 NE 0] AND [1/#1 GT 2]`), so operands that can are computed into
//! temporaries first. A temporary is never vacant: where an operand of EQ or NE may be, the truth of
//! the comparison is kept instead.

use super::split;
use crate::canon::Func;
use crate::dialect::{OperandPlace, Question};
use crate::ir::{
    BinOp, BlockId, Builder, Class, Cond, Expr, Place, Program, Relation, SourceInfo, StmtKind, TermKind,
    Terminator, Var,
};
use crate::legalize::Context;
use crate::legalize::expressions::cost::Measure;
use crate::legalize::rewrite::{Part, highest_temp, rebuild};

/// Splits compound conditions where the target takes one comparison only, or has no room for so many.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let joined = context.target.is(Question::ConditionAndOr);
    let measure = Measure::new(context.target);
    let depth = context.target.limit("brackets").unwrap_or(u32::MAX);
    // A control without loops has conditions in its IF alone, beside a longer text.
    let loops = context.target.form(OperandPlace::Loop).is_some();
    let place = if loops { OperandPlace::Loop } else { OperandPlace::Condition };
    let (beside, _) = split::beside(context.target, place);
    let room = context.target.room(place).saturating_sub(beside);
    let fits = |cond: &Cond| {
        let size = measure.cond(cond).bracketed();
        size.depth <= depth && size.length <= room
    };
    let compound = |cond: &Cond| match cond {
        Cond::And(_) | Cond::Or(_) => !joined || cond.has_switch() || !fits(cond),
        Cond::Not(inner) => !matches!(**inner, Cond::Switch(_)),
        _ => false,
    };
    let mut branches = program.blocks.iter().map(|b| &b.term.kind);
    let any = branches.any(|k| matches!(k, TermKind::Branch { cond, .. } if compound(cond)));
    if any {
        split_program(program, &compound);
    }
    any
}

fn split_program(program: &mut Program, compound: &dyn Fn(&Cond) -> bool) {
    let mut temps = Temps(highest_temp(program));
    rebuild(program, &mut |builder, part| match part {
        Part::Term(Terminator { kind: TermKind::Branch { cond, then, otherwise }, site })
            if compound(&cond) =>
        {
            let cond = temps.hold_alarming(builder, *cond, &site);
            split(builder, cond, then, otherwise, &site, true);
        }
        other => other.keep(builder),
    });
}

/// Ends the present block with a chain of branches. Comments and number stay with the first.
fn split(
    builder: &mut Builder,
    cond: Cond,
    then: BlockId,
    otherwise: BlockId,
    site: &SourceInfo,
    first: bool,
) {
    let here = || if first { site.clone() } else { SourceInfo { span: site.span, ..SourceInfo::default() } };
    match cond {
        Cond::And(parts) => chain(builder, parts, site, first, |b, part, next, last, first| {
            split(b, part, if last { then } else { next }, otherwise, site, first);
        }),
        Cond::Or(parts) => chain(builder, parts, site, first, |b, part, next, last, first| {
            split(b, part, then, if last { otherwise } else { next }, site, first);
        }),
        Cond::Not(inner) => match *inner {
            Cond::Switch(n) => builder.end(
                TermKind::Branch { cond: Box::new(Cond::Switch(n)), then: otherwise, otherwise: then },
                here(),
            ),
            other => split(builder, other.negated(), then, otherwise, site, first),
        },
        simple => builder.end(TermKind::Branch { cond: Box::new(simple), then, otherwise }, here()),
    }
}

fn chain(
    builder: &mut Builder,
    parts: Vec<Cond>,
    site: &SourceInfo,
    first: bool,
    mut link: impl FnMut(&mut Builder, Cond, BlockId, bool, bool),
) {
    let count = parts.len();
    for (at, part) in parts.into_iter().enumerate() {
        let last = at + 1 == count;
        let next = if last { BlockId(0) } else { builder.fresh() };
        link(builder, part, next, last, first && at == 0);
        if !last {
            builder.start(next);
        }
    }
    let _ = site;
}

struct Temps(u32);

impl Temps {
    fn hold_alarming(&mut self, builder: &mut Builder, cond: Cond, site: &SourceInfo) -> Cond {
        let mut first = true;
        let mut later_can_alarm = false;
        each_simple(&cond, &mut |part| {
            later_can_alarm |=
                !first && matches!(part, Cond::Compare(_, a, b) if can_alarm(a) || can_alarm(b));
            first = false;
        });
        if later_can_alarm { self.materialize(builder, cond, site) } else { cond }
    }

    fn materialize(&mut self, builder: &mut Builder, cond: Cond, site: &SourceInfo) -> Cond {
        let parts = |this: &mut Self, builder: &mut Builder, parts: Vec<Cond>| {
            parts.into_iter().map(|part| this.materialize(builder, part, site)).collect()
        };
        match cond {
            Cond::Compare(Relation::Equal | Relation::NotEqual, ref a, ref b)
                if (can_alarm(a) && a.may_be_vacant()) || (can_alarm(b) && b.may_be_vacant()) =>
            {
                self.hold_truth(builder, cond, site)
            }
            Cond::Compare(relation, a, b) => {
                let a = self.hold_value(builder, a, site);
                Cond::Compare(relation, a, self.hold_value(builder, b, site))
            }
            Cond::And(all) => Cond::And(parts(self, builder, all)),
            Cond::Or(any) => Cond::Or(parts(self, builder, any)),
            Cond::Not(inner) => Cond::Not(Box::new(self.materialize(builder, *inner, site))),
            switch @ Cond::Switch(_) => switch,
        }
    }

    fn hold_value(&mut self, builder: &mut Builder, e: Expr, site: &SourceInfo) -> Expr {
        if !can_alarm(&e) {
            return e;
        }
        let temp = self.fresh();
        let site = SourceInfo { span: site.span, ..SourceInfo::default() };
        // A sum makes a number of what may be vacant, on targets whose registers may be too.
        let value = if e.may_be_vacant() { add_zero(e) } else { e };
        builder.push(StmtKind::Assign { target: Place::Var(temp), value }, site);
        Expr::Var(temp)
    }

    /// Keeps whether a comparison holds, and compares that.
    fn hold_truth(&mut self, builder: &mut Builder, cond: Cond, site: &SourceInfo) -> Cond {
        let temp = self.fresh();
        let site = || SourceInfo { span: site.span, ..SourceInfo::default() };
        let set = |value| StmtKind::Assign { target: Place::Var(temp), value: Expr::Number(value) };
        builder.push(set(0.0), site());
        let (then, otherwise) = (builder.fresh(), builder.fresh());
        builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, site());
        builder.start(then);
        builder.push(set(1.0), site());
        builder.start(otherwise);
        Cond::Compare(Relation::NotEqual, Expr::Var(temp), Expr::Number(0.0))
    }

    fn fresh(&mut self) -> Var {
        self.0 += 1;
        Var { class: Class::Temp, number: self.0 }
    }
}

fn add_zero(e: Expr) -> Expr {
    Expr::binary(BinOp::Add, e, Expr::Number(0.0))
}

/// Calls `f` on the parts that are not compound, in order.
fn each_simple<'c>(cond: &'c Cond, f: &mut dyn FnMut(&'c Cond)) {
    match cond {
        Cond::Compare(..) | Cond::Switch(_) => f(cond),
        Cond::And(parts) | Cond::Or(parts) => parts.iter().for_each(|part| each_simple(part, f)),
        Cond::Not(inner) => each_simple(inner, f),
    }
}

/// True where evaluating the expression can stop the machine with an alarm. Sums and products are
/// not counted: they overflow where the source's would have, in one operand or the other.
///
/// Not [`Expr::may_alarm`], which counts all that is not sure: here a false alarm costs a register and a block.
fn can_alarm(e: &Expr) -> bool {
    let mut found = false;
    e.walk(&mut |e| {
        found |= match e {
            Expr::Binary(BinOp::Div, operands) => operands[1].constant().is_none_or(|v| v == 0.0),
            // Its divisor is rounded.
            Expr::Binary(BinOp::Mod, operands) => operands[1].constant().is_none_or(|v| v.round() == 0.0),
            // Their operands must fit a word.
            Expr::Binary(BinOp::And | BinOp::Or | BinOp::Xor, ..) => true,
            Expr::Call(Func::Sin | Func::Cos, _) => false,
            Expr::Call(function, _) => Expr::Call(*function, [Expr::Vacant].into()).may_alarm(),
            Expr::Indirect(..) => true,
            _ => false,
        };
    });
    found
}
