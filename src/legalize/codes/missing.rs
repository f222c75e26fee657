//! Operations that the target has no code for, and that nothing stood in for.
//!
//! Runs last of the passes that rewrite: what is left without a row in the target's table is refused here,
//! in the words of the machine and not of a table.

use crate::canon::{Op, Role};
use crate::diag::{Asks, Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::{Nc, Program, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::{BTreeMap, BTreeSet};

/// The operations that a control has.
fn had<'c>(context: &'c Context<'_>) -> &'c BTreeSet<Op> {
    context.had.get_or_init(|| has(context.target))
}

fn has(control: &Control) -> BTreeSet<Op> {
    let dialect = control.dialect();
    let codes = dialect.codes.iter().filter(|row| row.preferred).map(|row| row.op);
    let mut had: BTreeSet<Op> = codes.chain(dialect.words.iter().filter_map(|row| row.op)).collect();
    if control.statement("test.unit").is_some() {
        had.extend([Op::CheckInch, Op::CheckMetric]);
    }
    if control.is(Question::ToolWordSelectsLength) {
        had.insert(Op::LengthOff);
    }
    had
}

/// True where an operation stands that the target has not.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let had = had(context);
    features.any_op(|op| !had.contains(&op) || is_output(op))
}

fn is_output(op: Op) -> bool {
    matches!(op, Op::OutputOn | Op::OutputOff)
}

/// True where the target has no code that switches the output of this block so.
fn lacks_output(nc: &Nc, op: Op, target: &Control) -> bool {
    let number = nc.word(Role::Output).and_then(|number| number.constant());
    let operands = number.map(|number| BTreeMap::from([(Role::Output, number)]));
    is_output(op) && target.code_for(op, &operands.unwrap_or_default()).is_none()
}

/// Refuses what the target cannot do.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let (target, had) = (context.target.dialect(), had(context));
    let mut found = Vec::new();
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        let StmtKind::Nc(nc) = &stmt.kind else { continue };
        let lacks = |op: &Op| !had.contains(op) || lacks_output(nc, *op, context.target);
        let places = [Role::X, Role::Y, Role::Z].iter().any(|role| nc.word(*role).is_some());
        found.extend(nc.ops().filter(lacks).map(|op| (stmt.site.span, op, places)));
    }
    for (span, op, places) in found {
        // A hole, a return or a shift that stayed as it was, for a reason that is told, has the source's code still.
        if (op.is_hole() || matches!(op, Op::Reference2 | Op::LocalShift)) && context.is_refused(index, span)
        {
            continue;
        }
        let meaning = op.meaning().trim().trim_end_matches('.');
        let what = match op {
            Op::Cylinder => {
                format!("{} has no code for this that a source describes ({op}): {meaning}", target.title)
            }
            _ => format!("{} has no code for this ({op}): {meaning}", target.title),
        };
        let finding = Diagnostic::new(Code::NoEquivalent, span, what);
        let stand_in = stand_in(op, context.source);
        let lathe = context.target.machine() == Machine::Lathe;
        let zero = (lathe && op == Op::SetPosition).then(|| set_zero(places, context.source));
        context.add(
            index,
            match (help(op).or(zero), stand_in) {
                _ if is_output(op) => {
                    finding.with_help(switches(op, context.source)).asking_for(Asks::Output { op })
                }
                (Some(help), _) if op.auxiliary().is_some() => {
                    finding.with_help(help).asking_for(Asks::OpThere { op })
                }
                (Some(help), _) => finding.with_help(help),
                (None, Some((code, help))) => {
                    finding.with_help(help).asking_for(Asks::Code { code: code.into(), op: None })
                }
                (None, None) => finding,
            },
        );
    }
    false
}

