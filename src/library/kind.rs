//! The kind of machine of a library whose profile does not say it.
//!
//! Law: the library is a lathe's if a program of it has the signs of a lathe, and none has those of a mill (machine_kind.rs).
//! Side condition: the profile of its control says no kind, and the control's table has rows for a lathe. Then all of it is
//! read by these rows, and it goes to a lathe where the target's profile says no kind either.
//! Counter-example: a folder with T0101 in one program and G43 in another holds the programs of two machines. No kind is
//! right for all of it, so the lathe's are refused.

use super::Input;
use super::chunks::lower::lower;
use super::machine_kind::Signs;
use crate::dialect::{Control, Machine, NoMeeting};
use crate::text::Span;
use rayon::prelude::*;

/// Files that are looked at together. A mill's shows itself in the first of them.
const TOGETHER: usize = 32;

/// Bytes of a file that are looked at: a program shows its kind where it begins.
const LOOKED_AT: usize = 256 * 1024;

/// Letters of a sign that are told.
const SHOWN: usize = 32;

/// Why a library is taken to be a lathe's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TakenAsLathe {
    /// What shows it, as it stands in the program.
    pub sign: String,
    /// Where, as `file:line`.
    pub place: String,
    /// The G code system that it is read by, where the profile does not say one and the control has several.
    pub system: Option<String>,
}

impl std::fmt::Display for TakenAsLathe {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { sign, place, system } = self;
        write!(
            f,
            "no profile says the kind of machine: it is taken as a lathe, because of {sign} in {place}. Write machine = \
             \"lathe\" into the profile"
        )?;
        match system {
            Some(system) => {
                write!(f, ", and gcode_system = \"{system}\" under [settings] if that is its system")
            }
            None => Ok(()),
        }
    }
}

/// The control that a library is read by, and why, if that is a lathe because of its programs.
pub fn of_library(inputs: &[Input], source: Control) -> (Control, Option<TakenAsLathe>) {
    let taken = || {
        let lathe = as_lathe(&source)?;
        let (sign, place) = sign(inputs, &source)?;
        Some((lathe, sign, place))
    };
    match taken() {
        Some((lathe, sign, place)) => {
            let system = lathe.open_code_system().map(|(system, _)| system.to_owned());
            (lathe, Some(TakenAsLathe { sign, place, system }))
        }
        None => (source, None),
    }
}

/// The control that programs of `source` go to: of the same kind, where its profile says none.
pub fn of_target(source: &Control, target: Control) -> Control {
    match source.machine() {
        Machine::Lathe => as_lathe(&target).unwrap_or(target),
        Machine::Mill => target,
    }
}

/// Both machines of a conversion, with the kind of the library's programs where their profiles leave it open.
///
/// # Errors
/// If what the source's profile says of the target's codes does not fit the rows of this kind.
pub fn settled(
    inputs: &[Input],
    source: Control,
    target: Control,
) -> Result<(Control, Control, Option<TakenAsLathe>), NoMeeting> {
    let kinds = [source.machine(), target.machine()];
    let (source, taken) = of_library(inputs, source);
    let target = of_target(&source, target);
    if [source.machine(), target.machine()] == kinds {
        return Ok((source, target, taken));
    }
    // What they know of each other is of their former rows.
    let fresh =
        |control: Control| Control::new(control.entry(), control.profile().clone()).unwrap_or(control);
    let (source, target) = Control::meeting(fresh(source), fresh(target))?;
    Ok((source, target, taken))
}

/// The control with the rows of a lathe; none where its profile says a kind, or its table has no such rows.
pub(super) fn as_lathe(control: &Control) -> Option<Control> {
    if control.profile().machine.is_some() {
        return None;
    }
    let mut profile = control.profile().clone();
    profile.machine = Some(Machine::Lathe);
    Control::new(control.entry(), profile).ok()
}

/// The first sign of a lathe and where it stands, if no program is a mill's.
fn sign(inputs: &[Input], source: &Control) -> Option<(String, String)> {
    let mut first: Option<(usize, Span)> = None;
    for (at, some) in inputs.chunks(TOGETHER).enumerate() {
        let looked_at = |(file, input): (usize, &Input)| {
            let input = start(input);
            let lowered = lower(file, &input, source);
            let programs = lowered.programs.iter();
            programs.map(|(program, found)| Signs::of(program, found, &input.bytes, source)).collect()
        };
        let signs: Vec<Vec<Signs>> = some.par_iter().enumerate().map(looked_at).collect();
        for (file, signs) in signs.iter().enumerate() {
            if signs.iter().any(Signs::is_surely_mill) {
                return None;
            }
            let lathe = signs.iter().filter(|signs| signs.is_lathe()).find_map(|signs| signs.first.as_ref());
            first = first.or(lathe.map(|(span, _)| (at * TOGETHER + file, *span)));
        }
    }
    let (file, span) = first?;
    let input = inputs.get(file)?;
    let text = String::from_utf8_lossy(span.of(&input.bytes));
    let sign = text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(SHOWN).collect();
    let before = input.bytes.get(..span.start as usize).unwrap_or_default();
    let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
    Some((sign, format!("{}:{line}", input.name)))
}

