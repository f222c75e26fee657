//! Tool lengths, on a control whose tool word brings the length of the tool.
//!
//! Law: a change to tool n brings length n there, and a word of the tool that is in the spindle brings it again where the
//! machine's profile says that it changes nothing; tool 0 ends it. Lengths show in moves along Z alone. So the block that takes
//! up or ends a length has nothing to do by itself, and before the next move along Z the target's length is made what the
//! source's is there. What a program is called with is followed through its callers. Side conditions: the numbers of tools and
//! lengths are constants; a length is taken up with its own tool in the spindle. Where no profile says what a tool word does
//! for the tool in the spindle, the length that a change brings stays until it is ended, and nothing may move along Z while the
//! lengths of the two controls differ, nor may a program that others do not call return. A tool that is made ready is named at
//! its change.
//!
//! A program that nothing in the library calls, takes up one length alone and changes to no tool is run with that tool: a
//! person must look at that. Counter-example: `T1 M6`, `G0 Z5.`, `G43 H1`: on the target Z5 counts the length.

mod again;
mod loaded;
mod radius;

use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls, called};
use crate::ir::analysis::reachable;
use crate::ir::analysis::{Modal, ModalFacts};
use crate::ir::{
    Block, BlockId, Expr, Module, Nc, NcItem, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind,
    Terminator,
};
use crate::legalize::Context;
use crate::legalize::rewrite::put_first;
use thin_vec::{ThinVec, thin_vec};

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
    /// True where both count the same length on every way here.
    same: bool,
}

const START: State =
    State { tool: None, waits: None, ours: Length::Entry, theirs: Length::Entry, same: true };
const LOST: State =
    State { tool: None, waits: None, ours: Length::Unknown, theirs: Length::Unknown, same: false };

impl Lattice for State {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        self.tool = self.tool.filter(|tool| other.tool == Some(*tool));
        self.waits = self.waits.filter(|tool| other.waits == Some(*tool));
        self.same &= other.same;
        for (mine, theirs) in [(&mut self.ours, other.ours), (&mut self.theirs, other.theirs)] {
            if *mine != theirs {
                *mine = Length::Unknown;
            }
        }
        *self != before
    }
}

/// What is put in so that both controls count the same length.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sync {
    /// Tool 0 in the block.
    Off,
    /// The word of this tool in a block of its own before.
    Bring(u32),
}

impl State {
    /// What a block says of tools and lengths.
    fn say(&mut self, nc: &Nc, rules: &Rules<'_>) {
        if names_tools(nc) {
            self.say_names(nc, rules);
            self.same = self.ours == self.theirs && self.ours != Length::Unknown;
        }
    }

    fn say_names(&mut self, nc: &Nc, rules: &Rules<'_>) {
        let named = nc.word(Role::Tool).map(number);
        if nc.has(Op::ToolChange) {
            self.tool = named.unwrap_or(self.waits);
            self.waits = None;
            self.theirs = self.tool.map_or(Length::Unknown, of);
            if rules.change_ends {
                self.ours = Length::Off;
            }
        } else if let Some(named) = named {
            self.waits = named;
        }
        let row = nc.word(Role::LengthOffset);
        if let Some(row) = row {
            self.ours = number(row).map_or(Length::Unknown, of);
        }
        if nc.has(Op::LengthMinus) {
            self.ours = Length::Unknown;
        }
        if nc.has(Op::LengthOff) {
            self.ours = Length::Off;
        }
        if !rules.again && self.ours == Length::Off && (row.is_some() || nc.has(Op::LengthOff)) {
            self.theirs = Length::Off;
        }
    }

