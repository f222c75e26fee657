//! Faults of programs that a control takes all the same.
//!
//! A rule looks at a library that was lowered and that no pass has changed. It asks the common form and the tables, so one
//! rule serves all dialects. It never changes the outcome of a conversion.

mod arithmetic;
mod calls;
mod conditions;
mod flow;
mod in_force;
mod left_on;
mod locals;
mod looked;
mod loops;
mod state;
mod unset;
mod values;
mod words;

pub use looked::{Findings, Looked};

use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::Module;
use crate::library::Input;

/// One rule.
pub struct Rule {
    /// What it finds.
    pub code: Code,
    /// Whether it runs where nobody asks for it by name.
    pub on: bool,
    run: fn(&Looked<'_>, &mut Findings),
}

const fn rule(code: Code, run: fn(&Looked<'_>, &mut Findings)) -> Rule {
    Rule { code, on: true, run }
}

/// One that runs only where somebody asks for it.
const fn asked(code: Code, run: fn(&Looked<'_>, &mut Findings)) -> Rule {
    Rule { code, on: false, run }
}

/// All rules, in the order of their codes.
pub const RULES: &[Rule] = &[
    rule(Code::UnsetLocal, locals::unset),
    rule(Code::MissingArgument, locals::missing_argument),
    rule(Code::UnreadArgument, locals::unread_argument),
    rule(Code::LeftChanged, locals::left_changed),
    rule(Code::NeverRead, locals::never_read),
    rule(Code::Overwritten, words::overwritten),
    rule(Code::UnusedLabel, flow::unused_label),
    rule(Code::Unreached, flow::unreached),
    rule(Code::EndlessLoop, loops::endless),
    rule(Code::JumpToNext, flow::jump_to_next),
    rule(Code::EndMissing, flow::no_end),
    // Off: shops number by hand and never jump, and where a jump is concerned the lowering says so.
    asked(Code::SequenceTwice, flow::sequence_twice),
    rule(Code::CallsTooDeep, calls::too_deep),
    rule(Code::EndlessCalls, calls::endless_calls),
    rule(Code::MissingProgram, calls::missing_program),
    rule(Code::FileNumber, calls::file_number),
    rule(Code::EqualComputed, values::equal_computed),
    rule(Code::VacantOrder, conditions::vacant_order),
    rule(Code::ConstantCondition, conditions::constant_condition),
    rule(Code::UnsetDivisor, arithmetic::unset_divisor),
    rule(Code::OpenSubscript, arithmetic::open_subscript),
    rule(Code::RoundForFix, arithmetic::round_for_fix),
    rule(Code::BareLength, words::bare_length),
    rule(Code::UncheckedSpeed, words::unchecked_speed),
    rule(Code::LongText, words::long_text),
    rule(Code::NoFeed, in_force::no_feed),
    rule(Code::NoUnit, in_force::no_unit),
    rule(Code::NoSpeed, in_force::no_speed),
    rule(Code::SpindleStands, in_force::spindle_stands),
    rule(Code::OldLength, in_force::old_length),
    rule(Code::OtherLength, in_force::other_length),
    rule(Code::RadiusLeftOn, left_on::radius),
    rule(Code::CycleLeftOn, left_on::cycle),
    rule(Code::FrameLeftOn, left_on::frame),
    rule(Code::IncrementalLeftOn, left_on::incremental),
    // Off: programs name each tool's length after its change, and leave the last one on by the shop's rule.
    asked(Code::LengthLeftOn, left_on::length),
    rule(Code::ModalCallLeftOn, left_on::modal_call),
];

/// Finds what the wanted rules find: each finding with the index of its file among the inputs, in the order of files,
/// places and codes.
pub fn lint(
    inputs: &[Input],
    control: &Control,
    module: &Module,
    wanted: &dyn Fn(Code) -> bool,
) -> Vec<(usize, Diagnostic)> {
    let looked = Looked::new(inputs, control, module);
    let mut findings = Findings::default();
    RULES.iter().filter(|rule| wanted(rule.code)).for_each(|rule| (rule.run)(&looked, &mut findings));
    findings.sorted()
}
