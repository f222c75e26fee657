//! Variables that the library reads and never sets, where they get another number.
//!
//! Law: what nothing in the library sets is set by an operator or by another program, by its number on the source. Side
//! condition: it keeps that number. Where the target has something else there, whoever sets it must set its register, and is told
//! so, once for the library. Counter-example: probing that leaves its calibration in `#556`, which the target's profile
//! reserves.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::{VarSet, Vars};
use crate::ir::{Expr, Module, Place, Program, StmtKind, Var};
use crate::legalize::Context;
use crate::legalize::by_program::look_at_each;
use crate::legalize::registers::map::Register;
use crate::legalize::registers::names::{in_a_sentence, name_of};

/// Reports variables that nothing here sets and that have another number on the target: of all of them in one sentence.
pub fn run(module: &Module, context: &mut Context<'_>) {
    // A program of plain moves has none.
    if context.registers.of.is_empty() {
        return;
    }
    let written = written(module);
    let reads: Vec<VarSet> = look_at_each(module, |_, program| read(program));
    let moved = |var: &Var| {
        let register = context.registers.of.get(var)?;
        if context.interface.holds(*var) {
            return None;
        }
        let set_here =
            !var.class.is_numbered() || written.contains(*var) || context.registers.is_known(var, register);
        (!set_here).then(|| name_of(*var, module, context.source)).flatten().map(|name| (name, register))
    };
    let mut all = VarSet::default();
    reads.iter().for_each(|read| _ = all.join(read, |_| true));
    let moves: Vec<Moved> = all
        .iter()
        .filter_map(|var| moved(&var).map(|(name, register)| named(var, &name, register)))
        .collect();
    if moves.is_empty() {
        return;
    }
    let what = told(&moves);
    let help = "whoever sets it, an operator or another program, must set the one of the target; 'reserved' in the target's \
                profile keeps numbers free";
    for (index, read) in reads.iter().enumerate() {
        if moves.iter().any(|(var, ..)| read.contains(*var)) {
            let span = module.programs[index].site.span;
            let finding = Diagnostic::new(Code::Conditional, span, what.clone()).with_help(help);
            context.add(index, finding.asked_once());
        }
    }
}

/// A variable, its name on the source, and its register.
pub(super) type Moved = (Var, Named, Named);

/// A variable of this name on the source that has this register.
pub(super) fn named(var: Var, name: &str, register: &Register) -> Moved {
    (var, apart(name), (register.name.clone(), Some(register.number)))
}

/// A name, and the number at its end if it has one.
type Named = (String, Option<u32>);

fn apart(name: &str) -> Named {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    match name[letters.len()..].parse() {
        Ok(number) => (letters.to_owned(), Some(number)),
        Err(_) => (name.to_owned(), None),
    }
}

fn as_written((name, number): &Named) -> String {
    format!("{name}{}", number.map(|n| n.to_string()).unwrap_or_default())
}

/// What they are on the target, those in a row that stay in a row as one.
pub(super) fn in_words(moves: &[Moved]) -> String {
    let next = |a: &Named, b: &Named| a.0 == b.0 && a.1.is_some() && a.1.map(|n| n + 1) == b.1;
    let rows = moves.chunk_by(|a, b| next(&a.1, &b.1) && next(&a.2, &b.2));
    let said = rows.filter_map(|row| {
        let (first, last) = (row.first()?, row.last()?);
        Some(match row.len() {
            1 => format!("{} is {}", as_written(&first.1), as_written(&first.2)),
            _ => format!(
                "{} to {} are {} to {}",
                as_written(&first.1),
                as_written(&last.1),
                as_written(&first.2),
                as_written(&last.2)
            ),
        })
    });
    format!("on the target {}", in_a_sentence(&said.collect::<Vec<_>>()))
}

/// The sentence about variables.
fn told(moves: &[Moved]) -> String {
    match moves {
        [one] => format!(
            "{} is read and nothing here sets it: it is {} on the target; set that one",
            as_written(&one.1),
            as_written(&one.2)
        ),
        _ => format!("variables are read that nothing here sets: {}; set those", in_words(moves)),
    }
}

/// What a program reads by name.
pub(super) fn read(program: &Program) -> VarSet {
    let mut read = VarSet::default();
    let mut add = |e: &Expr| e.variables(&mut |var| _ = read.insert(var));
    for block in &program.blocks {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut add));
        block.term.kind.exprs(&mut add);
    }
    read
}

/// What the library sets by name, or clears.
fn written(module: &Module) -> Vars {
    let by_program = look_at_each(module, |_, program| written_by(program));
    by_program.iter().fold(Vars::default(), |mut all, written| {
        all.join(written);
        all
    })
}

/// What a program sets by name, or clears.
pub(super) fn written_by(program: &Program) -> Vars {
    let mut written = Vars::default();
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        match (&stmt.kind, stmt.kind.target()) {
            (StmtKind::ClearAll(class), _) => written.classes.insert(*class),
            (_, Some(Place::Var(var))) => _ = written.vars.insert(*var),
            _ => {}
        }
    }
    written
}
