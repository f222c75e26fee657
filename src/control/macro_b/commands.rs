//! The words of a block: what they tell the machine, and where they send the program.

use super::code::{Coded, Meaning, Words};
use super::meaning::is_code;
use super::run::{Next, Runner};
use crate::canon::{Group, Op, Pause, Role, Sys};
use crate::control::machine::Command;
use crate::control::outcome::Stop;
use crate::control::session::Halt;
use crate::control::trace::{EventKind, Trace};
use smallvec::SmallVec;

impl<'c> Runner<'c> {
    /// Does what the words say.
    pub fn words(&mut self, words: &Words) -> Result<Next, Halt> {
        let count = words.words.len();
        let mut values: SmallVec<[Option<f64>; 16]> = smallvec::smallvec![None; count];
        let mut there: SmallVec<[bool; 16]> = smallvec::smallvec![true; count];
        for (at, word) in words.words.iter().enumerate() {
            if is_code(word.letter, word.comma) {
                let value = self.eval(&word.value)?;
                there[at] = value.is_some();
                self.rounds_to_whole(value.unwrap_or(0.0));
                // A computed code is a whole number, the nearest one.
                values[at] = value.map(|value| if word.form.is_literal() { value } else { value.round() });
                if let Some(number) = values[at].filter(|_| !word.form.is_literal()) {
                    self.session.trace.computed_code(word.letter, number);
                }
            }
        }
        let fresh = match &words.meaning {
            Some(_) => None,
            None => Some(self.meaning_now(&words.words, &there, &values)),
        };
        let Some(mut meaning) = fresh.as_ref().or(words.meaning.as_deref()) else { return Ok(Next::On) };
        let call = self.macro_call(meaning);
        // The words of its own block count in the unit that a code names.
        let control = self.session.control;
        for row in meaning.codes.iter().filter_map(|code| control.code_at(code.row?)) {
            self.session.machine.name_unit(row.op);
        }
        for (at, word) in words.words.iter().enumerate() {
            let argument = call.is_some_and(|call| at > call.word || call.alias.is_some());
            if argument || is_code(word.letter, word.comma) {
                continue;
            }
            let known = self.role_of(meaning, at, word);
            values[at] = self.word_value(word, known)?;
            if values[at].is_none() {
                self.rules.vacant_word_dropped.ask(&mut self.session.trace);
                there[at] = false;
                if known.is_some_and(|(role, _)| role == Role::Speed) {
                    self.session.trace.odd_speed(0.0);
                }
            }
        }
        // A word that is dropped may have picked the meaning of a code, and so may a computed one.
        let mended = (there.contains(&false) || meaning.fault.is_some())
            .then(|| self.meaning_now(&words.words, &there, &values));
        meaning = mended.as_ref().unwrap_or(meaning);
        if fresh.is_some() || mended.is_some() {
            meaning.facts.iter().for_each(|fact| self.session.trace.doubt(fact));
        }
        if let Some(stop) = &meaning.fault {
            return Err(Halt::Alarm(stop.clone()));
        }
        self.refuse_flow(meaning)?;
        self.gather(words, meaning, call, &values)?;
        self.place_beside_limit()?;
        if self.keep_contoured() {
            return Ok(Next::On);
        }
        self.refuse_modal_call()?;
        let mut command = std::mem::take(&mut self.command);
        let moves = command.has_axes() && !command.ops.iter().any(|op| keeps_axes(*op));
        let shown = words.shown.as_ref().filter(|_| command.has(Op::Stop));
        if shown.is_some() {
            command.ops.retain(|op| *op != Op::Stop);
        }
        let done = if command.is_empty() {
            Ok(())
        } else {
            self.session.machine.run(&command, &mut self.session.trace)
        };
        let done = done.map_err(|stop| self.lathe_stop(stop));
        if let Some(op) = command.ops.iter().copied().find(|op| op.reads_contour()) {
            self.command = Command::default();
            return done.and_then(|()| self.contour(op, &command));
        }
        let asks = command.words.iter().find_map(|(role, act)| self.asks_at(*role, *act));
        command.clear();
        self.command = command;
        done?;
        if let Some(variable) = asks.filter(|_| self.session.has_answer()) {
            let answer = self.session.answer_at_code();
            self.memory.put(variable, answer);
        }
        if self.session.machine.waits() && (call.is_some() || self.goes_elsewhere(meaning)) {
            return Err(self.lathe_stop(self.session.machine.waits_in_vain()));
        }
        if let Some(text) = shown {
            let what = EventKind::Message { text: text.clone() };
            self.session.pause(Pause::Stop, what);
            self.answer_in(text);
        }
        match call {
            Some(call) => self.call_macro(words, call),
            None => self.flow(words, meaning, &values, moves),
        }
    }

