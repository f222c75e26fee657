//! Calls, returns and ends: L words, M98, G66, M17, M99, M2, M30.

use crate::CHECKED;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BinOp, BlockId, Call, Callee, Cond, Expr, Place, Relation, SourceInfo, StmtKind, TermKind};
use crate::lower::common::otherwise;
use crate::lower::fadal::build::Lowering;
use crate::lower::fadal::codes::{Codes, FIRST_FIXED, Step, operand, program_number};
use crate::lower::fadal::flow::{Flow, Goal, return_goal};
use crate::syntax::{self, Item, ProgramName};
use crate::text::Span;

fn call(callee: Callee, count: Option<Expr>) -> Call {
    Call { callee, level: false, arguments: Vec::new(), count }
}

impl<'b> Lowering<'b> {
    /// What a block's words do to the flow, when the rest of the block is done.
    pub fn step(
        &mut self,
        step: Step<'b>,
        items: &'b [Item],
        codes: &Codes<'b, 'b>,
        span: Span,
    ) -> Option<()> {
        match step {
            Step::Define(number) => self.definition(number, span)?,
            Step::Local(value) => self.local(value, codes, span)?,
            Step::Program => {
                let Some(program) = operand(items, codes, Role::Program) else {
                    return self.refuse(span, "M98 needs the program number in P");
                };
                let callee = match program_number(program) {
                    Some(number) => Callee::Program(ProgramName::Number(number)),
                    None => Callee::Computed(self.nc_value(program, Some(Role::Program))?),
                };
                let count = match operand(items, codes, Role::CallCount) {
                    Some(count) => Some(self.nc_value(count, Some(Role::CallCount))?),
                    None => None,
                };
                let may_be_none =
                    count.as_ref().is_some_and(|count| count.constant().is_none_or(|n| n == 0.0));
                let once = self.control.behaviour(Question::RepeatZero).filter(|row| row.value == "once");
                if may_be_none && once.is_some() {
                    self.findings.not_understood(span, otherwise(Question::RepeatZero, "once"));
                }
                self.call_then(call(callee, count));
            }
            Step::ModalOff => {
                if self.state.modal == 0 && !self.state.in_modal {
                    let what = "no modal call begins before this block: this can end only a modal call of \
                                a caller";
                    self.findings.add(Diagnostic::new(Code::ModalCallNotOpen, span, what));
                }
                self.push(StmtKind::ModalCallOff);
            }
            Step::SubEnd => {
                if self.shape.region(self.at).is_none() {
                    let message = "M17 outside a subroutine";
                    self.once(Code::SubroutineLeft, "end", span, message.into());
                }
                self.end(TermKind::Return { to: None });
            }
            Step::Return => self.back(items, codes, span)?,
            Step::End => self.end(TermKind::End { rewind: false }),
            Step::AreaEnd if self.shape.area_end == Some(self.at) => {}
            Step::AreaEnd => {
                self.suppose(Question::EndAlone, "true", span);
                self.end(TermKind::End { rewind: true });
            }
        }
        Some(())
    }

    fn definition(&mut self, number: u32, span: Span) -> Option<()> {
        let Some(here) = self.shape.begins(self.at) else {
            let message = format!(
                "L{number}00 defines a subroutine, but it is not alone in its block at the head of the \
                 program"
            );
            return self.refuse(span, message);
        };
        if self.shape.sub(number) != Some(here) {
            return self.refuse(span, format!("the subroutine L{number}00 is defined twice"));
        }
        Some(())
    }

    fn call_then(&mut self, call: Call) {
        let mut site = self.take_site();
        site.skip = None;
        self.builder.end_then(site, |next| TermKind::Call { call: Box::new(call), next });
    }

