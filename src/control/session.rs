//! A run in the making: what an interpreter keeps besides its own variables.

use super::fewer::FewerDigits;
use super::library::{Heard, Library, LoadedFile, ProgramRef, Sections};
use super::machine::{GIVEN, Machine};
use super::outcome::{Branches, End, Run, Stop};
use super::scenario::Scenario;
use super::trace::{EventKind, Place, Program, Trace};
use super::words::Increments;
use crate::canon::{Op, Pause};
use crate::diag::Severity;
use crate::dialect::{Control, Question};
use crate::syntax::{Block, ItemKind, ProgramName};
use crate::text::Span;
use std::collections::{BTreeMap, HashMap};
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

/// How many blocks pass between two looks at the clock, and before a listener is told of them.
const CLOCK_EVERY: u64 = 1024;

/// Why a run comes to its end.
#[derive(Clone, Debug, PartialEq)]
pub enum Halt {
    /// By an end code, or after the last block.
    Ended(Op),
    /// An alarm.
    Alarm(Stop),
    /// So many blocks were run as the scenario allows.
    Steps,
    /// So much time passed as the scenario allows.
    Time,
    /// What the program asks for is not there.
    Error(String),
}

impl From<Stop> for Halt {
    fn from(stop: Stop) -> Self {
        Halt::Alarm(stop)
    }
}

/// What a step of an interpreter gives, unless the run ends in it.
pub type Flow<T> = Result<T, Halt>;

/// The state that all interpreters have in common.
#[derive(Debug)]
pub struct Session<'r, 'f> {
    /// The control.
    pub control: &'r Control,
    /// What the program meets.
    pub scenario: &'r Scenario,
    /// The files.
    pub files: &'r [LoadedFile<'f>],
    /// The programs in them.
    pub sections: &'r Sections,
    library: &'r Library<'f>,
    /// The machine.
    pub machine: Machine,
    /// What happened so far.
    pub trace: Trace,
    /// The ways taken so far.
    pub branches: Branches,
    digits: FewerDigits,
    programs: Vec<Program>,
    numbers: HashMap<usize, u32>,
    /// The section that was asked for last, and its number.
    last_number: Option<(usize, u32)>,
    answered: usize,
    steps: u64,
    deadline: Option<Instant>,
    listener: Option<&'r SyncSender<Heard>>,
    /// How many programs the listener knows.
    heard: usize,
}

impl<'r, 'f> Session<'r, 'f> {
    /// A run that has not begun.
    pub fn new(library: &'r Library<'f>, control: &'r Control, scenario: &'r Scenario) -> Self {
        let deadline =
            scenario.milliseconds.and_then(|ms| Instant::now().checked_add(Duration::from_millis(ms)));
        let machine = Machine::new(library.rules(control), control, scenario);
        let mut trace = Trace::new(scenario.events, &control.tried());
        machine.tell_entry(&scenario.entry, &mut trace);
        trace.nearness = scenario.nearness.then(Box::default);
        Self {
            control,
            scenario,
            files: library.files,
            library,
            sections: &library.sections,
            machine,
            trace,
            branches: Branches::default(),
            digits: FewerDigits::of(scenario, None),
            programs: Vec::new(),
            numbers: HashMap::new(),
            last_number: None,
            answered: 0,
            steps: 0,
            deadline,
            listener: library.listener,
            heard: 0,
        }
    }

    /// The section of a program; an error where the library has none there.
    pub fn section_of(&self, program: ProgramRef) -> Flow<usize> {
        self.sections.place(program).ok_or_else(|| Halt::Error("there is no such program".into()))
    }

