//! Variables by a computed number, on a target whose variables have no computed numbers.
//!
//! Law: a statement with the variable of a number that is one of a few does what the same statement with that variable
//! does. So it becomes a comparison with each number, and the statement with its variable after it; a branch or a call
//! alike. Where a number may come that is none of them, because an operator edits a literal, an alarm stands after the
//! last. Side conditions: the numbers are whole and few, each is that of a variable of the source, and the statement
//! computes one number only. Counter-example: `#[#1+100]` where a macro is called with any #1.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::{Numbers, Ranges, Summaries};
use crate::ir::{
    Bank, BlockId, Builder, Class, Cond, Expr, Module, Place, Program, Relation, SourceInfo, Stmt, StmtKind,
    TermKind, Terminator, Var,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::{Part, highest_temp, rebuild, unless_skipped};
use std::collections::BTreeMap;

/// Most numbers that a statement is written out for.
const MOST: u32 = 10;

/// True if the library computes numbers of variables, and the target takes none.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::Indirect) && context.target.statement("variable.computed").is_none()
}

/// Writes statements out.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let summaries = context.summaries(module);
    let mut any = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let chains = chains(program, &summaries, context.source);
        for (span, chain) in chains.values() {
            if chain.may_miss {
                let what = "the number of this variable is computed: it is one of a few as the numbers in the program have \
                            it, and any other stops with an alarm";
                context.add_once(index, what, Diagnostic::new(Code::Conditional, *span, what));
            }
        }
        any |= !chains.is_empty();
        if !chains.is_empty() {
            write_out(program, chains);
        }
    }
    any
}

/// The variable that a statement computes the number of.
type Computed = (Bank, Expr);

struct Chain {
    of: Computed,
    choices: Vec<(u32, Var)>,
    /// The number may be none of them.
    may_miss: bool,
}

type Chains = BTreeMap<(BlockId, usize), (crate::text::Span, Chain)>;

fn chains(program: &Program, summaries: &Summaries, source: &Control) -> Chains {
    let (ranges, any) = (Ranges::of(program, summaries), Ranges::of_any_inputs(program, summaries));
    let mut found = Chains::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        let stmts = block.stmts.iter().map(|stmt| (in_stmt(&stmt.kind), stmt.site.span));
        let end = std::iter::once((in_end(&block.term.kind), block.term.site.span));
        for (at, (of, span)) in stmts.chain(end).enumerate() {
            let Some((bank, number)) = of else { continue };
            let numbers = |ranges: &Ranges<'_>| {
                let values = ranges.at(id, at, &number);
                (values.all_whole() && values.bounds().is_some_and(|(low, _)| low >= 1.0))
                    .then(|| values.numbers())
            };
            let Some(all) = numbers(&ranges) else { continue };
            let count: u32 = all.runs().iter().map(|(first, last)| last - first + 1).sum();
            if count == 0 || count > MOST {
                continue;
            }
            let each = all.runs().iter().flat_map(|(first, last)| *first..=*last);
            let choices: Option<Vec<(u32, Var)>> =
                each.map(|number| Some((number, variable(bank, number, source)?))).collect();
            let Some(choices) = choices else { continue };
            let known = Numbers::of(choices.iter().map(|(number, _)| (*number, *number)));
            let may_miss = numbers(&any).is_none_or(|any| !known.holds(&any));
            found.insert((id, at), (span, Chain { of: (bank, number), choices, may_miss }));
        }
    }
    found
}

/// The variable of a number.
fn variable(bank: Bank, number: u32, source: &Control) -> Option<Var> {
    let class = match bank {
        Bank::Global => Class::Global,
        Bank::Parametric => Class::Parametric,
        Bank::Numbered => match source.numbered_class(number)?.class.as_str() {
            "local" => Class::Local,
            "common" => Class::Common,
            "retained" => Class::Retained,
            _ => return None,
        },
    };
    let there = |name: &str| {
        source.classes().iter().any(|row| row.class == name && (row.first..=row.last).contains(&number))
    };
    let exists = bank.class().is_none_or(there);
    exists.then_some(Var { class, number })
}

/// The one computed variable of a statement; none if there are more, or the number itself has one in it.
fn one(all: Vec<Computed>) -> Option<Computed> {
    let first = all.first()?.clone();
    let mut nested = false;
    first.1.walk(&mut |e| nested |= matches!(e, Expr::Indirect(..)));
    (!nested && all.iter().all(|other| *other == first)).then_some(first)
}

fn note(e: &Expr, all: &mut Vec<Computed>) {
    e.walk(&mut |e| {
        if let Expr::Indirect(bank, number) = e {
            all.push((*bank, (**number).clone()));
        }
    });
}

fn in_stmt(kind: &StmtKind) -> Option<Computed> {
    if matches!(kind, StmtKind::ModalCall(_)) {
        return None;
    }
    let mut all = Vec::new();
    kind.exprs(&mut |e| note(e, &mut all));
    if let Some(place) = kind.target() {
        note(&place.read(), &mut all);
    }
    one(all)
}