    /// `M99`, `M99 P10`.
    fn back(&mut self, items: &'b [Item], codes: &Codes<'b, 'b>, span: Span) -> Option<()> {
        if self.shape.region(self.at).is_some() {
            let message = "M99 inside a subroutine: M17 ends it";
            self.once(Code::SubroutineLeft, "return", span, message.into());
        }
        let Some(to) = operand(items, codes, Role::Sequence) else {
            self.end(TermKind::Return { to: None });
            return Some(());
        };
        let called = self.shape.returns || self.shape.region(self.at).is_some();
        let question = if called { Question::M99PInCalled } else { Question::M99PJumpsHere };
        let here = self.rely(question, span) != Some("false");
        // One that no block has goes nowhere: not to the caller's, which no source says.
        if here && let Some(goal) = return_goal(items, codes) {
            let to = self.block_of(&goal, span);
            self.end(TermKind::Jump(to));
            return Some(());
        }
        let value = self.nc_value(to, Some(Role::Sequence))?;
        let targets = if here && value.constant().is_none() { self.all_sequences(span) } else { Vec::new() };
        self.end(match targets.is_empty() {
            true => TermKind::Return { to: Some(value) },
            false => TermKind::Computed { value: Box::new(value), targets: targets.into() },
        });
        Some(())
    }

    /// The blocks of the program that have a sequence number.
    fn all_sequences(&mut self, span: Span) -> Vec<(u32, BlockId)> {
        let numbers = self.shape.goals.keys().filter_map(|goal| match goal {
            Goal::Sequence(number) => Some(*number),
            Goal::Label(_) => None,
        });
        let mut numbers: Vec<u32> = numbers.collect();
        numbers.sort_unstable();
        numbers.into_iter().map(|number| (number, self.block_of(&Goal::Sequence(number), span))).collect()
    }

    /// `L101`, `L+R2`, and `L101 G66`.
    fn local(&mut self, value: &'b syntax::Expr, codes: &Codes<'b, 'b>, span: Span) -> Option<()> {
        let values = Flow::constants(value, &self.state);
        let known: Vec<f64> = values.list().iter().map(|bits| f64::from_bits(*bits)).collect();
        if let [number] = known.as_slice() {
            let (sub, count) = parts(*number);
            let callee = self.callee(*number, span)?;
            assert!(!CHECKED || sub < 100);
            let count = (count != 1).then(|| Expr::Number(f64::from(count)));
            if codes.has(Op::CallModal) {
                return self.modal(call(callee, count), span);
            }
            self.call_then(call(callee, count));
            return Some(());
        }
        if codes.has(Op::CallModal) {
            return self
                .refuse(span, "a modal call of a subroutine with a computed number: write the number");
        }
        let mut subs: Vec<u32> = known.iter().map(|number| parts(*number).0).collect();
        if values.is_any() {
            subs = self.shape.numbers.keys().copied().collect();
            self.say_open(&subs, span)?;
        }
        subs.sort_unstable();
        subs.dedup();
        for number in &known {
            self.callee(*number, span)?;
        }
        self.choose(value, &subs, values.is_any())
    }

    /// Says that nothing bounds which of the subroutines is called; refuses where the program has none.
    fn say_open(&mut self, subs: &[u32], span: Span) -> Option<()> {
        if subs.is_empty() {
            return self.refuse(
                span,
                "the number of the called subroutine is computed, and the program has no subroutines of \
                 its own",
            );
        }
        let names: Vec<String> = subs.iter().map(|sub| format!("L{sub}01 to L{sub}99")).collect();
        let message = format!(
            "the number of the called subroutine is computed: it must be one of {}; at any other number \
             the target stops with an alarm",
            names.join(", ")
        );
        self.once(Code::Conditional, "open", span, message);
        Some(())
    }

