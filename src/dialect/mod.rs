//! Facts about controls, as data.
//!
//! A [`Dialect`] is one `dialects/*.toml` file; a [`Control`] is a dialect
//! with a shop's machine profile laid over it, and it is what everything to
//! the right of here asks. No module outside the four of a dialect knows one by
//! name: they ask a [`Control`] whether it has a function, how a state is
//! addressed, which code an operation has.

mod acts;
mod answers;
mod arithmetic;
mod bare_shapes;
mod check;
mod check_codes;
mod check_sources;
mod check_system;
mod control;
mod control_codes;
mod control_system;
mod extend;
mod extends;
mod extents;
mod forbidden;
mod forms;
mod load;
mod machine_places;
mod matrix;
pub mod matters;
mod meeting;
mod model;
mod one_table;
mod origin;
mod overlay;
mod overlay_settings;
mod overlay_variables;
mod page;
mod profile;
mod program_numbers;
mod question_groups;
mod questions;
mod reader;
pub mod registry;
mod row;
mod rows;
mod second_home;
mod signals;
mod site;
mod site_lines;
mod site_rows;
mod spelling;
mod spoken;
mod standing;
mod standing_results;
mod start;
mod stated;
mod stated_groups;
mod table;
#[cfg(test)]
mod tests;
mod turret_word;
mod unconfirmed;
mod variables;
mod wanted;

pub use acts::{Acts, Ends};
pub use answers::Answers;
pub use check::TELLS;
pub use control::{CODE_SYSTEM, Control};
pub use control_codes::{Alias, CodePlace};
pub use extend::Base;
pub use extends::Unreadable;
pub use forbidden::{Clash, Forbidden};
pub use forms::{Compares, Form, LineCounts, Names, Operand, OperandPlace};
pub use load::load;
pub use machine_places::MachinePlaces;
pub use matrix::matrix;
pub use meeting::NoMeeting;
pub use model::*;
pub use one_table::{OneTable, RowKind, TABLE_ROWS};
pub use origin::{Mark, Origin};
pub use page::page;
pub use profile::{
    Axis, DecimalPoint, LineEnds, Machine, Outputs, Plain, Profile, Signal, Units, VariableRun,
};
pub use question_groups::{HALTS, HALTS_ASKED, HALTS_WORDS, QuestionGroup};
pub use questions::Question;
pub use reader::{faults_as_text, faults_of_files};
pub use registry::Entry;
pub use row::Row;
pub use rows::*;
pub use second_home::{HOLE_CLAMP, SECOND_HOME, STEP_LETTERS};
pub use site::{Keeps, SiteCode, Without};
pub use spelling::{Beside, CodeHead, beside_letter, measures};
pub use standing::Standing;
pub use standing_results::StandingResults;
pub use start::{Start, StartMode};
pub use turret_word::{TurretWord, apart as turret_parts};
pub use unconfirmed::{Settled, Side, to_confirm};
pub use variables::{InUse, Matter, SameCells, VariableClass};
