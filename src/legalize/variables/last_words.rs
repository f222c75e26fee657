//! The last numbers of tool offsets, and codes in force, where the target tells none that a program reads.
//!
//! Laws: where every way to the place named the same number, it is that number. Where the ways named several, it is a
//! register that is set after each block of the programs that belong together which names one. A branch that goes one way
//! whichever of them is read is a jump. Side conditions: no way comes from a caller that is not in the library, by a
//! computed code, by a block with a number that may be vacant, or by the end of the offset, after which no maker's text
//! says what is read; the letter of the word means nothing else beside any code of the source. Counter-example:
//! `#1=#4111` in a macro that nothing in the library calls.

use super::modal_reads::{group_of, may_read, number_of};
use crate::canon::{Group, Role, Sys};
use crate::dialect::Control;
use crate::ir::analysis::named::{Last, value};
use crate::ir::eval::{Memory, holds};
use crate::ir::{
    BlockId, Class, Cond, Expr, Module, Place, SourceInfo, Stmt, StmtKind, Stmts, TermKind, Var, statics_of,
};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal, ModalFacts};
use std::collections::{BTreeMap, BTreeSet};

/// The letters of tool offsets, as [`Sys::Address`] counts them.
const LETTERS: [(f64, char, Role); 2] = [(4.0, 'D', Role::RadiusOffset), (8.0, 'H', Role::LengthOffset)];

/// What is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kept {
    Word(Role),
    Code(Group),
}

impl Kept {
    /// What an expression reads, and what is added to it, where the target does not tell it.
    fn read(e: &Expr, source: &Control, target: &Control) -> Option<(Self, f64)> {
        if let Some((group, more)) = group_of(e, target) {
            return Some((Kept::Code(group), more));
        }
        let Expr::System(Sys::Address, subscripts) = e else { return None };
        let number = subscripts.first()?.constant()?;
        let (_, letter, role) = LETTERS.into_iter().find(|(own, ..)| *own == number)?;
        let told = target.system_address(Sys::Address, &[number as u32]).is_some();
        (!told && means_one(source, letter, role)).then_some((Kept::Word(role), 0.0))
    }

    /// Its number, where every way named the same.
    fn number(self, state: &Modal, source: &Control) -> Option<f64> {
        match self {
            Kept::Word(role) => match state.named.last(role) {
                Last::Number(number) => Some(f64::from(number)),
                _ => None,
            },
            Kept::Code(group) => number_of(state, group, source),
        }
    }

    /// True where every way named a number.
    fn is_named(self, state: &Modal) -> bool {
        match self {
            Kept::Word(role) => state.named.last(role) != Last::Unknown,
            Kept::Code(group) => state.named.has(group),
        }
    }

    /// True for what a register can hold: only codes of the group change what is in force, and the target has no tests of codes,
    /// which need none.
    fn takes_register(self, target: &Control) -> bool {
        use Group::{Distance, FeedMode, Plane, RadiusComp, Units, WorkOffset};
        match self {
            Kept::Word(_) => true,
            Kept::Code(group) => {
                matches!(group, Plane | Distance | FeedMode | Units | RadiusComp | WorkOffset)
                    && target.system_run(Sys::CodeTest).is_none()
            }
        }
    }

    /// The value that a statement names, before whose end `state` stands; an error where it names one without a number.
    fn named(self, stmt: &Stmt, state: &Modal, source: &Control) -> Result<Option<Expr>, ()> {
        let Some(nc) = stmt.kind.nc() else { return Ok(None) };
        match self {
            Kept::Word(role) => Ok(value(nc, role).cloned()),
            Kept::Code(group) if nc.ops().any(|op| op.group() == group) => {
                // A block that may be skipped leaves it open afterwards, and puts it in force where it runs.
                let mut after = state.clone();
                after.step_words(nc);
                number_of(&after, group, source).map(|number| Some(Expr::Number(number))).ok_or(())
            }
            Kept::Code(_) => Ok(None),
        }
    }
}

/// True if the letter has this role, and no other beside any code.
fn means_one(source: &Control, letter: char, role: Role) -> bool {
    let other = |name: &str, own: Role| name.starts_with(letter) && own != role;
    source.word(letter, false).is_some_and(|word| word.role == role)
        && !source.dialect().codes.iter().any(|row| row.words.iter().any(|(name, own)| other(name, *own)))
}

