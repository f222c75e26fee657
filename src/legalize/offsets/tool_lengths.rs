//! Tool lengths, on a control whose tool word brings the length of the tool.
//!
//! Law: a change to tool n brings length n there, so the block that takes up length n of the tool in the spindle has
//! nothing left to do; a length that is ended is tool 0. Side conditions: the numbers of tools and lengths are constants;
//! a length is taken up with its own tool in the spindle, changed by the program; nothing moves along Z while the lengths
//! of the two controls differ, nor is anything called or returned to. A tool that is made ready is named at its change.
//! A main program that takes up one length alone and changes to no tool is run with that tool: it is changed to at the
//! head, which a person must look at. Counter-example: `T1 M6`, `G0 Z5.`, `G43 H1`: on the target Z5 counts the length.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, solve};
use crate::ir::analysis::{Cfg, calls_of, own_call, reachable};
use crate::ir::{
    Block, BlockId, Call, Callee, Expr, Module, Nc, NcItem, Program, SourceInfo, Stmt, StmtKind, TermKind,
    Terminator,
};
use crate::legalize::Context;
use crate::legalize::rewrite::put_first;
use crate::syntax::ProgramName;
use smallvec::SmallVec;
use std::collections::{BTreeMap, BTreeSet};

/// True if a tool word brings the length of its tool.
pub fn concerns(target: &Control) -> bool {
    target.is(Question::ToolWordSelectsLength)
}

/// Which length is in force.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Length {
    /// What was in force at the start.
    Entry,
    Off,
    Of(u32),
    Unknown,
}

/// What is in force at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct State {
    /// The tool in the spindle, and the one that waits for its change.
    tool: Option<u32>,
    waits: Option<u32>,
    /// The length on the source and on the target.
    ours: Length,
    theirs: Length,
}

const START: State = State { tool: None, waits: None, ours: Length::Entry, theirs: Length::Entry };
const LOST: State = State { tool: None, waits: None, ours: Length::Unknown, theirs: Length::Unknown };

impl Lattice for State {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        self.tool = self.tool.filter(|tool| other.tool == Some(*tool));
        self.waits = self.waits.filter(|tool| other.waits == Some(*tool));
        for (mine, theirs) in [(&mut self.ours, other.ours), (&mut self.theirs, other.theirs)] {
            if *mine != theirs {
                *mine = Length::Unknown;
            }
        }
        *self != before
    }
}

impl State {
    fn step(&mut self, stmt: &Stmt) {
        let StmtKind::Nc(nc) = &stmt.kind else { return };
        let before = *self;
        let named = nc.word(Role::Tool).map(number);
        if nc.has(Op::ToolChange) {
            self.tool = named.unwrap_or(self.waits);
            self.waits = None;
            self.theirs = self.tool.map_or(Length::Unknown, of);
        } else if let Some(named) = named {
            self.waits = named;
        }
        if let Some(row) = nc.word(Role::LengthOffset) {
            self.ours = number(row).map_or(Length::Unknown, of);
            self.theirs = if self.ours == Length::Off { Length::Off } else { self.theirs };
        }
        if nc.has(Op::LengthMinus) {
            self.ours = Length::Unknown;
        }
        if nc.has(Op::LengthOff) {
            (self.ours, self.theirs) = (Length::Off, Length::Off);
        }
        if stmt.site.skip.is_some() {
            self.join(&before);
        }
    }

    /// True if both controls count the same length.
    fn agrees(&self) -> bool {
        self.ours == self.theirs && self.ours != Length::Unknown
    }
}

fn of(number: u32) -> Length {
    if number == 0 { Length::Off } else { Length::Of(number) }
}

fn number(value: &Expr) -> Option<u32> {
    value.constant().filter(|value| *value >= 0.0 && value.fract() == 0.0).map(|value| value as u32)
}

/// True for what says anything of tools and lengths.
fn names_tools(nc: &Nc) -> bool {
    let words = nc.word(Role::Tool).is_some() || nc.word(Role::LengthOffset).is_some();
    words || nc.ops().any(|op| op == Op::ToolChange || op.group() == Group::LengthComp)
}

/// What blocks do; `says` tells the calls that may say something of tools.
struct Rules<'r> {
    says: &'r dyn Fn(&Call) -> bool,
}

impl Analysis for Rules<'_> {
    type State = State;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, State)> {
        cfg.roots().iter().map(|root| (*root, START)).collect()
    }

    fn block(&self, _: BlockId, block: &Block, here: &mut State) {
        block.stmts.iter().for_each(|stmt| here.step(stmt));
        if let TermKind::Call { call, .. } = &block.term.kind
            && (self.says)(call)
        {
            *here = LOST;
        }
    }
}

/// Leaves lengths to the changes of their tools.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let says = |program: &Program| program.blocks.iter().any(block_says);
    let saying: Vec<bool> = module.programs.iter().map(says).collect();
    let names: BTreeMap<ProgramName, usize> =
        module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.clone()?, at))).collect();
    let below = below(module, &names, &saying);
    for (index, program) in module.programs.iter_mut().enumerate().filter(|(index, _)| saying[*index]) {
        if let Some(tool) = loaded(program) {
            begin(program, tool);
            let what = format!(
                "the program takes up the length of tool {tool} and changes to none: T{tool:02} is written at its head, \
                 because on the target only the tool word brings a length. Make sure that tool {tool} is the one to run with"
            );
            context.add(index, Diagnostic::new(Code::Conditional, program.site.span, what));
        }
        let own = has_saying_parts(program);
        let says = |call: &Call| match &call.callee {
            Callee::Program(name) => names.get(name).is_none_or(|callee| below[*callee]),
            Callee::Block(_) => own,
            Callee::Computed(_) | Callee::Cycle(_) => true,
        };
        let states = solve(&Rules { says: &says }, program, &Cfg::of(program));
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let Some(mut state) = states.at(id).copied() else { continue };
            for stmt in &mut block.stmts {
                let before = state;
                state.step(stmt);
                if let Err(what) = settle(stmt, &before, &state) {
                    context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
                }
            }
            let leaves = matches!(block.term.kind, TermKind::Call { .. } | TermKind::Return { .. });
            if leaves && !state.agrees() {
                let span = block.term.site.span;
                context.add_once(index, ELSEWHERE, Diagnostic::new(Code::NoEquivalent, span, ELSEWHERE));
            }
        }
    }
}

