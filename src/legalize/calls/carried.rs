//! What changes while a modal call is open: locals that one run of its macro leaves for the next one, and variables that
//! its arguments read.

use super::defaults;
use crate::dialect::Control;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::calls_of;
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::dataflow::{Analysis, Direction, Every, reached, solve};
use crate::ir::constant_part;
use crate::ir::{
    Bank, Block, BlockId, Call, Callee, Class, Expr, Module, Place, Program, SourceInfo, StmtKind, TermKind,
    Var,
};
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

/// Numbers of locals.
type Locals = BTreeSet<u32>;

/// The numbers that locals may have.
pub type Numbers = RangeInclusive<u32>;

/// A local that a macro writes, and may read before that: one run leaves it to the next. None if each run begins alike.
pub fn local(module: &Module, called: &CalledPrograms, at: usize, numbers: &Numbers) -> Option<u32> {
    let (mut written, mut elsewhere) = (Locals::new(), Locals::new());
    // What shares the level: subprograms, whatever they call at the same level, and where they return to.
    let shared = reached([at], |index, go| {
        let program = &module.programs[index];
        written.extend(program.blocks.iter().flat_map(|block| may_write(block, numbers)));
        let others = program.blocks.iter().flat_map(|block| match index == at {
            true => computed_writes(block, numbers),
            false => may_write(block, numbers),
        });
        elsewhere.extend(others);
        for (id, block) in program.ids().zip(&program.blocks) {
            if let TermKind::Call { call, .. } = &block.term.kind
                && !call.level
            {
                called.by((index, id), call).iter().for_each(|callee| go(*callee));
            }
        }
    });
    let of_others = shared.iter().filter(|other| **other != at).map(|other| &module.programs[*other]);
    let mut read: Locals =
        of_others.flat_map(|other| other.blocks.iter().flat_map(|block| reads(block, numbers))).collect();
    let program = &module.programs[at];
    let tests = defaults::tests(module, program, &written, &elsewhere);
    read.extend(early(program, numbers, tests));
    read.intersection(&written).next().copied()
}

/// A variable of the arguments of an open modal call, or of the number it calls, that a write to this place may change, of
/// those that count.
pub fn argument(call: &Call, place: &Place, numbers: &Numbers, counts: impl Fn(Var) -> bool) -> Option<Var> {
    let number = match &call.callee {
        Callee::Computed(number) => Some(number),
        _ => None,
    };
    call.arguments.iter().map(|argument| &argument.value).chain(number).find_map(|value| {
        let mut found = None;
        value.variables(&mut |var| {
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

/// An argument of a modal call that the macros it may be meant for, or what those call, may change; their locals are
/// their own.
pub fn changed_by_callee(
    module: &Module,
    called: &CalledPrograms,
    macros: &[usize],
    call: &Call,
    numbers: &Numbers,
) -> Option<Var> {
    let shared = |var: Var| !call.level || var.class.shared();
    let mut found = None;
    reached(macros.iter().copied(), |index, go| {
        let program = &module.programs[index];
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut places = block.stmts.iter().filter_map(|stmt| stmt.kind.target());
            found = found.or_else(|| places.find_map(|place| argument(call, place, numbers, shared)));
            if found.is_some() {
                return;
            }
            calls_of(block).flat_map(|inner| called.by((index, id), inner)).for_each(|callee| go(*callee));
        }
    });
    found
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

/// What a modal call computes: its arguments and its number.
fn computed(call: &mut Call) -> impl Iterator<Item = &mut Expr> {
    let number = match &mut call.callee {
        Callee::Computed(number) => Some(number),
        _ => None,
    };
    call.arguments.iter_mut().map(|argument| &mut argument.value).chain(number).filter(|value| is_held(value))
}

/// Computes the arguments and the numbers of modal calls where those are opened.
pub fn hold_arguments(program: &mut Program) {
    let computes = |call: &Call| computed(&mut call.clone()).next().is_some();
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    if !stmts.any(|stmt| matches!(&stmt.kind, StmtKind::ModalCall(call) if computes(call))) {
        return;
    }
    let mut temp = highest_temp(program);
    rebuild(program, &mut |builder, mut part| {
        if let Part::Stmt(stmt) = &mut part
            && let StmtKind::ModalCall(call) = &mut stmt.kind
        {
            for value in computed(call) {
                temp += 1;
                let var = Var { class: Class::Temp, number: temp };
                let value = std::mem::replace(value, Expr::Var(var));
                let site = SourceInfo { skip: stmt.site.skip, ..SourceInfo::default() };
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

/// What a program may read before it wrote it, or before it tested it to give it a default.
fn early(program: &Program, numbers: &Numbers, tests: BTreeMap<BlockId, u32>) -> Locals {
    let all: Locals = program.blocks.iter().flat_map(writes).collect();
    let written_before = Written { tests };
    let before = solve(&written_before, program, &Cfg::of(program));
    let mut found = Locals::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        // Where no way leads, all is.
        let mut sure = before.at(id).map_or_else(|| all.clone(), |before| before.0.clone());
        let mut look = |e: &Expr, sure: &Locals| {
            found.extend(locals(e, numbers).into_iter().filter(|l| !sure.contains(l)))
        };
        for stmt in &block.stmts {
            stmt.kind.exprs(&mut |e| look(e, &sure));
            sure.extend(stmt.kind.target().and_then(written));
        }
        sure.extend(written_before.tests.get(&id));
        block.term.kind.exprs(&mut |e| look(e, &sure));
    }
    found
}

/// The locals that every way to a place writes, or gives a default.
struct Written {
    /// By the block whose end tests it.
    tests: BTreeMap<BlockId, u32>,
}

impl Analysis for Written {
    type State = Every<u32>;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, Every<u32>)> {
        vec![(BlockId(0), Every(Locals::new()))]
    }

    fn block(&self, id: BlockId, block: &Block, written: &mut Every<u32>) {
        written.0.extend(writes(block));
        written.0.extend(self.tests.get(&id));
    }
}

fn written(place: &Place) -> Option<u32> {
    match place {
        Place::Var(Var { class: Class::Local, number }) => Some(*number),
        _ => None,
    }
}

/// The numbers that locals have on a control.
pub fn numbers(control: &Control) -> Numbers {
    let rows = control.classes().iter().filter(|row| row.class == "local");
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
    out.extend(computed_writes(block, numbers));
    out
}

/// What a block may write by a computed number.
fn computed_writes(block: &Block, numbers: &Numbers) -> Locals {
    let mut out = Locals::new();
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
