//! What passes found, in little room.

use crate::diag::Diagnostic;
use foldhash::{HashMap, HashSet};
use std::sync::Arc;

/// Findings, by program of the source.
#[derive(Debug, Default)]
pub(super) struct Findings {
    /// With the program of each, in the order they were found. A list never grows: grown ones take twice the room.
    pub lists: Vec<Vec<(u32, Diagnostic)>>,
    /// By program: the facts that something was said of, by their numbers, in order.
    said: Vec<Vec<u32>>,
    /// The number of each fact that something is said of once.
    facts: HashMap<Box<str>, u32>,
    /// Texts that were said before: a library has few, many times over.
    texts: HashSet<Arc<str>>,
}

/// Findings of the longest lists.
const LIST: usize = 1024;

impl Findings {
    /// None yet, of so many programs.
    pub fn of(programs: usize) -> Self {
        Self { said: vec![Vec::new(); programs], ..Self::default() }
    }

    /// Adds one to a program of the source.
    pub fn add(&mut self, origin: usize, mut diagnostic: Diagnostic) {
        for text in [Some(&mut diagnostic.message), diagnostic.help.as_mut()].into_iter().flatten() {
            match self.texts.get(text) {
                Some(same) => *text = Arc::clone(same),
                None => drop(self.texts.insert(Arc::clone(text))),
            }
        }
        self.push(origin, diagnostic);
    }

    /// Adds one whose texts are shared already.
    pub fn push(&mut self, origin: usize, diagnostic: Diagnostic) {
        if origin >= self.said.len() {
            return;
        }
        let next = (16 << self.lists.len().min(6)).min(LIST);
        match self.lists.last_mut().filter(|list| list.len() < list.capacity()) {
            Some(list) => list.push((origin as u32, diagnostic)),
            None => {
                let mut list = Vec::with_capacity(next);
                list.push((origin as u32, diagnostic));
                self.lists.push(list);
            }
        }
    }

    /// By program.
    pub fn into_all(self) -> Vec<Vec<Diagnostic>> {
        let mut counts = vec![0; self.said.len()];
        self.lists.iter().flatten().for_each(|(origin, _)| counts[*origin as usize] += 1);
        let mut all: Vec<Vec<Diagnostic>> = counts.into_iter().map(Vec::with_capacity).collect();
        for (origin, finding) in self.lists.into_iter().flatten() {
            all[origin as usize].push(finding);
        }
        all
    }

    /// True the first time for a program and a fact.
    pub fn say(&mut self, origin: usize, fact: &str) -> bool {
        let next = self.facts.len() as u32;
        let number = match self.facts.get(fact) {
            Some(number) => *number,
            None => *self.facts.entry(fact.into()).or_insert(next),
        };
        let Some(said) = self.said.get_mut(origin) else { return false };
        let place = said.binary_search(&number);
        place.is_err_and(|place| {
            said.insert(place, number);
            true
        })
    }
}
