//! `test legalize <pass>[+<pass>]..|all <source> <target> [after] [lock:NAME=NUMBER]..`: what passes, in the order of
//! legalization, make of a module for a target, and what they have to say (a machine may have a profile in brackets behind its dialect): findings first, then registers, then the module. The pass `registers` gives every variable its
//! register and does what needs them. Claims must hold before and behind it; with `after`, only behind.

use crate::machine::machine;
use crate::{Case, claims};
use macroglot::ir::analysis::Numbers;
use macroglot::ir::text::{parse, print};
use macroglot::ir::validate;
use macroglot::legalize::{Context, Locked, PASSES, Pass, Registers, assign_registers};
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
        let variables = locked(options)?;
        let locked = Locked {
            variables: &variables,
            scratch: &[],
            own: &[],
            reached: Numbers::default(),
            others: &[],
        };
        assign_registers(&mut after, &locked, &mut context)
    } else {
        named(pass)?.iter().for_each(|pass| pass.apply(&mut after, &mut context));
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

/// The passes of a name such as `link+outline`; `all` are all of them.
fn named(names: &str) -> Result<Vec<&'static Pass>, String> {
    let wanted: Vec<&str> = names.split('+').collect();
    let passes: Vec<_> = PASSES.iter().filter(|p| names == "all" || wanted.contains(&p.name)).collect();
    let found = names == "all" || passes.len() == wanted.len();
    found.then_some(passes).ok_or_else(|| format!("no such passes: {names}"))
}

/// Which passes a case has something to do or to say for, and which it leaves with nothing.
pub fn acts(case: &Case) -> Result<Vec<(&'static str, bool)>, String> {
    let [names, source, target, ..] = case.options.as_slice() else { return Ok(Vec::new()) };
    if names == "registers" {
        return Ok(Vec::new());
    }
    let (source, target) = (machine(source)?, machine(target)?);
    let mut module = parse(&case.text).map_err(|e| e.to_string())?;
    let mut all = Vec::new();
    for pass in named(names)? {
        let before = module.clone();
        let mut context = Context::new(&source, &target, module.programs.len());
        pass.apply(&mut module, &mut context);
        let said = context.into_findings().iter().any(|findings| !findings.is_empty());
        all.push((pass.name, said || module != before));
    }
    Ok(all)
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
