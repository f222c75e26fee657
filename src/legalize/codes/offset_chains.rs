//! Work offsets by a computed number, where the target counts the first few by codes and the others by a word.
//!
//! Law: a block with a code of its own for each of the standard offsets, after a comparison with its number, and one with the word of
//! the others for the rest selects what the computed number selects; the words of the block stand after it. Side conditions: the
//! number is that of a word of which each number up to a bound is a standard offset and each from there on an additional one; no cycle and no call is in
//! force, so that a block without axes only selects. A number below the first stops with an alarm: a person is told.
//! Counter-example: `E+R9` under a drilling cycle.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{
    BinOp, BlockId, Builder, Class, Cond, Expr, Module, Nc, NcItem, Place, Relation, SourceInfo, Stmt,
    StmtKind, TermKind, Var,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::{Part, highest_temp, rebuild, unless_skipped};
use crate::text::Span;
use std::collections::BTreeMap;

/// The most standard offsets that are told apart.
const MOST: u32 = 9;

/// What the first additional offset is counted from.
const ADDITIONAL: f64 = 100.0;

/// True where a work offset may be computed, and the target has no word that selects any.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.op(Op::SelectWork)
        && features.has(Feature::Variable)
        && context.target.word_for(Op::SelectWork).is_none()
}

/// A number whose first values are standard offsets.
struct Counted {
    /// What is computed.
    number: Expr,
    /// From here on it is that of an additional offset.
    from: f64,
    /// What is added to it then.
    more: f64,
}

/// Writes them out.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut places: BTreeMap<(BlockId, usize), Counted> = BTreeMap::new();
        let mut spans: Vec<Span> = Vec::new();
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for (at, stmt) in block.stmts.iter().enumerate() {
                state.step(stmt);
                let quiet = state.op(Group::Cycle) == Some(Op::CycleOff) && !state.may_call();
                if let Some(found) = stmt.kind.nc().and_then(counted).filter(|_| quiet) {
                    places.insert((id, at), found);
                    spans.push(stmt.site.span);
                }
            }
        }
        let Some(first) = spans.first() else { continue };
        let finding = Diagnostic::new(Code::Conditional, *first, WHAT);
        context.add_once(index, WHAT, finding);
        let target = context.target;
        let counter = Var { class: Class::Temp, number: highest_temp(program) + 1 };
        let mut place = (BlockId(0), 0);
        rebuild(program, &mut |builder, part| match part {
            Part::Start(id) => place = (id, 0),
            Part::Stmt(stmt) => {
                let found = places.remove(&place);
                place.1 += 1;
                match (found, stmt) {
                    (Some(found), Stmt { kind: StmtKind::Nc(nc), site }) => {
                        lay(builder, (&found, counter), nc, site, target);
                    }
                    (_, stmt) => Part::Stmt(stmt).keep(builder),
                }
            }
            term => term.keep(builder),
        });
    }
}

/// The number of a block's work offset: `n + 94 * truth(n ge 7)`.
fn counted(nc: &Nc) -> Option<Counted> {
    if !nc.has(Op::SelectWork) {
        return None;
    }
    let Expr::Binary(BinOp::Add, sides) = nc.word(Role::WorkOffset)? else { return None };
    let [number, Expr::Binary(BinOp::Mul, product)] = &**sides else { return None };
    let [more, Expr::Truth(cond)] = &**product else { return None };
    let Cond::Compare(Relation::GreaterEqual, of, from) = &**cond else { return None };
    let (more, from) = (more.constant()?, from.constant()?);
    (of == number && number.constant().is_none()).then(|| Counted { number: number.clone(), from, more })
}

/// One branch for each standard offset, one for the others, and the rest of the block after it.
fn lay(
    builder: &mut Builder,
    (found, counter): (&Counted, Var),
    mut nc: Nc,
    mut site: SourceInfo,
    target: &Control,
) {
    let place = SourceInfo { span: site.span, ..SourceInfo::default() };
    let after = builder.fresh();
    // Comments and number stand at the head.
    let head = SourceInfo { skip: None, ..site.clone() };
    if !head.comments.is_empty() || head.sequence.is_some() {
        builder.push(StmtKind::Comment, head);
    }
    site.comments = Default::default();
    site.sequence = Default::default();
    let skip = site.skip.take();
    unless_skipped(builder, skip, after);
    let has = |number: f64| {
        target.code_for(Op::SelectWork, &BTreeMap::from([(Role::WorkOffset, number)])).is_some()
    };
    let select = |builder: &mut Builder, number: Expr, to: BlockId| {
        let items = vec![NcItem::Op(Op::SelectWork), NcItem::Word(Role::WorkOffset, number)];
        builder.push(StmtKind::Nc(Nc { items }), place.clone());
        builder.end(TermKind::Jump(to), SourceInfo::default());
    };
    let rest = builder.fresh();
    let branch = |builder: &mut Builder, relation: Relation, with: f64, number: Expr| {
        let (then, otherwise) = (builder.fresh(), builder.fresh());
        let cond = Cond::Compare(relation, found.number.clone(), Expr::Number(with));
        builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, place.clone());
        builder.start(then);
        select(builder, number, rest);
        builder.start(otherwise);
    };
    let add = |number: Expr, more: f64| Expr::Binary(BinOp::Add, Box::new([number, Expr::Number(more)]));
    if has(found.from + found.more) {
        // The code's own word counts the additional ones from 1 on.
        let own = found.more - ADDITIONAL;
        let value = add(found.number.clone(), own);
        builder.push(StmtKind::Assign { target: Place::Var(counter), value }, place.clone());
        branch(builder, Relation::GreaterEqual, found.from, add(Expr::Var(counter), ADDITIONAL));
    }
    for number in (1..MOST).map(f64::from).filter(|number| *number < found.from && has(*number)) {
        branch(builder, Relation::Equal, number, Expr::Number(number));
    }
    let alarm = StmtKind::Alarm { number: Expr::Number(1.0).into(), text: "NO SUCH OFFSET".into() };
    builder.push(alarm, place.clone());
    builder.end(TermKind::End { rewind: false }, place.clone());
    builder.start(rest);
    nc.items.retain(|item| !matches!(item, NcItem::Op(Op::SelectWork) | NcItem::Word(Role::WorkOffset, _)));
    if !nc.items.is_empty() {
        builder.push(StmtKind::Nc(nc), site);
    }
    builder.end(TermKind::Jump(after), SourceInfo::default());
    builder.start(after);
}

const WHAT: &str = "the number of the work offset is computed: each of the first ones has a block of its own, the larger ones the additional \
                    offset of that number, and any other stops with an alarm. Make sure that no run comes to 0 here, or to more than the target has";
