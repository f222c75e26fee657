//! Passes, and what runs them.

use super::{branches::Branches, copies::Copies, dead_temps::DeadTemps, fold::Fold};
use super::{retarget::Retarget, unreachable::Unreachable};
use crate::ir::validate::Invalid;
use crate::ir::{Module, validate};

/// How much is changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// Nothing that is not required.
    O0,
    /// What this program itself put in.
    #[default]
    O1,
    /// What people wrote, too.
    O2,
}

/// One rewriting of a module.
pub trait Pass: Sync {
    /// Its name, as it is asked for.
    fn name(&self) -> &'static str;

    /// True where it runs at every level.
    fn is_required(&self) -> bool {
        false
    }

    /// True where it runs at a level.
    fn is_enabled(&self, level: Level) -> bool {
        level >= Level::O1
    }

    /// True where it keeps a module such as the target can say it: it puts no value where a place
    /// for another kind of value was. Only such passes run after legalization.
    fn keeps_legal(&self) -> bool {
        true
    }

    /// Rewrites a module. `level` is at least one that it is enabled at.
    fn run(&self, module: &mut Module, level: Level);
}

/// All passes, in the order in which they run.
pub const PASSES: &[&dyn Pass] = &[&Copies, &Fold, &Retarget, &Branches, &Unreachable, &DeadTemps];

/// Before or behind a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Before it.
    Before,
    /// Behind it.
    After,
}

/// Told of a pass by name, and of the module before or behind it.
pub type Dump<'o> = dyn FnMut(&str, When, &Module) + 'o;

/// How to run the passes.
#[derive(Default)]
pub struct Options<'o> {
    /// How much is changed.
    pub level: Level,
    /// True where the module is legal for its target already and must stay so.
    pub legalized: bool,
    /// Only the first so many of the enabled passes run: finds the culprit.
    pub first: Option<usize>,
    /// The last pass to run, by name.
    pub stop_after: Option<&'o str>,
    /// True to validate behind every pass. Always done in debug builds.
    pub validate: bool,
    /// Told of the module before and behind each pass.
    pub dump: Option<&'o mut Dump<'o>>,
}

/// Why passes did not run to their end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OptError {
    /// A name that no pass has.
    #[error("no pass is named '{name}'; there are {known}")]
    UnknownPass {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// A pass broke the contract of the IR.
    #[error("pass '{pass}' broke the IR: {first}")]
    Broken {
        /// The pass.
        pass: &'static str,
        /// The first breach.
        first: Invalid,
    },
}

/// The pass of a name.
pub fn find(name: &str) -> Result<&'static dyn Pass, OptError> {
    PASSES.iter().copied().find(|pass| pass.name() == name).ok_or_else(|| OptError::UnknownPass {
        name: name.into(),
        known: PASSES.iter().map(|pass| pass.name()).collect::<Vec<_>>().join(", "),
    })
}

/// Runs the passes. Returns the names of those that ran.
pub fn run(module: &mut Module, mut options: Options<'_>) -> Result<Vec<&'static str>, OptError> {
    let last = options.stop_after.map(find).transpose()?.map(Pass::name);
    let mut ran = Vec::new();
    let check = options.validate || cfg!(debug_assertions);
    let level = options.level;
    for pass in PASSES {
        let wanted = pass.is_required() || pass.is_enabled(level);
        if wanted && (pass.keeps_legal() || !options.legalized) {
            if options.first.is_some_and(|first| ran.len() >= first) {
                break;
            }
            let mut dump = |when, module: &Module| {
                if let Some(dump) = &mut options.dump {
                    dump(pass.name(), when, module);
                }
            };
            dump(When::Before, module);
            pass.run(module, level);
            dump(When::After, module);
            ran.push(pass.name());
            if check && let Err(mut all) = validate(module) {
                return Err(OptError::Broken { pass: pass.name(), first: all.swap_remove(0) });
            }
        }
        if last == Some(pass.name()) {
            break;
        }
    }
    Ok(ran)
}
