//! T words whose offset has another number than the station, on lathes that do not take the geometry from the same row.
//!
//! Law: none. A lathe adds the geometry and the wear of a tool. Either both have the number of the offset, or the geometry has that of the
//! station. Where station and offset have one number this is the same row. Where they differ, and the two controls are known to differ
//! too, the program is refused; where nobody says it of a control it is asked once. A computed T word may be of either kind.
//! Side condition: offset 00 is none (`none_offsets`), and station 0 leaves the tool that is there.
//! Counter-example: `T0121`, a second offset of the tool in station 1.

use super::none_offsets::{answer, turns_apart};
use crate::canon::Role;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, turret_parts};
use crate::ir::{Expr, Module, Nc};
use crate::legalize::Context;
use crate::legalize::features::Features;

const QUESTION: Question = Question::TurretGeometry;

/// True for lathes that do not answer alike.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    turns_apart(QUESTION, features, context)
}

/// Looks at each T word.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let known = answer(context.source, QUESTION).is_some() && answer(context.target, QUESTION).is_some();
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let Some(parts) = stmt.kind.nc().and_then(apart) else { continue };
            let span = stmt.site.span;
            // What the source takes for a fault too was said of it.
            if context.is_faulty(index, span) {
                continue;
            }
            match (known, parts) {
                (true, Parts::Differ) => {
                    let told = Diagnostic::new(Code::NoEquivalent, span, DIFFER).with_help(HELP);
                    context.add(index, told);
                }
                (true, Parts::Computed) => {
                    let told = Diagnostic::new(Code::Conditional, span, COMPUTED).with_help(HELP);
                    context.add_once(index, COMPUTED, told);
                }
                (false, _) => {
                    if answer(context.source, QUESTION).is_none() {
                        context.rests_on_source(index, span, QUESTION);
                    }
                    if answer(context.target, QUESTION).is_none() {
                        context.rests_on_target(index, span, QUESTION);
                    }
                }
            }
        }
    }
}

const DIFFER: &str = "the station and the offset of this T word have two numbers: one of the two lathes takes the geometry from the row of the \
                      offset, the other from that of the station";
const COMPUTED: &str = "this T word is computed: where its offset has another number than its station, one of the two lathes takes the geometry from \
                        the row of the offset, the other from that of the station";
const HELP: &str = "give the tool an offset with the number of its station; or set both machines alike, and say so in their profiles";

/// What a T word says of both.
enum Parts {
    Differ,
    Computed,
}

/// The parts of the T word of a block, if they may be two numbers.
fn apart(nc: &Nc) -> Option<Parts> {
    let word = nc.word(Role::Turret)?;
    let Some(word) = Expr::constant(word) else { return Some(Parts::Computed) };
    let (station, offset) = turret_parts(word);
    (offset != 0.0 && station != offset).then_some(Parts::Differ)
}
