//! Feeds without a decimal point, where the source's table tells them in millimetres a minute alone.
//!
//! Law: under G21 and G94 `F100` is 100 mm/min. Side conditions: both are known to be in force, or no program of the library names
//! another mode and, for the unit, the machine's profile says it; the machine is a mill.
//! Counter-example: `G20 F20`, which may be 20 inches a minute or .2, and `G95 F20`: taken as written, for a reviewer.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{BareLength, Control, Machine, Side, Units};
use crate::ir::analysis::modal_facts::replace_statements;
use crate::ir::{Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal};

const FACT: &str = "numbers:bare_feed";

const WHOLE: &str =
    "F without a decimal point is taken as whole millimetres a minute, as two sources of the trade have it";

const OPEN: &str = "no manual says which unit a feed without a decimal point has in inches, or a turn; it is taken as written";

/// True for a mill with numbers without a point, whose feeds the table leaves to the modes in force.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let source = context.source;
    features.has(Feature::Increments)
        && source.machine() == Machine::Mill
        && source.numbers().whole_feeds
        && source.bare_feed() == BareLength::Unknown
}

/// Gives them their value; true if there are any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let blocks = module.programs.iter().flat_map(|program| &program.blocks);
    if !blocks.flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc()).any(has_count) {
        return false;
    }
    let facts = context.modal_facts(module);
    let usual = Usual::of(module, context.source);
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        let mut words = state.clone();
        state.step(&stmt);
        if let StmtKind::Nc(nc) = &mut stmt.kind {
            words.step_words(nc);
            if whole(nc) {
                let span = stmt.site.span;
                if usual.millimetres(&words) {
                    let told = Diagnostic::new(Code::CommonFact, span, WHOLE).with_fact(FACT);
                    context.add_once(
                        index,
                        WHOLE,
                        told.with_help(context.source.to_settle(FACT, Side::Source)),
                    );
                } else if !context.source.has_tried(FACT) {
                    context.unconfirmed(index, Side::Source, span, FACT, OPEN);
                }
            }
        }
        out.push(stmt);
    });
    true
}

/// True where a feed is a count of increments.
fn has_count(nc: &Nc) -> bool {
    nc.items.iter().any(|item| match item {
        NcItem::Word(Role::Feed, Expr::Negate(inner)) => matches!(**inner, Expr::Increments(_)),
        NcItem::Word(Role::Feed, value) => matches!(value, Expr::Increments(_)),
        _ => false,
    })
}

/// Takes counts in the feeds of a block as they are written; true where there were any.
fn whole(nc: &mut Nc) -> bool {
    let mut any = false;
    for item in &mut nc.items {
        let NcItem::Word(Role::Feed, value) = item else { continue };
        let inner = match value {
            Expr::Negate(inner) => inner.as_mut(),
            other => other,
        };
        if let Expr::Increments(count) = inner {
            *inner = Expr::Number(*count);
            any = true;
        }
    }
    any
}

/// What counts where no code before tells it.
struct Usual {
    metric: bool,
    by_minute: bool,
}

impl Usual {
    fn of(module: &Module, source: &Control) -> Self {
        let blocks = module.programs.iter().flat_map(|program| &program.blocks);
        let ncs = blocks.flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc());
        let (mut inch, mut other) = (false, false);
        for item in ncs.flat_map(|nc| &nc.items) {
            // A computed code may be any.
            let any = matches!(item, NcItem::Code('G', _));
            inch |= any || matches!(item, NcItem::Op(Op::Inch));
            other |= any || matches!(item, NcItem::Op(Op::FeedPerTurn | Op::FeedInverse));
        }
        Self { metric: source.units() == Some(Units::Metric) && !inch, by_minute: !other }
    }

    fn millimetres(&self, state: &Modal) -> bool {
        let metric = state.op(Group::Units).map_or(self.metric, |op| op == Op::Metric);
        let by_minute = state.op(Group::FeedMode).map_or(self.by_minute, |op| op == Op::FeedPerMinute);
        metric && by_minute
    }
}
