//! Modal calls by a call behind each move, where the target has none.
//!
//! Law: under open modal calls, a block that moves an axis and then calls the innermost one does what they make of it;
//! inside that macro the ones outside it are open, so the macro is copied with their calls behind its own moves. Side
//! conditions: it is known at each move which modal calls are open; a callee that opens a level finds its arguments
//! anew each time, which is the same only while it does not change them.
//! Counter-example: a macro that counts in `#1`: under the modal call the count goes on.
//! A code that runs the macro where the tool stands becomes a call on every target.

use super::{Context, ModalFacts};
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::ir::{
    BlockId, Builder, Call, Callee, Class, Expr, Module, NcItem, Place, Program, Site, StmtKind, TermKind,
    Var,
};
use crate::syntax::ProgramName;

/// Replaces modal calls by explicit ones.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let native = context.target.statement("call.modal").is_some();
    let facts = match native {
        true => ModalFacts::of(module, &context.entry),
        false => ModalFacts::with_copies(module, &context.entry),
    };
    let mut expansion = Expansion { module: module.clone(), facts, native, copies: Vec::new() };
    let count = module.programs.len();
    for index in 0..count {
        let program = &module.programs[index];
        let done = expansion.expand(index, program, None, context);
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

/// A macro with outer calls in it.
struct Copied {
    /// Which program it is of.
    origin: usize,
    /// The outer calls, outermost first.
    under: Vec<Call>,
    copy: Program,
}

struct Expansion {
    module: Module,
    facts: ModalFacts,
    native: bool,
    /// Copies of macros with outer calls in them.
    copies: Vec<Copied>,
}

/// How deep modal calls may nest: as deep as macro calls do anywhere.
const DEEPEST: usize = 5;

impl Expansion {
    /// The program with its modal calls made explicit; under `outer`, those calls come behind its
    /// moves where it opens none of its own.
    fn expand(
        &mut self,
        index: usize,
        program: &Program,
        outer: Option<&[Call]>,
        context: &mut Context<'_>,
    ) -> Program {
        let mut builder = Builder::over(program.blocks.len());
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = self.facts.at(index, id);
            if let Some(outer) = outer {
                state.calls = Some(outer.to_vec());
            }
            builder.start(id);
            block.labels.iter().for_each(|label| builder.label(label.clone()));
            for stmt in &block.stmts {
                let before = state.calls.clone();
                state.step(stmt);
                let site = stmt.site.clone();
                match &stmt.kind {
                    StmtKind::ModalCall(call) if !self.native => {
                        let computed = call.arguments.iter().any(|a| a.value.constant().is_none());
                        if call.level && (computed || self.changes(call)) {
                            let why = "each move calls the macro anew: its arguments are computed and set again each time";
                            context.add(index, Diagnostic::new(Code::Conditional, site.span, why));
                        }
                        leave(&mut builder, site);
                    }
                    StmtKind::ModalCallOff if !self.native => leave(&mut builder, site),
                    StmtKind::Nc(nc) => {
                        let here =
                            nc.has(Op::CycleHere) && before.as_ref().is_none_or(|calls| !calls.is_empty());
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
                            Site { span, ..Site::default() }
                        };
                        match before {
                            None if runs => {
                                let why = "whether a modal call is open here depends on the path taken";
                                context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
                            }
                            Some(_) if here && moves && self.native => {
                                let why = "the macro is called for the move and for the code that calls it in place: taken to run once";
                                context.add(index, Diagnostic::new(Code::Conditional, span, why));
                            }
                            Some(mut calls) if runs && self.native => {
                                // Under the open modal call, each move of the macro would call it again.
                                if let Some(call) = calls.pop() {
                                    let again = call.clone();
                                    builder.push(StmtKind::ModalCallOff, site);
                                    let site = Site { span, ..Site::default() };
                                    builder.end_then(site.clone(), |next| TermKind::Call { call, next });
                                    builder.push(StmtKind::ModalCall(again), site);
                                }
                            }
                            Some(calls) if runs && !calls.is_empty() => {
                                let call = self.innermost(calls, index, span, context);
                                builder.end_then(site, |next| TermKind::Call { call, next });
                            }
                            _ => leave(&mut builder, site),
                        }
                    }
                    kind => builder.push(kind.clone(), site),
                }
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
        if calls.iter().any(reads_locals) {
            let why = "modal calls are nested here, and an outer one has arguments that are computed from variables of its level";
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
                let why =
                    "modal calls are nested here, and the macro of the inner one opens or ends one itself";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
            }
            Some((at, name)) if calls.len() < DEEPEST => {
                let written = |name: &ProgramName| match name {
                    ProgramName::Number(n) => format!("O{n}"),
                    ProgramName::Name(name) => name.clone(),
                };
                let under: Vec<String> = calls
                    .iter()
                    .map(|call| match &call.callee {
                        Callee::Program(name) => written(name),
                        other => format!("{other:?}"),
                    })
                    .collect();
                let text = format!("{} UNDER {}", written(&name), under.join(" "));
                let same = |copied: &&Copied| copied.origin == at && copied.under == calls;
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
                    self.copies.push(Copied { origin: at, under: calls.clone(), copy: copy.clone() });
                    self.copies[taken].copy = self.expand(at, &copy, Some(&calls), context);
                    name
                });
                call.callee = Callee::Program(name);
            }
            _ => {
                let why = "modal calls are nested here, and the inner one is not a program of the library";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
            }
        }
        call
    }

    /// True where the callee changes one of its arguments, or is not known.
    fn changes(&self, call: &Call) -> bool {
        let Callee::Program(name) = &call.callee else { return call.level };
        let program = self.module.programs.iter().find(|p| p.name.as_ref() == Some(name));
        program.is_none_or(|program| {
            let written = locals_written(program);
            call.arguments.iter().any(|argument| written.contains(&argument.local))
        })
    }
}

/// True where the arguments of a call mean another thing in a program that it runs under.
fn reads_locals(call: &Call) -> bool {
    let mut found = false;
    for argument in &call.arguments {
        argument.value.walk(&mut |e| {
            found |= matches!(e, Expr::Indirect(..) | Expr::Var(Var { class: Class::Local, .. }));
        });
    }
    found
}

/// Leaves of a block what people wrote in it.
fn leave(builder: &mut Builder, site: Site) {
    if !site.remarks.is_empty() {
        builder.push(StmtKind::Remark, site);
    }
}

fn locals_written(program: &Program) -> Vec<u32> {
    let targets = program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.target());
    targets
        .filter_map(|target| match target {
            Place::Var(Var { class: Class::Local, number }) => Some(*number),
            _ => None,
        })
        .collect()
}
