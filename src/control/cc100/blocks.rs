//! Blocks: statements from left to right, then the words, then jumps and calls.

use super::store::Cell;
use super::{Interpreter, Next};
use crate::canon::{Op, Pause, Role};
use crate::control::outcome::Stop;
use crate::control::session::{Flow, Halt};
use crate::control::trace::EventKind;
use crate::control::words::{self, Read, Spoken};
use crate::dialect::Question;
use crate::syntax::{Block, ExprKind, ItemKind};
use crate::text::{decode, variable_to_set};
use smallvec::SmallVec;

/// G800: cycle nn has the code G8nn.
const CYCLES: f64 = 800.0;

/// True for a cycle with a wait at the bottom.
fn waits(op: Op) -> bool {
    matches!(op, Op::CycleDrillDwell | Op::CycleBoreDwell)
}

impl<'r> Interpreter<'r, '_> {
    /// Runs a block.
    pub(super) fn run(&mut self, block: &'r Block) -> Flow<Next> {
        let mut words: SmallVec<[Spoken; 12]> = SmallVec::new();
        for (at, item) in block.items.iter().enumerate() {
            match &item.kind {
                ItemKind::Word(word) => {
                    let Some(expr) = &word.value else { continue };
                    let computed = !matches!(expr.kind, ExprKind::Number(_));
                    let value = self.operand(expr)?;
                    self.last.insert(word.letter, value);
                    words.push(Spoken { letter: word.letter, value, computed });
                }
                ItemKind::Skip(number) => {
                    if let Some(row) = self.session.control.statement("block.skip") {
                        self.session.trace.rest_on(row);
                    }
                    if self.session.skips(*number) {
                        return Ok(Next::On);
                    }
                }
                ItemKind::Label(_)
                | ItemKind::Comment(_)
                | ItemKind::Sequence { .. }
                | ItemKind::EndOfBlock => {}
                other => {
                    self.stood = None;
                    if self.statement(other)? {
                        if at + 1 < block.items.len() {
                            self.session.trace.doubt("machine:block.behind.branch");
                        }
                        return Ok(Next::On);
                    }
                }
            }
        }
        if words.is_empty() { Ok(Next::On) } else { self.words(block, &words) }
    }

    fn words(&mut self, block: &'r Block, words: &[Spoken]) -> Flow<Next> {
        let session = &mut self.session;
        if session.machine.cycle().is_none() {
            self.lasting.cycle = None;
        }
        let mut read = words::read(session, words, &mut self.lasting)?;
        self.cycle(&mut read);
        // Its variable says how long it waits, though no word does.
        read.command.without_dwell &= !self.lasting.cycle.is_some_and(|row| waits(row.op));
        let session = &mut self.session;
        let command = &mut read.command;
        let incremental =
            match command.ops.iter().rev().find(|op| matches!(op, Op::Absolute | Op::Incremental)) {
                Some(op) => *op == Op::Incremental,
                None => session.machine.is_incremental(),
            };
        let increment = session.unstated_increments().map(|all| all.length);
        self.polar.resolve(command, incremental, increment, &mut session.trace);
        let message = if command.has(Op::Stop) { self.message(block) } else { None };
        let command = &mut read.command;
        if message.is_some() {
            command.ops.retain(|op| *op != Op::Stop);
        }
        let only_stop =
            command.words.is_empty() && (message.is_some() || command.ops.as_slice() == [Op::Stop]);
        let only_jump = command.ops.is_empty() && read.flow.as_slice() == [Op::Jump];
        if only_stop && self.stood == Some(self.at) {
            // A stop that leads to itself: whatever an operator does, nothing more comes of it.
            return Err(Halt::Steps);
        }
        self.stood = if only_stop { Some(self.at) } else { self.stood.filter(|_| only_jump) };
        let session = &mut self.session;
        if !command.is_empty() {
            session.machine.run(command, &mut session.trace)?;
        }
        if let Some(text) = message {
            session.pause(Pause::Stop, EventKind::Message { text: text.clone() });
            self.answer_in(&text);
        }
        self.flow(&read, words)
    }

    /// An operator who reads the name of a variable in a message enters the next answer into it.
    fn answer_in(&mut self, text: &str) {
        if !self.session.has_answer() {
            return;
        }
        if let Some(cell) = variable_to_set(text, &["V"]).and_then(|name| Cell::numbered(name.number)) {
            let answer = self.session.answer();
            self.store.set(cell, answer);
            self.stood = None;
        }
    }

    /// What a drilling cycle takes from elsewhere: its planes, pecks and dwell from variables, and where its holes end.
    fn cycle(&mut self, read: &mut Read<'r>) {
        if !read.codes.iter().any(|row| row.op.is_cycle()) {
            return;
        }
        let mut taken =
            vec![(Question::CycleVariableRetract, Role::CycleR), (Question::CycleVariableDepth, Role::Z)];
        for row in &read.codes {
            match row.op {
                Op::CyclePeck | Op::CycleChipBreak => taken.push((Question::CycleVariablePeck, Role::CycleQ)),
                op if waits(op) => taken.push((Question::CycleVariableDwell, Role::CycleDwell)),
                _ => {}
            }
        }
        for (behaviour, role) in taken {
            let row = self.session.control.behaviour(behaviour);
            let cell = row.and_then(|row| row.value.parse().ok()).and_then(Cell::numbered);
            let Some(cell) = cell else { continue };
            self.session.rest_on(behaviour);
            if let Some(value) = self.store.get(cell) {
                // The variable counts seconds, a cycle milliseconds.
                let scale = if role == Role::CycleDwell { 1000.0 } else { 1.0 };
                read.command.words.push((role, value * scale));
            }
        }
        let returns = self.session.control.behaviour(Question::CycleReturns);
        self.session.rest_on(Question::CycleReturns);
        if returns.is_some_and(|row| row.value == "retract") {
            read.command.ops.push(Op::ReturnR);
        }
    }

    /// The text that a stop shows: the comment in its block, or alone in the next one.
    fn message(&self, block: &'r Block) -> Option<String> {
        if !self.session.control.is(Question::MessageShowsComment) {
            return None;
        }
        let next = self.session.block(self.at.section, self.at.index).filter(|next| {
            let items = &next.items;
            items.iter().all(|item| {
                matches!(item.kind, ItemKind::Comment(_) | ItemKind::Sequence { .. } | ItemKind::EndOfBlock)
            })
        });
        let comment = [Some(block), next].into_iter().flatten().find_map(|block| {
            block.items.iter().find_map(|item| match &item.kind {
                ItemKind::Comment(comment) => Some(comment.text),
                _ => None,
            })
        })?;
        let source = self.session.source(self.at.section);
        let text = source.get(comment.start as usize..comment.end as usize)?;
        Some(decode(text).trim().to_owned())
    }

    /// The end of a called part; that of a cycle where the code is M2.
    fn go_back(&mut self, of_cycle: bool) -> Flow<Next> {
        if of_cycle && !self.in_cycle() {
            self.session.act_as(Question::CycleEndEndsProgram, "true");
            return Err(Halt::Ended(Op::End));
        }
        if self.depth > 0 {
            return Ok(Next::Back);
        }
        // The end of a cycle, or of a part that stands in a file of its own, as it is pasted into its callers.
        if self.session.scenario.called {
            return Err(Halt::Ended(Op::Return));
        }
        if !of_cycle {
            self.session.trace.doubt("machine:return.without.call");
        }
        Err(Halt::Ended(Op::End))
    }

    fn flow(&mut self, read: &Read<'r>, words: &[Spoken]) -> Flow<Next> {
        for &op in &read.flow {
            let label = read.command.number(Role::Sequence);
            let label = || label.ok_or_else(|| Stop::unnamed("a call or a jump without P"));
            match op {
                Op::Jump => self.jump(label()?)?,
                Op::CallLocal => {
                    let again = read.command.number(Role::CallAgain);
                    if again.is_some() {
                        self.session.act_as(Question::RepeatCounts, "extra");
                    }
                    self.call_local(label()?, again.unwrap_or(0).saturating_add(1))?;
                }
                Op::CallCycle => {
                    let numbers =
                        words.iter().filter(|word| word.letter == 'G').map(|word| word.value - CYCLES);
                    let number = numbers.rev().find(|number| (1.0..100.0).contains(number));
                    self.call_cycle(number.unwrap_or(0.0) as u32)?;
                }
                Op::Return => return self.go_back(words.iter().any(|word| word.letter == 'M')),
                Op::End | Op::EndRewind => return Err(Halt::Ended(op)),
                _ => {}
            }
        }
        Ok(Next::On)
    }
}
