//! Calls, repeats and returns that the target can make.

pub(in crate::legalize) mod carried;
pub(in crate::legalize) mod chain;
pub(in crate::legalize) mod link;
pub(in crate::legalize) mod modal_calls;
pub(in crate::legalize) mod modal_off;
pub(in crate::legalize) mod nesting;
pub(in crate::legalize) mod outline;
pub(in crate::legalize) mod repeats;
