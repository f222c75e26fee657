//! Tool changes for which no tool was named since the last one.
//!
//! Law: one control takes the tool that is in the spindle again; another, with an arm, the one that waits, which is the tool that
//! the last change put back; a third stops. Where both are known to do the same all stays. Else the tool that the source takes is named at
//! the change, where the text says it. Side conditions: on all ways there it is the same number; no stop, no code of a builder and nothing
//! that the library does not have stands between, for a tool may be changed there; nothing reads the last tool word. Where the tool is not known, what the machines
//! do is asked, or the program is refused. A program that returns and that nothing of the library calls is taken to have a tool named.
//! Counter-example: `T2`, `M6`, where tool 2 waits.

use super::shop::are_mills;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::analysis::calls_of;
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::analysis::tool_word::ToolWord;
use crate::ir::{Block, BlockId, Callee, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::offsets::tools_at_change::reads_word;
use crate::text::Span;

const QUESTION: Question = Question::ChangeWithoutTool;

/// True if the library changes tools, between two mills that do it by a code.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let by_code = |control: &Control| {
        let row = control.behaviour(Question::ToolChangeWord);
        row.is_some_and(|row| row.value == "m6") && control.behaviour(QUESTION).is_some()
    };
    are_mills(context) && features.op(Op::ToolChange) && by_code(context.source) && by_code(context.target)
}

/// What the two controls do.
#[derive(Clone, Copy)]
enum Answers<'a> {
    /// Nothing is to be done: both do the same, or the source stops.
    Agree,
    /// The source, or the target, says nothing of it.
    Open(&'a Control, Side),
    Differ(&'a str, &'a str),
}

fn answer(control: &Control) -> &str {
    control.behaviour(QUESTION).map_or("unknown", |row| row.value.as_str())
}

impl<'a> Answers<'a> {
    fn of(source: &'a Control, target: &'a Control) -> Self {
        match (answer(source), answer(target)) {
            ("alarm", _) => Self::Agree,
            ("unknown", _) => Self::Open(source, Side::Source),
            (_, "unknown") => Self::Open(target, Side::Target),
            (ours, theirs) if ours == theirs => Self::Agree,
            (ours, theirs) => Self::Differ(ours, theirs),
        }
    }
}

/// Names the tools of such changes, or says what they rest on; true if it named one.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let (source, target) = (context.source, context.target);
    let answers = Answers::of(source, target);
    if matches!(answers, Answers::Agree) {
        return false;
    }
    let facts = context.modal_facts(module);
    let mut found = Vec::new();
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for (at, stmt) in block.stmts.iter().enumerate() {
                let none = match state.tool_word {
                    ToolWord::Changed => true,
                    ToolWord::Begun => !program.returns(),
                    ToolWord::Unknown | ToolWord::Waits => false,
                };
                if none && stmt.kind.nc().is_some_and(is_bare) {
                    found.push((index, id, at));
                }
                state.step(stmt);
            }
        }
    }
    if found.is_empty() {
        return false;
    }
    let again = match answer(source) {
        _ if !is_followed(module) || shows_word(module) => None,
        "same" => Some(true),
        "pot" => Some(false),
        _ => None,
    };
    let called = || module.programs.iter().map(Program::returns).collect();
    let known = again.map(|same| {
        let rules = Rules { same, called: called() };
        let known = OverCalls::of(module, &rules);
        (rules, known)
    });
    let mut named = Vec::new();
    for (index, id, at) in found {
        let Some(block) = module.programs.get(index).and_then(|program| program.block(id)) else { continue };
        let tool = known.as_ref().and_then(|(rules, known)| {
            let mut tools = *known.at(index, id)?;
            rules.enter((index, id), &mut tools);
            block.stmts.iter().take(at).for_each(|stmt| tools.step(stmt, rules.same));
            if rules.same { tools.spindle } else { tools.back }
        });
        match tool {
            Some(tool) => named.push((index, id, at, tool)),
            None => {
                told(index, block.stmts.get(at).map_or_else(Span::default, |s| s.site.span), answers, context)
            }
        }
    }
    let any = !named.is_empty();
    for (index, id, at, tool) in named {
        let block = module.programs.get_mut(index).and_then(|program| program.blocks.get_mut(id.index()));
        let Some(stmt) = block.and_then(|block| block.stmts.get_mut(at)) else { continue };
        if let StmtKind::Nc(nc) = &mut stmt.kind {
            nc.items.insert(0, NcItem::Word(Role::Tool, Expr::Number(tool)));
        }
    }
    any
}

/// True for a change without a tool in its block.
fn is_bare(nc: &Nc) -> bool {
    nc.has(Op::ToolChange) && nc.word(Role::Tool).is_none()
}

/// True if all calls are followed: none is computed, and none is made by moves.
fn is_followed(module: &Module) -> bool {
    module.programs.iter().flat_map(|program| &program.blocks).all(|block| {
        !block.stmts.iter().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)))
            && !calls_of(block).any(|call| matches!(call.callee, Callee::Computed(_)))
    })
}

