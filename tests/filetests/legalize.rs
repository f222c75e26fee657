//! `test legalize <pass>[+<pass>]..|all <source> <target> [after] [lock:NAME=NUMBER]..`: what passes, in the order of
//! legalization, make of a module for a target, and what they have to say (a machine may have a profile in brackets behind its dialect): findings first, then registers, then the module. The pass `registers` gives every variable its
//! register and does what needs them. Claims must hold before and behind it; with `after`, only behind.

use crate::machine::machine;
use crate::{Case, claims};
use macroglot::ir::text::{parse, print};
use macroglot::ir::validate;
use macroglot::legalize::pipeline::{GROUPS, Pass};
use macroglot::legalize::{Context, Locked, Registers};
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
    let variables = locked(options)?;
    let mut context = Context::new(&source, &target, after.programs.len());
    let registers = if pass == "registers" {
        context.locked = Locked { variables: &variables, ..Locked::default() };
        of_groups(REGISTERS).for_each(|pass| pass.apply(&mut after, &mut context));
        std::mem::take(&mut context.registers)
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

/// The groups of passes that run before variables have registers, but for those that only tidy.
pub const LEGALIZE: &[&str] = &[
    "earlier",
    "read",
    "source",
    "structure",
    "blocks",
    "calls",
    "moves",
    "variables",
    "cycles",
    "lathe",
    "codes",
    "expressions",
    "entry",
];

/// Those that give them, and need them.
const REGISTERS: &[&str] = &["registers", "operator", "layout"];

/// The passes of some groups.
pub fn of_groups(names: &'static [&'static str]) -> impl Iterator<Item = &'static Pass> {
    GROUPS.iter().filter(|group| names.contains(&group.name)).flat_map(|group| group.passes)
}

/// The passes of a name such as `link+outline`; `all` are all of them.
fn named(names: &str) -> Result<Vec<&'static Pass>, String> {
    let wanted: Vec<&str> = names.split('+').collect();
    let passes: Vec<_> = of_groups(LEGALIZE).filter(|p| names == "all" || wanted.contains(&p.name)).collect();
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
    let mut context = Context::new(&source, &target, module.programs.len());
    for pass in named(names)? {
        let (before, said) = (module.clone(), context.found());
        pass.apply(&mut module, &mut context);
        all.push((pass.name, context.found() > said || module != before));
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
