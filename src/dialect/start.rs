//! What is in force on a machine when a program begins, as its profile says.

use super::profile::Units;
use super::{CODE_SYSTEM, CodeMeaning, Control, Machine, Plain};
use crate::canon::{Group, Op, Role};
use serde::Deserialize;
use std::collections::BTreeMap;

/// The section `[start]` of a profile.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Start {
    /// The codes in force, as the machine shows them: `"G0 G17 G20 G54 G90 G94"`.
    pub codes: Option<String>,
}

fn setting_name() -> String {
    format!("setting.{CODE_SYSTEM}")
}

/// A code that is in force when a program begins.
#[derive(Clone, Debug, PartialEq)]
pub struct StartMode {
    /// What it does.
    pub op: Op,
    /// The operands that it fixes: the number of a work offset.
    pub fixed: BTreeMap<Role, f64>,
}

impl StartMode {
    /// The groups of which a machine may say what is in force. Cycles, lengths and compensation are cancelled when a program
    /// begins. Where holes end is a lathe's to say.
    pub const GROUPS: [Group; 7] = [
        Group::Units,
        Group::Distance,
        Group::Plane,
        Group::FeedMode,
        Group::Motion,
        Group::WorkOffset,
        Group::ReturnPlane,
    ];

    fn of(row: &CodeMeaning) -> Self {
        Self { op: row.op, fixed: row.fixed.clone() }
    }

    /// The work offset that it selects, by its common number.
    pub fn work_offset(&self) -> Option<u32> {
        let number = self.fixed.get(&Role::WorkOffset).filter(|_| self.op == Op::SelectWork)?;
        (number.fract() == 0.0 && (0.0..1e6).contains(number)).then_some(*number as u32)
    }
}

impl Control {
    /// What is in force when a program begins; empty where the profile does not say it.
    pub fn start(&self) -> &[StartMode] {
        &self.start
    }

    /// True if the profile names what is in force when a program begins, though it be only what every machine begins in (`G49`).
    pub fn says_start(&self) -> bool {
        !self.start_text().trim().is_empty()
    }

    /// Reads what the profile says.
    ///
    /// # Errors
    /// A code that the control has not, or that is none of these, or no code at all; with what to do.
    pub(super) fn read_start(&mut self) -> Result<(), (String, String)> {
        if self.profile.start.codes.is_some() && !self.says_start() {
            let help = "write what is in force when a program begins, or leave the line out";
            return Err(("[start] has empty 'codes'".into(), help.into()));
        }
        let found = self.start_modes(self.start_text()).map_err(|fault| self.told_elsewhere(fault))?;
        let unit = found.iter().find(|mode| mode.op.group() == Group::Units);
        let unit = unit.map(|mode| if mode.op == Op::Inch { Units::Inch } else { Units::Metric });
        if let (Some(unit), Some(stated)) = (unit, self.profile.units)
            && unit != stated
        {
            return Err(("[start] names another unit than 'units'".into(), "correct one of them".into()));
        }
        self.profile.units = self.profile.units.or(unit);
        self.start = found;
        Ok(())
    }

    fn start_text(&self) -> &str {
        self.profile.start.codes.as_deref().unwrap_or_default()
    }

    /// The modes that a profile names, by the codes of this control.
    fn start_modes(&self, text: &str) -> Result<Vec<StartMode>, (String, String)> {
        let mut found: Vec<StartMode> = Vec::new();
        for word in text.split_whitespace() {
            let Some(mode) = self.start_mode(word)? else { continue };
            if let Some(other) = found.iter().find(|other| other.op.group() == mode.op.group()) {
                let message = format!("'{word}' stands beside '{}', and one of them is in force", other.op);
                return Err((message, "leave one of them out".into()));
            }
            found.push(mode);
        }
        Ok(found)
    }

