//! The IR's own text form: what `macroglot ir` prints and the tests of passes are written in.
//!
//! [`parse`] reads back what [`print()`] writes, numbers bit for bit.
//!
//! ```text
//! name common.500 "LIMIT"                   ; a name that people know a variable by
//! program O9010 file 0 @0..5 "BORE" {       ; site: span, comment
//! block0:
//!     local.1 = 2 * (local.2 + 3) @6..20 N10 skip 1 ^"AHEAD" "BEHIND"
//!     nc motion.linear axis.x=local.1 feed=increments(10) G=local.9
//!     branch all(local.1 eq vacant, not(switch 2)) ? block1 : block2
//! block1 (N20, :LOOP):
//!     call O100 level (1: 2.5, 2: local.3) times 2 -> block2
//! block2:
//!     end rewind
//! }
//! ```
//!
//! A line holds one thing; `;` starts a comment that is not part of the program. A program's
//! name is `O1`, `"NAME"` or `unnamed`. A site follows what it belongs to and is left out
//! where it is the default: `@start..end`, `Nsequence`, `skip level`, then the comments, of which
//! those that stood before the words have a `^`. Variables are `local.1`, `common.100`,
//! `retained.500`, `global.5`, `param.9`, `register.0`, `tmp.3`, `static.2`; with a computed number `#[..]`,
//! `global[..]`, `param[..]`; state is `sys pos.work[1]`. Operators bind as in the makers' texts:
//! `* / mod and` before `+ - or xor`. A minus directly before a number belongs to the number;
//! `-(2)` is the operation.

mod lex;
mod parse;
mod parse_expr;
mod parse_flow;
mod print;
mod print_expr;

pub use print::print;

use super::Module;

/// How deep the parser lets expressions nest; past what the validator allows, so that it can refuse.
const MAX_DEPTH: usize = 280;

/// Why a text is not IR.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct TextError {
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
    /// What was expected.
    pub message: String,
}

/// Reads a module.
pub fn parse(text: &str) -> Result<Module, TextError> {
    parse::module(text)
}

#[cfg(test)]
mod tests;
