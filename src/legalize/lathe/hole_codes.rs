//! M codes and tool words in the drilling blocks of a lathe.
//!
//! Law: none. Such a code acts between the position and the hole, as the clamp of C does, and the control undoes it after the hole by a code
//! that only the builder knows: on another control nothing is sure to be the same, so it is refused. Between two machines of one control the
//! block stays as it is, if both profiles give the clamp of C (parameter 5110) one name, or neither gives it. Counter-example: `C90. M31`,
//! where M31 clamps the spindle before the drill goes down and M32 lets it go after.

use super::holes;
use crate::canon::{Act, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{HOLE_CLAMP, Question};
use crate::ir::{Expr, Module, NcItem};
use crate::legalize::Context;

/// Refuses them, unless both machines have one control.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let (ours, theirs) = (context.source.hole_clamp(), context.target.hole_clamp());
    let alike = context.source.name() == context.target.name();
    holes::each(module, context, |index, span, nc, context| {
        if !nc.items.iter().any(acts) {
            return;
        }
        let act = nc.word(Role::Act).and_then(Expr::constant);
        let is_clamp = |clamp: [Option<Act>; 2]| clamp[0].is_some_and(|clamp| act == Some(clamp.number()));
        let names = nc.items.iter().any(|item| matches!(item, NcItem::Code('M', _) | NcItem::Op(Op::Act)));
        let open = [context.source, context.target].iter().all(|control| control.leaves_open(HOLE_CLAMP));
        if !alike {
            let found = Diagnostic::new(Code::NoEquivalent, span, WHAT);
            context.add(
                index,
                match context.source.leaves_open(HOLE_CLAMP) && names {
                    true => found.with_help(format!("{HELP}{CLAMP}")).lacking(HOLE_CLAMP),
                    false => found.with_help(HELP),
                },
            );
        } else if is_clamp(ours) || is_clamp(theirs) {
            context.rests_on_source(index, span, Question::HoleClamp);
            context.rests_on_target(index, span, Question::HoleClamp);
            if ours != theirs {
                let found = Diagnostic::new(Code::NoEquivalent, span, ONE_CLAMPS).with_help(ONE_CLAMPS_HELP);
                context.add(
                    index,
                    match (context.source.leaves_open(HOLE_CLAMP), context.target.leaves_open(HOLE_CLAMP)) {
                        (true, _) => found.lacking(HOLE_CLAMP),
                        (_, true) => found.lacking_there(HOLE_CLAMP),
                        _ => found,
                    },
                );
            }
        } else if names && open {
            let found = Diagnostic::new(Code::Conditional, span, UNTOLD).with_help(UNTOLD_HELP);
            context.add_once(index, UNTOLD, found.lacking(HOLE_CLAMP));
        }
    });
}

const UNTOLD: &str = "an M code in a drilling block stays, and neither profile says that it clamps the C axis for the hole: make sure that both machines do \
                      the same by it";
const UNTOLD_HELP: &str = "if it does, give its number as \"5110\" under [parameters] of both profiles, and name it and the code of the next number under \
                           [[site]] in both; if no code clamps there, write \"5110\" = \"0\" into both";
const ONE_CLAMPS: &str = "this code clamps the C axis for the hole of its block on one of the two machines alone: parameter 5110 is given in one profile, or \
                          the codes of the two have other names";
const ONE_CLAMPS_HELP: &str = "give 5110 under [parameters] of both profiles, and that code and the next one the same names under [[site]] in both";
const CLAMP: &str = "; or, if it clamps the C axis for the hole, give its number under [parameters] of the source's profile, as \"5110\" = 31, and name it \
                     and the code of the next number, which lets the axis go, under [[site]] in both profiles";

fn acts(item: &NcItem) -> bool {
    match item {
        NcItem::Code(letter, _) => *letter == 'M',
        NcItem::Op(op) => {
            op.auxiliary().is_some()
                || matches!(op, Op::Stop | Op::OptionalStop | Op::TurretIndex | Op::RigidTaps)
        }
        NcItem::Word(role, _) => matches!(role, Role::Turret),
    }
}

const WHAT: &str = "an M code or a tool word in a drilling block acts between the position and the hole, as the clamp of C does, and ends \
                    after the hole: no source says how the target does that";
const HELP: &str = "give the position, the code, and each hole blocks of their own, with the code that ends it after the hole";