/// The source's code for a place that every shop sets as it likes, or for limits that it keeps in the machine: only the shop knows
/// what stands for it on the other machine.
fn stand_in(op: Op, source: &Control) -> Option<(String, String)> {
    let is_asked = matches!(op, Op::Reference2 | Op::StrokeCheckOn | Op::StrokeCheckOff);
    let row = is_asked.then(|| source.code_for(op, &BTreeMap::new()))??;
    let code = row.code.split(' ').next().unwrap_or_default().to_owned();
    if op != Op::Reference2 {
        let help = format!(
            "set the limits of the target's axes in the machine, and say what becomes of the code: [[site]] with code = \"{code}\", a text, and \
             do = \"omit\" or \"stop\", or target"
        );
        return Some((code, help));
    }
    let help = format!(
        "say what goes to that place on the target: [[site]] with code = \"{code}\", a text, and a name that the code of \
         the target's builder has too, or target, or do = \"omit\" or \"stop\""
    );
    Some((code, help))
}

/// What becomes of an output, which another machine has elsewhere.
fn switches(op: Op, source: &Control) -> String {
    let row = source.dialect().codes.iter().find(|row| row.op == op);
    let word = row.and_then(|row| row.words.iter().find(|(_, role)| **role == Role::Output));
    let number = word.map_or_else(String::new, |(letter, _)| format!(" {letter}1134"));
    let code = row.map_or_else(|| op.to_string(), |row| format!("{}{number}", row.code));
    format!(
        "if a code of the target's builder does the same, name it in the source's profile, under [codes], as this one is written: \"{code}\" = {{ \
         target = \"M62\", text = \"probe on\" }}; else write do = \"omit\", \"stop\" or \"alarm\" in place of target"
    )
}

/// What becomes of a zero that a program sets from where the tool stands.
fn set_zero(places: bool, source: &Control) -> String {
    let code = source.code_for(Op::SetPosition, &BTreeMap::new()).map_or("G50", |row| row.code.as_str());
    if places {
        return "set this zero on the target by a work offset (G54) and the tool offsets, and take the block out. A way back to the place \
                that it names (G0 to the same X and Z) would then count from the work offset: write it as G28 U0 W0, or in machine coordinates with G53"
            .into();
    }
    format!(
        "set this zero on the target by a work offset (G54) and the tool offsets, and take the block out. If it changes nothing \
         there, as {code} C0 after the return of C, say so in the source's profile: [[site]] with code = \"{code} C\", words = {{ \
         C = \"place\" }}, do = \"omit\" and a text"
    )
}

const LEADS: &str = "cut this thread on a machine that has the code. Threads of one lead each, block after block, only come near it: if that is \
                     good enough for the part, write them into the source yourself";

const SIDE: &str = "if the machine has a code for it under which C counts degrees, as here, name it in the target's profile: [[site]] with its code, op = \
                    \"interpolation.cylinder\", words = { R = \"cylinder.radius\" } (the letter of the radius) and a text; moves and arcs stay as they are \
                    then. Or let the CAM system write this part for the target, or write straight lines as G1 with Z and C in degrees and arcs as many short \
                    lines: along a straight line round the side Z and C go evenly, so the path is the same. F is not the speed along the side there: try \
                    it with the tool in the air";

const TURNS: &str = "write S as a number before the cuts, and F in each block that follows a change of S or of G94 and G95: then the feeds are written per \
                     minute. Or write G94, and as F the feed of a turn times the speed";

/// What a person can do: a shop says what a code of its machine does. None for what is more than a code.
fn help(op: Op) -> Option<String> {
    let words = match op {
        Op::Dwell => ", the role of its word (words = { F = \"dwell.s\" }, in seconds, or \"dwell.ms\")",
        Op::OptionalStop => "",
        op if op.auxiliary().is_some() => "",
        Op::ThreadVariable => return Some(LEADS.into()),
        Op::Cylinder => return Some(SIDE.into()),
        Op::FeedPerTurn => return Some(TURNS.into()),
        _ => return None,
    };
    Some(format!(
        "if the machine has a code for it, name it in the target's profile: [[site]] with its code, op = \"{op}\"{words} \
         and a text"
    ))
}
