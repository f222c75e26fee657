//! The passes, by name.

use super::pass::Pass;
use super::{branches::Branches, copy_propagation::CopyPropagation, dead_stores::DeadStores, fold::Fold};
use super::{nested::Nested, retarget::Retarget, unreachable::Unreachable};
use super::{whole_parts::WholeParts, word_values::WordValues};

/// All passes, in the order in which they run.
pub const PASSES: &[&dyn Pass] = &[
    &WholeParts,
    &Nested,
    &WordValues,
    &CopyPropagation,
    &Fold,
    &Retarget,
    &Branches,
    &Unreachable,
    &DeadStores,
];

/// The pass of a name.
pub fn find(name: &str) -> Option<&'static dyn Pass> {
    PASSES.iter().copied().find(|pass| pass.name() == name)
}
