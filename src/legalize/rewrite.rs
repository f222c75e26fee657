//! Rewrites expressions, and puts in front of a statement what a rewriting needs.

mod lay;

use crate::canon::Role;
use crate::ir::{
    BinOp, Block, BlockId, Builder, Call, Callee, Class, Cond, Expr, Nc, NcItem, OutputPart, Place,
    PrintPart, Program, Stmt, StmtKind, TermKind, Terminator, Var,
};
use crate::text::Span;
pub(super) use lay::unless_skipped;
use lay::{insert, lay};
use std::collections::VecDeque;

/// Where an expression stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Position {
    /// The value of a word.
    Word(Role),
    /// The number of a computed code.
    Code,
    /// An argument of a call.
    Argument(u32),
    /// The right side of an assignment.
    Value,
    /// A variable's number or a subscript.
    Subscript,
    /// An operand of a condition.
    Condition,
    /// Something printed.
    Output,
    /// A count, a program number.
    Count,
    /// The target of a computed jump or return.
    Jump,
}

/// What runs before the statement whose expression was rewritten.
#[derive(Clone, Debug, PartialEq)]
pub enum PreStatement {
    /// An assignment.
    Assign(Var, Expr),
    /// An assignment under a condition.
    When(Cond, Var, Expr),
    /// Others, again and again while a condition holds.
    While(Cond, Vec<PreStatement>),
    /// A call.
    Call(Call),
}

/// Collects what must run before a statement.
pub struct Rewriter<'a> {
    prelude: Vec<PreStatement>,
    next_temp: &'a mut u32,
    /// The bytes that the statement came from.
    pub span: Span,
    /// True in the value of a word or a code, and in the subscripts there.
    pub in_word: bool,
}

impl Rewriter<'_> {
    /// A temporary of its own.
    pub fn temp(&mut self) -> Var {
        *self.next_temp += 1;
        Var { class: Class::Temp, number: *self.next_temp }
    }

    /// Runs something first.
    pub fn first(&mut self, step: PreStatement) {
        self.prelude.push(step);
    }

    /// Computes `value` first, and yields the temporary that holds it: an operand, which counts as 0 when vacant,
    /// so that it can be compared like the number it is.
    pub fn materialize(&mut self, value: Expr) -> Var {
        let temp = self.temp();
        let value = match value {
            Expr::Vacant => Expr::Number(0.0),
            value if value.may_be_vacant() => Expr::binary(BinOp::Add, value, Expr::Number(0.0)),
            value => value,
        };
        self.first(PreStatement::Assign(temp, value));
        temp
    }

    /// Like [`Rewriter::materialize`], but leaves constants and temporaries as they are.
    pub fn held(&mut self, value: Expr) -> Expr {
        match value {
            Expr::Number(_) | Expr::Var(Var { class: Class::Temp, .. }) => value,
            other => Expr::Var(self.materialize(other)),
        }
    }
}

/// A part of a program that is rebuilt.
pub(super) enum Part {
    /// The start of a block of the old program, after its labels.
    Start(BlockId),
    /// A statement.
    Stmt(Stmt),
    /// The end of the block.
    Term(Terminator),
}

impl Part {
    /// Lays the part down as it was.
    pub fn keep(self, builder: &mut Builder) {
        match self {
            Part::Start(_) => {}
            Part::Stmt(stmt) => builder.push(stmt.kind, stmt.site),
            Part::Term(term) => builder.end(term.kind, term.site),
        }
    }
}

/// Builds a program anew: `each` is given its parts in their order and lays down what becomes of them. Ids of
/// blocks in what it lays down are those of the old program and those that the builder hands out.
pub(super) fn rebuild(program: &mut Program, each: &mut dyn FnMut(&mut Builder, Part)) {
    rebuild_where(program, &|_| Some(0), each);
}

/// As [`rebuild`]; `more` tells of a block how many statements it gets about, none where it stays as it is.
fn rebuild_where(
    program: &mut Program,
    more: &dyn Fn(BlockId) -> Option<usize>,
    each: &mut dyn FnMut(&mut Builder, Part),
) {
    let mut builder = Builder::over(program.blocks.len());
    for (index, block) in std::mem::take(&mut program.blocks).into_iter().enumerate() {
        let id = BlockId(index as u32);
        builder.start(id);
        let Some(more) = more(id) else {
            builder.keep(block);
            continue;
        };
        builder.reserve(block.stmts.len() + more);
        block.labels.into_iter().for_each(|label| builder.label(label));
        each(&mut builder, Part::Start(id));
        block.stmts.into_iter().for_each(|stmt| each(&mut builder, Part::Stmt(stmt)));
        each(&mut builder, Part::Term(block.term));
    }
    let held = std::mem::take(&mut program.held);
    let rebuilt = builder.finish(program.name.take(), program.file, std::mem::take(&mut program.site));
    *program = Program { held, ..rebuilt };
}

