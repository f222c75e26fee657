//! What passes work out of each program by itself, on all cores.
//!
//! A pass that looks at a whole library asks most things of one program at a time. It tells what it found when all have been
//! looked at, in the order of programs: findings are the same however many cores there are.

use crate::ir::{Module, Program};
use rayon::prelude::*;

/// What `look` makes of each program of a library and its index, in their order.
pub(super) fn look_at_each<'m, T: Send>(
    module: &'m Module,
    look: impl Fn(usize, &'m Program) -> T + Sync + Send,
) -> Vec<T> {
    look_with(module, || (), |(), index, program| look(index, program))
}

/// As [`look_at_each`], with what `tools` makes, which serves for many programs one after the other.
pub(super) fn look_with<'m, W, T: Send>(
    module: &'m Module,
    tools: impl Fn() -> W + Sync + Send,
    look: impl Fn(&mut W, usize, &'m Program) -> T + Sync + Send,
) -> Vec<T> {
    let programs = module.programs.par_iter().enumerate();
    programs.map_init(tools, |tools, (index, program)| look(tools, index, program)).collect()
}
