//! Branches that nothing but a program's own numbers decides.
//!
//! Whatever the machine or the operator gives it, such a branch goes the ways that one run of the program showed: another way
//! takes an edit of its text. A number that a block writes is the program's own. It is not where a run may pass that block by,
//! or come to it again, for something from outside: all that stands between a jump and its label is taken to be so.

use super::super::alarms::place_in;
use super::exposed::exposed;
use super::{Node, Rests};
use crate::canon::Op;
use crate::control::trace::EventKind;
use crate::control::{ProgramRef, Run};
use crate::dialect::Control;
use crate::syntax::{Block, Expr, ExprKind, Item, ItemKind, Target, for_each_item};
use crate::text::Span;
use crate::verify::sides::{Side, name_of};
use std::collections::BTreeSet;
use std::ops::Range;

/// The conditions in the text of a program that its own numbers decide. `run` is any run of it.
pub fn by_own_numbers(side: &Side<'_>, program: ProgramRef, run: &Run) -> BTreeSet<Span> {
    let from_outside = |what: &EventKind| matches!(what, EventKind::Asked { .. } | EventKind::Outside(_));
    if run.events.iter().any(|event| from_outside(&event.what)) {
        return BTreeSet::new();
    }
    Own::new(side, program).map_or_else(BTreeSet::new, |own| own.conditions())
}

/// A branch of a text.
struct Branch<'t> {
    /// Its block.
    at: usize,
    /// The condition, or the whole item.
    span: Span,
    rests: BTreeSet<Node>,
    does: Does<'t>,
}

enum Does<'t> {
    /// It jumps to a block.
    Jump(usize),
    /// It is done or passed by.
    Items(&'t [Item]),
    /// Blocks that are done again and again.
    Loop(Range<usize>),
}

struct Own<'t> {
    control: &'t Control,
    text: &'t [Block],
    rests: Rests<'t>,
    /// What a variable may hold that was there before.
    free: BTreeSet<String>,
    branches: Vec<Branch<'t>>,
    /// What called programs write, if any of their branches hangs on something from outside.
    called: BTreeSet<String>,
}

impl<'t> Own<'t> {
    /// None of a text that may jump anywhere, or does what nobody knows.
    fn new(side: &'t Side<'_>, program: ProgramRef) -> Option<Self> {
        let control = side.control;
        let mut rests = Rests { modes_are_open: true, ..Rests::new(control) };
        let others: Vec<&[Block]> = side
            .reached(program)
            .into_iter()
            .filter(|other| *other != program)
            .map(|other| side.text(other))
            .collect();
        let text = side.text(program);
        let (mut anywhere, mut free) = (side.links().returns_to_blocks(), BTreeSet::new());
        for text in others.iter().copied().chain([text]) {
            for block in text {
                // What is no part of the library may write anything.
                anywhere |= calls_outside(side, block);
                for_each_item(&block.items, &mut |item| match &item.kind {
                    ItemKind::Skip(_) => {}
                    ItemKind::Goto(Target::Computed(_))
                    | ItemKind::Start(_)
                    | ItemKind::Branch { target: Target::Computed(_), .. } => anywhere = true,
                    ItemKind::Word(word) => {
                        let code = word.value.as_ref().and_then(|value| match &value.kind {
                            ExprKind::Number(number) => control.code(word.letter, number.value, &[]),
                            _ => None,
                        });
                        anywhere |= code.is_some_and(|row| matches!(row.op, Op::Jump | Op::JumpInputOff));
                        rests.word(word);
                    }
                    _ => rests.item(item),
                });
            }
            free.extend(exposed(text, control));
        }
        // What cannot be read may write anything, and a message may ask for a variable.
        if anywhere || rests.is_open {
            return None;
        }
        let mut own = Self { control, text, rests, free, branches: Vec::new(), called: BTreeSet::new() };
        own.branches = own.branches()?;
        let called: Vec<BTreeSet<String>> = others.iter().map(|text| own.written(text)).collect();
        own.called = called.into_iter().flatten().collect();
        Some(own)
    }

