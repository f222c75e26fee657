//! A folder of programs as one linked thing.
//!
//! Programs call one another and share variables, so a library is read, linked
//! and converted as a whole: one map of variables and program numbers for all
//! of it, kept in `macroglot.lock` so that the next run makes the same choices.

mod callees;
mod convert;
mod detect;
mod draft;
mod inputs;
mod lock;
mod machine_kind;
mod names;
mod outputs;
mod parts;
mod pieces;
mod project;
mod refused_calls;
mod segments;
mod verified;
mod withdrawn;

pub use convert::{Conversion, Options, Outcome, ProgramReport, convert};
pub use detect::{Detected, detect, looks_like};
pub use inputs::{Files, Input, InputError, Source, gather, same_file, sources};
pub use lock::{Lock, LockError};
pub use outputs::{Output, OutputError, certificate_of, plan, withheld_of, write_all};
pub use project::{Library, Machine, Project, ProjectError};
pub use verified::{Certificates, judge};
