//! NC blocks: assignments, codes, words, and what they do to the flow.

mod block;
mod calls;
mod distance;
mod facts;
mod motion;
mod plane;
mod reading;
mod tidy;
mod value;

pub use plane::name_planes;
