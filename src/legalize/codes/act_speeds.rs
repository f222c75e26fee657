//! The speed of a live tool, which one control takes from the last S, and the other from a word of the code that turns the tool.
//!
//! Law: where a builder's code reads S, the last S counts for it, in whatever block that stands; a change of S while the tool turns
//! changes its speed. So the target's code gets the S in force as its word, and is written again before a block with another S.
//! Side condition: the S in force is one known number, and no other code of a builder, stop of the spindle or tool change came
//! between the code and the later S: nobody knows whether the tool turns then.
//! Counter-example: `S1000`, `M33` as `M133` without its P: the tool stands, or turns as fast as it did last.

mod live;

use crate::canon::{Act, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::codes::ahead::ahead;
use crate::legalize::cycles::tap_leads::Speed;
use crate::legalize::features::Features;
use crate::text::Span;
use live::{Known, Live, Lives, acts, names_tool};

/// True where there are codes of builders.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let speaks = |site: &crate::dialect::SiteCode| !site.words.is_empty();
    let any = |control: &crate::dialect::Control| control.profile().site.iter().any(speaks);
    features.op(Op::Act) && (any(context.source) || any(context.target))
}

/// Gives the codes that turn live tools their speed.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let (source, target) = (context.source, context.target);
    let lives = OverCalls::of(module, &Lives { source, target });
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let mut known = lives.at(index, id).copied().unwrap_or(Known::NOTHING);
            let stmts = std::mem::take(&mut block.stmts);
            let starts: Vec<bool> =
                (0..stmts.len()).map(|at| starts_next(&stmts[at + 1..], context)).collect();
            for (mut stmt, starts) in stmts.into_iter().zip(starts) {
                let before = known;
                known.step(&stmt, source, target);
                give(&mut stmt, index, before, context);
                turned(&mut stmt, index, (before, starts), context, &mut block.stmts);
                block.stmts.push(stmt);
            }
        }
    }
}

/// True if a spindle or a live tool starts before anything moves: a speed before it is for that.
fn starts_next(stmts: &[Stmt], context: &Context<'_>) -> bool {
    for nc in stmts.iter().filter_map(|stmt| stmt.kind.nc()) {
        let live = |act: Act| context.source.speed_word(act).is_some();
        if nc.has(Op::SpindleCw) || nc.has(Op::SpindleCcw) || acts(nc).any(live) {
            return true;
        }
        if nc.names_axis() {
            return false;
        }
    }
    false
}

/// Gives a code its word for the speed, and a start of the spindle the speed that the target would take from a live tool.
fn give(stmt: &mut Stmt, index: usize, before: Known, context: &mut Context<'_>) {
    let span = stmt.site.span;
    let StmtKind::Nc(nc) = &mut stmt.kind else { return };
    let (source, target) = (context.source, context.target);
    let starts = nc.has(Op::SpindleCw) || nc.has(Op::SpindleCcw);
    if starts && before.beside && nc.word(Role::Speed).is_none() && !nc.has(Op::SurfaceSpeed) {
        let what = "the last S stood beside the code of a live tool: whether the spindle turns at it is the builder's";
        let help = "write S in this block of the source";
        context.add(index, Diagnostic::new(Code::Conditional, span, what).with_help(help));
    }
    let surface = counts_surface(before, nc);
    let own: Vec<Act> = acts(nc).collect();
    for act in own {
        let Some(row) = target.code_of(act) else { continue };
        let (code, name) = (row.code.clone(), shown(act, context));
        let (ours, theirs) = (source.speed_word(act), target.speed_word(act));
        let said = |role: Role, nc: &Nc| nc.word(role).is_some();
        match (ours, theirs) {
            (Some(ours), theirs) if theirs != Some(ours) => {
                if said(ours, nc) {
                    if surface {
                        let there = format!("{code} of the target takes turns a minute in its word");
                        of_surface(index, span, (&name, &there), context);
                    }
                    continue;
                }
                let speed = if nc.word(Role::Speed).is_some() { Speed::Unknown } else { before.speed };
                match speed {
                    Speed::Known(speed) => nc.items.push(NcItem::Word(ours, Expr::Number(speed))),
                    _ => {
                        let what = format!(
                            "{code} of the target takes the speed of the tool as a word, and which S counts for {name} here is not known"
                        );
                        let help = "write S in this block of the source, as a number or by a variable";
                        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
                    }
                }
            }
            (None, Some(theirs)) if !said(theirs, nc) && source.act_words(act).contains(&theirs) => {
                let what = format!(
                    "{name} without its speed: {code} of the target takes the last S, of whatever it was"
                );
                let help = "write the speed in this block of the source";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
            }
            (None, Some(theirs)) if surface && said(theirs, nc) => {
                let there =
                    format!("S of {code} on the target would count it, and the word here counts turns");
                of_surface(index, span, (&name, &there), context);
            }
            (None, None) => wanted(act, index, span, context),
            _ => {}
        }
    }
}

/// True where S of a block counts what the surface does, or may.
fn counts_surface(before: Known, nc: &Nc) -> bool {
    before.speed == Speed::Surface && !nc.has(Op::TurnsPerMinute) || nc.has(Op::SurfaceSpeed)
}