/// A file, or its start to the last whole line.
fn start(input: &Input) -> std::borrow::Cow<'_, Input> {
    use std::borrow::Cow;
    let Some(head) = input.bytes.get(..LOOKED_AT) else { return Cow::Borrowed(input) };
    let end = head.iter().rposition(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(LOOKED_AT);
    let bytes = head.get(..end).unwrap_or(head).to_vec();
    Cow::Owned(Input { path: input.path.clone(), name: input.name.clone(), bytes })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library(files: &[(&str, &str)]) -> Vec<Input> {
        let input = |(name, text): &(&str, &str)| Input {
            path: name.into(),
            name: (*name).into(),
            bytes: text.as_bytes().to_vec(),
        };
        files.iter().map(input).collect()
    }

    fn taken(profile: &str, files: &[(&str, &str)]) -> Option<TakenAsLathe> {
        let source = Control::from_profile(profile).unwrap();
        let (control, taken) = of_library(&library(files), source.clone());
        let kind = if taken.is_some() { Machine::Lathe } else { source.machine() };
        assert_eq!(control.machine(), kind);
        taken
    }

    const FANUC: &str = "dialect = \"fanuc\"";
    const SHAFT: (&str, &str) = ("shaft.nc", "O1\n(SHAFT)\nT0101\nG96 S200 M3\nG0 X50. Z2.\nM98 P2\nM30\n");
    const CUT: (&str, &str) = ("cut.nc", "O2\nG1 X40. F.1\nM99\n");
    const PLATE: (&str, &str) = ("plate.nc", "O11\nT1 M6\nG90 G54 G0 X0. Y0.\nG43 H1 Z5.\nM30\n");

    #[test]
    fn a_library_of_lathe_programs_is_a_lathes() {
        let of = taken(FANUC, &[CUT, SHAFT]).unwrap();
        assert_eq!(
            (of.sign.as_str(), of.place.as_str(), of.system.as_deref()),
            ("T0101", "shaft.nc:3", Some("A"))
        );
        let of = taken("dialect = \"haas\"", &[("a.nc", "O1\nG28 U0 W0\nG0 X50. Z2.\nM30\n")]).unwrap();
        assert_eq!((of.sign.as_str(), of.place.as_str(), of.system), ("G28 U0 W0", "a.nc:2", None));
        // The system that the profile says is not told again.
        let stated = format!("{FANUC}\n[settings]\ngcode_system = \"B\"");
        assert_eq!(taken(&stated, &[SHAFT]).unwrap().system, None);
    }

    #[test]
    fn a_mixed_library_is_no_lathes() {
        assert_eq!(taken(FANUC, &[SHAFT, PLATE]), None);
        // However far behind it stands.
        let mut many: Vec<(&str, &str)> = vec![SHAFT; 40];
        many.push(PLATE);
        assert_eq!(taken(FANUC, &many), None);
        assert_eq!(taken(FANUC, &[PLATE, CUT]), None);
        assert_eq!(taken(FANUC, &[CUT]), None);
    }

    #[test]
    fn a_lathe_may_have_y() {
        let live = ("live.nc", "O3\nT0404\nM133 P2000\nG0 X50. Y0. Z2.\nG1 Y12. F.1\nM135\nM30\n");
        assert_eq!(taken("dialect = \"haas\"", &[SHAFT, live]).unwrap().place, "shaft.nc:3");
        let home = ("family.nc", "O6\nG18 G99\nG53 X0.\nG53 Y0.\nG65 P1 D1.\nM30\n");
        assert_eq!(taken("dialect = \"haas\"", &[home, SHAFT]).unwrap().place, "shaft.nc:3");
        // A tool that is made ready for its change.
        let mill = ("mill.nc", "O4\nT0404\nM6\nG0 G54 X50. Y0.\nG1 Y12. F100.\nM30\n");
        assert_eq!(taken(FANUC, &[mill]), None);
        assert_eq!(taken(FANUC, &[("plain.nc", "O5\nG0 G54 X50. Y0.\nG1 Y12. F100.\nM30\n")]), None);
    }

    #[test]
    fn what_a_profile_says_counts() {
        assert_eq!(taken("dialect = \"fanuc\"\nmachine = \"mill\"", &[SHAFT]), None);
        assert_eq!(taken("dialect = \"fanuc\"\nmachine = \"lathe\"", &[SHAFT]), None);
        // A control without rows for a lathe has none.
        assert_eq!(taken("dialect = \"fadal\"", &[SHAFT]), None);
    }

    #[test]
    fn a_target_is_of_the_same_kind_unless_it_says_its_own() {
        let lathe = Control::from_profile("dialect = \"fanuc\"\nmachine = \"lathe\"").unwrap();
        let to = |profile: &str| of_target(&lathe, Control::from_profile(profile).unwrap()).machine();
        assert_eq!(to("dialect = \"haas\""), Machine::Lathe);
        assert_eq!(to("dialect = \"haas\"\nmachine = \"mill\""), Machine::Mill);
        assert_eq!(to("dialect = \"fadal\""), Machine::Mill);
        let mill = Control::plain("fanuc").unwrap();
        assert_eq!(of_target(&mill, Control::plain("haas").unwrap()).machine(), Machine::Mill);
    }

    #[test]
    fn a_long_file_is_known_by_its_start() {
        let long = format!("O1\nT0101\n{}", "G1 X40. F.1\n".repeat(LOOKED_AT / 8));
        assert_eq!(taken(FANUC, &[("long.nc", &long)]).unwrap().place, "long.nc:2");
    }
}
