//! From the words of a block to a [`Command`], by the tables of the control.

use super::by_place::ByPlace;
use super::machine::Command;
use super::outcome::Stop;
use super::session::Session;
use super::trace::Trace;
use crate::canon::{Group, Op, Role};
use crate::dialect::{CodeMeaning, Control, Question};
use smallvec::SmallVec;

/// A word whose value is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spoken {
    /// Its letter.
    pub letter: char,
    /// Its value.
    pub value: f64,
    /// True where the value is computed, not written.
    pub computed: bool,
}

/// The codes whose meaning of a letter lasts. Whoever drives the machine drops a cycle that
/// the machine has ended.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lasting<'c> {
    /// The interpolation.
    pub motion: Option<&'c CodeMeaning>,
    /// The drilling cycle.
    pub cycle: Option<&'c CodeMeaning>,
}

impl<'c> Lasting<'c> {
    /// The codes that are in force when a program starts.
    pub fn at_start(session: &Session<'c, '_>) -> Self {
        let row = |op: Op| session.control.code_for(op, &Default::default());
        let motion = Some(session.machine.motion()).filter(|op| *op != Op::Rapid);
        Self { motion: motion.and_then(row), cycle: session.machine.cycle().and_then(row) }
    }
}

/// What a block's words say.
#[derive(Debug, Default)]
pub struct Read<'c> {
    /// What the machine is told.
    pub command: Command,
    /// The codes that stand in the block, in order.
    pub codes: SmallVec<[&'c CodeMeaning; 4]>,
    /// Flow: calls, returns, ends, and what writes variables; the interpreter's.
    pub flow: SmallVec<[Op; 2]>,
    /// Which of G90 and G91 counts where in the block, where one does not count for all of it.
    pub by_place: Option<ByPlace>,
}

impl<'c> Read<'c> {
    /// True where a flow operation stands in it.
    pub fn flows(&self, op: Op) -> bool {
        self.flow.contains(&op)
    }

    /// The codes that give letters their roles here, the block's own first.
    pub fn rows<'s>(&'s self, lasting: &'s Lasting<'c>) -> impl Iterator<Item = &'c CodeMeaning> + 's {
        let in_force = [lasting.cycle, lasting.motion].into_iter().flatten();
        self.codes.iter().copied().chain(in_force)
    }
}

/// Reads the words of a block. A code that the control does not have stops it.
pub fn read<'c>(
    session: &mut Session<'c, '_>,
    words: &[Spoken],
    lasting: &mut Lasting<'c>,
) -> Result<Read<'c>, Stop> {
    let (control, increments) = (session.control, session.unstated_increments());
    let trace = &mut session.trace;
    let block: SmallVec<[(char, Option<f64>); 12]> =
        words.iter().map(|word| (word.letter, Some(word.value))).collect();
    let mut read = Read::default();
    for word in words.iter().filter(|word| matches!(word.letter, 'G' | 'M')) {
        code(control, *word, &block, &mut read, trace)?;
    }
    read.by_place = ByPlace::of(control, words, &read.codes);
    if control.behaviour(Question::DistanceCode).is_none() {
        doubt_distance(words, &read, trace);
    }
    for row in &read.codes {
        match row.op.group() {
            Group::Motion => lasting.motion = Some(*row),
            Group::Cycle => lasting.cycle = row.op.is_cycle().then_some(*row),
            _ => {}
        }
    }
    read.command.without_dwell = lasting.cycle.is_some_and(|row| !row.takes(Role::CycleDwell));
    for (at, word) in words.iter().enumerate().filter(|(_, word)| !matches!(word.letter, 'G' | 'M')) {
        let before = read.command.words.len();
        value(control, *word, increments, lasting, &mut read, trace);
        let role = read.command.words.get(before).map(|(role, _)| *role);
        if let (Some(by_place), Some(role)) = (&mut read.by_place, role) {
            by_place.note(role, at);
        }
    }
    Ok(read)
}

