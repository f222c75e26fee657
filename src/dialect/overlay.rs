//! Lays a machine profile over a dialect's table.

use super::extents;
use super::overlay_settings::settle_tool_words;
use super::profile::{Axis, Profile, VariableRun};
use super::reader::Reader;
use super::{
    Behaviour, Control, Dialect, Entry, Mark, Question, SameCells, SystemVariable, VariableClass, registry,
};
use crate::diag::{Code, Diagnostic};
use std::collections::{BTreeMap, BTreeSet};

impl Control {
    /// A control of a dialect, with its profile. What the profile says wrong
    /// comes back with its place in the profile's text; so do the faults of a
    /// table that does not load, with theirs in the table's.
    pub fn new(entry: &'static Entry, profile: Profile) -> Result<Self, Vec<Diagnostic>> {
        let mut dialect = entry.dialect().map_err(<[Diagnostic]>::to_vec)?.clone();
        let mut overlay = Overlay::new(profile);
        overlay.check_dialect(entry);
        overlay.keep_answers(&mut dialect);
        leave_open(&mut dialect);
        overlay.confirmed_settings();
        let settings = overlay.settings(&dialect);
        overlay.apply(&mut dialect, &settings);
        overlay.check_machine(&dialect);
        overlay.check_options(&dialect);
        overlay.keep_present(&mut dialect, &settings);
        overlay.doubt(&mut dialect);
        overlay.behaviours(&mut dialect);
        overlay.limits(&mut dialect);
        overlay.counts();
        extents::clamp(&mut dialect, &overlay.profile);
        overlay.axes(&mut dialect);
        let table = dialect.variables.clone();
        overlay.keep_variables(&mut dialect);
        let reserved = overlay.reserved(&table, &dialect);
        let has_locals = dialect.variables.iter().any(|class| class.class == "local");
        let standing = overlay.standing(dialect.text.program_max, has_locals);
        let shared = |number: u32| {
            let is_space = |name: &String| Some(name) == dialect.names.numbered.as_ref();
            let twice = |row: &&SameCells| is_space(&row.name) && (row.first..=row.last).contains(&number);
            let cell = dialect.same_cells.iter().find(twice).map_or(number, |row| row.cell_of(number));
            let mut rows =
                dialect.variables.iter().filter(|row| !matches!(row.class.as_str(), "local" | "letter"));
            rows.any(|row| is_space(&row.name) && (row.first..=row.last).contains(&cell)).then_some(cell)
        };
        let standing_results = overlay.standing_results(dialect.names.numbered.as_deref(), &shared);
        let machine_places = overlay.machine_places();
        let program_numbers = overlay.program_numbers(dialect.text.program_max);
        overlay.site(&mut dialect);
        overlay.signals(&mut dialect);
        overlay.confirm(&mut dialect);
        settle_tool_words(&mut dialect);
        Overlay::rest(&mut dialect);
        let Overlay { mut reader, profile, .. } = overlay;
        if !reader.faults.is_empty() {
            return Err(reader.faults);
        }
        let place = profile.place("start:codes").unwrap_or(0..0);
        let mut control = Control::index(entry, dialect, profile, settings, (reserved, standing));
        (control.machine_places, control.standing_results) = (machine_places, standing_results);
        control.program_numbers = program_numbers;
        match control.read_start() {
            Ok(()) => Ok(control),
            Err((message, help)) => {
                reader.fault(place, message, help);
                Err(reader.faults)
            }
        }
    }

    /// A control of a dialect without a profile.
    pub fn plain(name: &str) -> Option<Self> {
        let entry = registry::find(name)?;
        Control::new(entry, Profile { dialect: name.into(), ..Profile::default() }).ok()
    }

    /// A control from a profile's text: the profile names its dialect.
    pub fn from_profile(text: &str) -> Result<Self, Vec<Diagnostic>> {
        let profile = Profile::read(text)?;
        match registry::find(&profile.dialect) {
            Some(entry) => Control::new(entry, profile),
            None => {
                let mut overlay = Overlay::new(profile);
                overlay.unknown_dialect();
                Err(overlay.reader.faults)
            }
        }
    }
}

/// What the table leaves to a setting is open until the profile states it.
fn leave_open(dialect: &mut Dialect) {
    for row in &mut dialect.behaviours {
        if row.question.may_hang_on_setting(&row.value) && !row.question.answers().admits(&row.value) {
            row.value = "unknown".into();
            row.origin.mark = Mark::Unconfirmed;
        }
    }
}

