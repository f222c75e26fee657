//! Passes, and what runs them.

use super::{branches::Branches, copies::Copies, dead_temps::DeadTemps, fold::Fold};
use super::{retarget::Retarget, unreachable::Unreachable};
use crate::ir::analysis::{Summaries, Ways};
use crate::ir::validate::Invalid;
use crate::ir::{Module, Program, Var, validate};
use rayon::prelude::*;
use std::collections::BTreeSet;

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

/// What a program's passes are told of its library, as it was before any of them: they take calls and ways
/// away, and bring none.
#[derive(Debug)]
pub struct Library {
    /// What its programs do to one another's ways.
    pub(super) ways: Ways,
    /// Variables that people have named.
    pub(super) named: BTreeSet<Var>,
    /// What calls write.
    pub(super) summaries: Summaries,
}

impl Library {
    fn of(module: &Module, passes: &[&dyn Pass], level: Level) -> Self {
        let asked = passes.iter().any(|pass| pass.asks_what_calls_write())
            && (level >= Level::O2 || module.programs.iter().any(|p| p.temporaries().next().is_some()));
        Self {
            ways: Ways::of(module),
            named: module.names.keys().copied().collect(),
            summaries: if asked { Summaries::of(module) } else { Summaries::default() },
        }
    }
}

/// One rewriting of a program.
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

    /// True where it looks at what calls write: what programs without temporaries do not need below `-O2`.
    fn asks_what_calls_write(&self) -> bool {
        false
    }

    /// Rewrites a program. `level` is at least one that it is enabled at.
    fn run(&self, program: &mut Program, library: &Library, level: Level);
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

/// Runs one pass on every program.
pub fn apply(pass: &dyn Pass, module: &mut Module, level: Level) {
    let library = Library::of(module, &[pass], level);
    module.programs.iter_mut().for_each(|program| pass.run(program, &library, level));
}

/// Runs the passes. Returns the names of those that ran.
pub fn run(module: &mut Module, mut options: Options<'_>) -> Result<Vec<&'static str>, OptError> {
    let last = options.stop_after.map(find).transpose()?.map(Pass::name);
    let level = options.level;
    let through = PASSES.iter().position(|pass| last == Some(pass.name())).map_or(PASSES.len(), |at| at + 1);
    let wanted = |pass: &&dyn Pass| {
        (pass.is_required() || pass.is_enabled(level)) && (pass.keeps_legal() || !options.legalized)
    };
    let first = options.first.unwrap_or(usize::MAX);
    let passes: Vec<&dyn Pass> = PASSES[..through].iter().copied().filter(wanted).take(first).collect();
    let library = Library::of(module, &passes, level);
    if options.validate || options.dump.is_some() || cfg!(debug_assertions) {
        for pass in &passes {
            let mut dump = |when, module: &Module| {
                if let Some(dump) = &mut options.dump {
                    dump(pass.name(), when, module);
                }
            };
            dump(When::Before, module);
            module.programs.iter_mut().for_each(|program| pass.run(program, &library, level));
            dump(When::After, module);
            if (options.validate || cfg!(debug_assertions))
                && let Err(mut all) = validate(module)
            {
                return Err(OptError::Broken { pass: pass.name(), first: all.swap_remove(0) });
            }
        }
    } else {
        // A program goes through all passes while it is at hand: a library is larger than any cache.
        let all = |program: &mut Program| passes.iter().for_each(|pass| pass.run(program, &library, level));
        match module.programs.as_mut_slice() {
            [program] => all(program),
            programs => programs.par_iter_mut().for_each(all),
        }
    }
    Ok(passes.iter().map(|pass| pass.name()).collect())
}
