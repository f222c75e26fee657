//! With how many digits the machines calculate, where a comparison of computed values rests on it.

use super::keys::AskedSetting;
use super::shape::{NAMED, Places};
use crate::dialect::{Control, Side};
use crate::ir::{BinOp, Cond, Expr, Module, Place, Program, StmtKind, TermKind, Var};
use crate::text::Span;
use std::collections::BTreeSet;

/// The settings that say it, of machines whose profiles and tables do not. They are asked where both machines could be
/// said to calculate alike, so that rounding decides nothing that differs.
pub(super) fn asked(places: &Places<'_>, controls: [&Control; 2], module: &Module) -> Vec<AskedSetting> {
    let found: Vec<(usize, Span)> =
        module.programs.iter().filter_map(|program| Some((program.file, compared(program)?))).collect();
    let settings = controls.map(Control::double_setting);
    if found.is_empty() || settings.iter().any(Option::is_none) {
        return Vec::new();
    }
    let sides = [Side::Source, Side::Target].into_iter().zip(controls).zip(settings);
    let open = sides.filter(|((_, control), _)| !control.is_said_double());
    let asked = open.filter_map(|((side, control), setting)| {
        let (section, name, double) = setting?;
        let row = control.setting_row(&match section {
            "parameters" => format!("parameter.{name}"),
            _ => format!("setting.{name}"),
        })?;
        let is_said =
            control.profile().settings.contains_key(name) || control.profile().parameters.contains_key(name);
        (!is_said).then(|| AskedSetting {
            side,
            section,
            name: name.to_owned(),
            // Nobody reads it off a page of the machine.
            as_fact: true,
            likely: Some(double.to_owned()),
            wanted: Vec::new(),
            values: row.values.clone(),
            default: None,
            meaning: format!("it calculates with about fifteen digits ({})", row.meaning),
            programs: found.len(),
            places: found.iter().take(NAMED).map(|(file, span)| places.at(*file, *span)).collect(),
        })
    });
    asked.collect()
}

/// The first comparison of a program whose operands may have a last digit that rounding made.
fn compared(program: &Program) -> Option<Span> {
    let mut rounded: BTreeSet<Var> = BTreeSet::new();
    let stmts = || program.blocks.iter().flat_map(|block| &block.stmts);
    for _ in 0..2 {
        for stmt in stmts() {
            if let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind
                && is_rounded(value, &rounded)
            {
                rounded.insert(*var);
            }
        }
    }
    program.blocks.iter().find_map(|block| match &block.term.kind {
        TermKind::Branch { cond, .. } if compares(cond, &rounded) => Some(block.term.site.span),
        _ => None,
    })
}

fn compares(cond: &Cond, rounded: &BTreeSet<Var>) -> bool {
    match cond {
        Cond::Compare(_, a, b) => [a, b].into_iter().any(|side| is_rounded(side, rounded)),
        Cond::And(all) | Cond::Or(all) => all.iter().any(|one| compares(one, rounded)),
        Cond::Not(inner) => compares(inner, rounded),
        Cond::Switch(_) => false,
    }
}

/// True where arithmetic with fractions, or a division, makes the value.
fn is_rounded(value: &Expr, rounded: &BTreeSet<Var>) -> bool {
    let is_whole = |e: &Expr| e.constant().is_some_and(|number| number.fract() == 0.0);
    let mut found = false;
    value.walk(&mut |e| {
        found |= match e {
            Expr::Var(var) => rounded.contains(var),
            Expr::Binary(BinOp::Div, _) => true,
            Expr::Binary(BinOp::Add | BinOp::Sub | BinOp::Mul, sides) => !sides.iter().any(is_whole),
            _ => false,
        };
    });
    found
}
