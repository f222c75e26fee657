//! Going on in another program for good, and returning to a sequence number of the caller.

use crate::assume::Predicate;
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::computed_calls::computed_calls;
use crate::ir::{
    BlockId, Call, Callee, Class, Cond, Expr, Module, Nc, NcItem, Place, Program, Relation, SourceInfo,
    StmtKind, TermKind, Terminator, Var,
};
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use crate::legalize::{Context, calls_of, reachable};
use crate::syntax::{Label, ProgramName};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// Up to so many returns of a callee are told apart by comparisons.
const FEW: usize = 4;

/// The register that carries a return's sequence number, by its number in [`Class::Register`].
const RETURN_TO: u32 = 1;

/// Replaces a jump to another program by a stop, a call and the end of the run.
///
/// Law: the source stops and waits for the operator's start, runs the other program and never comes
/// back; a stop, a call and an end do that. Side condition: the call takes a level of nesting.
pub fn chain(module: &mut Module, context: &mut Context<'_>) {
    if context.target.statement("start").is_some() {
        return;
    }
    for (index, program) in module.programs.iter_mut().enumerate() {
        if !program.blocks.iter().any(|b| matches!(b.term.kind, TermKind::Chain(_))) {
            continue;
        }
        rebuild(program, &mut |builder, part| match part {
            Part::Term(Terminator { kind: TermKind::Chain(name), site }) => {
                let span = site.span;
                let why = "going on in another program becomes a stop, a call of that program, and an end \
                           after it returns";
                context.add(index, Diagnostic::new(Code::Conditional, span, why));
                builder.push(StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::Stop)] }), site);
                let callee = Callee::Program(name);
                let call = Call { callee, level: false, arguments: Vec::new(), count: None };
                builder.end_then(SourceInfo::default(), |next| TermKind::Call { call: Box::new(call), next });
                builder.end(TermKind::End { rewind: true }, SourceInfo { span, ..SourceInfo::default() });
            }
            other => other.keep(builder),
        });
    }
}

