//! Words: of NC blocks, and as arguments of calls.

mod arguments;
mod bare;
mod beside;
mod in_cycle;
mod named_by;
mod nc;
mod roles;
mod turning;
mod twice;
mod unknown;
mod value;
