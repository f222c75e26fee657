//! Writes the holes of a library as moves: all of them, or those that the target cannot say.

use super::chosen::Chosen;
use super::drill::{Known, Runs};
use super::flow::{Flow, Vacancies, named_unit};
use super::{Context, Writer};
use crate::canon::Op;
use crate::dialect::Question;
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{Module, Nc, statics_of};
use crate::legalize::features::Features;
use crate::legalize::rewrite::highest_temp;
use std::collections::BTreeSet;

/// Says what is written, of what is known of the cycles; all of it if none.
type Choose<'c> = &'c dyn Fn(&Module, &Flow<'_>, &OverCalls<Known>) -> Option<Chosen>;

/// Writes holes as moves.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    context.drills = true;
    write(module, context, &|_, _, _| None);
}

/// Writes each cycle that has such a block, by itself, where that can be done without registers.
pub(in crate::legalize::cycles) fn write_cycles(
    module: &mut Module,
    context: &mut Context<'_>,
    is_such: &dyn Fn(&Nc) -> bool,
) {
    write(module, context, &|module, flow, known| Some(Chosen::cycles(module, flow, known, is_such)));
}

/// Writes all holes of these programs, where that can be done without registers.
pub(in crate::legalize::cycles) fn write_programs(
    module: &mut Module,
    context: &mut Context<'_>,
    all: &BTreeSet<usize>,
) {
    write(module, context, &|module, _, _| Some(Chosen::programs(module, all)));
}

fn write(module: &mut Module, context: &mut Context<'_>, choose: Choose<'_>) {
    let facts = context.modal_facts(module);
    let value = |question| context.source.behaviour(question).map(|row| row.value.as_str());
    let rules = Runs {
        with_place: value(Question::CycleBlockRuns) != Some("false"),
        without: value(Question::CycleRunsWithoutAxes) == Some("true"),
        wordless: value(context.source.of_wordless_cycles()) == Some("true"),
        by_depth: value(Question::CycleRunsByDepth) == Some("true"),
        // Controls begin so, and nothing in the library changes it.
        returns: (!Features::of(&module.programs).op(Op::ReturnR)).then_some(Op::ReturnInitial),
    };
    let vacancies = Vacancies::of(module, &context.summaries(module));
    let flow = Flow { facts: &facts, runs: rules, vacancies: &vacancies };
    let known = OverCalls::of(module, &flow);
    let chosen = choose(module, &flow, &known);
    let held = flow.held(module, &known, chosen.as_ref());
    let inch = named_unit(module);
    if chosen.is_some() && held.contains(&true) {
        return;
    }
    for (index, program) in module.programs.iter_mut().enumerate() {
        if chosen.as_ref().is_some_and(|chosen| !chosen.any_in(index)) {
            continue;
        }
        let mut writer = Writer {
            index,
            facts: &facts,
            flow: &known,
            rules,
            held,
            first: statics_of::HOLES,
            temps: highest_temp(program),
            vacancies: &vacancies,
            inch,
            vacant: false,
            chosen: chosen.as_ref(),
            context,
        };
        writer.program(program);
    }
}
