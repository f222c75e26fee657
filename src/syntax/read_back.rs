//! Reads back what was written, for its faults alone.

use super::file::{CHUNK, Parser, chunks};
use super::{Block, SyntaxError};
use crate::text::{Lines, Span};
use foldhash::{HashSet, HashSetExt};
use rayon::prelude::*;

/// True for a line that a dialect's parser surely reads without a fault; false where only reading tells.
pub type IsSound = fn(source: &[u8], line: Span) -> bool;

/// Bytes of the longest line that has a likeness.
pub const LONGEST: usize = 64;

/// Writes what a line has in common with those that are as sound as it is; none where the line is too long for it.
pub type Likeness = for<'k> fn(line: &[u8], key: &'k mut [u8; LONGEST]) -> Option<&'k [u8]>;

/// What a dialect knows of lines before they are read whole.
#[derive(Clone, Copy, Debug)]
pub struct Shortcuts {
    /// Knows lines of plain words that have no fault.
    pub is_plain: IsSound,
    /// Knows lines that need not be read whole to see that they have no fault.
    pub is_sound: IsSound,
    /// Lines of one likeness are sound together.
    pub likeness: Likeness,
}

impl Shortcuts {
    /// Every line is read.
    pub const NONE: Self = Self { is_plain: |_, _| false, is_sound: |_, _| false, likeness: |_, _| None };
}

/// Reads lines for their faults. What is written of many programs is half repetition, of loops' ends and the steps of
/// emulated functions, and most of the rest repeats but for its numbers: what is known to be sound is not read again.
#[derive(Debug)]
pub struct ReadLines {
    parser: Parser,
    shortcuts: Shortcuts,
    /// Likenesses of lines that are sound.
    sound: HashSet<Box<[u8]>>,
}

/// Likenesses that are remembered at a time.
const REMEMBERED: usize = 8192;

impl ReadLines {
    /// None yet.
    pub fn new(parser: Parser, shortcuts: Shortcuts) -> Self {
        Self { parser, shortcuts, sound: HashSet::new() }
    }

    /// The faults of a text, in order. A long one is read in parallel.
    pub fn faults(&mut self, source: &[u8]) -> Vec<SyntaxError> {
        if source.len() <= CHUNK {
            return self.faults_within(source, Span::new(0, source.len() as u32));
        }
        let (parser, shortcuts) = (self.parser, self.shortcuts);
        let faults = |chunk| Self::new(parser, shortcuts).faults_within(source, chunk);
        chunks(source).into_par_iter().flat_map_iter(faults).collect()
    }

    fn faults_within(&mut self, source: &[u8], part: Span) -> Vec<SyntaxError> {
        let (mut faults, mut blocks) = (Vec::new(), Vec::<Block>::new());
        for line in Lines::within(source, part).map(|line| line.text) {
            // What is plain is seen faster than remembered, and what is sound faster than read.
            if (self.shortcuts.is_plain)(source, line) || self.is_sound(source, line) {
                continue;
            }
            blocks.clear();
            (self.parser)(source, line, &mut blocks);
            blocks.iter_mut().for_each(|block| faults.append(&mut block.errors));
        }
        faults
    }

    fn is_sound(&mut self, source: &[u8], line: Span) -> bool {
        let mut key = [0; LONGEST];
        let likeness = (self.shortcuts.likeness)(line.of(source), &mut key);
        if likeness.is_some_and(|likeness| self.sound.contains(likeness)) {
            return true;
        }
        let sound = (self.shortcuts.is_sound)(source, line);
        if let Some(likeness) = likeness.filter(|_| sound) {
            if self.sound.len() == REMEMBERED {
                self.sound.clear();
            }
            self.sound.insert(likeness.into());
        }
        sound
    }
}
