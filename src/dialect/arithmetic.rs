//! With how many digits a machine calculates, where a setting says it.

use super::{Control, Plain};

/// The columns of numbers that a setting may change, and what the longer arithmetic is called there.
const COLUMN: &str = "numbers:arithmetic";
const DOUBLE: &str = "double";

impl Control {
    /// The line of a profile that says that the machine calculates with about fifteen digits. No line, if its table has no
    /// setting for that.
    pub fn says_double(&self) -> Option<String> {
        let (section, key, value) = self.double_setting()?;
        Some(format!("{key} = \"{value}\" under [{section}]"))
    }

    /// True if the machine's profile says so itself.
    pub fn is_said_double(&self) -> bool {
        let Some((section, key, value)) = self.double_setting() else { return false };
        let profile = self.profile();
        let stated = if section == "parameters" { &profile.parameters } else { &profile.settings };
        stated.get(key).map(Plain::to_string).as_deref() == Some(value)
    }

    /// The section, the key and the value of the setting.
    pub fn double_setting(&self) -> Option<(&'static str, &str, &str)> {
        self.dialect().settings.iter().find_map(|row| {
            let doubles = |(_, sets): &(&String, &std::collections::BTreeMap<String, String>)| {
                sets.get(COLUMN).is_some_and(|arithmetic| arithmetic == DOUBLE)
            };
            let (value, _) = row.sets.iter().find(doubles)?;
            let parameter = row.name.strip_prefix("parameter.").map(|key| ("parameters", key));
            let (section, key) =
                parameter.or_else(|| Some(("settings", row.name.strip_prefix("setting.")?)))?;
            Some((section, key, value.as_str()))
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::dialect::Control;

    #[test]
    fn the_profile_says_with_how_many_digits_a_machine_calculates() {
        for (text, double) in [
            ("dialect = \"haas\"", false),
            ("dialect = \"haas\"\n[settings]\narithmetic = \"single\"", false),
            ("dialect = \"haas\"\n[settings]\narithmetic = \"double\"", true),
            ("dialect = \"fanuc\"", false),
            ("dialect = \"fanuc\"\n[parameters]\n6008.0 = \"0\"", true),
            ("dialect = \"fanuc\"\n[parameters]\n6008.0 = \"1\"", false),
            ("dialect = \"fadal\"", false),
            ("dialect = \"haas\"\nconfirm = [\"setting.arithmetic=double\"]", true),
            ("dialect = \"fanuc\"\nconfirm = [\"parameter.6008.0=0\"]", true),
        ] {
            assert_eq!(Control::from_profile(text).unwrap().is_said_double(), double, "{text}");
        }
        let both = "dialect = \"haas\"\nconfirm = [\"setting.arithmetic=double\"]\n[settings]\narithmetic = \"single\"";
        assert!(Control::from_profile(both).is_err());
        let none = "dialect = \"haas\"\nconfirm = [\"setting.arithmetic=triple\"]";
        assert!(Control::from_profile(none).is_err());
    }
}
