//! The tool word, and the code of the builder that changes tools beside it.
//!
//! A code for the change in the block of a tool word triggers the change to that tool, whichever of the two changes it: it is
//! one change.

use super::Lowering;
use super::words::{Change, Planned};
use crate::canon::{Op, Role, Sys};
use crate::dialect::Question;
use crate::ir::{Expr, Nc, NcItem};
use crate::syntax::Word;
use crate::text::Span;
use thin_vec::ThinVec;

impl Lowering<'_> {
    /// Lowers a tool word that stands by itself. The tool is changed before the block's
    /// moves, and its length acts in them; tool 0 takes the length away. `coded` is true beside a code for the change.
    pub(super) fn tool(&mut self, word: &Word, span: Span, coded: bool, plan: &mut Planned, nc: &mut Nc) {
        let Some(tool) = self.word_value(Role::Tool, word, span) else { return };
        let changes = self.findings.behaviour(Question::ToolChangeWord, span);
        let length = self.findings.is(Question::ToolWordSelectsLength, span);
        let none = tool == Expr::Number(0.0);
        let by_word = changes == Some("t");
        match changes {
            _ if none && length && coded => self.findings.not_understood(span, CHANGE_TO_NONE),
            Some(_) if none && length => {}
            Some(_) if by_word || coded => {
                let items = vec![NcItem::Op(Op::ToolChange), NcItem::Word(Role::Tool, tool.clone())];
                let may_be_none = length && self.whole(word).is_none_or(|number| number == 0.0);
                let mut unless = Vec::new();
                if may_be_none {
                    unless.push(Expr::Number(0.0));
                }
                if by_word && self.findings.behaviour(Question::ToolWordAgain, span) == Some("skipped") {
                    unless.push(Expr::System(Sys::ActiveTool, ThinVec::new()));
                }
                plan.change = Some(Change { nc: Nc { items }, tool: tool.clone(), unless });
            }
            Some(_) if length => self.findings.not_understood(span, LENGTH_WAITS),
            Some(_) => self.add(nc, NcItem::Word(Role::Tool, tool.clone()), span),
            None => self.findings.not_understood(span, "no source says what the tool word does"),
        }
        if length && none {
            self.add(nc, NcItem::Op(Op::LengthOff), span);
        } else if length {
            self.add(nc, NcItem::Op(Op::LengthPlus), span);
            self.add(nc, NcItem::Word(Role::LengthOffset, tool), span);
        }
    }

    /// Settles the code for a change: beside a tool word the two are one change.
    pub(super) fn coded_change(&mut self, span: Span, plan: &Planned, nc: &mut Nc) {
        let by_word = self.findings.behaviour(Question::ToolChangeWord, span) == Some("t");
        if by_word && plan.change.is_none() {
            self.findings.not_understood(span, CHANGE_ALONE);
        } else if plan.change.is_some() && nc.moves() {
            self.findings.not_understood(span, CHANGE_AND_MOVE);
        }
        if by_word || plan.change.is_some() {
            nc.items.retain(|item| *item != NcItem::Op(Op::ToolChange));
        }
    }
}

const CHANGE_ALONE: &str = "the tool word changes the tool on this control, and no source says what a code for the change does without one: write T into its block";

const CHANGE_TO_NONE: &str =
    "no source says what a change to tool 0 does: write T00 without the code for the change, or the tool";

const CHANGE_AND_MOVE: &str = "no source says whether the tool is changed before the move of this block or after it: give the change a block of its own";

const LENGTH_WAITS: &str = "the code for the change changes the tool, and no source says whether the length of a tool that waits for it \
                            counts: write the code into the block of the tool word";
