//! Words: of NC blocks, and as arguments of calls.

mod arguments;
mod axis_words;
mod bare;
mod nc;
mod roles;
mod turning;
mod unknown;
mod value;
