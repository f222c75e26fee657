//! What the codes and words of an NC block mean: which code each letter belongs to.

use crate::canon::{Group, Op, Role};
use crate::dialect::{CodeHead, CodeMeaning, Control};
use crate::lower::common::{constant, letters};
use crate::syntax::{Expr, Item, ItemKind, Word};
use smallvec::SmallVec;

/// The codes of a block, looked up once.
#[derive(Debug)]
pub struct Codes<'b, 'c> {
    items: &'b [Item],
    /// The words with a code's letter, with their meaning; none if the table has no row.
    pub rows: Vec<(&'b Item, Option<&'c CodeMeaning>)>,
    letters: SmallVec<[(char, Option<f64>); 6]>,
    control: &'c Control,
}

/// True for a letter whose words are codes.
pub fn is_code(letter: char) -> bool {
    matches!(letter, 'G' | 'M')
}

impl<'b, 'c> Codes<'b, 'c> {
    /// Looks up the codes of a block's items.
    pub fn new(items: &'b [Item], control: &'c Control) -> Self {
        let mut letters = letters(items);
        // A variable that is set by its sign stands in the block like a word of its letter.
        let assigned = items.iter().filter_map(|item| match &item.kind {
            ItemKind::Assign { target, by_sign: true, .. } => target.name.chars().next(),
            _ => None,
        });
        letters.extend(assigned.map(|letter| (letter, None)));
        let rows = items
            .iter()
            .filter_map(|item| Some((item, word(item).filter(|word| is_code(word.letter))?)))
            .map(|(item, word)| {
                let number = word.value.as_ref().and_then(constant);
                (item, number.and_then(|number| control.code(word.letter, number, &letters)))
            })
            .collect();
        Self { items, rows, letters, control }
    }

    /// The codes with a meaning.
    pub fn known(&self) -> impl Iterator<Item = &'c CodeMeaning> + Clone + '_ {
        self.rows.iter().filter_map(|(_, row)| *row)
    }

    /// The meaning of the word that is this item, where it is a code.
    pub fn row(&self, item: &Item) -> Option<&'c CodeMeaning> {
        self.rows.iter().find(|(at, _)| std::ptr::eq(*at, item)).and_then(|(_, row)| *row)
    }

    /// True where the block has the operation.
    pub fn has(&self, op: Op) -> bool {
        self.known().any(|row| row.op == op)
    }

    /// True where a code of the block names a letter among its words.
    pub fn names(&self, letter: char, comma: bool) -> bool {
        let is_it = |written: &String| {
            written.starts_with(',') == comma && written.trim_start_matches(',').starts_with(letter)
        };
        self.known().any(|row| row.words.keys().any(is_it))
    }

    /// True for a letter whose value only picks the meaning of a code: L of `G10 L2`.
    pub fn selects(&self, letter: char) -> bool {
        let beside = self.known().filter_map(CodeMeaning::beside).flatten();
        beside.into_iter().any(|word| word.letter == letter && word.thousandths.is_some())
    }

    /// The constant that stands after a letter.
    pub fn number(&self, letter: char) -> Option<f64> {
        self.value(letter).and_then(constant)
    }

    /// What stands after a letter.
    pub fn value(&self, letter: char) -> Option<&'b Expr> {
        self.items.iter().filter_map(word).find(|word| word.letter == letter)?.value.as_ref()
    }

    /// The code that says how the block moves, where it has one.
    pub fn motion(&self) -> Option<&'c CodeMeaning> {
        let moves = |op: Op| {
            matches!(op.group(), Group::Motion | Group::Cycle)
                || matches!(op, Op::RapidOnce | Op::Probe | Op::ProbeOther)
        };
        // G1 G31: the probe move is what happens, feed is its mode.
        self.known().filter(|row| moves(row.op)).max_by_key(|row| row.op.group() == Group::OneShot)
    }

    /// The interpolation that the block sets, in thousandths.
    pub fn interpolation(&self) -> Option<u32> {
        self.last(|op| op.group() == Group::Motion && !op.is_cycle() && op != Op::CycleOff)
    }

    /// The drilling cycle that the block sets, in thousandths; 0 where it ends one.
    pub fn cycle(&self) -> Option<u32> {
        let code = self.last(|op| op.is_cycle() || op == Op::CycleOff)?;
        let ends = self.known().any(|row| row.op == Op::CycleOff && thousandths(row) == Some(code));
        Some(if ends { 0 } else { code })
    }

    fn last(&self, wanted: impl Fn(Op) -> bool) -> Option<u32> {
        let row = self.known().filter(|row| wanted(row.op)).last()?;
        thousandths(row)
    }

    /// True where the axis words belong to an operation that is no move of the motion mode.
    pub fn takes_axes(&self) -> bool {
        use Op::*;
        self.known().any(|row| {
            matches!(
                row.op,
                WriteWork
                    | WriteLength
                    | WriteRadius
                    | ReferenceReturn
                    | ReferenceFrom
                    | ReferenceCheck
                    | Reference2
                    | Home
                    | SetPosition
                    | LocalShift
                    | Pole
                    | MirrorOn
                    | RotateOn
                    | ScaleOn
                    | MachineSpecific
                    | Builder
            )
        })
    }

    /// The meaning of the motion mode with this code, beside the words of the block.
    pub fn modal(&self, thousandths: u32) -> Option<&'c CodeMeaning> {
        self.control.code('G', f64::from(thousandths) / 1000.0, &self.letters)
    }

    /// The role of a letter: beside the codes of the block, then beside the motion
    /// mode, then by itself. Two codes that disagree give an error.
    pub fn role(&self, letter: char, comma: bool, modal: Option<&CodeMeaning>) -> Result<Option<Role>, ()> {
        let by_itself = self.control.role(letter, comma, None);
        let special = |row: &CodeMeaning| {
            let role = self.control.role(letter, comma, Some(row));
            let named = row.words.keys().any(|written| written.trim_start_matches(',').starts_with(letter));
            role.filter(|_| named)
        };
        self.resolve(special, modal, by_itself)
    }

    /// The role that a variable has beside the codes of the block or the motion mode.
    pub fn variable_role(
        &self,
        letter: char,
        number: u32,
        modal: Option<&CodeMeaning>,
    ) -> Result<Option<Role>, ()> {
        self.resolve(|row| self.control.parametric_role(letter, number, Some(row)), modal, None)
    }

    fn resolve(
        &self,
        special: impl Fn(&CodeMeaning) -> Option<Role>,
        modal: Option<&CodeMeaning>,
        else_: Option<Role>,
    ) -> Result<Option<Role>, ()> {
        let mut found: Option<Role> = None;
        for role in self.known().filter_map(&special) {
            if found.is_some_and(|other| other != role) {
                return Err(());
            }
            found = Some(role);
        }
        Ok(found.or_else(|| modal.and_then(&special)).or(else_))
    }
}

/// The word that an item is.
pub fn word(item: &Item) -> Option<&Word> {
    match &item.kind {
        ItemKind::Word(word) => Some(word),
        _ => None,
    }
}

/// A code's number in thousandths.
pub fn thousandths(row: &CodeMeaning) -> Option<u32> {
    row.head().map(|head: CodeHead| head.thousandths)
}
