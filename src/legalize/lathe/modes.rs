//! What lathe programs rest on by the modes that are in force: threads in feed a minute, and a change between G96 and G97 without a speed. And what a
//! table of tool offsets takes no increment of.
//!
//! Law: none. F of a thread is taken as its lead in either mode of the feed, and the speed after such a change as the other control has it. What no
//! source says is asked, and two answers that differ are refused. Counter-example: `G98` and `G92 X29. Z-20. F2.`, which a control may take as 2 mm a
//! minute.

use super::settings::takes;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::{Module, Nc};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;

/// The codes of threads.
const THREADS: [Op; 3] = [Op::Thread, Op::ThreadingPass, Op::Threading];

/// The codes that say what S counts.
const SPEEDS: [Op; 2] = [Op::SurfaceSpeed, Op::TurnsPerMinute];

/// True where threads stand with feed a minute in the library, or both codes of the speed.
pub fn concerns(features: &Features) -> bool {
    let threads = THREADS.iter().any(|op| features.op(*op)) && features.op(Op::FeedPerMinute);
    threads || SPEEDS.iter().all(|op| features.op(*op)) || features.op(Op::WriteTurret)
}

/// Says what is not known of them.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    facts.each(module, &mut |index, stmt, before, after| {
        let Some(nc) = stmt.kind.nc() else { return };
        if nc.has(Op::WriteTurret)
            && nc.word(Role::C).is_some()
            && !takes(context.target, Op::WriteTurret, Role::StepX)
        {
            let told = Diagnostic::new(Code::NoEquivalent, stmt.site.span, NOSE).with_help(NOSE_HELP);
            context.add_once(index, &format!("{NOSE} {:?}", stmt.site.span), told);
        }
        let threads = is_thread(nc, after) && after.op(Group::FeedMode) == Some(Op::FeedPerMinute);
        let asked = [
            threads.then_some(Question::ThreadFeedIsLead),
            changes_speed(nc, before).then_some(Question::SpeedKept),
        ];
        for question in asked.into_iter().flatten() {
            context.rests_on_source(index, stmt.site.span, question);
            context.rests_on_target(index, stmt.site.span, question);
            context.must_agree(index, stmt.site.span, question);
            if question == Question::SpeedKept {
                only_one_says(index, stmt.site.span, context);
            }
        }
    });
}

/// Where nobody says it of one control, the last speed of the mode is taken to come back; the other's is known to keep the turns.
fn only_one_says(index: usize, span: Span, context: &mut Context<'_>) {
    let turns = |control: &Control| {
        let known = control.behaviour(Question::SpeedKept).filter(|row| row.value != "unknown");
        known.map(|row| row.value == "turns")
    };
    let (control, side) = match (turns(context.source), turns(context.target)) {
        (Some(true), None) => (context.target, Side::Target),
        (None, Some(true)) => (context.source, Side::Source),
        _ => return,
    };
    let what = format!(
        "what the {side} does with a change between G96 and G97 without S is not known, and the other control keeps the turns of the moment"
    );
    let help = control.to_settle(Question::SpeedKept.fact(), side);
    context.add_once(index, &what, Diagnostic::new(Code::NoEquivalent, span, what.as_str()).with_help(help));
}

const NOSE: &str =
    "C in this block is an increment of a nose radius: no source says by which word the target is told one";
const NOSE_HELP: &str = "write the whole radius with R";

/// True for a block that cuts a thread.
fn is_thread(nc: &Nc, state: &Modal) -> bool {
    let goes_on = || nc.names_axis() && state.op(Group::Motion).is_some_and(|op| THREADS.contains(&op));
    nc.ops().any(|op| THREADS.contains(&op)) || goes_on()
}

/// True for a code that changes what S counts, without S.
fn changes_speed(nc: &Nc, before: &Modal) -> bool {
    let code = nc.ops().filter(|op| SPEEDS.contains(op)).last();
    let from = before.op(Group::SpeedMode);
    code.is_some_and(|op| from.is_some_and(|from| from != op)) && nc.word(Role::Speed).is_none()
}
