//! Changes to a tool that are left out while it is in the spindle, where the text says which tool that is.
//!
//! Law: a tool word that changes nothing while its tool is in the spindle is a comparison and a change. After a change to tool n,
//! and past such a comparison with n, tool n is in the spindle: the next one is decided, and what reads that tool reads n. Side conditions: nothing between may
//! change the tool, as a stop of the program, where the operator may, a computed code, or what the library
//! does not have; a program that returns begins with no tool known; comparisons that a person wrote stay, for a tool may stand for another of its group.
//! Counter-example: `T1`, `M0`, `T1`, where the operator puts another tool in at the stop.

use crate::canon::{Op, Role, Sys};
use crate::ir::analysis::dataflow::Same;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::analysis::{Cfg, calls_of};
use crate::ir::{
    Block, BlockId, Call, Callee, Cond, Expr, Module, Nc, NcItem, Program, Relation, SourceInfo, Stmt,
    StmtKind, TermKind,
};
use crate::legalize::Context;
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// A block of a program.
type Place = (usize, BlockId);

/// The tool in the spindle, if it is known.
type Spindle = Same<f64>;

fn step(spindle: &mut Spindle, stmt: &Stmt) {
    match &stmt.kind {
        StmtKind::Nc(nc) if stmt.site.skip.is_none() && changes(nc) => {
            spindle.0 = nc.word(Role::Tool).and_then(Expr::constant);
        }
        StmtKind::Nc(nc) if !may_change(nc) => {}
        StmtKind::Comment | StmtKind::Assign { .. } => {}
        _ => spindle.0 = None,
    }
}

/// Decides what is known; true if there was any.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let found: BTreeMap<Place, Change> = module
        .programs
        .iter()
        .enumerate()
        .flat_map(|(index, program)| {
            program.ids().filter_map(move |id| Some(((index, id), change(program, id)?)))
        })
        .collect();
    let blocks = || module.programs.iter().flat_map(|program| &program.blocks);
    let modal = |block: &Block| block.stmts.iter().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)));
    let computed = |block: &Block| calls_of(block).any(|call| matches!(call.callee, Callee::Computed(_)));
    if found.is_empty() || blocks().any(|block| modal(block) || computed(block)) {
        return false;
    }
    let mut past = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        let cfg = Cfg::of(program);
        for ((_, id), change) in found.range((index, BlockId(0))..(index + 1, BlockId(0))) {
            // Nothing else comes there.
            if cfg.preds(change.past).iter().all(|from| [*id, change.block].contains(from)) {
                past.insert((index, change.past), change.tool);
            }
        }
    }
    let called = module.programs.iter().map(Program::returns).collect();
    let tools = Tools { past, called, keep: keeping(module) };
    let spindles = OverCalls::of(module, &tools);
    let mut changed = false;
    for (place, change) in found {
        let Some(known) = spindles.at(place.0, place.1) else { continue };
        let Some(program) = module.programs.get_mut(place.0) else { continue };
        let Some(block) = program.blocks.get_mut(place.1.index()) else { continue };
        let mut spindle = *known;
        tools.stmts(place, block, &mut spindle);
        if let Some(tool) = spindle.0 {
            let is_it = tool == change.tool;
            block.term.kind = TermKind::Jump(if is_it { change.past } else { change.block });
            if !is_it {
                say_once(program, place.1, &change);
            }
            changed = true;
        }
    }
    read(module, &spindles, &tools) || changed
}

/// Puts the tool where statements read it; true if there were any.
fn read(module: &mut Module, spindles: &OverCalls<Spindle>, tools: &Tools) -> bool {
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let Some(mut spindle) = spindles.at(index, id).copied() else { continue };
            tools.enter((index, id), &mut spindle);
            for stmt in &mut block.stmts {
                if let Some(tool) = spindle.0 {
                    stmt.kind.exprs_mut(&mut |e| {
                        e.walk_mut(&mut |e| {
                            if matches!(e, Expr::System(Sys::ActiveTool, _)) {
                                *e = Expr::Number(tool);
                                changed = true;
                            }
                        });
                    });
                }
                step(&mut spindle, stmt);
            }
        }
    }
    changed
}

/// Leaves number and comments of a tool word at its change alone.
fn say_once(program: &mut Program, before: BlockId, change: &Change) {
    let Some(block) = program.blocks.get_mut(before.index()) else { return };
    let span = block.term.site.span;
    block.term.site = SourceInfo::default();
    let first = program.blocks.get_mut(change.past.index()).and_then(|block| block.stmts.first_mut());
    if let Some(first) = first.filter(|stmt| stmt.site.span == span) {
        first.site = SourceInfo { span, skip: first.site.skip, ..SourceInfo::default() };
    }
}

