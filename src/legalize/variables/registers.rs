//! Registers for variables: one map for the whole library.
//!
//! A variable whose number the target has too keeps it. All others get a register of their own, the
//! one that the lock gives them or the next free one: their values outlive a program, so every one of
//! them interferes with every other. Temporaries live inside one program and are coloured
//! ([`crate::legalize::temporaries`]) before this runs.

use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, VariableClass};
use crate::ir::analysis::{Numbers, VarSet};
use crate::ir::{Bank, BinOp, Class, Expr, Module, Place, StmtKind, Var};
use crate::legalize::features::{Feature, Features};
use crate::legalize::variables::clear;
use crate::legalize::variables::locked::{Effective, Locked};
use crate::legalize::{Context, Position, Rewriter, rewrite_program};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A register of the target: its name before the number, and its number.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Register {
    /// `#`, `V`.
    pub name: String,
    /// Its number.
    pub number: u32,
}

/// The map, and what the lock is to remember of it.
#[derive(Clone, Debug, Default)]
pub struct Registers {
    /// The register of each variable.
    pub of: BTreeMap<Var, Register>,
    /// What was chosen, by the variable's name on the source.
    pub chosen: BTreeMap<String, u32>,
    /// The registers of temporaries.
    pub scratch: BTreeSet<u32>,
    /// Variables that lose the register of an earlier run, by name.
    pub freed: BTreeSet<String>,
    /// Numbers that programs reach by computing them, or may.
    pub reached: Numbers,
    /// The names on the source of variables that have another number now.
    pub names: BTreeMap<Var, String>,
}

impl Registers {
    /// The registers that hold something else than the variable of their number.
    pub fn taken(&self) -> impl Iterator<Item = u32> + '_ {
        self.of.iter().filter(|(var, register)| !is_own(var, register)).map(|(_, register)| register.number)
    }

    /// The registers that hold the variable of their number, locals aside.
    pub fn own(&self) -> impl Iterator<Item = u32> + '_ {
        let own = self.of.iter().filter(|(var, register)| is_own(var, register) && var.class != Class::Local);
        own.map(|(_, register)| register.number)
    }

    /// The registers of variables that a program of the source has.
    pub fn held(&self) -> impl Iterator<Item = u32> + '_ {
        let named = self.of.iter().filter(|(var, _)| var.class != Class::Temp);
        named.map(|(_, register)| register.number)
    }
}

fn is_own(var: &Var, register: &Register) -> bool {
    var.class.nullable() && var.number == register.number
}

/// Gives every variable its register. Nothing changes the variables of the module after this.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let (features, locked) = (context.features, context.locked.clone());
    context.registers = allocate(module, &features, &locked, context);
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
    let named = module.programs.iter().enumerate().filter(|_| features.has(Feature::Variable));
    let mut seen = VarSet::default();
    for (index, program) in named {
        program.variables(&mut |var| {
            if seen.insert(var) {
                users.insert(var, (index, program.site.span));
            }
        });
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
    let effective = crate::legalize::variables::locked::settle(module, locked, &kept, &banked, context);
    let mut pool = Pool::new(context, &effective, locked);
    let mut registers = Registers { freed: effective.freed.clone(), ..Registers::default() };
    registers.reached = context.reached.sure.clone();
    registers.reached.join(&context.reached.everything(context.source, context.target));
    for var in kept {
        pool.used.insert(var.number);
        registers.of.insert(var, Register { name: pool.name.clone(), number: var.number });
    }
    let runs: Vec<(Bank, u32)> =
        banks.keys().filter_map(|bank| run_of(*bank, &mut pool, &users, &mut registers, context)).collect();
    for (&var, &(index, span)) in &users {
        if registers.of.contains_key(&var) {
            continue;
        }
        let name = name_of(var, module, context.source);
        match pool.take(var.class, name.as_deref()) {
            Some(number) => {
                if var.class == Class::Temp {
                    registers.scratch.insert(number);
                } else if let Some(name) = name {
                    registers.chosen.insert(name, number);
                }
                registers.of.insert(var, Register { name: pool.name.clone(), number });
            }
            None => {
                let what = format!(
                    "the target has no register left for {}; {} variables of the library want one",
                    name.unwrap_or_else(|| "a temporary".into()),
                    users.len()
                );
                context.add(index, Diagnostic::new(Code::OutOfRegisters, span, what));
            }
        }
    }
    crate::legalize::variables::locked::check(module, &effective.variables, &registers, context);
    let moved = registers.of.iter().filter(|(var, register)| !is_own(var, register));
    let named = moved.filter_map(|(var, _)| Some((*var, name_of(*var, module, context.source)?)));
    registers.names = named.collect();
    point(module, &runs);
    registers
}

/// The class that a bank counts in.
fn class_of(bank: Bank) -> Class {
    if bank == Bank::Parametric { Class::Parametric } else { Class::Global }
}

