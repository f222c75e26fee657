//! Formatted output, on a control that prints values as they come.
//!
//! Law: a value that is rounded to its places and then printed shows the digits that the format shows, but for zeros at its
//! end and the blanks before it. A whole number over a power of ten has its places, and is not rounded again. A port needs no opening where every line is sent by itself. A vacant value prints as 0.
//! Side condition, for a reviewer: whoever reads the lines does not count columns. Counter-example: `DPRNT[X#1[53]]`, which
//! fills nine columns, and `SPRINT "X",V1`.

use crate::canon::Func;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::{Ranges, Summaries};
use crate::ir::{
    BinOp, BlockId, Class, Expr, Module, OutputPart, Place, PrintPart, Program, SourceInfo, Stmt, StmtKind,
    Stmts, Var,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::highest_temp;
use crate::text::Span;
use std::collections::BTreeSet;
use thin_vec::ThinVec;

/// True if there is output in a format, and the target prints without one.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    (features.has(Feature::Output) || features.has(Feature::Port)) && prints_plainly(context.target)
}

fn prints_plainly(target: &Control) -> bool {
    target.statement("output.formatted").is_none() && target.statement("print.serial").is_some()
}

/// Prints what was formatted.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let mut found: Vec<(usize, Span)> = Vec::new();
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let rounded = rounded(program, &summaries);
        let mut next = highest_temp(program);
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let mut stmts = Stmts::with_capacity(block.stmts.len());
            for (at, stmt) in std::mem::take(&mut block.stmts).into_iter().enumerate() {
                match stmt.kind {
                    StmtKind::Output(parts) => {
                        found.push((index, stmt.site.span));
                        let parts = parts.into_iter().enumerate();
                        let mut parts: ThinVec<PrintPart> =
                            parts.map(|(n, part)| plain(part, rounded.contains(&(id, at, n)))).collect();
                        if context.target.statement("wait").is_some() {
                            if stmt.site.skip.is_none() {
                                compute_first(&mut parts, &mut next, &mut stmts);
                            }
                            let site = SourceInfo {
                                span: stmt.site.span,
                                skip: stmt.site.skip,
                                ..SourceInfo::default()
                            };
                            stmts.push(Stmt { kind: StmtKind::Sync, site });
                        }
                        let kind = StmtKind::Print { serial: true, parts, stay: false };
                        stmts.push(Stmt { kind, site: stmt.site });
                    }
                    StmtKind::OpenPort | StmtKind::ClosePort => {
                        stmts.push(Stmt { kind: StmtKind::Comment, site: stmt.site });
                    }
                    kind => stmts.push(Stmt { kind, site: stmt.site }),
                }
            }
            block.stmts = stmts;
        }
    }
    for (index, span) in found {
        let what = "output in a format is printed without one: values have no blanks before them and no zeros at their \
                    end; make sure that what reads it does not count columns";
        context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
    }
}

/// Computes what is rounded before the wait that its output needs, where it hangs on no state of the machine: whoever reads
/// the program finds the wait beside the output.
fn compute_first(parts: &mut [PrintPart], next: &mut u32, stmts: &mut Stmts) {
    for part in parts {
        let PrintPart::Value(value @ Expr::Call(..)) = part else { continue };
        let mut waits = false;
        value.walk(&mut |e| waits |= matches!(e, Expr::System(..) | Expr::Indirect(..)));
        if !waits {
            *next += 1;
            let temp = Var { class: Class::Temp, number: *next };
            let value = std::mem::replace(value, Expr::Var(temp));
            let kind = StmtKind::Assign { target: Place::Var(temp), value };
            stmts.push(Stmt { kind, site: SourceInfo::default() });
        }
    }
}

/// A part of an output, by block, statement and part.
type PartOf = (BlockId, usize, usize);

/// Where values stand that have no more places than their format: whole numbers over a power of ten, as an earlier conversion
/// rounds them.
fn rounded(program: &Program, summaries: &Summaries) -> BTreeSet<PartOf> {
    let mut found: Vec<(PartOf, (usize, Expr))> = Vec::new();
    let mut vars = BTreeSet::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            let StmtKind::Output(parts) = &stmt.kind else { continue };
            for (n, part) in parts.iter().enumerate() {
                if let Some((from, over)) = over_scale(part, &block.stmts[..at]) {
                    over.variables(&mut |var| _ = vars.insert(var));
                    found.push(((id, at, n), (from, over.clone())));
                }
            }
        }
    }
    if found.is_empty() {
        return BTreeSet::new();
    }
    let ranges = Ranges::of_these(program, summaries, vars);
    found.retain(|((id, ..), (from, over))| ranges.at(*id, *from, over).all_whole());
    found.into_iter().map(|(place, _)| place).collect()
}

/// What stands over the power of ten in the temporary that is put out, and which of the statements before sets it.
fn over_scale<'s>(part: &OutputPart, before: &'s [Stmt]) -> Option<(usize, &'s Expr)> {
    let OutputPart::Value { value: Expr::Var(temp), fraction, .. } = part else { return None };
    let sets = |stmt: &Stmt| stmt.kind.target() == Some(&Place::Var(*temp));
    let from = before.iter().rposition(sets).filter(|_| temp.class == Class::Temp)?;
    let StmtKind::Assign { value: Expr::Binary(BinOp::Div, operands), .. } = &before[from].kind else {
        return None;
    };
    let scale = 10f64.powi(i32::try_from(*fraction).ok()?);
    let is_sure = before[from].site.skip.is_none() && operands[1].constant() == Some(scale);
    is_sure.then_some((from, &operands[0]))
}

/// A part without its format; a value that is `rounded` has no more places.
fn plain(part: OutputPart, rounded: bool) -> PrintPart {
    match part {
        OutputPart::Text(text) => PrintPart::Text(text),
        OutputPart::Value { value, .. } if rounded => PrintPart::Value(value),
        OutputPart::Value { value, fraction, .. } => {
            let value = match value {
                Expr::Vacant => Expr::Number(0.0),
                value if value.may_be_vacant() => Expr::binary(BinOp::Add, value, Expr::Number(0.0)),
                value => value,
            };
            PrintPart::Value(match fraction {
                0 => Expr::Call(Func::Round, [value].into()),
                places => Expr::Call(Func::RoundPlaces, [value, Expr::Number(f64::from(places))].into()),
            })
        }
    }
}
