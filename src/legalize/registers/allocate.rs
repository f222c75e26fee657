//! Registers for variables: one map for the whole library.
//!
//! A variable whose number the target has too keeps it. All others get a register of their own, the
//! one that the lock gives them or the next free one: their values outlive a program, so every one of
//! them interferes with every other. Temporaries live inside one program and are coloured
//! ([`super::temporaries`]) before this runs.

use super::clear;
use super::locked::{self, Locked};
use super::map::{Register, Registers};
use super::names::{OF, class_of, keeps_number, name_of, numbers_alike, reached};
use super::needs::class_of_colour;
use super::pool::Pool;
use super::results;
use super::runs::{banks, point, run_of};
use super::shortage::Shortage;
use crate::ir::analysis::VarSet;
use crate::ir::{Bank, Class, Module, Var};
use crate::legalize::Context;
use crate::legalize::by_program::look_at_each;
use crate::legalize::features::{Feature, Features};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// Gives every variable its register. Nothing changes the variables of the module after this.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let (features, locked) = (context.features, context.locked.clone());
    context.registers = allocate(module, &features, &locked, context);
    (context.registers.arguments, context.registers.always) = arguments(module, context);
}

/// The registers of what programs find in their own locals, and which of these every call gives a value.
fn arguments(module: &Module, context: &Context<'_>) -> (BTreeMap<String, u32>, BTreeSet<String>) {
    let (mut found, mut all) = (BTreeMap::new(), BTreeSet::new());
    for program in &module.programs {
        let Some(of) = &program.name else { continue };
        let Some(taken) = context.taken.get(of) else { continue };
        for (var, name) in program.held.iter().filter(|(_, name)| taken.contains(name)) {
            let Some(register) = context.registers.of.get(var) else { continue };
            let full = format!("{name}{OF}{}", of.short());
            if context.always.get(of).is_some_and(|always| always.contains(name)) {
                all.insert(full.clone());
            }
            found.insert(full, register.number);
        }
    }
    (found, all)
}

/// Chooses registers for everything in the library, after the choices of earlier runs.
fn allocate(
    module: &mut Module,
    features: &Features,
    locked: &Locked<'_>,
    context: &mut Context<'_>,
) -> Registers {
    let mut users: BTreeMap<Var, (usize, Span)> = BTreeMap::new();
    // Where no program names any, there is nothing to look for.
    if features.has(Feature::Variable) {
        let named = look_at_each(module, |_, program| VarSet::of(program));
        for (index, (program, named)) in module.programs.iter().zip(named).enumerate() {
            named.iter().for_each(|var| _ = users.entry(var).or_insert((index, program.site.span)));
        }
    }
    if clear::concerns(features, context) {
        users.insert(clear::COUNTER, (0, Span::default()));
    }
    let banks = if features.has(Feature::Banked) { banks(module) } else { BTreeMap::new() };
    for (bank, place) in &banks {
        for number in reached(*bank, context.source) {
            users.entry(Var { class: class_of(*bank), number }).or_insert(*place);
        }
    }
    let banked: Vec<Bank> = banks.keys().copied().collect();
    let kept: BTreeSet<Var> = users.keys().copied().filter(|var| keeps_number(*var, context)).collect();
    let effective = locked::settle(module, locked, &kept, &banked, context);
    let held = context.earlier.held.clone();
    let mut pool = Pool::new(context, &effective, locked, &held);
    let mut registers =
        Registers { freed: effective.freed.clone(), alike: numbers_alike(context), ..Registers::default() };
    registers.reached = context.reached.sure.clone();
    registers.reached.join(&context.reached.everything(context.source, context.target));
    for var in kept {
        pool.used.insert(var.number);
        registers.of.insert(var, Register { name: pool.name.clone(), number: var.number });
    }
    results::pin(&users, locked, &mut pool, &mut registers, module, context);
    let runs: Vec<(Bank, u32)> =
        banks.keys().filter_map(|bank| run_of(*bank, &mut pool, &users, &mut registers, context)).collect();
    let mut wanted: BTreeSet<Var> = users.into_keys().filter(|var| !registers.of.contains_key(var)).collect();
    let (free, settled) = (pool, registers);
    let (mut registers, mut short) = assign(&wanted, free.clone(), settled.clone(), module, context);
    if !short.is_empty() {
        let mut shortage = Shortage::of(module);
        while !short.is_empty() {
            let own = shortage.set_aside(&wanted, &short, context);
            if own.is_empty() {
                break;
            }
            wanted.retain(|var| !own.contains(var));
            (registers, short) = assign(&wanted, free.clone(), settled.clone(), module, context);
        }
        shortage.report(&short, &registers, module, context);
    }
    locked::tell_moves(module, &effective, &registers, context);
    locked::check(module, &effective.variables, &registers, context);
    let moved = registers.of.iter().filter(|(var, register)| !registers.is_own(var, register));
    let named = moved.filter_map(|(var, _)| Some((*var, name_of(*var, module, context.source)?)));
    registers.names = named.collect();
    point(module, &runs);
    registers
}

/// Gives variables their registers beside what is settled, and tells which get none.
fn assign(
    wanted: &BTreeSet<Var>,
    mut pool: Pool<'_>,
    mut registers: Registers,
    module: &Module,
    context: &Context<'_>,
) -> (Registers, Vec<Var>) {
    let mut short = Vec::new();
    let named = wanted.iter().map(|var| (*var, name_of(*var, module, context.source)));
    // What goes back to where it was comes first: nothing else takes its register.
    let mut kept = BTreeSet::new();
    let (mut back, new): (Vec<_>, Vec<_>) = named.partition(|(var, name)| {
        let there = name.as_deref().and_then(|name| pool.back_to(*var, name));
        there.is_some_and(|number| kept.insert(number))
    });
    back.extend(new);
    for (var, name) in back {
        let over = context.over_calls.contains(&var);
        let found = match class_of_colour(var, context.target) {
            Some(class) => pool.take_of(class),
            None => pool.take(var, name.as_deref(), over).map(|number| (pool.name.clone(), number)),
        };
        let Some((place, number)) = found else {
            short.push(var);
            continue;
        };
        if matches!(var.class, Class::Temp | Class::Static) {
            if place == pool.name {
                registers.scratch.insert(number);
            } else {
                registers.of_words.insert(format!("{place}{number}"));
            }
            registers.over_calls.extend(Some(number).filter(|_| over && place == pool.name));
        } else if let Some(name) = name {
            registers.chosen.insert(name, number);
        }
        registers.of.insert(var, Register { name: place, number });
    }
    (registers, short)
}
