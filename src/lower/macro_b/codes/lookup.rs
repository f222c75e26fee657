//! The codes of a control, looked up once each.
//!
//! A long program is a few dozen codes a million times over, so what the table says
//! of each is kept by its number.

use crate::dialect::{Alias, CodeHead, CodeMeaning, Control, WordMeaning};
use foldhash::{HashMap, HashMapExt};

/// Index of a code among those met so far.
pub type CodeId = u32;

/// What is known of one code.
#[derive(Debug)]
pub struct Coded<'c> {
    /// Its letter and number.
    pub head: CodeHead,
    /// What it means where no other word counts.
    pub row: Option<&'c CodeMeaning>,
    /// True where words beside it may change what it means.
    pub depends: bool,
    /// The program it calls by the machine profile.
    pub alias: Option<Alias>,
    told: bool,
}

/// The codes met so far.
#[derive(Debug)]
pub struct Codes<'c> {
    control: &'c Control,
    list: Vec<Coded<'c>>,
    /// Whole numbers below 1000 of G and M: the index plus one.
    dense: [Vec<u32>; 2],
    sparse: HashMap<CodeHead, CodeId>,
    /// What the letters A to Z mean by themselves, and whether that was said.
    letters: [(Option<&'c WordMeaning>, bool); 26],
    early: bool,
    numbers: bool,
}

const DENSE: usize = 1000;

impl<'c> Codes<'c> {
    /// None met yet.
    pub fn new(control: &'c Control) -> Self {
        let mut letters = [(None, false); 26];
        for (slot, letter) in letters.iter_mut().zip('A'..='Z') {
            slot.0 = control.word(letter, false);
        }
        let dense = [vec![0; DENSE], vec![0; DENSE]];
        let (list, sparse) = (Vec::new(), HashMap::new());
        Self { control, list, dense, sparse, letters, early: false, numbers: false }
    }

    /// What a letter means by itself.
    pub fn letter(&self, letter: char, comma: bool) -> Option<&'c WordMeaning> {
        if comma {
            return self.control.word(letter, true);
        }
        self.letters.get((letter as usize).wrapping_sub('A' as usize))?.0
    }

    /// True the first time in a program that it is asked of a letter.
    pub fn tell_letter(&mut self, letter: char, comma: bool) -> bool {
        match self.letters.get_mut((letter as usize).wrapping_sub('A' as usize)) {
            Some(slot) if !comma => !std::mem::replace(&mut slot.1, true),
            _ => true,
        }
    }

    /// True the first time in a program that it is asked: what a bare number counts is said once.
    pub fn tell_numbers(&mut self) -> bool {
        !std::mem::replace(&mut self.numbers, true)
    }

    /// The code of a letter and a number; none if the number cannot be one.
    pub fn find(&mut self, letter: char, number: f64) -> Option<CodeId> {
        let plane = usize::from(letter == 'M');
        let whole = number as usize;
        let is_dense = (0.0..DENSE as f64).contains(&number) && whole as f64 == number;
        if is_dense && let Some(&found @ 1..) = self.dense.get(plane).and_then(|codes| codes.get(whole)) {
            return Some(found - 1);
        }
        let head = CodeHead::new(letter, number)?;
        if let Some(&id) = self.sparse.get(&head) {
            return Some(id);
        }
        let id = self.add(head);
        match self.dense.get_mut(plane).and_then(|codes| codes.get_mut(whole)).filter(|_| is_dense) {
            Some(slot) => *slot = id + 1,
            None => {
                self.sparse.insert(head, id);
            }
        }
        Some(id)
    }

    fn add(&mut self, head: CodeHead) -> CodeId {
        let depends = self.control.depends_on_words(head);
        let (letter, number) = (head.letter, head.number());
        self.list.push(Coded {
            head,
            row: self.control.code(letter, number, &[]),
            depends,
            alias: self.control.alias(letter, number),
            told: false,
        });
        self.list.len() as u32 - 1
    }

    /// What is known of a code.
    pub fn get(&self, id: CodeId) -> Option<&Coded<'c>> {
        self.list.get(id as usize)
    }

    /// True the first time in a program that it is asked of a code.
    pub fn tell(&mut self, id: CodeId) -> bool {
        self.list.get_mut(id as usize).is_some_and(|code| !std::mem::replace(&mut code.told, true))
    }

    /// True the first time in a program that it is asked: early reads are said once.
    pub fn tell_early(&mut self) -> bool {
        !std::mem::replace(&mut self.early, true)
    }

    /// A new program begins.
    pub fn forget_told(&mut self) {
        self.early = false;
        self.numbers = false;
        self.letters.iter_mut().for_each(|letter| letter.1 = false);
        self.list.iter_mut().for_each(|code| code.told = false);
    }

    /// True for a program that a code calls by the machine profile.
    pub fn is_alias_target(&self, program: u32) -> bool {
        let by_site = self.control.profile().site.iter().any(|site| site.calls == Some(program));
        by_site
            || self.control.dialect().settings.iter().any(|row| {
                let Some(rule) = row.alias else { return false };
                let Some(at) = program.checked_sub(rule.program) else { return false };
                let stem = row.name.trim_end_matches(|c: char| c.is_ascii_digit());
                let Some(first) = row.name.get(stem.len()..).and_then(|n| n.parse::<u32>().ok()) else {
                    return false;
                };
                let setting = first.saturating_add(at);
                setting <= row.through.unwrap_or(first)
                    && (self.control.setting(&format!("{stem}{setting}")))
                        .is_some_and(|value| value.parse::<f64>().is_ok_and(|code| code != 0.0))
            })
    }
}