    /// The code of the block whose other words are arguments.
    fn macro_call(&self, meaning: &Meaning) -> Option<Coded> {
        meaning.codes.iter().copied().find(|code| {
            code.alias.is_some_and(|alias| alias.arguments && self.aliases_count())
                || self
                    .row(code.row)
                    .is_some_and(|row| matches!(row.op, Op::CallMacro | Op::CallModal | Op::CallModalEach))
        })
    }

    /// Makes the command of those words that are no arguments.
    fn gather(
        &mut self,
        words: &Words,
        meaning: &Meaning,
        call: Option<Coded>,
        values: &[Option<f64>],
    ) -> Result<(), Halt> {
        let mut command = std::mem::take(&mut self.command);
        for code in &meaning.codes {
            let Some(row) = self.row(code.row) else {
                if code.alias.is_none() || !self.aliases_count() {
                    command.ops.push(Op::Builder);
                    command.own_code = Some(format!("{}{}", code.letter, code.number));
                    self.session.trace.doubt(&format!("code:{}{}", code.letter, code.number));
                }
                continue;
            };
            self.keep_modal(code, row.op);
            command.words.extend(row.fixed.iter().map(|(role, value)| (*role, *value)));
            // No input of data is ever open here.
            if row.op.is_flow() || row.op == Op::DataInputEnd {
                continue;
            }
            if self.session.machine.is_lathe() && self.style.lathe_signs.contains(&row.code.as_str()) {
                let what = EventKind::Other { operation: row.op, code: Some(row.code.clone()) };
                self.session.trace.push(what);
                self.session.trace.doubt("machine:lathe.code.moves.nothing");
                continue;
            }
            if matches!(row.op, Op::MachineSpecific | Op::Builder | Op::CycleOther) {
                command.own_code = Some(row.code.clone());
            }
            command.ops.push(row.op);
            command.ops.extend_from_slice(&row.with);
            // Words of the straight feed mean something by it: corners.
            let straight = row.op == Op::Linear && !row.words.is_empty();
            if row.op.is_cycle() || row.op.is_pass() || straight {
                self.cycle = Some(row);
            }
        }
        command.without_dwell =
            self.cycle.is_some_and(|row| row.op != Op::Linear && !row.takes(Role::CycleDwell));
        let last = match call {
            Some(call) if call.alias.is_none() => call.word,
            Some(_) => 0,
            None if self.is_alarm_alone(meaning) => 0,
            None => usize::MAX,
        };
        let flow = meaning.codes.iter().any(|code| self.row(code.row).is_some_and(|row| row.op.is_flow()));
        for (at, word) in words.words.iter().enumerate().take(last) {
            let Some(value) = values.get(at).copied().flatten() else { continue };
            if !word.comma
                && let Some(address) = self.addresses.get_mut(place_of(word.letter))
            {
                *address = value;
            }
            if is_code(word.letter, word.comma) {
                continue;
            }
            match self.role_of(meaning, at, word) {
                // Words of the call, the jump or the return are not the machine's.
                Some((_, Some(row))) if row.op.is_flow() => {}
                // The code is another one by it: the tap of `G84 ,R1`.
                Some((_, None)) if word.comma && picks_code(self, meaning, word.letter, true) => {}
                Some((role, row)) => {
                    let value = match role {
                        Role::WorkOffset | Role::OffsetRow | Role::Output => {
                            self.session.control.canonical(row, role, value)
                        }
                        Role::Turret => self.session.control.turret_word().read(value),
                        _ => value * self.session.machine.scale_of(role),
                    };
                    if let (None, Some(op)) =
                        (row, self.session.control.word(word.letter, word.comma).and_then(|row| row.op))
                    {
                        command.ops.push(op);
                    }
                    push_word(&mut command, role, value, &mut self.session.trace);
                }
                None if flow => {}
                // The code is another one without it: `G5.1 Q1`.
                None if picks_code(self, meaning, word.letter, word.comma) => {}
                // A lathe does nothing of which nobody knows what it does. P beside an M code is its builder's: which spindle.
                None if self.session.machine.is_lathe()
                    && !(word.letter == 'P' && meaning.codes.iter().any(|code| code.letter == 'M')) =>
                {
                    let text = format!("the emulated lathe knows no {} here", word.letter);
                    self.command = command;
                    self.command.clear();
                    return Err(self.lathe_stop(Stop::unnamed(text)));
                }
                None => self.session.trace.doubt(&format!("word:{}", word.letter)),
            }
        }
        self.command = command;
        Ok(())
    }

