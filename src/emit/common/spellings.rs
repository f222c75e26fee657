//! The spellings of a control, gathered once a library so that no word looks them up.

use crate::canon::{Func, Op, Role};
use crate::dialect::{CodeMeaning, Control, Function, Question};
use crate::ir::{BinOp, Relation};
use smallvec::SmallVec;
use std::collections::BTreeMap;

/// A code as it is written.
pub(in crate::emit) struct Code<'c> {
    /// The code with the constant words that select it: `G1`, `G10 L2`.
    pub text: String,
    /// What the table says of it.
    pub row: &'c CodeMeaning,
    /// Letters with a role of their own beside it, and whether a comma stands before them.
    pub words: Vec<((char, bool), Role)>,
    /// True where other words beside it make another operation of it.
    pub shared: bool,
}

/// A binary operator as it is written.
#[derive(Clone, Copy, Default)]
pub(in crate::emit) struct Operator<'c> {
    /// Its spelling; empty where the control lacks it.
    pub text: &'c str,
    /// Its rank from 1; 0 if nobody says for sure how tight it binds.
    pub rank: u32,
}

/// The spellings of a control.
pub(in crate::emit) struct Spellings<'c> {
    control: &'c Control,
    codes: Vec<Code<'c>>,
    /// For each operation: the codes that do it.
    by_op: Vec<SmallVec<[usize; 2]>>,
    /// For each operation: how its code is found.
    ops: Vec<Choice>,
    /// For each role: its usual letter, or the one that all codes that have it agree on.
    letters: Vec<Letter>,
    functions: Vec<[Option<&'c Function>; 2]>,
    /// Most brackets inside one another.
    pub brackets: Option<u32>,
    /// True where ROUND in a word rounds to the word's increment.
    pub round_is_increment: bool,
    /// Most M codes of a block; one if nobody says.
    pub m_codes: usize,
    arithmetic: [Operator<'c>; 8],
    relations: [Operator<'c>; 6],
}

/// How the code of an operation is found.
#[derive(Clone, Copy, PartialEq)]
enum Choice {
    None,
    /// Always this one.
    Code(usize),
    /// It depends on the operands.
    Operands,
}

#[derive(Clone, Copy, Default)]
struct Letter {
    usual: Option<(char, bool)>,
    beside: Option<(char, bool)>,
    shifted: bool,
    literal_only: bool,
    /// True where every code that has the role counts increments in it.
    counted: bool,
}

/// What is known of an operand when the code is chosen.
#[derive(Clone, Copy)]
pub(in crate::emit) enum Operand {
    /// No word has the role.
    None,
    /// It is this number.
    Constant(f64),
    /// It is computed, and this number is added last.
    Computed(f64),
}

impl<'c> Spellings<'c> {
    /// Gathers the spellings.
    pub fn of(control: &'c Control) -> Self {
        let codes: Vec<Code> = (control.dialect().codes.iter())
            .filter(|row| row.preferred)
            .filter_map(|row| {
                Some(Code { text: spelling(row)?, row, words: beside(row), shared: shared(row, control) })
            })
            .collect();
        let mut by_op = vec![SmallVec::new(); Op::ALL.len()];
        for (at, code) in codes.iter().enumerate() {
            for &op in std::iter::once(&code.row.op).chain(&code.row.also) {
                by_op[op as usize].push(at);
            }
        }
        let beside = beside_letters(&codes);
        let functions = Func::ALL.iter().map(|&f| [control.function(f, 1), control.function(f, 2)]).collect();
        let mut all = Self {
            control,
            codes,
            by_op,
            ops: vec![Choice::None; Op::ALL.len()],
            letters: vec![Letter::default(); Role::ALL.len()],
            functions,
            brackets: control.limit("brackets"),
            round_is_increment: control
                .behaviour(Question::RoundInAddress)
                .is_some_and(|b| b.value == "increment"),
            m_codes: match control.behaviour(Question::MCodesPerBlock).map(|row| row.value.as_str()) {
                Some("any") => usize::MAX,
                Some("3") => 3,
                _ => 1,
            },
            arithmetic: ARITHMETIC.map(|meaning| operator(control, meaning)),
            relations: RELATIONS.map(|meaning| operator(control, meaning)),
        };
        for &op in Op::ALL {
            all.ops[op as usize] = all.choice(op);
        }
        for &role in Role::ALL {
            let usual = control.letter(role, None);
            let row = usual.and_then(|(letter, comma)| control.word(letter, comma));
            all.letters[role as usize] = Letter {
                usual,
                beside: beside[role as usize],
                shifted: row.is_some_and(|row| row.shift.contains_key(&role)),
                literal_only: row.is_some_and(|row| !row.expression),
                counted: counted(&all.codes, role),
            };
        }
        all
    }

    fn choice(&self, op: Op) -> Choice {
        if self.rows(op).any(|code| !code.row.fixed.is_empty() || !code.row.shift.is_empty()) {
            return Choice::Operands;
        }
        let found = self.control.code_for(op, &BTreeMap::new());
        found.and_then(|row| self.index(row)).map_or(Choice::None, Choice::Code)
    }

    fn rows(&self, op: Op) -> impl Iterator<Item = &Code<'c>> {
        self.by_op.get(op as usize).into_iter().flatten().filter_map(|&at| self.codes.get(at))
    }

    fn index(&self, row: &CodeMeaning) -> Option<usize> {
        self.codes.iter().position(|code| std::ptr::eq(code.row, row))
    }

    /// The code of an operation, given the words beside it.
    pub fn code(&self, op: Op, operand: impl Fn(Role) -> Operand) -> Option<&Code<'c>> {
        match self.ops.get(op as usize)? {
            Choice::None => None,
            Choice::Code(at) => self.codes.get(*at),
            Choice::Operands => {
                let mut operands = BTreeMap::new();
                let rows = || self.rows(op).map(|code| code.row);
                for &role in rows().flat_map(|row| row.fixed.keys().chain(row.shift.keys())) {
                    match operand(role) {
                        Operand::None => {}
                        Operand::Constant(value) => drop(operands.insert(role, value)),
                        Operand::Computed(add) => {
                            return self
                                .rows(op)
                                .find(|code| code.row.fixed.is_empty() && code.adds(role, add));
                        }
                    }
                }
                self.codes.get(self.index(self.control.code_for(op, &operands)?)?)
            }
        }
    }

    /// The code of an operation that no word selects.
    pub fn bare_code(&self, op: Op) -> Option<&Code<'c>> {
        self.code(op, |_| Operand::None)
    }

    /// The letter of a role in a block with these codes, and the code that gives it.
    pub fn letter<'s>(
        &self,
        role: Role,
        codes: &[&'s Code<'c>],
    ) -> Option<((char, bool), Option<&'s Code<'c>>)> {
        let Letter { usual, beside, .. } = *self.letters.get(role as usize)?;
        for code in codes {
            let mut letters = code.words.iter().filter(|(_, r)| *r == role).map(|(letter, _)| *letter);
            let Some(first) = letters.next() else { continue };
            // Of several letters the usual one.
            let usual = usual.filter(|usual| *usual == first || letters.clone().any(|l| l == *usual));
            return Some((usual.unwrap_or(first), Some(code)));
        }
        let taken = |letter: &(char, bool)| codes.iter().any(|c| c.words.iter().any(|(l, _)| l == letter));
        usual.or(beside).filter(|letter| !taken(letter)).map(|letter| (letter, None))
    }

    /// A function with so many arguments.
    pub fn function(&self, function: Func, arguments: usize) -> Option<&'c Function> {
        *self.functions.get(function as usize)?.get(arguments.checked_sub(1)?)?
    }

    /// True where the numbers of a role are not those of the common vocabulary.
    pub fn is_shifted(&self, role: Role, code: Option<&Code>) -> bool {
        code.is_some_and(|code| code.row.shift.contains_key(&role))
            || self.letters.get(role as usize).is_some_and(|letter| letter.shifted)
    }

    /// True where the letter of a role takes constants only.
    pub fn is_literal_only(&self, role: Role) -> bool {
        self.letters.get(role as usize).is_some_and(|letter| letter.literal_only)
    }

    /// True where the role counts least increments beside each code that has it.
    pub fn is_counted(&self, role: Role) -> bool {
        self.letters.get(role as usize).is_some_and(|letter| letter.counted)
    }

    /// An arithmetic operator.
    pub fn binary(&self, op: BinOp) -> Operator<'c> {
        self.arithmetic.get(op as usize).copied().unwrap_or_default()
    }

    /// A comparison.
    pub fn relation(&self, relation: Relation) -> Operator<'c> {
        self.relations.get(relation as usize).copied().unwrap_or_default()
    }
}

