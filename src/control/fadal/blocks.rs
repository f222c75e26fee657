//! NC lines: words, R set by sign, and the codes of flow.

use super::calls::Local;
use super::registers::{PLANE, Register};
use super::{Interpreter, Next};
use crate::canon::{Op, Pause, Role};
use crate::control::outcome::Stop;
use crate::control::session::{Flow, Halt};
use crate::control::trace::EventKind;
use crate::control::words::{self, Read, Spoken};
use crate::dialect::Question;
use crate::syntax::{Block, Expr, ExprKind, Index, ItemKind};
use crate::text::{Span, decode, variable_to_set};
use smallvec::SmallVec;

/// The words of a block, and which R it set before they were read.
#[derive(Default)]
struct Line {
    words: SmallVec<[Spoken; 12]>,
    set: SmallVec<[Register; 4]>,
    /// How many words stand before the R0 that it sets.
    plane_at: Option<usize>,
    /// The comment, which a stop shows.
    comment: Option<Span>,
}

/// What an L without a code of its own asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Nothing,
    Call(Local),
    Times(u32),
}

impl<'r> Interpreter<'r, '_> {
    /// Runs a block that stands in no border of a subroutine.
    pub(super) fn run(&mut self, block: &Block) -> Flow<Next> {
        let mut line = Line::default();
        self.waited &= block.items.iter().any(|item| matches!(item.kind, ItemKind::Print { .. }));
        for item in &block.items {
            match &item.kind {
                ItemKind::Skip(number) => {
                    match number {
                        Some(2..) => self.session.act_as(Question::SkipLevels, "true"),
                        _ => self.session.rest_on(Question::SkipLevels),
                    }
                    if self.session.skips(*number) {
                        break;
                    }
                }
                ItemKind::Word(word) => {
                    let Some(expr) = &word.value else { continue };
                    let computed = !matches!(expr.kind, ExprKind::Number(_));
                    self.doubt_order(expr, &line);
                    let value = self.value(expr)?;
                    line.words.push(Spoken { letter: word.letter, value, computed });
                }
                ItemKind::Assign { target, value, by_sign: true } => {
                    let value = self.value(value)?;
                    self.assign(target, value)?;
                    if let Index::Number(number) = target.index
                        && let Some(register) = Register::new(&target.name, number)
                    {
                        line.plane_at = line.plane_at.or((register == PLANE).then_some(line.words.len()));
                        line.set.push(register);
                    }
                }
                ItemKind::Comment(comment) => line.comment = Some(comment.text),
                other => self.statement(other)?,
            }
        }
        if line.words.is_empty() && line.set.is_empty() { Ok(Next::On) } else { self.words(line) }
    }

    /// Whether a word sees what its own block gave to a variable is not stated.
    fn doubt_order(&mut self, expr: &Expr, line: &Line) {
        let inner = match &expr.kind {
            ExprKind::Negate(inner) | ExprKind::Plus(inner) => inner,
            _ => expr,
        };
        if let ExprKind::Variable(variable) = &inner.kind
            && let Index::Number(number) = variable.index
            && Register::new(&variable.name, number).is_some_and(|used| line.set.contains(&used))
        {
            self.session.act_as(Question::BlockAssignsFirst, "true");
        }
    }

    fn words(&mut self, mut line: Line) -> Flow<Next> {
        let asked = self.asked(&mut line)?;
        let session = &mut self.session;
        if session.machine.cycle().is_none() {
            self.lasting.cycle = None;
        }
        let mut read = words::read(session, &line.words, &mut self.lasting)?;
        self.plane(&mut read, &line);
        self.by_place(&mut read)?;
        self.before(&read, &line, asked)?;
        let printed = self.printed.take();
        let stops = read.command.has(Op::Stop);
        let shown = if stops { self.shown(&line) } else { None };
        let printed = printed.filter(|_| stops && self.session.scenario.sets_named);
        let text = shown.clone().or(printed);
        if shown.is_some() {
            read.command.ops.retain(|op| *op != Op::Stop);
        }
        let waits = self.waits_for_start(&mut read);
        self.tell(&mut read, asked)?;
        if let Some(text) = shown {
            self.session.pause(Pause::Stop, EventKind::Message { text });
        }
        self.answer_in(text.as_deref());
        if waits {
            self.session.pause(Pause::Message, EventKind::Message { text: String::new() });
        }
        if let Asked::Call(call) = asked
            && !read.flows(Op::CallModal)
        {
            if !read.command.is_empty() {
                self.session.act_as(Question::CallAfterWords, "true");
            }
            self.call_local(call)?;
        }
        self.after(&read)
    }

    /// An operator who reads the name of a variable at a stop enters the next answer into it.
    fn answer_in(&mut self, text: Option<&str>) {
        let Some(text) = text.filter(|_| self.session.has_answer()) else { return };
        let named = variable_to_set(text, &["V", "R"]);
        if let Some(register) = named.and_then(|name| Register::new(&name.prefix, name.number)) {
            let answer = self.session.answer();
            self.keep(register, answer);
        }
    }

    /// Takes out a dwell of the one time that waits for START.
    fn waits_for_start(&self, read: &mut Read<'_>) -> bool {
        let time = read.command.word(Role::DwellMs).filter(|_| read.command.has(Op::Dwell));
        if time.is_none() || time != self.session.control.number(Question::DwellWaits) {
            return false;
        }
        read.command.ops.retain(|op| *op != Op::Dwell);
        read.command.words.retain(|(role, _)| *role != Role::DwellMs);
        true
    }

    /// The text that a stop shows: the comment in its block.
    fn shown(&mut self, line: &Line) -> Option<String> {
        let comment = line.comment.filter(|_| self.session.control.is(Question::MessageShowsComment))?;
        let text = self.session.source(self.at.section).get(comment.start as usize..comment.end as usize)?;
        let text = decode(text).trim().to_owned();
        (!text.is_empty()).then_some(text)
    }

    /// Takes an L that calls or repeats out of the words; beside a code that reads L it stays.
    fn asked(&mut self, line: &mut Line) -> Flow<Asked> {
        let Some(place) = line.words.iter().position(|word| word.letter == 'L') else {
            return Ok(Asked::Nothing);
        };
        let block: SmallVec<[(char, Option<f64>); 12]> =
            line.words.iter().map(|word| (word.letter, Some(word.value))).collect();
        let control = self.session.control;
        let reads_l = line.words.iter().filter(|word| matches!(word.letter, 'G' | 'M')).any(|word| {
            control.code(word.letter, word.value, &block).is_some_and(|row| {
                row.words.contains_key("L")
                    || row.beside().is_some_and(|all| all.iter().any(|one| one.letter == 'L'))
            })
        });
        if reads_l {
            return Ok(Asked::Nothing);
        }
        let value = line.words.remove(place).value;
        line.plane_at.iter_mut().filter(|before| **before > place).for_each(|before| *before -= 1);
        if value.fract() != 0.0 {
            self.session.act_as(Question::IntegerWordRounds, "true");
        }
        if !(0.0..1e6).contains(&value) {
            return Err(Stop::unnamed(format!("L{value} is out of range")).into());
        }
        let value = value.round() as u32;
        Ok(Local::new(value).map_or(Asked::Times(value), Asked::Call))
    }

    /// R0 as the word that a cycle, an arc or a table takes it for.
    fn plane(&mut self, read: &mut Read<'r>, line: &Line) {
        let control = self.session.control;
        let Register::R(number) = PLANE else { return };
        let role =
            read.rows(&self.lasting).find_map(|row| control.parametric_role('R', number as u32, Some(row)));
        let Some(role) = role else { return };
        if read.command.word(role).is_some() {
            if role == Role::CycleR {
                self.session.act_as(Question::CycleRWord, "true");
                self.plane_moved = false;
            }
            return;
        }
        let kept = !line.set.contains(&PLANE);
        let begins = read.codes.iter().any(|row| row.op.is_cycle());
        let places = read.command.has_axes() && !read.command.ops.iter().any(|op| takes_axes(*op));
        let drills = places || read.command.has(Op::CycleHere);
        match role {
            _ if !kept => {}
            // A cycle that is begun without R0 takes what R0 holds.
            Role::CycleR if begins => self.session.act_as(Question::CycleR0Kept, "true"),
            // So does a hole after R0 got another value.
            Role::CycleR if self.plane_moved && drills && control.is(Question::CycleR0Kept) => {
                self.session.act_as(Question::CycleR0Kept, "true");
            }
            Role::OffsetValue => self.session.trace.doubt("machine:offset.value.kept"),
            _ => return,
        }
        // A register that nothing set holds zero, as where a word reads it.
        let otherwise = (role == Role::CycleR).then_some(0.0);
        let Some(value) = self.registers.get(PLANE).or(otherwise) else { return };
        read.command.words.push((role, value));
        self.plane_moved &= role != Role::CycleR;
        if let (Some(by_place), Some(before)) = (&mut read.by_place, line.plane_at) {
            by_place.note(role, before);
        }
    }

    /// G90 and G91 count for the words after them.
    fn by_place(&mut self, read: &mut Read<'r>) -> Flow<()> {
        let Some(by_place) = read.by_place.take() else { return Ok(()) };
        let machine = &self.session.machine;
        let ends = read.command.has(Op::CycleOff);
        let drills = machine.cycle().is_some() && !ends || read.codes.iter().any(|row| row.op.is_cycle());
        by_place.tell(&mut read.command, machine.is_incremental(), drills)?;
        if by_place.matters() {
            self.session.rest_on(Question::DistanceCode);
        }
        Ok(())
    }

    /// What must be in force before the block's words act.
    fn before(&mut self, read: &Read<'_>, line: &Line, asked: Asked) -> Flow<()> {
        if read.flows(Op::CallModal) {
            let Asked::Call(call) = asked else {
                return Err(Halt::Error("G66 stands without the subroutine that it calls".into()));
            };
            self.session.act_as(Question::CallModalBlockCalls, "false");
            if self.in_modal || !self.modal.is_empty() {
                self.session.act_as(Question::CallModalNested, "");
            }
            self.modal.push(call);
        }
        if read.flows(Op::CallModalOff) {
            self.modal.pop();
        }
        if read.flows(Op::WriteVariable) {
            let value = |letter| line.words.iter().find(|word| word.letter == letter).map(|word| word.value);
            let number = value('L').map(|selector| (selector - 100.0).round() as u32);
            if let Some(register) = number.and_then(|number| Register::new("R", number)) {
                self.keep(register, value('P').unwrap_or(0.0));
            }
        }
        if read.flows(Op::ReadOffset) {
            return Err(Halt::Error("no source says which table this G10 reads".into()));
        }
        Ok(())
    }

    /// Tells the machine, as often as L says, and runs the modal subroutine after each move.
    /// Stops at a code that the control takes for a fault under another one.
    fn check_fault(&self, read: &Read<'_>) -> Flow<()> {
        let (command, machine) = (&read.command, &self.session.machine);
        for op in &command.ops {
            let in_force = |other: Op| {
                let group = other.group();
                let own = command.of(group).filter(|_| group != op.group());
                own.or_else(|| machine.modal(group)) == Some(other)
            };
            if let Some(row) = self.session.control.forbids(*op, in_force) {
                return Err(Halt::Error(format!("{op} is a fault here ({})", row.origin.source)));
            }
        }
        Ok(())
    }

    fn tell(&mut self, read: &mut Read<'r>, asked: Asked) -> Flow<()> {
        let begins = read.codes.iter().any(|row| row.op.is_cycle());
        let drills = begins || self.session.machine.cycle().is_some() && !read.command.has(Op::CycleOff);
        let here = read.command.has(Op::CycleHere) && !drills && !self.modal.is_empty();
        if here {
            read.command.ops.retain(|op| *op != Op::CycleHere);
        }
        self.check_fault(read)?;
        let moves = read.command.has_axes() && !read.command.ops.iter().any(|op| takes_axes(*op));
        let mut times = 1;
        if let Asked::Times(count) = asked {
            if drills {
                read.command.words.push((Role::Repeat, f64::from(count)));
            } else {
                times = count;
                if count == 0 {
                    self.session.act_as(Question::RepeatZero, "none");
                }
            }
        }
        for turn in 0..times {
            if turn > 0 {
                self.session.count()?;
            }
            if read.command.is_empty() {
                break;
            }
            let session = &mut self.session;
            if read.command.has(Op::ToolChange) && read.command.word(Role::Tool).is_none() {
                session.trace.doubt("machine:tool.change.alone");
            }
            session.machine.run(&read.command, &mut session.trace)?;
            self.moving |= moves;
            if moves {
                self.call_modal()?;
            }
        }
        if here { self.call_modal() } else { Ok(()) }
    }

    /// Calls, returns and ends, when the words are done.
    fn after(&mut self, read: &Read<'_>) -> Flow<Next> {
        for &op in &read.flow {
            match op {
                Op::CallProgram => {
                    let Some(number) = read.command.number(Role::Program) else {
                        return Err(Stop::unnamed("M98 without P").into());
                    };
                    let count = read.command.number(Role::CallCount).unwrap_or(1);
                    self.call_program(number, count)?;
                }
                Op::Return => return self.give_back(read.command.number(Role::Sequence)),
                Op::SubEnd | Op::SubAreaEnd => return self.end_subroutine(op),
                Op::End | Op::EndRewind => return Err(Halt::Ended(op)),
                _ => {}
            }
        }
        Ok(Next::On)
    }
}

/// True for an operation that takes the axis words for itself.
fn takes_axes(op: Op) -> bool {
    use Op::*;
    matches!(op, LocalShift | SetPosition | WriteWork | RotateOn | ScaleOn | MirrorOn | MirrorOff | Dwell)
}
