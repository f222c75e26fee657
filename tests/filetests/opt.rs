//! `test opt <pass>|all [-O1|-O2]`: what passes make of a module. Claims must hold before and
//! behind them, and for many start values both must do the same.

use crate::domain::DOMAIN;
use crate::{Case, claims};
use macroglot::ir::eval::{Ending, Memory, Trace, run};
use macroglot::ir::text::{parse, print};
use macroglot::ir::{Class, Module, Var, validate};
use macroglot::opt::{self, Level};

pub fn drive(case: &Case) -> Result<Option<String>, String> {
    let before = parse(&case.text).map_err(|e| e.to_string())?;
    validate(&before).map_err(|all| all[0].to_string())?;
    let level = if case.options.iter().any(|o| o == "-O2") { Level::O2 } else { Level::O1 };
    let mut after = before.clone();
    let passes = match case.options.first().map_or("", String::as_str) {
        "all" => opt::PASSES.to_vec(),
        name => vec![opt::find(name).ok_or_else(|| format!("no pass '{name}'"))?],
    };
    opt::run(&mut after, &passes, level).map_err(|(pass, first)| format!("{pass}: {first}"))?;
    validate(&after).map_err(|all| format!("broken: {}", all[0]))?;
    claims::check(&case.text, &before)?;
    claims::check(&case.text, &after)?;
    compare(&before, &after)?;
    Ok(Some(print(&after)))
}

/// Runs both on every pair of values of two variables of each class.
fn compare(before: &Module, after: &Module) -> Result<(), String> {
    for (a, b) in DOMAIN.iter().flat_map(|a| DOMAIN.iter().map(move |b| (*a, *b))) {
        for switches in [vec![], vec![1]] {
            let (old, new) = (observe(before, a, b, &switches), observe(after, a, b, &switches));
            if old != new {
                return Err(format!("with {a:?} and {b:?}\nbefore: {old:?}\nafter: {new:?}"));
            }
        }
    }
    Ok(())
}

/// What others can see of a run.
fn observe(module: &Module, a: Option<f64>, b: Option<f64>, switches: &[u8]) -> (Trace, Vec<(Var, u64)>) {
    let mut memory = Memory { switches: switches.to_vec(), ..Memory::new() };
    for class in [Class::Local, Class::Common, Class::Global] {
        let base = if class == Class::Common { 100 } else { 0 };
        memory.set(Var { class, number: base + 1 }, a);
        memory.set(Var { class, number: base + 2 }, b);
    }
    let trace = run(module, 0, &mut memory, &[1.0, 2.0], 500);
    assert!(!matches!(trace.ending, Ending::Unsupported(_)), "{:?}", trace.ending);
    let shared = memory.vars.iter().filter(|(var, _)| var.class.shared());
    let vacant = u64::MAX;
    (trace, shared.map(|(var, value)| (*var, value.map_or(vacant, f64::to_bits))).collect())
}
