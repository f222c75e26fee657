//! `test legalize <pass>[+<pass>].. <source> <target> [after] [lock:NAME=NUMBER]..`: what passes, in the order of
//! legalization, make of a module for a target, and what they have to say (a machine may have a profile in brackets behind its dialect): findings first, then registers, then the module. The pass `registers` gives every variable its
//! register and does what needs them. Claims must hold before and behind it; with `after`, only behind.

use crate::machine::machine;
use crate::{Case, claims};
use macroglot::ir::text::{parse, print};
use macroglot::ir::validate;
use macroglot::legalize::{Context, PASSES, Registers, assign_registers};
use std::collections::BTreeMap;
use std::fmt::Write;

pub fn drive(case: &Case) -> Result<Option<String>, String> {
    let [pass, source, target, options @ ..] = case.options.as_slice() else {
        return Err("wants a pass, a source and a target".into());
    };
    let (source, target) = (machine(source)?, machine(target)?);
    let before = parse(&case.text).map_err(|e| e.to_string())?;
    validate(&before).map_err(|all| all[0].to_string())?;
    if !options.iter().any(|option| option == "after") {
        claims::check(&case.text, &before)?;
    }

    let mut after = before;
    let mut context = Context::new(&source, &target, after.programs.len());
    let registers = if pass == "registers" {
        assign_registers(&mut after, &locked(options)?, &[], &mut context)
    } else {
        let names: Vec<&str> = pass.split('+').collect();
        let passes: Vec<_> = PASSES.iter().filter(|p| names.contains(&p.name)).collect();
        if passes.len() != names.len() {
            return Err(format!("no such passes: {pass}"));
        }
        passes.iter().for_each(|pass| pass.apply(&mut after, &mut context));
        Registers::default()
    };
    validate(&after).map_err(|all| format!("broken: {}\n{after}", all[0]))?;
    claims::check(&case.text, &after)?;

    let mut out = String::new();
    for (program, findings) in context.into_findings().iter().enumerate() {
        for finding in findings {
            let _ = writeln!(out, "{program}: {:?} @{}", finding.code, finding.span.start);
        }
    }
    for (var, register) in &registers.of {
        let _ = writeln!(out, "{var} is {}{}", register.name, register.number);
    }
    Ok(Some(out + &print(&after)))
}

/// Registers that an earlier run chose.
fn locked(options: &[String]) -> Result<BTreeMap<String, u32>, String> {
    let locks = options.iter().filter_map(|option| option.strip_prefix("lock:"));
    locks
        .map(|lock| {
            let (name, number) = lock.split_once('=').ok_or("a lock lacks its number")?;
            Ok((name.to_owned(), number.parse().map_err(|_| format!("no number: {number}"))?))
        })
        .collect()
}