    /// Takes a statement, and gives what has to be put in with it. Under a cycle any move goes along Z.
    fn step(&mut self, stmt: &Stmt, modal: &Modal, rules: &Rules<'_>) -> Result<Option<Sync>, &'static str> {
        let StmtKind::Nc(nc) = &stmt.kind else { return Ok(None) };
        let before = *self;
        self.say(nc, rules);
        let drills = modal.op(Group::Cycle).is_some_and(Op::is_cycle);
        let along = nc.moves() && (nc.word(Role::Z).is_some() || drills);
        let found = if along { self.sync(rules) } else { self.taken(nc, rules) };
        if stmt.site.skip.is_some() {
            self.join(&before);
        }
        found
    }

    /// Makes the target count what the source counts.
    fn sync(&mut self, rules: &Rules<'_>) -> Result<Option<Sync>, &'static str> {
        if self.agrees() {
            return Ok(None);
        }
        match self.ours {
            Length::Off if rules.again => {
                (self.theirs, self.same) = (Length::Off, true);
                Ok(Some(Sync::Off))
            }
            Length::Of(row) if rules.again && self.tool == Some(row) => {
                (self.theirs, self.same) = (self.ours, true);
                Ok(Some(Sync::Bring(row)))
            }
            Length::Of(row) if self.tool != Some(row) || self.theirs == Length::Off => Err(NOT_ITS_OWN),
            _ => Err(MOVED),
        }
    }

    /// Where nothing moves a length is taken up by its change alone.
    fn taken(&self, nc: &Nc, rules: &Rules<'_>) -> Result<Option<Sync>, &'static str> {
        let takes = nc.has(Op::LengthPlus) || nc.word(Role::LengthOffset).is_some();
        match self.ours {
            _ if !takes || nc.has(Op::LengthMinus) => Ok(None),
            Length::Off if nc.has(Op::ToolChange) && !rules.again => Err(NOT_ITS_OWN),
            Length::Of(row) if rules.again && self.tool != Some(row) => Err(NOT_ITS_OWN),
            Length::Of(_) if !rules.again && self.theirs != self.ours => Err(NOT_ITS_OWN),
            Length::Unknown | Length::Entry => Err(NOT_ITS_OWN),
            _ => Ok(None),
        }
    }

    /// True if both controls count the same length.
    fn agrees(&self) -> bool {
        self.same
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

/// What is known of both controls, and of the tools that programs are run with.
struct Rules<'r> {
    facts: &'r ModalFacts,
    /// True if a tool word of the tool in the spindle brings its length and changes nothing.
    again: bool,
    /// True if a change ends the length on the source.
    change_ends: bool,
    /// The tool that each program is run with, where that is supposed.
    loaded: &'r [Option<u32>],
}

impl Follow for Rules<'_> {
    type Known = State;

    fn outside(&self, program: usize) -> State {
        let tool = self.loaded.get(program).copied().flatten();
        let theirs = tool.filter(|_| !self.again).map_or(Length::Entry, Length::Of);
        State { tool, theirs, same: theirs == Length::Entry, ..START }
    }

    fn stmts(&self, (program, id): (usize, BlockId), block: &Block, state: &mut State) {
        let mut modal = self.facts.at(program, id);
        for stmt in &block.stmts {
            modal.step(stmt);
            let _ = state.step(stmt, &modal, self);
        }
    }

    fn lose(&self, state: &mut State) {
        *state = LOST;
    }
}

/// Leaves lengths to the changes of their tools.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if !module.programs.iter().any(|program| program.blocks.iter().any(block_says)) {
        return;
    }
    let value = |control: &Control, question| control.behaviour(question).map(|row| row.value.clone());
    let again = value(context.target, Question::ToolWordAgain).as_deref() == Some("skipped");
    let change_ends = value(context.source, Question::ChangeLength).as_deref() == Some("cancelled");
    let called: Vec<bool> = called(module)
        .into_iter()
        .zip(&module.programs)
        .map(|(called, program)| called && program.returns())
        .collect();
    let loaded = loaded::of(module, &called);
    let facts = context.modal_facts(module);
    if again {
        // What is in force does not change: the facts of the ways before hold on the ways that are left.
        again::run(module, &facts, context);
    }
    let rules = Rules { facts: &facts, again, change_ends, loaded: &loaded };
    let states = OverCalls::of(module, &rules);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut computed = Vec::new();
        let main = reachable(program, BlockId(0));
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let Some(mut state) = states.at(index, id).copied() else { continue };
            let mut modal = facts.at(index, id);
            let mut out = Stmts::with_capacity(block.stmts.len() + 1);
            for mut stmt in std::mem::take(&mut block.stmts) {
                modal.step(&stmt);
                let before = state;
                let found = state.step(&stmt, &modal, &rules);
                let result = settle(&mut stmt, (&before, &state), found.unwrap_or_default(), again);
                let result = found.and(result);
                if let Some(nc) = stmt.kind.nc() {
                    radius::ask(nc, state.tool, (index, stmt.site.span), context);
                }
                let tool =
                    stmt.kind.nc().filter(|nc| nc.has(Op::ToolChange)).and_then(|nc| nc.word(Role::Tool));
                computed.extend(tool.filter(|tool| tool.constant().is_none()).map(|_| stmt.site.span));
                match result {
                    Ok(first) => out.extend(first),
                    Err(what) => {
                        let finding = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what);
                        let own = matches!(state.ours, Length::Of(row) if state.tool == Some(row));
                        let waits = own || what == MOVED;
                        let asked = if waits { again::asked(finding, context) } else { finding };
                        context.add_once(index, what, asked);
                    }
                }
                out.push(stmt);
            }
            let leaves = match block.term.kind {
                TermKind::Return { .. } => !called[index] && main.contains(&id),
                TermKind::End { .. } => {
                    again && state.ours == Length::Off && matches!(state.theirs, Length::Of(_))
                }
                _ => false,
            };
            if leaves && !state.agrees() && state != LOST {
                let span = block.term.site.span;
                match state.sync(&rules) {
                    Ok(Some(Sync::Off)) => out.push(word_of(0, span)),
                    Ok(Some(Sync::Bring(tool))) => out.push(word_of(tool, span)),
                    _ => {
                        let finding = Diagnostic::new(Code::NoEquivalent, span, ELSEWHERE);
                        context.add_once(index, ELSEWHERE, again::asked(finding, context));
                    }
                }
            }
            block.stmts = out;
        }
        if let Some(first) = computed.first().copied() {
            let finding = Diagnostic::new(Code::Conditional, first, NUMBERED);
            context.add(index, finding.assuming(Predicate::Tools(computed)));
        }
        if let Some(tool) = loaded[index] {
            if !again {
                begin(program, tool);
            }
            let told = Diagnostic::new(Code::Conditional, program.site.span, LOADED);
            context.add(index, told.assuming(Predicate::Loaded(tool)).asked_once());
        }
    }
}

