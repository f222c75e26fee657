//! A folder of programs as one linked thing.
//!
//! Programs call one another and share variables, so a library is read, linked
//! and converted as a whole: one map of variables and program numbers for all
//! of it, kept in `macroglot.lock` so that the next run makes the same choices.

mod accepted;
mod broken;
mod builders;
mod callees;
mod callers_modes;
mod chunks;
mod code_system;
mod compile;
mod convert;
mod detect;
mod draft;
mod echoes;
mod folders;
mod inputs;
mod kind;
mod line_ends;
mod lock;
mod machine_kind;
mod marks;
mod names;
mod outputs;
mod pairs;
mod partway;
mod places;
mod prepare;
mod project;
mod project_places;
mod publish;
mod refused_calls;
mod selection;
mod stranger;
mod two_paths;
mod understood;
mod unread;
mod verified;
mod walk;
mod withdrawn;

pub use accepted::{
    Answered, Answers, Asked, Chosen, Edit, Entry, Fit, OfPrograms, Question, Scopes, Signer, acceptable,
    answered, asks_any, edited, edits, questions,
};
pub use builders::{WithoutBuilders, without_builders};
pub use callees::linked_files;
pub use code_system::{by_other_systems, is_of_another};
pub use convert::{Conversion, Options, Outcome, ProgramReport, convert, outcome};
pub use detect::{Detected, detect, likeness, looks_like};
pub use folders::Folder;
pub use inputs::{Files, Found, Input, Source, gather, same_file, sources};
pub use kind::{TakenAsLathe, of_library, of_target, settled};
pub use lock::{Lock, LockError};
pub use outputs::{certificate_of, plan, withheld_of};
pub use pairs::{Pairs, with_pairs};
pub use partway::{Partway, partway};
pub use places::{Spots, real_place, slashed};
pub use project::{Allow, Checks, Library, Machine, Project, ProjectError};
pub use project_places::ProjectPlaces;
pub use publish::{
    Change, Held, Home, Kind, Made, Manifest, ManifestError, Outdated, OutputError, Recovered, Told, Wanted,
    abandon, changes, check, is_pending, profiles_of, publish, write_file,
};
pub use refused_calls::{Link, Linked};
pub use stranger::another_library;
pub use understood::{Understood, understood};
pub use unread::{InputError, LeftOut, WhyNot};
pub use verified::{judge, judge_telling};
pub use withdrawn::Certificates;