/// True if something reads the last tool word, which a tool that is named would change.
fn shows_word(module: &Module) -> bool {
    let mut found = false;
    for block in module.programs.iter().flat_map(|program| &program.blocks) {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut |e| found |= reads_word(e)));
        block.term.kind.exprs(&mut |e| found |= reads_word(e));
    }
    found
}

/// The tools of the machine, as far as they are one constant each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Tools {
    spindle: Option<f64>,
    /// The one that the last change put back.
    back: Option<f64>,
    /// The one that was named since the last change.
    ready: Option<f64>,
    /// True if one may have been named since the last change, or none was changed yet.
    may_be_named: bool,
}

impl Lattice for Tools {
    fn join(&mut self, other: &Self) -> bool {
        let both = |one: Option<f64>, two: Option<f64>| one.filter(|_| one == two);
        let joined = Self {
            spindle: both(self.spindle, other.spindle),
            back: both(self.back, other.back),
            ready: both(self.ready, other.ready),
            may_be_named: self.may_be_named || other.may_be_named,
        };
        std::mem::replace(self, joined) != joined
    }
}

impl Tools {
    const UNKNOWN: Self = Self { spindle: None, back: None, ready: None, may_be_named: true };

    fn step(&mut self, stmt: &Stmt, same: bool) {
        let before = *self;
        match &stmt.kind {
            StmtKind::Nc(nc) => self.block(nc, same),
            StmtKind::Comment | StmtKind::Assign { .. } => {}
            _ => *self = Self::UNKNOWN,
        }
        if stmt.site.skip.is_some() {
            self.join(&before);
        }
    }

    fn block(&mut self, nc: &Nc, same: bool) {
        if let Some(tool) = nc.word(Role::Tool) {
            (self.ready, self.may_be_named) = (tool.constant(), true);
        }
        if nc.has(Op::ToolChange) {
            let taken = match (self.may_be_named, same) {
                (true, _) => self.ready,
                (false, true) => self.spindle,
                (false, false) => self.back,
            };
            *self = Self { spindle: taken, back: self.spindle, ready: None, may_be_named: false };
        }
        if nc.items.iter().any(may_change) {
            *self = Self::UNKNOWN;
        }
    }
}

/// True for what may change the tool, or where a person may.
fn may_change(item: &NcItem) -> bool {
    match item {
        NcItem::Op(op) => matches!(op, Op::Stop | Op::OptionalStop | Op::MachineSpecific | Op::Act),
        NcItem::Code(..) => true,
        NcItem::Word(..) => false,
    }
}

struct Rules {
    /// A change without a tool takes the one in the spindle; else the one that was put back.
    same: bool,
    /// By program, whether it returns: something else than the library may call it too.
    called: Vec<bool>,
}

impl Rules {
    fn enter(&self, (program, id): (usize, BlockId), tools: &mut Tools) {
        if id == BlockId(0) && self.called.get(program) == Some(&true) {
            *tools = Tools::UNKNOWN;
        }
    }
}

impl Follow for Rules {
    type Known = Tools;

    fn outside(&self, _: usize) -> Tools {
        Tools::UNKNOWN
    }

    fn stmts(&self, place: (usize, BlockId), block: &Block, known: &mut Tools) {
        self.enter(place, known);
        block.stmts.iter().for_each(|stmt| known.step(stmt, self.same));
    }

    fn lose(&self, known: &mut Tools) {
        *known = Tools::UNKNOWN;
    }
}

/// Says what a change without a tool rests on.
fn told(index: usize, span: Span, answers: Answers<'_>, context: &mut Context<'_>) {
    let finding = match answers {
        Answers::Agree => return,
        Answers::Open(control, side) => Diagnostic::new(Code::Conditional, span, OPEN)
            .with_help(format!(
                "write T with its number into the block; or {}",
                control.to_settle(QUESTION.fact(), side)
            ))
            .with_fact(QUESTION.fact()),
        Answers::Differ(ours, theirs) => {
            let what = format!("{DIFFER}: {} on the source, {} on the target", does(ours), does(theirs));
            Diagnostic::new(Code::NoEquivalent, span, what).with_help(UNKNOWN_TOOL)
        }
    };
    context.add_once(index, OPEN, finding);
}

/// What an answer says, in words.
fn does(answer: &str) -> &'static str {
    match answer {
        "same" => "it takes the tool that is in the spindle",
        "pot" => "it takes the tool that the last change put back",
        _ => "it is an alarm",
    }
}

const OPEN: &str = "a tool is changed here, and no T was named since the last change: what that does is not known of one of the two \
                    machines";

const DIFFER: &str = "a tool is changed here, and no T was named since the last change";

const UNKNOWN_TOOL: &str =
    "which tool that is, the text does not say: write T with its number into the block";