/// Returns to a sequence number of the caller by a register that each caller looks at.
///
/// Law: the callee leaves the number in a register and returns; after the call, the caller jumps to
/// the block of that number, and goes on where it is 0. Side conditions: every caller is in the
/// library; a call is not repeated, for such a return ends its repeats. A caller that lacks the number
/// goes on after the call where the source would alarm. A program that nothing calls is a main program, in which
/// the return is a jump; so is one that only a call by an unknown number might run, from a program without such a block.
pub fn return_to(module: &mut Module, context: &mut Context<'_>) {
    if context.target.statement("return.to.sequence").is_some() && !context.target.is(Question::M99PJumpsHere)
    {
        return;
    }
    let mut numbers: BTreeMap<ProgramName, Vec<u32>> = BTreeMap::new();
    let register = Var { class: Class::Register, number: RETURN_TO };
    let Callers { called, guessed } = Callers::of(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let inside = subroutines_that_return_to(program);
        let main = inside.is_empty() && !program.name.as_ref().is_some_and(|name| called.contains(name));
        let guess = guessed.get(&index);
        for span in inside {
            let why = "a subroutine inside the program returns to a block by its number: the target cannot";
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
        }
        let own = if main { places(program) } else { BTreeMap::new() };
        let ends = program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::End { .. }));
        for block in &mut program.blocks {
            let TermKind::Return { to } = &mut block.term.kind else { continue };
            let Some(wanted) = to.take() else { continue };
            let span = block.term.site.span;
            if let Some(to) = wanted.constant().and_then(|number| own.get(&(number as u32))) {
                block.term.kind = TermKind::Jump(*to);
                let both = guess
                    .is_some_and(|labels| wanted.constant().is_some_and(|n| labels.contains(&(n as u32))));
                let finding = match guess {
                    _ if both => Diagnostic::new(Code::NoEquivalent, span, EITHER).with_help(EITHER_HELP),
                    Some(_) => Diagnostic::new(Code::Conditional, span, BY_NUMBER).assuming(Predicate::Main),
                    // One that ends the run is a main program: the question is the library's, if other files may call it.
                    None if ends || is_numbered_as_main(program.name.as_ref(), context.source) => {
                        Diagnostic::new(Code::Conditional, span, UNCALLED)
                            .assuming(Predicate::Main)
                            .asked_once()
                    }
                    None => Diagnostic::new(Code::Conditional, span, UNCALLED).assuming(Predicate::Main),
                };
                context.add(index, finding);
                continue;
            }
            match (wanted.constant().filter(|n| *n >= 1.0), &program.name) {
                (Some(number), Some(_)) if main && guess.is_none() => {
                    let why = format!(
                        "the program returns to block N{number} of its caller, but nothing in the library \
                         calls it: convert it together with its callers"
                    );
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
                }
                (Some(number), Some(name)) => {
                    numbers.entry(name.clone()).or_default().push(number as u32);
                    let kind = StmtKind::Assign { target: Place::Var(register), value: wanted };
                    let site = SourceInfo { span, ..SourceInfo::default() };
                    block.stmts.push(crate::ir::Stmt { kind, site });
                    let why = "the return to a block of the caller goes through a register: callers in \
                               the library look at it, callers outside do not";
                    context.add(index, Diagnostic::new(Code::Conditional, span, why));
                }
                _ => {
                    let why = "the number of the caller's block to return to is computed: write a constant";
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
                }
            }
        }
    }
    if numbers.is_empty() {
        return;
    }
    for list in numbers.values_mut() {
        list.sort_unstable();
        list.dedup();
    }
    let computed = context.target.statement("goto.computed").is_some();
    let computed_wants = wanted_by(module, &numbers);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let by_computed = computed_wants.get(&index);
        let wanted = |call: &Call| match &call.callee {
            Callee::Program(name) => numbers.get(name),
            Callee::Computed(_) => by_computed,
            _ => None,
        };
        if !program.blocks.iter().flat_map(calls_of).any(|call| wanted(call).is_some()) {
            continue;
        }
        let place = places(program);
        let temp = Var { class: Class::Temp, number: highest_temp(program) + 1 };
        rebuild(program, &mut |builder, part| match part {
            Part::Term(Terminator { kind: TermKind::Call { call, next }, site: whole })
                if wanted(&call).is_some() =>
            {
                let span = whole.span;
                let site = || SourceInfo { span, ..SourceInfo::default() };
                let targets: Vec<(u32, BlockId)> =
                    wanted(&call).into_iter().flatten().filter_map(|n| Some((*n, *place.get(n)?))).collect();
                if call.count.as_ref().is_some_and(|count| count.constant() != Some(1.0)) {
                    let why = "a repeated call of a program that returns to a block of its caller: call \
                               it once in each block";
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
                }
                let assign = |var, value| StmtKind::Assign { target: Place::Var(var), value };
                let clear = || assign(register, Expr::Number(0.0));
                builder.push(clear(), site());
                builder.end_then(whole, |next| TermKind::Call { call, next });
                // Cleared at once, so that a plain return of this program carries no number.
                builder.push(assign(temp, Expr::Var(register)), site());
                builder.push(clear(), site());
                // One jump finds its block by the number, as the return did.
                if targets.len() > FEW && computed {
                    let here = Cond::Compare(Relation::Equal, Expr::Var(temp), Expr::Number(0.0));
                    let jump = builder.fresh();
                    builder
                        .end(TermKind::Branch { cond: Box::new(here), then: next, otherwise: jump }, site());
                    builder.start(jump);
                    return builder.end(
                        TermKind::Computed { value: Box::new(Expr::Var(temp)), targets: targets.into() },
                        site(),
                    );
                }
                for (number, to) in targets {
                    let cond =
                        Cond::Compare(Relation::Equal, Expr::Var(temp), Expr::Number(f64::from(number)));
                    builder.end_then(site(), |otherwise| TermKind::Branch {
                        cond: Box::new(cond),
                        then: to,
                        otherwise,
                    });
                }
                builder.end(TermKind::Jump(next), SourceInfo::default());
            }
            other => other.keep(builder),
        });
    }
}

