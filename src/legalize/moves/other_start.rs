//! What only the target's profile says of the start of a program.
//!
//! Two machines of which no profile says what they begin in are taken to begin alike. A target that is said to begin in
//! something else than machines usually do is not: what the old machine begins in has to be said. Asked once for the library.

use super::start::rests_on;
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Machine, StartMode};
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeSet;

const HELP: &str = "say what the old machine begins in under [start] in its machine profile; if it begins so too, name the same there";

/// True where the target's profile names an unusual mode, of a group of which the source's names none.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    open(context).next().is_some()
}

/// Asks what the source begins in, if a program rests on such a mode.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let resting = rests_on(module);
    for (root, groups) in resting.iter().enumerate() {
        let modes: Vec<StartMode> =
            open(context).filter(|mode| groups.contains(&mode.op.group())).cloned().collect();
        if modes.is_empty() {
            continue;
        }
        let target = context.target;
        let codes = modes.iter().filter_map(|mode| target.code_for(mode.op, &mode.fixed));
        let codes: Vec<&str> = codes.map(|row| row.code.as_str()).collect();
        let what = format!(
            "the target begins in {}, as its profile says, and no profile says what the old machine begins in: programs that name \
             no such mode are run in that of the target",
            codes.join(" ")
        );
        let told = Diagnostic::new(Code::Conditional, module.programs[root].site.span, what);
        context.add_once(root, HELP, told.with_help(HELP).asked_once());
    }
}

/// The modes that only the target's profile names, and that a machine does not usually begin in. The unit is asked for elsewhere.
fn open<'c>(context: &Context<'c>) -> impl Iterator<Item = &'c StartMode> {
    let said: BTreeSet<Group> = context.source.start().iter().map(|mode| mode.op.group()).collect();
    let (target, turns) = (context.target, context.target.machine() == Machine::Lathe);
    target.start().iter().filter(move |mode| {
        let group = mode.op.group();
        group != Group::Units && !said.contains(&group) && !is_usual(mode, turns)
    })
}

/// True for what machines begin in unless a parameter says another thing.
fn is_usual(mode: &StartMode, turns: bool) -> bool {
    match mode.op {
        Op::Rapid | Op::Absolute | Op::ReturnInitial => true,
        Op::PlaneXy | Op::FeedPerMinute => !turns,
        Op::PlaneZx | Op::FeedPerTurn => turns,
        Op::SelectWork => mode.work_offset() == Some(1),
        _ => false,
    }
}