    fn conditions(&self) -> BTreeSet<Span> {
        let own = self.branches.iter().filter(|branch| self.is_own(branch));
        own.map(|branch| branch.span).collect()
    }

    /// True if all that a condition hangs on is written in every run, and always the same.
    fn is_own(&self, of: &Branch<'_>) -> bool {
        // What called programs write may hang on what they find.
        let mut open: BTreeSet<String> = self.called.clone();
        let mut taken = BTreeSet::new();
        loop {
            let next = self.branches.iter().enumerate().find(|(at, branch)| {
                !taken.contains(at) && !self.rests.is_closed(&branch.rests, &|name| self.is_free(name, &open))
            });
            let Some((at, branch)) = next else { break };
            taken.insert(at);
            let Some(more) = self.open_by(branch, of.at) else { return false };
            open.extend(more);
        }
        self.rests.is_closed(&of.rests, &|name| self.is_free(name, &open))
    }

    fn is_free(&self, name: &str, open: &BTreeSet<String>) -> bool {
        self.free.contains(name) || open.contains(name)
    }

    /// The variables that hang on which way a branch goes, as a block sees them; none if that cannot be told.
    fn open_by(&self, branch: &Branch<'_>, seen_from: usize) -> Option<BTreeSet<String>> {
        let range = match &branch.does {
            Does::Items(items) => return self.is_told(items).then(|| self.written_by(items)),
            Does::Loop(range) => range.clone(),
            Does::Jump(to) if *to > branch.at => {
                // Runs that go on here passed nothing by.
                if seen_from < *to && !self.comes_back(*to) {
                    return Some(BTreeSet::new());
                }
                branch.at + 1..*to
            }
            Does::Jump(to) => *to..branch.at,
        };
        let between = self.text.get(range)?;
        // From there it may go anywhere.
        let is_open =
            |block: &Block| block.items.iter().any(|item| self.leaves(item)) || !self.is_told(&block.items);
        if between.iter().any(is_open) {
            return None;
        }
        Some(self.written(between))
    }

    /// True if something after a block may jump to what stands before it.
    fn comes_back(&self, at: usize) -> bool {
        self.branches.iter().any(|branch| match &branch.does {
            Does::Jump(to) => branch.at >= at && *to < at,
            Does::Loop(range) => range.start < at && range.end >= at,
            Does::Items(_) => false,
        })
    }

    /// True for a jump, a call or an end.
    fn leaves(&self, item: &Item) -> bool {
        match &item.kind {
            ItemKind::Goto(_) | ItemKind::Branch { .. } => true,
            ItemKind::If { body, .. } => body.iter().any(|item| self.leaves(item)),
            ItemKind::Word(word) => match (word.letter, word.value.as_ref().map(|value| &value.kind)) {
                ('G' | 'M', Some(ExprKind::Number(number))) => {
                    let op = self.control.code(word.letter, number.value, &[]).map(|row| row.op);
                    op.is_none_or(Op::is_flow)
                }
                ('G' | 'M', _) => true,
                _ => false,
            },
            _ => false,
        }
    }

    /// True if the text says which variables these write.
    fn is_told(&self, items: &[Item]) -> bool {
        let mut told = true;
        for_each_item(items, &mut |item| match &item.kind {
            ItemKind::Clear(_) => told = false,
            ItemKind::Assign { target, .. } | ItemKind::Step { target, .. } => {
                told &= name_of(target, self.control).is_some();
            }
            _ => {}
        });
        told
    }

    fn written(&self, blocks: &[Block]) -> BTreeSet<String> {
        blocks.iter().flat_map(|block| self.written_by(&block.items)).collect()
    }

