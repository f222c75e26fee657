//! Offset tables that a code writes, on a target that writes them as state.
//!
//! Law: a code that writes a table writes each value of its block into the cell of that row, one after the other, and
//! adds it to what stands there under incremental coordinates. So does an assignment to each cell. A word that is vacant
//! is not there: where a value may be vacant a branch asks. Side conditions: whether coordinates are absolute is known,
//! and the block does nothing else but set that; a sign before what may be vacant is left to a person. A computed value
//! loses no digits that its word would have lost, which is told. Counter-example: `G10 L2 P1 X#1 M8`.

use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::Vacancy;
use crate::ir::{
    BinOp, BlockId, Builder, Cond, Expr, Module, Nc, NcItem, Place, Program, Relation, SourceInfo, Stmt,
    StmtKind, TermKind,
};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::rewrite::{Part, rebuild, unless_skipped};
use std::collections::{BTreeMap, BTreeSet};
use thin_vec::ThinVec;

/// The codes that write tables, and what they write.
const TABLES: [(Op, Sys); 5] = [
    (Op::WriteWork, Sys::WorkOffset),
    (Op::WriteLength, Sys::LengthGeometry),
    (Op::WriteLengthWear, Sys::LengthWear),
    (Op::WriteRadius, Sys::DiameterOrRadius),
    (Op::WriteRadiusWear, Sys::DiameterOrRadiusWear),
];

/// True if the library writes a table by a code, and the target has cells for it and no such code.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    TABLES.iter().any(|(op, _)| features.op(*op) && lacks(*op, context.target))
}

fn lacks(op: Op, target: &Control) -> bool {
    target.code_for(op, &BTreeMap::new()).is_none()
}

/// What a block writes.
struct Writes {
    /// Whether values are added to what stands there.
    adds: bool,
    /// The cells, and the value of each; true where it may be vacant.
    cells: Vec<(Sys, ThinVec<Expr>, Expr, bool)>,
    /// What else stands in the block: it only says how coordinates count.
    rest: Vec<NcItem>,
}

/// Writes such blocks as assignments.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let vacancy = Vacancy::of(program, &summaries, &BTreeSet::new());
        let mut found: BTreeMap<(BlockId, usize), Writes> = BTreeMap::new();
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            let mut stmts = block.stmts.iter();
            vacancy.forward(id, &mut |at, may| {
                let Some(stmt) = stmts.next() else { return };
                let mut words = state.clone();
                stmt.kind.nc().iter().for_each(|nc| words.step_words(nc));
                let absolute = words.op(Group::Distance).map(|op| op == Op::Absolute);
                state.step(stmt);
                match writes(stmt, absolute, &|e| may(e), context.target) {
                    None => {}
                    Some(Ok(writes)) => {
                        if writes.cells.iter().any(|(_, _, value, _)| value.constant().is_none()) {
                            let what = "a value that is computed is written into a table as it is, where the source's \
                                        word loses the digits after its least increment";
                            let finding = Diagnostic::new(Code::NearlyEqual, stmt.site.span, what);
                            context.add_once(index, what, finding);
                        }
                        found.insert((id, at), writes);
                    }
                    Some(Err(what)) => {
                        context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
                    }
                }
            });
        }
        if !found.is_empty() {
            write_out(program, found);
        }
    }
}

