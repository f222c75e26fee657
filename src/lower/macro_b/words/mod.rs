//! Words: of NC blocks, and as arguments of calls.

mod arguments;
mod bare;
mod beside;
mod named_by;
mod nc;
mod roles;
mod turning;
mod unknown;
mod value;
