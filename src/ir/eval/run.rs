//! Runs IR programs: the oracle of passes and emulations that touch more than one expression.
//!
//! It records what a program does as lines of text. Modal calls and state that is not
//! given are refused, never guessed. Runs are bounded in steps.

use super::{Alarm, Env, Memory, Value, eval, holds, number, whole};
use crate::ir::{
    BlockId, Call, Callee, Class, Module, Nc, NcItem, OutputPart, Place, PrintPart, Program, SourceInfo,
    Stmt, StmtKind, TermKind, Var,
};
use crate::syntax::{Label, ProgramName};
use std::collections::{BTreeMap, VecDeque};

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The program ended.
    End,
    /// An evaluation stopped the machine.
    Alarm(Alarm),
    /// The program stopped the machine.
    Stopped,
    /// More steps than allowed.
    Steps,
    /// Something that is not run here.
    Unsupported(&'static str),
}

/// What a run did.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// What happened, in order.
    pub events: Vec<String>,
    /// How it ended.
    pub ending: Ending,
}

/// A call that is running.
struct Frame {
    program: usize,
    next: BlockId,
    /// Variables of the caller, which come back with the return.
    kept: BTreeMap<Var, Value>,
    /// Classes whose variables end with the call.
    ends: Vec<Class>,
    /// Runs still to come; the arguments are not loaded again.
    again: u32,
    entry: (usize, BlockId),
}

/// Runs a program of a module on a memory, which is left as the run leaves it. A main program that
/// returns ends, for all that it would start again.
pub fn run(module: &Module, program: usize, memory: &mut Memory, answers: &[f64], steps: usize) -> Trace {
    let mut runner = Runner {
        module,
        memory,
        answers: answers.iter().copied().collect(),
        events: Vec::new(),
        frames: Vec::new(),
        at: (program, BlockId(0)),
    };
    let ending = (0..steps).find_map(|_| runner.block().err()).unwrap_or(Ending::Steps);
    Trace { events: runner.events, ending }
}

struct Runner<'r> {
    module: &'r Module,
    memory: &'r mut Memory,
    answers: VecDeque<f64>,
    events: Vec<String>,
    frames: Vec<Frame>,
    at: (usize, BlockId),
}

/// Deeper calls are not run.
const FRAMES: usize = 64;

impl From<Alarm> for Ending {
    fn from(alarm: Alarm) -> Self {
        Ending::Alarm(alarm)
    }
}

