//! Zeros that a program sets from where the tool stands, and that the source's profile leaves out.
//!
//! Law: none, it only reports. All places after such a block count from another zero on the target, unless its offsets are set so that they
//! are the same; a way back to the place that the block named goes there too. A person looks at each program, and at each such way.
//! Counter-example: `G50 X310. Z242.` at the reference position, and at the end `G0 X310. Z242. T0100`, which is past the end of travel
//! from the zero of the part.

use crate::canon::{Act, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{SiteCode, Without};
use crate::ir::{Expr, Module, Nc, NcItem};
use crate::legalize::Context;
use crate::text::Span;

/// A block that is left out: its program, its place, and the places along X, Y and Z that it named.
pub struct LeftZero {
    program: usize,
    span: Span,
    code: String,
    places: Vec<(Role, Option<f64>)>,
}

/// The blocks of a library that are left out and that set a zero of X, Y or Z.
pub fn of(module: &Module, context: &Context<'_>) -> Vec<LeftZero> {
    let mut found = Vec::new();
    for (program, own) in module.programs.iter().enumerate() {
        for stmt in own.blocks.iter().flat_map(|block| &block.stmts) {
            let Some(nc) = stmt.kind.nc().filter(|nc| nc.has(Op::Act)) else { continue };
            let act = nc.word(Role::Act).and_then(Expr::constant).and_then(Act::of);
            let Some((act, site)) = act.and_then(|act| Some((act, context.source.site_of(act)?))) else {
                continue;
            };
            if site.without != Some(Without::Omit)
                || context.target.code_of(act).is_some()
                || !sets_zero(site, context)
            {
                continue;
            }
            let places = places(nc, act, site);
            if !places.is_empty() {
                found.push(LeftZero { program, span: stmt.site.span, code: site.shown(), places });
            }
        }
    }
    found
}

/// True for a code that sets the zero from where the tool stands, by the source's own table.
fn sets_zero(site: &SiteCode, context: &Context<'_>) -> bool {
    let name = |code: &str| code.split(' ').next().unwrap_or_default().to_owned();
    let mut rows = context.source.dialect().codes.iter().filter(|row| row.op == Op::SetPosition);
    rows.any(|row| name(&row.code) == name(&site.code))
}

/// What the words of a block named along the axes.
fn places(nc: &Nc, act: Act, site: &SiteCode) -> Vec<(Role, Option<f64>)> {
    let axis = |letter: &str| match letter {
        "X" => Some(Role::X),
        "Y" => Some(Role::Y),
        "Z" => Some(Role::Z),
        _ => None,
    };
    let place = |item: &NcItem| match item {
        NcItem::Word(role, value) => {
            let word = act.word_name(*role)?;
            let (letter, _) = site.words.iter().find(|(_, name)| **name == word)?;
            Some((axis(letter)?, value.constant()))
        }
        _ => None,
    };
    nc.items.iter().filter_map(place).collect()
}

/// Tells of each, and of each move to the place that one named.
pub fn tell(module: &Module, zeros: &[LeftZero], context: &mut Context<'_>) {
    for zero in zeros {
        let what = format!(
            "{} is left out, and it sets the zero that all places after it count from: on the target they count from the work offset",
            zero.code
        );
        context.add(zero.program, Diagnostic::new(Code::Conditional, zero.span, what).with_help(HELP));
    }
    for (index, program) in module.programs.iter().enumerate() {
        let own = || zeros.iter().filter(|zero| zero.program == index).flat_map(|zero| &zero.places);
        if own().next().is_none() {
            continue;
        }
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let Some(nc) = stmt.kind.nc().filter(|nc| !nc.has(Op::MachineOnce)) else { continue };
            let there = |(role, place): &(Role, Option<f64>)| {
                *place != Some(0.0) && place.is_some() && nc.word(*role).and_then(Expr::constant) == *place
            };
            if own().any(there) {
                context.add(
                    index,
                    Diagnostic::new(Code::Conditional, stmt.site.span, BACK).with_help(BACK_HELP),
                );
            }
        }
    }
}

const HELP: &str =
    "set the work offset and the tool offsets of the target so that these places are the same ones";
const BACK: &str = "this is the place that a code named which sets a zero and is left out: on the target it counts from the work offset, and may \
                    lie past the end of travel, or in the part";
const BACK_HELP: &str = "write the way back as G28 U0 W0, or as a place in machine coordinates with G53";
