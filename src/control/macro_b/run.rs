//! Runs programs, block by block.

use super::calls::{Frame, ModalCall};
use super::code::{At, Block, Goto, Program, Step};
use super::commands::place_of;
use super::compile::Compiler;
use super::memory::{Locals, Memory};
use super::numeric::{Answers, Numeric};
use super::rules::Rules;
use super::{Style, meaning};
use crate::canon::{Op, Pause, Role};
use crate::control::kept::{Kept, with_kept};
use crate::control::library::{Library, ProgramRef};
use crate::control::machine::{Command, Contour};
use crate::control::outcome::{Run, Stop};
use crate::control::scenario::Scenario;
use crate::control::session::{Halt, Session};
use crate::control::trace::{EventKind, Place};
use crate::dialect::{CodeMeaning, CodePlace, Control};
use crate::text::variable_to_set;
use std::collections::{HashMap, VecDeque};
use std::rc::Rc;
use std::sync::LazyLock;

/// A program and its number among those that ran.
#[derive(Clone, Copy)]
pub struct Loaded<'c> {
    pub code: &'c Program,
    pub number: u32,
    section: usize,
    /// The first of its branches and of its blocks among those of all programs that ran.
    branches: usize,
    blocks: usize,
}

/// Where the run goes on.
pub enum Next {
    /// With the next step of the block.
    On,
    /// With the next block.
    Block,
    /// With this block.
    At(usize),
}

/// A control that runs.
pub struct Runner<'c> {
    pub session: Session<'c, 'c>,
    pub style: &'static Style,
    pub rules: &'c Rules,
    pub numeric: Numeric<'c>,
    kept: Kept<'c, Made, Program>,
    loaded: HashMap<usize, Loaded<'c>>,
    /// Parts of programs that are not held, with their sections; the one that was used last comes last.
    pub made: VecDeque<(usize, usize, Rc<[Block]>)>,
    /// Where the branches of the programs stand, and the ways each went: bit 0 for false, bit 1 for true.
    pub branches: Vec<Place>,
    ways: Vec<u8>,
    /// The blocks whose facts are in the trace, by number among those of all programs that ran.
    told: Vec<bool>,
    pub memory: Memory,
    pub frames: Vec<Frame<'c>>,
    pub modal_calls: Vec<ModalCall>,
    /// Calls so far of programs that stand in the machine.
    pub calls_outside: u64,
    /// The command in the making, kept to be used again.
    pub command: Command,
    /// Codes of the modal groups as this control numbers them.
    pub modal: [f64; 32],
    /// Last values of addresses, A at 1.
    pub addresses: [f64; 27],
    /// The row of the drilling cycle in force, of a pass, or of a straight feed that has words of its own.
    pub cycle: Option<&'c CodeMeaning>,
    /// The contour that is being read.
    pub contour: Option<Contour>,
    /// True while the port for output is open.
    pub port_open: bool,
    /// By how much the value of the last expression may be off.
    pub off: f64,
}

/// Runs a program of a library.
pub fn execute(
    style: &'static Style,
    library: &Library<'_>,
    main: ProgramRef,
    control: &Control,
    scenario: &Scenario,
) -> Run {
    let made = || Made { rules: Rules::new(control), answers: Answers::new(control, &style.alarms) };
    with_kept(library, control, made, |kept| {
        let mut runner = Runner::new(style, library, kept, control, scenario);
        let halt = match runner.session.section_of(main) {
            Ok(section) => runner.run(section),
            Err(halt) => halt,
        };
        runner.finish(halt)
    })
}

/// What is read of a control's table for all runs.
struct Made {
    rules: Rules,
    answers: Answers,
}

/// What a section without a file is.
static EMPTY: LazyLock<Program> = LazyLock::new(Program::default);

impl<'c> Runner<'c> {
    fn new(
        style: &'static Style,
        library: &'c Library<'c>,
        kept: Kept<'c, Made, Program>,
        control: &'c Control,
        scenario: &'c Scenario,
    ) -> Self {
        let mut runner = Self {
            session: Session::new(library, control, scenario),
            style,
            rules: &kept.rules.rules,
            numeric: Numeric::new(&kept.rules.answers, scenario),
            kept,
            loaded: HashMap::new(),
            made: VecDeque::new(),
            branches: Vec::new(),
            ways: Vec::new(),
            told: Vec::new(),
            memory: Memory::new(&scenario.variables),
            frames: Vec::new(),
            modal_calls: Vec::new(),
            calls_outside: 0,
            command: Command::default(),
            modal: [0.0; 32],
            addresses: [0.0; 27],
            cycle: None,
            contour: None,
            port_open: false,
            off: 0.0,
        };
        // The program before this one called for the tool that is in the spindle.
        runner.addresses[20] = f64::from(scenario.tool);
        runner.show_modes(crate::canon::Group::ALL);
        runner.start_words();
        runner
    }

