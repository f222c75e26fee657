//! What one machine's control has and does: the questions that everyone asks.

use super::control_codes::{Alias, address, aliases};
use super::profile::{Machine, Profile, Units, VariableRun};
use super::start::StartMode;
use super::{
    BareLength, Behaviour, Beside, CodeHead, Dialect, Entry, Function, Limit, MachinePlaces, Numbers,
    Operator, Question, SameCells, Setting, Standing, StandingResults, Statement, Text, VariableClass,
};
use crate::canon::{Func, Op, Role, Sys};
use foldhash::{HashMap, HashMapExt};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// The setting that says the G code system of a lathe, as a profile has it under `[settings]`.
pub const CODE_SYSTEM: &str = "gcode_system";

/// A dialect with a machine profile laid over it.
///
/// Rows for another kind of machine, for other settings, and for options that
/// the profile says were not bought are not in it.
#[derive(Clone, Debug)]
pub struct Control {
    pub(super) entry: &'static Entry,
    pub(super) dialect: Dialect,
    pub(super) profile: Profile,
    /// Values of the settings, by name, the profile's over the table's.
    pub(super) settings: BTreeMap<String, String>,
    pub(super) reserved: Vec<VariableRun>,
    pub(super) standing: Standing,
    /// The results of programs that stand in the machine.
    pub(super) standing_results: StandingResults,
    /// Where places of other machines lie on this one.
    pub(super) machine_places: MachinePlaces,
    /// The numbers that it leaves to programs of other machines.
    pub(super) program_numbers: Vec<(u32, u32)>,
    /// Where its own places lie on the machine that its programs go to.
    pub(super) places_there: MachinePlaces,
    pub(super) rapid_will_do: bool,
    /// Rows of each code, with the words that each wants beside it.
    pub(super) codes: HashMap<CodeHead, Vec<(usize, Vec<Beside>)>>,
    pub(super) targets: HashMap<Op, Vec<usize>>,
    pub(super) words: HashMap<(char, bool), usize>,
    /// Rows of the system variables of each name, with the first and the last number of each.
    pub(super) system: HashMap<String, Vec<(usize, u32, u32)>>,
    pub(super) states: HashMap<Sys, Vec<usize>>,
    /// The codes that call programs, by letter and number.
    pub(super) aliases: Vec<(char, f64, Alias)>,
    /// What is in force when a program begins.
    pub(super) start: Vec<StartMode>,
    /// The number of the profile, once it is asked for.
    pub(super) owner: OnceLock<u64>,
    /// The row of each question, by its place in [`Question::ALL`].
    behaviours: Vec<Option<usize>>,
}

impl Control {
    pub(super) fn index(
        entry: &'static Entry,
        dialect: Dialect,
        profile: Profile,
        settings: BTreeMap<String, String>,
        (reserved, standing): (Vec<VariableRun>, Standing),
    ) -> Self {
        let mut codes: HashMap<CodeHead, Vec<(usize, Vec<Beside>)>> = HashMap::new();
        let mut targets: HashMap<Op, Vec<usize>> = HashMap::new();
        for (at, row) in dialect.codes.iter().enumerate() {
            if let (Some(head), Some(beside)) = (row.head(), row.beside()) {
                codes.entry(head).or_default().push((at, beside));
            }
            for op in std::iter::once(row.op).chain(row.also.iter().copied()) {
                targets.entry(op).or_default().push(at);
            }
        }
        let words = (dialect.words.iter().enumerate())
            .filter_map(|(at, row)| Some((address(&row.letter)?, at)))
            .collect();
        let mut system: HashMap<String, Vec<(usize, u32, u32)>> = HashMap::new();
        let mut states: HashMap<Sys, Vec<usize>> = HashMap::new();
        for (at, row) in dialect.system.iter().enumerate() {
            let (first, last) = (row.first.unwrap_or(0), row.last().unwrap_or(u32::MAX));
            system.entry(row.name.clone()).or_default().push((at, first, last));
            states.entry(row.state).or_default().push(at);
        }
        let aliases = aliases(&dialect, &settings, &profile);
        let mut behaviours = vec![None; Question::ALL.len()];
        for (at, row) in dialect.behaviours.iter().enumerate() {
            if let Some(place) = behaviours.get_mut(row.question as usize) {
                *place = Some(at);
            }
        }
        Self {
            entry,
            owner: OnceLock::new(),
            dialect,
            profile,
            settings,
            reserved,
            standing,
            standing_results: StandingResults::default(),
            machine_places: MachinePlaces::default(),
            program_numbers: Vec::new(),
            places_there: MachinePlaces::default(),
            rapid_will_do: false,
            codes,
            targets,
            words,
            system,
            states,
            aliases,
            start: Vec::new(),
            behaviours,
        }
    }

