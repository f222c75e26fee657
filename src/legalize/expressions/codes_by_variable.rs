//! Codes beside words by variables, where the target does not mix these with plain words.
//!
//! Law: a code whose number comes from a variable is the code of that number. So where no plain word stands beside a word
//! by a variable, a code that acts once, with its own words, gets its number from a variable too: `V31=4`, then
//! `G=V31 F=V30`. A code that stays in force needs none: it goes to a block of its own before. Side conditions: the target
//! takes a code by a variable, and the row of the code fixes nothing and asks for no word. The operation stays in the
//! block, and the number beside it is how it is written. Counter-example: `G4`, then `F=V30`, which is a feed.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Operand, OperandPlace};
use crate::ir::{Class, Expr, Nc, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, Var};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::rewrite::highest_temp;
use crate::text::Span;
use std::collections::BTreeMap;

/// True if the library has such codes, and the target mixes no variables and numbers.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let mixed = context.target.form(OperandPlace::Word).is_none_or(|form| form.mixed);
    let by_variable =
        context.target.form(OperandPlace::Code).is_some_and(|form| form.takes.contains(&Operand::Variable));
    !mixed && by_variable && features.any_op(Op::acts_with_words)
}

/// Gives these codes their numbers from temporaries; true if there was any.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let mut next = highest_temp(program);
    let mut changed = false;
    let mut beside: Option<Span> = None;
    for block in &mut program.blocks {
        let mut out = Stmts::with_capacity(block.stmts.len());
        for mut stmt in std::mem::take(&mut block.stmts) {
            let twice = stmt.kind.nc().is_some_and(|nc| nc.ops().any(Op::acts_with_words) && has_code(nc));
            beside = beside.or(twice.then_some(stmt.site.span));
            let code = stmt.kind.nc().filter(|_| !twice).and_then(|nc| code_of(nc, context.target));
            if let (Some((letter, number)), StmtKind::Nc(nc)) = (code, &mut stmt.kind) {
                next += 1;
                let temp = Var { class: Class::Temp, number: next };
                nc.items.insert(0, NcItem::Code(letter, Expr::Var(temp)));
                let value = Expr::Number(number);
                let site = SourceInfo { skip: stmt.site.skip, ..SourceInfo::default() };
                out.push(Stmt { kind: StmtKind::Assign { target: Place::Var(temp), value }, site });
                changed = true;
            }
            out.push(stmt);
        }
        block.stmts = out;
    }
    if let Some(span) = beside {
        let what = "a code by a computed number stands beside one that acts with words of its own: write it in a block of its own";
        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
    }
    changed
}

fn has_code(nc: &Nc) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Code(..)))
}

/// The letter and the number of the code that a block needs by a variable.
fn code_of(nc: &Nc, target: &Control) -> Option<(char, f64)> {
    let mut ops = nc.ops().filter(|op| op.acts_with_words());
    let op = ops.next().filter(|_| ops.next().is_none())?;
    let words: Vec<(Role, &Expr)> = nc.items.iter().filter_map(word).collect();
    let computed = words.iter().any(|(_, value)| value.constant().is_none());
    if !computed {
        return None;
    }
    let operands: BTreeMap<Role, f64> =
        words.iter().map(|(role, value)| (*role, value.constant().unwrap_or(0.0))).collect();
    let row = target.code_for(op, &operands)?;
    let head = row
        .head()
        .filter(|_| row.fixed.is_empty() && row.beside().is_some_and(|beside| beside.is_empty()))?;
    Some((head.letter, head.number()))
}

fn word(item: &NcItem) -> Option<(Role, &Expr)> {
    match item {
        NcItem::Word(role, value) => Some((*role, value)),
        _ => None,
    }
}
