//! Machines named in the head of a test case.

use macroglot::dialect::{Control, Profile, registry};

/// The control of `fanuc`, or of `fanuc[units="inch";options=[]]`: a dialect, and behind it the lines of a machine profile.
pub fn machine(spec: &str) -> Result<Control, String> {
    let (name, lines) = match spec.split_once('[') {
        Some((name, rest)) => (name, rest.strip_suffix(']').ok_or_else(|| format!("{spec}: no ']'"))?),
        None => (spec, ""),
    };
    let entry = registry::find(name).ok_or_else(|| format!("no dialect '{name}'"))?;
    let profile = Profile::read(&format!("dialect = \"{name}\"\n{}", lines.replace(';', "\n")));
    let told = |all: Vec<macroglot::diag::Diagnostic>| {
        format!("{spec}: {}", all.first().map_or("", |diagnostic| &diagnostic.message))
    };
    Control::new(entry, profile.map_err(told)?).map_err(told)
}