fn code<'c>(
    control: &'c Control,
    word: Spoken,
    block: &[(char, Option<f64>)],
    read: &mut Read<'c>,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let name = || format!("{}{}", word.letter, word.value);
    if let Some(row) = control.code(word.letter, word.value, block) {
        trace.rest_on(row);
        read.codes.push(row);
        if row.op.is_flow() || matches!(row.op, Op::WriteVariable | Op::ReadOffset) {
            read.flow.push(row.op);
            return Ok(());
        }
        read.command.ops.push(row.op);
        read.command.ops.extend_from_slice(&row.with);
        read.command.words.extend(row.fixed.iter().map(|(role, value)| (*role, *value)));
        if matches!(row.op, Op::Builder | Op::MachineSpecific) {
            read.command.own_code = Some(name());
        }
        return Ok(());
    }
    if word.letter == 'M' || control.site_code(word.letter, word.value).is_some() {
        // The tables list the codes of the manuals; builders add their own.
        trace.doubt(&format!("machine:code.{}", name()));
        read.command.ops.push(Op::Builder);
        read.command.own_code = Some(name());
        return Ok(());
    }
    Err(Stop::unnamed(format!("the control has no {}", name())))
}

/// Whether an absolute or incremental code counts for the words before it is not stated; it is
/// taken to count for its whole block.
fn doubt_distance(words: &[Spoken], read: &Read<'_>, trace: &mut Trace) {
    let mut codes = read.codes.iter();
    let mut axes = false;
    for word in words {
        match word.letter {
            'G' | 'M' => {
                let changes = codes.next().is_some_and(|row| row.op.group() == Group::Distance);
                if changes && axes {
                    trace.doubt("machine:distance.code.behind.words");
                }
            }
            'X' | 'Y' | 'Z' => axes = true,
            _ => {}
        }
    }
}

fn value<'c>(
    control: &'c Control,
    word: Spoken,
    increments: Option<Increments>,
    lasting: &Lasting<'c>,
    read: &mut Read<'c>,
    trace: &mut Trace,
) {
    let mut buffer = [0; 4];
    let letter: &str = word.letter.encode_utf8(&mut buffer);
    let row = read.rows(lasting).find(|row| row.words.contains_key(letter));
    let beside = row.and_then(|row| row.words.get(letter)).copied();
    let usual = control.word(word.letter, false);
    let Some(role) = beside.or(usual.map(|usual| usual.role)) else {
        trace.doubt("machine:word.without.meaning");
        return;
    };
    if beside.is_none()
        && let Some(usual) = usual
    {
        trace.rest_on(usual);
        read.command.ops.extend(usual.op);
    }
    let mut value = control.canonical(row, role, word.value);
    if role == Role::Speed && control.is(Question::SpindleRangeSuffix) {
        // The fraction picks the gear range.
        value = value.trunc();
    }
    if role.is_integer() && value.fract() != 0.0 {
        if let Some(row) = control.behaviour(Question::IntegerWordRounds) {
            match row.value.as_str() {
                "false" => trace.doubt(row.question.fact()),
                _ => trace.rest_on(row),
            }
        }
        value = value.round();
    }
    if let Some(increment) = increments.filter(|_| word.computed).and_then(|all| all.of(role)) {
        value = to_increment(value, increment);
    }
    read.command.words.push((role, value));
}

/// The least increments of a control in the units in force.
#[derive(Clone, Copy, Debug)]
pub struct Increments {
    /// Of lengths.
    pub length: f64,
    /// Of angles.
    pub degrees: f64,
}

impl Increments {
    /// That of a word in a role, where it has one.
    fn of(self, role: Role) -> Option<f64> {
        match role {
            Role::A | Role::B | Role::C | Role::Angle => Some(self.degrees),
            _ if role.is_length() || role.is_axis() => Some(self.length),
            _ => None,
        }
    }
}

/// The nearest multiple of an increment, half-way ones away from zero.
pub fn to_increment(value: f64, increment: f64) -> f64 {
    let count = (1.0 / increment).round();
    let scaled = value * count;
    // A value that means a half-way one may lie a last digit beside it.
    let nearest = (scaled + scaled.signum() * 1e-9).round();
    nearest / count
}
