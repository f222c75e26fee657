//! Branches and loops.

use super::Writer;
use crate::generate::{Kind, Source, Step, Test};

impl Writer<'_> {
    pub(super) fn branch(
        &mut self,
        test: &Test,
        then: &[Step],
        otherwise: &[Step],
        choices: &mut Source<'_>,
    ) {
        let gap = self.gap;
        if let ([Step { kind: Kind::Set { slot, value }, .. }], [], true) =
            (then, otherwise, choices.one_in(2))
        {
            let (test, value) = (self.test(test), self.value(value, 0));
            let name = self.name(*slot);
            let word = if self.haas && choices.one_in(3) { "" } else { "THEN" };
            return self.line(&format!("IF{gap}{test}{gap}{word} {name}{gap}={gap}{value}"));
        }
        let word = if self.haas && choices.one_in(4) { "" } else { "IF" };
        let end = self.labels(2);
        if otherwise.is_empty() && choices.one_in(2) {
            let line = format!("{word}{gap}{}{gap}GOTO{gap}{end}", self.test(&test.opposite()));
            self.line(&line);
            self.steps(then);
        } else {
            let line = format!("{word}{gap}{}{gap}GOTO{gap}{}", self.test(test), end + 10);
            self.line(&line);
            self.steps(otherwise);
            self.line(&format!("GOTO{gap}{end}"));
            self.line(&format!("N{}", end + 10));
            self.steps(then);
        }
        self.line(&format!("N{end}"));
    }

    pub(super) fn repeat(&mut self, counter: usize, times: u32, body: &[Step], choices: &mut Source<'_>) {
        let (gap, name) = (self.gap, self.name(counter));
        let label = self.labels(2);
        let end = label + 10;
        self.ends.push(end);
        match choices.below(4) {
            0 => {
                self.line(&format!("{name}={times}"));
                self.line(&format!("N{label}"));
                self.steps(body);
                self.line(&format!("{name}={name}-1"));
                self.line(&format!("IF{gap}[{name}{gap}GT{gap}0]{gap}GOTO{gap}{label}"));
            }
            1 if self.loops < 3 => {
                self.loops += 1;
                let number = self.loops;
                self.line(&format!("{name}=0"));
                self.line(&format!("DO{number}"));
                self.line(&format!("IF{gap}[{name}{gap}GE{gap}{times}]{gap}GOTO{gap}{end}"));
                self.steps(body);
                self.line(&format!("{name}={name}+1"));
                self.line(&format!("END{number}"));
                self.loops -= 1;
            }
            _ if self.loops < 3 => {
                self.loops += 1;
                let number = self.loops;
                self.line(&format!("{name}=0"));
                self.line(&format!("WHILE{gap}[{name}{gap}LT{gap}{times}]{gap}DO{number}"));
                self.steps(body);
                self.line(&format!("{name}={name}+1"));
                self.line(&format!("END{number}"));
                self.loops -= 1;
            }
            _ => {
                self.line(&format!("{name}=0"));
                self.line(&format!("N{label} IF{gap}[{name}{gap}GE{gap}{times}]{gap}GOTO{gap}{end}"));
                self.steps(body);
                self.line(&format!("{name}={name}+1"));
                self.line(&format!("GOTO{gap}{label}"));
            }
        }
        self.ends.pop();
        self.line(&format!("N{end}"));
    }

    pub(super) fn switch(&mut self, on: usize, arms: &[Vec<Step>], choices: &mut Source<'_>) {
        let (gap, name) = (self.gap, self.name(on));
        let many = arms.len() as u32;
        let first = self.labels(many + 1);
        let end = first + 10 * many;
        let computed = choices.below(3);
        if computed == 0 {
            for at in 1..many {
                self.line(&format!("IF{gap}[{name}{gap}EQ{gap}{at}]{gap}GOTO{gap}{}", first + 10 * at));
            }
        } else {
            self.line(&format!("#119={gap}ROUND[{name}]"));
            self.line(&format!("IF{gap}[#119{gap}LT{gap}0]{gap}GOTO{gap}{first}"));
            self.line(&format!("IF{gap}[#119{gap}GE{gap}{many}]{gap}GOTO{gap}{first}"));
            if computed == 1 {
                self.line(&format!("GOTO[{first}+#119*10]"));
            } else {
                self.line(&format!("#119={first}+#119*10"));
                self.line("GOTO#119");
            }
        }
        self.arms(arms, first, end);
    }

    /// The ways of a computed jump: ten numbers apart from the first, each goes on at the end.
    pub(super) fn arms(&mut self, arms: &[Vec<Step>], first: u32, end: u32) {
        let gap = self.gap;
        for (at, arm) in arms.iter().enumerate() {
            self.line(&format!("N{}", first + 10 * at as u32));
            self.steps(arm);
            if at + 1 < arms.len() {
                self.line(&format!("GOTO{gap}{end}"));
            }
        }
        self.line(&format!("N{end}"));
    }
}
