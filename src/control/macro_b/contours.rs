//! Contours: the blocks from P to Q of the running program, which a cycle of a lathe reads (R3 to R8, K12 of docs/lathe.md).

use super::code::{At, Block, Coded, Meaning, Step};
use super::run::{Loaded, Next, Runner};
use crate::canon::{Op, Role};
use crate::control::machine::{Command, Contour, Contoured};
use crate::control::outcome::Stop;
use crate::control::session::Halt;
use crate::control::trace::Place;

impl Runner<'_> {
    /// Cuts the contour that a cycle names, and says where the run goes on.
    pub fn contour(&mut self, op: Op, command: &Command) -> Result<Next, Halt> {
        let Some(at) = self.frames.last().map(|frame| frame.at) else { return Ok(Next::On) };
        let (first, last) = self.contour_blocks(command, at)?;
        if first <= at && at <= last {
            return Err(self.lathe_stop(Stop::unnamed("a cycle between the blocks of its own contour")));
        }
        // After a finishing the run goes on with the next block, wherever the contour stands (F3).
        let passed_over = at < first && op != Op::Finish;
        if passed_over {
            self.nothing_between(at + 1, first)?;
        }
        let here = self.session.trace.at;
        let contour = self.read_contour(op, first, last)?;
        self.session.trace.at = here;
        let (machine, trace) = (&mut self.session.machine, &mut self.session.trace);
        let done = machine.cut_contour(op, command, &contour, trace);
        done.map_err(|stop| self.lathe_stop(stop))?;
        Ok(if passed_over { Next::At(last + 1) } else { Next::On })
    }

    /// The alarm of a lathe, with its number on the controls that have those.
    pub fn lathe_stop(&self, mut stop: Stop) -> Halt {
        if !self.style.numbers_lathe_alarms && self.session.machine.is_lathe() {
            stop.number.clear();
        }
        Halt::Alarm(stop)
    }

    /// The first and the last block for a cycle at a block: the numbers are looked for from the start of the program (R3). One that stands
    /// more than once is the first, if a search from the cycle on finds that too.
    fn contour_blocks(&self, command: &Command, at: usize) -> Result<(usize, usize), Halt> {
        let alarm = |number: &str, text: String| self.lathe_stop(Stop::alarm(number, text));
        let place = |role: Role| {
            let number = command.number(role);
            let number = number.ok_or_else(|| alarm("PS0061", "a cycle without P or Q".into()))?;
            let labels = self.frames.last().and_then(|frame| frame.program.code.labels.get(&number));
            match labels.map(Vec::as_slice) {
                Some([one]) => Ok(*one),
                Some(all @ [first, ..])
                    if all.iter().find(|one| **one > at).is_none_or(|one| one == first) =>
                {
                    Ok(*first)
                }
                Some([_, ..]) => {
                    let text = format!("N{number} stands in the program more than once");
                    Err(self.lathe_stop(Stop::unnamed(text)))
                }
                _ => Err(alarm("PS0063", format!("N{number} of a contour is not in the program"))),
            }
        };
        let (first, last) = (place(Role::ContourFirst)?, place(Role::ContourLast)?);
        match first <= last {
            true => Ok((first, last)),
            false => Err(alarm("PS0063", "the last block of a contour stands before its first".into())),
        }
    }

    /// Between a cycle and its contour after it nothing may stand that would be passed over (K12).
    fn nothing_between(&mut self, from: usize, to: usize) -> Result<(), Halt> {
        for at in from..to {
            if self.with_block(at, |_, block| Ok(!block.steps.is_empty()))? {
                let text = "a block between a cycle and its contour, which is passed over";
                return Err(self.lathe_stop(Stop::unnamed(text)));
            }
        }
        Ok(())
    }

    /// Reads the blocks; what their words leave in force counts only where the contour is finished.
    fn read_contour(&mut self, op: Op, first: usize, last: usize) -> Result<Contour, Halt> {
        let kept = (self.modal, self.cycle, self.addresses);
        let outer = self.contour.replace(Contour::default());
        let done = (first..=last).try_for_each(|at| self.with_block(at, Self::contour_block));
        let contour = std::mem::replace(&mut self.contour, outer).unwrap_or_default();
        (self.modal, self.cycle) = (kept.0, kept.1);
        if op != Op::Finish {
            self.addresses = kept.2;
        }
        done.map(|()| contour)
    }

    /// Does something with a block of the running program.
    fn with_block<T: Default>(
        &mut self,
        at: usize,
        what: impl FnOnce(&mut Self, &Block) -> Result<T, Halt>,
    ) -> Result<T, Halt> {
        let Some(frame) = self.frames.last() else { return Ok(T::default()) };
        let Loaded { code, .. } = frame.program;
        match code.find(at) {
            Some(At::Held(block)) => what(self, block),
            Some(At::Made(part, place)) => {
                let section = self.section();
                let made = self.part(section, code, part);
                made.get(place).map_or(Ok(T::default()), |block| what(self, block))
            }
            None => Ok(T::default()),
        }
    }

    fn contour_block(&mut self, block: &Block) -> Result<(), Halt> {
        let program = self.frames.last().map_or(0, |frame| frame.program.number);
        self.session.trace.at = Place { program, span: block.span };
        self.session.count()?;
        block.facts.iter().for_each(|fact| self.session.trace.doubt(fact));
        self.contour_steps(&block.steps)
    }

    fn contour_steps(&mut self, steps: &[Step]) -> Result<(), Halt> {
        for step in steps {
            match step {
                Step::Words(words) => {
                    self.words(words)?;
                }
                Step::Skip { level, before } => {
                    if self.session.skips(Some(*level)) {
                        return self.contour_steps(before);
                    }
                }
                Step::Alarm(stop) => return Err(Halt::Alarm(stop.clone())),
                Step::Unreadable(text) => return Err(Halt::Error(text.clone())),
                _ => {
                    let text = "a statement between the blocks of a contour";
                    return Err(self.lathe_stop(Stop::unnamed(text)));
                }
            }
        }
        Ok(())
    }

    /// Calls, returns and ends have no place in a contour (R7).
    pub fn refuse_flow(&self, meaning: &Meaning) -> Result<(), Halt> {
        match self.contour.is_some() && self.goes_elsewhere(meaning) {
            true => {
                Err(self
                    .lathe_stop(Stop::alarm("PS0210", "a call or a return between the blocks of a contour")))
            }
            false => Ok(()),
        }
    }

    /// True for a block with a call, a return or an end.
    pub fn goes_elsewhere(&self, meaning: &Meaning) -> bool {
        let flows = |code: &Coded| self.row(code.row).is_some_and(|row| row.op.is_flow());
        meaning.codes.iter().any(|code| code.alias.is_some() || flows(code))
    }

    /// Keeps the words of a block for the contour that is being read.
    pub fn keep_contoured(&mut self) -> bool {
        let (at, command) = (self.session.trace.at, &mut self.command);
        let Some(contour) = &mut self.contour else { return false };
        contour.blocks.push(Contoured { at, command: command.clone() });
        command.clear();
        true
    }
}
