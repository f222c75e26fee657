//! Arithmetic: divisions by nothing, numbers of variables without a bound, remainders of the wrong sign.

use super::looked::{Findings, Looked, blocks};
use crate::canon::{Func, Op};
use crate::diag::Code;
use crate::ir::analysis::{Ranges, VarSet};
use crate::ir::{BinOp, BlockId, Callee, Class, Expr, Place, Program, StmtKind, TermKind, Var};
use crate::text::Span;
use std::collections::BTreeMap;

/// Visits every expression of a program, with the block and the statement that it stands in.
pub(super) fn each_expr(program: &Program, f: &mut dyn FnMut(BlockId, usize, Span, &Expr)) {
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            stmt.kind.exprs(&mut |e| f(id, at, stmt.site.span, e));
        }
        block.term.kind.exprs(&mut |e| f(id, block.stmts.len(), block.term.site.span, e));
    }
}

/// A division by a variable that nothing sets, and that nothing asks for.
pub(super) fn unset_divisor(looked: &Looked<'_>, findings: &mut Findings) {
    let mut divisors: Vec<(usize, Var, Span)> = Vec::new();
    for (at, program) in looked.programs() {
        each_expr(program, &mut |_, _, span, e| {
            e.walk(&mut |part| {
                if let Expr::Binary(BinOp::Div, operands) = part
                    && let Expr::Var(var) = operands[1]
                {
                    divisors.push((at, var, span));
                }
            });
        });
    }
    if divisors.is_empty() || looked.has_holes() {
        return;
    }
    let touched = touched(looked);
    for (at, var, span) in divisors {
        let called = looked.called(at);
        // Its callers may stand elsewhere, or lend it their own locals.
        let open = var.class == Class::Local && (called.without || !called.with_level && !looked.is_main(at));
        if open || touched.any(at, var) {
            continue;
        }
        let message = format!("this divides by {}, which nothing in the library sets", looked.name(var));
        findings.add(looked.module.programs[at].file, Code::UnsetDivisor, span, message);
    }
}

/// What is set or asked for anywhere.
struct Touched {
    shared: VarSet,
    /// By program.
    locals: Vec<VarSet>,
    /// True where a computed number may set any.
    computed: bool,
}

impl Touched {
    fn any(&self, program: usize, var: Var) -> bool {
        let own = self.locals.get(program).is_some_and(|locals| locals.contains(var));
        self.computed || own || self.shared.contains(var)
    }

    fn note(&mut self, program: usize, var: Var) {
        if var.class.shared() {
            self.shared.insert(var);
        } else if let Some(locals) = self.locals.get_mut(program) {
            locals.insert(var);
        }
    }
}

fn touched(looked: &Looked<'_>) -> Touched {
    let locals = looked.programs().map(|_| VarSet::default()).collect();
    let mut touched = Touched { shared: VarSet::default(), locals, computed: false };
    for (at, _, block) in blocks(looked.module) {
        for stmt in &block.stmts {
            match stmt.kind.target() {
                Some(Place::Var(var)) => touched.note(at, *var),
                Some(Place::Indirect(..)) => touched.computed = true,
                _ => {}
            }
            touched.computed |=
                matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(Op::WriteVariable) || nc.has(Op::ReadOffset));
        }
        match &block.term.kind {
            TermKind::Branch { cond, .. } => {
                cond.exprs(&mut |e| e.variables(&mut |var| touched.note(at, var)))
            }
            // A program of another maker may set anything.
            TermKind::Call { call, .. } => {
                if !call.level && matches!(call.callee, Callee::Program(_)) {
                    let written = looked.summaries().by_call(call);
                    written.vars().for_each(|var| touched.note(at, var));
                    touched.computed |= written.classes().next().is_some();
                }
                touched.computed |= match &call.callee {
                    Callee::Program(name) => looked.program_of(name).is_none(),
                    Callee::Block(_) => false,
                    _ => true,
                };
            }
            _ => {}
        }
    }
    for site in looked.sites() {
        let Some(callee) = site.callee.filter(|_| site.call.level) else { continue };
        for argument in &site.call.arguments {
            touched.note(callee, Var { class: Class::Local, number: argument.local });
        }
    }
    touched
}

/// A computed subscript that nothing in its program bounds.
pub(super) fn open_subscript(looked: &Looked<'_>, findings: &mut Findings) {
    for (_, program) in looked.programs() {
        let mut found: Vec<(BlockId, usize, Span, Expr)> = Vec::new();
        let mut note = |id, at, span, e: &Expr| {
            e.walk(&mut |part| {
                if let Expr::Indirect(_, index) = part {
                    found.push((id, at, span, (**index).clone()));
                }
            });
        };
        each_expr(program, &mut note);
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                if let Some(place @ Place::Indirect(..)) = stmt.kind.target() {
                    note(id, at, stmt.site.span, &place.read());
                }
            }
        }
        if found.is_empty() {
            continue;
        }
        let ranges = Ranges::of_constants_and_codes(program, looked.summaries());
        let with_indexes = Ranges::of(program, looked.summaries());
        for (id, at, span, index) in found {
            let bounded = |ranges: &Ranges<'_>| {
                let bounds = ranges.at(id, at, &index).bounds();
                bounds.is_none_or(|(low, high)| low.is_finite() && high.is_finite())
            };
            if !bounded(&ranges) && !bounded(&with_indexes) {
                let message = "the number of this variable is computed, and nothing in the program bounds it";
                findings.add(program.file, Code::OpenSubscript, span, message);
            }
        }
    }
}

/// A remainder is made with the nearest whole number where the one below is meant.
pub(super) fn round_for_fix(looked: &Looked<'_>, findings: &mut Findings) {
    for (_, program) in looked.programs() {
        let mut set: BTreeMap<Var, (BlockId, Expr)> = BTreeMap::new();
        let mut last = None;
        for (id, block) in program.ids().zip(&program.blocks) {
            for stmt in &block.stmts {
                let mut found = false;
                stmt.kind.exprs(&mut |e| e.walk(&mut |part| found |= is_remainder(part, id, &set)));
                if found && last != Some(stmt.site.span) {
                    let message = "the remainder of a division is taken from the nearest whole number, so it is below 0 \
                                   for half of all values: the whole number toward zero is meant";
                    findings.add(program.file, Code::RoundForFix, stmt.site.span, message);
                    last = Some(stmt.site.span);
                }
                if let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind {
                    set.insert(*var, (id, value.clone()));
                }
            }
        }
    }
}

/// `a - ROUND(a / n) * n`, the rounded part perhaps kept in a variable before.
fn is_remainder(e: &Expr, id: BlockId, set: &BTreeMap<Var, (BlockId, Expr)>) -> bool {
    let Expr::Binary(BinOp::Sub, operands) = e else { return false };
    let Expr::Binary(BinOp::Mul, factors) = &operands[1] else { return false };
    let rounded = |e: &Expr, of: &Expr, by: &Expr| {
        let kept = match e {
            Expr::Var(var) => set.get(var).filter(|(there, _)| *there == id).map(|(_, value)| value),
            e => Some(e),
        };
        matches!(kept, Some(Expr::Call(Func::Round, all)) if matches!(all.first(), Some(Expr::Binary(BinOp::Div, parts)) if parts[0] == *of && parts[1] == *by))
    };
    let of = &operands[0];
    rounded(&factors[0], of, &factors[1]) || rounded(&factors[1], of, &factors[0])
}
