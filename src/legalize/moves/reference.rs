//! The return to the reference position without axes, where the target needs them named.
//!
//! Law: a return of all axes by way of the place where the tool stands is a return that names every axis at an
//! incremental distance of 0. Side condition: absolute or incremental is known, to be restored. Which
//! axes the machine has its profile says, and the moves of the library: X, Y, Z and the rotary ones it moves. Of those that the target does
//! not have, the ones that the program itself moves. A lathe sends home the axes that its profile lists, else X and Z (docs/lathe.md Z2):
//! where the profile lists none and the library moves Y or C, the return is refused. C is an axis there only while it is engaged: where it
//! is not, a word for it is an alarm of the target, so it is named only where it is known to be, and told where it may be.
//! Counter-example: `G28` before M154, where C turns as the spindle.

mod engaged;

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Axis, Control, Machine, Question};
use crate::ir::analysis::Vacancy;
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Var};
use crate::legalize::lathe::steps::has_letters;
use crate::legalize::{Context, replace_statements};
use engaged::Engagement;
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};

/// Nothing is known of arguments.
static NONE: BTreeSet<Var> = BTreeSet::new();

const ROTARY: &str = "this return takes all axes of the source along, and the target does not have all of the rotary ones: make sure that \
                      they stand at their reference position, or that the target's machine has no such axes";

/// Names the axes of returns that name none.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let ncs = || {
        module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts).filter_map(|stmt| {
            match &stmt.kind {
                StmtKind::Nc(nc) => Some(nc),
                _ => None,
            }
        })
    };
    let (here, there) =
        (context.source.is(Question::ReferenceAllAxes), context.target.is(Question::ReferenceAllAxes));
    if here && there
        || context.source.name() == context.target.name()
        || !ncs().any(|nc| bare(nc) || empty(nc, &|_| true))
    {
        return;
    }
    if !here {
        return doubt(module, there, context);
    }
    let rotary = [Role::A, Role::B, Role::C];
    let further = [Role::A, Role::B, Role::C, Role::U, Role::V, Role::W];
    let source = context.source;
    let turns = source.machine() == Machine::Lathe;
    let moves = |role: &Role| {
        let step = Role::STEPS.iter().find(|(whole, _)| whole == role).map(|(_, step)| *step);
        ncs().any(|nc| nc.word(*role).is_some() || step.is_some_and(|step| nc.word(step).is_some()))
    };
    let has = |role: &Role| has_axis(source, *role) == Some(true) || rotary.contains(role) && moves(role);
    let linear = [Role::X, Role::Y, Role::Z].into_iter();
    let axes: Vec<Role> = match turns {
        true => of_lathe(source, context.target, &moves),
        false => linear.chain(further.into_iter().filter(has)).collect(),
    };
    let untold = turns && source.profile().axes.is_none() && [Role::Y, Role::C].iter().any(moves);
    let letters = has_letters(context.source);
    // What the target does not have is named where the program moves it, and refused there.
    let target = context.target;
    let taken = |role: Role| target.letter(role, None).is_some() && has_axis(target, role) != Some(false);
    let own: Vec<Vec<Role>> = module
        .programs
        .iter()
        .map(|program| {
            let ncs = || program.blocks.iter().flat_map(|b| &b.stmts).filter_map(|stmt| stmt.kind.nc());
            let named = |role: &Role| {
                !further.contains(role) || taken(*role) || ncs().any(|nc| nc.word(*role).is_some())
            };
            axes.iter().copied().filter(named).collect()
        })
        .collect();
    // Without a list of its axes the source may have each of the rotary ones.
    let may_have =
        |role: &Role| axes.contains(role) || rotary.contains(role) && has_axis(source, *role).is_none();
    let left_out = !turns && further.iter().any(|role| may_have(role) && !taken(*role));
    let turns_c: Vec<bool> = module.programs.iter().map(engaged::is_named).collect();
    let engaged = match turns && axes.contains(&Role::C) {
        true => Engagement::at_returns(module, source, moves(&Role::C)),
        false => BTreeMap::new(),
    };
    let facts = context.modal_facts(module);
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        state.step(&stmt);
        let span = stmt.site.span;
        let mut restore = None;
        if let StmtKind::Nc(nc) = &mut stmt.kind
            && bare(nc)
        {
            context.rests_on_source(index, span, Question::ReferenceAllAxes);
            let distance = state.op(Group::Distance);
            let (code, what) = match distance {
                _ if untold => (Code::NoEquivalent, UNTOLD),
                _ if letters || distance.is_some() => {
                    restore = distance.filter(|distance| !letters && *distance == Op::Absolute);
                    let c = engaged.get(&(index, span));
                    let is_axis = |role: &&Role| **role != Role::C || c.is_none_or(|c| c.on && !c.off);
                    let axes: Vec<Role> = own[index].iter().filter(is_axis).copied().collect();
                    name(nc, &axes, letters);
                    let is_told = engaged::is_told(source);
                    let what = match c {
                        Some(c) if c.on && c.off => Some(ENGAGED),
                        Some(c) if c.on && !is_told => Some(TAKEN),
                        _ => None,
                    };
                    if let Some(what) = what {
                        let told = Diagnostic::new(Code::Conditional, span, what).with_help(ENGAGED_HELP);
                        let own = is_told && turns_c[index];
                        context.add_once(index, what, if own { told } else { told.asked_once() });
                    }
                    (
                        Code::Conditional,
                        "all axes return at the same time; no source says in which order the source moves \
                         them",
                    )
                }
                _ => (
                    Code::NoEquivalent,
                    "a return to the reference position without axes, and it is not known whether G90 or \
                     G91 is in force: write one of them before it",
                ),
            };
            // Where the source's axes return together, those of the target do the same. No source says it of C and of further axes.
            let is_said = |role: &Role| !matches!(role, Role::C | Role::U | Role::V | Role::W);
            let together = context.source.is(Question::ReferenceTogether) && own[index].iter().all(is_said);
            if code == Code::NoEquivalent || !together {
                let told = Diagnostic::new(code, span, what).asked_once();
                context.add(index, if untold { told.with_help(UNTOLD_HELP) } else { told });
            }
            if left_out {
                context.add_once(
                    index,
                    ROTARY,
                    Diagnostic::new(Code::Conditional, span, ROTARY).asked_once(),
                );
            }
        }
        out.push(stmt);
        if let Some(distance) = restore {
            let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(distance)] });
            out.push(Stmt { kind, site: SourceInfo { span, ..SourceInfo::default() } });
        }
    });
}

