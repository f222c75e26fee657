//! Variables by a computed number, on a target whose variables have no computed numbers.
//!
//! Law: a statement with the variable of a number that is one of a few does what the same statement with that variable
//! does. So it becomes a comparison with each number, and the statement with its variable after it; a branch or a call
//! alike. Where several numbers hang on one variable, its values are compared, which each say all of them. Where a number
//! may come that is none of them, because an operator edits a literal, an alarm stands after the last. Side conditions: the
//! numbers are whole and few, and each is that of a variable of the source. What a macro is called with counts where all calls
//! of the library give literals ([`given`]). Counter-example: `#[#1+100]` where a macro is called with any #1.

mod given;

use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::{Numbers, Ranges, Summaries};
use crate::ir::eval::{self, Memory, whole};
use crate::ir::{
    Bank, BlockId, Builder, Class, Cond, Expr, Module, Place, Program, Relation, SourceInfo, Stmt, StmtKind,
    TermKind, Terminator, Var,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::{Part, highest_temp, rebuild, unless_skipped};
use given::Given;
use std::collections::{BTreeMap, BTreeSet};

/// Most numbers that a statement is written out for: where the target takes computed numbers, of its own variables, and
/// where it takes none, which is a target with few labels.
const MOST: u32 = 32;
const FEW: u32 = 10;

/// True if the library computes numbers of variables, and the target takes none of such variables.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::Indirect) && (takes_none(context.target) || context.target.numbered().is_none())
}

/// True if the target takes no variable by a computed number.
pub(super) fn takes_none(target: &Control) -> bool {
    target.statement("variable.computed").is_none()
}

/// Writes statements out.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let summaries = context.summaries(module);
    let given = given::given(module);
    let mut any = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let given = program.name.as_ref().and_then(|name| given.get(name));
        let chains = chains(program, &summaries, given, context);
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
    of: Vec<Computed>,
    /// What is compared: the number itself, or the variable that all of the numbers hang on.
    on: Expr,
    /// For each of its values the variables.
    choices: Vec<(u32, Vec<Var>)>,
    /// It may be none of them.
    may_miss: bool,
}

type Chains = BTreeMap<(BlockId, usize), (crate::text::Span, Chain)>;

fn chains(program: &Program, summaries: &Summaries, given: Option<&Given>, context: &Context<'_>) -> Chains {
    let (source, target) = (context.source, context.target);
    let most = if takes_none(target) { FEW } else { MOST };
    let there = |(bank, _): &Computed| *bank != Bank::Numbered || target.numbered().is_some();
    let (ranges, any) = (Ranges::of(program, summaries), Ranges::of_any_inputs(program, summaries));
    let mut found = Chains::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        let stmts = block.stmts.iter().map(|stmt| (in_stmt(&stmt.kind), stmt.site.span));
        let end = std::iter::once((in_end(&block.term.kind), block.term.site.span));
        for (at, (of, span)) in stmts.chain(end).enumerate() {
            if of.is_empty() || !takes_none(target) && of.iter().all(there) {
                continue;
            }
            let Some(on) = compared(&of) else { continue };
            let least = if of.len() == 1 { 1.0 } else { 0.0 };
            let numbers = |ranges: &Ranges<'_>| {
                let values = ranges.at(id, at, &on);
                (values.all_whole() && values.bounds().is_some_and(|(low, _)| low >= least))
                    .then(|| values.numbers())
            };
            let of_calls = || {
                let values = given::values(&on, given.filter(|_| of.len() == 1)?)?;
                Some(Numbers::of(values.into_iter().map(|number| (number, number))))
            };
            let few =
                |all: &Numbers| all.runs().iter().map(|(first, last)| last - first + 1).sum::<u32>() <= most;
            let Some(all) = numbers(&ranges).filter(few).or_else(of_calls) else { continue };
            let count: u32 = all.runs().iter().map(|(first, last)| last - first + 1).sum();
            if count == 0 || count > most {
                continue;
            }
            let each = all.runs().iter().flat_map(|(first, last)| *first..=*last);
            let choices: Option<Vec<(u32, Vec<Var>)>> =
                each.map(|value| Some((value, variables(&of, &on, value, source)?))).collect();
            let Some(choices) = choices else { continue };
            let known = Numbers::of(choices.iter().map(|(number, _)| (*number, *number)));
            let may_miss = numbers(&any).is_none_or(|any| !known.holds(&any));
            found.insert((id, at), (span, Chain { of, on, choices, may_miss }));
        }
    }
    found
}

/// What a chain compares: the number of one variable, or the variable that the numbers of several hang on.
fn compared(of: &[Computed]) -> Option<Expr> {
    if let [(_, number)] = of {
        return Some(number.clone());
    }
    let mut all = BTreeSet::new();
    for (_, number) in of {
        number.variables(&mut |var| {
            all.insert(var);
        });
    }
    match (all.pop_first(), all.is_empty()) {
        (Some(var), true) => Some(Expr::Var(var)),
        _ => None,
    }
}