/// What a statement writes into tables; none if it writes into none that the target has no code for.
fn writes(
    stmt: &Stmt,
    absolute: Option<bool>,
    may: &dyn Fn(&Expr) -> bool,
    target: &Control,
) -> Option<Result<Writes, &'static str>> {
    const BESIDE: &str = "a code that writes an offset table stands beside other codes or words: write it in a block of its own";
    let nc = stmt.kind.nc()?;
    let (op, state) = TABLES.into_iter().find(|(op, _)| nc.has(*op) && lacks(*op, target))?;
    let mut rest = Vec::new();
    let mut values = Vec::new();
    for item in &nc.items {
        match item {
            NcItem::Op(own) if *own == op => {}
            NcItem::Op(Op::Absolute | Op::Incremental) => rest.push(item.clone()),
            NcItem::Word(Role::OffsetRow, _) => {}
            NcItem::Word(role, value) if op == Op::WriteWork && role.is_axis() => {
                values.push((role.axis_number(), value));
            }
            NcItem::Word(Role::OffsetValue, value) if op != Op::WriteWork => values.push((None, value)),
            _ => return Some(Err(BESIDE)),
        }
    }
    let Some(row) = nc.word(Role::OffsetRow) else {
        return Some(Err("this writes an offset table, and which row of it is not known: write its number"));
    };
    let Some(absolute) = absolute else {
        return Some(Err(
            "it is not known whether G90 or G91 is in force where this writes an offset: write one before it",
        ));
    };
    let mut cells = Vec::new();
    for (axis, value) in values {
        let vacant = value.may_be_vacant() && may(value);
        match value {
            Expr::Vacant => continue,
            Expr::Negate(_) if value_below(value).may_be_vacant() && may(value_below(value)) => {
                let what = "a sign stands before a value that may be vacant where this writes an offset: set it before";
                return Some(Err(what));
            }
            _ => {}
        }
        // Row 0 is the shift of all offsets.
        let (state, subscripts): (Sys, ThinVec<Expr>) = match axis {
            Some(axis) if row.constant() == Some(0.0) => {
                (Sys::ExternalShift, [Expr::Number(f64::from(axis))].into())
            }
            Some(axis) => (state, [row.clone(), Expr::Number(f64::from(axis))].into()),
            None => (state, [row.clone()].into()),
        };
        cells.push((state, subscripts, value.clone(), vacant));
    }
    Some(Ok(Writes { adds: !absolute, cells, rest }))
}

/// What the signs stand before.
fn value_below(value: &Expr) -> &Expr {
    match value {
        Expr::Negate(inner) => value_below(inner),
        value => value,
    }
}

fn write_out(program: &mut Program, mut found: BTreeMap<(BlockId, usize), Writes>) {
    let (mut block, mut at) = (BlockId(0), 0);
    rebuild(program, &mut |builder, part| match part {
        Part::Start(id) => (block, at) = (id, 0),
        Part::Stmt(stmt) => {
            at += 1;
            match found.remove(&(block, at - 1)) {
                Some(writes) => lay(builder, writes, stmt.site),
                None => builder.push(stmt.kind, stmt.site),
            }
        }
        term => term.keep(builder),
    });
}

fn lay(builder: &mut Builder, writes: Writes, site: SourceInfo) {
    let place = SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
    let mut site = Some(site);
    let mut next = || site.take().unwrap_or_else(|| place.clone());
    if !writes.rest.is_empty() || writes.cells.is_empty() {
        let kind =
            if writes.rest.is_empty() { StmtKind::Comment } else { StmtKind::Nc(Nc { items: writes.rest }) };
        builder.push(kind, next());
    }
    for (state, subscripts, value, vacant) in writes.cells {
        let after = vacant.then(|| {
            let (full, after) = (builder.fresh(), builder.fresh());
            unless_skipped(builder, place.skip, after);
            let cond = Cond::Compare(Relation::Equal, value.clone(), Expr::Vacant);
            builder.end(
                TermKind::Branch { cond: Box::new(cond), then: after, otherwise: full },
                SourceInfo::default(),
            );
            builder.start(full);
            after
        });
        let value = match writes.adds {
            true => Expr::binary(BinOp::Add, Expr::System(state, subscripts.clone()), value),
            false => value,
        };
        builder.push(StmtKind::Assign { target: Place::System(state, subscripts), value }, next());
        if let Some(after) = after {
            builder.end(TermKind::Jump(after), SourceInfo::default());
            builder.start(after);
        }
    }
}
