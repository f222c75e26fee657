//! Calls that run more often than the target's count says.
//!
//! Law: a loop that calls once and counts n down runs the callee n times. Side condition: n is a whole number; a count
//! below 1 runs nothing here, and what it does on the source no maker's text says. Counter-example: `M98 P10 L150` on a
//! control whose count has two digits.

use crate::ir::{Call, Module};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::registers::frames::repeats::loops;

const REPEAT: &str = "repeat";

/// True if the target's calls run less often than the source's.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let most = |control: &crate::dialect::Control| control.limit(REPEAT).unwrap_or(u32::MAX);
    features.has(Feature::Call) && most(context.target) < most(context.source)
}

/// Makes loops of counts that are larger, or computed.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let most = context.target.limit(REPEAT).map_or(f64::INFINITY, f64::from);
    let wanted = |call: &Call| {
        let count = call.count.as_ref().map(|count| count.constant());
        count.is_some_and(|count| count.is_none_or(|count| !(0.0..=most).contains(&count)))
    };
    module.programs.iter_mut().for_each(|program| loops(program, wanted));
}