    /// Calls the subroutine that a computed number names, out of those that it can be.
    fn choose(&mut self, value: &'b syntax::Expr, subs: &[u32], others: bool) -> Option<()> {
        let value = self.nc_value(value, None)?;
        let count = |value: Expr, sub: u32| {
            let base = Box::new(Expr::Number(f64::from(sub * 100)));
            Some(Expr::binary(BinOp::Sub, value, *base))
        };
        if let ([number], false) = (subs, others) {
            let callee = self.callee(f64::from(number * 100 + 1), Span::default())?;
            self.call_then(call(callee, count(value, *number)));
            return Some(());
        }
        let temp = self.temp();
        self.assign(Place::Var(temp), value);
        let after = self.builder.fresh();
        for (at, number) in subs.iter().enumerate() {
            let Some(place) = self.shape.sub(*number) else { continue };
            let entry = self.shape.subs.get(place).map_or(0, |sub| sub.blocks.start);
            let entry = self.entry(entry);
            let call = call(Callee::Block(entry), count(Expr::Var(temp), *number));
            if at + 1 == subs.len() && !others {
                self.end(TermKind::Call { call: Box::new(call), next: after });
                continue;
            }
            let (then, otherwise) = (self.builder.fresh(), self.builder.fresh());
            let bound = |relation, bound: u32| {
                Cond::Compare(relation, Expr::Var(temp), Expr::Number(f64::from(bound)))
            };
            let cond = Cond::And(vec![
                bound(Relation::GreaterEqual, number * 100 + 1),
                bound(Relation::Less, number * 100 + 100),
            ]);
            self.end(TermKind::Branch { cond: Box::new(cond), then, otherwise });
            self.builder.start(then);
            self.end(TermKind::Call { call: Box::new(call), next: after });
            self.builder.start(otherwise);
        }
        if others {
            let text = "NO SUCH SUBROUTINE".to_owned();
            self.push(StmtKind::Alarm { number: Expr::Number(1.0).into(), text: text.into() });
            self.builder.end(TermKind::End { rewind: false }, SourceInfo::default());
        }
        self.builder.start(after);
        Some(())
    }

    fn modal(&mut self, call: Call, span: Span) -> Option<()> {
        self.suppose(Question::CallModalBlockCalls, "false", span);
        if self.state.modal > 0 || self.state.in_modal {
            self.suppose(Question::CallModalNested, "", span);
        }
        self.push(StmtKind::ModalCall(Box::new(call)));
        Some(())
    }

    /// What a subroutine call with a known number goes to.
    fn callee(&mut self, number: f64, span: Span) -> Option<Callee> {
        let (sub, count) = parts(number);
        if !(100.0..10_000.0).contains(&number) || number.fract() != 0.0 || count == 0 {
            return self.refuse(
                span,
                format!(
                    "L{number} calls nothing: write the subroutine's number and two digits for the count"
                ),
            );
        }
        if let Some(place) = self.shape.sub(sub) {
            let start = self.shape.subs.get(place).map_or(0, |sub| sub.blocks.start);
            return Some(Callee::Block(self.entry(start)));
        }
        if sub >= FIRST_FIXED {
            let name = sub * 100 + 1;
            let message = format!("L{name} is a fixed subroutine that the maker keeps in the control");
            self.once(Code::FixedSubroutine, &name.to_string(), span, message);
            return Some(Callee::Cycle(name));
        }
        let missing = format!("L{sub}00");
        Some(Callee::Block(self.nowhere.block(missing, span, &mut self.builder, &mut self.findings)))
    }

    /// A call of a subroutine that the control keeps, with the words of its block as
    /// arguments, numbered by their letters (X is 24).
    pub fn fixed(&mut self, number: f64, arguments: Vec<crate::ir::Argument>, span: Span) -> Option<()> {
        let callee = self.callee(number, span)?;
        let (_, count) = parts(number);
        let count = (count != 1).then(|| Expr::Number(f64::from(count)));
        self.call_then(Call { callee, level: !arguments.is_empty(), arguments, count });
        Some(())
    }
}

/// The subroutine and the count that a call's number holds.
pub fn parts(number: f64) -> (u32, u32) {
    let whole = if (0.0..10_000.0).contains(&number) { number as u32 } else { 0 };
    (whole / 100, whole % 100)
}