    /// What is wrong, where a lathe, or another G code system of it, has all the codes that the profile names: it leaves that
    /// open, or says another one.
    fn told_elsewhere(&self, (message, help): (String, String)) -> (String, String) {
        let names = self.systems_that_have_it();
        if names.is_empty() {
            return (message, help);
        }
        let write =
            format!("write {CODE_SYSTEM} = {} under [settings] if it has that one", names.join(" or "));
        let stated = self.profile.settings.get(CODE_SYSTEM);
        let own = self.setting(&setting_name()).unwrap_or_default();
        match (self.machine(), stated) {
            (Machine::Lathe, None) => (
                format!("{message}: G code system {own} is taken, as the profile does not say {CODE_SYSTEM}"),
                write,
            ),
            (Machine::Lathe, Some(stated)) => {
                (format!("{message}: {CODE_SYSTEM} is \"{stated}\""), format!("{help}; or {write}"))
            }
            (Machine::Mill, stated) => {
                let lathe = "write machine = \"lathe\" if it is one";
                let system = if stated.is_some() { String::new() } else { format!(", and {write}") };
                (
                    format!("{message}: a mill is taken, as the profile does not say the machine"),
                    format!("{lathe}{system}; or {help}"),
                )
            }
        }
    }

    /// The other G code systems of a lathe that have all the codes that the profile names. None if the profile says that the
    /// machine is a mill.
    fn systems_that_have_it(&self) -> Vec<String> {
        let is_lathe = self.machine() == Machine::Lathe;
        if !is_lathe && self.profile.machine.is_some() {
            return Vec::new();
        }
        let name = setting_name();
        let rows = self.entry.dialect().ok().map(|dialect| dialect.settings.iter());
        let values = rows.into_iter().flatten().filter(|row| row.name == name).flat_map(|row| &row.values);
        let others = values.filter(|value| !is_lathe || self.setting(&name) != Some(value.as_str()));
        let has_it = |system: &&String| {
            let mut profile = self.profile.clone();
            profile.machine = Some(Machine::Lathe);
            profile.settings.insert(CODE_SYSTEM.into(), Plain::Word((*system).clone()));
            profile.start = Start::default();
            Control::new(self.entry, profile).is_ok_and(|other| other.start_modes(self.start_text()).is_ok())
        };
        others.filter(has_it).map(|system| format!("\"{system}\"")).collect()
    }

    /// The mode of a code; none if every machine begins in it, as the page of a machine may show it too.
    fn start_mode(&self, word: &str) -> Result<Option<StartMode>, (String, String)> {
        let mut letters = word.chars();
        let letter = letters.next().map(|letter| letter.to_ascii_uppercase());
        let number: Option<f64> = letters.as_str().parse().ok();
        let (Some(letter @ 'A'..='Z'), Some(number)) = (letter, number) else {
            return Err((format!("'{word}' is no code"), "write codes as \"G90 G17 G54\"".into()));
        };
        let row = self.code(letter, number, &[]);
        let row = row.ok_or_else(|| {
            (format!("{} has no code {word}", self.dialect.title), "leave it out".to_owned())
        })?;
        let mode = StartMode::of(row);
        if is_cancelled(mode.op) || mode.op == Op::ReturnInitial && self.machine() == Machine::Mill {
            return Ok(None);
        }
        let may = match mode.op.group() {
            Group::Motion => matches!(mode.op, Op::Rapid | Op::Linear),
            Group::WorkOffset => mode.work_offset().is_some_and(|number| number > 0),
            // Where the holes of a lathe end.
            Group::ReturnPlane => self.machine() == Machine::Lathe,
            group => StartMode::GROUPS.contains(&group),
        };
        if may && row.modal != Some(false) {
            return Ok(Some(mode));
        }
        if matches!(mode.op, Op::CheckInch | Op::CheckMetric) {
            let what = format!("'{word}' asks which unit the machine is set to, and sets none");
            return Err((what, "leave it out, and say it as units = \"inch\" or \"metric\"".into()));
        }
        let help =
            "name the unit, absolute or incremental, the plane, the feed mode, G0 or G1, and the work offset";
        Err((format!("'{word}' is nothing that a program begins in"), help.into()))
    }
}

/// True for the end of something that no program begins in.
const fn is_cancelled(op: Op) -> bool {
    matches!(
        op,
        Op::RadiusOff
            | Op::LengthOff
            | Op::CycleOff
            | Op::RotateOff
            | Op::ScaleOff
            | Op::MirrorOff
            | Op::PolarOff
    )
}
