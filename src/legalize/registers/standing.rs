//! Variables of programs that stand in the machine, where the conversion gives variables another number.
//!
//! Law: a program that stands in the target's machine knows common variables by the numbers that the source knows them
//! by. Side condition: each that it may share with the library keeps its number, and nothing that the conversion keeps in
//! between lies in one of its own. A number that the target does not have is known by none there: what such a program shares under
//! another one is asked once. Counter-example: `#714` that becomes `#109`, and `O9810`, which reads `#714`.

use super::names::name_of;
use super::outside::{Moved, in_words, named, read, written_by};
use super::results::is_result;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::analysis::{VarSet, calls_of};
use crate::ir::{Argument, Class, Expr, Module, Place, Program, StmtKind, Var};
use crate::legalize::Context;
use crate::legalize::calls::standing;
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

const QUESTION: Question = Question::StandingResults;

/// Reports variables and registers that such a program may know by another meaning.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let callers = standing::callers(module, context);
    let Some((first, called)) = callers.first_key_value().map(|(at, called)| (*at, called.clone())) else {
        return;
    };
    let tied = standing::tied_to(callers.keys().copied(), &context.called(module).pairs(module));
    moved(module, &|at| tied.contains(&at), context);
    let callers: Vec<usize> = callers.keys().copied().collect();
    results(module, &callers, context);
    let taken = context.registers.taken_in_words();
    if !taken.is_empty() && !context.target.states_reserved() {
        let example = called.first().map(|number| ProgramName::Number(*number).short().into_owned());
        let example = example.unwrap_or_default();
        let what = format!(
            "programs that stand on the target are called, {example} is one, and the conversion takes registers that \
             these may use: {taken}"
        );
        let help = "name the variables that they use in 'reserved' of the target's profile; reserved = [] says that they \
                    use none beside those of the library";
        let finding =
            Diagnostic::new(Code::Conditional, module.programs[first].site.span, what).with_help(help);
        context.add(first, finding.asked_once());
    }
}

/// True where the target has a variable of the number that the source knows this one by.
fn has_number(target: &Control, (_, (name, number), _): &Moved) -> bool {
    let number = number.filter(|_| target.numbered().is_some_and(|space| space == name));
    number.is_some_and(|number| target.numbered_class(number).is_some())
}

/// Variables that have another number: of programs that run with such a one each is for review, of the others it is
/// asked once.
fn moved(module: &Module, runs_with: &dyn Fn(usize) -> bool, context: &mut Context<'_>) {
    let mut names: BTreeMap<Var, Option<Moved>> = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        let mut vars: Vec<Var> = read(program).iter().collect();
        vars.extend(written_by(program).vars.iter());
        vars.sort_unstable();
        vars.dedup();
        let mut moves = Vec::new();
        let pinned =
            |var: &Var| is_result(*var) && context.target.standing_results().of(var.number).is_some();
        for var in vars.into_iter().filter(|var| var.class.is_numbered() && !pinned(var)) {
            let there = names.entry(var).or_insert_with(|| {
                let register = context.registers.of.get(&var)?;
                let is_own = context.registers.is_own(&var, register);
                let name = name_of(var, module, context.source).filter(|_| !is_own)?;
                Some(named(var, &name, register))
            });
            moves.extend(there.clone());
        }
        let (moves, lacking): (Vec<Moved>, Vec<Moved>) =
            moves.into_iter().partition(|moved| has_number(context.target, moved));
        if !lacking.is_empty() {
            let what = format!(
                "{}, as the target has no variables of these numbers: a program that stands there, and shares one of \
                 them with this program, must use the new number",
                in_words(&lacking)
            );
            let help = "look which variables that program uses; 'reserved' in the target's profile says which ones this conversion \
                        must not take";
            let finding =
                Diagnostic::new(Code::Conditional, module.programs[index].site.span, what).with_help(help);
            context.add(index, finding.asked_once());
        }
        if moves.is_empty() {
            continue;
        }
        let what = format!(
            "programs that stand on the target know variables by their numbers on the source, and {}: they find \
             other values, or set others",
            in_words(&moves)
        );
        let help = "look whether one of them reads or sets these; the target's profile says which variables the machine \
                    has ('variables') and which programs must not be given ('reserved')";
        let finding =
            Diagnostic::new(Code::Conditional, module.programs[index].site.span, what).with_help(help);
        context.add(index, if runs_with(index) { finding } else { finding.asked_once() });
    }
}

