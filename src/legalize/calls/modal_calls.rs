//! Modal calls by a call after each move, where the target has none.
//!
//! Law: under open modal calls, a block that moves an axis and then calls the innermost one does what they make of it;
//! inside that macro the ones outside it are open, so the macro is copied with their calls after its own moves. The
//! arguments are those of the block that opens it, so those that are numbers are kept in temporaries, and one that may be
//! vacant is a condition. A word whose value is
//! vacant is not there: where that may be so of all axes, the call stands under the condition that one is. Side
//! conditions: it is known at each move which modal calls are open; a callee that opens a level finds its locals
//! anew each time, which is the same only while it reads none that an earlier run of it wrote.
//! Counter-example: a macro that counts in `#1`: under the modal call the count goes on.
//! A drilling cycle under a modal call is refused: no source says which of the two runs first, or whether both do.
//! A code that runs the macro where the tool stands becomes a call on every target.

use super::{calls_programs, carried};
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::{Summaries, Vacancy};
use crate::ir::{
    BlockId, Builder, Call, Callee, Class, Cond, Expr, Module, Nc, NcItem, Program, Relation, SourceInfo,
    StmtKind, TermKind, Var,
};
use crate::legalize::moves::increments;
use crate::legalize::registers::names::name_of;
use crate::legalize::rewrite::unless_skipped;
use crate::legalize::{Context, Modal, ModalFacts};
use crate::syntax::ProgramName;
use std::collections::BTreeSet;

/// Replaces modal calls by explicit ones.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let native = context.target.statement("call.modal").is_some() && calls_programs(context.target);
    if !native {
        increments::of_modal_calls(module, context);
        module.programs.iter_mut().for_each(carried::hold_arguments);
    }
    let facts = match native {
        true => ModalFacts::of(module, &context.entry),
        false => ModalFacts::with_copies(module, &context.entry),
    };
    let summaries = Summaries::of(module);
    let locals = carried::numbers(context.source);
    let called = CalledPrograms::of(module);
    let mut expansion =
        Expansion { module: module.clone(), called, facts, summaries, native, locals, copies: Vec::new() };
    let count = module.programs.len();
    for index in 0..count {
        let program = &module.programs[index];
        let done = expansion.expand(index, program, None, &BTreeSet::new(), context);
        module.programs[index] = done;
    }
    for Copied { origin, copy, .. } in expansion.copies {
        module.programs.push(copy);
        context.origins.push(context.origins[origin]);
    }
}

/// True where a program opens or ends a modal call.
fn is_modal(program: &Program) -> bool {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_) | StmtKind::ModalCallOff))
}

/// True for a value that other moves may find changed.
fn may_change(value: &Expr) -> bool {
    !matches!(value, Expr::Vacant | Expr::Var(Var { class: Class::Temp, .. })) && value.constant().is_none()
}

/// The moves of a program that are none where what their words hold is vacant.
fn unsure_moves(
    program: &Program,
    summaries: &Summaries,
    given: &BTreeSet<Var>,
) -> BTreeSet<(BlockId, usize)> {
    let vacancy = Vacancy::of(program, summaries, &BTreeSet::new());
    let kept = |e: &Expr| matches!(unsigned(e), Expr::Var(var) if given.contains(var) && !carried::sets(program, *var));
    let mut found = BTreeSet::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        vacancy.forward(id, &mut |at, may| {
            if let Some(StmtKind::Nc(nc)) = block.stmts.get(at).map(|stmt| &stmt.kind)
                && nc.moves()
                && axes(nc).map(unsigned).all(|value| value.may_be_vacant() && may(value) && !kept(value))
            {
                found.insert((id, at));
            }
        });
    }
    found
}

/// A value without its sign: with a vacant variable after it, the word is not there either.
fn unsigned(value: &Expr) -> &Expr {
    match value {
        Expr::Negate(inner) => inner,
        value => value,
    }
}

/// The values of a block's axis words.
fn axes(nc: &Nc) -> impl Iterator<Item = &Expr> {
    nc.items.iter().filter_map(|item| match item {
        NcItem::Word(role, value) if role.is_axis() => Some(value),
        _ => None,
    })
}

/// A macro with outer calls in it.
struct Copied {
    /// Which program it is of.
    origin: usize,
    /// The outer calls, outermost first.
    under: Vec<Call>,
    /// The locals that those who call it give a number.
    given: BTreeSet<Var>,
    copy: Program,
}

struct Expansion {
    module: Module,
    called: CalledPrograms,
    facts: ModalFacts,
    summaries: Summaries,
    native: bool,
    locals: carried::Numbers,
    /// Copies of macros with outer calls in them.
    copies: Vec<Copied>,
}

/// How deep modal calls may nest: as deep as macro calls do anywhere.
const DEEPEST: usize = 5;

