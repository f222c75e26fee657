//! Cuts a file into the texts of its programs.

use crate::syntax::{Block, Item, ItemKind, ProgramName};

/// The text of one program of a file.
#[derive(Clone, Copy, Debug)]
pub struct ProgramText<'b> {
    /// The name that its first block gives it.
    pub name: Option<&'b ProgramName>,
    /// Its blocks, the naming one included.
    pub blocks: &'b [Block],
}

/// The programs of a file, in order. What stands before the first name is a
/// program without one where it says anything, else it goes with the first program.
pub fn programs(blocks: &[Block]) -> Vec<ProgramText<'_>> {
    let starts = (0..blocks.len()).filter(|&at| blocks.get(at).is_some_and(|block| name_of(block).is_some()));
    let mut starts: Vec<usize> = starts.collect();
    let first = starts.first().copied().unwrap_or(blocks.len());
    let lead = blocks.get(..first).unwrap_or(&[]);
    if lead.iter().flat_map(|block| &block.items).any(says_something) {
        starts.insert(0, 0);
    } else if let Some(first) = starts.first_mut() {
        *first = 0;
    }
    let ends = starts.iter().skip(1).copied().chain([blocks.len()]);
    starts
        .iter()
        .zip(ends)
        .filter_map(|(&start, end)| blocks.get(start..end))
        .map(|blocks| {
            // Only comments stand before the name of the first program.
            let named = blocks.iter().find(|block| block.items.iter().any(says_something));
            ProgramText { name: named.and_then(name_of), blocks }
        })
        .collect()
}

fn name_of(block: &Block) -> Option<&ProgramName> {
    block.items.iter().find_map(|item| match &item.kind {
        ItemKind::Program(name) => Some(name),
        _ => None,
    })
}

/// False for framing, comments and bare sequence numbers.
pub fn says_something(item: &Item) -> bool {
    !matches!(
        item.kind,
        ItemKind::Tape
            | ItemKind::EndOfBlock
            | ItemKind::Comment(_)
            | ItemKind::Skip(_)
            | ItemKind::MacroMark
            | ItemKind::Sequence { .. }
    )
}
