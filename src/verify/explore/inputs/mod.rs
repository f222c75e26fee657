//! What a program takes from outside: read off its text.

mod both;
mod input;
mod read;
mod reader;
mod solve;

pub use both::inputs_of_both;
pub use input::{Input, Inputs};
pub use read::inputs;