impl Code<'_> {
    /// True where the common numbers of a role are those written and `add`.
    pub fn adds(&self, role: Role, add: f64) -> bool {
        self.row.shift.get(&role).is_some_and(|shifts| shifts.iter().any(|shift| shift.add as f64 == add))
    }

    /// True for an M code.
    pub fn is_m(&self) -> bool {
        self.text.starts_with('M')
    }
}

fn counted(codes: &[Code], role: Role) -> bool {
    let words = codes.iter().flat_map(|code| code.words.iter().map(move |word| (code, word)));
    let mut counts = words
        .filter(|(_, (_, found))| *found == role)
        .map(|(code, ((letter, _), _))| code.row.counts.contains(letter))
        .peekable();
    counts.peek().is_some() && counts.all(|counts| counts)
}

/// The meanings of [`BinOp`], in its order.
const ARITHMETIC: [&str; 8] =
    ["add", "subtract", "multiply", "divide", "modulo", "and.bits", "or.bits", "xor.bits"];

/// The meanings of [`Relation`], in its order.
const RELATIONS: [&str; 6] = ["eq", "ne", "lt", "le", "gt", "ge"];

fn operator<'c>(control: &'c Control, meaning: &str) -> Operator<'c> {
    let row = control.operator(meaning);
    row.map_or(Operator::default(), |row| Operator {
        text: &row.spelling,
        rank: if row.origin.is_settled() { row.rank.saturating_add(1) } else { 0 },
    })
}

