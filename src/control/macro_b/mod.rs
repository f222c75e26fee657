//! The control of the Macro B family.
//!
//! Programs are prepared once ([`compile`]), then run block by block. What the controls of the
//! family do differently is asked of the table; the names of their alarms stand in a [`Style`].

mod arguments;
mod calls;
mod code;
mod commands;
mod compile;
mod contours;
mod digits;
mod eval;
mod expressions;
mod jumps;
mod loops;
mod meaning;
mod memory;
mod numeric;
mod output;
mod outside;
mod parts;
mod rules;
mod run;
mod stand_ins;
mod store;
#[cfg(test)]
mod tests;
mod values;

pub(super) use run::execute;

use crate::diag::Code;

/// What a control of the family calls its alarms; empty where no source says.
#[derive(Debug)]
pub struct Alarms {
    /// A result is too large.
    pub overflow: &'static str,
    /// Division by zero.
    pub division: &'static str,
    /// An argument outside a function's domain.
    pub domain: &'static str,
    /// Brackets nest too deep.
    pub brackets: &'static str,
    /// DO and END do not match.
    pub loops: &'static str,
    /// A loop number other than 1, 2, 3.
    pub loop_number: &'static str,
    /// Words beside a macro call.
    pub call_not_alone: &'static str,
    /// A sequence number that is not there.
    pub no_sequence: &'static str,
    /// A second argument of ATAN without brackets.
    pub atan: &'static str,
    /// A constant with too many digits.
    pub digits: &'static str,
    /// A decimal point where there may be none.
    pub point: &'static str,
    /// A code that the control does not have.
    pub no_such_code: &'static str,
    /// A variable that is not there, or cannot be read or written.
    pub no_variable: &'static str,
    /// Calls nest too deep.
    pub too_deep: &'static str,
    /// The end of a modal call that is not in force.
    pub no_modal_call: &'static str,
}

/// What differs within the family beside the table.
#[derive(Debug)]
pub struct Style {
    /// Names of alarms.
    pub alarms: Alarms,
    /// True where the alarms of a lathe's cycles have the numbers of the maker's list.
    pub numbers_lathe_alarms: bool,
    /// Codes of its lathes that are refused on no lathe: what they end was refused where it began, or they move nothing.
    pub lathe_signs: &'static [&'static str],
}

impl Style {
    /// The alarm that a control raises for a fault that the parser saw; none if the block
    /// cannot be run at all.
    fn alarm_of(&self, code: Code) -> Option<&'static str> {
        let alarms = &self.alarms;
        Some(match code {
            Code::BracketDepth => alarms.brackets,
            Code::TooManyDigits => alarms.digits,
            Code::NotInteger => alarms.point,
            Code::LoopNumber => alarms.loop_number,
            Code::AtanDivision => alarms.atan,
            Code::MacroCallNotAlone | Code::ArgumentBeforeCall => alarms.call_not_alone,
            Code::LoopsCross | Code::LoopNotPaired => alarms.loops,
            Code::NullAssigned => alarms.no_variable,
            _ => return None,
        })
    }
}