impl Runner<'_> {
    fn block(&mut self) -> Result<(), Ending> {
        let module = self.module;
        let program = module.programs.get(self.at.0).ok_or(Ending::Unsupported("no such program"))?;
        let block = program.block(self.at.1).ok_or(Ending::Unsupported("no such block"))?;
        for Stmt { kind, site } in &block.stmts {
            if !self.is_skipped(site) {
                self.stmt(kind)?;
            }
        }
        match &block.term.kind {
            TermKind::Jump(to) => self.at.1 = *to,
            TermKind::Branch { cond, then, otherwise } => {
                self.at.1 = if holds(cond, &*self.memory)? { *then } else { *otherwise };
            }
            TermKind::Computed { value, targets } => {
                let label = whole(number(value, &*self.memory)?);
                let found = targets.iter().find(|(number, _)| Some(*number) == label);
                self.at.1 = found.ok_or(Ending::Alarm(Alarm::Variable))?.1;
            }
            TermKind::Call { call, next } => self.call(call, *next)?,
            TermKind::Return { to } => {
                let label = to.as_ref().map(|to| number(to, &*self.memory)).transpose()?;
                self.leave(label)?;
            }
            TermKind::Chain(name) => self.at = (self.find(name)?, BlockId(0)),
            TermKind::End { .. } | TermKind::Stray => return Err(Ending::End),
        }
        Ok(())
    }

    fn is_skipped(&self, site: &SourceInfo) -> bool {
        site.skip.is_some_and(|level| self.memory.switch(level))
    }

    fn stmt(&mut self, kind: &StmtKind) -> Result<(), Ending> {
        match kind {
            StmtKind::Comment | StmtKind::Sync | StmtKind::SetNames { .. } | StmtKind::LimitLookahead(_) => {}
            StmtKind::Assign { target, value } => {
                let value = eval(value, &*self.memory)?;
                self.write(target, value)?;
            }
            StmtKind::ClearAll(class) => {
                let all = self.memory.vars.iter_mut().filter(|(var, _)| var.class == *class);
                all.for_each(|(_, value)| *value = Some(0.0));
            }
            StmtKind::Nc(nc) => self.nc(nc)?,
            StmtKind::Alarm { number: code, text } => {
                let code = number(code, &*self.memory)?;
                self.events.push(format!("alarm {code} {text}"));
                return Err(Ending::Stopped);
            }
            StmtKind::StopMessage { number: code, text } => {
                let code = number(code, &*self.memory)?;
                self.events.push(format!("stop {code} {text}"));
            }
            StmtKind::Output(parts) => {
                let mut line = "output".to_owned();
                for part in parts {
                    line += &match part {
                        OutputPart::Text(text) => format!(" {text}"),
                        OutputPart::Value { value, whole, fraction } => {
                            format!(" {}[{whole}{fraction}]", number(value, &*self.memory)?)
                        }
                    };
                }
                self.events.push(line);
            }
            StmtKind::Print { serial, parts, stay } => {
                let mut line = if *serial { "print serial" } else { "print" }.to_owned();
                for part in parts {
                    line += &match part {
                        PrintPart::Text(text) => format!(" {text}"),
                        PrintPart::Value(value) => format!(" {}", number(value, &*self.memory)?),
                    };
                }
                self.events.push(if *stay { line + " .." } else { line });
            }
            StmtKind::OpenPort => self.events.push("port.open".into()),
            StmtKind::ClosePort => self.events.push("port.close".into()),
            StmtKind::Input { target, .. } => {
                let answer = self.answers.pop_front().ok_or(Ending::Unsupported("no answer is left"))?;
                self.write(target, Some(answer))?;
            }
            StmtKind::ModalCall(_) | StmtKind::ModalCallOff => return Err(Ending::Unsupported("modal call")),
        }
        Ok(())
    }

    fn nc(&mut self, nc: &Nc) -> Result<(), Ending> {
        let mut line = "nc".to_owned();
        for item in &nc.items {
            let (name, value) = match item {
                NcItem::Op(op) => {
                    line += &format!(" {op}");
                    continue;
                }
                NcItem::Word(role, value) => (role.name().to_owned(), value),
                NcItem::Code(letter, value) => (letter.to_string(), value),
            };
            // A vacant word is as if it were not written.
            if let Some(value) = eval(value, &*self.memory)? {
                line += &format!(" {name}={value}");
            }
        }
        self.events.push(line);
        Ok(())
    }

    fn write(&mut self, target: &Place, value: Value) -> Result<(), Ending> {
        let var = match target {
            Place::Var(var) => *var,
            Place::Indirect(bank, index) => {
                let index = whole(number(index, &*self.memory)?).ok_or(Alarm::Variable)?;
                Memory::numbered(*bank, index)?
            }
            Place::System(state, subscripts) => {
                let all: Result<Vec<f64>, Alarm> =
                    subscripts.iter().map(|s| number(s, &*self.memory)).collect();
                let key = Memory::key(*state, &all?);
                self.events.push(format!("{state} {:?} = {}", key.1, value.unwrap_or(0.0)));
                self.memory.state.insert(key, value);
                return Ok(());
            }
        };
        self.memory.set(var, value);
        Ok(())
    }

    fn call(&mut self, call: &Call, next: BlockId) -> Result<(), Ending> {
        let count = call.count.as_ref().map(|count| number(count, &*self.memory)).transpose()?;
        let count = whole(count.unwrap_or(1.0)).ok_or(Ending::Unsupported("count"))?;
        let entry = match &call.callee {
            Callee::Program(name) => (self.find(name)?, BlockId(0)),
            Callee::Block(entry) => (self.at.0, *entry),
            Callee::Computed(value) => {
                let code =
                    whole(number(value, &*self.memory)?).ok_or(Ending::Unsupported("program number"))?;
                (self.find(&ProgramName::Number(code))?, BlockId(0))
            }
            Callee::Cycle(_) => return Err(Ending::Unsupported("cycle")),
        };
        let mut arguments = Vec::new();
        for argument in &call.arguments {
            let var = Var { class: Class::Local, number: argument.local };
            arguments.push((var, eval(&argument.value, &*self.memory)?));
        }
        if count == 0 {
            self.at.1 = next;
            return Ok(());
        }
        if self.frames.len() >= FRAMES {
            return Err(Ending::Unsupported("calls nest too deep"));
        }
        let body = matches!(call.callee, Callee::Block(_));
        let classes = [(call.level, Class::Local), (!body, Class::Temp)];
        let ends: Vec<Class> =
            classes.into_iter().filter(|(ends, _)| *ends).map(|(_, class)| class).collect();
        let own = |var: &Var| ends.contains(&var.class);
        let kept: BTreeMap<Var, Value> =
            self.memory.vars.iter().filter(|(var, _)| own(var)).map(|(var, value)| (*var, *value)).collect();
        self.memory.vars.retain(|var, _| !own(var));
        arguments.into_iter().for_each(|(var, value)| self.memory.set(var, value));
        self.frames.push(Frame { program: self.at.0, next, kept, ends, again: count - 1, entry });
        self.at = entry;
        Ok(())
    }

    fn leave(&mut self, label: Option<f64>) -> Result<(), Ending> {
        let Some(mut frame) = self.frames.pop() else { return Err(Ending::End) };
        if label.is_none() && frame.again > 0 {
            frame.again -= 1;
            self.at = frame.entry;
            self.frames.push(frame);
            return Ok(());
        }
        self.memory.vars.retain(|var, _| !frame.ends.contains(&var.class));
        self.memory.vars.extend(std::mem::take(&mut frame.kept));
        self.at = (frame.program, frame.next);
        if let Some(label) = label {
            let found = self.module.programs.get(frame.program).and_then(|p| labelled(p, whole(label)?));
            self.at.1 = found.ok_or(Ending::Alarm(Alarm::Variable))?;
        }
        Ok(())
    }

    fn find(&self, name: &ProgramName) -> Result<usize, Ending> {
        let found = self.module.programs.iter().position(|program| program.name.as_ref() == Some(name));
        found.ok_or(Ending::Unsupported("no such program"))
    }
}

fn labelled(program: &Program, label: u32) -> Option<BlockId> {
    program
        .ids()
        .zip(&program.blocks)
        .find(|(_, b)| b.labels.contains(&Label::Number(label)))
        .map(|(id, _)| id)
}
