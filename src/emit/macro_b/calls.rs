//! Calls: G65, G66, M98 and M97 as the target's table spells them.

use super::Emitter;
use super::expressions::Place;
use crate::canon::{Op, Role};
use crate::diag::Code;
use crate::dialect::{BareLength, Question};
use crate::ir::{Argument, Call, Callee, Expr};

/// The letters that stand for locals 4 to 33 when arguments go by place.
const BY_PLACE: [char; 3] = ['I', 'J', 'K'];

impl Emitter<'_> {
    /// Writes a call that happens once.
    pub(super) fn call_once(&mut self, call: &Call) {
        let op = match (&call.callee, call.level) {
            (Callee::Block(_), false) if self.out.has_statement("call.local") => Op::CallLocal,
            (Callee::Program(_) | Callee::Computed(_), false) => Op::CallProgram,
            (Callee::Program(_) | Callee::Computed(_), true) => Op::CallMacro,
            _ => return self.out.unmapped("a call of that kind"),
        };
        self.call_by(op, call);
    }

    /// Writes a call by this code.
    pub(super) fn call_by(&mut self, op: Op, call: &Call) {
        let spellings = self.spellings;
        let Some(code) = spellings.bare_code(op) else {
            return self.out.unmapped(format_args!("the operation '{op}'"));
        };
        self.out.word(&code.text);
        let codes = [code];
        let role = if op == Op::CallLocal { Role::Sequence } else { Role::Program };
        let Some(((letter, _), _)) = spellings.letter(role, &codes) else {
            return self.out.unmapped(format_args!("what '{op}' calls"));
        };
        self.out.space();
        self.out.push(letter);
        self.callee(&call.callee);
        if let Some(count) = &call.count {
            // A macro call's count has no such range.
            let most = self.control.limit("repeat").map_or(f64::INFINITY, f64::from);
            if !call.level && count.constant().is_some_and(|count| count > most) {
                self.out.refuse(Code::Unmapped, format!("a call runs 1 to {most} times here: write a loop"));
            }
            match spellings.letter(Role::CallCount, &codes) {
                Some(((letter, _), _)) => {
                    self.out.space();
                    self.out.push(letter);
                    self.word_value(Role::CallCount, count);
                }
                None => self.out.unmapped("how often a call is repeated"),
            }
        }
        if !call.arguments.is_empty() {
            if call.level {
                self.arguments(&call.arguments);
            } else {
                self.out.unmapped("arguments of a call that opens no level of locals");
            }
        }
    }

    fn callee(&mut self, callee: &Callee) {
        match callee {
            Callee::Program(name) => match self.names.program(name) {
                Some(number) if (1..=self.control.text().program_max).contains(&number) => {
                    self.out.integer(number);
                }
                _ => self.out.unmapped(format_args!("the name of the program, {name}")),
            },
            Callee::Block(entry) => self.sequence_of(*entry),
            Callee::Computed(value) => self.word_value(Role::Program, value),
            Callee::Cycle(number) => self.out.unmapped(format_args!("cycle {number} of the maker")),
        }
    }

    /// Writes the arguments: each by the letter of its local where all have one, else by place.
    fn arguments(&mut self, arguments: &[Argument]) {
        let mut last: Vec<&Argument> = Vec::with_capacity(arguments.len());
        for argument in arguments {
            // Of two for one local the later counts; the earlier is left out only where leaving
            // it out cannot be told.
            if let Some(at) = last.iter().position(|other| other.local == argument.local) {
                if !matches!(last[at].value, Expr::Number(_) | Expr::Var(_) | Expr::Vacant) {
                    self.out.unmapped("two arguments for one local");
                }
                last.remove(at);
            }
            last.push(argument);
        }
        last.retain(|argument| argument.value != Expr::Vacant);
        let control = self.control;
        let letters: Option<Vec<char>> =
            last.iter().map(|argument| control.argument_letter(argument.local)).collect();
        match letters {
            Some(letters) => {
                let mut all: Vec<_> = letters.into_iter().zip(last).collect();
                in_order(&mut all);
                for (letter, argument) in all {
                    self.argument(letter, &argument.value);
                }
            }
            None => self.arguments_by_place(last),
        }
    }

    /// A B C set locals 1 to 3, and each I, J or K the next local of its column.
    fn arguments_by_place(&mut self, mut arguments: Vec<&Argument>) {
        arguments.sort_by_key(|argument| argument.local);
        let control = self.control;
        let letter = |local: u32| match local {
            1..=3 => control.argument_letter(local),
            4..=33 => BY_PLACE.get((local as usize - 4) % 3).copied(),
            _ => None,
        };
        let letters: Vec<(char, u32)> =
            arguments.iter().filter_map(|argument| Some((letter(argument.local)?, argument.local))).collect();
        if letters.len() < arguments.len() || !self.goes_by_place(&letters) {
            return match arguments.iter().find(|a| control.argument_letter(a.local).is_none()) {
                Some(a) => self.out.unmapped(format_args!("an argument for #{} in this list", a.local)),
                None => self.out.unmapped("these arguments in one list"),
            };
        }
        for ((letter, _), argument) in letters.iter().zip(arguments) {
            self.argument(*letter, &argument.value);
        }
    }

    /// True where the control reads the I, J and K of this list, sorted by locals, as setting these locals.
    fn goes_by_place(&self, letters: &[(char, u32)]) -> bool {
        let answer = |name| self.control.behaviour(name).map_or("", |row| row.value.as_str());
        let sets: Vec<(char, u32)> = letters.iter().filter(|(_, local)| *local > 3).copied().collect();
        // From one column to the next there are at most three steps.
        let steps = std::iter::once(3).chain(sets.iter().map(|(_, local)| *local));
        let close = steps.zip(&sets).all(|(before, (_, local))| local - before <= 3);
        let earlier = |at: usize, letter| sets.iter().take(at).filter(|(other, _)| *other == letter).count();
        let twice = sets.iter().enumerate().any(|(at, (letter, _))| earlier(at, *letter) > 0);
        let counted =
            |(at, (letter, local)): (usize, &(char, u32))| earlier(at, *letter) == (*local as usize - 4) / 3;
        let order = answer(Question::ArgumentsOrderIjk);
        let by_place = order == "true" || order == "repeated" && twice;
        let in_sets = match answer(Question::ArgumentsRepeatedOrder) {
            "place" => close,
            "count" => sets.iter().enumerate().all(counted),
            _ => close && sets.iter().enumerate().all(counted),
        };
        by_place && in_sets
    }

    fn argument(&mut self, letter: char, value: &Expr) {
        self.out.space();
        self.out.push(letter);
        self.place = Place::Whole;
        match value {
            Expr::Number(number) => self.out.number(*number, true),
            Expr::Increments(count) => self.bare_argument(letter, *count),
            Expr::Negate(inner) => match &**inner {
                Expr::Number(number) => self.out.number(-number, true),
                Expr::Increments(count) => self.bare_argument(letter, -count),
                inner => {
                    self.out.push('-');
                    self.behind_letter(inner);
                }
            },
            value => self.behind_letter(value),
        }
        self.place = Place::Statement;
    }

    fn bare_argument(&mut self, letter: char, count: f64) {
        if self.control.bare_argument(letter) == BareLength::Increments && count.fract() == 0.0 {
            self.out.number(count, false);
        } else {
            self.out.unmapped(format_args!("a count of increments in the argument {letter}"));
        }
    }
}

/// Puts I, J and K in this order without moving the others: out of order they go by place.
fn in_order(arguments: &mut [(char, &Argument)]) {
    let places: Vec<usize> = (0..arguments.len()).filter(|&at| BY_PLACE.contains(&arguments[at].0)).collect();
    let mut sorted: Vec<(char, &Argument)> = places.iter().map(|&at| arguments[at]).collect();
    sorted.sort_by_key(|(letter, _)| *letter);
    places.into_iter().zip(sorted).for_each(|(at, argument)| arguments[at] = argument);
}
