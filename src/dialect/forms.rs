//! What the places of a program take as operands, how much of a line they need, and the names that programs and
//! variables have.

use super::{Control, Origin, SameCells, SystemVariable, VariableClass};
use crate::canon::Sys;
use serde::{Deserialize, Serialize};

/// A place where an operand may stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OperandPlace {
    /// The value of a word.
    Word,
    /// The number of a computed code.
    Code,
    /// An argument of a call.
    Argument,
    /// The right side of an assignment to a variable.
    Assignment,
    /// What is written to state of the machine.
    State,
    /// The first operand of an operator.
    First,
    /// The second operand of an operator.
    Second,
    /// The argument of a function.
    Function,
    /// A variable's number, or a subscript.
    Subscript,
    /// A side of a comparison that a jump depends on.
    Condition,
    /// The condition before a statement in the same line.
    Then,
    /// The condition of a loop.
    Loop,
    /// Something printed.
    Output,
    /// A count, or the number of a program.
    Count,
    /// The target of a computed jump.
    Jump,
}

impl OperandPlace {
    /// All places.
    pub const ALL: [OperandPlace; 15] = [
        OperandPlace::Word,
        OperandPlace::Code,
        OperandPlace::Argument,
        OperandPlace::Assignment,
        OperandPlace::State,
        OperandPlace::First,
        OperandPlace::Second,
        OperandPlace::Function,
        OperandPlace::Subscript,
        OperandPlace::Condition,
        OperandPlace::Then,
        OperandPlace::Loop,
        OperandPlace::Output,
        OperandPlace::Count,
        OperandPlace::Jump,
    ];

    /// Its name in the tables.
    pub const fn name(self) -> &'static str {
        match self {
            OperandPlace::Word => "word",
            OperandPlace::Code => "code",
            OperandPlace::Argument => "argument",
            OperandPlace::Assignment => "assignment",
            OperandPlace::State => "state",
            OperandPlace::First => "first",
            OperandPlace::Second => "second",
            OperandPlace::Function => "function",
            OperandPlace::Subscript => "subscript",
            OperandPlace::Condition => "condition",
            OperandPlace::Then => "then",
            OperandPlace::Loop => "loop",
            OperandPlace::Output => "output",
            OperandPlace::Count => "count",
            OperandPlace::Jump => "jump",
        }
    }

    /// True for a place in a block of words, false for one in a macro statement.
    const fn is_of_words(self) -> bool {
        matches!(self, OperandPlace::Word | OperandPlace::Code | OperandPlace::Argument)
    }
}

/// What may stand as an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Operand {
    /// Anything that is computed.
    Expression,
    /// A variable by its number.
    Variable,
    /// A constant.
    Literal,
}

impl Operand {
    /// Its name in the tables.
    pub const fn name(self) -> &'static str {
        match self {
            Operand::Expression => "expression",
            Operand::Variable => "variable",
            Operand::Literal => "literal",
        }
    }
}

/// What a comparison is with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Compares {
    /// One operand with another, inside the statement that jumps.
    #[default]
    Two,
    /// One operand with 0: a register that is set before says its sign.
    Zero,
}

/// Where an operand stands in what is written.
const HOLE: &str = "{}";

/// What a place takes. A control has no place without a row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Form {
    /// The place.
    pub place: OperandPlace,
    /// What may stand there.
    pub takes: Vec<Operand>,
    /// The class of the variables that may; absent for all.
    pub class: Option<String>,
    /// False where constants and variables do not stand in one block.
    #[serde(default = "super::yes")]
    pub mixed: bool,
    /// What a comparison is with.
    #[serde(default)]
    pub compares: Compares,
    /// How it is written at its longest, `{}` for the operand.
    pub written: String,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

impl Form {
    /// True where such an operand may stand there.
    pub fn takes(&self, operand: Operand) -> bool {
        self.takes.contains(&operand)
    }

    /// True where no operand has to be computed before.
    pub fn takes_all(&self) -> bool {
        self.takes(Operand::Expression) && self.mixed && self.compares == Compares::Two
    }

    /// Characters of the line besides the operand.
    pub fn beside(&self) -> usize {
        self.written.chars().count().saturating_sub(HOLE.len())
    }

    /// Brackets that the operand stands in.
    pub fn brackets(&self) -> u32 {
        let before = self.written.split(HOLE).next().unwrap_or_default();
        before.chars().fold(0, |depth: u32, sign| match sign {
            '[' | '(' => depth + 1,
            ']' | ')' => depth.saturating_sub(1),
            _ => depth,
        })
    }

