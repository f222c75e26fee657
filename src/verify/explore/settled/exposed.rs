//! Variables of which a program may read what stood in them at its start.
//!
//! A variable that is written on every way to each of its reads is none. Jumps are followed to their labels until nothing
//! changes; a label that a call or a return may mean, or any where a jump is computed, is come to with nothing written.

use crate::canon::Op;
use crate::dialect::Control;
use crate::syntax::{
    Block, Expr, ExprKind, Index, Item, ItemKind, Label, Target, VarRef, for_each_expr, for_each_item,
};
use crate::verify::sides::name_of;
use std::collections::{BTreeMap, BTreeSet};

/// Passes over a text before nothing is taken to be written.
const PASSES: usize = 24;

/// What is written for sure.
type Written = BTreeSet<String>;

/// Where jumps go.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Number(u32),
    Name(String),
    /// A loop, by the bytes of its head.
    Loop(u32),
}

/// The variables that a program may read before it writes them.
pub(super) fn exposed(blocks: &[Block], control: &Control) -> BTreeSet<String> {
    let mut walk = Walk::new(blocks, control);
    for _ in 0..PASSES {
        if !walk.pass(blocks) {
            return walk.exposed;
        }
    }
    walk.anywhere = true;
    walk.nothing = true;
    walk.pass(blocks);
    walk.exposed
}

struct Walk<'c> {
    /// What is written where a label is come to; none of those that nothing came to yet.
    at: BTreeMap<Key, Written>,
    /// Numbers in words that a call, or a return, may mean.
    in_words: BTreeSet<u32>,
    /// True where any label may be come to.
    anywhere: bool,
    /// True where nothing counts as written: subroutines stand in the text in another order than they run in.
    nothing: bool,
    /// What is written here; none where nothing comes to.
    here: Option<Written>,
    loops: Vec<(u32, Key, Option<Written>)>,
    exposed: BTreeSet<String>,
    changed: bool,
    control: &'c Control,
}

impl<'c> Walk<'c> {
    fn new(blocks: &[Block], control: &'c Control) -> Self {
        let (mut in_words, mut anywhere, mut nothing) = (BTreeSet::new(), false, false);
        // Where subroutines have no end of their own, L is a count and no more.
        let is_called_by_l = control.code_for(Op::SubEnd, &BTreeMap::new()).is_some();
        for block in blocks {
            for_each_item(&block.items, &mut |item| match &item.kind {
                ItemKind::Goto(Target::Computed(_))
                | ItemKind::Branch { target: Target::Computed(_), .. } => {
                    anywhere = true;
                }
                ItemKind::Word(word) => match (word.letter, word.value.as_ref().map(|value| &value.kind)) {
                    ('L', _) => nothing |= is_called_by_l,
                    ('P' | 'Q', Some(ExprKind::Number(number))) => {
                        in_words.insert(number.value as u32);
                    }
                    ('P' | 'Q', _) => anywhere = true,
                    ('G' | 'M', Some(ExprKind::Number(number))) => {
                        let op = control.code(word.letter, number.value, &[]).map(|row| row.op);
                        nothing |= matches!(op, Some(Op::SubEnd | Op::SubAreaEnd));
                    }
                    _ => {}
                },
                _ => {}
            });
        }
        Self {
            at: BTreeMap::new(),
            in_words,
            anywhere,
            nothing,
            here: None,
            loops: Vec::new(),
            exposed: BTreeSet::new(),
            changed: false,
            control,
        }
    }