fn block_says(block: &Block) -> bool {
    block
        .stmts
        .iter()
        .any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if names_tools(nc) || radius::names(nc)))
}

/// The word of a tool in a block of its own.
fn word_of(tool: u32, span: crate::text::Span) -> Stmt {
    let items = match tool {
        0 => vec![NcItem::Op(Op::LengthOff)],
        _ => vec![NcItem::Op(Op::ToolChange), NcItem::Word(Role::Tool, Expr::Number(f64::from(tool)))],
    };
    Stmt { kind: StmtKind::Nc(Nc { items }), site: SourceInfo { span, ..SourceInfo::default() } }
}

/// Changes to a tool at the head of a program.
fn begin(program: &mut Program, tool: u32) {
    let items = vec![NcItem::Op(Op::ToolChange), NcItem::Word(Role::Tool, Expr::Number(f64::from(tool)))];
    let stmt = Stmt { kind: StmtKind::Nc(Nc { items }), site: SourceInfo::default() };
    let term = Terminator { kind: TermKind::Jump(BlockId(1)), site: SourceInfo::default() };
    put_first(program, vec![Block { labels: ThinVec::new(), stmts: thin_vec![stmt], term }]);
}

/// Which tool such programs are run with is a custom of the shop: one answer for all of them.
const LOADED: &str = "a program that takes up the length of one tool, and changes to none, gets the word of that tool before \
                      the length counts, because on the target only the tool word brings one. Make sure that such \
                      programs are run with the tool whose length they name";
const NUMBERED: &str = "the number of this tool is taken to be a whole number, 1 or more: on the target tool 0 ends the length and changes to none";
const ELSEWHERE: &str = "a return between a tool change and the block that takes up the tool's length: on the target the change brings the length. Take it up before";
const NOT_ITS_OWN: &str = "this takes up a length whose tool the program has not changed to, or has ended the length of: on the \
                           target only the change to a tool brings its length";
const MOVED: &str = "a move along Z between a tool change and the block that takes up the tool's length: on the target the change \
                     brings the length, and the move counts it";
const COMPUTED: &str = "no tool was named before this change, or its number was computed in another block: write the number into the \
                        block of the change";

/// Takes out of a block what the change of its tool has done, and puts in what the moves of the block need; what stands
/// before the block.
fn settle(
    stmt: &mut Stmt,
    (before, after): (&State, &State),
    sync: Option<Sync>,
    again: bool,
) -> Result<Option<Stmt>, &'static str> {
    let (span, skipped) = (stmt.site.span, stmt.site.skip.is_some());
    let StmtKind::Nc(nc) = &mut stmt.kind else { return Ok(None) };
    let names = names_tools(nc);
    if nc.has(Op::LengthMinus) {
        // Refused as what the target lacks.
        return Ok(None);
    }
    if nc.has(Op::ToolChange) {
        // A computed number changes to its tool in its own block; which length it brings is not known.
        if after.tool.is_none() && nc.word(Role::Tool).is_none() {
            return Err(COMPUTED);
        }
        if let (Some(tool), None) = (after.tool, nc.word(Role::Tool)) {
            nc.items.push(NcItem::Word(Role::Tool, Expr::Number(f64::from(tool))));
        }
    } else {
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Tool, _)));
    }
    let takes = nc.has(Op::LengthPlus) || nc.word(Role::LengthOffset).is_some();
    if takes || again {
        nc.items.retain(|item| {
            !matches!(item, NcItem::Op(Op::LengthPlus | Op::LengthOff) | NcItem::Word(Role::LengthOffset, _))
        });
    }
    if takes && !again && after.ours == Length::Off && before.theirs != Length::Off {
        nc.items.insert(0, NcItem::Op(Op::LengthOff));
    }
    if !takes && !again && nc.has(Op::LengthOff) && before.theirs == Length::Off && !skipped {
        nc.items.retain(|item| *item != NcItem::Op(Op::LengthOff));
    }
    let mut first = None;
    match sync {
        Some(Sync::Off) if nc.has(Op::ToolChange) => return Err(MOVED),
        Some(Sync::Off) => nc.items.insert(0, NcItem::Op(Op::LengthOff)),
        Some(Sync::Bring(_)) if skipped => return Err(MOVED),
        Some(Sync::Bring(tool)) => first = Some(word_of(tool, span)),
        None => {}
    }
    if names && nc.items.is_empty() {
        stmt.kind = StmtKind::Comment;
    }
    Ok(first)
}
