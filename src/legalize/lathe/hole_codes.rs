//! M codes and tool words in the drilling blocks of a lathe.
//!
//! Law: none. Such a code acts between the position and the hole, as the clamp of C does, and the control undoes it after the hole by a code
//! that only the builder knows: on another control nothing is sure to be the same, so it is refused. Between two machines of one control the
//! block stays as it is, if both profiles give the clamp of C (parameter 5110) one name, or neither gives it. Counter-example: `C90. M31`,
//! where M31 clamps the spindle before the drill goes down and M32 lets it go after.

use super::holes;
use crate::canon::{Act, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, HOLE_CLAMP, Question};
use crate::ir::{Expr, Module, Nc, NcItem};
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
            let found = Diagnostic::new(Code::NoEquivalent, span, WHAT).with_help(HELP);
            let number = number(nc, context.source);
            context.add(
                index,
                match (context.source.leaves_open(HOLE_CLAMP) && names, context.source.hole_clamp_codes()) {
                    (true, _) => found.with_help(format!("{HELP}{CLAMP}")).lacking(match number {
                        Some(number) => format!("{HOLE_CLAMP}={number}"),
                        None => HOLE_CLAMP.into(),
                    }),
                    // The profile says that it clamps the axis, and not what lets it go.
                    (false, Some([clamps, frees])) if number == Some(clamps) && ours[1].is_none() => {
                        Diagnostic::new(Code::NoEquivalent, span, frees_what(clamps, frees))
                            .with_help(frees_help(frees))
                            .asking('M', f64::from(frees))
                    }
                    _ => found,
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
const CLAMP: &str = "; or, if it clamps the C axis for the hole, give its number under [parameters] of the source's profile, as \"5110\" = 31, and say \
                     there under [[site]] what it and the code of the next number, which lets the axis go, are on the target: target = \"M14\"";

fn frees_what(clamps: u32, frees: u32) -> String {
    format!(
        "M{clamps} clamps the C axis for the hole of its block, and M{frees} lets it go after the hole (parameter 5110): the profile does not say what \
         M{frees} is on the target"
    )
}

fn frees_help(frees: u32) -> String {
    format!("say it under [[site]] of the source's profile: code = \"M{frees}\" with target, do or name")
}

/// The number of the M code of a block, if it has one that is not the control's own.
fn number(nc: &Nc, source: &Control) -> Option<u32> {
    nc.items.iter().find_map(|item| match item {
        NcItem::Code('M', number) => number.constant().map(|number| number as u32),
        NcItem::Word(Role::Act, number) => {
            let act = Act::of(number.constant()?)?;
            source.code_of(act)?.code.strip_prefix('M')?.parse().ok()
        }
        _ => None,
    })
}

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
