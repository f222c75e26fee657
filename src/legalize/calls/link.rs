//! Calls that leave the library.
//!
//! A call of a program that is not in the library stays a call of that number, since the shop may have the program
//! in the machine; a reviewer must know it, because nothing is known of it. A maker's cycle that is not
//! in the library has no number on the target and is an error. Where the target has no locals, arguments are set in
//! registers before the call, and a reviewer is told which ([`crate::legalize::registers::interface`]); modal and repeated
//! calls with arguments are errors. Of a program that the target's
//! profile names a note says, once for the library, that it stands there.

use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::computed_calls::computed_calls;
use crate::ir::{Call, Callee, Module, StmtKind, TermKind};
use crate::legalize::calls::{merged, standing};
use crate::legalize::registers::needs::has_locals;
use crate::legalize::{Context, calls_of, span_of};
use crate::syntax::ProgramName;
use crate::text::Span;
use foldhash::HashSet;
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};

/// Reports calls of what is not there.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let unplaced = report(module, context);
    let mut changed = false;
    // What is refused anyway keeps no arguments that no program has.
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            let modal = block.stmts.iter_mut().filter_map(|stmt| match &mut stmt.kind {
                StmtKind::ModalCall(call) => Some((stmt.site.span, call)),
                _ => None,
            });
            let end = match &mut block.term.kind {
                TermKind::Call { call, .. } => Some((block.term.site.span, call)),
                _ => None,
            };
            for (span, call) in modal.chain(end) {
                if matches!(call.callee, Callee::Cycle(_)) || unplaced.contains(&(index, span)) {
                    changed |= !call.arguments.is_empty();
                    call.arguments.clear();
                }
            }
        }
    }
    changed
}

/// Yields the calls whose arguments have no place.
fn report(module: &Module, context: &mut Context<'_>) -> BTreeSet<(usize, Span)> {
    let mut without = BTreeSet::new();
    stand_there(module, context);
    let known: HashSet<&ProgramName> = module.programs.iter().filter_map(|p| p.name.as_ref()).collect();
    let computed = LazyCell::new(|| computed_calls(module));
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            for call in calls_of(block) {
                let span = span_of(block, call);
                match &call.callee {
                    // Every program that it may call is here.
                    Callee::Computed(_) if computed.get(&(index, id)).is_some_and(|callees| callees.all) => {}
                    Callee::Program(name @ ProgramName::Number(_))
                        if !known.contains(name)
                            && !call.arguments.is_empty()
                            && !has_locals(context.target) =>
                    {
                        // The registers of the others are told when they are known.
                        if !sets_registers(call, &block.term.kind) || merged::concerns(context.target) {
                            unplaced(name, index, span, context);
                            without.insert((index, span));
                        }
                    }
                    callee => check(callee, &known, index, span, context),
                }
            }
            if let TermKind::Chain(name) = &block.term.kind {
                check(&Callee::Program(name.clone()), &known, index, block.term.site.span, context);
            }
        }
    }
    without
}

/// Tells once of each program that stands on the target, at the first call of it.
fn stand_there(module: &Module, context: &mut Context<'_>) {
    let callers = standing::callers(module, context);
    let mut told: BTreeMap<u32, (usize, Span, usize)> = BTreeMap::new();
    for (index, called) in &callers {
        for block in &module.programs[*index].blocks {
            for call in calls_of(block) {
                let Callee::Program(ProgramName::Number(number)) = &call.callee else { continue };
                if called.contains(number) {
                    told.entry(*number).or_insert((*index, span_of(block, call), 0));
                }
            }
            // Its own locals may be others when it runs again.
            for stmt in &block.stmts {
                if let StmtKind::ModalCall(call) = &stmt.kind
                    && matches!(&call.callee, Callee::Program(ProgramName::Number(n)) if called.contains(n))
                {
                    context.must_agree(*index, stmt.site.span, Question::CallModalSetsLocalsOnce);
                }
            }
        }
        if let Some(span) = called.iter().find_map(|number| told.get(number)).map(|told| told.1) {
            offset_in_force(*index, span, context);
        }
        for number in called {
            if let Some((.., programs)) = told.get_mut(number) {
                *programs += 1;
            }
        }
    }
    for (number, (index, span, programs)) in told {
        let name = ProgramName::Number(number);
        let there = standing::number_of(&name, context).filter(|there| *there != number);
        let there =
            there.map(|there| format!(" as {}", ProgramName::Number(there).short())).unwrap_or_default();
        let calls =
            if programs == 1 { "1 program calls".to_owned() } else { format!("{programs} programs call") };
        let name = name.short();
        let what = format!(
            "{name} stands on the target{there} and does the same there, as its profile says: {calls} it"
        );
        context.add(index, Diagnostic::new(Code::StandsThere, span, what));
    }
}