    fn run(&mut self, main: usize) -> Halt {
        let program = self.load(main);
        self.frames.push(Frame::main(program));
        loop {
            if let Err(halt) = self.block() {
                return halt;
            }
        }
    }

    /// The prepared program of a section.
    pub fn load(&mut self, section: usize) -> Loaded<'c> {
        if let Some(loaded) = self.loaded.get(&section) {
            return *loaded;
        }
        let number = self.session.program_number(section);
        let (control, style) = (self.session.control, self.style);
        let (library, source) = (self.session.library(), self.session.source(section));
        let code = self.kept.program(section, self.session.length(section), || {
            Compiler::new(control, style, source).program(library, section)
        });
        let code = code.unwrap_or(&EMPTY);
        let loaded = Loaded { code, number, section, branches: self.branches.len(), blocks: self.told.len() };
        self.branches.extend(code.branches.iter().map(|span| Place { program: number, span: *span }));
        self.ways.resize(self.branches.len(), 0);
        self.told.resize(loaded.blocks + code.count, false);
        self.loaded.insert(section, loaded);
        loaded
    }

    /// The number of a branch of the running program among those of all programs.
    pub fn branch_at(&self, branch: usize) -> usize {
        self.frames.last().map_or(0, |frame| frame.program.branches) + branch
    }

    /// The section of the running program.
    pub fn section(&self) -> usize {
        self.frames.last().map_or(0, |frame| frame.program.section)
    }

    /// The row of a code.
    pub fn row(&self, place: Option<CodePlace>) -> Option<&'c CodeMeaning> {
        self.session.control.code_at(place?)
    }

    /// Executes one block and goes to the next.
    fn block(&mut self) -> Result<(), Halt> {
        let Some(frame) = self.frames.last() else { return Err(Halt::Ended(Op::End)) };
        let (Loaded { code, number, section, blocks, .. }, at) = (frame.program, frame.at);
        let made;
        let block = match code.find(at) {
            Some(At::Held(block)) => Some(block),
            Some(At::Made(part, place)) => {
                made = self.part(section, code, part);
                made.get(place)
            }
            None => None,
        };
        let Some(block) = block else {
            return self.runs_out();
        };
        self.session.trace.at = Place { program: number, span: block.span };
        self.session.count()?;
        if let Some(sequence) = block.sequence {
            self.addresses[14] = f64::from(sequence);
        }
        if self.told.get_mut(blocks + at).is_some_and(|told| !std::mem::replace(told, true)) {
            block.facts.iter().for_each(|fact| self.session.trace.doubt(fact));
        }
        let next = self.steps_of(&block.steps, at)?;
        if let Next::At(place) = next {
            self.go(place);
        } else if let Some(frame) = self.frames.last_mut().filter(|_| matches!(next, Next::On)) {
            frame.at = at + 1;
        }
        Ok(())
    }

    /// Executes steps. [`Next::On`] where all are done, [`Next::Block`] where the frame knows where to go on.
    fn steps_of(&mut self, steps: &[Step], at: usize) -> Result<Next, Halt> {
        for step in steps {
            match step {
                Step::Assign { target, value } => {
                    let value = self.eval(value)?;
                    self.write(target, value, self.off)?;
                }
                Step::If { condition, branch, body } => {
                    let holds = self.holds(condition, *branch)?;
                    if holds {
                        match self.steps_of(body, at)? {
                            Next::On => {}
                            other => return Ok(other),
                        }
                    }
                }
                Step::While { condition, tail } => {
                    let holds = match condition {
                        Some((condition, branch)) => self.holds(condition, *branch)?,
                        None => true,
                    };
                    if !holds {
                        return Ok(Next::At(tail + 1));
                    }
                }
                Step::Repeat { head } => return Ok(Next::At(*head)),
                Step::Goto { target, branch } => {
                    let number = match target {
                        Goto::Number(number) => *number,
                        Goto::Computed(value) => self.jump_target(value, *branch)?,
                    };
                    return self.jump(number, at).map(Next::At);
                }
                Step::Words(words) => match self.words(words)? {
                    Next::On => {}
                    other => return Ok(other),
                },
                Step::Signal { alarm, value, text } => {
                    let value = self.eval(value)?.unwrap_or(0.0);
                    self.signal(*alarm, value, text)?;
                }
                Step::Skip { level, before } => {
                    if self.session.skips(Some(*level)) {
                        return self.steps_of(before, at);
                    }
                }
                Step::Names { first, names } => {
                    for (number, name) in (*first..).zip(names) {
                        self.memory.names.insert(name.clone(), number);
                    }
                }
                Step::Port { open } => self.port_open = *open,
                Step::Output { binary, parts } => self.output(*binary, parts)?,
                Step::Alarm(stop) => return Err(Halt::Alarm(stop.clone())),
                Step::Unreadable(text) => return Err(Halt::Error(text.clone())),
            }
        }
        Ok(Next::On)
    }

    /// A condition, and the way it went.
    fn holds(&mut self, condition: &super::code::Ex, branch: usize) -> Result<bool, Halt> {
        let value = self.eval(condition)?.unwrap_or(0.0);
        if let Some(short) = self.numeric.short {
            short.truth(value, self.off, &mut self.session.trace);
        }
        let holds = value != 0.0;
        let branch = self.branch_at(branch);
        if let Some(ways) = self.ways.get_mut(branch) {
            *ways |= if holds { 2 } else { 1 };
        }
        if let Some(place) = self.branches.get(branch) {
            self.session.trace.branched(*place, holds);
        }
        Ok(holds)
    }

    fn signal(&mut self, alarm: bool, value: f64, text: &str) -> Result<(), Halt> {
        if !alarm {
            self.session.pause(Pause::Message, EventKind::Message { text: text.into() });
            self.answer_in(text);
            return Ok(());
        }
        let number = format!("{}", self.rules.alarm_offset + value);
        Err(Halt::Alarm(Stop { program_number: Some(value), ..Stop::alarm(&number, text) }))
    }

    /// An operator who reads the name of a variable in a message enters the next answer into it.
    pub(super) fn answer_in(&mut self, text: &str) {
        if !self.session.has_answer() {
            return;
        }
        if let Some(name) = variable_to_set(text, &["#"]) {
            let answer = self.session.answer();
            self.memory.put(name.number, answer);
        }
    }

    /// After the last block of a program.
    fn runs_out(&mut self) -> Result<(), Halt> {
        if self.session.machine.waits() {
            return Err(self.lathe_stop(self.session.machine.waits_in_vain()));
        }
        if self.frames.len() <= 1 {
            return Err(Halt::Ended(Op::End));
        }
        self.session.trace.doubt("machine:program.runs.out");
        self.give_back(None)
    }

    fn finish(mut self, halt: Halt) -> Run {
        for (place, ways) in self.branches.iter().zip(&self.ways) {
            for way in [0, 1] {
                if ways & (1 << way) != 0 {
                    self.session.branches.took(*place, way);
                }
            }
        }
        let lacked_digits = self.numeric.lacked_digits();
        Run { lacked_digits, ..self.session.finish(halt, self.memory.dump()) }
    }

    /// Locals of the running level.
    pub fn locals(&self) -> Locals {
        self.memory.levels.last().copied().unwrap_or_default()
    }

    /// Takes the codes in force of these groups from the machine.
    pub fn show_modes(&mut self, groups: &[crate::canon::Group]) {
        for group in groups {
            let (Some(number), Some(op)) = (group.number(), self.session.machine.modal(*group)) else {
                continue;
            };
            let mut operands = std::collections::BTreeMap::new();
            if op == Op::SelectWork {
                operands.insert(Role::WorkOffset, f64::from(self.session.machine.work_offset()));
            }
            let head = self.session.control.code_for(op, &operands).and_then(CodeMeaning::head);
            if let (Some(head), Some(place)) = (head, self.modal.get_mut(number as usize)) {
                *place = head.number();
            }
        }
    }

    /// The words and the drilling cycle that an earlier program left in force.
    fn start_words(&mut self) {
        self.found_words();
        let entry = &self.session.scenario.entry;
        let offsets = [('H', entry.length), ('D', entry.cutter)];
        let offsets = offsets.into_iter().filter_map(|(letter, number)| Some((letter, f64::from(number?))));
        for (letter, value) in self.session.words_in_force().into_iter().chain(offsets) {
            if let Some(address) = self.addresses.get_mut(place_of(letter)) {
                *address = value;
            }
        }
        let cycle = self.session.machine.cycle();
        let straight = Some(self.session.machine.motion()).filter(|op| *op == Op::Linear);
        let row = cycle.or(straight).and_then(|op| self.session.control.code_for(op, &Default::default()));
        self.cycle = row.filter(|row| row.op != Op::Linear || !row.words.is_empty());
    }

    /// The meaning of words whose codes are computed or of which some are dropped.
    pub fn meaning_now(
        &self,
        words: &[super::code::Word],
        there: &[bool],
        values: &[Option<f64>],
    ) -> super::code::Meaning {
        meaning::of(self.session.control, self.style, words, there, values)
    }
}