/// The options that rows of a table need.
fn options_of(dialect: &Dialect) -> BTreeSet<&str> {
    let rows = dialect.codes.iter().map(|row| &row.option);
    let rows = rows.chain(dialect.system.iter().map(|row| &row.option));
    let rows = rows.chain(dialect.variables.iter().map(|row| &row.option));
    let rows = rows.chain(dialect.same_cells.iter().map(|row| &row.option));
    let rows = rows.chain(dialect.functions.iter().map(|row| &row.option));
    let rows = rows.chain(dialect.operators.iter().map(|row| &row.option));
    let rows = rows.chain(dialect.statements.iter().map(|row| &row.option));
    let rows = rows.chain(dialect.behaviours.iter().map(|row| &row.option));
    rows.filter_map(Option::as_deref).filter(|option| !option.starts_with(WITHOUT)).collect()
}

/// What stands before an option in a row of controls that do not have it.
const WITHOUT: &str = "not.";

/// True where one of two rows is for controls that have an option, and the other for those that do not.
pub(super) fn options_apart(a: Option<&String>, b: Option<&String>) -> bool {
    let without = |x: &String, y: &String| x.strip_prefix(WITHOUT) == Some(y);
    a.zip(b).is_some_and(|(a, b)| without(a, b) || without(b, a))
}

/// True where an option is there: where the profile does not list the options, each may be.
fn has(option: &Option<String>, bought: &Option<Vec<String>>) -> bool {
    match (option, bought) {
        (Some(option), Some(bought)) => match option.strip_prefix(WITHOUT) {
            Some(other) => !bought.iter().any(|bought| bought == other),
            None => bought.contains(option),
        },
        _ => true,
    }
}

/// A profile on its way over a table.
pub(super) struct Overlay {
    reader: Reader,
    pub(super) profile: Profile,
    /// The settings that the profile states.
    pub(super) stated: BTreeSet<String>,
}

impl Overlay {
    fn new(profile: Profile) -> Self {
        Self { reader: Reader::new(Code::MachineProfile), profile, stated: BTreeSet::new() }
    }

    pub(super) fn fault(&mut self, place: &str, message: String, help: String) {
        let section = place.split(':').next().unwrap_or(place);
        let place = self.profile.places.get(place).or_else(|| self.profile.places.get(section));
        self.reader.fault(place.cloned().unwrap_or(0..0), message, help);
    }

    fn unknown_dialect(&mut self) {
        let names: Vec<&str> = registry::all().iter().map(|entry| entry.name).collect();
        let message = match self.profile.dialect.as_str() {
            "" => "the profile does not say its dialect".into(),
            name => format!("no dialect is named '{name}'"),
        };
        self.fault(
            "dialect",
            message,
            format!("write 'dialect = \"NAME\"' with one of {}", names.join(", ")),
        );
    }

    fn check_dialect(&mut self, entry: &Entry) {
        if self.profile.dialect != entry.name {
            let message = format!("the profile is for '{}', not for '{}'", self.profile.dialect, entry.name);
            self.fault("dialect", message, "name the profile's own dialect".into());
        }
        if self.profile.extends.is_some() && self.profile.bases.is_empty() {
            let message = "this profile extends another, which was not read with it".into();
            self.fault("extends", message, "name the profile by its file".into());
        }
    }

    /// A kind of machine that no row of the table speaks of would be read as the one that the rows are for.
    fn check_machine(&mut self, dialect: &Dialect) {
        let Some(machine) = self.profile.machine.filter(|machine| *machine != super::Machine::Mill) else {
            return;
        };
        let name = machine.name();
        if !dialect.codes.iter().any(|row| row.machine.as_deref() == Some(name)) {
            let message = format!("the table of {} has no rows for a {name}", dialect.title);
            self.fault(
                "machine",
                message,
                format!("the codes of a {name} are not known for this control: leave out its programs"),
            );
        }
    }

    /// An option that no row of the table needs would be taken for one that was not bought under its right name.
    fn check_options(&mut self, dialect: &Dialect) {
        let named = self.profile.options.clone().unwrap_or_default();
        let known = options_of(dialect);
        for name in named.iter().filter(|name| !known.contains(name.as_str())) {
            let list = known.iter().copied().collect::<Vec<_>>().join(", ");
            let message = format!("no row of {} needs an option '{name}'", dialect.title);
            let help = match known.is_empty() {
                true => "leave it out: the table has no options".to_owned(),
                false => format!("name one of {list}, or leave it out"),
            };
            self.fault("options", message, help);
        }
    }

