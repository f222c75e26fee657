//! Local shifts that are counted into the coordinates, on a target that has none.
//!
//! Law: under a local shift an absolute place of the program is so much further along in the work offset, so the shift is added to each
//! absolute word, to the planes of drilling cycles and to the centre of a rotation, and its blocks go. Increments, centres of arcs from their
//! start and machine coordinates do not know of it. Where runs come to a word under several shifts, as in a part that is called
//! under each of them, a register holds what was set last. Side conditions: a shift is a number; its block does nothing else, and no
//! cycle, compensation or turned frame is in force there; what is called under it is in the library, and is counted with its
//! callers; nothing under it sets a frame or a table, or reads a position; it ends with the run. Counter-example: `G52 X10.`, `#1=#5041`.

mod follow;
mod look;
mod obstacles;

use super::left_shifts::AXES;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::over_calls::{OverCalls, called};
use crate::ir::analysis::{Around, Filled, Vacancy, entries};
use crate::ir::{
    Block, BlockId, Callee, Class, Expr, Module, Nc, Place, Program, SourceInfo, Stmt, StmtKind, Var,
    statics_of,
};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, calls_of};
use follow::Shifts;
use look::{Look, Made};
use obstacles::*;
use std::collections::{BTreeMap, BTreeSet};

/// The registers of the shift along X, Y and Z, where a word counts with one of several.
const REGISTERS: [Var; 3] = {
    const fn register(number: u32) -> Var {
        Var { class: Class::Static, number: statics_of::SHIFT + number }
    }
    [register(0), register(1), register(2)]
};

const CLEARS: Question = Question::EndClearsLocal;

const FOLDED: &str =
    "the target has no local shift: this one is counted into the coordinates up to where it ends";

/// True if the library shifts so, and the target cannot.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    super::no_shifts::concerns(features, context)
}

/// Counts shifts into coordinates, and says why where it cannot; true if one went.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let pairs = context.called(module).pairs(module);
    let all = look(module, context, &pairs);
    let mut obstacles: Vec<Option<Obstacle>> = all.iter().map(|made| made.obstacle).collect();
    // What is called under a shift is counted with its callers, or not at all.
    let under: Vec<(usize, usize)> = (0..)
        .zip(&all)
        .flat_map(|(index, made)| made.under.iter().map(move |callee| (index, *callee)))
        .collect();
    spread(&mut obstacles, &under, &|mine, other| mine.or(other));
    let with = |own: &dyn Fn(&Made) -> [bool; 3]| {
        let of_each = |(made, no): (&Made, &Option<Obstacle>)| own(made).map(|own| own && no.is_none());
        let mut each: Vec<[bool; 3]> = all.iter().zip(&obstacles).map(of_each).collect();
        spread(&mut each, &pairs, &|mine, other| std::array::from_fn(|axis| mine[axis] || other[axis]));
        each
    };
    let (counts, starts) = (with(&|made| made.counts), with(&|made| made.starts));
    let mut changed = false;
    for (index, made) in all.into_iter().enumerate() {
        let is_free = obstacles[index].is_none();
        if let Some((why, help)) = obstacles[index] {
            let what = format!(
                "the target has no local shift, and this one cannot be counted into the coordinates: {why}"
            );
            for span in made.first {
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what.clone()).with_help(help));
            }
        } else if let Some(span) = made.first.first() {
            changed = true;
            made.ends.iter().for_each(|span| context.rests_on_source(index, *span, CLEARS));
            context.add_once(index, FOLDED, Diagnostic::new(Code::ShiftCounted, *span, FOLDED));
        }
        let mut edits = if is_free { made.edits } else { BTreeMap::new() };
        let sets = if counts[index].contains(&true) { made.sets } else { BTreeMap::new() };
        changed |= !edits.is_empty();
        let program = &mut module.programs[index];
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            // From the end, so that the places of the others stay.
            for at in (0..block.stmts.len()).rev() {
                let Some(stmt) = block.stmts.get_mut(at) else { continue };
                if let Some(edit) = edits.remove(&(id, at)) {
                    stmt.kind = edit.map_or(StmtKind::Comment, StmtKind::Nc);
                }
                let Some(values) = sets.get(&(id, at)) else { continue };
                insert(block, at, values, counts[index]);
                changed = true;
            }
        }
        if let Some(first) = program.blocks.first_mut().filter(|_| made.is_start) {
            insert(first, 0, &[(); 3].map(|()| Some(Expr::Number(0.0))), starts[index]);
        }
    }
    changed
}

/// Sets registers before a statement.
fn insert(block: &mut Block, at: usize, values: &[Option<Expr>; 3], wanted: [bool; 3]) {
    let site = SourceInfo {
        span: block.stmts.get(at).map_or(block.term.site.span, |stmt| stmt.site.span),
        ..SourceInfo::default()
    };
    for ((value, var), _) in values.iter().zip(REGISTERS).zip(wanted).rev().filter(|(_, wanted)| *wanted) {
        let Some(value) = value.clone() else { continue };
        let kind = StmtKind::Assign { target: Place::Var(var), value };
        block.stmts.insert(at, Stmt { kind, site: site.clone() });
    }
}