/// The variables whose numbers are computed, where what is compared has a value; none if one of them has no variable.
fn variables(of: &[Computed], on: &Expr, value: u32, source: &Control) -> Option<Vec<Var>> {
    let value = Expr::Number(f64::from(value));
    let each = of.iter().map(|(bank, number)| {
        let mut number = number.clone();
        number.walk_mut(&mut |e| {
            if e == on {
                *e = value.clone();
            }
        });
        let number = eval::number(&number, &Memory::new()).ok().filter(|number| number.fract() == 0.0)?;
        variable(*bank, whole(number)?, source)
    });
    each.collect()
}

/// The variable of a number.
pub(super) fn variable(bank: Bank, number: u32, source: &Control) -> Option<Var> {
    let name = source.numbered().filter(|_| bank == Bank::Numbered);
    let number = name.map_or(number, |name| source.cell(name, number));
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

/// The computed variables of a statement, each once; none if a number has one in it.
fn each_once(all: Vec<Computed>) -> Vec<Computed> {
    let mut nested = false;
    let mut found: Vec<Computed> = Vec::new();
    for one in all {
        one.1.walk(&mut |e| nested |= matches!(e, Expr::Indirect(..)));
        if !found.contains(&one) {
            found.push(one);
        }
    }
    if nested { Vec::new() } else { found }
}

fn note(e: &Expr, all: &mut Vec<Computed>) {
    e.walk(&mut |e| {
        if let Expr::Indirect(bank, number) = e {
            all.push((*bank, (**number).clone()));
        }
    });
}

fn in_stmt(kind: &StmtKind) -> Vec<Computed> {
    if matches!(kind, StmtKind::ModalCall(_)) {
        return Vec::new();
    }
    let mut all = Vec::new();
    kind.exprs(&mut |e| note(e, &mut all));
    if let Some(place) = kind.target() {
        note(&place.read(), &mut all);
    }
    each_once(all)
}

fn in_end(kind: &TermKind) -> Vec<Computed> {
    let mut all = Vec::new();
    kind.exprs(&mut |e| note(e, &mut all));
    each_once(all)
}

/// Which variable stands for which computed one.
struct Named<'n> {
    of: &'n [Computed],
    vars: &'n [Var],
}

impl Named<'_> {
    fn var(&self, bank: Bank, number: &Expr) -> Option<Var> {
        let at = self.of.iter().position(|(other, of)| *other == bank && of == number)?;
        self.vars.get(at).copied()
    }

    /// Puts the variables in the place of the computed ones.
    fn put(&self, e: &mut Expr) {
        e.walk_mut(&mut |e| {
            if let Expr::Indirect(bank, number) = e
                && let Some(var) = self.var(*bank, number)
            {
                *e = Expr::Var(var);
            }
        });
    }

    fn put_in_stmt(&self, kind: &mut StmtKind) {
        kind.exprs_mut(&mut |e| self.put(e));
        if let StmtKind::Assign { target, .. } | StmtKind::Input { target, .. } = kind {
            match target {
                Place::Indirect(bank, number) => {
                    if let Some(var) = self.var(*bank, number) {
                        *target = Place::Var(var);
                    }
                }
                Place::System(_, subscripts) => subscripts.iter_mut().for_each(|e| self.put(e)),
                Place::Var(_) => {}
            }
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
    match &chain.on {
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
    lay: &mut dyn FnMut(&mut Builder, Named<'_>),
) {
    let value = number(builder, chain, temp, place);
    let last = chain.choices.last().filter(|_| !chain.may_miss);
    let count = chain.choices.len() - usize::from(last.is_some());
    for (number, vars) in &chain.choices[..count] {
        let (then, otherwise) = (builder.fresh(), builder.fresh());
        let cond = Cond::Compare(Relation::Equal, value.clone(), Expr::Number(f64::from(*number)));
        builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, place.clone());
        builder.start(then);
        lay(builder, Named { of: &chain.of, vars });
        builder.start(otherwise);
    }
    match last {
        Some((_, vars)) => lay(builder, Named { of: &chain.of, vars }),
        None => {
            let alarm = StmtKind::Alarm { number: Expr::Number(1.0).into(), text: "NO SUCH VARIABLE".into() };
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
    branches(builder, chain, temp, &place, &mut |builder, named| {
        let mut kind = kind.clone();
        named.put_in_stmt(&mut kind);
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
    branches(builder, chain, temp, &place, &mut |builder, named| {
        let mut kind = kind.clone();
        kind.exprs_mut(&mut |e| named.put(e));
        builder.end(kind, place.clone());
    });
}
