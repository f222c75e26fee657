//! Passes, and what runs them.

use crate::CHECKED;
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

    /// True where it keeps a module such as the target can say it: it puts no value where a place
    /// for another kind of value was. Only such passes run after legalization.
    fn keeps_legal(&self) -> bool {
        true
    }

    /// True where it looks at what calls write: what programs without temporaries do not need below `-O2`.
    fn asks_what_calls_write(&self) -> bool {
        false
    }

    /// Rewrites a program, at `level` above [`Level::O0`].
    fn run(&self, program: &mut Program, library: &Library, level: Level);
}

/// Runs passes on every program, each with what the library was before the first of them.
///
/// # Errors
/// In checked builds, the pass that broke the contract of the IR, and its first breach.
pub fn run(module: &mut Module, passes: &[&dyn Pass], level: Level) -> Result<(), (&'static str, Invalid)> {
    if level == Level::O0 {
        return Ok(());
    }
    let library = Library::of(module, passes, level);
    if CHECKED {
        for pass in passes {
            module.programs.iter_mut().for_each(|program| pass.run(program, &library, level));
            validate(module).map_err(|mut all| (pass.name(), all.swap_remove(0)))?;
        }
        return Ok(());
    }
    // A program goes through all passes while it is at hand: a library is larger than any cache.
    let all = |program: &mut Program| passes.iter().for_each(|pass| pass.run(program, &library, level));
    match module.programs.as_mut_slice() {
        [program] => all(program),
        programs => programs.par_iter_mut().for_each(all),
    }
    Ok(())
}
