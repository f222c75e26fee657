//! Rows of a table that has one number for lengths and radii, on a target that holds them apart.
//!
//! Law: the number of a row is put into the length and the radius of that row, once, by whoever fills the new table: then H and D
//! name what they named, which is told once. What writes or reads the number of a row writes or reads the one of the two that the
//! profile of the source says the row is for. Side conditions: the row is a number that stands in one of its lists, and nothing
//! names it as the other. Counter-example: `#[2000+#1]`, where no row is known, is refused.

use crate::canon::{Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{OneTable, RowKind};
use crate::ir::{Expr, Module, NcItem, Place, StmtKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Position, Rewriter, rewrite_program};
use crate::text::Span;

/// True if the library uses such a table, and the target holds lengths and radii apart.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let names = [Role::LengthOffset, Role::RadiusOffset].iter().any(|role| features.role(*role));
    (names || features.op(Op::WriteOffset) || features.has(Feature::System))
        && context.source.one_table().is_some()
        && context.target.holds_offsets_apart()
}

/// What is wrong with a row.
#[derive(Clone, Copy)]
enum Wrong {
    /// It is not known what it holds.
    Unknown,
    /// It is computed.
    Computed,
    /// A word names it as what it is not.
    Other(u32, RowKind),
}

const TOLD: &str = "the old machine has one number in a row of its tool offsets, and the new one has a length and a radius: put the number of \
                    each row that H names into the length (geometry) of the same row, that of each row which D names into its radius \
                    (geometry), and leave the wear at 0";
const ROWS: &str = "say which rows hold which, in the profile of the old machine under [settings]: offset_lengths = \"1-30\" and offset_radii = \
                    \"31-60\"";

/// Rewrites what writes and reads rows, and tells what goes where.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let Some(table) = context.source.one_table() else { return false };
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut wrong: Vec<(Span, Wrong)> = Vec::new();
        let mut named = None;
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let span = stmt.site.span;
            match &mut stmt.kind {
                StmtKind::Nc(nc) => {
                    for (role, kind) in WORDS {
                        let Some(row) = nc.word(role).filter(|row| row.constant() != Some(0.0)) else {
                            continue;
                        };
                        named.get_or_insert(span);
                        let own = whole(row).and_then(|row| Some((row, table.kind(row)?)));
                        let other = own.filter(|(_, own)| *own != kind);
                        wrong.extend(other.map(|(row, own)| (span, Wrong::Other(row, own))));
                    }
                    if !nc.has(Op::WriteOffset) {
                        continue;
                    }
                    let row = nc.word(Role::OffsetRow).cloned().unwrap_or(Expr::Vacant);
                    match kind_of(&row, &table) {
                        Ok(kind) => (nc.items.iter_mut()).for_each(|item| {
                            if let NcItem::Op(op @ Op::WriteOffset) = item {
                                *op = [Op::WriteLength, Op::WriteRadius][kind as usize];
                                changed = true;
                            }
                        }),
                        Err(what) => {
                            nc.items.retain(|item| *item != NcItem::Op(Op::WriteOffset));
                            changed = true;
                            wrong.push((span, what));
                        }
                    }
                }
                StmtKind::Assign { target: Place::System(state @ Sys::ToolOffset, rows), .. } => {
                    match rows.first().map_or(Err(Wrong::Computed), |row| kind_of(row, &table)) {
                        Ok(kind) => (*state, changed) = (STATES[kind as usize], true),
                        Err(what) => wrong.push((span, what)),
                    }
                }
                _ => {}
            }
        }
        rewrite_program(
            program,
            |e| matches!(e, Expr::System(Sys::ToolOffset, _)),
            &mut |e, _: Position, rewriter: &mut Rewriter<'_>| match e {
                Expr::System(state @ Sys::ToolOffset, rows) => {
                    match rows.first().map_or(Err(Wrong::Computed), |row| kind_of(row, &table)) {
                        Ok(kind) => {
                            changed = true;
                            Expr::System(STATES[kind as usize], rows)
                        }
                        Err(what) => {
                            wrong.push((rewriter.span, what));
                            Expr::System(state, rows)
                        }
                    }
                }
                other => other,
            },
        );
        if let Some(span) = named {
            let finding = Diagnostic::new(Code::Conditional, span, TOLD).asked_once();
            context.add_once(index, TOLD, finding);
        }
        wrong.into_iter().for_each(|(span, wrong)| report(wrong, index, span, context));
    }
    changed
}

const WORDS: [(Role, RowKind); 2] =
    [(Role::LengthOffset, RowKind::Length), (Role::RadiusOffset, RowKind::Radius)];

/// What holds each kind, as the table of the source counts radii.
const STATES: [Sys; 2] = [Sys::LengthGeometry, Sys::DiameterOrRadius];

fn whole(row: &Expr) -> Option<u32> {
    row.constant().filter(|row| *row >= 1.0 && row.fract() == 0.0).map(|row| row as u32)
}

fn kind_of(row: &Expr, table: &OneTable) -> Result<RowKind, Wrong> {
    let row = whole(row).ok_or(Wrong::Computed)?;
    table.kind(row).ok_or(Wrong::Unknown)
}

/// Refuses the use of a computed row, where the target holds lengths and radii apart.
pub fn report_computed(index: usize, span: Span, context: &mut Context<'_>) {
    report(Wrong::Computed, index, span, context);
}

fn report(wrong: Wrong, index: usize, span: Span, context: &mut Context<'_>) {
    let (what, help) = match wrong {
        Wrong::Unknown => (
            "the number of a row of the old table is used, and nothing says whether it is a length or a radius: the new table has both"
                .to_owned(),
            ROWS.to_owned(),
        ),
        Wrong::Computed => (
            "the row is computed whose number is used here, so it may be a length or a radius: the new table has both".to_owned(),
            "write the rows as numbers, or convert the program by hand: the new machine has other variables for lengths and for radii"
                .to_owned(),
        ),
        Wrong::Other(row, kind) => {
            let (held, word) = match kind {
                RowKind::Length => ("length", 'D'),
                RowKind::Radius => ("radius", 'H'),
            };
            (
                format!("{word}{row} names row {row}, and the profile of the old machine says that this row holds a {held}"),
                "mend offset_lengths and offset_radii in that profile, or the block".to_owned(),
            )
        }
    };
    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
}
