//! Labels: a block that something jumps to has a name of its own.
//!
//! A block keeps the name that it has on the source, or gets one from its number: `N10` becomes `:N10`. No jump here
//! can be computed, so a name catches nothing that is not meant for it.

use crate::ir::Program;
use crate::syntax::Label;
use std::collections::BTreeSet;

/// The labels of one program.
#[derive(Debug, Default)]
pub(super) struct Labels {
    /// By block, and one for the end of the text.
    names: Vec<Option<String>>,
}

impl Labels {
    /// Gives a label to each block of `labelled`.
    pub fn new(program: &Program, labelled: &[bool]) -> Self {
        let mut taken = BTreeSet::new();
        let mut names = vec![None; labelled.len()];
        for (at, block) in
            program.blocks.iter().enumerate().filter(|(at, _)| labelled.get(*at) == Some(&true))
        {
            names[at] = block.labels.iter().filter_map(name).find(|name| taken.insert(name.clone()));
        }
        let mut next = 1..;
        for (at, needed) in labelled.iter().enumerate() {
            if *needed && names[at].is_none() {
                let mut free = next.by_ref().map(|number: u32| format!("L{number}"));
                names[at] = free.find(|name| taken.insert(name.clone()));
            }
        }
        Self { names }
    }

    /// The label that a block is found by.
    pub fn of(&self, block: usize) -> Option<&str> {
        self.names.get(block)?.as_deref()
    }
}

/// A label as it is written here, if it can be: letters and digits (seed 000:596).
fn name(label: &Label) -> Option<String> {
    match label {
        Label::Number(number) => Some(format!("N{number}")),
        Label::Name(name) => {
            let name = name.trim_start_matches([':', '$']).to_ascii_uppercase();
            let fits = name.bytes().all(|byte| byte.is_ascii_alphanumeric()) && (1..=8).contains(&name.len());
            let number = name.starts_with(|first: char| first.is_ascii_digit());
            fits.then(|| if number { format!("N{name}") } else { name })
        }
    }
}