/// Puts blocks before a program, the last of which goes on at the block after them: ids of the program's own blocks move.
pub(super) fn put_first(program: &mut Program, mut blocks: Vec<Block>) {
    let shift = blocks.len() as u32;
    for block in &mut program.blocks {
        block.term.kind.for_each_target(&mut |to| to.0 += shift);
        for stmt in &mut block.stmts {
            if let StmtKind::ModalCall(call) = &mut stmt.kind
                && let Callee::Block(entry) = &mut call.callee
            {
                entry.0 += shift;
            }
        }
    }
    blocks.append(&mut program.blocks);
    program.blocks = blocks;
}

/// Picks the expressions that [`rewrite_program`] is about.
pub type Wanted = fn(&Expr) -> bool;

/// The function that [`rewrite_program`] calls on these, innermost first.
pub type Rewrite<'f> = dyn FnMut(Expr, Position, &mut Rewriter<'_>) -> Expr + 'f;

/// Calls `rewrite` on every expression of a program that is `wanted`, innermost first, and
/// lays what it wants done first before the statement.
///
/// Statements keep their order; a prelude runs right before its statement, so
/// what it reads is what the expression would have read. True where any expression was wanted.
pub fn rewrite_program(program: &mut Program, wanted: Wanted, rewrite: &mut Rewrite<'_>) -> bool {
    let mut any = false;
    let rewrite: &mut Rewrite<'_> = &mut |e, position, rewriter: &mut Rewriter<'_>| {
        any = true;
        rewrite(e, position, rewriter)
    };
    let mut next_temp = highest_temp(program);
    let mut preludes: VecDeque<(usize, usize, Vec<PreStatement>)> = VecDeque::new();
    for (id, block) in program.blocks.iter_mut().enumerate() {
        let mut each = |at: usize, span: Span, walk: &mut dyn FnMut(&mut Each<'_>)| {
            let mut rewriter =
                Rewriter { prelude: Vec::new(), next_temp: &mut next_temp, span, in_word: false };
            walk(&mut |e, p| {
                rewriter.in_word = matches!(p, Position::Word(_) | Position::Code);
                map(e, p, wanted, rewrite, &mut rewriter);
            });
            if !rewriter.prelude.is_empty() {
                preludes.push_back((id, at, rewriter.prelude));
            }
        };
        for (at, stmt) in block.stmts.iter_mut().enumerate() {
            each(at, stmt.site.span, &mut |f| statement(&mut stmt.kind, f));
        }
        let end = block.stmts.len();
        each(end, block.term.site.span, &mut |f| terminator(&mut block.term.kind, f));
    }
    if preludes.iter().flat_map(|(.., steps)| steps).all(|step| matches!(step, PreStatement::Assign(..))) {
        // Blocks stay what they are.
        insert(program, preludes);
        return any;
    }
    let mut place = (0, 0);
    let mut counts: Vec<(usize, usize)> = Vec::new();
    for (id, _, steps) in &preludes {
        match counts.last_mut() {
            Some((last, count)) if last == id => *count += steps.len(),
            _ => counts.push((*id, steps.len())),
        }
    }
    let more = |id: BlockId| {
        let at = counts.binary_search_by_key(&id.index(), |(id, _)| *id);
        at.ok().map(|at| counts[at].1)
    };
    rebuild_where(program, &more, &mut |builder, part| {
        let site = match &part {
            Part::Start(id) => {
                place = (id.index(), 0);
                return;
            }
            Part::Stmt(stmt) => &stmt.site,
            Part::Term(term) => &term.site,
        };
        if let Some(prelude) = next_at(&mut preludes, place) {
            lay(builder, prelude, site);
        }
        place.1 += 1;
        part.keep(builder);
    });
    true
}

/// What runs first at a place, where that is the next one that something does at.
fn next_at(
    preludes: &mut VecDeque<(usize, usize, Vec<PreStatement>)>,
    place: (usize, usize),
) -> Option<Vec<PreStatement>> {
    preludes.front().filter(|(id, at, _)| (*id, *at) == place)?;
    preludes.pop_front().map(|(.., prelude)| prelude)
}

