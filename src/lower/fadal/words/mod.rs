//! NC blocks: assignments, codes, words, and what they do to the flow.

mod block;
mod calls;
mod facts;
mod motion;
mod reading;
mod tidy;
mod value;
