//! What pest makes of the grammar. Its rules do not leave the dialect.
#![allow(missing_docs)]

#[derive(pest_derive::Parser)]
#[grammar = "grammar/cc100.pest"]
pub(super) struct Grammar;