/// What the run of registers of a bank is called in the lock.
pub(in crate::legalize) fn run_name(bank: Bank) -> String {
    match bank {
        Bank::Parametric => "R(..)".into(),
        Bank::Global | Bank::Numbered => "V(..)".into(),
    }
}

/// The variables of a bank of its own: their numbers and names.
pub(in crate::legalize) fn members(bank: Bank, module: &Module, context: &Context<'_>) -> Vec<(u32, String)> {
    let numbers = reached(bank, context.source).into_iter();
    let named =
        |number| Some((number, name_of(Var { class: class_of(bank), number }, module, context.source)?));
    numbers.filter_map(named).collect()
}

/// The numbers that a computed one can be, in a bank of its own.
fn reached(bank: Bank, source: &Control) -> Vec<u32> {
    let Some(wanted) = bank.class() else { return Vec::new() };
    source
        .classes()
        .iter()
        .filter(|row| row.class == wanted && !row.nullable)
        .flat_map(|row| row.first..=row.last)
        .collect()
}

/// The name of a variable on the source.
pub(in crate::legalize) fn name_of(var: Var, module: &Module, source: &Control) -> Option<String> {
    if let Some(name) = module.names.get(&var) {
        return Some(name.clone());
    }
    let class = match var.class {
        Class::Local => "local",
        Class::Common => "common",
        Class::Retained => "retained",
        Class::Global => "global",
        Class::Parametric => "parametric",
        Class::Register => return Some(format!("register {}", var.number)),
        Class::Temp => return None,
    };
    let rows = source.classes();
    let row = rows.iter().find(|row| row.class == class && (row.first..=row.last).contains(&var.number));
    let row = row.or_else(|| {
        rows.iter().find(|row| row.class != "letter" && (row.first..=row.last).contains(&var.number))
    });
    Some(format!("{}{}", row.map_or("#", |row| row.name.as_str()), var.number))
}

/// True for a variable whose number the target has too.
fn keeps_number(var: Var, context: &Context<'_>) -> bool {
    let name = pool_name(context.target);
    let there = context.target.variable_class(&name, var.number);
    let same_kind = there.is_some_and(|row| (row.class == "local") == (var.class == Class::Local));
    var.class.nullable() && same_kind && !context.target.is_reserved(&name, var.number)
}

/// The name that the target's registers have before their number.
fn pool_name(target: &Control) -> String {
    let shared = target.classes().iter().find(|row| row.class != "local" && row.class != "letter");
    shared.map_or_else(|| "#".into(), |row| row.name.clone())
}

/// Which spaces of computed numbers the library uses, and where first.
fn banks(module: &Module) -> BTreeMap<Bank, (usize, Span)> {
    let mut banks = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            let mut note = |e: &Expr, span: Span| {
                e.walk(&mut |e| {
                    if let Expr::Indirect(bank @ (Bank::Global | Bank::Parametric), _) = e {
                        banks.entry(*bank).or_insert((index, span));
                    }
                });
            };
            for stmt in &block.stmts {
                stmt.kind.exprs(&mut |e| note(e, stmt.site.span));
                if let Some(place @ Place::Indirect(..)) = stmt.kind.target() {
                    note(&place.read(), stmt.site.span);
                }
            }
            block.term.kind.exprs(&mut |e| note(e, block.term.site.span));
        }
    }
    banks
}

/// A run of registers for variables that are reached by computed numbers: what is added to the number.
fn run_of(
    bank: Bank,
    pool: &mut Pool<'_>,
    users: &BTreeMap<Var, (usize, Span)>,
    registers: &mut Registers,
    context: &mut Context<'_>,
) -> Option<(Bank, u32)> {
    if bank == Bank::Numbered {
        return None;
    }
    let (class, name) = (class_of(bank), run_name(bank));
    let numbers: Vec<u32> =
        users.keys().filter(|var| var.class == class).map(|var| var.number).filter(|n| *n <= 100).collect();
    let (first, last) = (*numbers.first()?, *numbers.last()?);
    match pool.run(first, last, &name) {
        Some(base) => {
            registers.chosen.insert(name, base);
            for number in numbers {
                let register = Register { name: pool.name.clone(), number: base + number };
                registers.of.insert(Var { class, number }, register);
            }
            Some((bank, base))
        }
        None => {
            let (index, span) = users.values().next().copied()?;
            let what = format!(
                "the target has no {} registers in a row for variables with computed numbers",
                last - first + 1
            );
            context.add(index, Diagnostic::new(Code::OutOfRegisters, span, what));
            None
        }
    }
}