/// The axes that a lathe sends home: those that its profile lists, as far as the target has them or the library moves them.
fn of_lathe(source: &Control, target: &Control, moves: &dyn Fn(&Role) -> bool) -> Vec<Role> {
    let listed = |control: &Control, role: &Role| has_axis(control, *role) == Some(true);
    let more = [Role::Y, Role::C].into_iter();
    let more = more.filter(|role| listed(source, role) && (listed(target, role) || moves(role)));
    [Role::X, Role::Z].into_iter().chain(more).collect()
}

const UNTOLD: &str = "a return to the reference position without axes takes all axes home, and which axes the machine has is not known";
const UNTOLD_HELP: &str =
    "name the axes in this block, or list them in the source's profile: axes = [\"X\", \"Z\", ...]";

const ENGAGED: &str = "this return takes C home where C is engaged, and whether it is, is not known here: it is written without C, as a word for C is an alarm while the spindle turns the part";
const TAKEN: &str = "this return takes C home, and a word for C is an alarm while the spindle turns the part: C is taken to be engaged here, as it moved before";
const ENGAGED_HELP: &str = "write H0 into this block if C is engaged there, and U0 W0 if it is not; the codes that engage C and let it go need the names c.axis.on and c.axis.off in the source's profile";

/// Whether a machine has an axis, if its profile lists them.
fn has_axis(control: &Control, role: Role) -> Option<bool> {
    let number = |axis: &Axis| Some(axis.number()) == role.axis_number();
    Some(control.profile().axes.as_ref()?.iter().any(number))
}

/// What a return without axes does on the source is not known; on the target it may move all of them.
fn doubt(module: &Module, all: bool, context: &mut Context<'_>) {
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter().enumerate() {
        let vacancy = LazyCell::new(|| Vacancy::of(program, &summaries, &NONE));
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                if bare(nc) {
                    let what = "no source says what a return to the reference position without axes does on the \
                         source: name the axes";
                    context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
                } else if all && empty(nc, &|value| vacancy.may_yield_vacant(id, at, value)) {
                    let what = "all axis words of this return may be vacant; the target then moves all axes";
                    context.add_once(index, what, Diagnostic::new(Code::Conditional, stmt.site.span, what));
                }
            }
        }
    }
}

/// True where all axes may be dropped from a return, because their values may be vacant.
fn empty(nc: &Nc, may_be_vacant: &dyn Fn(&Expr) -> bool) -> bool {
    let axes = |item: &NcItem| match item {
        NcItem::Word(role, value) if role.is_axis() => Some(value.may_be_vacant() && may_be_vacant(value)),
        _ => None,
    };
    nc.has(Op::ReferenceReturn) && nc.moves() && nc.items.iter().filter_map(axes).all(|vacant| vacant)
}

fn bare(nc: &Nc) -> bool {
    nc.has(Op::ReferenceReturn) && !nc.moves()
}

/// Names the axes at an increment of 0: by letters for increments where the source has them, else by the mode.
fn name(nc: &mut Nc, axes: &[Role], letters: bool) {
    nc.items.retain(|item| !matches!(item, NcItem::Op(Op::Absolute | Op::Incremental)));
    let at = nc.items.iter().position(|item| *item == NcItem::Op(Op::ReferenceReturn)).unwrap_or(0);
    let word = |axis: Role| {
        let step = Role::STEPS.iter().find(|(whole, _)| letters && *whole == axis).map(|(_, step)| *step);
        NcItem::Word(step.unwrap_or(axis), Expr::Number(0.0))
    };
    nc.items.splice(at + 1..at + 1, axes.iter().copied().map(word));
    if !letters {
        nc.items.insert(at, NcItem::Op(Op::Incremental));
    }
}
