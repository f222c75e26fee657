//! Calls that leave the library.
//!
//! A call of a program that is not in the library stays a call of that number, since the shop may have the program
//! in the machine; a reviewer must know it, because nothing is known of it. A maker's cycle that is not
//! in the library has no number on the target and is an error. So is a call with arguments, if the target has no
//! locals: which registers that program reads is known only when it is converted too.

use crate::diag::{Code, Diagnostic};
use crate::ir::{Callee, Module, TermKind};
use crate::legalize::registers::needs::has_locals;
use crate::legalize::{Context, calls_of, span_of};
use crate::syntax::ProgramName;
use crate::text::Span;
use foldhash::HashSet;

/// Reports calls of what is not there.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    report(module, context);
    let mut changed = false;
    // What is refused anyway keeps no arguments that no program has.
    for block in module.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        if let TermKind::Call { call, .. } = &mut block.term.kind
            && matches!(call.callee, Callee::Cycle(_))
        {
            changed |= !call.arguments.is_empty();
            call.arguments.clear();
        }
    }
    changed
}

fn report(module: &Module, context: &mut Context<'_>) {
    let known: HashSet<&ProgramName> = module.programs.iter().filter_map(|p| p.name.as_ref()).collect();
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            for call in calls_of(block) {
                let span = span_of(block, call);
                match &call.callee {
                    Callee::Program(name @ ProgramName::Number(_))
                        if !known.contains(name)
                            && !call.arguments.is_empty()
                            && !has_locals(context.target) =>
                    {
                        unplaced(name, index, span, context);
                    }
                    callee => check(callee, &known, index, span, context),
                }
            }
            if let TermKind::Chain(name) = &block.term.kind {
                check(&Callee::Program(name.clone()), &known, index, block.term.site.span, context);
            }
        }
    }
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
        Callee::Program(name) if known.contains(name) => {}
        Callee::Program(name @ ProgramName::Number(_)) => {
            let what = format!(
                "{} is not in the library: put a program of that number that does the same on the target",
                name.short()
            );
            context.add_once(index, &what, Diagnostic::new(Code::OutsideLibrary, span, what.clone()));
        }
        Callee::Program(ProgramName::Name(name)) => {
            let what = format!("'{name}' is not in the library, and the target has no program of that name");
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
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