    fn written_by(&self, items: &[Item]) -> BTreeSet<String> {
        let mut all = BTreeSet::new();
        for_each_item(items, &mut |item| {
            if let ItemKind::Assign { target, .. } | ItemKind::Step { target, .. } = &item.kind {
                all.extend(name_of(target, self.control));
            }
        });
        all
    }

    /// All branches of the text; none if one of them jumps to where nothing is.
    fn branches(&self) -> Option<Vec<Branch<'t>>> {
        let mut all = Vec::new();
        for (at, block) in self.text.iter().enumerate() {
            let outside = || BTreeSet::from([Node::Outside]);
            let skipped = block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_)));
            if skipped {
                all.push(Branch { at, span: block.span, rests: outside(), does: Does::Items(&block.items) });
            }
            for item in &block.items {
                match &item.kind {
                    ItemKind::If { condition, body, .. } => {
                        let rests = self.rests_of(condition);
                        let jump = body.iter().find_map(|item| match &item.kind {
                            ItemKind::Goto(to) => Some(to),
                            _ => None,
                        });
                        let does = match jump {
                            Some(to) => Does::Jump(place_in(self.text, to)?),
                            None => Does::Items(body),
                        };
                        all.push(Branch { at, span: condition.span, rests, does });
                    }
                    ItemKind::Do { condition, .. } => {
                        let end = self.end_of(at, item)?;
                        let (span, rests) = match condition {
                            Some(condition) => (condition.span, self.rests_of(condition)),
                            None => (item.span, BTreeSet::new()),
                        };
                        all.push(Branch { at, span, rests, does: Does::Loop(at..end) });
                    }
                    ItemKind::Branch { target, .. } => {
                        let does = Does::Jump(place_in(self.text, target)?);
                        all.push(Branch { at, span: item.span, rests: [Node::Register].into(), does });
                    }
                    ItemKind::Goto(to) => {
                        let rests = if skipped { outside() } else { BTreeSet::new() };
                        all.push(Branch {
                            at,
                            span: item.span,
                            rests,
                            does: Does::Jump(place_in(self.text, to)?),
                        });
                    }
                    _ => {}
                }
            }
        }
        Some(all)
    }

    fn rests_of(&self, condition: &Expr) -> BTreeSet<Node> {
        self.rests.read_in(condition)
    }

    /// The block that ends a loop: the first one after its head with its number.
    fn end_of(&self, at: usize, head: &Item) -> Option<usize> {
        let ItemKind::Do { number, .. } = &head.kind else { return None };
        let is_end = |item: &Item| matches!(&item.kind, ItemKind::End { number: own, .. } if own == number);
        let after = self.text.get(at..)?.iter().position(|block| block.items.iter().any(is_end))?;
        Some(at + after)
    }
}

/// True for a call of a program that the library does not have, or of one that is not named by its number.
fn calls_outside(side: &Side<'_>, block: &Block) -> bool {
    let (mut calls, mut called) = (false, None);
    for_each_item(&block.items, &mut |item| {
        let ItemKind::Word(word) = &item.kind else { return };
        let number = word.value.as_ref().and_then(|value| match &value.kind {
            ExprKind::Number(number) => Some(number.value),
            _ => None,
        });
        match (word.letter, number) {
            ('G' | 'M', Some(number)) => {
                let op = side.control.code(word.letter, number, &[]).map(|row| row.op);
                let ends = [Op::Return, Op::SubEnd, Op::SubAreaEnd, Op::End, Op::EndRewind, Op::CallModalOff];
                let is_call = |op: Op| op.is_flow() && !ends.contains(&op) && op != Op::CallLocal;
                calls |= op.is_some_and(is_call) || side.control.alias(word.letter, number).is_some();
            }
            ('G' | 'M', None) => calls = true,
            ('P', Some(number)) => called = Some(number as u32),
            _ => {}
        }
    });
    // The digits before the last four are how often.
    let is_here =
        |number: u32| [number, number % 10_000].into_iter().any(|number| side.numbered(number).is_some());
    calls && !called.is_some_and(is_here)
}