    fn machine(&self) -> &'static str {
        self.profile.machine.map_or("mill", super::profile::Machine::name)
    }

    /// Drops the settings and the answers of another machine. Of several answers to one question it keeps one that names its
    /// machine or its option, and of those the first.
    fn keep_answers(&self, dialect: &mut Dialect) {
        let machine = self.machine();
        let here = |of: &Option<String>| of.as_deref().is_none_or(|of| of == machine);
        dialect.settings.retain(|row| here(&row.machine));
        let rows = std::mem::take(&mut dialect.behaviours);
        let count = |question| rows.iter().filter(|row| row.question == question).count();
        let several: BTreeSet<_> =
            rows.iter().map(|row| row.question).filter(|one| count(*one) > 1).collect();
        let (open, single): (Vec<Behaviour>, _) =
            rows.into_iter().partition(|row| several.contains(&row.question));
        dialect.behaviours = single;
        for question in several {
            let rows = open.iter().filter(|row| row.question == question && here(&row.machine));
            let mut rows = rows.filter(|row| has(&row.option, &self.profile.options));
            let general = |row: &&Behaviour| row.machine.is_none() && row.option.is_none();
            let first = rows.clone().find(|row| !general(row)).or_else(|| rows.next());
            dialect.behaviours.extend(first.map(|row| Behaviour { option: None, ..row.clone() }));
        }
        dialect.behaviours.retain(|row| here(&row.machine));
    }

    /// Drops the rows of another machine, of other settings, of options that were not bought.
    fn keep_present(&mut self, dialect: &mut Dialect, settings: &BTreeMap<String, String>) {
        let (machine, bought) = (self.machine(), self.profile.options.clone());
        let has = |option: &Option<String>| has(option, &bought);
        let here = |of: &Option<String>, when: &Option<String>, option: &Option<String>| {
            let set = |when: &String| {
                conditions(when).all(|(name, mut values)| {
                    settings.get(name).is_some_and(|set| values.any(|value| set == value))
                })
            };
            of.as_deref().is_none_or(|of| of == machine) && when.as_ref().is_none_or(set) && has(option)
        };
        let codes = std::mem::take(&mut dialect.codes).into_iter();
        let (codes, others) = codes.partition(|row| here(&row.machine, &row.when, &row.option));
        (dialect.codes, dialect.other_codes) = (codes, others);
        dialect.other_codes.retain(|row| row.when.is_some());
        let system = std::mem::take(&mut dialect.system).into_iter();
        let (system, others) = system.partition(|row| here(&row.machine, &row.when, &row.option));
        (dialect.system, dialect.other_system) = (system, others);
        dialect.other_system.retain(|row| row.when.is_some() && here(&row.machine, &None, &row.option));
        dialect.words.retain(|row| here(&row.machine, &row.when, &None));
        dialect.forbidden.retain(|row| here(&row.machine, &row.when, &None));
        dialect.variables.retain(|row| has(&row.option));
        dialect.same_cells.retain(|row| has(&row.option));
        dialect.functions.retain(|row| has(&row.option));
        dialect.operators.retain(|row| has(&row.option));
        dialect.statements.retain(|row| has(&row.option));
        // Whether an option was bought is the owner's word on what it brings.
        for row in dialect.behaviours.iter_mut().filter(|row| row.option.is_some() && bought.is_some()) {
            row.value = has(&row.option).to_string();
            row.origin.mark = Mark::Confirmed;
        }
        // A row that holds under a setting stands for the general one of the same letter.
        let special: BTreeSet<String> = dialect
            .words
            .iter()
            .filter(|row| row.when.is_some() || row.machine.is_some())
            .map(|row| row.letter.clone())
            .collect();
        dialect
            .words
            .retain(|row| row.when.is_some() || row.machine.is_some() || !special.contains(&row.letter));
    }

    /// Numbers the axes as this machine does: a run over axes becomes one run for each axis. They count in the profile's order, or
    /// by their letters on every machine. Without a profile a lathe has X and Z.
    fn axes(&mut self, dialect: &mut Dialect) {
        let lathe = self.profile.machine == Some(super::Machine::Lathe);
        let axes = match &self.profile.axes {
            Some(axes) => axes.clone(),
            None if lathe => vec![Axis::X, Axis::Z],
            None => return,
        };
        if axes.iter().enumerate().any(|(at, axis)| axes.iter().take(at).any(|earlier| earlier == axis)) {
            self.fault("axes", "an axis stands twice".into(), "name each axis once".into());
        }
        let lettered = |row: &Behaviour| row.question == Question::AxesNumbered && row.value == "letter";
        // What stands at each number: none if this machine has not the axis of that letter.
        let numbered: Vec<Option<Axis>> = match dialect.behaviours.iter().any(lettered) {
            true => Axis::ALL.iter().map(|axis| axes.contains(axis).then_some(*axis)).collect(),
            false => axes.iter().copied().map(Some).collect(),
        };
        dialect.system = std::mem::take(&mut dialect.system)
            .into_iter()
            .flat_map(|row| match (row.first, row.subscripts.split_last()) {
                (Some(first), Some((last, rest))) if last.axis => (0..last.count)
                    .zip(numbered.iter().skip(last.from.saturating_sub(1) as usize))
                    .filter_map(|(at, axis)| Some((at, (*axis)?)))
                    .map(|(at, axis)| SystemVariable {
                        first: first.checked_add(at * last.step),
                        subscripts: rest.to_vec(),
                        after: vec![axis.number()],
                        ..row.clone()
                    })
                    .collect(),
                _ => vec![row],
            })
            .collect();
    }

    /// A machine without an axis, a variable or a tool offset is none.
    fn counts(&mut self) {
        let none = |list: bool| if list { "[]" } else { "0" };
        let profile = &self.profile;
        let empty = [
            ("axes", profile.axes.as_ref().is_some_and(Vec::is_empty), true),
            ("variables", profile.variables.as_ref().is_some_and(Vec::is_empty), true),
            ("offsets", profile.offsets == Some(0), false),
        ];
        for (name, _, list) in empty.into_iter().filter(|(_, empty, _)| *empty) {
            let message = format!("'{name} = {}' says that the machine has none", none(list));
            self.fault(name, message, "write those that it has, or remove the line".into());
        }
    }

    /// The variables that programs must not be given. A run without any variable of the control is a slip.
    fn reserved(&mut self, table: &[VariableClass], dialect: &Dialect) -> Vec<VariableRun> {
        let mut runs = Vec::new();
        for text in self.profile.reserved.clone() {
            let Some(run) = self.runs("reserved", std::slice::from_ref(&text)).pop() else { continue };
            let mut classes = table.iter().chain(&dialect.variables);
            if run.kind.is_none() && !classes.any(|class| run.meets(class)) {
                let names: BTreeSet<&str> =
                    dialect.variables.iter().map(|class| class.name.as_str()).collect();
                let names = names.into_iter().collect::<Vec<_>>().join(", ");
                let message = format!("{} has no variables {text}", dialect.title);
                let help = match dialect.variables.iter().any(|class| class.name == run.name) {
                    true => "leave it out: what the control does not have is given to no program".to_owned(),
                    false => {
                        format!("name variables of this control, which begin with {names}, or leave it out")
                    }
                };
                self.fault(&format!("reserved:{text}"), message, help);
            }
            runs.push(run);
        }
        if let Some(kind) = runs.iter().find_map(|run| run.kind.clone()) {
            let what = format!("'{kind}' says nothing of reserved variables");
            self.fault("reserved", what, "leave it out; under 'variables' it says what they are".into());
        }
        runs
    }

    pub(super) fn runs(&mut self, section: &str, texts: &[String]) -> Vec<VariableRun> {
        let mut runs = Vec::new();
        for text in texts {
            match VariableRun::read(text) {
                Some(run) => runs.push(run),
                None => self.fault(
                    &format!("{section}:{text}"),
                    format!("'{text}' is not a variable or a run of variables"),
                    "write '#500', '#500-#549' or 'VX'".into(),
                ),
            }
        }
        runs
    }
}

/// What a row's `when` asks for: `setting.NAME=VALUE`, `axis.A=no` where the profile lists the axes without A, or several of them with ` and ` between; the values that do, with `|`
/// between.
pub(super) fn conditions(when: &str) -> impl Iterator<Item = (&str, std::str::Split<'_, char>)> {
    when.split(" and ").map(|one| {
        let (name, values) = one.split_once('=').unwrap_or((one, ""));
        (name, values.split('|'))
    })
}
