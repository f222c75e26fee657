//! Sequence numbers: who keeps the one it has, and who gets a new one.
//!
//! A block that is jumped to keeps the number of the source where it is the only one to
//! claim it. Others get a number between those of their neighbours, a multiple of ten where one
//! is free, and no computed jump looks for it ([`super::reach`]). All other numbers stay where people
//! wrote them, unless they would catch a jump that is meant for another block, or for none.

use super::reach::Reach;
use crate::ir::{Block, Program, TermKind};
use crate::syntax::Label;
use foldhash::{HashMap, HashMapExt, HashSet};

/// Tries at one place before another is looked for.
const TRIES: usize = 1000;

/// Where numbers are taken from that have no room between their neighbours.
const SPARE: u32 = 9000;

/// What becomes of a sequence number of the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::emit) enum Standing {
    /// It is written.
    Free,
    /// It is a label of its block, which writes it at its head.
    Label,
    /// It cannot be written, or another block is found by it.
    Barred,
}

/// The sequence numbers of one program.
#[derive(Debug, Default)]
pub(in crate::emit) struct Labels {
    /// By block, and one for the end of the text.
    numbers: Vec<Option<u32>>,
    claimed: HashMap<u32, usize>,
    most: u32,
    reach: Reach,
    /// True where a number was invented.
    invents: bool,
}

impl Labels {
    /// Gives a number to each block of `labelled`. `kept` tells numbers that other programs
    /// return to, `most` is the largest number. Problems are told in words.
    pub fn new(
        program: &Program,
        labelled: &[bool],
        kept: impl Fn(u32) -> bool,
        reach: Reach,
        most: u32,
    ) -> (Self, Vec<String>) {
        let numbers = vec![None; labelled.len()];
        let mut labels = Self { numbers, claimed: HashMap::new(), most, reach, invents: false };
        let mut faults = Vec::new();
        labels.claim_fixed(program, kept, &mut faults);
        let mut owners = labelled.to_vec();
        for &at in labels.claimed.values() {
            if let Some(owns) = owners.get_mut(at) {
                *owns = true;
            }
        }
        for (at, block) in program.blocks.iter().enumerate() {
            if owners.get(at) == Some(&true) {
                labels.keep(at, block);
            }
        }
        let missing: Vec<usize> =
            (0..labelled.len()).filter(|&at| labelled[at] && labels.numbers[at].is_none()).collect();
        if !missing.is_empty() {
            Inventor::new(program, &labels).invent(&mut labels, &missing, &mut faults);
            labels.invents = true;
        }
        (labels, faults)
    }

    /// The number that a block is found by.
    pub fn number(&self, block: usize) -> Option<u32> {
        self.numbers.get(block).copied().flatten()
    }

    /// The number from which on a computed jump must stop before it looks for its block.
    pub fn guard(&self) -> Option<u32> {
        self.reach.floor().filter(|_| self.invents)
    }

    /// True where blocks have numbers that the source does not give them.
    pub fn invents(&self) -> bool {
        self.invents
    }

    /// True where something finds a block by this number.
    pub fn is_claimed(&self, number: u32) -> bool {
        self.claimed.contains_key(&number)
    }

    /// What becomes of a number that stands in a block of the source.
    pub fn standing(&self, number: u32, block: usize) -> Standing {
        if !self.is_valid(number) {
            return Standing::Barred;
        }
        match self.claimed.get(&number) {
            // The source's jump finds nothing there.
            None if self.reach.bars(number) => Standing::Barred,
            None => Standing::Free,
            Some(owner) if *owner == block => Standing::Label,
            Some(_) => Standing::Barred,
        }
    }

    fn is_valid(&self, number: u32) -> bool {
        (1..=self.most).contains(&number)
    }

    /// Numbers that computed jumps and returns find their blocks by.
    fn claim_fixed(&mut self, program: &Program, kept: impl Fn(u32) -> bool, faults: &mut Vec<String>) {
        for block in &program.blocks {
            if let TermKind::Computed { targets, .. } = &block.term.kind {
                for (number, to) in targets {
                    let owner = *self.claimed.entry(*number).or_insert(to.index());
                    if owner != to.index() || !self.is_valid(*number) {
                        faults.push(format!("a computed jump needs the sequence number {number}"));
                    }
                }
            }
        }
        for (at, block) in program.blocks.iter().enumerate() {
            for number in numbers(block).filter(|&number| kept(number)) {
                self.claimed.entry(number).or_insert(at);
                if !self.is_valid(number) {
                    faults.push(format!("a program returns to the sequence number {number}"));
                }
            }
        }
    }