/// True if the library reads state.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.has(Feature::System)
}

/// What may stand where several numbers were named.
struct Several {
    /// The programs that a register for it must be set in.
    together: BTreeSet<usize>,
    /// The numbers that they name, where all are constants.
    numbers: Option<Vec<f64>>,
}

/// Replaces what is read; true if there is any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let readers = readers(module, context);
    if readers.is_empty() {
        return false;
    }
    let facts = context.modal_facts(module);
    let mut several = BTreeMap::new();
    for (kept, programs) in open(module, &readers, &facts, context) {
        let together = belong_together(module, programs, context);
        if let Some(numbers) = all_named(kept, module, &together, &facts, context.source) {
            several.insert(kept, Several { together, numbers });
        }
    }
    let mut changed = false;
    for &index in &readers {
        changed |= decide(module, index, &several, &facts, context);
    }
    let left = open(module, &readers, &facts, context);
    several.retain(|kept, _| left.contains_key(kept));
    let registers: Vec<(Kept, Var, BTreeSet<usize>)> = (statics_of::LAST_WORDS..)
        .zip(several)
        .map(|(number, (kept, several))| (kept, Var { class: Class::Static, number }, several.together))
        .collect();
    for index in 0..module.programs.len() {
        let own = registers.iter().filter(|(.., together)| together.contains(&index));
        let own: Vec<(Kept, Var)> = own.map(|(kept, var, _)| (*kept, *var)).collect();
        if readers.contains(&index) || !own.is_empty() {
            changed |= replace(module, index, &own, &facts, context);
        }
    }
    changed
}

/// Turns branches into jumps that go one way whatever of the numbers is in force; true if there are any.
fn decide(
    module: &mut Module,
    index: usize,
    several: &BTreeMap<Kept, Several>,
    facts: &ModalFacts,
    context: &Context<'_>,
) -> bool {
    let mut changed = false;
    for (at, block) in module.programs[index].blocks.iter_mut().enumerate() {
        let TermKind::Branch { cond, then, otherwise } = &block.term.kind else { continue };
        let mut reads = BTreeSet::new();
        let mut look = |e: &Expr| {
            e.walk(&mut |e| {
                reads.extend(Kept::read(e, context.source, context.target).map(|(kept, _)| kept))
            });
        };
        cond.exprs(&mut look);
        let &[kept] = reads.into_iter().collect::<Vec<_>>().as_slice() else { continue };
        let mut state = facts.at(index, BlockId(at as u32));
        block.stmts.iter().for_each(|stmt| state.step(stmt));
        let numbers = match kept.number(&state, context.source) {
            Some(number) => vec![number],
            None if kept.is_named(&state) => match several.get(&kept) {
                Some(Several { numbers: Some(numbers), .. }) => numbers.clone(),
                _ => continue,
            },
            None => continue,
        };
        let mut ways = numbers.into_iter().map(|number| holds_with(cond, number, context));
        let Some(Some(way)) = ways.next() else { continue };
        if ways.all(|other| other == Some(way)) {
            block.term.kind = TermKind::Jump(if way { *then } else { *otherwise });
            changed = true;
        }
    }
    changed
}

/// Whether a condition holds if what it reads is this number; none if it reads more, or raises an alarm.
fn holds_with(cond: &Cond, number: f64, context: &Context<'_>) -> Option<bool> {
    let mut cond = cond.clone();
    let mut constant = !cond.has_switch();
    cond.exprs_mut(&mut |e| {
        e.walk_mut(&mut |e| {
            if let Some((_, more)) = Kept::read(e, context.source, context.target) {
                *e = Expr::Number(number + more);
            }
            constant &=
                !matches!(e, Expr::Var(_) | Expr::System(..) | Expr::Indirect(..) | Expr::Increments(_));
        });
    });
    if constant { holds(&cond, &Memory::new()).ok() } else { None }
}

