//! What a cycle of a lathe takes besides the words of its block: from a block before it, or from settings of the control.

use crate::canon::{Op, Role};
use crate::dialect::{CodeMeaning, Control};
use crate::ir::{Expr, Nc, NcItem};
use crate::legalize::features::Features;

/// A cycle, the block that sets what it takes, and what that is.
pub struct Kind {
    /// The operation of the block that sets it.
    pub setup: Op,
    /// The operation of the block that runs.
    pub cycle: Op,
    /// What is set.
    pub roles: &'static [Role],
}

/// All of them.
pub const KINDS: [Kind; 6] = [
    Kind { setup: Op::TurningSetup, cycle: Op::RoughTurning, roles: &[Role::CutDepth, Role::CutRetract] },
    Kind { setup: Op::FacingSetup, cycle: Op::RoughFacing, roles: &[Role::CutDepth, Role::CutRetract] },
    Kind {
        setup: Op::PatternSetup,
        cycle: Op::Pattern,
        roles: &[Role::PatternX, Role::PatternZ, Role::Passes],
    },
    Kind { setup: Op::FaceGrooveSetup, cycle: Op::FaceGroove, roles: &[Role::CutRetract] },
    Kind { setup: Op::GrooveSetup, cycle: Op::Groove, roles: &[Role::CutRetract] },
    Kind {
        setup: Op::ThreadingSetup,
        cycle: Op::Threading,
        roles: &[
            Role::ThreadForm,
            Role::ThreadLeast,
            Role::ThreadAllowance,
            Role::ThreadFinishes,
            Role::ThreadRunOut,
            Role::ThreadAngle,
            Role::ThreadInfeed,
        ],
    },
];

impl Kind {
    /// The kind that an operation runs.
    pub fn of_cycle(op: Op) -> Option<&'static Kind> {
        KINDS.iter().find(|kind| kind.cycle == op)
    }

    /// The kind that an operation sets something of.
    pub fn of_setup(op: Op) -> Option<&'static Kind> {
        KINDS.iter().find(|kind| kind.setup == op)
    }
}

/// The code that a control writes for an operation.
pub fn row(control: &Control, op: Op) -> Option<&CodeMeaning> {
    control.dialect().codes.iter().find(|row| row.preferred && row.op == op)
}

/// True where the code of an operation has a letter for a role.
pub fn takes(control: &Control, op: Op, role: Role) -> bool {
    row(control, op).is_some_and(|row| row.words.values().any(|found| *found == role))
}

/// The setting that counts where no block before a cycle writes a word: its name, and its number if the profile says it.
pub fn stand_in(control: &Control, op: Op, role: Role) -> Option<(&str, Option<f64>)> {
    row_for(control, op, role).map(|row| (row.name.as_str(), stated(control, row)))
}

pub(super) fn row_for(control: &Control, op: Op, role: Role) -> Option<&crate::dialect::Setting> {
    // In a cycle of one block what is left out of a thread is none.
    let word = if super::thread_form::PARTS.contains(&role) { Role::ThreadForm } else { role };
    let before = Kind::of_cycle(op).is_some_and(|kind| takes(control, kind.setup, word));
    if !before && !matches!(role, Role::CutDepth | Role::CutRetract) {
        return None;
    }
    let wanted = |row: &&crate::dialect::Setting| row.otherwise == Some(role) && row.cycles.contains(&op);
    control.dialect().settings.iter().find(wanted)
}

/// True where such a setting counts and no block of the library may change it: a block that writes the word does, for the cycles of other
/// programs and of later days too.
pub fn stands_in(control: &Control, features: &Features, op: Op, role: Role) -> bool {
    let word = if super::thread_form::PARTS.contains(&role) { Role::ThreadForm } else { role };
    row_for(control, op, role).is_some_and(|row| {
        let sets = |kind: &Kind| row.cycles.contains(&kind.cycle) && features.op(kind.setup);
        !(features.role(word) && KINDS.iter().any(sets))
    })
}

/// True where the blocks that set what two cycles take set one setting of the control.
pub fn share(control: &Control, one: &Kind, other: &Kind) -> bool {
    let both = |row: &crate::dialect::Setting| {
        row.otherwise == Some(Role::CutRetract)
            && [one, other].iter().all(|kind| row.cycles.contains(&kind.cycle))
    };
    one.setup == other.setup || control.dialect().settings.iter().any(both)
}

fn stated(control: &Control, row: &crate::dialect::Setting) -> Option<f64> {
    let value = control.setting(&row.name).and_then(|value| value.parse::<f64>().ok());
    value.map(|value| value / row.whole())
}

/// The setting that stands for a word of an operation, by name, and its number where the profile says it.
pub fn setting(control: &Control, op: Op, role: Role) -> Option<(&str, Option<f64>)> {
    // Finishing passes, run-out and angle may stand in one number.
    let part = super::thread_form::PARTS.contains(&role);
    let written = || {
        let setup = |kind: &Kind| {
            takes(control, kind.setup, role) || (part && takes(control, kind.setup, Role::ThreadForm))
        };
        Kind::of_cycle(op).is_some_and(setup) || takes(control, op, role)
    };
    // What stands in for a word that is left out is all there is where the control has no word.
    let gives = |row: &&crate::dialect::Setting| {
        let stands = row.gives == Some(role) || (row.otherwise == Some(role) && !written());
        stands && row.cycles.contains(&op)
    };
    let row = control.dialect().settings.iter().find(gives)?;
    Some((&row.name, stated(control, row)))
}

/// The block that sets the values, in the order that people write them in.
pub(super) fn block_before(kind: &Kind, mut values: Vec<(Role, Expr)>) -> Nc {
    values.sort_by_key(|(role, _)| kind.roles.iter().position(|found| found == role));
    let words = values.into_iter().map(|(role, value)| NcItem::Word(role, value));
    Nc { items: std::iter::once(NcItem::Op(kind.setup)).chain(words).collect() }
}