/// Refuses a speed that counts the surface on one of the two machines alone.
fn of_surface(index: usize, span: Span, (name, there): (&str, &str), context: &mut Context<'_>) {
    let what = format!("constant surface speed is in force at {name}: {there}");
    let help = "write the code for turns a minute and the turns in this block, if the part may be turned so; else write this part of the \
                program by hand, in the target's way for that spindle";
    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
}

/// Asks for words of the target's code that the source's never gives.
fn wanted(act: Act, index: usize, span: Span, context: &mut Context<'_>) {
    let Some(row) = context.target.code_of(act) else { return };
    let given = context.source.act_words(act);
    let Some((letter, role)) = row.words.iter().find(|(_, role)| !given.contains(role)) else { return };
    let Some(word) = act.word_name(*role) else { return };
    let (name, code) = (shown(act, context), row.code.clone());
    let what = format!(
        "{code} of the target takes {letter} ({word}), and the source's profile names no word of {name} for it"
    );
    let own = own_code(act, context);
    let site = context.source.profile().site.iter().find(|site| site.code == own);
    let there = if site.is_some_and(|site| site.target.is_some()) { letter.clone() } else { word };
    let help = format!(
        "write at {own} in the source's profile which letter says it: words = {{ S = \"{there}\" }}, S being the letter for a speed. If \
         nothing says it on the source, make sure that {code} does what it must without {letter}"
    );
    context.add_once(
        index,
        &what,
        Diagnostic::new(Code::Conditional, span, what.clone()).with_help(help).asked_once(),
    );
}

/// Writes the code again before a block that gives another speed while the tool turns.
fn turned(
    stmt: &mut Stmt,
    index: usize,
    (before, starts): (Known, bool),
    context: &mut Context<'_>,
    out: &mut Stmts,
) {
    let StmtKind::Nc(nc) = &stmt.kind else { return };
    let switches = [Op::SpindleCw, Op::SpindleCcw, Op::SpindleStop, Op::RigidTaps];
    let other = nc.ops().any(|op| switches.contains(&op)) || acts(nc).next().is_some();
    let (Some(speed), false) = (nc.word(Role::Speed).cloned(), other) else { return };
    let span = stmt.site.span;
    if counts_surface(before, nc) {
        return under_surface(index, (before.live, starts), span, context);
    }
    let changes = nc.has(Op::ToolChange) || names_tool(nc);
    match before.live {
        Live::On(act) if !changes => {
            let (ours, theirs) = (context.source.speed_word(act), context.target.speed_word(act));
            let Some(code) = context.target.code_of(act).map(|row| row.code.clone()) else { return };
            match (ours, theirs) {
                (Some(ours), theirs) if theirs != Some(ours) => {
                    let items = vec![
                        NcItem::Op(Op::Act),
                        NcItem::Word(Role::Act, Expr::Number(act.number())),
                        NcItem::Word(ours, speed),
                    ];
                    out.push(ahead(stmt, items));
                }
                (None, Some(_)) => {
                    let what = format!(
                        "S while {} is in force: on the target S is the speed of the tool that {code} turns, and here it is not",
                        shown(act, context)
                    );
                    let help = "write S in the block that starts the spindle";
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
                }
                _ => {}
            }
        }
        Live::On(act) | Live::Doubted(act) | Live::Either(act) => {
            let (ours, theirs) = (context.source.speed_word(act), context.target.speed_word(act));
            let known = matches!(before.live, Live::Doubted(_)) || changes;
            if ours == theirs || context.target.code_of(act).is_none() || starts && known {
                return;
            }
            let name = shown(act, context);
            let what = format!(
                "S after {name}: whether the tool turns still is not known here, and the target has its speed at the code"
            );
            let help = format!(
                "if it turns, write {} again in this block of the source; if not, write S in the block that starts the spindle",
                own_code(act, context)
            );
            let code = if known { Code::Conditional } else { Code::NoEquivalent };
            context.add(index, Diagnostic::new(code, span, what).with_help(help));
        }
        Live::No => {}
    }
}

/// Tells S under constant surface speed while what a code turns may turn, and no spindle starts before the next move.
fn under_surface(index: usize, (live, starts): (Live, bool), span: Span, context: &mut Context<'_>) {
    let Live::On(act) = live else { return };
    if starts
        || context.source.speed_word(act) == context.target.speed_word(act)
        || context.target.code_of(act).is_none()
    {
        return;
    }
    let what = format!(
        "S under constant surface speed after {}: whether it is for what that code turns is the builder's, and the target takes turns a \
         minute at its code",
        shown(act, context)
    );
    let help = "make sure that this S is for the main spindle, or write this part of the program by hand";
    context.add(index, Diagnostic::new(Code::Conditional, span, what).with_help(help));
}

/// A code for people: as it is written, and what it does.
fn shown(act: Act, context: &Context<'_>) -> String {
    context.source.site_of(act).map_or_else(|| own_code(act, context), |site| site.shown())
}

/// The source's code of a name.
fn own_code(act: Act, context: &Context<'_>) -> String {
    context.source.code_of(act).map_or_else(|| format!("'{}'", act.shown()), |row| row.code.clone())
}
