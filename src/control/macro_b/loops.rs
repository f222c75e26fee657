//! Where loops begin and end.

use super::Style;
use super::code::{Block, Ends, Loop, Program, Step};
use crate::control::outcome::Stop;

/// A block with the head or the end of a loop, and their numbers.
pub struct Mark {
    at: usize,
    head: Option<u32>,
    end: Option<u32>,
    /// The switch that leaves the block out.
    skip: Option<u8>,
}

/// A loop head met so far.
struct Open {
    number: u32,
    block: usize,
    index: usize,
    skip: Option<u8>,
}

impl Mark {
    /// None where the block has neither.
    pub fn of(at: usize, block: &Block) -> Option<Self> {
        let (mut head, mut end, mut skip) = (None, None, None);
        for step in &block.steps {
            match step {
                Step::While { tail, .. } => head = Some(*tail as u32),
                Step::Repeat { head } => end = Some(*head as u32),
                Step::Skip { level, .. } => skip = Some(*level),
                _ => {}
            }
        }
        (head.is_some() || end.is_some()).then_some(Self { at, head, end, skip })
    }
}

/// Finds the ends of loops. A loop without its end, and an end without its loop, is an alarm where it is met.
pub fn match_loops(program: &mut Program, marks: &[Mark]) {
    let mut open: Vec<Open> = Vec::new();
    let mut faults: Vec<(usize, &'static str)> = Vec::new();
    let mut halves: Vec<(usize, u8, &'static str)> = Vec::new();
    if !marks.is_empty() {
        program.loop_of = vec![None; program.count];
    }
    let mut next = 0;
    for mark in marks {
        let at = mark.at;
        let around = open.last().map(|open| open.index);
        fill(program, next, at, around);
        next = at + 1;
        if let Some(number) = mark.head {
            if open.iter().any(|loop_| loop_.number == number) {
                faults.push((at, "a loop of this number is open already"));
            }
            program.loops.push(Loop { head: at, tail: usize::MAX, outer: around });
            let index = program.loops.len() - 1;
            open.push(Open { number, block: at, index, skip: mark.skip });
        }
        fill(program, at, next, open.last().map(|open| open.index));
        if let Some(number) = mark.end {
            match open.iter().rposition(|loop_| loop_.number == number) {
                None => faults.push((at, "END without DO")),
                Some(place) => {
                    if place + 1 != open.len() {
                        faults.push((at, "loops cross"));
                    }
                    let head = open.remove(place);
                    if let Some(loop_) = program.loops.get_mut(head.index) {
                        loop_.tail = at;
                    }
                    if head.skip != mark.skip {
                        halves.extend(head.skip.map(|level| (at, level, "END without DO")));
                        halves.extend(mark.skip.map(|level| (head.block, level, "DO without END")));
                    }
                }
            }
        }
    }
    fill(program, next, program.count, open.last().map(|open| open.index));
    faults.extend(open.iter().map(|open| (open.block, "DO without END")));
    for loop_ in program.loops.iter().filter(|loop_| loop_.tail != usize::MAX) {
        program.ends.entry(loop_.head).or_default().tail = Some(loop_.tail);
        program.ends.entry(loop_.tail).or_default().head = Some(loop_.head);
    }
    for (at, level, text) in halves {
        program.ends.entry(at).or_default().alone = Some((level, text));
    }
    for (at, text) in faults {
        program.ends.entry(at).or_default().fault = Some(text);
    }
}

/// Notes the innermost loop of blocks.
fn fill(program: &mut Program, from: usize, to: usize, around: Option<usize>) {
    program.loop_of.get_mut(from..to).unwrap_or_default().fill(around);
}

/// Puts into blocks, of which this is the first in the program, where their loops lead.
pub fn set_ends(
    blocks: &mut [Block],
    first: usize,
    ends: &std::collections::HashMap<usize, Ends>,
    style: &Style,
) {
    if ends.is_empty() {
        return;
    }
    for (at, block) in (first..).zip(blocks) {
        let Some(ends) = ends.get(&at) else { continue };
        for step in &mut block.steps {
            match step {
                Step::While { tail, .. } => *tail = ends.tail.unwrap_or(*tail),
                Step::Repeat { head } => *head = ends.head.unwrap_or(*head),
                _ => {}
            }
        }
        if let Some((level, text)) = ends.alone {
            // With its own switch on it is left out as well.
            let own = block.steps.iter().position(|step| matches!(step, Step::Skip { .. }));
            let before = vec![Step::Alarm(Stop::alarm(style.alarms.loops, text))];
            block.steps.insert(own.map_or(0, |own| own + 1), Step::Skip { level, before });
        }
        if let Some(text) = ends.fault {
            block.steps = vec![Step::Alarm(Stop::alarm(style.alarms.loops, text))];
        }
    }
}
