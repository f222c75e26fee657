//! Codes that the table of the control does not have.

use super::roles::BlockCodes;
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Beside, CodeHead, Machine};
use crate::lower::common::constant;
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::codes::CodeId;
use crate::lower::macro_b::parts::Words;
use crate::syntax::{Block, ItemKind, Word};
use crate::text::Span;
use std::collections::BTreeSet;

/// The codes of a block without a meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unknown {
    /// All have one.
    None,
    /// Codes of the machine's builder alone: the program is refused until it is said what they do, and is looked at with the
    /// modes that the block sets, so that nothing is asked which they settle.
    Builders,
    /// Others.
    Other,
}

/// True for a code, and for a word that is part of a mode or a move.
pub(super) fn is_of_mode(word: &Word) -> bool {
    !word.comma && "GMXYZABCHDTFS".contains(word.letter)
}

impl<'a> Lowering<'a> {
    /// The codes of a block that have a meaning, and what those are that have none: the meaning of the block's words is not
    /// known then either, but for what a code of the builder leaves alone.
    pub(super) fn block_codes(&mut self, words: &Words<'a>) -> (BlockCodes<'a>, Unknown) {
        let mut codes = BlockCodes::new();
        let mut unknown = Unknown::None;
        for (word, span) in words {
            let Some(id) = self.constant_code(word) else { continue };
            match self.row_beside(id, words) {
                Some(row) => {
                    self.rest_on_code(id, row, *span);
                    codes.push((id, row));
                }
                None => {
                    let of_builder = word.letter == 'M' && unknown != Unknown::Other;
                    unknown = if of_builder { Unknown::Builders } else { Unknown::Other };
                    self.unknown_code(id, words, *span);
                }
            }
        }
        (codes, unknown)
    }

    /// Refuses a code that the table does not have, or not beside the words of its block.
    pub fn unknown_code(&mut self, id: CodeId, words: &Words<'_>, span: Span) {
        let Some(code) = self.codes.get(id) else { return };
        let (letter, number) = (code.head.letter, code.head.number());
        let name = format!("{letter}{number}");
        let of_builder = code.alias.is_none();
        if code.depends {
            let data = self.begins_data(code.head, words);
            self.in_data |= data;
            return self.findings.add(self.other_words(&name, code.head, data, span));
        }
        let message = if code.alias.is_some() {
            format!(
                "{name} calls a program elsewhere; in a program that a code calls it is a plain code, and \
                 the table has no such code"
            )
        } else {
            format!("the table of this control has no code {name}")
        };
        let help = format!(
            "say in the machine profile what the builder made of it: [[site]] with code = \"{name}\", a text, and name, \
             target or do; or calls, if it calls a program"
        );
        let finding = Diagnostic::new(Code::NotUnderstood, span, message).with_help(help);
        self.findings.add(if of_builder { finding.asking(letter, number) } else { finding });
    }

    /// True for a code that writes into tables, beside a word that no row of it has, where a code of a later block ends the input of
    /// data: what stands between is such data.
    fn begins_data(&self, head: CodeHead, words: &Words<'_>) -> bool {
        let rows = self.control.dialect().codes.iter().filter(|row| row.head() == Some(head));
        let told: Vec<Beside> = rows.filter_map(|row| row.beside()).flatten().collect();
        let is_strange = |word: &Word| {
            let number = word.value.as_ref().and_then(constant);
            let here =
                number.and_then(|number| CodeHead::new(word.letter, number)).map(|head| head.thousandths);
            let mut of_letter = told.iter().filter(|one| one.letter == word.letter).peekable();
            of_letter.peek().is_some()
                && of_letter.all(|one| one.thousandths.is_some() && one.thousandths != here)
        };
        let ends = |block: &&Block| {
            block.items.iter().any(|item| matches!(item.kind, ItemKind::Program(_) | ItemKind::Tape))
        };
        let mut later = self.parsed.blocks.iter().skip(self.at + 1).take_while(|block| !ends(block));
        words.iter().any(|(word, _)| is_strange(word)) && later.any(|block| self.ends_data(block))
    }

    /// True for a block with the code that ends the input of data.
    pub fn ends_data(&self, block: &Block) -> bool {
        block.items.iter().any(|item| match &item.kind {
            ItemKind::Word(word) if word.letter == 'G' && !word.comma => {
                let number = word.value.as_ref().and_then(constant);
                let row = number.and_then(|number| self.control.code(word.letter, number, &[]));
                row.is_some_and(|row| row.op == Op::DataInputEnd)
            }
            _ => false,
        })
    }

    /// A code that the table knows beside other words alone.
    fn other_words(&self, name: &str, head: CodeHead, data: bool, span: Span) -> Diagnostic {
        let rows = || self.control.dialect().codes.iter().filter(|row| row.head() == Some(head));
        let all: BTreeSet<&str> = rows().map(|row| row.code.as_str()).collect();
        let all = all.into_iter().collect::<Vec<_>>().join(", ");
        let message = format!(
            "what {name} does beside the words of this block no source says: the table of this control has it as {all} alone"
        );
        if data {
            let message = format!(
                "{name} begins data here that only this control has in its programs (L3: groups of tool life; L50: parameters): the \
                 table of this control has it as {all} alone"
            );
            let help =
                "enter the data on the pages of the other control, and take these blocks out of the program";
            return Diagnostic::new(Code::NotUnderstood, span, message).with_help(help);
        }
        // A limit of the speed, which sets a zero beside the letters of axes on many lathes.
        let limits = rows().any(|row| row.op == Op::LimitSpeed);
        let help = match limits && self.control.machine() == Machine::Lathe {
            true => format!(
                "if it sets a zero from where the tool stands, set that zero by a work offset (G54 to G59, G10 L2) and the tool offsets, and \
                 take {name} out of the block; a limit of the speed (S) stays"
            ),
            false => format!(
                "say in the machine profile what the builder made of it: [[site]] with code = \"{name}\", a text, and name, target or do"
            ),
        };
        Diagnostic::new(Code::NotUnderstood, span, message).with_help(help)
    }
}
