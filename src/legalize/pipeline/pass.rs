//! What a pass is, and how one is run.

use crate::ir::{Module, Program};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::opt;

/// One step between lowering and emission.
pub struct Pass {
    /// Its name, by which `macroglot ir --after` and tests ask for it.
    pub name: &'static str,
    /// What it does, in a line.
    pub does: &'static str,
    /// The passes that must have run before it.
    pub needs: &'static [&'static str],
    /// The most that it may change.
    pub changes: Changes,
    /// False if it puts nothing into a library that stood nowhere in it: what was counted before still holds.
    pub(super) brings: bool,
    /// Whether anything in a library concerns it. If not, it would change nothing and say nothing.
    pub(super) concerns: fn(&Features, &Context<'_>) -> bool,
    pub(super) run: Run,
}

/// How far the changes of a pass may go. An analysis holds over a pass that changes nothing it looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Changes {
    /// It only reports.
    Nothing,
    /// Statements and values; blocks, and the ways between them, stay.
    Statements,
    /// Blocks and the ways between them; programs stay.
    Flow,
    /// It may add programs.
    Programs,
}

impl Changes {
    /// What differs between two states of a library.
    pub fn between(before: &Module, after: &Module) -> Self {
        if before.programs.len() != after.programs.len() {
            return Self::Programs;
        }
        if before == after {
            return Self::Nothing;
        }
        let flow = |program: &Program| {
            let ways = |block: &crate::ir::Block| block.term.kind.successors();
            program.blocks.iter().map(ways).collect::<Vec<_>>()
        };
        let same = before.programs.iter().zip(&after.programs).all(|(a, b)| flow(a) == flow(b));
        if same { Self::Statements } else { Self::Flow }
    }
}

impl std::fmt::Display for Changes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Nothing => "nothing",
            Self::Statements => "statements",
            Self::Flow => "flow",
            Self::Programs => "programs",
        })
    }
}

pub(super) enum Run {
    /// Makes each program tidier, by itself.
    Tidies(&'static dyn opt::Pass),
    /// Only has something to say.
    Reports(fn(&Module, &mut Context<'_>)),
    Rewrites(fn(&mut Module, &mut Context<'_>)),
    /// Finds nothing to change in most libraries that concern it; true if it changed anything.
    Edits(fn(&mut Module, &mut Context<'_>) -> bool),
    /// The same, where most programs stay as they are; gives the indexes of those that do not.
    EditsSome(fn(&mut Module, &mut Context<'_>) -> Vec<usize>),
    /// Looks at one program alone, whose index it is given; true if it changed anything.
    Each(fn(&mut Program, usize, &mut Context<'_>) -> bool),
}

impl Pass {
    const fn new(name: &'static str, does: &'static str, run: Run, changes: Changes) -> Self {
        Self { name, does, needs: &[], changes, brings: true, concerns: |_, _| true, run }
    }

    pub(super) const fn tidies(pass: &'static dyn opt::Pass, name: &'static str, does: &'static str) -> Self {
        Self::new(name, does, Run::Tidies(pass), Changes::Flow).brings_nothing()
    }

    pub(super) const fn reports(
        name: &'static str,
        does: &'static str,
        run: fn(&Module, &mut Context<'_>),
    ) -> Self {
        Self::new(name, does, Run::Reports(run), Changes::Nothing)
    }

    pub(super) const fn rewrites(
        name: &'static str,
        does: &'static str,
        run: fn(&mut Module, &mut Context<'_>),
    ) -> Self {
        Self::new(name, does, Run::Rewrites(run), Changes::Statements)
    }

    pub(super) const fn edits(
        name: &'static str,
        does: &'static str,
        run: fn(&mut Module, &mut Context<'_>) -> bool,
    ) -> Self {
        Self::new(name, does, Run::Edits(run), Changes::Statements)
    }

    pub(super) const fn edits_some(
        name: &'static str,
        does: &'static str,
        run: fn(&mut Module, &mut Context<'_>) -> Vec<usize>,
    ) -> Self {
        Self::new(name, does, Run::EditsSome(run), Changes::Statements)
    }

    pub(super) const fn each(
        name: &'static str,
        does: &'static str,
        run: fn(&mut Program, usize, &mut Context<'_>) -> bool,
    ) -> Self {
        Self::new(name, does, Run::Each(run), Changes::Statements)
    }

    /// Runs it only if this says that something concerns it.
    pub(super) const fn when(mut self, concerns: fn(&Features, &Context<'_>) -> bool) -> Self {
        self.concerns = concerns;
        self
    }

    pub(super) const fn needs(mut self, passes: &'static [&'static str]) -> Self {
        self.needs = passes;
        self
    }

    pub(super) const fn changes_flow(mut self) -> Self {
        self.changes = Changes::Flow;
        self
    }

    pub(super) const fn adds_programs(mut self) -> Self {
        self.changes = Changes::Programs;
        self
    }

    pub(super) const fn brings_nothing(mut self) -> Self {
        self.brings = false;
        self
    }

    /// Runs it alone, if anything concerns it.
    pub fn apply(&self, module: &mut Module, context: &mut Context<'_>) {
        context.forget();
        context.count(module);
        if (self.concerns)(&context.features, context) {
            self.run_on(module, context);
        }
    }

    /// Runs it; true if that may have changed the library. Then what was known of it is dropped.
    pub(super) fn run_on(&self, module: &mut Module, context: &mut Context<'_>) -> bool {
        let changed = match self.run {
            // Broken IR shows where it is validated next.
            Run::Tidies(pass) => {
                let _ = opt::run(module, &[pass], context.level);
                true
            }
            Run::Reports(run) => {
                run(module, context);
                false
            }
            Run::Rewrites(run) => {
                run(module, context);
                true
            }
            Run::Edits(run) => run(module, context),
            Run::EditsSome(run) => {
                let changed = run(module, context);
                if !changed.is_empty() {
                    context.forget_some(&changed);
                }
                return !changed.is_empty();
            }
            // Counts what it leaves.
            Run::Each(_) => return each(&[self], module, context),
        };
        if changed {
            context.forget();
        }
        changed
    }
}

/// Takes each program through passes that look at one alone, and counts anew what stands in those that they change; true
/// if they changed anything.
pub(super) fn each(passes: &[&Pass], module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut known = context.take_counted().into_iter();
    let (mut counted, mut any) = (Vec::with_capacity(module.programs.len()), false);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut features = Features::of_known(known.next().flatten(), program);
        for pass in passes {
            let Run::Each(run) = pass.run else { continue };
            if (pass.concerns)(&features, context) && run(program, index, context) {
                (features, any) = (Features::of_program(program), true);
            }
        }
        counted.push(features);
    }
    if any {
        context.forget();
    }
    context.keep_counted(counted);
    any
}
