//! Formatted output, on a control that prints values as they come.
//!
//! Law: a value that is rounded to its places and then printed shows the digits that the format shows, but for zeros at its
//! end and the blanks before it. A whole number over a power of ten has its places, and is not rounded again. A port needs no opening where every line is sent by itself. A vacant value prints as 0.
//! Side condition, for a reviewer: whoever reads the lines does not count columns. Counter-example: `DPRNT[X#1[53]]`, which
//! fills nine columns, and `SPRINT "X",V1`.

use super::rounded::rounded;
use crate::canon::Func;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{
    BinOp, Class, Expr, Module, OutputPart, Place, PrintPart, SourceInfo, Stmt, StmtKind, Stmts, Var,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::highest_temp;
use crate::text::Span;
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
                            let waited = waited(&stmts);
                            if stmt.site.skip.is_none() {
                                compute_first(&mut parts, &mut next, &mut stmts);
                            }
                            let site = SourceInfo {
                                span: stmt.site.span,
                                skip: stmt.site.skip,
                                ..SourceInfo::default()
                            };
                            if !waited {
                                stmts.push(Stmt { kind: StmtKind::Sync, site });
                            }
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

/// True if the moves are waited for already: a wait, and after it nothing that moves.
fn waited(stmts: &[Stmt]) -> bool {
    let still =
        |kind: &StmtKind| matches!(kind, StmtKind::Comment | StmtKind::Assign { target: Place::Var(_), .. });
    let last = stmts.iter().rev().find(|stmt| !still(&stmt.kind));
    last.is_some_and(|last| last.kind == StmtKind::Sync && last.site.skip.is_none())
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
