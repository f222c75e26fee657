//! Where the jumps of a program go, and what is known where they come from.

use super::known::{Known, Range};
use crate::canon::Op;
use crate::dialect::Control;
use crate::syntax::{Block, Expr, ExprKind, Item, ItemKind, Label, Target, Word, for_each_item};
use std::collections::{BTreeMap, BTreeSet};

/// What is known of variables.
pub(super) type State = BTreeMap<String, Known>;

/// What a jump names.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Sequence(u32),
    Label(Label),
}

/// The jumps of a program.
#[derive(Default)]
pub(super) struct Jumps {
    /// How many jumps name a place.
    to: BTreeMap<Key, usize>,
    /// Numbers in words: a call, or a return to a block, may mean them.
    in_words: BTreeSet<u32>,
    /// True if a jump, or what is called, may come to any place that has a number.
    anywhere: bool,
    /// The jumps that were come by, and what is known at those of them that can be taken.
    seen: BTreeMap<Key, (usize, Option<State>)>,
    /// The places that later jumps lead back to.
    loops: BTreeSet<Key>,
    /// What is supposed to be known at the jumps that lead there.
    supposed: BTreeMap<Key, State>,
    /// True if nothing is supposed, and nothing known at such places.
    forgets: bool,
}

impl Jumps {
    /// `returns` is true where some program returns to a block of its caller.
    pub(super) fn of(blocks: &[Block], control: &Control, returns: bool) -> Self {
        let mut all = Self::default();
        for block in blocks {
            let mut words = false;
            let goes = goes(&block.items, control);
            if let Some(target) = goes.as_ref().and_then(key) {
                *all.to.entry(target).or_default() += 1;
            }
            for_each_item(&block.items, &mut |item| match &item.kind {
                ItemKind::Goto(target) | ItemKind::Branch { target, .. } => match key(target) {
                    Some(key) => *all.to.entry(key).or_default() += 1,
                    None => all.anywhere = true,
                },
                ItemKind::Word(word) => {
                    words = true;
                    match (word.letter, number(word)) {
                        ('P', Some(_)) if goes.is_some() => {}
                        ('P' | 'L', Some(number)) => _ = all.in_words.insert(number as u32),
                        ('P' | 'L', None) => all.anywhere = true,
                        _ => {}
                    }
                }
                _ => {}
            });
            // What is called may return to a block of this program.
            all.anywhere |= returns
                && words
                && goes.is_none()
                && !is_plain(&block.items, control)
                && !is_end(&block.items, control);
        }
        all
    }

    /// What is known where a block begins: `state` if the one before it goes on to it. None in both is a block that nothing
    /// comes to.
    pub(super) fn enter(&mut self, block: &Block, mut state: Option<State>) -> Option<State> {
        for item in &block.items {
            let key = match &item.kind {
                ItemKind::Sequence { number, .. } => Key::Sequence(*number),
                ItemKind::Label(label) => Key::Label(label.clone()),
                _ => continue,
            };
            let anyone = match &key {
                Key::Sequence(number) | Key::Label(Label::Number(number)) => {
                    self.anywhere || self.in_words.contains(number)
                }
                Key::Label(Label::Name(_)) => false,
            };
            let (come_by, joined) = self.seen.get(&key).cloned().unwrap_or_default();
            state = match self.to.get(&key).copied().unwrap_or_default() {
                _ if anyone => Some(State::new()),
                total if come_by < total && self.forgets => Some(State::new()),
                total if come_by < total => {
                    let supposed = self.supposed.get(&key).cloned();
                    self.loops.insert(key);
                    join(join(state, joined), supposed)
                }
                _ => join(state, joined),
            };
        }
        state
    }

    /// True where the jumps that lead back bring no more than was supposed of them.
    pub(super) fn is_settled(&self) -> bool {
        self.loops.iter().all(|key| match (self.supposed.get(key), self.brought(key)) {
            (Some(supposed), Some(brought)) => covers(supposed, brought),
            (_, brought) => brought.is_none(),
        })
    }

    fn brought(&self, key: &Key) -> Option<&State> {
        self.seen.get(key)?.1.as_ref()
    }

    /// The same for another reading, which supposes what the jumps brought.
    pub(super) fn again(mut self) -> Self {
        for key in std::mem::take(&mut self.loops) {
            let old = self.supposed.remove(&key);
            let supposed = match (old, self.brought(&key)) {
                (Some(old), Some(new)) => Some(widened(old, new)),
                (old, new) => old.or_else(|| new.cloned()),
            };
            self.supposed.extend(supposed.map(|supposed| (key, supposed)));
        }
        Self { seen: BTreeMap::new(), ..self }
    }

    /// The same for a reading that knows nothing where a later jump leads back to.
    pub(super) fn without_loops(self) -> Self {
        Self {
            seen: BTreeMap::new(),
            loops: BTreeSet::new(),
            supposed: BTreeMap::new(),
            forgets: true,
            ..self
        }
    }

    /// Comes by a jump; `state` is what is known if it can be taken.
    pub(super) fn jump(&mut self, target: &Target, state: Option<State>) {
        let Some(key) = key(target) else { return };
        let (come_by, joined) = self.seen.remove(&key).unwrap_or_default();
        self.seen.insert(key, (come_by + 1, join(joined, state)));
    }
}