/// A program that probes writes the work offset in force, which may count at once on one of the two machines alone.
fn offset_in_force(index: usize, span: Span, context: &mut Context<'_>) {
    let answer = |control: &Control| {
        let row = control.behaviour(Question::OffsetActiveImmediately).filter(|row| row.value != "unknown");
        row.map(|row| row.value.clone())
    };
    let answers = (answer(context.source), answer(context.target));
    if matches!(&answers, (Some(ours), Some(theirs)) if ours != theirs) {
        let what = "a program that stands on the target may write the work offset in force, and the two machines differ in \
                    whether that counts at once ('offset.active.immediately'): select the offset again after the call";
        context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
    }
}

/// True if the arguments can be set right before the call, for one run of the program.
fn sets_registers(call: &Call, kind: &TermKind) -> bool {
    let ends = matches!(kind, TermKind::Call { call: own, .. } if std::ptr::eq(&**own, call));
    ends && call.level && call.count.is_none()
}

/// The target has no locals, so nobody knows where a program that is not there looks for its arguments.
fn unplaced(name: &ProgramName, index: usize, span: Span, context: &mut Context<'_>) {
    let name = name.short();
    let what = format!(
        "{name} gets arguments and is not in the library: the target has no local variables, so no register is known for them"
    );
    let help = format!("convert it together with {name}");
    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
}

fn check(
    callee: &Callee,
    known: &HashSet<&ProgramName>,
    index: usize,
    span: Span,
    context: &mut Context<'_>,
) {
    match callee {
        Callee::Program(name) if known.contains(name) || standing::number_of(name, context).is_some() => {}
        Callee::Program(name @ ProgramName::Number(_)) => {
            let short = name.short();
            let what = format!(
                "{short} is not in the library: put a program of that number that does the same on the target"
            );
            let finding = Diagnostic::new(Code::OutsideLibrary, span, what.clone());
            let both = has_locals(context.source) && has_locals(context.target);
            let help = format!(
                "if such a program stands on the target, say so in its profile: programs = [\"{short}\"]; then no program \
                 is asked for it again"
            );
            context.add_once(index, &what, if both { finding.with_help(help) } else { finding });
        }
        Callee::Program(ProgramName::Name(name)) => {
            let what = format!("'{name}' is not in the library, and the target has no program of that name");
            let finding = Diagnostic::new(Code::NoEquivalent, span, what);
            // Where no text says a program's name, its file does.
            let by_file = context.source.names().program.is_none();
            let help = format!("add its file to the library, and name the file after it: {name}.NC");
            context.add(index, if by_file { finding.with_help(help) } else { finding });
        }
        Callee::Cycle(n) => {
            let what = format!(
                "{n} is a subroutine that the maker keeps in the source's control; the target has no such \
                 subroutine"
            );
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
        }
        Callee::Computed(_) => {
            let what = "the number of the called program is computed: put every program that it may call \
                        on the target under the same number";
            context.add_once(index, "computed call", Diagnostic::new(Code::OutsideLibrary, span, what));
        }
        Callee::Block(_) => {}
    }
}
