//! M, S and T alone in a block while a turning, threading or facing pass is in force.
//!
//! Law: a control that makes the pass once more for such a block gets no word. For another target a word of the pass is written beside it; where the
//! target alone makes it once more, G0 stands beside it, and the next block that goes on with the pass tells all its words, as it does after a code
//! for its own block that may take them away. Side condition: the words are numbers, the same on all ways. A block before the first pass of a code
//! repeats nothing. What an empty block does is asked of both. Counter-example: `X40. M8`, which makes a pass on every control.

mod known;

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{BlockId, Module, NcItem, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use known::{Known, Passes, Rules, Word, place_of, runs, switches_alone};

/// True if there are such passes, a table asks what they do, and the target does not need its own ended.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let controls = [context.source, context.target];
    let asks = controls.iter().any(|control| control.behaviour(Question::PassAlone).is_some());
    asks && features.any_op(Op::is_pass) && !cancels(context)
}

/// True if there are such passes, and the target alone makes them once more: what was split off moves must have its own block by then.
pub fn ends(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(Op::is_pass) && cancels(context)
}

fn cancels(context: &Context<'_>) -> bool {
    repeats(context.target) && !repeats(context.source)
}

/// Makes both controls make the same passes, and says what rests on them; true where something was written.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let rules = rules(context);
    let starts = OverCalls::of(module, &Passes { facts: &facts, rules });
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let in_pass = facts.at(index, BlockId(0)).op(Group::Motion).is_some_and(Op::is_pass);
        let rules = Rules { carried: program.returns() && in_pass, ..rules };
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let mut state = facts.at(index, id);
            let mut known = starts.at(index, id).cloned().unwrap_or_default();
            for stmt in &mut block.stmts {
                state.step(stmt);
                let before = known.clone();
                known.step(stmt, &state, rules);
                changed |= Walk { index, rules, context }.stmt(stmt, &state, before);
            }
        }
    }
    changed
}

fn rules(context: &Context<'_>) -> Rules {
    let clears = |control: &Control| answer(control, Question::PassData).map(|value| value == "cleared");
    let (here, there) = (clears(context.source), clears(context.target));
    Rules {
        cancels: cancels(context),
        clears: here == Some(true),
        clears_apart: here != there || here.is_none(),
        carried: false,
        increments: context.features.any_op(|op| op == Op::Incremental),
    }
}

/// True where it is known to make the pass once more.
fn repeats(control: &Control) -> bool {
    answer(control, Question::PassAlone) == Some("repeats")
}

fn answer(control: &Control, question: Question) -> Option<&str> {
    control.behaviour(question).map(|row| &*row.value).filter(|value| *value != "unknown")
}

struct Walk<'w, 'c> {
    index: usize,
    rules: Rules,
    context: &'w mut Context<'c>,
}

impl Walk<'_, '_> {
    /// Looks at a statement, with what is in force after it and what was known before it; true where something was written.
    fn stmt(&mut self, stmt: &mut Stmt, state: &Modal, before: Known) -> bool {
        if is_empty(stmt) {
            if !before.is_untold() && state.op(Group::Motion).is_some_and(Op::is_pass) {
                self.empty(stmt);
            }
            return false;
        }
        let StmtKind::Nc(nc) = &stmt.kind else { return false };
        if nc.ops().any(|op| op.group() == Group::Motion) {
            return false;
        }
        let pass = state.op(Group::Motion);
        let goes_on = runs(nc) && !nc.ops().any(Op::is_for_its_block);
        let without_way =
            goes_on && nc.items.iter().filter_map(|item| place_of(role(item)?)).all(|at| at == 2);
        if without_way && pass.is_some_and(Op::is_pass) {
            self.empty(stmt);
        }
        let StmtKind::Nc(nc) = &stmt.kind else { return false };
        match pass.filter(|op| op.is_pass()) {
            Some(pass) if goes_on => self.go_on(stmt, pass, &before),
            Some(_) if switches_alone(nc) && !before.is_untold() => self.alone(stmt, &before),
            None if pass.is_none() && switches_alone(nc) && before.may_repeat => {
                self.on_some_ways(stmt);
                false
            }
            None if pass.is_none() && goes_on && before.again => {
                self.refuse(stmt, "whether a pass is in force here is not known");
                false
            }
            _ => false,
        }
    }

    /// A block without a word, with F or a taper alone, or with codes that only say how words count.
    fn empty(&mut self, stmt: &Stmt) {
        let (index, span) = (self.index, stmt.site.span);
        self.context.rests_on_source(index, span, Question::PassEmpty);
        self.context.rests_on_target(index, span, Question::PassEmpty);
        self.context.must_agree(index, span, Question::PassEmpty);
    }

