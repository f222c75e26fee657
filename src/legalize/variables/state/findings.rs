//! What is told of machine state that the target keeps in another form, or not at all.

use super::holds_radii;
use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::legalize::Context;
use crate::legalize::offsets::one_table;
use crate::legalize::variables::signals::is_signal;
use crate::text::Span;

/// What is told of a state that is read or written.
pub(super) enum Finding {
    /// The target does not have it; with what the source's table notes of it, and the setting by which it may be another one there.
    Missing(Sys, Option<String>, Option<String>),
    /// A variable that only the source's control has, by its name, with what the table notes of it.
    Own(String, Option<String>),
    /// The same, where an alarm stands for the block that reads it.
    NotTold(String, Option<String>),
    /// A variable of the target, by the name of its fact.
    Unconfirmed(Sys, String, String),
    /// Codes of a group that is read have another number there; true if it is that of work offsets.
    Renumbered(String, bool),
    /// The same, if no program of the library names one of them.
    NeverNamed(String),
    Wiring,
    /// The wear of a tool is in its size on the target.
    Worn(Sys),
    /// The tool in the spindle stands for the last tool word.
    ToolWord,
    /// The position of the target stands for this one.
    Frame(Sys),
    ReadOnly(Sys),
    Table(Sys),
    TargetTable,
    /// What the tables hold as far as it is stated, which a block that writes them rests on.
    TablesHold,
}

/// What stands in the table of a lathe's tool offsets.
fn is_of_turret(state: Sys) -> bool {
    matches!(state, Sys::LatheX | Sys::LatheY | Sys::LatheZ | Sys::LatheRadius | Sys::LatheTip)
}

const TURRET: &str = "no page that was read says which variables of this lathe hold its tool offsets: write the offset with G10, or let the \
                      operator put it into the table";

impl Finding {
    /// Reports it.
    pub(super) fn report(self, index: usize, span: Span, context: &mut Context<'_>) {
        let title = context.target.dialect().title.clone();
        match self {
            // The pass that turns signals round has said so.
            Finding::Missing(state, ..) if is_signal(state) => {}
            Finding::Missing(Sys::Act, ..) => {
                let what = format!("{title} has no variable that stands for one of a builder's code");
                let help = "name it in the target's profile at the code: sets = { \"VARIABLE\" = \"NAME\" }, or reads, with the \
                            name that the source's profile has";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
            }
            Finding::Missing(Sys::ToolOffset, ..) => one_table::report_computed(index, span, context),
            Finding::Missing(state, note, setting) => {
                let what = format!("{title} has no variable for '{state}' ({})", state.meaning().trim());
                let finding = Diagnostic::new(Code::NoEquivalent, span, what);
                let help = "if the position that its programs read is in these coordinates, write 'position.frame = \"machine\"' \
                            under [behaviours] in the machine profile of the target";
                let help = note.or_else(|| may_be_in_frame(state, context.target).then(|| help.to_owned()));
                let help = help.or_else(|| is_of_turret(state).then(|| TURRET.to_owned()));
                let finding = if let Some(help) = help { finding.with_help(help) } else { finding };
                context.add(index, if let Some(name) = setting { finding.lacking(name) } else { finding });
            }
            Finding::Own(variable, note) => {
                let note = note.map(|note| format!(" ({note})")).unwrap_or_default();
                let what = format!("no variable of {title} is known to hold what {variable}{note} holds");
                let help = "if nothing that runs here needs it, take out what reads or sets it; else write the number that is \
                            meant in its place";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
            }
            Finding::NotTold(variable, note) => {
                let note = note.map(|note| format!(" ({note})")).unwrap_or_default();
                let what = format!(
                    "{variable}{note} is read, and {title} has no variable for it: an alarm stands in its place. No \
                     program of the library selects an additional work offset, so make sure that nothing else leaves one in force"
                );
                context.add_once(
                    index,
                    &what,
                    Diagnostic::new(Code::Conditional, span, what.clone()).asked_once(),
                );
            }
            Finding::ReadOnly(state) => {
                let what = format!("{title} cannot write '{state}'");
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
            }
            Finding::Unconfirmed(state, fact, note) => {
                let note = format!("'{state}' is taken to be in it{note}");
                let finding = context.target.unconfirmed(Side::Target, &fact, Some(&note), span);
                context.add_once(index, &format!("{} {fact}", Side::Target), finding);
            }
            Finding::Table(state) => {
                let what = match state {
                    Sys::DiameterOrRadius | Sys::DiameterOrRadiusWear => "a setting of each control says whether its cutter \
                                                                          table holds radii or diameters: the number is \
                                                                          copied as it is".into(),
                    state => format!("a setting of the source says whether its cutter table holds radii \
                                      or diameters: diameters are taken for '{state}'"),
                };
                context.unconfirmed(index, Side::Source, span, Question::RadiusOffsetTable.fact(), what);
            }
            Finding::Renumbered(code, _) => {
                let what = format!(
                    "a modal code is read, and the number of {code} is another one on {title}: make sure that no such \
                     code is in force here, and do not compare with its number"
                );
                context.add_once(index, &what, Diagnostic::new(Code::Conditional, span, what.clone()));
            }
            Finding::NeverNamed(code) => {
                let what = format!(
                    "a modal code is read, and the number of {code} is another one on {title}: no program of the library \
                     names one, so make sure that nothing else leaves one in force"
                );
                let finding = Diagnostic::new(Code::Conditional, span, what.clone()).asked_once();
                context.add_once(index, &what, finding);
            }
            Finding::TargetTable => {
                let what = "a setting of the target says whether its cutter table holds radii or \
                            diameters: diameters are taken";
                context.unconfirmed(index, Side::Target, span, Question::RadiusOffsetTable.fact(), what);
            }
            Finding::TablesHold => {
                let name = Question::RadiusOffsetTable;
                if holds_radii(context.source).is_some() {
                    context.rests_on_source(index, span, name);
                }
                if holds_radii(context.target).is_some() {
                    context.rests_on_target(index, span, name);
                }
            }
            Finding::ToolWord => {
                let what = format!(
                    "the last T is read, and {title} tells the tool in the spindle: call no tool ahead of its M6"
                );
                context.add_once(index, &what, Diagnostic::new(Code::Conditional, span, what.clone()));
            }
            Finding::Frame(state) => {
                context.rests_on_target(index, span, Question::PositionFrame);
                if state == Sys::EndPosition {
                    let what = "the end of the block before is read, and the target tells where the axes are when \
                                they have stopped: no cutter compensation and no rotation may be in force here, and \
                                no probe may have stopped the move";
                    context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
                }
            }
            Finding::Worn(state) => {
                let what = format!(
                    "{title} has one number for a tool, and no '{state}' beside it: it is read as 0. Put the sum of size and \
                     wear into the table"
                );
                context.add_once(
                    index,
                    &what,
                    Diagnostic::new(Code::Conditional, span, what.clone()).asked_once(),
                );
            }
            Finding::Wiring => {
                let what = "the number of this input or output depends on the machine's wiring: on the \
                            target it may be another signal";
                let finding = Diagnostic::new(Code::Conditional, span, what);
                context.add_once(index, "wiring", finding.asked_once());
            }
        }
    }
}

/// True for a position that the target may have: nobody knows in which frame its one kind of position is.
fn may_be_in_frame(state: Sys, target: &Control) -> bool {
    let unknown = target.behaviour(Question::PositionFrame).is_some_and(|row| row.value == "unknown");
    state == Sys::MachinePosition && unknown && target.system_run(Sys::AxisPosition).is_some()
}