/// Looks at all programs.
fn look(module: &Module, context: &mut Context<'_>, pairs: &[(usize, usize)]) -> Vec<Made> {
    let called = called(module);
    let shifts = Shifts::of(module, &called);
    let known = OverCalls::of(module, &shifts);
    let facts = context.modal_facts(module);
    let summaries = context.summaries(module);
    let given = context.called(module).given(module);
    let features = Features::of(&module.programs);
    let calls = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
    let library = Library {
        drills: features.any_op(Op::is_cycle),
        compensates: features.op(Op::RadiusLeft) || features.op(Op::RadiusRight),
        units: features.op(Op::Inch) && features.op(Op::Metric),
        clears: context.source.is(CLEARS),
        touches: reads(&module.programs, &has_touch),
        external: reads(&module.programs, &|e| has_external(e, context.source))
            || sets(&module.programs, &|kind| sets_external(kind, context.source)),
        indirect: calls().any(|call| matches!(call.callee, Callee::Computed(_) | Callee::Cycle(_)))
            || sets(&module.programs, &|kind| matches!(kind, StmtKind::ModalCall(_))),
    };
    let names: BTreeMap<_, _> =
        module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.as_ref()?, at))).collect();
    let named = |callee: &Callee| match callee {
        Callee::Program(name) => names.get(name).copied(),
        _ => None,
    };
    let of_each = |is_so: &dyn Fn(&Features) -> bool| -> Vec<bool> {
        let mut each: Vec<bool> =
            module.programs.iter().map(|program| is_so(&Features::of_program(program))).collect();
        spread(&mut each, pairs, &|mine, other| mine || other);
        each
    };
    let shapes = of_each(&|own| own.any_op(is_shape));
    let returns_to = of_each(&|own| own.has(Feature::ReturnTo));
    let (none, filled) = (BTreeSet::new(), Filled::default());
    let counts = |_: &Nc, role: Role| AXES.contains(&role) || role == Role::CycleR;
    let look = |(index, program): (usize, &Program)| {
        let around = Around {
            assigned: given.get(&index).unwrap_or(&none),
            called: called[index] && !entries(program).any(|to| to == BlockId(0)),
            named: &none,
            filled: &filled,
        };
        let vacancy = Vacancy::around(program, &summaries, around);
        let look = Look {
            program,
            library: &library,
            source: context.source,
            named: &named,
            is_called: called[index],
            is_flat: !shapes[index],
            absent: vacancy.absent(&counts),
        };
        let mut made = look.over(&|id| known.at(index, id).cloned(), &|id| facts.at(index, id));
        made.is_start = shifts.starts[index];
        if returns_to[index] && !made.first.is_empty() {
            made.obstacle.get_or_insert(JUMPS);
        }
        made
    };
    module.programs.iter().enumerate().map(look).collect()
}

/// Joins what programs have with what those have that they call, or are called by, however far.
fn spread<T: Copy + PartialEq>(all: &mut [T], pairs: &[(usize, usize)], join: &dyn Fn(T, T) -> T) {
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (a, b) in pairs {
            let both = [join(all[*a], all[*b]), join(all[*b], all[*a])];
            changed |= [all[*a], all[*b]] != both;
            [all[*a], all[*b]] = both;
        }
    }
}

/// True for a code that turns, scales or mirrors coordinates.
fn is_shape(op: Op) -> bool {
    matches!(op, Op::RotateOn | Op::ScaleOn | Op::MirrorOn)
}

/// True where programs read what is asked.
fn reads(programs: &[Program], is_asked: &dyn Fn(&Expr) -> bool) -> bool {
    let mut blocks = programs.iter().flat_map(|program| &program.blocks);
    blocks.any(|block| {
        let mut found = false;
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut |e| found |= is_asked(e)));
        block.term.kind.exprs(&mut |e| found |= is_asked(e));
        found
    })
}

/// True where a statement of programs is so.
fn sets(programs: &[Program], is_so: &dyn Fn(&StmtKind) -> bool) -> bool {
    let blocks = programs.iter().flat_map(|program| &program.blocks);
    blocks.flat_map(|block| &block.stmts).any(|stmt| is_so(&stmt.kind))
}

/// What is asked of the whole library.
struct Library {
    drills: bool,
    compensates: bool,
    /// True if it reads where the probe touched.
    touches: bool,
    /// True if it reads or sets the shift of all work offsets, which some controls keep in one register with local ones.
    external: bool,
    /// True if it has codes of both units.
    units: bool,
    /// True if the source's end of a run clears the shift.
    clears: bool,
    /// True if it calls by a computed number, at each move, or a cycle of the maker's: nothing follows a shift through such calls.
    indirect: bool,
}