    /// What is wrong with the row.
    pub(super) fn fault(&self) -> Option<(&'static str, &'static str)> {
        if self.takes.is_empty() {
            return Some(("the place takes nothing", "leave the row out where there is no such place"));
        }
        if (0..self.takes.len()).any(|at| self.takes[..at].contains(&self.takes[at])) {
            return Some(("an operand stands twice", "name each operand once"));
        }
        if self.written.matches(HOLE).count() != 1 {
            return Some(("'written' has one place for the operand", "write {} for the operand"));
        }
        if !self.mixed && self.place != OperandPlace::Word {
            return Some(("only words stand in one block with others", "say 'mixed' of the place 'word'"));
        }
        let compares = matches!(self.place, OperandPlace::Condition);
        if self.compares != Compares::Two && !compares {
            return Some(("nothing is compared there", "say 'compares' of the place 'condition'"));
        }
        None
    }
}

/// What counts as the length of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LineCounts {
    /// All characters, block skip and sequence number too: also where no source says.
    #[default]
    Block,
    /// What stands behind block skip and sequence number.
    Statement,
}

/// The names that programs and variables have before their number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Names {
    /// Before the number of a program; absent where programs have none.
    pub program: Option<String>,
    /// True where the programs of a file stand between two lines of `%`.
    pub tape: bool,
    /// True where a program without a number begins after such a line.
    pub nameless: bool,
    /// The space in which the system's variables have numbers beside the free ones, so that one computed number reaches
    /// both; absent where there is none.
    pub numbered: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

impl Control {
    /// What a place takes; none where the control has no such place.
    pub fn form(&self, place: OperandPlace) -> Option<&Form> {
        self.dialect.forms.iter().find(|row| row.place == place)
    }

    /// The names of programs and variables.
    pub fn names(&self) -> &Names {
        &self.dialect.names
    }

    /// The name of the space in which the system's variables have numbers beside the free ones.
    pub fn numbered(&self) -> Option<&str> {
        self.dialect.names.numbered.as_deref()
    }

    /// What may stand before the number of a variable.
    pub fn prefixes(&self) -> Vec<&str> {
        self.numbered().into_iter().chain(self.classes().iter().map(|row| row.name.as_str())).collect()
    }

    /// The class of a free variable of that space.
    pub fn numbered_class(&self, number: u32) -> Option<&VariableClass> {
        self.variable_class(self.numbered()?, number)
    }

    /// The row of a number of that space which names the cell of another one.
    pub fn numbered_same(&self, number: u32) -> Option<&SameCells> {
        self.same_cells(self.numbered()?, number)
    }

    /// True for a variable of that space that the profile keeps for the shop.
    pub fn is_numbered_reserved(&self, number: u32) -> bool {
        self.numbered().is_some_and(|name| self.is_reserved(name, number))
    }

    /// What a variable of that space is, where it is the system's, with its subscripts.
    pub fn numbered_state(&self, number: u32) -> Option<(Sys, Vec<u32>, &SystemVariable)> {
        self.read_system(self.numbered()?, Some(number))
    }

    /// Characters that a line has at most for an operand and what is written beside it there; no end where none is known.
    pub fn room(&self, place: OperandPlace) -> usize {
        let text = self.text();
        let line = if place.is_of_words() { text.line } else { text.macro_line.or(text.line) };
        line.map_or(usize::MAX, |line| (line as usize).saturating_sub(self.head_of_line()))
    }

    /// Characters that stand before a block's own and count: a block skip with its level, a sequence number, a space.
    fn head_of_line(&self) -> usize {
        match self.text().line_counts {
            LineCounts::Block => "/1N ".len() + self.text().sequence_max.to_string().len(),
            LineCounts::Statement => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(place: OperandPlace, written: &str) -> Form {
        Form {
            place,
            takes: vec![Operand::Variable],
            class: None,
            mixed: true,
            compares: Compares::Two,
            written: written.into(),
            origin: Origin::default(),
        }
    }

    #[test]
    fn what_is_written_beside_an_operand_is_measured() {
        let condition = form(OperandPlace::Condition, "IF [{}] GOTO 99999");
        assert_eq!((condition.beside(), condition.brackets()), (16, 1));
        let subscript = form(OperandPlace::Subscript, "#[1000]=#[[{}]]");
        assert_eq!((subscript.beside(), subscript.brackets()), (13, 2));
    }

    #[test]
    fn rows_that_contradict_themselves_are_told() {
        assert!(form(OperandPlace::Word, "X{}").fault().is_none());
        assert!(form(OperandPlace::Word, "X").fault().is_some());
        assert!(Form { takes: vec![], ..form(OperandPlace::Word, "X{}") }.fault().is_some());
        assert!(Form { mixed: false, ..form(OperandPlace::Count, "L{}") }.fault().is_some());
        assert!(Form { compares: Compares::Zero, ..form(OperandPlace::Count, "L{}") }.fault().is_some());
        let twice = vec![Operand::Literal, Operand::Literal];
        assert!(Form { takes: twice, ..form(OperandPlace::Word, "X{}") }.fault().is_some());
    }
}
