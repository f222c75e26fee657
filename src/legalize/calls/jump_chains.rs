//! Jumps to a computed label, where the target has none.
//!
//! Law: a jump to the value goes where a comparison with each label's number goes, one after the other. The number is
//! rounded first where it may have a fraction, as the source's jump rounds it. If no block has the number, the source
//! stops with an alarm of its control, and the target with one of the program; where the analysis of values shows that
//! it cannot happen, none is written, and labels that the value never has are left out. Side condition: no more labels
//! than a reader can follow. Counter-example: a jump in a program of two hundred numbered blocks.

use crate::canon::Func;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::{Numbers, Ranges, Summaries};
use crate::ir::{
    BinOp, BlockId, Builder, Class, Cond, Expr, Module, Place, Program, Relation, SourceInfo, StmtKind,
    TermKind, Terminator, Var,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use thin_vec::ThinVec;

/// Most labels that a jump is written out for.
const MOST: usize = 64;

/// True if the library has computed jumps and the target none.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::ComputedJump) && context.target.statement("goto.computed").is_none()
}

/// Writes computed jumps out.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let summaries = Summaries::of(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let jumps = jumps(program, &summaries);
        if jumps.is_empty() {
            continue;
        }
        for (site, _) in jumps.iter().filter(|(_, jump)| jump.targets.len() > MOST) {
            let what = format!(
                "this jump is computed and may go to more than {MOST} blocks, and the target has no such jump: write \
                 an IF for each block that it is meant for"
            );
            context.add(index, Diagnostic::new(Code::NoEquivalent, site.span, what));
        }
        write_out(program, jumps);
    }
}

/// A computed jump as it will be written.
struct Jump {
    value: Expr,
    /// The value may have a fraction.
    rounded: bool,
    targets: ThinVec<(u32, BlockId)>,
    /// The value may be that of no label.
    may_miss: bool,
}

/// The computed jumps of a program, in the order of its blocks.
fn jumps(program: &Program, summaries: &Summaries) -> Vec<(SourceInfo, Jump)> {
    let ranges = Ranges::of_any_inputs(program, summaries);
    let mut found = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        let TermKind::Computed { value, targets } = &block.term.kind else { continue };
        let values = ranges.at(id, block.stmts.len(), value);
        let numbers = values.numbers();
        let mut targets = targets.clone();
        targets.retain(|(number, _)| numbers.contains(*number));
        targets.sort_by_key(|(number, _)| *number);
        let known = Numbers::of(targets.iter().map(|(number, _)| (*number, *number)));
        let negative = values.bounds().is_none_or(|(low, _)| low < 0.0);
        let may_miss = negative || value.may_be_vacant() || !values.all_whole() || !known.holds(&numbers);
        let rounded = !values.all_whole() && !value.is_whole();
        found.push((block.term.site.clone(), Jump { value: Expr::clone(value), rounded, targets, may_miss }));
    }
    found
}

fn write_out(program: &mut Program, jumps: Vec<(SourceInfo, Jump)>) {
    let temp = Var { class: Class::Temp, number: highest_temp(program) + 1 };
    let mut jumps = jumps.into_iter();
    rebuild(program, &mut |builder, part| match part {
        Part::Term(Terminator { kind: TermKind::Computed { .. }, site }) => {
            if let Some((_, jump)) = jumps.next() {
                chain(builder, jump, temp, site);
            }
        }
        other => other.keep(builder),
    });
}

/// One branch for each label, and an alarm after the last.
fn chain(builder: &mut Builder, jump: Jump, temp: Var, site: SourceInfo) {
    let place = SourceInfo { span: site.span, ..SourceInfo::default() };
    let mut site = Some(site);
    let mut next_site = || site.take().unwrap_or_else(|| place.clone());
    let value = match jump.value {
        Expr::Var(var) if !jump.rounded => Expr::Var(var),
        value => {
            // What is vacant finds no block, as 0 does not.
            let value = match value.may_be_vacant() {
                true => Expr::binary(BinOp::Add, value, Expr::Number(0.0)),
                false => value,
            };
            let value = if jump.rounded { Expr::Call(Func::Round, [value].into()) } else { value };
            builder.push(StmtKind::Assign { target: Place::Var(temp), value }, next_site());
            Expr::Var(temp)
        }
    };
    let last = if jump.may_miss { None } else { jump.targets.last().copied() };
    let branches = jump.targets.len() - usize::from(last.is_some());
    for (number, to) in jump.targets.into_iter().take(branches) {
        let cond = Cond::Compare(Relation::Equal, value.clone(), Expr::Number(f64::from(number)));
        builder.end_then(next_site(), |otherwise| TermKind::Branch {
            cond: Box::new(cond),
            then: to,
            otherwise,
        });
    }
    match last {
        Some((_, to)) => builder.end(TermKind::Jump(to), next_site()),
        None => {
            let alarm = StmtKind::Alarm { number: Expr::Number(1.0).into(), text: "NO SUCH BLOCK".into() };
            builder.push(alarm, next_site());
            builder.end(TermKind::End { rewind: false }, place.clone());
        }
    }
}