/// By program: the blocks that what its computed calls may run returns to.
fn wanted_by(module: &Module, numbers: &BTreeMap<ProgramName, Vec<u32>>) -> BTreeMap<usize, Vec<u32>> {
    let mut wanted: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for ((index, _), callees) in computed_calls(module) {
        let names = callees.programs.iter().filter_map(|at| module.programs[*at].name.as_ref());
        for list in names.filter_map(|name| numbers.get(name)) {
            wanted.entry(index).or_default().extend(list);
        }
    }
    for list in wanted.values_mut() {
        list.sort_unstable();
        list.dedup();
    }
    wanted
}

const UNCALLED: &str = "nothing in the library calls this program: it is taken to be a main program, which goes on at that block of its own; where the \
     control counts parts by such a return, a jump does not count";
const BY_NUMBER: &str = "only a call by a number that is not known might run this program, and the program with that call has no such \
     block: as a main program it goes on at that block";
const EITHER: &str = "as a main program this goes on at its own block of that number; a call by a number that is not known might run it \
     too, and the program with that call has such a block as well";
const EITHER_HELP: &str = "write a jump if it is a main program; if it is called, call it by its number";

/// Who calls the programs of a library.
struct Callers {
    /// Those that a call is known to run.
    called: BTreeSet<ProgramName>,
    /// Of each other program that a call by an unknown number may run: the sequence numbers of the callers.
    guessed: BTreeMap<usize, BTreeSet<u32>>,
}

impl Callers {
    fn of(module: &Module) -> Self {
        let calls = module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
        let named = calls.filter_map(|call| match &call.callee {
            Callee::Program(name) => Some(name.clone()),
            _ => None,
        });
        let mut called: BTreeSet<ProgramName> = named.collect();
        let mut guessed: BTreeMap<usize, BTreeSet<u32>> = BTreeMap::new();
        for ((caller, _), callees) in computed_calls(module) {
            if callees.known {
                let programs = callees.programs.iter().filter_map(|at| module.programs.get(*at));
                called.extend(programs.filter_map(|program| program.name.clone()));
                continue;
            }
            let labels = module.programs.get(caller).map(places).unwrap_or_default();
            for program in callees.programs.iter().filter(|program| **program != caller) {
                guessed.entry(*program).or_default().extend(labels.keys());
            }
        }
        Self { called, guessed }
    }
}

/// The first block of each sequence number.
fn places(program: &Program) -> BTreeMap<u32, BlockId> {
    let mut places = BTreeMap::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        for label in &block.labels {
            if let Label::Number(number) = label {
                places.entry(*number).or_insert(id);
            }
        }
    }
    places
}

/// The calls inside a program of what may return to a sequence number: nobody looks at the register after them.
fn subroutines_that_return_to(program: &Program) -> Vec<Span> {
    let returns_to = |id: &BlockId| {
        program.block(*id).is_some_and(|block| matches!(block.term.kind, TermKind::Return { to: Some(_) }))
    };
    let returns = |call: &Call| match call.callee {
        Callee::Block(entry) => reachable(program, entry).iter().any(returns_to),
        _ => false,
    };
    let calls = program.blocks.iter().filter(|block| calls_of(block).any(returns));
    calls.map(|block| block.term.site.span).collect()
}

/// True for a number that is none of a macro, by the source's table: of a program that an operator runs.
fn is_numbered_as_main(name: Option<&ProgramName>, source: &Control) -> bool {
    let last = source.limit("program.main").unwrap_or_default();
    matches!(name, Some(ProgramName::Number(number)) if (1..=last).contains(number))
}
