//! A program: its blocks in order, their statements, and what is seen of the whole.

mod block;
mod remarks;
mod skipped_loop;
mod statement;
mod vacancy;

pub use vacancy::signed_variables;
