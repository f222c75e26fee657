//! What is told of computed numbers of variables.

use super::alike::is_moved;
use super::{Finding, named};
use crate::diag::Code;
use crate::dialect::Control;
use crate::ir::analysis;
use crate::legalize::Context;
use crate::legalize::registers::names::in_a_sentence;

/// How many ranges of numbers a message tells of before it says how many more there are.
const MOST_RANGES: usize = 5;

impl Finding {
    /// Why a number is no variable for programs on the target, or is another one.
    fn why_other(&self, context: &Context<'_>, number: u32) -> String {
        let spelt = context.source.names().numbered.clone().unwrap_or_default();
        if context.target.is_reserved(&spelt, number) {
            return "'reserved' of the target's profile keeps from programs: take it out of that list if nothing on the machine \
                    uses it, or give the programs other numbers"
                .to_owned();
        }
        if is_moved(context.source, context.target, number) {
            return "is a result of a program that stands in the target's machine, or the number of one there, as 'standing_results' of its \
                    profile says: name these variables by their numbers, or take them out of 'standing_results'"
                .to_owned();
        }
        format!("is another variable on {}", context.target.dialect().title)
    }

    /// What is told of it, where the numbers in `safe` mean the same, and `hits` would too but for the conversion's registers.
    pub(super) fn told(
        &self,
        context: &Context<'_>,
        safe: &analysis::Numbers,
        hits: &[u32],
    ) -> (Code, String) {
        let title = &context.target.dialect().title;
        let name = context.source.numbered().unwrap_or_default();
        match *self {
            Finding::Alike(..) if !hits.is_empty() => (
                Code::Conditional,
                format!(
                    "the number of a variable is computed: it must be one of {}{}",
                    shortly(safe, name),
                    taken(hits, name)
                ),
            ),
            Finding::Alike(first, last) => (
                Code::Conditional,
                must_stay(context.source, first, last)
                    + &format!("; other numbers are other variables on {title}"),
            ),
            Finding::Shifted(state, first, last, by) => {
                let there = |n: u32| i64::from(n) + by;
                (
                    Code::Conditional,
                    format!(
                        "{} ('{state}'), which are {} to {} on {title}",
                        must_stay(context.source, first, last),
                        named(context.target, there(first)),
                        named(context.target, there(last))
                    ),
                )
            }
            Finding::Counted(state, first, last, _) => {
                (Code::Conditional, format!("{} ('{state}')", must_stay(context.source, first, last)))
            }
            Finding::Other(number) => (
                Code::NoEquivalent,
                format!(
                    "the number of a variable is computed, and it may be or start from {}, which {}",
                    named(context.source, number.into()),
                    self.why_other(context, number)
                ),
            ),
            Finding::Any if safe.last().is_none() => (
                Code::NoEquivalent,
                format!("the number of a variable is computed, and no number means the same on {title}"),
            ),
            Finding::Any => (
                Code::Conditional,
                format!(
                    "the number of a variable is computed: it must be one of {}, which are the same on {title}{}",
                    shortly(safe, name),
                    taken(hits, name)
                ),
            ),
        }
    }
}

/// Numbers of variables in words, the first ranges alone if there are many.
fn shortly(numbers: &analysis::Numbers, name: &str) -> String {
    let mut words = numbers.words(name);
    let more = words.len().saturating_sub(MOST_RANGES);
    if more <= 1 {
        return words.join(", ");
    }
    words.truncate(MOST_RANGES);
    format!("{} or of {more} more ranges", words.join(", "))
}

/// Which registers the conversion has among the numbers.
fn taken(hits: &[u32], name: &str) -> String {
    match hits {
        [] => String::new(),
        hits => {
            let numbers =
                in_a_sentence(&hits.iter().map(|number| format!("{name}{number}")).collect::<Vec<_>>());
            format!(". It must never be {numbers}: the conversion keeps its own values there")
        }
    }
}

fn must_stay(source: &Control, first: u32, last: u32) -> String {
    let [first, last] = [first, last].map(|number| named(source, number.into()));
    format!("the number of a variable is computed: it must stay in {first} to {last}")
}