    /// After which moves of a lathe's cycle a modal call calls, no source says.
    fn refuse_modal_call(&mut self) -> Result<(), Halt> {
        let drawn =
            self.session.machine.waits() || self.command.words.iter().any(|(role, _)| role.is_drawn());
        if drawn && self.session.machine.is_lathe() && self.has_modal_call() {
            return Err(self.lathe_stop(Stop::unnamed("a corner or an angle while a modal call is in force")));
        }
        let motion = self.command.of(Group::Motion).unwrap_or(self.session.machine.motion());
        let passes = motion.is_pass() && self.command.has_axes();
        if (passes || self.command.ops.iter().any(|op| op.is_lathe_cycle())) && self.has_modal_call() {
            return Err(self.lathe_stop(Stop::unnamed("a cycle of a lathe while a modal call is in force")));
        }
        Ok(())
    }

    /// A place beside a limit of the spindle speed is set, not gone to (S2).
    fn place_beside_limit(&mut self) -> Result<(), Halt> {
        let is_lathe = self.session.machine.is_lathe();
        if !is_lathe || !self.command.has(Op::LimitSpeed) || !self.command.has_axes() {
            return Ok(());
        }
        if !self.session.control.dialect().codes.iter().any(|row| row.op == Op::SetPosition) {
            self.command.clear();
            return Err(self.lathe_stop(Stop::unnamed("a position beside a limit of the spindle speed")));
        }
        self.command.ops.push(Op::SetPosition);
        Ok(())
    }

    /// Notes the code in force in a modal group, and the end of a drilling cycle.
    fn keep_modal(&mut self, code: &Coded, op: Op) {
        let group = op.group();
        if let Some(place) = group.number().and_then(|number| self.modal.get_mut(number as usize)) {
            *place = code.number;
        }
        if group == Group::Motion || op == Op::CycleOff {
            self.cycle = None;
            if group == Group::Motion && self.session.machine.cycle().is_some() {
                let off = self.session.control.code_for(Op::CycleOff, &Default::default());
                let head = off.and_then(crate::dialect::CodeMeaning::head);
                if let (Some(head), Some(place)) = (head, self.modal.get_mut(9)) {
                    *place = head.number();
                }
            }
        }
    }

