//! The parts of a program's text: subroutines at its head, the main part, jump targets.

use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::lower::common::says_something;
use crate::lower::fadal::codes::{Codes, FIRST_FIXED, Step, operand, program_number, steps};
use crate::syntax::{Block, Item, ItemKind, Label, Target, for_each_item};
use foldhash::{HashMap, HashSet, HashSetExt};
use std::collections::BTreeMap;
use std::ops::Range;

/// What a jump looks for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Goal {
    /// A sequence number.
    Sequence(u32),
    /// A label.
    Label(Label),
}

/// A subroutine `L100`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sub {
    /// Its number: 1 for `L100`.
    pub number: u32,
    /// Its blocks, the defining one included.
    pub blocks: Range<usize>,
    /// True where the next subroutine begins after it, not the area's end.
    pub followed: bool,
}

/// The parts of a program's text.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// The subroutines at its head, in order.
    pub subs: Vec<Sub>,
    /// The place of the first subroutine with each number.
    pub numbers: BTreeMap<u32, usize>,
    /// The block that ends their area.
    pub area_end: Option<usize>,
    /// The first block of the main part; 0 where there are no subroutines.
    pub main: usize,
    /// True where a block returns to a caller: others call the program.
    pub returns: bool,
    /// The first block that each jump goal names, and how often it stands.
    pub goals: HashMap<Goal, (usize, usize)>,
    /// The labels of the blocks that jumps go to.
    pub labels: HashMap<usize, Vec<Label>>,
    /// The first blocks of the runs: control enters a block at these only.
    pub leaders: Vec<usize>,
}

/// The goal of a jump with a written target.
pub fn goal(target: &Target) -> Option<Goal> {
    match target {
        Target::Sequence(number) => Some(Goal::Sequence(*number)),
        Target::Label(label) => Some(Goal::Label(label.clone())),
        Target::Computed(_) => None,
    }
}

impl Shape {
    /// Reads the parts of a program.
    pub fn new(blocks: &[Block], control: &Control) -> Self {
        let mut shape = Self::default();
        let mut wanted = HashSet::new();
        let mut leaders = vec![0];
        let mut at_head = true;
        let mut any_sequence = false;
        for (at, block) in blocks.iter().enumerate() {
            let mut flows = false;
            for_each_item(&block.items, &mut |item| match &item.kind {
                ItemKind::Goto(target) => {
                    wanted.extend(goal(target));
                    flows = true;
                }
                ItemKind::Start(_) => flows = true,
                _ => {}
            });
            let codes = Codes::new(&block.items, control);
            let steps = steps(&block.items, &codes);
            let goal = return_goal(&block.items, &codes);
            let computed = returns_computed(&block.items, &codes);
            shape.returns |= goal.is_none() && !computed && steps.contains(&Step::Return);
            wanted.extend(goal);
            any_sequence |= computed;
            flows |= !steps.is_empty();
            if at_head && let Some(number) = defines(&block.items, &steps) {
                shape.numbers.entry(number).or_insert(shape.subs.len());
                shape.subs.push(Sub { number, blocks: at..at + 1, followed: false });
                leaders.push(at);
            }
            if at_head && !shape.subs.is_empty() && steps.contains(&Step::AreaEnd) {
                at_head = false;
                shape.area_end = Some(at);
                shape.main = at + 1;
                leaders.extend([at, at + 1]);
            }
            if flows {
                leaders.push(at + 1);
            }
        }
        shape.close(blocks.len());
        if any_sequence {
            let items = blocks.iter().flat_map(|block| &block.items);
            wanted.extend(items.filter_map(sequence));
        }
        shape.find(blocks, &wanted);
        for (goal, (at, _)) in &shape.goals {
            let label = match goal {
                Goal::Sequence(number) => Label::Number(*number),
                Goal::Label(label) => label.clone(),
            };
            shape.labels.entry(*at).or_default().push(label);
        }
        shape.labels.values_mut().for_each(|labels| labels.sort());
        leaders.extend(shape.goals.values().map(|(at, _)| *at));
        leaders.sort_unstable();
        leaders.dedup();
        leaders.retain(|at| *at < blocks.len());
        shape.leaders = leaders;
        shape
    }

    /// Gives each subroutine its end. Without an end of the area the main part is
    /// what follows the last definition's own end, which is none: it is empty.
    fn close(&mut self, all: usize) {
        let end = self.area_end.unwrap_or(all);
        let mut next = end;
        let mut followed = false;
        for sub in self.subs.iter_mut().rev() {
            sub.followed = followed;
            sub.blocks.end = next;
            next = sub.blocks.start;
            followed = true;
        }
        if self.area_end.is_none() && !self.subs.is_empty() {
            self.main = all;
        }
    }

    fn find(&mut self, blocks: &[Block], wanted: &HashSet<Goal>) {
        if wanted.is_empty() {
            return;
        }
        for (at, block) in blocks.iter().enumerate() {
            for item in &block.items {
                let goal = match &item.kind {
                    ItemKind::Label(label) => Some(Goal::Label(label.clone())),
                    _ => sequence(item),
                };
                let Some(goal) = goal else { continue };
                if wanted.contains(&goal) {
                    self.goals.entry(goal).or_insert((at, 0)).1 += 1;
                }
            }
        }
    }

    /// The place of the subroutine that begins at a block.
    pub fn begins(&self, at: usize) -> Option<usize> {
        self.subs.binary_search_by_key(&at, |sub| sub.blocks.start).ok()
    }

    /// The subroutine that ends before a block.
    pub fn ends(&self, at: usize) -> Option<&Sub> {
        let place = self.subs.binary_search_by_key(&at, |sub| sub.blocks.end).ok()?;
        self.subs.get(place)
    }

    /// The place of the subroutine with this number.
    pub fn sub(&self, number: u32) -> Option<usize> {
        self.numbers.get(&number).copied()
    }

    /// The subroutine that a block stands in; none for the main part.
    pub fn region(&self, at: usize) -> Option<usize> {
        let place = self.subs.partition_point(|sub| sub.blocks.end <= at);
        self.subs.get(place).filter(|sub| sub.blocks.contains(&at)).map(|_| place)
    }
}

/// Where `M99 P10` goes.
pub fn return_goal(items: &[Item], codes: &Codes<'_, '_>) -> Option<Goal> {
    if !codes.has(Op::Return) {
        return None;
    }
    operand(items, codes, Role::Sequence).and_then(program_number).map(Goal::Sequence)
}

/// True for `M99 P+R2`, which goes to the block that the number names.
pub fn returns_computed(items: &[Item], codes: &Codes<'_, '_>) -> bool {
    let to = || operand(items, codes, Role::Sequence);
    codes.has(Op::Return) && to().is_some_and(|to| program_number(to).is_none())
}

/// The goal that a sequence number is.
fn sequence(item: &Item) -> Option<Goal> {
    match item.kind {
        ItemKind::Sequence { number, .. } => Some(Goal::Sequence(number)),
        _ => None,
    }
}

/// The subroutine that a block opens: `L100` with nothing else on it.
fn defines(items: &[Item], steps: &[Step<'_>]) -> Option<u32> {
    let alone = items.iter().filter(|item| says_something(item)).count() == 1;
    match steps {
        [Step::Define(number)] if alone && *number < FIRST_FIXED => Some(*number),
        _ => None,
    }
}
