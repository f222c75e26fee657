//! Words beside a code of a machine's builder that may be words of it.

use super::Findings;
use crate::canon::{Group, Op, Role};
use crate::diag::{Asks, Code, Diagnostic};
use crate::dialect::CodeMeaning;
use crate::text::Span;

/// The builder's code of a block that may take a word which no code of the block names. None if another code takes the word.
/// `moves` says that the block has axis words.
///
/// A G code of a builder may take any word, as the X of a return to a second reference position. An M code stands beside moves
/// and leaves them what is theirs; a centre or a word of a cycle without an axis is no part of a move.
pub fn may_take<'c>(
    rows: impl Iterator<Item = &'c CodeMeaning> + Clone,
    role: Role,
    moves: bool,
) -> Option<&'c CodeMeaning> {
    // An M code that shapes coordinates has its axes from the profile: those of the block would be taken for its own.
    let shapes = |row: &&CodeMeaning| {
        row.code.starts_with('M')
            && matches!(row.op.group(), Group::Mirror | Group::Rotation | Group::Scaling)
    };
    if role.is_axis()
        && let Some(row) = rows.clone().find(shapes)
    {
        return Some(row);
    }
    // A switch of a spindle or a coolant by a G code is a builder's too.
    let switch = |row: &CodeMeaning| row.code.starts_with('G') && row.op.auxiliary().is_some();
    let is_told = |row: &CodeMeaning| matches!(row.op, Op::Act | Op::Builder) || switch(row);
    let told = |letter: char| rows.clone().find(|row| is_told(row) && row.code.starts_with(letter));
    let has = |wanted: &dyn Fn(&CodeMeaning) -> bool| rows.clone().any(|row| !is_told(row) && wanted(row));
    let in_group = |group: Group| has(&|row| row.op.group() == group);
    let is_g = |row: &CodeMeaning| row.code.starts_with('G');
    if has(&|row| row.op.is_arc() || row.op.is_cycle() || is_g(row) && row.op.group() == Group::OneShot) {
        return None;
    }
    if let Some(row) = told('G') {
        let taken = match role {
            role if role.is_axis() => {
                has(&|row| matches!(row.op, Op::RotateOn | Op::ScaleOn | Op::MirrorOn))
                    || row.op == Op::Builder && in_group(Group::Motion)
            }
            _ if !matches!(row.op, Op::Act | Op::Builder) => true,
            Role::Feed => in_group(Group::Motion) || in_group(Group::FeedMode),
            Role::Speed => in_group(Group::Spindle) || in_group(Group::SpeedMode),
            Role::Tool | Role::Turret => has(&|row| row.op == Op::ToolChange),
            Role::LengthOffset => in_group(Group::LengthComp),
            Role::RadiusOffset => in_group(Group::RadiusComp),
            _ => false,
        };
        return (!taken).then_some(row);
    }
    let part_of_move = matches!(
        role,
        Role::ArcI
            | Role::ArcJ
            | Role::ArcK
            | Role::ArcRadius
            | Role::CycleR
            | Role::CycleRStep
            | Role::CycleQ
            | Role::CycleDwell
            | Role::Repeat
            | Role::PolarAngle
            | Role::PolarDistance
    );
    told('M').filter(|_| part_of_move && !moves)
}

impl Findings<'_> {
    /// A word of a block may be one of a builder's code: only the profile can say it.
    pub fn beside_code(&mut self, letter: char, role: Role, code: &str, span: Span) {
        let (stays, own) = match role.is_axis() {
            true => ("a move, which stays", "it is a move"),
            false => ("a word of the block, which stays", "it is none"),
        };
        let message =
            format!("{letter} beside {code} may be a word of that code, which goes with it, or {stays}");
        let help = format!(
            "name it in the [[site]] of {code} in the machine's profile: words = {{ {letter} = \"{letter}\" }}; if {own}, \
             write it into a block of its own"
        );
        let told = Diagnostic::new(Code::NotUnderstood, span, message).with_help(help);
        let name = letter.to_string().into();
        self.add(told.asking_for(Asks::Word { target: false, code: code.into(), letter, name }));
    }
}