    /// Where the codes of the block send the program.
    fn flow(
        &mut self,
        words: &Words,
        meaning: &Meaning,
        values: &[Option<f64>],
        moves: bool,
    ) -> Result<Next, Halt> {
        let control = self.session.control;
        let value = |wanted: Role| {
            meaning.beside.iter().zip(values).find_map(|(beside, value)| {
                let (role, place) = (*beside)?;
                let row = control.code_at(place)?;
                (row.op.is_flow() && role == wanted).then_some(*value)?
            })
        };
        for code in &meaning.codes {
            if let Some(alias) = code.alias.filter(|_| self.aliases_count()) {
                return self.call_program(f64::from(alias.program), (None, None), true);
            }
            let Some(row) = self.row(code.row).filter(|row| row.op.is_flow()) else { continue };
            // P of a call is a wait too, where P lasts across codes (docs/lathe.md S10): a whole number of milliseconds.
            if let Some(called) = value(Role::Program).or(value(Role::Sequence)) {
                self.session.machine.last_wait(called);
            }
            return match row.op {
                Op::End | Op::EndRewind => Err(Halt::Ended(row.op)),
                Op::Return => {
                    let to = value(Role::Sequence);
                    self.give_back(to).map(|()| Next::Block)
                }
                Op::CallProgram => match value(Role::Program) {
                    Some(program) => {
                        let from = value(Role::Sequence);
                        self.call_program(program, (value(Role::CallCount), from), false)
                    }
                    None => Err(Halt::Error("a call without its program".into())),
                },
                Op::CallLocal => match value(Role::Sequence) {
                    Some(sequence) => {
                        if words.words.iter().any(|word| word.letter == 'P' && !word.form.is_literal()) {
                            self.session.trace.computed_code('P', sequence);
                        }
                        self.call_local(sequence, value(Role::CallCount))
                    }
                    None => Err(Halt::Error("a call without its sequence number".into())),
                },
                Op::JumpInputOff => {
                    let bit = value(Role::Input).unwrap_or(0.0).max(0.0).round() as u32;
                    let session = &mut self.session;
                    let input = session.machine.read(Sys::Input, &[bit], &mut session.trace);
                    let on = input.unwrap_or(0.0) != 0.0;
                    self.session.branches.took(self.session.trace.at, i64::from(!on));
                    let at = self.frames.last().map_or(0, |frame| frame.at);
                    match (on, value(Role::Sequence)) {
                        (false, Some(to)) => self.jump(to.max(0.0).round() as u32, at).map(Next::At),
                        _ => Ok(Next::On),
                    }
                }
                Op::CallModalOff => {
                    self.end_modal()?;
                    Ok(Next::On)
                }
                _ => Err(Halt::Error(format!("{} is not run", row.code))),
            };
        }
        let each = self.modal_call_each();
        if moves || (each && !words.words.is_empty()) { self.trigger_modal() } else { Ok(Next::On) }
    }

    /// Notes that a program was entered, with locals of its own or its caller's.
    pub fn enter(&mut self, program: u32, level: bool) {
        self.session.enter(program, level);
    }
}

/// True for a word by which a code of the block is told from others, and which says nothing else: L2 of G10 L2.
fn picks_code(runner: &Runner<'_>, meaning: &Meaning, letter: char, comma: bool) -> bool {
    let rows = meaning.codes.iter().filter_map(|code| runner.row(code.row));
    let mut beside = rows.flat_map(|row| row.code.split_whitespace().skip(1));
    beside.any(|word| {
        let of_comma = word.strip_prefix(',');
        of_comma.is_some() == comma && {
            let word = of_comma.unwrap_or(word);
            word.starts_with(letter) && word.len() > 1
        }
    })
}

/// The place of an address among the last values: A at 1.
pub fn place_of(letter: char) -> usize {
    (letter as usize).wrapping_sub('A' as usize).wrapping_add(1)
}

/// Operations whose axis words do not move.
fn keeps_axes(op: Op) -> bool {
    use Op::*;
    matches!(
        op,
        LocalShift
            | SetPosition
            | WriteWork
            | WriteTurret
            | RotateOn
            | ScaleOn
            | MirrorOn
            | MirrorOff
            | Pole
            | Dwell
    )
}

/// Takes a word; of an axis that stands twice in its block the later word counts.
fn push_word(command: &mut Command, role: Role, value: f64, trace: &mut Trace) {
    if role.is_axis() && command.word(role).is_some() {
        trace.doubt("machine:word.twice");
        command.words.retain(|(other, _)| *other != role);
    }
    command.words.push((role, value));
}