/// Applies `rewrite` to the parts of an expression that are wanted, then to itself where it is.
fn map(
    e: &mut Expr,
    position: Position,
    wanted: Wanted,
    rewrite: &mut Rewrite<'_>,
    rewriter: &mut Rewriter<'_>,
) {
    let mut part = |e: &mut Expr, position| map(e, position, wanted, rewrite, rewriter);
    match e {
        Expr::Negate(a) => part(a, position),
        Expr::Binary(_, operands) => operands.iter_mut().for_each(|a| part(a, position)),
        Expr::Indirect(_, index) => part(index, Position::Subscript),
        Expr::System(_, subscripts) => subscripts.iter_mut().for_each(|s| part(s, Position::Subscript)),
        Expr::Call(_, arguments) => arguments.iter_mut().for_each(|a| part(a, position)),
        Expr::Truth(cond) => condition(cond, &mut part),
        Expr::Number(_) | Expr::Increments(_) | Expr::Vacant | Expr::Var(_) => {}
    }
    if wanted(e) {
        *e = rewrite(std::mem::replace(e, Expr::Vacant), position, rewriter);
    }
}

type Each<'f> = dyn FnMut(&mut Expr, Position) + 'f;

fn place(target: &mut Place, f: &mut Each<'_>) {
    match target {
        Place::Var(_) => {}
        Place::Indirect(_, index) => f(index, Position::Subscript),
        Place::System(_, subscripts) => {
            subscripts.iter_mut().for_each(|s| f(s, Position::Subscript));
        }
    }
}

fn condition(cond: &mut Cond, f: &mut Each<'_>) {
    match cond {
        Cond::Compare(_, a, b) => {
            f(a, Position::Condition);
            f(b, Position::Condition);
        }
        Cond::And(parts) | Cond::Or(parts) => parts.iter_mut().for_each(|part| condition(part, f)),
        Cond::Not(inner) => condition(inner, f),
        Cond::Switch(_) => {}
    }
}

fn call(call: &mut Call, f: &mut Each<'_>) {
    if let crate::ir::Callee::Computed(e) = &mut call.callee {
        f(e, Position::Count);
    }
    for argument in &mut call.arguments {
        f(&mut argument.value, Position::Argument(argument.local));
    }
    call.count.iter_mut().for_each(|count| f(count, Position::Count));
}

fn nc(nc: &mut Nc, f: &mut Each<'_>) {
    for item in &mut nc.items {
        match item {
            NcItem::Op(_) => {}
            NcItem::Word(role, value) => f(value, Position::Word(*role)),
            NcItem::Code(_, value) => f(value, Position::Code),
        }
    }
}

/// Calls `f` on each whole expression of a statement.
pub(super) fn statement(kind: &mut StmtKind, f: &mut Each<'_>) {
    match kind {
        StmtKind::Assign { target, value } => {
            f(value, Position::Value);
            place(target, f);
        }
        StmtKind::Nc(block) => nc(block, f),
        StmtKind::ModalCall(c) => call(c, f),
        StmtKind::Alarm { number, .. } | StmtKind::StopMessage { number, .. } => {
            f(number, Position::Count);
        }
        StmtKind::Output(parts) => {
            for part in parts {
                if let OutputPart::Value { value, .. } = part {
                    f(value, Position::Output);
                }
            }
        }
        StmtKind::Print { parts, .. } => {
            for part in parts {
                if let PrintPart::Value(value) = part {
                    f(value, Position::Output);
                }
            }
        }
        StmtKind::Input { target, .. } => place(target, f),
        StmtKind::LimitLookahead(blocks) => f(blocks, Position::Count),
        _ => {}
    }
}

/// Calls `f` on each whole expression of a terminator.
pub(super) fn terminator(kind: &mut TermKind, f: &mut Each<'_>) {
    match kind {
        TermKind::Branch { cond, .. } => condition(cond, f),
        TermKind::Computed { value, .. } => f(value, Position::Jump),
        TermKind::Call { call: c, .. } => call(c, f),
        TermKind::Return { to: Some(to) } => f(to, Position::Jump),
        _ => {}
    }
}

/// The highest number of a temporary in a program.
pub(in crate::legalize) fn highest_temp(program: &Program) -> u32 {
    program.temporaries().map(|var| var.number).max().unwrap_or(0)
}
