//! What the codes and words of a block are, before anything is made of them.

mod block_codes;
mod steps;

pub use block_codes::{Codes, is_code, thousandths, word};
pub use steps::{FIRST_FIXED, LWord, Step, l_word, operand, parametric, program_number, steps};
