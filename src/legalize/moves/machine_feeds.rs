//! Moves in machine coordinates that feed, for a target that goes there by rapid traverse alone.
//!
//! Law: under the code of the rapid both go there by rapid. Under another code the source may feed, and the target's code never does.
//! The way from where the machine stands to a place of the machine is the difference of the two, whatever offsets and lengths are in
//! force, so an increment by it feeds to the same place on the same line. The machine has to stand when its place is read.
//! Side conditions, each refused: G1 and G90 are known to be in force; the block names X, Y or Z alone, and none of them can be vacant; no
//! compensation, cycle, mirror, scaling or rotation and no feed in inverse time can be in force; no length is taken up or ended in it, and
//! after the last length something went to a place along Z: an increment may make up for one that has not counted yet.
//! Where it is not known which code is in force, or a word holds what was read by a
//! computed number of the system's, a reviewer has to look. Counter-example: `G53 G1 Z-5. F20.`, a crash where it is rapid.

use super::home::{absent, unsure};
use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question, Units};
use crate::ir::analysis::behind::behind_or_entered;
use crate::ir::analysis::modal_facts::replace_statements;
use crate::ir::eval::whole;
use crate::ir::{Bank, BinOp, Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts, constant_part};
use crate::legalize::ModalFacts;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use std::collections::BTreeSet;

const FEEDS: &str = "a move in machine coordinates under a code that feeds: the target makes every such move by rapid traverse";

const MAY_FEED: &str = "a move in machine coordinates, and it is not known whether G0 is in force: the target makes every such move by rapid \
     traverse";

const HELP: &str = "if rapid will do on the new machine, write \"machine.move.feed\" = \"rapid\" under [behaviours] in the target's profile, for all programs, \
     or G0 into this block; else move in coordinates of the part. If the source's moves are rapid too, its profile says so, as machine.move.rapid";

const RAPID: &str = "a move in machine coordinates that feeds on the source is rapid on the target, as the target's profile says that rapid will do";

const UNIT: &str = "a feed move in machine coordinates becomes an increment from the place that the target reads, and no source says whether it \
     reads it in the unit of the program or of the machine";

const UNIT_HELP: &str = "if the machine has the unit of the program, say so in the target's machine profile, as units; else read the machine's position in MDI under \
     this unit, and compare it with the machine position on the screen";

const VACANT: &str = "a word of this move in machine coordinates comes from a variable whose number is computed: where that variable is vacant, the source leaves \
     the axis where it is, and the target goes to machine 0. Make sure that it has a value in each run";

/// The library with what is read by a number that counts on from one of the system's taken to have a value.
fn with_system_reads(module: &Module, source: &Control) -> Module {
    // Systems count axes from the number before the first.
    let of_system = |number: f64| {
        let first = whole(number);
        first.is_some_and(|first| {
            (first..=first.saturating_add(1)).any(|number| source.numbered_state(number).is_some())
        })
    };
    let mut read = module.clone();
    for stmt in
        read.programs.iter_mut().flat_map(|program| &mut program.blocks).flat_map(|block| &mut block.stmts)
    {
        stmt.kind.exprs_mut(&mut |e| {
            if let Expr::Indirect(Bank::Numbered, number) = e
                && constant_part(number).is_some_and(of_system)
            {
                *e = Expr::Number(0.0);
            }
        });
    }
    read
}

/// True for two mills, where the target alone is known to go there by rapid whatever is in force.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let rapid = Question::MachineMoveRapid;
    features.op(Op::MachineOnce)
        && [context.source, context.target].iter().all(|control| control.machine() == Machine::Mill)
        && context.target.is(rapid)
        && (context.source.rapid_will_do() || !context.source.is(rapid))
}

/// Makes them increments, or refuses them.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    if context.source.rapid_will_do() {
        return tell_rapid(module, &facts, context);
    }
    let (library, may_lack) = (Library::of(module), unsure(module, context, Op::MachineOnce));
    let lacks = if may_lack.is_empty() {
        BTreeSet::new()
    } else {
        absent(&with_system_reads(module, context.source), &context.summaries(module), Op::MachineOnce)
    };
    replace_statements(module, &facts, |index, state, stmt, out| {
        state.step(&stmt);
        let found = stmt.kind.nc().filter(|nc| nc.has(Op::MachineOnce) && nc.names_axis());
        let (Some(nc), false) = (found, state.op(Group::Motion) == Some(Op::Rapid)) else {
            return out.push(stmt);
        };
        let span = stmt.site.span;
        let settled = (nc.word(Role::Z).is_none() || !library.lengths || counts(out))
            && !lacks.contains(&(index, span));
        let place = (index, span.start);
        if let Some(items) = increments(nc, state, &library, place).filter(|_| settled) {
            context.rests_on_source(index, span, Question::MachineMoveRapid);
            if may_lack.contains(&(index, span)) {
                context.add_once(index, VACANT, Diagnostic::new(Code::Conditional, span, VACANT));
            }
            if !in_its_unit(state, context.target) {
                let told = Diagnostic::new(Code::Conditional, span, UNIT).with_help(UNIT_HELP);
                context.add_once(index, UNIT, told.asked_once());
            }
            return put(items, stmt, out);
        }
        let (code, what) = match state.op(Group::Motion) {
            Some(_) => (Code::NoEquivalent, FEEDS),
            None => (Code::Conditional, MAY_FEED),
        };
        context.add_once(index, what, Diagnostic::new(code, span, what).with_help(HELP));
        out.push(stmt);
    });
}

