//! IR to IR, tidier: one pass per file, in one ordered list.
//!
//! What operators read stays: a literal assigned at a program's head is an input, and an input
//! stays an input. [`Level::O1`], the default, only tidies what lowering and legalization put in:
//! temporaries, and statements and blocks that no source block stands behind (their site is the
//! default). [`Level::O2`] may change what people wrote, never what it does.
//!
//! Each pass states its law, its side condition and a counter-example to leaving that out.

mod branches;
mod copy_propagation;
mod dead_stores;
mod fold;
mod list;
mod nested;
mod pass;
#[cfg(test)]
mod random;
mod retarget;
mod set_before;
mod unreachable;
mod whole_parts;
mod word_values;

pub use branches::Branches;
pub use copy_propagation::CopyPropagation;
pub use dead_stores::DeadStores;
pub use fold::Fold;
pub use fold::fold;
pub use list::{PASSES, find};
pub use nested::Nested;
pub use pass::{Level, Library, Pass, run};
pub use retarget::Retarget;
pub use unreachable::Unreachable;
pub use whole_parts::WholeParts;
pub use word_values::WordValues;

#[cfg(test)]
mod tests;
