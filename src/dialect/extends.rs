//! Machine profiles that extend others: what several machines of a shop have in common stands once.
//!
//! A profile of its own counts first. Of what is listed (facts, variables, codes, signals) both lists count, and a code or a
//! signal that both name is as the profile itself has it.

use super::profile::Profile;
use super::start::Start;
use super::{Control, faults_as_text, registry};
use crate::diag::{Code, Diagnostic};
use crate::text::Span;
use std::path::{Path, PathBuf};

/// How many profiles may extend one another.
const DEEPEST: usize = 8;

/// Why a profile could not be read: what is wrong in which file, a line for each fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unreadable(String);

impl Unreadable {
    /// The lines, each with its end.
    pub fn lines(&self) -> &str {
        &self.0
    }
}

impl Profile {
    /// Reads the profile in a file, with all that it extends.
    ///
    /// # Errors
    /// If a file of them cannot be read, or says something wrong.
    pub fn load(path: &Path) -> Result<Self, Unreadable> {
        load(path, &mut Vec::new())
    }

    /// The files that it stands in: its own, and those that it extends.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.file.iter().chain(&self.bases)
    }

    /// What the profile says, over what another one says.
    fn over(self, base: Self) -> Self {
        let mut bases: Vec<PathBuf> = base.file.into_iter().chain(base.bases).collect();
        bases.extend(self.bases);
        let both = |mut all: Vec<String>, own: Vec<String>| {
            all.extend(own);
            all.dedup();
            all
        };
        let mut site = base.site;
        site.retain(|row| !self.site.iter().any(|own| own.code == row.code));
        site.extend(self.site);
        let mut signal = base.signal;
        signal
            .retain(|row| !self.signal.iter().any(|own| (own.input, own.output) == (row.input, row.output)));
        signal.extend(self.signal);
        Self {
            dialect: base.dialect,
            extends: self.extends,
            title: self.title.or(base.title),
            machine: self.machine.or(base.machine),
            outputs: self.outputs.or(base.outputs),
            units: self.units.or(base.units),
            decimal_point: self.decimal_point.or(base.decimal_point),
            head: self.head.or(base.head),
            line_ends: self.line_ends.or(base.line_ends),
            options: self.options.or(base.options),
            offsets: self.offsets.or(base.offsets),
            work_offsets: self.work_offsets.or(base.work_offsets),
            axes: self.axes.or(base.axes),
            parameters: base.parameters.into_iter().chain(self.parameters).collect(),
            settings: base.settings.into_iter().chain(self.settings).collect(),
            behaviours: base.behaviours.into_iter().chain(self.behaviours).collect(),
            limits: base.limits.into_iter().chain(self.limits).collect(),
            start: Start { codes: self.start.codes.or(base.start.codes) },
            reserved: both(base.reserved, self.reserved),
            variables: self.variables.or(base.variables),
            programs: both(base.programs, self.programs),
            standing_results: both(base.standing_results, self.standing_results),
            program_numbers: match self.program_numbers.is_empty() {
                true => base.program_numbers,
                false => self.program_numbers,
            },
            machine_places: both(base.machine_places, self.machine_places),
            confirm: both(base.confirm, self.confirm),
            site,
            signal,
            file: self.file,
            bases,
            places: self.places,
        }
    }
}

impl Control {
    /// The control of a machine, by the profile in a file.
    ///
    /// # Errors
    /// If the profile cannot be read, or says something that its dialect's table does not take.
    pub fn load(path: &Path) -> Result<Self, Unreadable> {
        made(Profile::load(path)?)
    }
}

/// The text of a profile.
fn as_text(name: &str, bytes: Vec<u8>) -> Result<String, Unreadable> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let byte = error.as_bytes().get(at).copied().unwrap_or_default();
        let text = String::from_utf8_lossy(error.as_bytes().get(..at).unwrap_or_default()).into_owned() + "?";
        let place = u32::try_from(at).unwrap_or(u32::MAX);
        let what = format!("the byte {byte:02X} is no text in UTF-8");
        let help = "save the file as UTF-8, or write this letter without its accent";
        let fault = Diagnostic::new(Code::MachineProfile, Span::new(place, place), what).with_help(help);
        Unreadable(faults_as_text(name, &text, &[fault]))
    })
}

