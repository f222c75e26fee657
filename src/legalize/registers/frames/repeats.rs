//! Repeated calls with arguments: each run of the macro finds its arguments anew.
//!
//! Law: a call that opens a level and runs n times sets the level's locals before each of its runs; so does a loop that
//! calls once and counts n down. A count below 1 runs nothing here, and what it does on the source no maker's text says.
//! Counter-example: `G65 P9010 L2 A1.`, where O9010 does `#1=#1+1`.

use crate::ir::{
    BinOp, Call, Class, Cond, Expr, Place, Program, Relation, SourceInfo, StmtKind, TermKind, Var,
};
use crate::legalize::rewrite::{Part, highest_temp, rebuild};

/// Makes loops of the repeated calls that are `wanted`.
pub fn loops(program: &mut Program, wanted: impl Fn(&Call) -> bool) {
    let wanted = |call: &Call| call.count.is_some() && wanted(call);
    let repeated = |kind: &TermKind| matches!(kind, TermKind::Call { call, .. } if wanted(call));
    if !program.blocks.iter().any(|block| repeated(&block.term.kind)) {
        return;
    }
    let mut temps = highest_temp(program);
    rebuild(program, &mut |builder, part| {
        let Part::Term(mut term) = part else { return part.keep(builder) };
        let (mut call, next) = match term.kind {
            TermKind::Call { call, next } if wanted(&call) => (call, next),
            kind => {
                term.kind = kind;
                return Part::Term(term).keep(builder);
            }
        };
        let Some(count) = call.count.take().filter(|count| count.constant() != Some(1.0)) else {
            return builder.end(TermKind::Call { call, next }, term.site);
        };
        temps += 1;
        let left = Var { class: Class::Temp, number: temps };
        let set = |value| StmtKind::Assign { target: Place::Var(left), value };
        let span = || SourceInfo { span: term.site.span, ..SourceInfo::default() };
        builder.push(set(count), span());
        let (head, body, after) = (builder.fresh(), builder.fresh(), builder.fresh());
        builder.start(head);
        let cond = Cond::Compare(Relation::Greater, Expr::Var(left), Expr::Number(0.0));
        builder.end(TermKind::Branch { cond: Box::new(cond), then: body, otherwise: next }, span());
        builder.start(body);
        let one_less = Expr::binary(BinOp::Sub, Expr::Var(left), Expr::Number(1.0));
        builder.end(TermKind::Call { call, next: after }, term.site.clone());
        builder.start(after);
        builder.push(set(one_less), SourceInfo::default());
        builder.end(TermKind::Jump(head), SourceInfo::default());
    });
}
