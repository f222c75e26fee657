//! Which files go together: a program that is started, with all that it calls.

use crate::ir::analysis::{calls_of, computed_calls::computed_calls};
use crate::ir::{Callee, Module};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// Files that call one another, by index.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// The file that nothing else of the group calls, or the first of some that call one another.
    pub root: usize,
    /// All of them, in order.
    pub files: BTreeSet<usize>,
}

/// The calls between the files of a library.
pub struct Calls {
    callees: Vec<BTreeSet<usize>>,
    callers: Vec<BTreeSet<usize>>,
}

impl Calls {
    /// Of the programs of so many files.
    pub fn of(module: &Module, files: usize) -> Self {
        let mut by_name: BTreeMap<&ProgramName, BTreeSet<usize>> = BTreeMap::new();
        for program in &module.programs {
            if let Some(name) = &program.name {
                by_name.entry(name).or_default().insert(program.file);
            }
        }
        let mut calls = Self { callees: vec![BTreeSet::new(); files], callers: vec![BTreeSet::new(); files] };
        for program in &module.programs {
            for call in program.blocks.iter().flat_map(calls_of) {
                if let Callee::Program(name) = &call.callee {
                    by_name.get(name).into_iter().flatten().for_each(|to| calls.add(program.file, *to));
                }
            }
        }
        for ((program, _), callees) in computed_calls(module) {
            let from = module.programs[program].file;
            callees.programs.iter().for_each(|to| calls.add(from, module.programs[*to].file));
        }
        calls
    }

    fn add(&mut self, from: usize, to: usize) {
        if from != to {
            self.callees[from].insert(to);
            self.callers[to].insert(from);
        }
    }

    /// All files that these call, however far down, and themselves.
    pub fn down(&self, from: impl IntoIterator<Item = usize>) -> BTreeSet<usize> {
        reached(&self.callees, from)
    }

    /// All files that call these, however far up, and themselves.
    pub fn up(&self, from: impl IntoIterator<Item = usize>) -> BTreeSet<usize> {
        reached(&self.callers, from)
    }

    /// The groups that a change of these files touches, each once.
    pub fn groups(&self, changed: &BTreeSet<usize>) -> Vec<Group> {
        let above = self.up(changed.iter().copied());
        let mut groups: Vec<Group> = Vec::new();
        let mut grouped = BTreeSet::new();
        let is_root = |file: &usize| self.callers[*file].is_empty();
        let circles = above.iter().filter(|file| !is_root(file));
        for root in above.iter().filter(|file| is_root(file)).chain(circles) {
            // What nothing outside calls, but for its own callees, is begun at the first of the circle.
            if !is_root(root) && grouped.contains(root) {
                continue;
            }
            let files = self.down([*root]);
            grouped.extend(files.iter().copied());
            groups.push(Group { root: *root, files });
        }
        groups.sort_by_key(|group| group.root);
        groups
    }
}

fn reached(ways: &[BTreeSet<usize>], from: impl IntoIterator<Item = usize>) -> BTreeSet<usize> {
    let mut seen = BTreeSet::new();
    let mut work: Vec<usize> = from.into_iter().collect();
    while let Some(at) = work.pop() {
        if seen.insert(at) {
            work.extend(ways[at].iter().copied());
        }
    }
    seen
}

#[cfg(test)]
impl Calls {
    /// Calls from and to.
    pub fn from_pairs(files: usize, all: &[(usize, usize)]) -> Self {
        let mut calls = Self { callees: vec![BTreeSet::new(); files], callers: vec![BTreeSet::new(); files] };
        all.iter().for_each(|(from, to)| calls.add(*from, *to));
        calls
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(calls: &Calls, changed: &[usize]) -> Vec<(usize, Vec<usize>)> {
        let groups = calls.groups(&changed.iter().copied().collect());
        groups.into_iter().map(|group| (group.root, group.files.into_iter().collect())).collect()
    }

    #[test]
    fn a_change_touches_what_calls_it_with_all_that_this_calls() {
        // 0 and 1 call 2, which calls 3; 1 calls 4; 5 stands alone.
        let calls = Calls::from_pairs(6, &[(0, 2), (1, 2), (2, 3), (1, 4)]);
        assert_eq!(groups(&calls, &[3]), [(0, vec![0, 2, 3]), (1, vec![1, 2, 3, 4])]);
        assert_eq!(groups(&calls, &[4]), [(1, vec![1, 2, 3, 4])]);
        assert_eq!(groups(&calls, &[0]), [(0, vec![0, 2, 3])]);
        assert_eq!(groups(&calls, &[5]), [(5, vec![5])]);
    }

    #[test]
    fn what_calls_itself_is_a_group() {
        let calls = Calls::from_pairs(4, &[(0, 1), (1, 0), (1, 2), (3, 0)]);
        assert_eq!(groups(&calls, &[2]), [(3, vec![0, 1, 2, 3])]);
        let alone = Calls::from_pairs(2, &[(0, 1), (1, 0)]);
        assert_eq!(groups(&alone, &[1]), [(0, vec![0, 1])]);
    }
}
