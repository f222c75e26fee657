//! Settings that one answer stands for: they are no lines of their own.

use super::{AskedSetting, Survey};
use crate::canon::CycleSetting;
use crate::dialect::{Control, Question, Side};
use std::collections::BTreeMap;

/// The settings from which cycles take what no program says, where one line asks whether they are right for all of them; none if
/// the profile states one of them, as then they are answered one by one. How far a thread runs out is none of these.
pub(super) fn left<'s>(survey: &'s Survey<'_>, side: Side, control: &Control) -> Vec<&'s str> {
    let of_side = || survey.settings.iter().filter(|setting| setting.side == side);
    if !of_side().any(is_for_all) {
        return Vec::new();
    }
    let is_left = |name: &str| {
        let Some(row) = control.setting_row(&format!("setting.{name}")) else { return false };
        let of = |role| row.cycles.iter().find_map(|op| CycleSetting::of(*op, role));
        row.gives.or(row.otherwise).and_then(of).is_some_and(|what| what != CycleSetting::ThreadRunOut)
    };
    if control.profile().settings.keys().any(|name| is_left(name)) {
        return Vec::new();
    }
    let names =
        of_side().filter(|setting| setting.section == "settings").map(|setting| setting.name.as_str());
    names.filter(|name| is_left(name)).collect()
}

/// True for the question whether the settings of a machine are right for all its cycles.
fn is_for_all(setting: &AskedSetting) -> bool {
    setting.section == "behaviours" && Question::find(&setting.name) == Some(Question::CycleSettings)
}

/// The line of that question with the settings that may be answered in its place.
pub(super) fn or_each(line: String, setting: &AskedSetting, left: &[&str]) -> String {
    if left.is_empty() || !is_for_all(setting) {
        return line;
    }
    let each: Vec<String> = left.iter().map(|name| format!("{name} = ...")).collect();
    format!("{}; or state each under [settings]: {}\n", line.trim_end(), each.join(", "))
}

/// True where another line asks for what the setting says.
pub(super) fn is_answered(
    setting: &AskedSetting,
    control: &Control,
    asked: &BTreeMap<&'static str, String>,
) -> bool {
    let stem = if setting.section == "parameters" { "parameter." } else { "setting." };
    let Some(row) = control.setting_row(&format!("{stem}{}", setting.name)) else { return false };
    let Some(lines) = asked.get("behaviours") else { return false };
    let mut sets = row.sets.values().flat_map(BTreeMap::keys).peekable();
    let is_asked = |fact: &str| {
        let name = fact.strip_prefix("behaviour:");
        name.is_some_and(|name| lines.contains(&format!("{} \"{name}\" = ", super::filled::ASKS)))
    };
    sets.peek().is_some() && sets.all(|fact| is_asked(fact))
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    fn asked(text: &str, source: &str, target: &str, side: Side) -> String {
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let [from, to] = [source, target].map(|text| Control::from_profile(text).unwrap());
        let old = if side == Side::Source { source } else { target };
        filled(&survey(&inputs, &from, Some(&to)), side, Some(old)).unwrap()
    }

    const LATHE: &str = "dialect = \"haas\"\nmachine = \"lathe\"\nunits = \"metric\"\n";

    /// How far the passes of a contour go back is left to the machine, or stated: never both.
    #[test]
    fn one_line_stands_for_the_settings_of_cycles() {
        // Two values in one run, of which the machine has one.
        let text = "O1\nG21 G18 G99\nT0101\nG0 X50. Z2.\nG75 R.5\nG75 X30. Z-20. P2000 Q3000 F.1\nG0 Z-30.\nG75 R.3\nG75 X30. Z-40. P2000 \
                    Q3000 F.1\nG0 X60.\nM30\n";
        let source = "dialect = \"fanuc\"\nmachine = \"lathe\"\nunits = \"metric\"\n[settings]\ngcode_system = \"A\"\n";
        let open = asked(text, source, LATHE, Side::Target);
        assert!(
            !open.contains("#? 22 = ") && open.contains("or state each under [settings]: 22 = ..."),
            "{open}"
        );
        let stated = asked(text, source, &format!("{LATHE}[settings]\n73 = 1\n"), Side::Target);
        assert!(stated.contains("#? 22 = "), "{stated}");
    }

    const MILL: &str = "dialect = \"fanuc\"\nmachine = \"mill\"\nunits = \"metric\"\n";
    const STOPS: &str =
        "O1\nG21 G90 G54 G17 G94\nT1 M6\nS900 M3\nM8\nG0 X1.\nM0\nG1 X2. F100.\nT2 M6\nG1 X3.\nM30\n";

    /// What stops end is one line with an answer for each, and the answers count as those of the single names.
    #[test]
    fn what_stops_end_is_one_line() {
        let target = "dialect = \"haas\"\nmachine = \"mill\"\nunits = \"metric\"\n";
        let text = asked(STOPS, MILL, target, Side::Source);
        let line = "#? \"halts.end\" = \"stop yes|no, change yes|no\" # ";
        assert!(text.contains(line) && !text.contains("\"stop.ends\" ="), "{text}");
        let answered = text.replace(line, "\"halts.end\" = \"stop no, change yes\" # ");
        let control = Control::from_profile(&answered).unwrap();
        let says = |question| control.behaviour(question).map(|row| row.value.as_str());
        use crate::dialect::Question::{ChangeEndsCoolant, MessageEndsSpindle, StopEndsSpindle};
        assert_eq!(says(StopEndsSpindle), Some("false"));
        assert_eq!(says(ChangeEndsCoolant), Some("true"));
        assert_eq!(says(MessageEndsSpindle), Some("unknown"));
        assert!(Control::from_profile(&text.replace(line, "\"halts.end\" = \"stop yes|no\" # ")).is_err());
    }

    /// A person who confirms it says the setting, and a setting that says otherwise is a fault.
    #[test]
    fn how_machines_calculate_is_a_fact_to_confirm() {
        let text = "O1\nG21 G90\n#1=0\nWHILE[#1LT1.]DO1\n#1=#1+#500\nEND1\nM30\n";
        let target = "dialect = \"haas\"\nmachine = \"mill\"\nunits = \"metric\"\n";
        for (side, old) in [(Side::Source, MILL), (Side::Target, target)] {
            let asked = asked(text, MILL, target, side);
            let fact = match side {
                Side::Source => "parameter.6008.0=0",
                Side::Target => "setting.arithmetic=double",
            };
            assert!(asked.contains(&format!("#? \"{fact}\",")), "{asked}");
            assert!(!asked.contains("#? 6008.0 =") && !asked.contains("#? arithmetic ="), "{asked}");
            let said = Control::from_profile(&asked.replace("#? \"", "\"")).unwrap();
            assert!(said.is_said_double(), "{old}");
        }
    }
}
