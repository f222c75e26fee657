//! A program from its first block to its last.

mod blocks;

pub use blocks::lower;
