//! What changes while a modal call is open: locals that one run of its macro leaves for the next one, and variables that
//! its arguments read.

use super::computed_numbers::constant_part;
use super::rewrite::{Part, highest_temp, rebuild};
use crate::dialect::Control;
use crate::ir::analysis::Cfg;
use crate::ir::{
    Bank, Block, Call, Callee, Class, Expr, Module, Place, Program, Site, StmtKind, TermKind, Var,
};
use crate::syntax::ProgramName;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;

/// Numbers of locals.
type Locals = BTreeSet<u32>;

/// The numbers that locals may have.
pub type Numbers = RangeInclusive<u32>;

/// A local that a macro may read before it writes it, and writes; none where each run begins alike. A macro that is
/// not in the library has none: a diagnostic of its own speaks of it.
pub fn local(module: &Module, name: &ProgramName, numbers: &Numbers) -> Option<u32> {
    let program = find(module, name)?;
    let mut written = Locals::new();
    // What shares the level: subprograms, whatever they call at the same level, and where they return to.
    let mut shared = BTreeSet::from([name]);
    let mut work = vec![program];
    while let Some(one) = work.pop() {
        written.extend(one.blocks.iter().flat_map(|block| may_write(block, numbers)));
        for block in &one.blocks {
            if let TermKind::Call { call, .. } = &block.term.kind
                && let Callee::Program(name) = &call.callee
                && !call.level
                && shared.insert(name)
            {
                work.extend(find(module, name));
            }
        }
    }
    let of_others = shared.iter().filter(|other| **other != name).filter_map(|other| find(module, other));
    let mut read: Locals =
        of_others.flat_map(|other| other.blocks.iter().flat_map(|block| reads(block, numbers))).collect();
    read.extend(early(program, numbers));
    read.intersection(&written).next().copied()
}

/// An argument of an open modal call that a write to this place may change, of those that count.
pub fn argument(call: &Call, place: &Place, numbers: &Numbers, counts: impl Fn(Var) -> bool) -> Option<Var> {
    call.arguments.iter().find_map(|argument| {
        let mut found = None;
        argument.value.variables(&mut |var| {
            let hit = match place {
                Place::Var(target) => *target == var,
                Place::Indirect(bank, number) => {
                    *bank == Bank::Numbered
                        && var.class != Class::Temp
                        && (var.class != Class::Local || is_low(number, numbers))
                }
                _ => false,
            };
            found = found.or((hit && counts(var)).then_some(var));
        });
        found
    })
}

/// An argument of a modal call that the macro, or what that calls, may change; its locals are its own.
pub fn changed_by_callee(module: &Module, call: &Call, numbers: &Numbers) -> Option<Var> {
    let Callee::Program(name) = &call.callee else { return None };
    let mut seen = BTreeSet::from([name]);
    let mut work: Vec<&Program> = find(module, name).into_iter().collect();
    while let Some(program) = work.pop() {
        for block in &program.blocks {
            let mut places = block.stmts.iter().filter_map(|stmt| stmt.kind.target());
            let shared = |var: Var| !call.level || var.class.shared();
            if let Some(var) = places.find_map(|place| argument(call, place, numbers, shared)) {
                return Some(var);
            }
            for inner in super::calls_of(block) {
                if let Callee::Program(name) = &inner.callee
                    && seen.insert(name)
                {
                    work.extend(find(module, name));
                }
            }
        }
    }
    None
}

/// True where the arguments of a call mean another thing in a program that it runs under.
pub fn reads_locals(call: &Call) -> bool {
    let mut found = false;
    for argument in &call.arguments {
        argument.value.walk(&mut |e| {
            found |=
                matches!(e, Expr::Indirect(..) | Expr::Var(Var { class: Class::Local | Class::Temp, .. }));
        });
    }
    found
}

/// True for a value that a temporary can keep: those are never vacant.
fn is_held(value: &Expr) -> bool {
    value.constant().is_none() && !value.may_be_vacant()
}