    /// Goes over the text once. True where a label is come to with less than before.
    fn pass(&mut self, blocks: &[Block]) -> bool {
        (self.here, self.changed) = (Some(Written::new()), false);
        self.exposed.clear();
        self.loops.clear();
        for block in blocks {
            for item in &block.items {
                match &item.kind {
                    ItemKind::Sequence { number, .. } | ItemKind::Label(Label::Number(number)) => {
                        self.come_to(&Key::Number(*number));
                    }
                    ItemKind::Label(Label::Name(name)) => self.come_to(&Key::Name(name.clone())),
                    _ => {}
                }
            }
            // A block that is skipped writes nothing.
            let skipped = block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_)));
            let before = skipped.then(|| self.here.clone());
            block.items.iter().for_each(|item| self.item(item));
            if let Some(before) = before {
                self.here = before;
            }
        }
        self.changed
    }

    fn come_to(&mut self, key: &Key) {
        let anyone = match key {
            Key::Number(number) => self.anywhere || self.in_words.contains(number),
            _ => self.anywhere,
        };
        if anyone {
            self.here = Some(Written::new());
        } else if let Some(there) = self.at.get(key) {
            self.here = Some(match self.here.take() {
                Some(here) => here.intersection(there).cloned().collect(),
                None => there.clone(),
            });
        }
    }

    /// Goes to a label with what is written here.
    fn jump(&mut self, key: Key) {
        let Some(here) = &self.here else { return };
        let joined = match self.at.get(&key) {
            Some(there) => here.intersection(there).cloned().collect(),
            None => here.clone(),
        };
        if self.at.get(&key) != Some(&joined) {
            self.changed = true;
            self.at.insert(key, joined);
        }
    }

    fn jump_to(&mut self, target: &Target) {
        match target {
            Target::Sequence(number) | Target::Label(Label::Number(number)) => {
                self.jump(Key::Number(*number))
            }
            Target::Label(Label::Name(name)) => self.jump(Key::Name(name.clone())),
            Target::Computed(to) => self.read_in(to),
        }
    }

    fn item(&mut self, item: &Item) {
        use ItemKind::*;
        match &item.kind {
            Assign { target, value, .. } => {
                self.read_in(value);
                self.index(target);
                self.write(target);
            }
            If { condition, body, .. } => {
                self.read_in(condition);
                let before = self.here.clone();
                body.iter().for_each(|item| self.item(item));
                self.here = before;
            }
            Do { condition, number } => {
                let key = Key::Loop(item.span.start);
                self.come_to(&key);
                condition.iter().for_each(|condition| self.read_in(condition));
                self.loops.push((*number, key, self.here.clone()));
            }
            End { number } => {
                let at = self.loops.iter().rposition(|(own, ..)| own == number);
                match at.map(|at| self.loops.remove(at)) {
                    Some((_, key, before)) => {
                        self.jump(key);
                        self.here = before;
                    }
                    None => self.here = Some(Written::new()),
                }
            }
            Goto(target) => {
                self.jump_to(target);
                self.here = None;
            }
            Branch { target, .. } => self.jump_to(target),
            Step { target, .. } => {
                self.read(target);
                self.write(target);
            }
            Timer(target) => self.write(target),
            Input { targets, .. } => targets.iter().for_each(|target| self.write(target)),
            _ => {
                let mut all = Vec::new();
                for_each_expr(std::slice::from_ref(item), &mut |e| all.push(e));
                all.into_iter().for_each(|e| self.read_one(e));
                self.named_in(item);
            }
        }
    }

    /// What stands in other statements as a name.
    fn named_in(&mut self, item: &Item) {
        match &item.kind {
            ItemKind::Test(crate::syntax::TestSubject::Variable(variable)) => self.read(variable),
            ItemKind::Transfer { cells, .. } => {
                for cell in cells {
                    if cell.store { self.read(&cell.variable) } else { self.write(&cell.variable) }
                }
            }
            _ => {}
        }
    }

    fn write(&mut self, target: &VarRef) {
        if let (Some(here), Some(name), false) = (&mut self.here, name_of(target, self.control), self.nothing)
        {
            here.insert(name);
        }
    }

    fn read(&mut self, variable: &VarRef) {
        if let (Some(here), Some(name)) = (&self.here, name_of(variable, self.control))
            && !here.contains(&name)
        {
            self.exposed.insert(name);
        }
        self.index(variable);
    }

    fn index(&mut self, variable: &VarRef) {
        if let Index::Computed(index) = &variable.index {
            self.read_in(index);
        }
    }

    fn read_one(&mut self, e: &Expr) {
        if let ExprKind::Variable(variable) = &e.kind {
            self.read(variable);
        }
    }

    fn read_in(&mut self, e: &Expr) {
        // Parsers limit how deep expressions nest.
        match &e.kind {
            ExprKind::Number(_) => {}
            ExprKind::Variable(variable) => self.read(variable),
            ExprKind::Negate(a) | ExprKind::Plus(a) | ExprKind::Not(a) | ExprKind::Group(a) => {
                self.read_in(a)
            }
            ExprKind::Binary(_, operands) => operands.iter().for_each(|a| self.read_in(a)),
            ExprKind::Call { arguments, .. } => arguments.iter().for_each(|a| self.read_in(a)),
        }
    }
}
