//! Programs built by hand, with the text that the manuals' syntax has for them. Every text
//! that is emitted is also read back by the target's parser.

mod expressions;
mod flow;
mod labels;
mod statements;
mod words;

use crate::canon::{Func, Op, Role};
use crate::diag::{Code, Severity};
use crate::dialect::{Control, registry};
use crate::emit::{Emitted, Naming, Register};
use crate::ir::*;
use crate::syntax::{ItemKind, Label, ProgramName};
use crate::text::{Lines, Span};

/// Locals, commons and retained variables keep their numbers.
fn names() -> Naming {
    let mut names = Naming::new();
    let classes = [(Class::Local, 1..34), (Class::Common, 100..200), (Class::Retained, 500..1000)];
    for (class, numbers) in classes {
        for number in numbers {
            names.set_variable(Var { class, number }, Register::number("#", number));
        }
    }
    names.set_program(ProgramName::Name("SUB".into()), 8000);
    names
}

fn emit_with(
    dialect: &str,
    program: &Program,
    names: &Naming,
) -> Result<Emitted, Vec<crate::diag::Diagnostic>> {
    let control = Control::plain(dialect).unwrap();
    registry::find(dialect).unwrap().emit.unwrap()(names, &control)(Valid::unchecked(program))
}

/// The text of a program, which the target reads without error.
fn text(dialect: &str, program: &Program) -> String {
    let emitted = emit_with(dialect, program, &names()).unwrap_or_else(|faults| panic!("{faults:#?}"));
    assert_reads(dialect, &emitted.text);
    for (_, range) in &emitted.blocks {
        assert!(!emitted.text[range.clone()].contains('\n'), "{range:?} is not one line");
    }
    emitted.text
}

fn assert_reads(dialect: &str, text: &str) {
    let parser = registry::find(dialect).unwrap().parse;
    for line in Lines::new(text.as_bytes()) {
        let mut blocks = Vec::new();
        parser(text.as_bytes(), line.text, &mut blocks);
        for block in &blocks {
            assert!(!block.items.iter().any(|item| item.kind == ItemKind::Unparsed), "unread in {text}");
            let fault = block.errors.iter().find(|error| error.code.severity() == Severity::Error);
            assert!(fault.is_none(), "{fault:?} in\n{text}");
        }
    }
}

/// What refuses the program.
fn refused(dialect: &str, program: &Program) -> Vec<Code> {
    let faults = emit_with(dialect, program, &names()).expect_err("the program is written");
    faults.into_iter().map(|fault| fault.code).collect()
}

/// A program of one block.
fn one(kinds: impl IntoIterator<Item = StmtKind>) -> Program {
    let mut builder = Builder::new();
    kinds.into_iter().for_each(|kind| builder.push(kind, SourceInfo::default()));
    builder.finish(None, 0, SourceInfo::default())
}

/// The lines of one statement, without the last line feed.
fn line(dialect: &str, kind: StmtKind) -> String {
    text(dialect, &one([kind])).trim_end().to_owned()
}

fn local(number: u32) -> Var {
    let class = match number {
        1..34 => Class::Local,
        100..200 => Class::Common,
        _ => Class::Retained,
    };
    Var { class, number }
}

fn v(number: u32) -> Expr {
    Expr::Var(local(number))
}

fn n(value: f64) -> Expr {
    Expr::Number(value)
}

fn bin(op: BinOp, a: Expr, b: Expr) -> Expr {
    Expr::binary(op, a, b)
}

fn add(a: Expr, b: Expr) -> Expr {
    bin(BinOp::Add, a, b)
}

fn sub(a: Expr, b: Expr) -> Expr {
    bin(BinOp::Sub, a, b)
}

fn mul(a: Expr, b: Expr) -> Expr {
    bin(BinOp::Mul, a, b)
}

fn div(a: Expr, b: Expr) -> Expr {
    bin(BinOp::Div, a, b)
}

fn neg(a: Expr) -> Expr {
    Expr::Negate(Box::new(a))
}

fn call(function: Func, arguments: impl Into<thin_vec::ThinVec<Expr>>) -> Expr {
    Expr::Call(function, arguments.into())
}

fn indirect(index: Expr) -> Expr {
    Expr::Indirect(Bank::Numbered, Box::new(index))
}

fn set(number: u32, value: Expr) -> StmtKind {
    StmtKind::Assign { target: Place::Var(local(number)), value }
}

fn nc(items: impl Into<Vec<NcItem>>) -> StmtKind {
    StmtKind::Nc(Nc { items: items.into() })
}

fn op(op: Op) -> NcItem {
    NcItem::Op(op)
}

fn word(role: Role, value: Expr) -> NcItem {
    NcItem::Word(role, value)
}

/// A move along X, for bodies.
fn mv(x: f64) -> StmtKind {
    nc([word(Role::X, n(x))])
}

fn compare(relation: Relation, a: Expr, b: Expr) -> Cond {
    Cond::Compare(relation, a, b)
}

/// `#number GT limit`.
fn gt(number: u32, limit: f64) -> Cond {
    compare(Relation::Greater, v(number), n(limit))
}

/// A site of its own bytes.
fn site(at: u32) -> SourceInfo {
    SourceInfo { span: Span::new(at * 10, at * 10 + 9), ..SourceInfo::default() }
}

/// A site with a sequence number.
fn numbered(at: u32, sequence: u32) -> SourceInfo {
    SourceInfo { sequence: Some(sequence).into(), ..site(at) }
}

fn comment(text: &str, leading: bool) -> Comment {
    Comment { text: text.into(), leading }
}

/// A program laid out by hand: labels, statements and end of each block.
fn blocks<const N: usize>(blocks: [(&[u32], Vec<StmtKind>, TermKind); N]) -> Program {
    let blocks = blocks.into_iter().map(|(labels, stmts, kind)| Block {
        labels: labels.iter().map(|n| Label::Number(*n)).collect(),
        stmts: stmts.into_iter().map(|kind| Stmt { kind, site: SourceInfo::default() }).collect(),
        term: Terminator { kind, site: SourceInfo::default() },
    });
    Program { name: None, file: 0, site: SourceInfo::default(), held: Vec::new(), blocks: blocks.collect() }
}

fn jump(to: u32) -> TermKind {
    TermKind::Jump(BlockId(to))
}

fn branch(cond: Cond, then: u32, otherwise: u32) -> TermKind {
    TermKind::Branch { cond: Box::new(cond), then: BlockId(then), otherwise: BlockId(otherwise) }
}

const END: TermKind = TermKind::End { rewind: true };
const RETURN: TermKind = TermKind::Return { to: None };
