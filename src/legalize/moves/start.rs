//! What is in force on the source's machine when a program begins, where the program does not say it.
//!
//! Law: a main program runs in what the machine begins in until it names a mode of that group. So the codes that the profile
//! of the source has under `[start]` may stand at its head, as far as it comes to a use of modes before it names them; and a
//! code at the head that the target begins in may go again.
//! Side condition, else a reviewer is told: nothing calls the program, it does not return, and nothing jumps to its head, where the codes would be run
//! once more. The verifier starts the source so, and the target in anything that its own profile does not say.
//! Counter-example: `N1 G91 X1. GOTO 1`: at the second time N1 is run in G91.

use super::mains::{head, mains, returns, uncalled};
use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Machine, StartMode};
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::may_come_back;
use crate::ir::{
    Block, BlockId, Callee, Expr, Module, Nc, NcItem, Program, SourceInfo, Stmt, StmtKind, TermKind,
};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::{BTreeMap, BTreeSet};

/// True where the source's profile says what a program begins in.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    !context.source.start().is_empty()
}

/// Puts the codes at the heads of main programs that rest on them.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let back = may_come_back(module);
    let counted = Counted::of(module);
    let mut changed = false;
    let called = context.called(module);
    let alone = alone(module, context);
    for root in uncalled(module, &called) {
        let program = &mut module.programs[root];
        let named = named_first(program);
        let rests = |mode: &&StartMode| {
            let group = mode.op.group();
            // The unit is told where `units` is.
            group != Group::Units
                && counted.has(group)
                && named.as_ref().is_some_and(|named| !named.contains(&group))
        };
        // What the target cannot select it is in: every control here begins so.
        let usual = |op| matches!(op, Op::Rapid | Op::Absolute | Op::PlaneXy | Op::FeedPerMinute);
        // A lathe tells by letters of its own what G90 tells, and its passes ask for it.
        let turns = context.target.machine() == Machine::Lathe;
        let has = |mode: &&StartMode| {
            turns || !usual(mode.op) || context.target.code_for(mode.op, &mode.fixed).is_some()
        };
        let modes: Vec<&StartMode> = context.source.start().iter().filter(rests).filter(has).collect();
        if modes.is_empty() {
            continue;
        }
        let codes: Vec<&str> = modes.iter().filter_map(|mode| spelled(context, mode)).collect();
        if !alone.contains(&root) || is_entered_again(program, back) {
            let alike = |mode: &&StartMode| context.target.start().contains(mode);
            if !modes.iter().all(alike) {
                let what = format!(
                    "the old machine begins in {}, and this may be called, or goes back to its head, so that no code is \
                     written there: if an operator starts it, see that the target begins so",
                    codes.join(" ")
                );
                let help = "if it does, put these codes under [start] in the machine profile of the target";
                context
                    .add(root, Diagnostic::new(Code::Conditional, program.site.span, what).with_help(help));
            }
            continue;
        }
        let text = format!("begins in {}, as the machine's profile says", codes.join(" "));
        let finding = Diagnostic::new(Code::StartsStated, program.site.span, text)
            .assuming(Predicate::Start(modes.iter().map(|mode| mode.op).collect()));
        head(program, modes.into_iter().flat_map(items).collect());
        context.add(root, finding);
        changed = true;
    }
    changed
}

/// By program, the groups whose mode it takes from the machine: it comes to a use of modes before it names them. Of programs that
/// others call none, for they begin in what their callers set.
pub fn rests_on(module: &Module) -> Vec<BTreeSet<Group>> {
    let called = CalledPrograms::of(module);
    let counted = Counted::of(module);
    let mut all = vec![BTreeSet::new(); module.programs.len()];
    for root in uncalled(module, &called) {
        if let (Some(named), Some(rests)) = (named_first(&module.programs[root]), all.get_mut(root)) {
            let open =
                StartMode::GROUPS.into_iter().filter(|group| counted.has(*group) && !named.contains(group));
            *rests = open.collect();
        }
    }
    all
}

/// Of those, the groups of programs that get no codes at their heads: they may be called, or go back there.
pub fn rests_unwritten(module: &Module) -> Vec<BTreeSet<Group>> {
    let called = CalledPrograms::of(module);
    let alone = alone_among(module, &called);
    let back = may_come_back(module);
    let mut all = rests_on(module);
    for (root, rests) in all.iter_mut().enumerate() {
        if alone.contains(&root) && !is_entered_again(&module.programs[root], back) {
            rests.clear();
        }
    }
    all
}