impl Expansion {
    /// The program with its modal calls made explicit; under `outer`, those calls come after its
    /// moves where it opens none of its own. It is called with numbers in the locals that are `given`.
    fn expand(
        &mut self,
        index: usize,
        program: &Program,
        outer: Option<&[Call]>,
        given: &BTreeSet<Var>,
        context: &mut Context<'_>,
    ) -> Program {
        let unsure =
            if self.native { BTreeSet::new() } else { unsure_moves(program, &self.summaries, given) };
        // A part of a program cannot be called from another one.
        let entered = self.facts.at(index, BlockId(0)).calls.unwrap_or_default();
        let elsewhere = |call: &Call| matches!(call.callee, Callee::Block(_)) && entered.contains(call);
        let mut builder = Builder::over(program.blocks.len());
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = self.facts.at(index, id);
            if let Some(outer) = outer {
                state.calls = Some(outer.to_vec());
            }
            builder.start(id);
            block.labels.iter().for_each(|label| builder.label(label.clone()));
            for (at, stmt) in block.stmts.iter().enumerate() {
                let before = state.calls.clone();
                state.step(stmt);
                let site = stmt.site.clone();
                if !self.native
                    && let Some(place) = stmt.kind.target()
                    && let Some(var) = before
                        .iter()
                        .flatten()
                        .find_map(|call| carried::argument(call, place, &self.locals, |_| true))
                {
                    context.add(
                        index,
                        Diagnostic::new(Code::NoEquivalent, site.span, changes(var, &self.module, context)),
                    );
                }
                match &stmt.kind {
                    StmtKind::ModalCall(call) if !self.native => {
                        if call.level && call.arguments.iter().any(|a| may_change(&a.value)) {
                            let why = "each move becomes a call of the macro, which computes and sets its \
                                       arguments again each time";
                            context.add(index, Diagnostic::new(Code::Conditional, site.span, why));
                        }
                        let macros = self.called.by((index, id), call);
                        if let Some(var) =
                            carried::changed_by_callee(&self.module, &self.called, macros, call, &self.locals)
                        {
                            context.add(
                                index,
                                Diagnostic::new(
                                    Code::NoEquivalent,
                                    site.span,
                                    changes(var, &self.module, context),
                                ),
                            );
                        }
                        if let Some(local) = self.carries((index, id), call) {
                            let why = format!(
                                "each move would become a call of the macro, which reads local variable \
                                 {local} as its run before left it"
                            );
                            context.add(index, Diagnostic::new(Code::NoEquivalent, site.span, why));
                        }
                        leave(&mut builder, site);
                    }
                    StmtKind::ModalCallOff if !self.native => leave(&mut builder, site),
                    StmtKind::Nc(written) => {
                        let nc = written;
                        let open = before.as_ref().is_none_or(|calls| !calls.is_empty());
                        let here = nc.has(Op::CycleHere) && open;
                        let drills = |state: &Modal| state.op(Group::Cycle).is_some_and(Op::is_cycle);
                        let under = before.as_ref().map_or(is_modal(program), |calls| !calls.is_empty());
                        if under && (nc.ops().any(Op::is_cycle) || (nc.moves() && drills(&state))) {
                            let why = "a drilling cycle under a modal call: no source says which one runs \
                                       first, or whether both run";
                            context.add(index, Diagnostic::new(Code::NoEquivalent, site.span, why));
                        }
                        let runs = here || (nc.moves() && !self.native);
                        let mut nc = nc.clone();
                        if here {
                            nc.items.retain(|item| *item != NcItem::Op(Op::CycleHere));
                        }
                        let span = site.span;
                        let moves = nc.moves();
                        // What people wrote beside a block that is nothing but a call stands beside the call.
                        let site = if nc.items.is_empty() {
                            site
                        } else {
                            builder.push(StmtKind::Nc(nc), site);
                            SourceInfo { span, ..SourceInfo::default() }
                        };
                        match before {
                            None if runs => {
                                let why = "a modal call is open on only some paths to this block";
                                context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
                            }
                            Some(_) if here && moves && self.native => {
                                let why = "the move and the code in its block both call the macro: taken \
                                           to run once";
                                context.add(index, Diagnostic::new(Code::Conditional, span, why));
                            }
                            Some(mut calls) if runs && self.native => {
                                // Under the open modal call, each move of the macro would call it again.
                                if let Some(call) = calls.pop() {
                                    let again = call.clone();
                                    builder.push(StmtKind::ModalCallOff, site);
                                    let site = SourceInfo { span, ..SourceInfo::default() };
                                    builder.end_then(site.clone(), |next| TermKind::Call {
                                        call: Box::new(call),
                                        next,
                                    });
                                    builder.push(StmtKind::ModalCall(Box::new(again)), site);
                                }
                            }
                            Some(calls) if runs && calls.last().is_some_and(elsewhere) => {
                                let why = "the modal call in force here runs a part of the same program: the \
                                     target cannot";
                                context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
                            }
                            Some(calls) if runs && !calls.is_empty() => {
                                let call = self.innermost(calls, index, span, context);
                                let behind = builder.fresh();
                                unless_skipped(&mut builder, stmt.site.skip, behind);
                                if !here && unsure.contains(&(id, at)) {
                                    let vacant = |e: &Expr| {
                                        Cond::Compare(Relation::Equal, unsigned(e).clone(), Expr::Vacant)
                                    };
                                    let cond = match axes(written).map(vacant).collect::<Vec<_>>() {
                                        all if all.len() > 1 => Cond::And(all),
                                        one => one.into_iter().next().unwrap_or(Cond::And(Vec::new())),
                                    };
                                    let then = behind;
                                    builder.end_then(SourceInfo::default(), |otherwise| TermKind::Branch {
                                        cond: Box::new(cond),
                                        then,
                                        otherwise,
                                    });
                                }
                                builder.end(TermKind::Call { call: Box::new(call), next: behind }, site);
                                builder.start(behind);
                            }
                            _ => leave(&mut builder, site),
                        }
                    }
                    kind => builder.push(kind.clone(), site),
                }
            }
            if matches!(block.term.kind, TermKind::Call { .. })
                && outer.is_some_and(|outer| !outer.is_empty())
            {
                let why = "a macro in a nested modal call calls another program, and the moves of that \
                           program would call the outer macro";
                context.add(index, Diagnostic::new(Code::NoEquivalent, block.term.site.span, why));
            }
            builder.end(block.term.kind.clone(), block.term.site.clone());
        }
        builder.finish(program.name.clone(), program.file, program.site.clone())
    }

    /// The innermost of the open calls; of a macro with the outer ones in it, where there are any.
    fn innermost(
        &mut self,
        mut calls: Vec<Call>,
        index: usize,
        span: crate::text::Span,
        context: &mut Context<'_>,
    ) -> Call {
        let Some(mut call) = calls.pop() else {
            return Call {
                callee: Callee::Block(BlockId(0)),
                level: false,
                arguments: Vec::new(),
                count: None,
            };
        };
        if calls.is_empty() || self.native {
            return call;
        }
        if calls.iter().any(carried::reads_locals) {
            let why = "modal calls are nested here, and an outer call computes its arguments from local \
                       variables";
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
            return call;
        }
        let found = match &call.callee {
            Callee::Program(name) => {
                let at = self.module.programs.iter().position(|p| p.name.as_ref() == Some(name));
                at.map(|at| (at, name.clone()))
            }
            _ => None,
        };
        match found {
            Some((at, _)) if is_modal(&self.module.programs[at]) => {
                let why = "modal calls are nested here, and the macro of the inner call opens or ends a modal \
                     call itself";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
            }
            Some((at, name)) if calls.len() < DEEPEST => {
                let written = |name: &ProgramName| name.short().into_owned();
                let under: Vec<String> = calls
                    .iter()
                    .map(|call| match &call.callee {
                        Callee::Program(name) => written(name),
                        other => format!("{other:?}"),
                    })
                    .collect();
                let text = format!("{} UNDER {}", written(&name), under.join(" "));
                let arguments = call.arguments.iter().filter(|argument| argument.value.constant().is_some());
                let given: BTreeSet<Var> =
                    arguments.map(|argument| Var { class: Class::Local, number: argument.local }).collect();
                let same =
                    |copied: &&Copied| copied.origin == at && copied.under == calls && copied.given == given;
                let known = self.copies.iter().find(same).and_then(|copied| copied.copy.name.clone());
                let name = known.unwrap_or_else(|| {
                    // The outer calls may differ in their arguments only.
                    let taken = self.copies.len();
                    let name = ProgramName::Name(match taken {
                        0 => text,
                        n => format!("{text} {n}"),
                    });
                    let mut copy = self.module.programs[at].clone();
                    copy.name = Some(name.clone());
                    // Noted first: a macro that moves under itself would copy itself for ever.
                    let (under, noted) = (calls.clone(), given.clone());
                    self.copies.push(Copied { origin: at, under, given: noted, copy: copy.clone() });
                    self.copies[taken].copy = self.expand(at, &copy, Some(&calls), &given, context);
                    name
                });
                call.callee = Callee::Program(name);
            }
            _ => {
                let why = "modal calls are nested here, and the inner one calls a program outside the \
                           library";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
            }
        }
        call
    }

    /// A local of the callee that it reads as an earlier run of it left it.
    fn carries(&self, place: (usize, BlockId), call: &Call) -> Option<u32> {
        let mut macros = self.called.by(place, call).iter().filter(|_| call.level);
        macros.find_map(|at| carried::local(&self.module, &self.called, *at, &self.locals))
    }
}

/// Why an argument that changes is refused.
fn changes(var: Var, module: &Module, context: &Context<'_>) -> String {
    let name = name_of(var, module, context.source);
    format!(
        "each move computes the arguments of the modal call again, and {} changes while the call is open: \
         give the call a variable that does not change",
        name.as_deref().unwrap_or("one of their variables")
    )
}

/// Leaves of a block what people wrote in it.
fn leave(builder: &mut Builder, site: SourceInfo) {
    if !site.comments.is_empty() {
        builder.push(StmtKind::Comment, site);
    }
}