/// Turns computed numbers into those of the target.
fn point(module: &mut Module, runs: &[(Bank, u32)]) {
    if runs.is_empty() {
        return;
    }
    let base_of = |bank: Bank| runs.iter().find(|(b, _)| *b == bank).map(|(_, base)| f64::from(*base));
    let shifted = |index: Expr, base: f64| match index {
        Expr::Number(n) => Expr::Number(n + base),
        index => Expr::binary(BinOp::Add, Expr::Number(base), index),
    };
    for program in &mut module.programs {
        rewrite_program(
            program,
            |e| matches!(e, Expr::Indirect(..)),
            &mut |e, _: Position, _: &mut Rewriter<'_>| match e {
                Expr::Indirect(bank, index) => match base_of(bank) {
                    // Adding 0 makes a number of what nobody has set, as it is on the source.
                    Some(base) => Expr::binary(
                        BinOp::Add,
                        Expr::Indirect(Bank::Numbered, Box::new(shifted(*index, base))),
                        Expr::Number(0.0),
                    ),
                    None => Expr::Indirect(bank, index),
                },
                other => other,
            },
        );
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            if let StmtKind::Assign { target: Place::Indirect(bank, index), .. } = &mut stmt.kind
                && let Some(base) = base_of(*bank)
            {
                let old = std::mem::replace(index.as_mut(), Expr::Vacant);
                (*bank, **index) = (Bank::Numbered, shifted(old, base));
            }
        }
    }
}

/// The registers of the target and which of them are taken.
struct Pool<'a> {
    name: String,
    /// Rows to take from, those that keep their values first.
    rows: Vec<&'a VariableClass>,
    used: BTreeSet<u32>,
    locked: &'a BTreeMap<String, u32>,
    /// Where temporaries go first, and nothing else ever.
    scratch: BTreeSet<u32>,
    /// Numbers that computed ones reach.
    reached: Numbers,
    /// Numbers that computed ones are supposed to be: taken where nothing else is free.
    supposed: Numbers,
    target: &'a Control,
}

impl<'a> Pool<'a> {
    fn new(context: &Context<'a>, effective: &'a Effective, locked: &Locked<'_>) -> Self {
        let target = context.target;
        let supposed = context.reached.supposed();
        let mut reached = context.reached.sure.clone();
        reached.join(&locked.reached);
        let mut rows: Vec<&VariableClass> =
            target.classes().iter().filter(|row| row.class != "local" && row.class != "letter").collect();
        // What every control of the kind has comes before what must be bought.
        rows.sort_by_key(|row| (row.option.is_some(), row.first));
        let name = pool_name(target);
        let used = effective.variables.values().chain(locked.own).copied().collect();
        let scratch = effective.scratch.clone();
        Self { name, rows, used, locked: &effective.variables, scratch, reached, supposed, target }
    }

    fn free(&self, number: u32) -> bool {
        !self.used.contains(&number)
            && !self.scratch.contains(&number)
            && !self.reached.contains(number)
            && !self.target.is_reserved(&self.name, number)
    }

    fn take(&mut self, class: Class, name: Option<&str>) -> Option<u32> {
        if let Some(&number) = name.and_then(|name| self.locked.get(name)) {
            return Some(number);
        }
        let keeps = |row: &&&VariableClass| row.retained != Some(false);
        let volatile = matches!(class, Class::Temp | Class::Register | Class::Common | Class::Local);
        let preferred = self.rows.iter().filter(|row| keeps(row) != volatile);
        let rest = self.rows.iter().filter(|row| keeps(row) == volatile && (volatile || keeps(row)));
        let again = |number: &u32| {
            let taken = self.used.contains(number) || self.target.is_reserved(&self.name, *number);
            class == Class::Temp && !taken && !self.reached.contains(*number)
        };
        let free: Vec<u32> = preferred
            .chain(rest)
            .flat_map(|row| row.first..=row.last)
            .filter(|number| self.free(*number))
            .collect();
        let in_use = |number: u32| self.target.is_in_use(&self.name, number);
        let best = || free.iter().copied().min_by_key(|n| (self.supposed.contains(*n), in_use(*n)));
        let number = self.scratch.iter().copied().find(again).or_else(best)?;
        self.used.insert(number);
        Some(number)
    }

    /// A base so that `base + first ..= base + last` are free registers of one kind that keep their values.
    fn run(&mut self, first: u32, last: u32, name: &str) -> Option<u32> {
        if let Some(&base) = self.locked.get(name) {
            return Some(base);
        }
        let keeps = |row: &&&VariableClass| row.retained != Some(false);
        let mut numbers: Vec<u32> =
            self.rows.iter().filter(keeps).flat_map(|row| row.first..=row.last).collect();
        numbers.sort_unstable();
        let all: BTreeSet<u32> = numbers.iter().copied().collect();
        let fits = |base: &u32| (base + first..=base + last).all(|n| all.contains(&n) && self.free(n));
        // Round bases read best: V12 in #512 or #612.
        let bases = numbers.iter().filter_map(|n| n.checked_sub(first));
        let shunned = |number| self.supposed.contains(number) || self.target.is_in_use(&self.name, number);
        let apart = |base: &u32| !(base + first..=base + last).any(shunned);
        let round = bases.clone().filter(|base| base % 100 == 0).find(|base| fits(base) && apart(base));
        let base = round
            .or_else(|| bases.clone().find(|base| fits(base) && apart(base)))
            .or_else(|| bases.clone().find(&fits))?;
        self.used.extend(base + first..=base + last);
        Some(base)
    }
}