fn block_says(block: &Block) -> bool {
    block.stmts.iter().any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if names_tools(nc)))
}

/// The programs that say something of tools, themselves or in what they call.
fn below(module: &Module, names: &BTreeMap<ProgramName, usize>, saying: &[bool]) -> Vec<bool> {
    let mut below = saying.to_vec();
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (index, program) in module.programs.iter().enumerate() {
            let mut calls = program.blocks.iter().flat_map(calls_of);
            let says = calls.any(|call| match &call.callee {
                Callee::Program(name) => names.get(name).is_none_or(|callee| below[*callee]),
                Callee::Block(_) => false,
                Callee::Computed(_) | Callee::Cycle(_) => true,
            });
            changed |= says && !std::mem::replace(&mut below[index], true);
        }
    }
    below
}

/// True if parts of the program are called and any block may be one that says something of tools after its call.
fn has_saying_parts(program: &Program) -> bool {
    let entries: Vec<BlockId> = program.blocks.iter().filter_map(own_call).map(|(entry, ..)| entry).collect();
    let mut blocks = entries.iter().flat_map(|entry| reachable(program, *entry));
    blocks.any(|id| program.block(id).is_some_and(block_says))
}

/// The tool of a main program that takes up the length of one alone, and changes to none.
fn loaded(program: &Program) -> Option<u32> {
    let mut main = reachable(program, BlockId(0)).into_iter().filter_map(|id| program.block(id));
    if main.any(|block| matches!(block.term.kind, TermKind::Return { .. })) {
        return None;
    }
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    let ncs = || {
        stmts.clone().filter_map(|stmt| match &stmt.kind {
            StmtKind::Nc(nc) => Some(nc),
            _ => None,
        })
    };
    if ncs().any(|nc| nc.has(Op::ToolChange) || nc.word(Role::Tool).is_some()) {
        return None;
    }
    let rows: Option<BTreeSet<u32>> =
        ncs().filter_map(|nc| nc.word(Role::LengthOffset)).map(number).collect();
    let mut rows = rows?.into_iter().filter(|row| *row > 0);
    rows.next().filter(|_| rows.next().is_none())
}

/// Changes to a tool at the head of a program.
fn begin(program: &mut Program, tool: u32) {
    let items = vec![NcItem::Op(Op::ToolChange), NcItem::Word(Role::Tool, Expr::Number(f64::from(tool)))];
    let stmt = Stmt { kind: StmtKind::Nc(Nc { items }), site: SourceInfo::default() };
    let term = Terminator { kind: TermKind::Jump(BlockId(1)), site: SourceInfo::default() };
    put_first(program, vec![Block { labels: SmallVec::new(), stmts: vec![stmt], term }]);
}

const ELSEWHERE: &str = "a call or a return between a tool change and the block that takes up the tool's length: on the \
                         target the change brings the length. Take it up before";
const NOT_ITS_OWN: &str = "this takes up a length whose tool the program has not changed to, or has ended the length of: on the \
                           target only the change to a tool brings its length";
const MOVED: &str = "a move along Z between a tool change and the block that takes up the tool's length: on the target the change \
                     brings the length, and the move counts it";
const COMPUTED: &str =
    "the number of the tool is computed, or no tool was named before its change: write the number";

/// Takes out of a block what the change of its tool has done.
fn settle(stmt: &mut Stmt, before: &State, after: &State) -> Result<(), &'static str> {
    let StmtKind::Nc(nc) = &mut stmt.kind else { return Ok(()) };
    let along = nc.moves() && nc.word(Role::Z).is_some();
    let names = names_tools(nc);
    if nc.has(Op::LengthMinus) {
        // Refused as what the target lacks.
        return Ok(());
    }
    if nc.has(Op::ToolChange) {
        let Some(tool) = after.tool else { return Err(COMPUTED) };
        if nc.word(Role::Tool).is_none() {
            nc.items.push(NcItem::Word(Role::Tool, Expr::Number(f64::from(tool))));
        }
    } else {
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Tool, _)));
    }
    let takes = nc.has(Op::LengthPlus) || nc.word(Role::LengthOffset).is_some();
    if takes {
        nc.items.retain(|item| {
            !matches!(item, NcItem::Op(Op::LengthPlus | Op::LengthOff) | NcItem::Word(Role::LengthOffset, _))
        });
        match after.ours {
            Length::Off if nc.has(Op::ToolChange) => return Err(NOT_ITS_OWN),
            Length::Off if before.theirs != Length::Off => nc.items.insert(0, NcItem::Op(Op::LengthOff)),
            Length::Of(_) if after.theirs != after.ours => return Err(NOT_ITS_OWN),
            Length::Unknown | Length::Entry => return Err(NOT_ITS_OWN),
            _ => {}
        }
    } else if nc.has(Op::LengthOff) && before.theirs == Length::Off && stmt.site.skip.is_none() {
        nc.items.retain(|item| *item != NcItem::Op(Op::LengthOff));
    }
    if names && nc.items.is_empty() {
        stmt.kind = StmtKind::Comment;
    }
    if along && !after.agrees() { Err(MOVED) } else { Ok(()) }
}