/// Reads a profile; `after` are those that extend it, one after the other.
fn load(path: &Path, after: &mut Vec<PathBuf>) -> Result<Profile, Unreadable> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|error| Unreadable(format!("{name}: {error}\n")))?;
    let text = as_text(&name, bytes)?;
    let told = |faults: &[Diagnostic]| Unreadable(faults_as_text(&name, &text, faults));
    let mut profile = Profile::read(&text).map_err(|faults| told(&faults))?;
    profile.file = Some(path.to_owned());
    let fault = |key: &str, message: String, help: &str| {
        let place = profile.place(key).unwrap_or_default();
        let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        let span = Span::new(offset(place.start), offset(place.end));
        told(&[Diagnostic::new(Code::MachineProfile, span, message).with_help(help)])
    };
    // Without a dialect of its own, a profile is of that of the one that it extends.
    let told_there = profile.dialect.is_empty() && profile.extends.is_some();
    if !told_there && registry::find(&profile.dialect).is_none() {
        let message = match profile.dialect.as_str() {
            "" => "the profile does not say whose it is".to_owned(),
            other => format!("no dialect is named '{other}'"),
        };
        let names: Vec<&str> = registry::all().iter().map(|entry| entry.name).collect();
        let help = format!("write dialect = \"NAME\" with one of {}", names.join(", "));
        return Err(fault("dialect", message, &help));
    }
    let Some(extends) = profile.extends.clone() else { return Ok(profile) };
    if extends.as_os_str().is_empty() {
        let help = "write the file's name, or take the line out";
        return Err(fault("extends", "'extends' names no file".to_owned(), help));
    }
    let place = path.parent().unwrap_or_else(|| Path::new("")).join(&extends);
    if !place.is_file() {
        let message = match place.is_dir() {
            true => format!("{} is a folder, and no profile", place.display()),
            false => format!("there is no profile {}", place.display()),
        };
        return Err(fault("extends", message, "the path counts from the folder of this profile"));
    }
    after.push(path.to_owned());
    let same = |other: &PathBuf| {
        let [one, other] = [other, &place].map(|path| path.canonicalize().ok());
        one.is_some() && one == other
    };
    if let Some(first) = after.iter().position(same) {
        let circle: Vec<String> =
            after.iter().skip(first).chain([&place]).map(|path| path.display().to_string()).collect();
        let message = format!("a profile extends itself: {}", circle.join(" extends "));
        return Err(fault("extends", message, "take one of these 'extends' lines out"));
    }
    if after.len() == DEEPEST {
        let message = format!("{DEEPEST} profiles extend one another");
        return Err(fault("extends", message, "put what they have in common into fewer of them"));
    }
    let base = load(&place, after)?;
    if !told_there && base.dialect != profile.dialect {
        let message = format!(
            "{} is a profile for '{}', this one for '{}'",
            place.display(),
            base.dialect,
            profile.dialect
        );
        return Err(fault("extends", message, "a profile extends one of its own dialect"));
    }
    // What is wrong there is told at its own place.
    made(base.clone())?;
    Ok(profile.over(base))
}

fn made(profile: Profile) -> Result<Control, Unreadable> {
    let file = profile.file.clone().unwrap_or_default();
    let told = |faults: &[Diagnostic]| {
        let text = std::fs::read_to_string(&file).unwrap_or_default();
        Unreadable(faults_as_text(&file.display().to_string(), &text, faults))
    };
    let Some(entry) = registry::find(&profile.dialect) else {
        let message = format!("no dialect is named '{}'", profile.dialect);
        return Err(told(&[Diagnostic::new(Code::MachineProfile, Span::default(), message)]));
    };
    Control::new(entry, profile).map_err(|faults| match faults.iter().any(|f| f.code == Code::DialectTable) {
        true => Unreadable(entry.faults_as_text(&faults)),
        false => told(&faults),
    })
}
