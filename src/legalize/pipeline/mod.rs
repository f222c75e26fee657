//! The way from what lowering yields to what an emitter takes: one list of passes, and what runs them.
//!
//! [`GROUPS`] is the whole of it, in order; `macroglot ir --passes` prints it, and `macroglot ir FILE --to D --after PASS`
//! what the library is after any of them. In checked builds the IR is validated after every pass, and each pass
//! is held to what it says that it changes.

mod cycles;
mod late;
mod lathe;
mod list;
mod moves;
mod pass;
mod source;

pub use list::GROUPS;
pub use pass::{Changes, Pass};

use super::Context;
use super::features::Features;
use crate::CHECKED;
use crate::ir::validate::Invalid;
use crate::ir::{Module, validate};
use crate::opt;
use pass::{Run, each};

/// Passes that stand together because they are about the same thing.
pub struct Group {
    /// Its name; `NAME/PASS` names one of its passes.
    pub name: &'static str,
    /// What its passes are about.
    pub heading: &'static str,
    /// The passes, in the order they run in.
    pub passes: &'static [Pass],
}

/// A pass broke the contract of the IR: a fault of this program.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("pass '{pass}' broke the IR: {first}")]
pub struct Broken {
    /// The pass.
    pub pass: &'static str,
    /// The first breach.
    pub first: Invalid,
}

/// Why a name names no pass.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoPass {
    /// No pass has it.
    #[error("no pass is named '{0}'; `macroglot ir --passes` lists them")]
    Unknown(String),
    /// Two groups have a pass of this name.
    #[error("'{name}' stands in several groups: say {}", .groups.join(" or "))]
    Ambiguous {
        /// The name.
        name: String,
        /// The passes that have it, with their groups.
        groups: Vec<String>,
    },
}

/// All passes with their groups, in the order they run in.
pub fn passes() -> impl Iterator<Item = (&'static Group, &'static Pass)> {
    GROUPS.iter().flat_map(|group| group.passes.iter().map(move |pass| (group, pass)))
}

/// How many passes run up to the one of this name, itself included: `NAME`, or `GROUP/NAME`.
pub fn through(name: &str) -> Result<usize, NoPass> {
    let full = |group: &Group, pass: &Pass| format!("{}/{}", group.name, pass.name);
    let named: Vec<(usize, String)> = passes()
        .enumerate()
        .filter(|(_, (group, pass))| pass.name == name || full(group, pass) == name)
        .map(|(at, (group, pass))| (at, full(group, pass)))
        .collect();
    match named.as_slice() {
        [] => Err(NoPass::Unknown(name.to_owned())),
        [(at, _)] => Ok(at + 1),
        several => {
            let groups = several.iter().map(|(_, full)| format!("'{full}'")).collect();
            Err(NoPass::Ambiguous { name: name.to_owned(), groups })
        }
    }
}

/// Takes a library through all passes.
///
/// # Errors
/// In checked builds, if a pass breaks the contract of the IR.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> Result<(), Broken> {
    run_first(usize::MAX, module, context)
}

/// Takes a library through the first so many passes.
///
/// # Errors
/// As [`run`].
pub fn run_first(count: usize, module: &mut Module, context: &mut Context<'_>) -> Result<(), Broken> {
    let passes: Vec<&Pass> = passes().map(|(_, pass)| pass).take(count).collect();
    context.features = Features::default();
    context.forget();
    let mut fresh = false;
    for passes in passes.chunk_by(|a, b| goes_on(a, b)) {
        let [pass] = passes else {
            run_together(passes, &mut fresh, module, context)?;
            continue;
        };
        // What stood there before may be gone: then the pass finds nothing to do.
        if !fresh && !(pass.concerns)(&context.features, context) {
            context.count(module);
            fresh = true;
        }
        if !(pass.concerns)(&context.features, context) {
            continue;
        }
        let before = CHECKED.then(|| module.clone());
        let changed = pass.run_on(module, context);
        fresh &= !(changed && pass.brings);
        if let Some(before) = before {
            let found = Changes::between(&before, module);
            assert!(found <= pass.changes, "'{}' changes {found}", pass.name);
            assert!(changed || found == Changes::Nothing, "'{}' says that it changed nothing", pass.name);
            if let Err(mut all) = validate(module) {
                return Err(Broken { pass: pass.name, first: all.swap_remove(0) });
            }
        }
    }
    Ok(())
}

/// True if a program goes on from one pass to the next while it is at hand: a library is larger than any
/// cache. In checked builds each pass of legalization is looked at by itself.
fn goes_on(pass: &Pass, next: &Pass) -> bool {
    match (&pass.run, &next.run) {
        (Run::Tidies(_), Run::Tidies(_)) => true,
        (Run::Each(_), Run::Each(_)) => !CHECKED,
        _ => false,
    }
}

/// Runs passes that look at each program by itself.
fn run_together(
    passes: &[&Pass],
    fresh: &mut bool,
    module: &mut Module,
    context: &mut Context<'_>,
) -> Result<(), Broken> {
    let tidy = |pass: &&Pass| if let Run::Tidies(tidy) = pass.run { Some(tidy) } else { None };
    let tidies: Vec<&dyn opt::Pass> = passes.iter().filter_map(tidy).collect();
    if !tidies.is_empty() {
        context.forget();
        return opt::run(module, &tidies, context.level).map_err(|(pass, first)| Broken { pass, first });
    }
    if !*fresh || passes.iter().any(|pass| (pass.concerns)(&context.features, context)) {
        each(passes, module, context);
        *fresh = true;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