/// For each role, the letter that all codes that have it agree on.
fn beside_letters(codes: &[Code]) -> Vec<Option<(char, bool)>> {
    let mut letters: Vec<SmallVec<[(char, bool); 2]>> = vec![SmallVec::new(); Role::ALL.len()];
    for (letter, role) in codes.iter().flat_map(|code| &code.words) {
        let known = &mut letters[*role as usize];
        if !known.contains(letter) {
            known.push(*letter);
        }
    }
    let only = |known: &SmallVec<[(char, bool); 2]>| match known.as_slice() {
        [only] => Some(*only),
        _ => None,
    };
    letters.iter().map(only).collect()
}

fn shared(row: &CodeMeaning, control: &Control) -> bool {
    row.head().is_some_and(|head| control.rows_of(head).any(|other| other.op != row.op))
}

/// The code and the constant words beside it; a word with any value is written as a word.
fn spelling(row: &CodeMeaning) -> Option<String> {
    let mut words = row.code.split(' ');
    let mut text = words.next()?.to_owned();
    for word in words.filter(|word| word.len() > 1) {
        text.push(' ');
        text.push_str(word);
    }
    Some(text)
}

fn beside(row: &CodeMeaning) -> Vec<((char, bool), Role)> {
    let letter = |written: &str| {
        let (letter, comma) = written.strip_prefix(',').map_or((written, false), |rest| (rest, true));
        Some((letter.chars().next()?, comma))
    };
    row.words.iter().filter_map(|(written, role)| Some((letter(written)?, *role))).collect()
}