/// The programs that read any.
fn readers(module: &Module, context: &Context<'_>) -> BTreeSet<usize> {
    let reads = |index: usize| {
        let mut found = false;
        let mut look = |e: &Expr| {
            e.walk(&mut |e| found |= Kept::read(e, context.source, context.target).is_some());
        };
        for block in &module.programs[index].blocks {
            block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
            block.term.kind.exprs(&mut look);
        }
        found
    };
    (0..module.programs.len()).filter(|index| may_read(*index, context) && reads(*index)).collect()
}

/// What is read where several numbers may stand, and by which programs.
fn open(
    module: &Module,
    readers: &BTreeSet<usize>,
    facts: &ModalFacts,
    context: &Context<'_>,
) -> BTreeMap<Kept, BTreeSet<usize>> {
    let mut found: BTreeMap<Kept, BTreeSet<usize>> = BTreeMap::new();
    for &index in readers {
        let program = &module.programs[index];
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            let mut look = |e: &Expr, state: &Modal| {
                e.walk(&mut |e| {
                    if let Some((kept, _)) = Kept::read(e, context.source, context.target)
                        && kept.takes_register(context.target)
                        && kept.is_named(state)
                        && kept.number(state, context.source).is_none()
                    {
                        found.entry(kept).or_default().insert(index);
                    }
                });
            };
            for stmt in &block.stmts {
                stmt.kind.exprs(&mut |e| look(e, &state));
                state.step(stmt);
            }
            block.term.kind.exprs(&mut |e| look(e, &state));
        }
    }
    found
}

/// The programs, and all that call them or that they call, directly or not.
fn belong_together(module: &Module, mut programs: BTreeSet<usize>, context: &Context<'_>) -> BTreeSet<usize> {
    let pairs = context.called(module).pairs(module);
    loop {
        let before = programs.len();
        for (caller, callee) in &pairs {
            if programs.contains(caller) || programs.contains(callee) {
                programs.extend([*caller, *callee]);
            }
        }
        if programs.len() == before {
            return programs;
        }
    }
}

/// The numbers that the programs name; none where a block names one that is not known, no numbers where one is computed.
fn all_named(
    kept: Kept,
    module: &Module,
    programs: &BTreeSet<usize>,
    facts: &ModalFacts,
    source: &Control,
) -> Option<Option<Vec<f64>>> {
    let mut numbers = Some(Vec::new());
    for &index in programs {
        let program = &module.programs[index];
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                if let Some(value) = kept.named(stmt, &state, source).ok()? {
                    numbers = numbers.zip(value.constant()).map(|(mut all, number)| {
                        all.push(number);
                        all
                    });
                }
                state.step(stmt);
            }
        }
    }
    Some(numbers)
}

/// Replaces what a program reads, and sets the registers after what it names.
fn replace(
    module: &mut Module,
    index: usize,
    registers: &[(Kept, Var)],
    facts: &ModalFacts,
    context: &Context<'_>,
) -> bool {
    let (source, target) = (context.source, context.target);
    let mut changed = false;
    let mut put = |e: &mut Expr, state: &Modal| {
        e.walk_mut(&mut |e| {
            let Some((kept, more)) = Kept::read(e, source, target) else { return };
            let register = registers.iter().find(|(own, _)| *own == kept && kept.is_named(state));
            let value = match kept.number(state, source) {
                Some(number) => Expr::Number(number + more),
                None => match register {
                    Some((_, var)) if more == 0.0 => Expr::Var(*var),
                    _ => return,
                },
            };
            *e = value;
            changed = true;
        });
    };
    let mut set = false;
    for (at, block) in module.programs[index].blocks.iter_mut().enumerate() {
        let mut state = facts.at(index, BlockId(at as u32));
        let mut out = Stmts::new();
        for mut stmt in block.stmts.drain(..) {
            let mut sets = Vec::new();
            for (kept, var) in registers {
                if let Ok(Some(value)) = kept.named(&stmt, &state, source) {
                    let kind = StmtKind::Assign { target: Place::Var(*var), value };
                    let site =
                        SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
                    sets.push(Stmt { kind, site });
                }
            }
            stmt.kind.exprs_mut(&mut |e| put(e, &state));
            state.step(&stmt);
            set |= !sets.is_empty();
            out.push(stmt);
            out.extend(sets);
        }
        block.stmts = out;
        block.term.kind.exprs_mut(&mut |e| put(e, &state));
    }
    changed | set
}
