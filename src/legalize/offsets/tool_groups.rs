//! Tools that a control chooses from a group.
//!
//! Law: none. With the management of tool life T calls a group, and offset 99 (`T0199`, `H99`, `D99`) is that of the tool which the control
//! chose: no number of the target is that. Without it 99 is an offset like others. What the machine has is asked once; a profile that
//! gives it fewer offsets than 99 says it. A program that calls tool 99 itself has 99 as the offset of that tool, and asks nothing. Counter-example: `T0199` as tool 1 with offset 99 of the target, which nobody has set.

use crate::canon::Role;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, turret_parts};
use crate::ir::{Expr, Module, Nc, Program};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The offset that stands for the one of the group's tool, and the one by which a lathe lets it go.
const OF_GROUP: f64 = 99.0;
const LETS_GO: f64 = 88.0;

/// True if the library names offsets.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    [Role::LengthOffset, Role::RadiusOffset, Role::Turret].iter().any(|role| features.role(*role))
}

/// Refuses the offset of a group's tool, or asks whether it is that.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let answer = |control: &Control| {
        let own = control.profile().offsets.filter(|count| f64::from(*count) < OF_GROUP).map(|_| "group");
        let row = control.behaviour(Question::OffsetOfGroup).map(|row| row.value.as_str());
        own.or(row).unwrap_or("offset").to_owned()
    };
    let (here, there) = (answer(context.source), answer(context.target));
    if here == "offset" || here == "group" && there == "group" {
        return;
    }
    let known = here == "group";
    for (index, program) in module.programs.iter().enumerate() {
        if !known && calls_tool(program) {
            continue;
        }
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let Some(nc) = stmt.kind.nc() else { continue };
            let Some(offset) = offsets(nc).find(|n| *n == OF_GROUP || known && *n == LETS_GO && turns(nc))
            else {
                continue;
            };
            if !known {
                context.rests_on_source(index, stmt.site.span, Question::OffsetOfGroup);
                break;
            }
            let what = format!(
                "offset {offset} is the management of tool life, as the source's profile says: T calls a group there, and the control chooses the tool"
            );
            let help = "write the tool and its own offset in this block of the source; the groups are entered at the target, and only the \
                        page of its tools can take turns with them";
            context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help));
        }
    }
}

/// True where a program calls the tool of that number, so that its offset is one like others.
fn calls_tool(program: &Program) -> bool {
    let mut ncs = program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc());
    ncs.any(|nc| nc.word(Role::Tool).and_then(Expr::constant) == Some(OF_GROUP))
}

/// True for a tool word of a lathe.
fn turns(nc: &Nc) -> bool {
    nc.word(Role::Turret).is_some()
}

/// The numbers of the offsets that a block names.
fn offsets(nc: &Nc) -> impl Iterator<Item = f64> + '_ {
    let own = [Role::LengthOffset, Role::RadiusOffset].into_iter();
    let own = own.filter_map(|role| nc.word(role)).filter_map(Expr::constant);
    own.chain(nc.word(Role::Turret).and_then(Expr::constant).map(|word| turret_parts(word).1))
}
