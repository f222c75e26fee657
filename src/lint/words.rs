//! Words: lengths without a point, speeds that nothing checks, texts that are too long; values that are lost.

use super::conditions::compared;
use super::looked::{Findings, Looked};
use crate::canon::{Op, Role};
use crate::diag::Code;
use crate::dialect::BareLength;
use crate::ir::analysis::dataflow::reached;
use crate::ir::{Expr, NcItem, Place, Program, StmtKind, TermKind, Var};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A length without a decimal point among others that have one, where the control counts increments.
pub(super) fn bare_length(looked: &Looked<'_>, findings: &mut Findings) {
    if looked.control.bare_length() == BareLength::Units {
        return;
    }
    for (_, program) in looked.programs() {
        let (mut bare, mut pointed): (Vec<(Span, f64)>, usize) = (Vec::new(), 0);
        let mut note = |value: &Expr, span: Span| {
            let inner = if let Expr::Negate(inner) = value { inner } else { value };
            match inner {
                Expr::Increments(n) if *n != 0.0 => bare.push((span, *n)),
                Expr::Number(n) if *n != 0.0 => pointed += 1,
                _ => {}
            }
        };
        for block in &program.blocks {
            for stmt in &block.stmts {
                let Some(nc) = stmt.kind.nc() else { continue };
                for item in &nc.items {
                    if let NcItem::Word(role, value) = item
                        && role.is_length()
                    {
                        note(value, stmt.site.span);
                    }
                }
            }
            if let TermKind::Call { call, .. } = &block.term.kind {
                call.arguments.iter().for_each(|argument| note(&argument.value, block.term.site.span));
            }
        }
        if pointed <= bare.len() {
            continue;
        }
        let step = looked.control.numbers();
        for (span, count) in bare {
            let (mm, inch) = (count * step.increment_mm, count * step.increment_inch);
            let message = format!(
                "a length has no decimal point, and others of the program have one: {count} is {} mm or {} inch here",
                tidy(mm),
                tidy(inch)
            );
            findings.add(program.file, Code::BareLength, span, message);
        }
    }
}

fn tidy(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// A spindle speed that comes from outside the program, and that no comparison bounds.
pub(super) fn unchecked_speed(looked: &Looked<'_>, findings: &mut Findings) {
    for (_, program) in looked.programs() {
        let mut speeds: Vec<(Span, BTreeSet<Var>)> = Vec::new();
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let Some(speed) = stmt.kind.nc().and_then(|nc| nc.word(Role::Speed)) else { continue };
            let mut vars = BTreeSet::new();
            speed.variables(&mut |var| {
                vars.insert(var);
            });
            if !vars.is_empty() {
                speeds.push((stmt.site.span, vars));
            }
        }
        if speeds.is_empty() {
            continue;
        }
        let (made_of, checked) = made_of(program);
        for (span, vars) in speeds {
            let all = reached(vars, |var, go| {
                made_of.get(&var).into_iter().flatten().for_each(|other| go(*other));
            });
            let outside = all.iter().find(|var| !made_of.contains_key(var));
            if let Some(var) = outside.filter(|_| all.is_disjoint(&checked)) {
                let message = format!(
                    "the spindle speed depends on {}, which comes from outside the program, and no comparison bounds it",
                    looked.name(*var)
                );
                findings.add(program.file, Code::UncheckedSpeed, span, message);
            }
        }
    }
}

/// What each variable that a program sets is made of, and the variables that it compares for less or greater.
fn made_of(program: &Program) -> (BTreeMap<Var, BTreeSet<Var>>, BTreeSet<Var>) {
    let (mut made, mut checked): (BTreeMap<Var, BTreeSet<Var>>, BTreeSet<Var>) = Default::default();
    for block in &program.blocks {
        for stmt in &block.stmts {
            let StmtKind::Assign { target, value } = &stmt.kind else { continue };
            if let Place::Var(var) = target {
                let parts = made.entry(*var).or_default();
                value.variables(&mut |part| {
                    parts.insert(part);
                });
            }
        }
        if let TermKind::Branch { cond, .. } = &block.term.kind {
            use crate::ir::Relation::{Equal, NotEqual};
            compared(cond, &mut |relation, a, b| {
                if !matches!(relation, Equal | NotEqual) {
                    [a, b].into_iter().for_each(|e| {
                        e.variables(&mut |var| {
                            checked.insert(var);
                        })
                    });
                }
            });
        }
    }
    (made, checked)
}