    /// A block of a section, counted from the section's start; none after its end.
    pub fn block(&self, section: usize, index: usize) -> Option<&'r Block> {
        self.library.blocks(section).get(index)
    }

    /// How many blocks a section has.
    pub fn length(&self, section: usize) -> usize {
        self.sections.all().get(section).map_or(0, |section| section.blocks.len())
    }

    /// The library.
    pub fn library(&self) -> &'r Library<'f> {
        self.library
    }

    /// The bytes of the file that holds a section.
    pub fn source(&self, section: usize) -> &'r [u8] {
        self.library.source(section)
    }

    /// The number that places give a section; it is listed from its first block on.
    pub fn program_number(&mut self, section: usize) -> u32 {
        if let Some((last, number)) = self.last_number
            && last == section
        {
            return number;
        }
        let number = self.numbers.get(&section).copied().unwrap_or_else(|| self.list(section));
        self.last_number = Some((section, number));
        number
    }

    /// Lists a section that did not run before.
    fn list(&mut self, section: usize) -> u32 {
        let found = self.sections.all().get(section);
        let name = match found.and_then(|section| section.name.as_ref()) {
            Some(ProgramName::Number(number)) => format!("O{number}"),
            Some(ProgramName::Name(name)) => name.clone(),
            None => String::new(),
        };
        let file = found.map_or(0, |section| section.file);
        let number = self.programs.len() as u32;
        let modes = self.modes();
        let entry = self.machine.in_force(self.trace.open);
        self.programs.push(Program { file, name, modes, entry });
        self.numbers.insert(section, number);
        number
    }

    /// Notes that a program was entered, with locals of its own or its caller's.
    pub fn enter(&mut self, program: u32, level: bool) {
        let now = self.machine.in_force(self.trace.open);
        if let Some(entered) = self.programs.get_mut(program as usize) {
            entered.entry.keep_common(&now);
        }
        self.trace.push(EventKind::Enter { program, level });
    }

    /// What is in force now of what a called program finds as its caller left it.
    fn modes(&self) -> Vec<Op> {
        GIVEN.iter().filter_map(|group| self.machine.modal(*group)).collect()
    }

    /// The name of the first program that ran: `O1234`, or nothing.
    pub fn main_name(&self) -> &str {
        self.programs.first().map_or("", |program| program.name.as_str())
    }

    /// Counts a block that is about to run, and makes it the one that events belong to.
    pub fn enter_block(&mut self, section: usize, span: Span) -> Flow<()> {
        let program = self.program_number(section);
        self.trace.at = Place { program, span };
        self.count()
    }

    /// Counts one more piece of work.
    pub fn count(&mut self) -> Flow<()> {
        if self.steps >= self.scenario.steps || self.trace.is_full() {
            return Err(Halt::Steps);
        }
        self.steps += 1;
        if self.steps.is_multiple_of(CLOCK_EVERY) { self.now_and_then() } else { Ok(()) }
    }

    /// What is done between blocks from time to time: looks at the clock, and tells the listener.
    fn now_and_then(&mut self) -> Flow<()> {
        let now = Instant::now();
        let late = self.deadline.is_some_and(|deadline| now > deadline);
        if let Some(listener) = self.listener {
            let programs = self.programs.get(self.heard..).unwrap_or_default().to_vec();
            self.heard = self.programs.len();
            // One who is gone hears nothing more; the run goes on.
            let _ = listener.send(Heard { events: self.trace.take(), programs });
            // A reader who takes his time takes none of the run's.
            self.deadline = self.deadline.and_then(|deadline| deadline.checked_add(now.elapsed()));
        }
        if late { Err(Halt::Time) } else { Ok(()) }
    }

    /// Refuses a block that the control could not read either.
    pub fn refuse_faulty(&self, block: &Block) -> Flow<()> {
        let wrong = block.errors.iter().find(|error| error.code.severity() == Severity::Error);
        if let Some(error) = wrong {
            return Err(Halt::Error(error.message.clone()));
        }
        match block.items.iter().any(|item| matches!(item.kind, ItemKind::Unparsed)) {
            true => Err(Halt::Error("the block cannot be read".into())),
            false => Ok(()),
        }
    }

    /// True where the switch of a block skip is on.
    pub fn skips(&self, number: Option<u8>) -> bool {
        let bit = u32::from(number.unwrap_or(1));
        self.scenario.block_skip.checked_shr(bit).is_some_and(|bits| bits & 1 == 1)
    }

    /// True while the operator still has an answer.
    pub fn has_answer(&self) -> bool {
        self.answered < self.scenario.answers.len()
    }

    /// The operator's next answer.
    pub fn answer(&mut self) -> f64 {
        let answer = self.scenario.answers.get(self.answered).copied().unwrap_or(0.0);
        self.answered += 1;
        self.pause(Pause::Message, EventKind::Asked { answer });
        answer
    }

    /// The operator's next answer at a code of the builder that asks: it ends nothing that runs.
    pub fn answer_at_code(&mut self) -> f64 {
        let answer = self.scenario.answers.get(self.answered).copied().unwrap_or(0.0);
        self.answered += 1;
        self.trace.push(EventKind::Asked { answer });
        answer
    }

    /// A result of arithmetic, with the digits that the scenario leaves it.
    pub fn kept(&self, value: f64) -> f64 {
        self.digits.keep(value)
    }

    /// The least increments that computed words are rounded to where the scenario has it so and no source says whether
    /// they are, in the units in force.
    pub fn unstated_increments(&self) -> Option<Increments> {
        let stated = self.control.behaviour(Question::WordRoundsToIncrement);
        let known = stated.map_or("unknown", |row| row.value.as_str());
        // What a machine profile states, the emulated control does.
        let told =
            known == "true" && self.control.profile().behaviours.contains_key("word.rounds.to.increment");
        if !told && (!self.scenario.rounds_words || known != "unknown") {
            return None;
        }
        let numbers = self.control.numbers();
        let length = if self.machine.is_inch() { numbers.increment_inch } else { numbers.increment_mm };
        Some(Increments { length, degrees: numbers.increment_degrees })
    }

    /// Stops the program: what the control ends then is ended first.
    pub fn pause(&mut self, pause: Pause, what: EventKind) {
        self.machine.pause(pause, what, &mut self.trace);
    }

    /// Notes an answer to a question of behaviour that mattered, if nobody confirmed it.
    pub fn rest_on(&mut self, question: Question) {
        match self.control.behaviour(question) {
            Some(row) if row.origin.is_settled() => {}
            _ => self.trace.doubt(question.fact()),
        }
    }

    /// Notes that the control acts in the one way that it has here, if nobody confirmed that the machine does so
    /// too, or where somebody says that it does otherwise.
    pub fn act_as(&mut self, question: Question, answer: &str) {
        let as_here = |value: &str| value == answer || value == "unknown";
        match self.control.behaviour(question) {
            Some(row) if row.origin.is_settled() && as_here(&row.value) => {}
            _ => self.trace.doubt(question.fact()),
        }
    }

    /// The halt of a jump to a label or number that no block has, on a control of which no source says that it is an
    /// alarm.
    pub fn no_label(&mut self, text: &str) -> Halt {
        self.act_as(Question::GotoMissingAlarms, "true");
        Halt::Alarm(Stop::no_label("", text))
    }

    /// Notes that a variable which outlives the program was written, where the scenario asks for it.
    pub fn wrote(&mut self, name: impl FnOnce() -> String, value: Option<f64>) {
        if self.scenario.variable_events {
            self.trace.push(EventKind::Variable { name: name(), value });
        }
    }

    /// The way that a branching block takes.
    pub fn branch(&mut self, way: i64) {
        self.branches.took(self.trace.at, way);
        self.trace.branched(self.trace.at, way != 0);
    }

    /// The words that an earlier program left in force, in the units of the program: the letters that all controls have.
    pub fn words_in_force(&self) -> Vec<(char, f64)> {
        let entry = &self.scenario.entry;
        let feed = entry.feed.map(|_| ('F', self.machine.feed()));
        let speed = entry.spindle.map(|speed| ('S', speed));
        feed.into_iter().chain(speed).collect()
    }

    /// The finished run.
    pub fn finish(mut self, halt: Halt, variables: BTreeMap<String, f64>) -> Run {
        let at = self.trace.at;
        let modes = self.modes();
        if let Halt::Ended(by) = halt {
            self.machine.end_local(by);
        }
        let left = matches!(halt, Halt::Ended(_)).then(|| self.machine.left());
        let end = match halt {
            Halt::Ended(by) => {
                self.machine.end(by, &mut self.trace);
                End::Ended
            }
            Halt::Alarm(stop) => {
                self.trace.alarm(&stop);
                End::Alarm { at, stop }
            }
            Halt::Steps => End::StepBudget,
            Halt::Time => End::TimeBudget,
            Halt::Error(text) => End::Error { at, text },
        };
        Run {
            computed_codes: self.trace.computed_codes(),
            computed_numbers: self.trace.computed_numbers(),
            arguments: self.trace.arguments(),
            zeros: std::mem::take(&mut self.trace.zeros),
            nearest: self.trace.nearness.take().map(|nearness| nearness.end()).unwrap_or_default(),
            events: self.trace.into_events(),
            programs: self.programs,
            variables,
            end,
            steps: self.steps,
            branches: self.branches,
            lacked_digits: self.digits.lacked(),
            modes,
            left,
        }
    }
}