fn key(target: &Target) -> Option<Key> {
    match target {
        Target::Sequence(number) => Some(Key::Sequence(*number)),
        Target::Label(label) => Some(Key::Label(label.clone())),
        Target::Computed(_) => None,
    }
}

/// What holds on both ways.
pub(super) fn join(one: Option<State>, other: Option<State>) -> Option<State> {
    let (one, other) = match (one, other) {
        (Some(one), Some(other)) => (one, other),
        (one, other) => return one.or(other),
    };
    let both = one.into_iter().filter_map(|(name, known)| {
        let joined = match (known, other.get(&name)?) {
            (known, same) if known == *same => known,
            (Known::Number(a), Known::Number(b)) => Known::Number(Range {
                low: a.low.min(b.low),
                high: a.high.max(b.high),
                whole_of: a.whole_of.filter(|of| Some(of) == b.whole_of.as_ref()),
            }),
            _ => return None,
        };
        Some((name, joined))
    });
    Some(both.collect())
}

/// True if everything supposed of the variables also follows from what is known of them.
fn covers(supposed: &State, known: &State) -> bool {
    supposed.iter().all(|(name, supposed)| match (supposed, known.get(name)) {
        (Known::Number(supposed), Some(Known::Number(known))) => supposed.widened(known) == *supposed,
        (supposed, known) => known == Some(supposed),
    })
}

/// What was supposed of variables and still holds: what changes from one reading to the next may change for ever.
fn widened(old: State, new: &State) -> State {
    let both = old.into_iter().filter_map(|(name, known)| {
        let still = match (known, new.get(&name)?) {
            (known, same) if known == *same => known,
            (Known::Number(old), Known::Number(new)) => Known::Number(old.widened(new)),
            _ => return None,
        };
        Some((name, still))
    });
    both.collect()
}

/// The number of a word; none if it is computed, or has none.
fn number(word: &Word) -> Option<f64> {
    match word.value.as_ref().map(bare) {
        Some(ExprKind::Number(number)) => Some(number.value),
        _ => None,
    }
}

fn bare(e: &Expr) -> &ExprKind {
    match &e.kind {
        ExprKind::Group(inner) | ExprKind::Plus(inner) => bare(inner),
        kind => kind,
    }
}

/// True for a block whose words call nothing and go nowhere: its codes are all known, and none of them is of the machine's
/// builder, or a stop, where the operator may set a variable.
pub(super) fn is_plain(items: &[Item], control: &Control) -> bool {
    ops(items, control).all(|op| {
        op.is_some_and(|op| {
            let name = op.to_string();
            let first = name.split('.').next().unwrap_or_default();
            !matches!(first, "call" | "jump" | "sub" | "builder" | "machine" | "modal" | "stop")
                && op != Op::Return
                && !name.ends_with(".other")
        })
    })
}

/// True for a block whose only code that is not plain calls a program with locals of its own, or is one that a profile
/// describes: that one sets common variables at the most.
pub(super) fn keeps_locals(items: &[Item], control: &Control) -> bool {
    use Op::{Act, CallMacro, CallModal, CallModalEach, CallModalOff};
    let keeps = |op: Op| matches!(op, CallMacro | CallModal | CallModalEach | CallModalOff | Act);
    is_plain(items, control) || ops(items, control).all(|op| op.is_some_and(keeps))
}

/// Where a block goes whose code is a jump to a label (`G24 P5`); none for any other.
pub(super) fn goes(items: &[Item], control: &Control) -> Option<Target> {
    if !ops(items, control).eq([Some(Op::Jump)]) {
        return None;
    }
    let label = items.iter().find_map(|item| match &item.kind {
        ItemKind::Word(word) if word.letter == 'P' => number(word),
        _ => None,
    })?;
    Some(Target::Label(Label::Number(label as u32)))
}

/// True for a block that ends the program, if its codes say nothing else.
fn is_end(items: &[Item], control: &Control) -> bool {
    ops(items, control).all(|op| matches!(op, Some(Op::Return)))
}

/// What the codes of a block mean; none for one that is not known.
fn ops<'i>(items: &'i [Item], control: &'i Control) -> impl Iterator<Item = Option<Op>> + 'i {
    items.iter().filter_map(move |item| {
        let ItemKind::Word(word) = &item.kind else { return None };
        let value = number(word);
        // By a parameter it calls a program.
        if value.is_some_and(|value| control.alias(word.letter, value).is_some()) {
            return Some(None);
        }
        match word.letter {
            'G' | 'M' => Some(value.and_then(|value| op_of((word.letter, value), items, control))),
            // A subroutine on some controls.
            'L' => Some(None),
            _ => None,
        }
    })
}

/// What a code means by itself, or beside the other words of its block.
fn op_of((letter, value): (char, f64), items: &[Item], control: &Control) -> Option<Op> {
    let beside = || {
        let words = items.iter().filter_map(|item| match &item.kind {
            ItemKind::Word(word) => Some((word.letter, number(word))),
            _ => None,
        });
        control.code(letter, value, &words.collect::<Vec<_>>())
    };
    control.code(letter, value, &[]).or_else(beside).map(|row| row.op)
}

/// True for what ends the head of a program, whose literals its operator edits: the first branch, or what one leads to.
pub fn ends_head(item: &Item) -> bool {
    use ItemKind::*;
    matches!(item.kind, If { .. } | Do { .. } | End { .. } | Goto(_) | Branch { .. } | Label(_))
}