/// Computes the arguments of modal calls where those are opened.
pub fn hold_arguments(program: &mut Program) {
    let computed = |call: &Call| call.arguments.iter().any(|argument| is_held(&argument.value));
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    if !stmts.any(|stmt| matches!(&stmt.kind, StmtKind::ModalCall(call) if computed(call))) {
        return;
    }
    let mut temp = highest_temp(program);
    rebuild(program, &mut |builder, mut part| {
        if let Part::Stmt(stmt) = &mut part
            && let StmtKind::ModalCall(call) = &mut stmt.kind
        {
            for argument in call.arguments.iter_mut().filter(|a| is_held(&a.value)) {
                temp += 1;
                let var = Var { class: Class::Temp, number: temp };
                let value = std::mem::replace(&mut argument.value, Expr::Var(var));
                let site = Site { skip: stmt.site.skip, ..Site::default() };
                builder.push(StmtKind::Assign { target: Place::Var(var), value }, site);
            }
        }
        part.keep(builder);
    });
}

/// True where a local of a program may be set in it, or in what runs at its level.
pub fn sets(program: &Program, local: Var) -> bool {
    let calls = |block: &Block| matches!(&block.term.kind, TermKind::Call { call, .. } if !call.level);
    program.blocks.iter().any(|block| calls(block) || writes(block).contains(&local.number))
}

fn find<'m>(module: &'m Module, name: &ProgramName) -> Option<&'m Program> {
    module.programs.iter().find(|program| program.name.as_ref() == Some(name))
}

/// What a program may read before it wrote it.
fn early(program: &Program, numbers: &Numbers) -> Locals {
    let cfg = Cfg::of(program);
    let all: Locals = program.blocks.iter().flat_map(writes).collect();
    // What is written on every way to a block; at first, all.
    let mut sure = vec![all; program.blocks.len()];
    if let Some(entry) = sure.first_mut() {
        entry.clear();
    }
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut behind = sure[id.index()].clone();
            behind.extend(writes(block));
            for to in cfg.succs(id) {
                if let Some(there) = sure.get_mut(to.index()) {
                    let before = there.len();
                    there.retain(|local| behind.contains(local));
                    changed |= there.len() != before;
                }
            }
        }
    }
    let mut found = Locals::new();
    for (block, mut sure) in program.blocks.iter().zip(sure) {
        let mut look = |e: &Expr, sure: &Locals| {
            found.extend(locals(e, numbers).into_iter().filter(|l| !sure.contains(l)))
        };
        for stmt in &block.stmts {
            stmt.kind.exprs(&mut |e| look(e, &sure));
            sure.extend(stmt.kind.target().and_then(written));
        }
        block.term.kind.exprs(&mut |e| look(e, &sure));
    }
    found
}

fn written(place: &Place) -> Option<u32> {
    match place {
        Place::Var(Var { class: Class::Local, number }) => Some(*number),
        _ => None,
    }
}

/// The numbers that locals have on a control.
pub fn numbers(control: &Control) -> Numbers {
    let rows = control.classes().iter().filter(|row| row.class == "local" && row.name == "#");
    let (first, last) =
        rows.fold((u32::MAX, 0), |(first, last), row| (first.min(row.first), last.max(row.last)));
    first..=last
}

/// True where a computed number may be that of a local: by its constant part.
fn is_low(number: &Expr, numbers: &Numbers) -> bool {
    constant_part(number).is_none_or(|part| part <= f64::from(*numbers.end()))
}

/// What a block may write: a computed number may be that of any.
fn may_write(block: &Block, numbers: &Numbers) -> Locals {
    let mut out = writes(block);
    for place in block.stmts.iter().filter_map(|stmt| stmt.kind.target()) {
        if let Place::Indirect(Bank::Numbered, number) = place
            && is_low(number, numbers)
        {
            out.extend(numbers.clone());
        }
    }
    out
}

fn writes(block: &Block) -> Locals {
    block.stmts.iter().filter_map(|stmt| stmt.kind.target().and_then(written)).collect()
}

fn reads(block: &Block, numbers: &Numbers) -> Locals {
    let mut out = Locals::new();
    let mut look = |e: &Expr| out.extend(locals(e, numbers));
    block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
    block.term.kind.exprs(&mut look);
    out
}

fn locals(e: &Expr, numbers: &Numbers) -> Locals {
    let mut out = Locals::new();
    e.variables(&mut |var| {
        if var.class == Class::Local {
            out.insert(var.number);
        }
    });
    e.walk(&mut |e| {
        if let Expr::Indirect(Bank::Numbered, number) = e
            && is_low(number, numbers)
        {
            out.extend(numbers.clone());
        }
    });
    out
}
