//! Vacancy, for a target whose variables are never vacant: flags that say which hold a value.
//!
//! Law: the flag of a variable is 1 if it was given a number and vacant (0 on the target) if not, and the variable holds
//! 0 while it is vacant. So a comparison that tells vacant from 0 asks the flag, and a block whose word may be vacant
//! stands once with the word and once without. Only what may be vacant where someone asks has a flag, and what is
//! copied to it: the analysis of vacancy decides, and most variables have none. `IF v EQ vacant THEN v=0` asks nothing: v is 0 then.
//!
//! Side condition: nothing else writes the variable. Counter-example: `#[#1]=5.` with #1 at 100 would leave the flag of
//! #100 as it was. Such programs are refused, and so is a block with more words that may be vacant than [`MOST_WORDS`].

mod conditions;
mod entries;
mod given;
mod marks;
mod outside;
mod write;

use crate::dialect::Question;
use crate::ir::{Module, flag_of};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::registers::names::name_of;
use marks::Marks;

/// Words of a block that may be vacant, at the most: each doubles the blocks.
const MOST_WORDS: usize = 3;

/// True if there are variables, arguments of calls too, and only those of the source may be vacant.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    (features.has(Feature::Variable) || features.has(Feature::Call))
        && context.source.is(Question::Vacancy)
        && !context.target.is(Question::Vacancy)
}

/// Finds the variables that need a flag, and writes the flags.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let summaries = context.summaries(module);
    let marks = Marks::of(module, &summaries);
    marks.refuse(module, context);
    name(module, &marks, context);
    given::tell(module, &marks.always, context);
    for index in 0..module.programs.len() {
        write::program(index, &mut module.programs[index], &marks, context.source);
    }
}

/// People and the lock know a flag by the name of its variable.
fn name(module: &mut Module, marks: &Marks, context: &Context<'_>) {
    for var in marks.shared() {
        if let Some(name) = name_of(var, module, context.source) {
            module.names.insert(var.flag(), flag_of(&name));
        }
    }
}