/// By program, true if nothing calls it and it may cancel a tool length that was in force before it: it comes to the code, without a
/// word of an axis, before it names a length.
pub fn cancels_length(module: &Module) -> Vec<bool> {
    let called = CalledPrograms::of(module);
    let mut all = vec![false; module.programs.len()];
    for root in uncalled(module, &called) {
        let bare = |kind: &StmtKind| kind.nc().is_some_and(is_bare_cancel);
        let lengths =
            |kind: &StmtKind| kind.nc().is_some_and(|nc| nc.ops().any(|op| op.group() == Group::LengthComp));
        let program = &module.programs[root];
        let is_first = |block: &Block| {
            let first = block.stmts.iter().find(|stmt| lengths(&stmt.kind));
            first.is_some_and(|stmt| bare(&stmt.kind))
        };
        // The first code of a length on the way from the head.
        let (mut at, mut seen) = (vec![BlockId(0)], BTreeSet::new());
        while let Some(id) = at.pop() {
            let Some(block) = program.block(id).filter(|_| seen.insert(id)) else { continue };
            if is_first(block) {
                all[root] = true;
            } else if !block.stmts.iter().any(|stmt| lengths(&stmt.kind)) {
                at.extend(block.term.kind.successors());
            }
        }
    }
    all
}

fn is_bare_cancel(nc: &Nc) -> bool {
    let is_axis = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis());
    nc.ops().any(|op| op == Op::LengthOff) && !nc.items.iter().any(is_axis)
}

/// Takes out what the target begins in anyway.
pub fn drop_alike(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut changed = false;
    for root in alone(module, context) {
        if is_entered_again(&module.programs[root], true) {
            continue;
        }
        let Some(block) = module.programs[root].blocks.first_mut() else { continue };
        let inserted =
            |stmt: &Stmt| stmt.site == SourceInfo::default() && matches!(stmt.kind, StmtKind::Nc(_));
        let at = block.stmts.iter().take_while(|stmt| matches!(stmt.kind, StmtKind::Comment)).count();
        let Some(stmt) = block.stmts.get_mut(at).filter(|stmt| inserted(stmt)) else { continue };
        let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
        let before = nc.items.len();
        for mode in context.target.start() {
            let all = items(mode);
            if all.iter().all(|item| nc.items.contains(item)) {
                nc.items.retain(|item| !all.contains(item));
            }
        }
        changed |= nc.items.len() != before;
        if nc.items.is_empty() {
            block.stmts.remove(at);
        }
    }
    changed
}

/// The main programs that nothing calls, and that go back to nothing.
fn alone(module: &Module, context: &Context<'_>) -> Vec<usize> {
    alone_among(module, &context.called(module))
}

fn alone_among(module: &Module, called: &CalledPrograms) -> Vec<usize> {
    let uncalled = uncalled(module, called);
    let mut all = mains(module, called);
    all.retain(|root| {
        uncalled.contains(root) && !called.is_guessed(*root) && !returns(&module.programs[*root])
    });
    all
}

/// A mode as what a block says.
fn items(mode: &StartMode) -> Vec<NcItem> {
    let words = mode.fixed.iter().map(|(role, value)| NcItem::Word(*role, Expr::Number(*value)));
    std::iter::once(NcItem::Op(mode.op)).chain(words).collect()
}

fn spelled<'c>(context: &'c Context<'_>, mode: &StartMode) -> Option<&'c str> {
    context.source.code_for(mode.op, &mode.fixed).map(|row| row.code.as_str())
}

/// True if something in the program, or what it calls, may go on at its head.
fn is_entered_again(program: &Program, may_come_back: bool) -> bool {
    let labelled = program.blocks.first().is_some_and(|block| !block.labels.is_empty());
    may_come_back && labelled
        || program.blocks.iter().any(|block| {
            let calls = |kind: &TermKind| match kind {
                TermKind::Call { call, .. } => call.callee == Callee::Block(BlockId(0)),
                _ => false,
            };
            block.term.kind.successors().contains(&BlockId(0)) || calls(&block.term.kind)
        })
}

/// The groups that a program names before it uses any; none if it comes to no use. Where holes end counts at the first hole.
fn named_first(program: &Program) -> Option<BTreeSet<Group>> {
    let mut named = named_before(program, uses)?;
    let drills = |kind: &StmtKind| kind.nc().is_some_and(|nc| nc.ops().any(Op::is_hole));
    match named_before(program, drills) {
        Some(before) if !before.contains(&Group::ReturnPlane) => _ = named.remove(&Group::ReturnPlane),
        _ => _ = named.insert(Group::ReturnPlane),
    }
    Some(named)
}