/// Tells, once a program, that a move which feeds is rapid.
fn tell_rapid(module: &Module, facts: &ModalFacts, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                state.step(stmt);
                let moves = stmt.kind.nc().is_some_and(|nc| nc.has(Op::MachineOnce) && nc.names_axis());
                if moves && state.op(Group::Motion) != Some(Op::Rapid) {
                    context.add_once(
                        index,
                        RAPID,
                        Diagnostic::new(Code::RapidForFeed, stmt.site.span, RAPID),
                    );
                }
            }
        }
    }
}

/// True where a place reads the same in the unit in force and in that of the machine.
fn in_its_unit(state: &Modal, target: &Control) -> bool {
    let in_force = match state.op(Group::Units) {
        Some(Op::Inch) => Units::Inch,
        Some(Op::Metric) => Units::Metric,
        _ => return true,
    };
    target.units() == Some(in_force)
}

/// What of a library can be in force, by the programs and places of the moves that it may come before.
struct Library {
    /// Coordinates are turned, scaled, mirrored or polar, all shifts are cancelled, or a feed is in inverse time.
    shaped: BTreeSet<(usize, u32)>,
    compensates: BTreeSet<(usize, u32)>,
    drills: BTreeSet<(usize, u32)>,
    lengths: bool,
}

impl Library {
    fn of(module: &Module) -> Self {
        let features = Features::of(&module.programs);
        let shaped = |op| {
            use Op::{FeedInverse, MirrorOn, Pole, RotateOn, ScaleOn, ShiftCancel};
            matches!(op, RotateOn | ScaleOn | MirrorOn | Pole | ShiftCancel | FeedInverse)
        };
        Self {
            shaped: moves_after(module, shaped, |_| false),
            compensates: moves_after(
                module,
                |op| matches!(op, Op::RadiusLeft | Op::RadiusRight),
                |op| op == Op::RadiusOff,
            ),
            drills: moves_after(module, Op::is_cycle, |op| op == Op::CycleOff),
            lengths: features.role(Role::LengthOffset)
                || features.any_op(|op| matches!(op, Op::LengthPlus | Op::LengthMinus)),
        }
    }
}

/// The moves in machine coordinates that may come after an operation and before its end.
fn moves_after(
    module: &Module,
    sets: impl Fn(Op) -> bool,
    ends: impl Fn(Op) -> bool,
) -> BTreeSet<(usize, u32)> {
    let any = |stmt: &Stmt, of: &dyn Fn(Op) -> bool| stmt.kind.nc().is_some_and(|nc| nc.ops().any(of));
    let mut found = BTreeSet::new();
    behind_or_entered(
        module,
        |stmt| any(stmt, &sets),
        |stmt| any(stmt, &ends) && stmt.site.skip.is_none(),
        |index, stmt| {
            if stmt.kind.has_op(Op::MachineOnce) {
                found.insert((index, stmt.site.span.start));
            }
        },
    );
    found
}

/// True where the length in force counts: after its code these statements go to a place along Z.
fn counts(before: &Stmts) -> bool {
    for nc in before.iter().rev().filter_map(|stmt| stmt.kind.nc().filter(|_| stmt.site.skip.is_none())) {
        let own = |op: Op| matches!(op, Op::MachineOnce | Op::Incremental) || op.group() == Group::OneShot;
        if nc.word(Role::Z).is_some() && !nc.ops().any(own) {
            return true;
        }
        let length = |op: Op| op.group() == Group::LengthComp || op == Op::ToolChange;
        if nc.ops().any(length) || nc.word(Role::LengthOffset).is_some() {
            return false;
        }
    }
    false
}

/// The words of an increment that goes to the same place, if all side conditions hold.
fn increments(nc: &Nc, state: &Modal, library: &Library, place: (usize, u32)) -> Option<Vec<NcItem>> {
    let is = |group, op| state.op(group) == Some(op);
    let plain = is(Group::Motion, Op::Linear)
        && is(Group::Distance, Op::Absolute)
        && !library.shaped.contains(&place);
    let free = !library.compensates.contains(&place) || is(Group::RadiusComp, Op::RadiusOff);
    let no_cycle = !library.drills.contains(&place) || is(Group::Cycle, Op::CycleOff);
    if !(plain && free && no_cycle) {
        return None;
    }
    let mut items = vec![NcItem::Op(Op::Incremental), NcItem::Op(Op::Linear)];
    for item in &nc.items {
        match item {
            NcItem::Op(Op::MachineOnce | Op::Absolute | Op::Linear) => {}
            NcItem::Word(Role::Feed, _) => items.push(item.clone()),
            NcItem::Op(op) if matches!(op.group(), Group::Coolant | Group::Spindle) => {
                items.push(item.clone())
            }
            NcItem::Word(role @ (Role::X | Role::Y | Role::Z), to) => {
                items.push(NcItem::Word(*role, way(*role, to)?));
            }
            _ => return None,
        }
    }
    Some(items)
}

/// How far it is from where the machine stands.
fn way(role: Role, to: &Expr) -> Option<Expr> {
    let axis = Expr::Number(f64::from(role.axis_number()?));
    let stands = Expr::System(Sys::MachinePosition, [axis].into());
    Some(Expr::binary(BinOp::Sub, to.clone(), stands))
}

/// A wait until the machine stands, the increment, and absolute coordinates again.
fn put(items: Vec<NcItem>, stmt: Stmt, out: &mut Stmts) {
    let span = stmt.site.span;
    let aside = || SourceInfo { span, ..SourceInfo::default() };
    out.push(Stmt { kind: StmtKind::Sync, site: aside() });
    out.push(Stmt { kind: StmtKind::Nc(Nc { items }), site: stmt.site });
    out.push(Stmt { kind: StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::Absolute)] }), site: aside() });
}