/// Variables that a program reads after it called such a program, and that nothing in the library writes: results, as those of a
/// probing macro. The makers of such macros have other variables for them on another control.
fn results(module: &Module, callers: &[usize], context: &mut Context<'_>) {
    let other = match context.target.behaviour(QUESTION).map(|row| row.value.as_str()) {
        Some("same") => return,
        answer => answer == Some("other"),
    };
    let written: Vec<VarSet> = module.programs.iter().map(values_of).collect();
    let pairs = context.called(module).pairs(module);
    let standing = standing::known(module);
    for index in callers.iter().copied() {
        let Some(program) = module.programs.get(index) else { continue };
        offsets(program, index, (&standing, other), context);
        // What ends at power-off comes from programs that run with this one; what stays may come from any.
        let with = standing::tied_to([index], &pairs);
        let is_written = |var: &Var| {
            let sets = |at: usize| written.get(at).is_some_and(|written| written.contains(*var));
            (0..written.len()).any(|at| sets(at) && (var.class != Class::Common || with.contains(&at)))
        };
        let names: Vec<String> = read(program)
            .iter()
            .filter(|var| var.class.is_numbered() && !is_written(var))
            .filter(|var| !is_result(*var) || context.target.standing_results().of(var.number).is_none())
            .filter_map(|var| name_of(var, module, context.source))
            .collect();
        if names.is_empty() {
            continue;
        }
        let listed = names.join(", ");
        let span = program.site.span;
        if other {
            let what = format!(
                "{listed}, which a program that stands in the machine sets, and which this one reads: the target's sets other variables"
            );
            let help = format!(
                "say in the target's profile which variables they are there: standing_results = [\"{} as ...\"]",
                names.first().map_or("", String::as_str)
            );
            context.add(index, Diagnostic::new(Code::Conditional, span, what).with_help(help));
        } else {
            let what = format!("{} ({listed})", QUESTION.meaning());
            context.unconfirmed(index, Side::Target, span, QUESTION.fact(), what);
        }
    }
}

/// The local that an argument S sets, by which the makers' probing macros are told a work offset.
const OFFSET: u32 = 19;

/// Work offsets that both makers number alike: S1 to S6.
const ALIKE: f64 = 6.0;

/// Asks of calls that name an additional work offset: S101 and up on one control are other numbers on another.
fn offsets(
    program: &Program,
    index: usize,
    (known, other): (&BTreeSet<ProgramName>, bool),
    context: &mut Context<'_>,
) {
    for block in &program.blocks {
        for call in calls_of(block) {
            let outside = standing::outside(call, known, context).is_some();
            let named = |argument: &&Argument| {
                argument.local == OFFSET && argument.value.constant().is_none_or(|number| number > ALIKE)
            };
            if !outside || !call.arguments.iter().any(|argument| named(&argument)) {
                continue;
            }
            let span = block.term.site.span;
            if other {
                let what = "a program that stands in the machine is told a work offset here (S), and additional ones have other numbers on the \
                            target: write the target's number into the conversion";
                context.add(index, Diagnostic::new(Code::Conditional, span, what));
            } else {
                context.unconfirmed(index, Side::Target, span, QUESTION.fact(), QUESTION.meaning());
            }
        }
    }
}

/// The variables that a program gives a value. One that is emptied or set to 0 is made ready for a result.
fn values_of(program: &Program) -> VarSet {
    let mut all = VarSet::default();
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        match (&stmt.kind, stmt.kind.target()) {
            (StmtKind::Assign { value: Expr::Vacant, .. }, _) => {}
            (StmtKind::Assign { value, .. }, _) if value.constant() == Some(0.0) => {}
            (_, Some(Place::Var(var))) => _ = all.insert(*var),
            _ => {}
        }
    }
    all
}