    /// M, S or T alone.
    fn alone(&mut self, stmt: &mut Stmt, before: &Known) -> bool {
        let (index, span) = (self.index, stmt.site.span);
        self.context.rests_on_source(index, span, Question::PassAlone);
        self.context.rests_on_target(index, span, Question::PassAlone);
        if before.crossed {
            self.context.rests_on_source(index, span, Question::PassData);
        }
        let StmtKind::Nc(nc) = &mut stmt.kind else { return false };
        if self.rules.cancels && self.rules.carried {
            self.refuse(stmt, "M, S or T alone in a program that is called while a pass is in force: the target makes the pass once more there, and the source is not known to");
            return false;
        }
        if self.rules.cancels {
            let stands = before.again;
            if !stands {
                nc.items.insert(0, NcItem::Op(Op::Rapid));
            }
            return !stands;
        }
        if !repeats(self.context.source) || repeats(self.context.target) {
            self.context.must_agree(index, span, Question::PassAlone);
            return false;
        }
        let shifts = nc.ops().any(|op| op.group() != Group::Spindle && op.group() != Group::Coolant);
        match before.words.iter().find_map(|word| end(word, shifts)) {
            Some(end) => {
                nc.items.push(end);
                self.say(stmt);
                true
            }
            None => {
                self.context.must_agree(index, span, Question::PassAlone);
                false
            }
        }
    }

    /// M, S or T alone, where only some ways come by a pass.
    fn on_some_ways(&mut self, stmt: &Stmt) {
        let (index, span) = (self.index, stmt.site.span);
        self.context.rests_on_source(index, span, Question::PassAlone);
        self.context.rests_on_target(index, span, Question::PassAlone);
        self.context.must_agree(index, span, Question::PassAlone);
    }

    /// A block that goes on with the pass in force.
    fn go_on(&mut self, stmt: &mut Stmt, pass: Op, before: &Known) -> bool {
        let StmtKind::Nc(nc) = &mut stmt.kind else { return false };
        let own: Vec<usize> = nc.items.iter().filter_map(|item| place_of(role(item)?)).collect();
        let others = || (0..before.words.len()).filter(|at| !own.contains(at));
        let whole = others().all(|at| at == 2);
        if before.crossed && !(whole && own.contains(&2)) {
            self.context.rests_on_source(self.index, stmt.site.span, Question::PassData);
        }
        if before.crossed && self.rules.clears && !whole {
            self.refuse(stmt, "a G code for one block (as G28 is) came before this one and cleared X and Z of the pass on the source, and this block does not name both");
            return false;
        }
        if !before.again {
            return false;
        }
        let mut items = vec![NcItem::Op(pass)];
        for at in others() {
            match &before.words[at] {
                Word::None => {}
                Word::Told(item) => items.push(item.clone()),
                Word::Lost => {
                    self.refuse(stmt, "X, Z or R of the pass in force is not known here, and the target needs it again after the M, S or T before");
                    return false;
                }
            }
        }
        items.append(&mut nc.items);
        nc.items = items;
        true
    }

    fn refuse(&mut self, stmt: &Stmt, what: &'static str) {
        let help = "write the code of the pass into this program, with X, Z and its R in one block, and G0 before M, S or T alone";
        self.context
            .add(self.index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help));
    }

    /// Tells that a pass is made which no word of the program names.
    fn say(&mut self, stmt: &Stmt) {
        let what = "the source makes the pass in force once more here; it is written for the target";
        self.context.add(self.index, Diagnostic::new(Code::WrittenOut, stmt.site.span, what));
    }
}

/// True for a block of nothing, of a remark, of its number, of F alone, or of codes that only say how words count.
fn is_empty(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Comment => true,
        StmtKind::Nc(nc) => nc.items.iter().all(|item| match item {
            NcItem::Op(op) => op.only_counts(),
            item => role(item) == Some(Role::Feed),
        }),
        _ => false,
    }
}

fn role(item: &NcItem) -> Option<Role> {
    match item {
        NcItem::Word(role, _) => Some(*role),
        _ => None,
    }
}

/// A word that makes the same pass again; no increment beside what may move the coordinates.
fn end(word: &Word, shifts: bool) -> Option<NcItem> {
    match word {
        Word::Told(item) => {
            let steps = matches!(role(item), Some(Role::StepX | Role::StepZ));
            (!(steps && shifts)).then(|| item.clone())
        }
        _ => None,
    }
}
