//! The answers of the table that running rests on, read once.

use super::numeric::{Answer, yes};
use crate::dialect::{BareLength, Control, Machine, Question};

/// What a number of a dwell counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dwell {
    Milliseconds,
    Seconds,
    Refused,
}

/// Which lists of I, J and K are of the second kind, in which places count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lists {
    FallingOrTwice,
    Twice,
    Never,
}

/// What becomes of a word whose brackets hold one vacant variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VacantBracket {
    Dropped,
    Zero,
}

/// The answers.
#[derive(Debug)]
pub struct Rules {
    pub vacant_word_dropped: Answer<bool>,
    pub vacant_bracket: Answer<VacantBracket>,
    pub bracket_copies_vacancy: Answer<bool>,
    pub word_rounds: bool,
    pub integer_word_rounds: Answer<bool>,
    pub scale_parts: Answer<f64>,
    pub round_in_address: bool,
    pub goto_forward: Answer<bool>,
    pub return_jumps_here: Answer<bool>,
    pub output_needs_port: Answer<bool>,
    pub main_restarts: Answer<bool>,
    pub index_rounds: Answer<bool>,
    pub dwell_bare: Answer<Dwell>,
    pub dwell_point: Answer<Dwell>,
    pub dwell_expression: Answer<Dwell>,
    pub mixed_later_wins: Answer<bool>,
    pub lists: Answer<Lists>,
    pub set_by_count: Answer<bool>,
    pub repeat_reloads: Answer<bool>,
    pub repeat_zero_none: Answer<bool>,
    pub modal_block_calls: Answer<bool>,
    pub alias_nested: Answer<bool>,
    pub locals_shared: Answer<bool>,
    pub modal_keeps_locals: Answer<bool>,
    pub bare_length: BareLength,
    pub bare_feed: BareLength,
    pub feed_parts: f64,
    pub whole_feeds: bool,
    pub feed_unsure: bool,
    /// The letters that the control gives a point where lengths count units.
    pub pointed: String,
    pub numbers_unsure: bool,
    pub increment_mm: f64,
    pub increment_inch: f64,
    pub increment_degrees: f64,
    /// True where the letters of angles count increments of angles in arguments too.
    pub angle_arguments: bool,
    pub alarm_offset: f64,
}

impl Rules {
    /// The answers of a control.
    pub fn new(control: &Control) -> Self {
        let word = |yes: &'static str, no: &'static str| {
            move |value: &str| (value == yes || value == no).then_some(value == yes)
        };
        let dwell = |value: &str| match value {
            "ms" => Some(Dwell::Milliseconds),
            "seconds" => Some(Dwell::Seconds),
            "error" => Some(Dwell::Refused),
            _ => None,
        };
        let bracket = |value: &str| match value {
            "dropped" => Some(VacantBracket::Dropped),
            "zero" => Some(VacantBracket::Zero),
            _ => None,
        };
        let lists = |value: &str| match value {
            "true" => Some(Lists::FallingOrTwice),
            "repeated" => Some(Lists::Twice),
            "false" => Some(Lists::Never),
            _ => None,
        };
        let numbers = control.numbers();
        let offset = control.behaviour(Question::AlarmOffset).and_then(|row| row.value.parse().ok());
        Self {
            vacant_word_dropped: yes(control, Question::VacantWordDropped, true),
            vacant_bracket: Answer::new(
                control,
                Question::BracketVacantWord,
                bracket,
                VacantBracket::Dropped,
            ),
            bracket_copies_vacancy: yes(control, Question::BracketCopiesVacancy, true),
            word_rounds: control.is(Question::WordRoundsToIncrement),
            scale_parts: Answer::new(control, Question::ScaleBare, |_| control.scale_parts(), 1.0),
            integer_word_rounds: yes(control, Question::IntegerWordRounds, true),
            round_in_address: control
                .behaviour(Question::RoundInAddress)
                .is_some_and(|row| row.value == "increment"),
            goto_forward: yes(control, Question::GotoForwardFirst, false),
            return_jumps_here: yes(control, Question::M99PJumpsHere, false),
            output_needs_port: yes(control, Question::OutputNeedsPort, false),
            main_restarts: yes(control, Question::M99MainRestarts, true),
            index_rounds: Answer::new(control, Question::IndexOfFraction, word("round", "truncate"), true),
            dwell_bare: Answer::new(control, Question::DwellBare, dwell, Dwell::Milliseconds),
            dwell_point: Answer::new(control, Question::DwellPoint, dwell, Dwell::Seconds),
            dwell_expression: Answer::new(control, Question::DwellExpression, dwell, Dwell::Milliseconds),
            mixed_later_wins: yes(control, Question::ArgumentsMixedLaterWins, true),
            lists: Answer::new(control, Question::ArgumentsOrderIjk, lists, Lists::FallingOrTwice),
            set_by_count: Answer::new(
                control,
                Question::ArgumentsRepeatedOrder,
                word("count", "place"),
                false,
            ),
            repeat_reloads: yes(control, Question::CallRepeatReloadsArguments, false),
            repeat_zero_none: Answer::new(control, Question::RepeatZero, word("none", "once"), true),
            modal_block_calls: yes(control, Question::CallModalBlockCalls, false),
            alias_nested: yes(control, Question::CallAliasNested, false),
            locals_shared: yes(control, Question::LocalsSharedBySubprogram, true),
            modal_keeps_locals: yes(control, Question::CallModalSetsLocalsOnce, true),
            bare_length: numbers.bare_length,
            bare_feed: numbers.bare_feed,
            feed_parts: numbers.feed_parts,
            whole_feeds: numbers.whole_feeds && control.machine() == Machine::Mill,
            feed_unsure: control.profile().decimal_point.is_some() && !numbers.feed_stated,
            pointed: numbers.calculator_letters.clone(),
            numbers_unsure: !numbers.origin.is_settled(),
            increment_mm: numbers.increment_mm,
            increment_inch: numbers.increment_inch,
            increment_degrees: numbers.increment_degrees,
            angle_arguments: numbers.angle_arguments,
            alarm_offset: offset.unwrap_or(0.0),
        }
    }
}
