//! System variables.

use super::Emitter;
use crate::canon::Sys;
use crate::dialect::SystemVariable;
use crate::ir::{BinOp, Expr};

impl Emitter<'_> {
    /// Writes the variable that holds a state of the machine, to be read or to be written.
    pub(super) fn state(&mut self, state: Sys, subscripts: &[Expr], written: bool) {
        let constants: Option<Vec<u32>> = subscripts.iter().map(whole).collect();
        match constants {
            Some(constants) => self.fixed_state(state, &constants, written),
            None => self.computed_state(state, subscripts, written),
        }
    }

    fn fixed_state(&mut self, state: Sys, subscripts: &[u32], written: bool) {
        let control = self.control;
        let rows = control.system_runs(state).filter(|row| row.name == "#" && allows(row, written));
        let number = rows.filter_map(|row| row.number_of(subscripts)?).next();
        match number {
            Some(number) => {
                self.out.push('#');
                self.out.integer(number);
            }
            None => {
                let verb = if written { "written" } else { "read" };
                self.out.unmapped(format_args!("the state '{state}' {subscripts:?} where it is {verb}"));
            }
        }
    }

    /// `#[5201+20*#1]`: the run's first number, less what each subscript counts from, plus
    /// each subscript times its step. The run is the first that the constant subscripts fit.
    fn computed_state(&mut self, state: Sys, subscripts: &[Expr], written: bool) {
        let control = self.control;
        let fitting = control.system_runs(state).filter(|row| row.name == "#" && allows(row, written));
        let Some((base, terms)) = fitting.filter_map(|row| terms(row, subscripts)).next() else {
            return self.out.unmapped(format_args!("the state '{state}' with computed subscripts"));
        };
        let mut sum: Option<Expr> = (base != 0).then_some(Expr::Number(base as f64));
        for (step, subscript) in terms {
            let term = match step {
                1 => subscript.clone(),
                _ => Expr::binary(BinOp::Mul, Expr::Number(f64::from(step)), subscript.clone()),
            };
            sum = Some(match sum {
                Some(sum) => Expr::binary(BinOp::Add, sum, term),
                None => term,
            });
        }
        self.out.push('#');
        self.bracketed(&sum.unwrap_or(Expr::Number(0.0)));
    }
}

fn allows(row: &SystemVariable, written: bool) -> bool {
    row.access.contains(if written { 'w' } else { 'r' })
}

/// A subscript that is a whole number.
fn whole(subscript: &Expr) -> Option<u32> {
    let value = subscript.constant()?;
    ((0.0..=4_294_967_295.0).contains(&value) && value.fract() == 0.0).then_some(value as u32)
}

/// The number that the constant parts add up to, and the steps of the computed subscripts.
fn terms<'e>(row: &SystemVariable, subscripts: &'e [Expr]) -> Option<(i64, Vec<(u32, &'e Expr)>)> {
    let (before, rest) = subscripts.split_at_checked(row.fixed.len())?;
    let (counted, after) = rest.split_at_checked(row.subscripts.len())?;
    let same = |exprs: &[Expr], values: &[u32]| {
        exprs.len() == values.len() && exprs.iter().zip(values).all(|(e, v)| whole(e) == Some(*v))
    };
    if !same(before, &row.fixed) || !same(after, &row.after) {
        return None;
    }
    let mut base = i64::from(row.first?);
    let mut terms = Vec::new();
    for (value, subscript) in counted.iter().zip(&row.subscripts) {
        let (from, step) = (i64::from(subscript.from), i64::from(subscript.step));
        match whole(value) {
            Some(value) if value.checked_sub(subscript.from).is_some_and(|n| n < subscript.count) => {
                base += (i64::from(value) - from) * step;
            }
            Some(_) => return None,
            None if value.constant().is_some() => return None,
            None => {
                base -= from * step;
                terms.push((subscript.step, value));
            }
        }
    }
    Some((base, terms))
}