fn in_end(kind: &TermKind) -> Option<Computed> {
    let mut all = Vec::new();
    kind.exprs(&mut |e| note(e, &mut all));
    one(all)
}

/// Puts a variable in the place of the computed one.
fn put(e: &mut Expr, of: &Computed, var: Var) {
    e.walk_mut(&mut |e| {
        if matches!(e, Expr::Indirect(bank, number) if *bank == of.0 && **number == of.1) {
            *e = Expr::Var(var);
        }
    });
}

fn put_in_stmt(kind: &mut StmtKind, of: &Computed, var: Var) {
    kind.exprs_mut(&mut |e| put(e, of, var));
    if let StmtKind::Assign { target, .. } | StmtKind::Input { target, .. } = kind {
        match target {
            Place::Indirect(..) => *target = Place::Var(var),
            Place::System(_, subscripts) => subscripts.iter_mut().for_each(|e| put(e, of, var)),
            Place::Var(_) => {}
        }
    }
}

fn write_out(program: &mut Program, mut chains: Chains) {
    let temp = Var { class: Class::Temp, number: highest_temp(program) + 1 };
    let mut place = (BlockId(0), 0);
    rebuild(program, &mut |builder, part| {
        let chain = match &part {
            Part::Start(id) => {
                place = (*id, 0);
                return;
            }
            _ => chains.remove(&place),
        };
        place.1 += 1;
        match (chain, part) {
            (Some((_, chain)), Part::Stmt(stmt)) => statement(builder, &chain, temp, stmt),
            (Some((_, chain)), Part::Term(term)) => end(builder, &chain, temp, term),
            (_, part) => part.keep(builder),
        }
    });
}

/// The number, where it can be compared.
fn number(builder: &mut Builder, chain: &Chain, temp: Var, place: &SourceInfo) -> Expr {
    match &chain.of.1 {
        Expr::Var(var) if !var.class.nullable() => Expr::Var(*var),
        value => {
            // What is vacant counts as 0 in a number.
            let value = match value.may_be_vacant() {
                true => Expr::binary(crate::ir::BinOp::Add, value.clone(), Expr::Number(0.0)),
                false => value.clone(),
            };
            builder.push(StmtKind::Assign { target: Place::Var(temp), value }, place.clone());
            Expr::Var(temp)
        }
    }
}

/// One branch for each number, and an alarm after the last where another may come; `lay` ends each.
fn branches(
    builder: &mut Builder,
    chain: &Chain,
    temp: Var,
    place: &SourceInfo,
    lay: &mut dyn FnMut(&mut Builder, Var),
) {
    let value = number(builder, chain, temp, place);
    let last = chain.choices.last().filter(|_| !chain.may_miss);
    let count = chain.choices.len() - usize::from(last.is_some());
    for (number, var) in &chain.choices[..count] {
        let (then, otherwise) = (builder.fresh(), builder.fresh());
        let cond = Cond::Compare(Relation::Equal, value.clone(), Expr::Number(f64::from(*number)));
        builder.end(TermKind::Branch { cond, then, otherwise }, place.clone());
        builder.start(then);
        lay(builder, *var);
        builder.start(otherwise);
    }
    match last {
        Some((_, var)) => lay(builder, *var),
        None => {
            let alarm = StmtKind::Alarm { number: Expr::Number(1.0), text: "NO SUCH VARIABLE".into() };
            builder.push(alarm, place.clone());
            builder.end(TermKind::End { rewind: false }, place.clone());
        }
    }
}

fn statement(builder: &mut Builder, chain: &Chain, temp: Var, stmt: Stmt) {
    let Stmt { kind, mut site } = stmt;
    let place = SourceInfo { span: site.span, ..SourceInfo::default() };
    let after = builder.fresh();
    let skip = site.skip.take();
    // Comments and number stand at the head.
    if !site.comments.is_empty() || site.sequence.is_some() {
        builder.push(StmtKind::Comment, site);
    }
    unless_skipped(builder, skip, after);
    branches(builder, chain, temp, &place, &mut |builder, var| {
        let mut kind = kind.clone();
        put_in_stmt(&mut kind, &chain.of, var);
        builder.push(kind, place.clone());
        builder.end(TermKind::Jump(after), SourceInfo::default());
    });
    builder.start(after);
}

fn end(builder: &mut Builder, chain: &Chain, temp: Var, term: Terminator) {
    let Terminator { kind, site } = term;
    let place = SourceInfo { span: site.span, ..SourceInfo::default() };
    if !site.comments.is_empty() || site.sequence.is_some() {
        builder.push(StmtKind::Comment, site);
    }
    branches(builder, chain, temp, &place, &mut |builder, var| {
        let mut kind = kind.clone();
        kind.exprs_mut(&mut |e| put(e, &chain.of, var));
        builder.end(kind, place.clone());
    });
}