/// A change that a comparison leaves out.
struct Change {
    tool: f64,
    /// The block of the change.
    block: BlockId,
    /// Where both ways go on.
    past: BlockId,
}

/// The change that stands at the end of a block, if lowering made it from one tool word.
fn change(program: &Program, id: BlockId) -> Option<Change> {
    let term = &program.block(id)?.term;
    let TermKind::Branch { cond, then, otherwise } = &term.kind else { return None };
    let Cond::Compare(relation, Expr::System(Sys::ActiveTool, _), tool) = &**cond else { return None };
    let (past, block) = match relation {
        Relation::Equal => (*then, *otherwise),
        Relation::NotEqual => (*otherwise, *then),
        _ => return None,
    };
    let tool = tool.constant()?;
    let changes = program.block(block)?;
    let [stmt] = changes.stmts.as_slice() else { return None };
    let nc = stmt.kind.nc().filter(|_| stmt.site.skip.is_none() && stmt.site.span == term.site.span)?;
    let is_it = nc.has(Op::ToolChange) && nc.word(Role::Tool).and_then(Expr::constant) == Some(tool);
    (is_it && matches!(changes.term.kind, TermKind::Jump(to) if to == past)).then_some(Change {
        tool,
        block,
        past,
    })
}

/// What is known of the tool in the spindle.
struct Tools {
    /// The blocks past a change, with its tool.
    past: BTreeMap<Place, f64>,
    /// By program, whether it returns: something else than the library may call it too.
    called: Vec<bool>,
    /// The programs that leave the tool alone, with all that they call.
    keep: BTreeSet<ProgramName>,
}

impl Tools {
    fn enter(&self, place: Place, spindle: &mut Spindle) {
        if let Some(tool) = self.past.get(&place) {
            *spindle = Same(Some(*tool));
        } else if place.1 == BlockId(0) && self.called.get(place.0) == Some(&true) {
            *spindle = Same(None);
        }
    }
}

impl Follow for Tools {
    type Known = Spindle;

    fn outside(&self, _: usize) -> Spindle {
        Same(None)
    }

    fn stmts(&self, place: Place, block: &Block, spindle: &mut Spindle) {
        self.enter(place, spindle);
        block.stmts.iter().for_each(|stmt| step(spindle, stmt));
    }

    fn returned(&self, _: usize, call: &Call, before: &Spindle, after: &mut Spindle) {
        if matches!(&call.callee, Callee::Program(name) if self.keep.contains(name)) {
            *after = *before;
        }
    }

    fn lose(&self, spindle: &mut Spindle) {
        spindle.0 = None;
    }
}

/// The programs that leave the tool alone, with all that they call.
fn keeping(module: &Module) -> BTreeSet<ProgramName> {
    let mut keep: BTreeSet<ProgramName> = module.programs.iter().filter_map(|p| p.name.clone()).collect();
    loop {
        let leaves = |stmt: &Stmt| {
            let mut spindle = Same(Some(0.0));
            step(&mut spindle, stmt);
            spindle.0 == Some(0.0)
        };
        let stays = |call: &Call| match &call.callee {
            Callee::Program(name) => keep.contains(name),
            Callee::Block(_) => true,
            Callee::Computed(_) | Callee::Cycle(_) => false,
        };
        let changes = |program: &&Program| {
            let blocks = &program.blocks;
            !blocks.iter().all(|block| block.stmts.iter().all(leaves) && calls_of(block).all(stays))
        };
        let others: Vec<_> = module.programs.iter().filter(changes).filter_map(|p| p.name.clone()).collect();
        let before = keep.len();
        others.iter().for_each(|name| _ = keep.remove(name));
        if keep.len() == before {
            return keep;
        }
    }
}

/// True for a change whose tool stands beside it, and nothing that may change it again.
fn changes(nc: &Nc) -> bool {
    nc.has(Op::ToolChange) && nc.word(Role::Tool).is_some() && nc.items.iter().all(is_known)
}

/// True for a block that may change the tool, or at which a person may.
fn may_change(nc: &Nc) -> bool {
    nc.has(Op::ToolChange) || nc.word(Role::Tool).is_some() || !nc.items.iter().all(is_known)
}

/// True for words, and for codes that leave the tool alone.
fn is_known(item: &NcItem) -> bool {
    match item {
        NcItem::Op(op) => !matches!(op, Op::Stop | Op::OptionalStop | Op::MachineSpecific),
        NcItem::Code(..) => false,
        NcItem::Word(..) => true,
    }
}