/// A text for the operator that is longer than the control shows.
pub(super) fn long_text(looked: &Looked<'_>, findings: &mut Findings) {
    for program in &looked.module.programs {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let (name, text) = match &stmt.kind {
                StmtKind::Alarm { text, .. } => ("message.alarm", text),
                StmtKind::StopMessage { text, .. } => ("message", text),
                _ => continue,
            };
            let Some((row, most)) = looked.control.limit_row(name).and_then(|row| Some((row, row.max?)))
            else {
                continue;
            };
            let count = text.chars().count();
            if count > most as usize {
                let sure = if row.origin.is_settled() { "" } else { ", as far as is known" };
                let shown: String = text.chars().take(most as usize).collect();
                let message = format!(
                    "the text has {count} characters, and the control shows {most}{sure}: '{}' ('limits.{name}')",
                    shown.trim_end()
                );
                findings.add(program.file, Code::LongText, stmt.site.span, message);
            }
        }
    }
}

/// A value that the next statements replace before anything reads it.
pub(super) fn overwritten(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, program) in looked.programs().filter(|(at, _)| !looked.has_hole(*at)) {
        for block in &program.blocks {
            let mut open: BTreeMap<Var, (Span, bool)> = BTreeMap::new();
            for stmt in &block.stmts {
                let mut seen = BTreeSet::new();
                let mut indirect = false;
                stmt.kind.exprs(&mut |e| {
                    e.variables(&mut |var| {
                        seen.insert(var);
                    });
                    e.walk(&mut |part| indirect |= matches!(part, Expr::Indirect(..)));
                });
                let acts = !matches!(
                    stmt.kind,
                    StmtKind::Assign { .. } | StmtKind::Comment | StmtKind::Input { .. }
                );
                if indirect
                    || acts && !matches!(&stmt.kind, StmtKind::Nc(_))
                    || calls_at_moves(looked, &stmt.kind)
                {
                    open.clear();
                }
                open.retain(|var, _| !seen.contains(var));
                let Some(Place::Var(var)) = stmt.kind.target() else { continue };
                if stmt.site.skip.is_some() {
                    open.remove(var);
                    continue;
                }
                let cleared = matches!(&stmt.kind, StmtKind::Assign { value, .. } if value.constant() == Some(0.0) || *value == Expr::Vacant);
                let before = open.insert(*var, (stmt.site.span, cleared));
                // Whoever clears a variable first means nothing by the 0.
                if let Some((span, false)) = before {
                    let line = looked.line(at, stmt.site.span);
                    let message = format!(
                        "{} gets a value here that line {line} replaces before anything reads it",
                        looked.name(*var)
                    );
                    findings.add(program.file, Code::Overwritten, span, message);
                }
                if !matches!(stmt.kind, StmtKind::Assign { .. }) {
                    open.remove(var);
                }
            }
        }
    }
}

/// True for words that may run a macro, or that let a control read variables by itself.
fn calls_at_moves(looked: &Looked<'_>, kind: &StmtKind) -> bool {
    use Op::{Builder, CycleHere, MachineSpecific, ReadOffset, WriteVariable};
    let reads = |op: Op| {
        op.is_cycle() || matches!(op, Builder | CycleHere | MachineSpecific | ReadOffset | WriteVariable)
    };
    matches!(kind, StmtKind::Nc(nc) if nc.moves() && looked.has_modal_calls() || nc.ops().any(reads))
}