/// The groups that a program names on all ways to such a statement; none if it comes to none. An alarm ends a way.
fn named_before(program: &Program, comes_to: impl Fn(&StmtKind) -> bool) -> Option<BTreeSet<Group>> {
    // What is named on all ways to a block that come to no such statement before.
    let mut at_heads = BTreeMap::from([(BlockId(0), BTreeSet::new())]);
    let mut open = vec![BlockId(0)];
    while let Some(id) = open.pop() {
        let Some(block) = program.block(id) else { continue };
        let Way::On(named) = way(block, at_heads[&id].clone(), &comes_to) else { continue };
        for next in block.term.kind.successors() {
            let met: BTreeSet<Group> = match at_heads.get(&next) {
                Some(known) => known.intersection(&named).copied().collect(),
                None => named.clone(),
            };
            if at_heads.get(&next) != Some(&met) {
                at_heads.insert(next, met);
                open.push(next);
            }
        }
    }
    let uses =
        at_heads.into_iter().filter_map(|(id, named)| match way(program.block(id)?, named, &comes_to) {
            Way::Uses(named) => Some(named),
            Way::On(_) | Way::Ends => None,
        });
    uses.reduce(|one, other| one.intersection(&other).copied().collect())
}

/// Where a way through a block comes to, with the groups that are named by then.
enum Way {
    /// To a use of modes, or to what may be one.
    Uses(BTreeSet<Group>),
    /// To the blocks after it.
    On(BTreeSet<Group>),
    /// To the end of the run.
    Ends,
}

fn way(block: &Block, mut named: BTreeSet<Group>, comes_to: impl Fn(&StmtKind) -> bool) -> Way {
    for stmt in &block.stmts {
        if let StmtKind::Nc(nc) = &stmt.kind {
            // A block that may be skipped may name nothing.
            let sure = stmt.site.skip.is_none();
            named.extend(nc.ops().filter(|op| sure && op.group() != Group::OneShot).map(Op::group));
        }
        if matches!(stmt.kind, StmtKind::Alarm { .. }) {
            return Way::Ends;
        }
        if comes_to(&stmt.kind) {
            return Way::Uses(named);
        }
    }
    match &block.term.kind {
        TermKind::Jump(_) => Way::On(named),
        TermKind::Branch { cond, .. } => {
            let mut reads = false;
            cond.exprs(&mut |e| e.walk(&mut |part| reads |= is_read(part)));
            if reads { Way::Uses(named) } else { Way::On(named) }
        }
        TermKind::End { .. } | TermKind::Stray => Way::Ends,
        _ => Way::Uses(named),
    }
}

/// True for what may read a mode.
const fn is_read(part: &Expr) -> bool {
    matches!(part, Expr::System(..) | Expr::Indirect(..))
}

/// True for a statement in which modes count.
fn uses(kind: &StmtKind) -> bool {
    match kind {
        StmtKind::Comment | StmtKind::ClearAll(_) => false,
        StmtKind::Nc(nc) => nc.items.iter().any(|item| match item {
            NcItem::Word(role, _) => role.is_axis() || role.is_length() || *role == Role::Feed,
            NcItem::Code(..) => true,
            // Without axes it goes by way of where the tool stands: a place in coordinates of either mode.
            NcItem::Op(op) => *op == Op::ReferenceReturn,
        }),
        kind => {
            let mut reads = !matches!(kind, StmtKind::Assign { .. });
            kind.exprs(&mut |e| e.walk(&mut |part| reads |= is_read(part)));
            reads
        }
    }
}

/// What a library has to do with groups that matter to few moves.
struct Counted {
    feed: bool,
    plane: bool,
    holes: bool,
}

impl Counted {
    fn of(module: &Module) -> Self {
        let mut counted = Self { feed: false, plane: false, holes: false };
        for block in module.programs.iter().flat_map(|program| &program.blocks) {
            for stmt in &block.stmts {
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                for item in &nc.items {
                    match item {
                        NcItem::Word(role, _) => counted.feed |= matches!(role, Role::Feed | Role::Lead),
                        NcItem::Code(..) => counted = Self { feed: true, plane: true, holes: true },
                        NcItem::Op(op) => {
                            let group = op.group();
                            let turns = matches!(
                                group,
                                Group::RadiusComp
                                    | Group::LengthComp
                                    | Group::Cycle
                                    | Group::Rotation
                                    | Group::Plane
                            );
                            counted.plane |= turns || matches!(op, Op::ArcCw | Op::ArcCcw);
                            counted.holes |= op.is_hole();
                        }
                    }
                }
            }
        }
        counted
    }

    fn has(&self, group: Group) -> bool {
        match group {
            Group::FeedMode => self.feed,
            Group::Plane => self.plane,
            Group::ReturnPlane => self.holes,
            _ => true,
        }
    }
}
