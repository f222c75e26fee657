//! Long files, chunk by chunk: how they are cut, and how chunks are lowered and converted.

pub(super) mod convert;
pub(super) mod cut;
pub(super) mod lower;