    /// Lets a block keep the number at its head, or one of its labels.
    fn keep(&mut self, at: usize, block: &Block) {
        let head = match block.stmts.first() {
            Some(stmt) => stmt.site.sequence.get(),
            None => block.term.site.sequence.get(),
        };
        let mine = |number: &u32| {
            let owner = self.claimed.get(number);
            self.is_valid(*number) && owner.map_or(!self.reach.bars(*number), |owner| *owner == at)
        };
        if let Some(number) = head.into_iter().chain(numbers(block)).find(mine) {
            self.claimed.insert(number, at);
            self.numbers[at] = Some(number);
        }
    }
}

/// The labels of a block that are numbers.
pub(in crate::emit) fn numbers(block: &Block) -> impl Iterator<Item = u32> {
    block.labels.iter().filter_map(|label| match label {
        Label::Number(number) => Some(*number),
        Label::Name(_) => None,
    })
}

/// The number in a label of a letter and a number, as subroutines have where they are named so.
fn lettered(block: &Block) -> Option<u32> {
    block.labels.iter().find_map(|label| match label {
        Label::Name(name) if name.starts_with(|letter: char| letter.is_ascii_alphabetic()) => {
            name.get(1..)?.parse().ok()
        }
        _ => None,
    })
}

/// The sequence numbers in a block, in order.
fn sequences(block: &Block) -> impl DoubleEndedIterator<Item = u32> {
    block.stmts.iter().map(|stmt| &stmt.site).chain([&block.term.site]).filter_map(|site| site.sequence.get())
}

/// Finds numbers that nobody has.
struct Inventor {
    taken: HashSet<u32>,
    /// By block: the last number in it, and the first number in it or after it.
    last: Vec<Option<u32>>,
    next: Vec<Option<u32>>,
    /// By block: the number in a label like `L100`.
    wishes: Vec<Option<u32>>,
    /// Where to go on when there is no room between neighbours: every tenth number from here, if there is one.
    spare: u32,
    /// And the largest number that may be free when there is none of those.
    top: u32,
}

impl Inventor {
    fn new(program: &Program, labels: &Labels) -> Self {
        let mut taken: HashSet<u32> = labels.claimed.keys().copied().collect();
        let (mut last, mut next) = (Vec::new(), Vec::new());
        for (at, block) in program.blocks.iter().enumerate() {
            taken.extend(sequences(block).chain(numbers(block)));
            let stands = |number: &u32| labels.standing(*number, at) == Standing::Free;
            last.push(sequences(block).rev().find(stands).or(labels.number(at)));
            next.push(labels.number(at).or_else(|| sequences(block).find(stands)));
        }
        last.push(None);
        next.push(None);
        for at in (0..program.blocks.len()).rev() {
            next[at] = next[at].or(next[at + 1]);
        }
        let wishes = program.blocks.iter().map(lettered).collect();
        Self { taken, last, next, wishes, spare: labels.reach.floor().unwrap_or(SPARE), top: labels.most }
    }

    fn invent(mut self, labels: &mut Labels, missing: &[usize], faults: &mut Vec<String>) {
        let mut before = None;
        let mut seen = 0;
        for &at in missing {
            before = self.last.get(seen..at).unwrap_or_default().iter().flatten().last().copied().or(before);
            seen = at;
            let next = self.next.get(at).copied().flatten();
            let wish = self
                .wishes
                .get(at)
                .copied()
                .flatten()
                .filter(|number| labels.is_valid(*number) && !self.taken.contains(number))
                .filter(|number| labels.reach.may_be_invented(*number));
            let Some(number) = wish.or_else(|| self.pick(before.unwrap_or(0), next, labels)) else {
                faults.push("every sequence number is used".into());
                return;
            };
            self.taken.insert(number);
            labels.claimed.insert(number, at);
            labels.numbers[at] = Some(number);
            before = Some(number);
        }
    }

    fn pick(&mut self, before: u32, next: Option<u32>, labels: &Labels) -> Option<u32> {
        let most = labels.most;
        let end = next.unwrap_or(u32::MAX).min(most.saturating_add(1));
        let tens = (before / 10 + 1).saturating_mul(10);
        let free = |number: &u32| !self.taken.contains(number) && labels.reach.may_be_invented(*number);
        let between = (tens..end).step_by(10).take(TRIES).find(free);
        let between = between.or_else(|| (before.saturating_add(1)..end).take(TRIES).find(free));
        // What was found taken stays so: each number is looked at once.
        between.or_else(|| {
            let tenth = (self.spare..=most).step_by(10).find(free);
            let number = tenth.or_else(|| (1..=self.top).rev().find(free));
            match tenth {
                Some(number) => self.spare = number,
                None => (self.spare, self.top) = (most.saturating_add(1), number.unwrap_or(0)),
            }
            number
        })
    }
}
