//! A pole and polar words, by rectangular ones.
//!
//! Law: the point at distance d and angle a from the pole (px, py) is `px + d*COS[a]`, `py + d*SIN[a]`; in
//! incremental coordinates the move is `d*COS[a]`, `d*SIN[a]` from where the tool is, and the pole does not enter it. The
//! pole is kept in two registers. Side conditions: absolute or incremental is known at each polar move, and both words
//! stand in its block.

use crate::canon::{Func, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{BinOp, Class, Expr, Module, Nc, NcItem, Place, SourceInfo, Stmt, StmtKind, Var};
use crate::legalize::{Context, replace_statements};

/// The registers of the pole, X and Y, by their numbers in [`Class::Register`].
const POLE: [(Role, Var); 2] = [
    (Role::X, Var { class: Class::Register, number: 2 }),
    (Role::Y, Var { class: Class::Register, number: 3 }),
];

/// Replaces poles and polar words.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if context.target.code_for(Op::Pole, &Default::default()).is_some() {
        return;
    }
    let polar = |nc: &Nc| nc.word(Role::PolarAngle).is_some() || nc.word(Role::PolarDistance).is_some();
    let facts = context.modal_facts(module);
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        state.step(&stmt);
        let span = stmt.site.span;
        if let StmtKind::Nc(nc) = &mut stmt.kind {
            if nc.has(Op::Pole) {
                out.extend(set_pole(nc, &stmt.site));
                if nc.items.is_empty() {
                    return;
                }
            } else if polar(nc)
                && let Err(why) = rectangular(nc, state.op(Group::Distance))
            {
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
            }
        }
        out.push(stmt);
    });
}

/// Takes the pole out of a block, and yields the assignments that keep it.
fn set_pole(nc: &mut Nc, site: &SourceInfo) -> Vec<Stmt> {
    let mut out = Vec::new();
    let mut site = site.clone();
    nc.items.retain_mut(|item| match item {
        NcItem::Op(Op::Pole) => false,
        NcItem::Word(role, value) => match POLE.iter().find(|(of, _)| of == role) {
            Some((_, var)) => {
                let value = std::mem::replace(value, Expr::Vacant);
                let kind = StmtKind::Assign { target: Place::Var(*var), value };
                let rest = SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
                out.push(Stmt { kind, site: std::mem::replace(&mut site, rest) });
                false
            }
            None => true,
        },
        _ => true,
    });
    out
}

/// Puts rectangular words in the place of polar ones.
fn rectangular(nc: &mut Nc, distance: Option<Op>) -> Result<(), &'static str> {
    let (Some(angle), Some(length)) =
        (nc.word(Role::PolarAngle).cloned(), nc.word(Role::PolarDistance).cloned())
    else {
        return Err(
            "a polar move without its angle or its distance: write both, the earlier value is not followed",
        );
    };
    let absolute = match distance {
        Some(Op::Absolute) => true,
        Some(Op::Incremental) => false,
        _ => {
            return Err("a polar move, and it is not known whether G90 or G91 is in force: write one of \
                         them before it");
        }
    };
    let part = |function: Func, pole: Var| {
        let turned = Expr::Call(function, [angle.clone()].into());
        let part = Expr::binary(BinOp::Mul, length.clone(), turned);
        if absolute { Expr::binary(BinOp::Add, Expr::Var(pole), part) } else { part }
    };
    let words = [
        NcItem::Word(Role::X, part(Func::Cos, POLE[0].1)),
        NcItem::Word(Role::Y, part(Func::Sin, POLE[1].1)),
    ];
    let is_polar = |item: &NcItem| matches!(item, NcItem::Word(Role::PolarAngle | Role::PolarDistance, _));
    let at = nc.items.iter().position(is_polar).unwrap_or(0);
    nc.items.retain(|item| !is_polar(item));
    nc.items.splice(at..at, words);
    Ok(())
}