    /// The same machine with other rows: all that its profile says stays.
    pub(super) fn with_rows(self, dialect: Dialect) -> Self {
        let kept = (self.profile.clone(), self.settings.clone());
        let made = Self::index(self.entry, dialect, kept.0, kept.1, (Vec::new(), Standing::default()));
        let Self { dialect, codes, targets, words, system, states, aliases, behaviours, .. } = made;
        let owner = OnceLock::new();
        Self { owner, dialect, codes, targets, words, system, states, aliases, behaviours, ..self }
    }

    /// Short name of its dialect.
    pub fn name(&self) -> &str {
        &self.dialect.name
    }

    /// The dialect's entry in the registry.
    pub fn entry(&self) -> &'static Entry {
        self.entry
    }

    /// True where a program runs on both as it stands: one dialect, and machines whose profiles differ in nothing
    /// that a program could tell.
    pub fn is_same_machine(&self, other: &Control) -> bool {
        self.entry == other.entry
            && self.dialect == other.dialect
            && self.settings == other.settings
            && self.profile.units == other.profile.units
            && self.start == other.start
            && self.reserved == other.reserved
    }

    /// All facts, with the profile laid over them.
    pub fn dialect(&self) -> &Dialect {
        &self.dialect
    }

    /// The profile; an empty one where none was given.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The kind of machine; a mill where no profile says.
    pub fn machine(&self) -> Machine {
        self.profile.machine.unwrap_or(Machine::Mill)
    }

    /// The units in force where no code says so, if the profile knows.
    pub fn units(&self) -> Option<Units> {
        self.profile.units
    }

    /// How numbers are written and kept.
    pub fn numbers(&self) -> &Numbers {
        &self.dialect.numbers
    }

    /// Characters, comments, lengths.
    pub fn text(&self) -> &Text {
        &self.dialect.text
    }

    /// What a length without a decimal point counts.
    pub fn bare_length(&self) -> BareLength {
        self.dialect.numbers.bare_length
    }

    /// What a length or an angle without a decimal point counts after this letter.
    pub fn bare_length_of(&self, letter: char) -> BareLength {
        let numbers = &self.dialect.numbers;
        match numbers.bare_length {
            BareLength::Units if !numbers.calculator_reaches(letter) => BareLength::Increments,
            bare => bare,
        }
    }

    /// How many parts a scale factor of 1 has if it is written without a decimal point: 1000 for thousandths. None if that is not known.
    pub fn scale_parts(&self) -> Option<f64> {
        match self.behaviour(Question::ScaleBare)?.value.as_str() {
            "units" => Some(1.0),
            "thousandths" => Some(1e3),
            "hundred.thousandths" => Some(1e5),
            _ => None,
        }
    }

    /// What an argument of a macro call without a decimal point counts, for its letter.
    pub fn bare_argument(&self, letter: char) -> BareLength {
        let row = self.dialect.arguments.iter().find(|row| row.letter == letter);
        row.and_then(|row| row.bare).unwrap_or(self.dialect.numbers.bare_argument)
    }

    /// What a feed without a decimal point counts.
    pub fn bare_feed(&self) -> BareLength {
        self.dialect.numbers.bare_feed
    }

    /// True where the profile says how lengths without a point count, and that says nothing of feeds.
    pub fn feed_is_open(&self) -> bool {
        self.profile.decimal_point.is_some() && !self.dialect.numbers.feed_stated
    }

    /// A function, where the control has it with so many arguments.
    pub fn function(&self, function: Func, arguments: usize) -> Option<&Function> {
        self.dialect
            .functions
            .iter()
            .find(|row| row.function == function && row.arguments as usize == arguments)
    }

    /// A function by one of its spellings.
    pub fn function_named(&self, spelling: &str) -> Option<&Function> {
        let same = |name: &str| name.eq_ignore_ascii_case(spelling);
        self.dialect
            .functions
            .iter()
            .find(|row| same(&row.spelling) || row.aliases.iter().any(|name| same(name)))
    }

    /// The operator with a meaning (`add`, `and.bits`, `ge`), in the spelling that is written.
    pub fn operator(&self, meaning: &str) -> Option<&Operator> {
        self.dialect.operators.iter().find(|row| row.meaning == meaning)
    }

    /// A limit's largest value; none if the control has no such limit or none is known.
    pub fn limit(&self, name: &str) -> Option<u32> {
        self.limit_row(name)?.max
    }

    /// A limit with its alarm and its source.
    pub fn limit_row(&self, name: &str) -> Option<&Limit> {
        self.dialect.limits.iter().find(|row| row.name == name)
    }

    /// A statement, where the control has it.
    pub fn statement(&self, name: &str) -> Option<&Statement> {
        self.dialect.statements.iter().find(|row| row.name == name)
    }

    /// The answer to a question; none if the table is silent.
    pub fn behaviour(&self, question: Question) -> Option<&Behaviour> {
        self.dialect.behaviours.get((*self.behaviours.get(question as usize)?)?)
    }

    /// The answer to a question of a number; none if the table is silent.
    pub fn number(&self, question: Question) -> Option<f64> {
        self.behaviour(question)?.value.parse().ok()
    }

    /// True where the answer is `true`; a silent table and an unknown answer are no.
    pub fn is(&self, question: Question) -> bool {
        self.behaviour(question).is_some_and(|row| row.value == "true")
    }

    /// The question that says whether a block drills that names a cycle and has no word of an axis or a plane: its own, or where
    /// the table has none that of a block without a position.
    pub fn of_wordless_cycles(&self) -> Question {
        let own = Question::CycleRunsWithoutWords;
        if self.behaviour(own).is_some() { own } else { Question::CycleRunsWithoutAxes }
    }

    /// The class of a numbered variable.
    pub fn variable_class(&self, name: &str, number: u32) -> Option<&VariableClass> {
        self.classes()
            .iter()
            .find(|row| (row.first..=row.last).contains(&number) && row.name == name && row.class != "letter")
    }

    /// The class of a letter variable (`VX`).
    pub fn letter_class(&self, name: &str, letter: char) -> Option<&VariableClass> {
        let number = letter_number(letter)?;
        self.classes()
            .iter()
            .find(|row| (row.first..=row.last).contains(&number) && row.name == name && row.class == "letter")
    }

    /// All classes of variables, in order.
    pub fn classes(&self) -> &[VariableClass] {
        &self.dialect.variables
    }

    /// The row of a second number of a variable.
    pub fn same_cells(&self, name: &str, number: u32) -> Option<&SameCells> {
        let mut rows = self.dialect.same_cells.iter();
        rows.find(|row| (row.first..=row.last).contains(&number) && row.name == name)
    }

    /// The number of the cell that a number names: another one where the control numbers its variables twice.
    pub fn cell(&self, name: &str, number: u32) -> u32 {
        self.same_cells(name, number).map_or(number, |row| row.cell_of(number))
    }

    /// True for a free variable that most shops have put to use.
    pub fn is_in_use(&self, name: &str, number: u32) -> bool {
        let rows = &self.dialect.in_use;
        rows.iter().any(|row| row.name == name && (row.first..=row.last).contains(&number))
    }

    /// True where the profile says which variables the shop keeps for itself, be it none.
    pub fn states_reserved(&self) -> bool {
        !self.reserved.is_empty() || self.profile.places.contains_key("reserved")
    }

    /// True for a variable that the profile keeps for the shop.
    pub fn is_reserved(&self, name: &str, number: u32) -> bool {
        self.reserved.iter().any(|run| run.holds(name, number, false))
    }

    /// True for a letter variable that the profile keeps for the shop.
    pub fn is_reserved_letter(&self, name: &str, letter: char) -> bool {
        letter_number(letter)
            .is_some_and(|number| self.reserved.iter().any(|run| run.holds(name, number, true)))
    }

    /// The local variable that an argument letter sets (specification I).
    pub fn argument_local(&self, letter: char) -> Option<u32> {
        self.dialect.arguments.iter().find(|row| row.letter == letter).map(|row| row.local)
    }

    /// The argument letter that sets a local variable (specification I).
    pub fn argument_letter(&self, local: u32) -> Option<char> {
        self.dialect.arguments.iter().find(|row| row.local == local).map(|row| row.letter)
    }

    /// The value of a setting: the profile's, else the table's.
    pub fn setting(&self, name: &str) -> Option<&str> {
        self.settings.get(name).map(String::as_str)
    }

    /// The G code system that a lathe's programs are read by though no profile says it, with its setting; none where a profile
    /// does, or the control has one system only.
    pub fn open_code_system(&self) -> Option<(&str, &Setting)> {
        if self.machine() != Machine::Lathe || self.profile.settings.contains_key(CODE_SYSTEM) {
            return None;
        }
        let name = format!("setting.{CODE_SYSTEM}");
        Some((self.setting(&name)?, self.setting_row(&name)?))
    }

    /// The control after its operator has set it to the unit that its profile does not give. What lengths its settings hold then no
    /// source says (a number may stay, or be converted), so none is stated but 0.
    #[must_use]
    pub fn in_other_unit(&self) -> Control {
        let is_length = |row: &Setting| {
            let role = row.gives.or(row.otherwise);
            role.is_some_and(Role::is_length)
        };
        let mut other = self.clone();
        for row in self.dialect.settings.iter().filter(|row| is_length(row)) {
            let zero = other.settings.get(&row.name).is_some_and(|value| value.parse() == Ok(0.0));
            if !zero {
                other.settings.remove(&row.name);
            }
        }
        other
    }

    /// The row of a setting.
    pub fn setting_row(&self, name: &str) -> Option<&Setting> {
        self.dialect.settings.iter().find(|row| row.name == name)
    }

    /// True where the control has a setting that no profile states, and no table gives.
    pub fn leaves_open(&self, name: &str) -> bool {
        self.setting_row(name).is_some() && self.setting(name).is_none()
    }

    /// True where an option is there: the profile lists it. Where the profile
    /// lists no options, nobody knows, and the answer is none.
    pub fn has_option(&self, option: &str) -> Option<bool> {
        self.profile.options.as_ref().map(|bought| bought.iter().any(|name| name == option))
    }
}

fn letter_number(letter: char) -> Option<u32> {
    letter.is_ascii_uppercase().then(|| u32::from(letter) - u32::from('A') + 1)
}

/// `parameter.6050` as `parameter.` and 6050.
pub(super) fn numbered(name: &str) -> Option<(&str, u32)> {
    let at = name.rfind(|c: char| !c.is_ascii_digit()).map_or(0, |at| at + 1);
    let (stem, number) = name.split_at_checked(at)?;
    Some((stem, number.parse().ok()?))
}
