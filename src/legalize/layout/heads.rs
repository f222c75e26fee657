//! What an earlier conversion wrote for people: the registers at a program's head, and the old names of labels.
//!
//! Law: a comment does nothing. `(V31=#100 V40=FLAG OF #100 SCRATCH R5)` says what registers of the source hold, and this
//! conversion writes such a head of its own: with the old one above it, each way there and back would add to the text.
//! Only comments at the head go that hold nothing but names of registers, one of them the source's. Any other word in one
//! keeps it, and so does a statement before it. The program's own number goes there too. At a label `($1)`, `(N10)` or `(L1)` was its name on another control.

use crate::dialect::Control;
use crate::ir::{Block, Module, Program, Stmt, StmtKind};
use crate::legalize::Context;
use crate::syntax::ProgramName;

/// Leaves such comments out; true if there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let source = context.source;
    let mut changed = false;
    for program in &mut module.programs {
        changed |= drop_head(program, source);
        for block in program.blocks.iter_mut().filter(|block| !block.labels.is_empty()) {
            changed |= drop_name(block);
        }
    }
    changed
}

/// Takes the old name of a label out of the comments of the block's first statement.
fn drop_name(block: &mut Block) -> bool {
    let Some(first) = block.stmts.first_mut() else { return false };
    let all = first.site.comments.len();
    first.site.comments.retain(|comment| !counts(&comment.text));
    let changed = first.site.comments.len() < all;
    if changed && first.kind == StmtKind::Comment && first.site.comments.is_empty() {
        block.stmts.remove(0);
    }
    changed
}

/// True for a name that only counts.
fn counts(name: &str) -> bool {
    let number =
        name.strip_prefix(['$', 'N']).or_else(|| name.strip_prefix('L').filter(|rest| rest.len() < 3));
    number.is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|digit| digit.is_ascii_digit()))
}

/// True for the number of a program as a comment, which a control without such numbers has at its head.
fn is_name(text: &str, name: Option<&ProgramName>) -> bool {
    let Some(own @ ProgramName::Number(_)) = name else { return false };
    parted(text).is_some_and(|text| parted(&own.short()) == Some(text))
}

/// What stands before the digits of a name, and its number without the zeros before it.
fn parted(name: &str) -> Option<(&str, &str)> {
    let at = name.find(|sign: char| sign.is_ascii_digit())?;
    let (sign, digits) = name.split_at_checked(at)?;
    Some((sign, digits.trim_start_matches('0')))
}

fn drop_head(program: &mut Program, source: &Control) -> bool {
    let name = program.name.clone();
    let (mut changed, mut scratch) = (false, false);
    // A block with a number is a block of the IR too, where something may jump to it.
    'head: for block in &mut program.blocks {
        let mut kept: Vec<Stmt> = Vec::with_capacity(block.stmts.len());
        let mut rest = std::mem::take(&mut block.stmts).into_iter();
        let mut ended = false;
        for mut stmt in rest.by_ref() {
            ended = stmt.kind != StmtKind::Comment;
            if ended {
                kept.push(stmt);
                break;
            }
            let all = stmt.site.comments.len();
            stmt.site.comments.retain(|comment| {
                if is_name(&comment.text, name.as_ref()) {
                    return false;
                }
                let head = Head::of(&comment.text, source);
                let is_one = head.is_some_and(|head| head.pairs || scratch);
                scratch = is_one && (scratch || head.is_some_and(|head| head.scratch));
                !is_one
            });
            let left_out = stmt.site.comments.len() < all;
            changed |= left_out;
            if !left_out || !stmt.site.comments.is_empty() {
                kept.push(stmt);
            }
        }
        kept.extend(rest);
        block.stmts = kept;
        if ended || block.term.kind.successors().len() != 1 {
            break 'head;
        }
    }
    changed
}

/// What a comment of nothing but names says.
#[derive(Clone, Copy, Default)]
struct Head {
    /// It says what registers hold: `V31=#100`, and one of the names is the source's.
    pairs: bool,
    /// It names registers for values in between; the rest of them may stand in the next comment.
    scratch: bool,
}

impl Head {
    /// None for a comment with another word in it.
    fn of(text: &str, source: &Control) -> Option<Self> {
        let spaced = text.replace('=', " = ");
        let mut head = Self::default();
        let (mut equals, mut own) = (false, false);
        for word in spaced.split_ascii_whitespace() {
            match word {
                "=" => equals = true,
                "FLAG" | "OF" => {}
                "SCRATCH" => head.scratch = true,
                word => {
                    let (first, last) = word.split_once('-').unwrap_or((word, word));
                    let (first, last) = (Name::of(first)?, Name::of(last)?);
                    own |= first.is_of(source) || last.is_of(source);
                }
            }
        }
        head.pairs = own && (equals || head.scratch);
        own.then_some(head)
    }
}

/// The name of a register as any control may have it: a sign, and a number or a letter.
struct Name<'t> {
    sign: &'t str,
    rest: &'t str,
}

impl<'t> Name<'t> {
    fn of(word: &'t str) -> Option<Self> {
        let sign = word.chars().next().filter(|sign| sign.is_ascii_graphic() && !sign.is_ascii_digit())?;
        let (sign, rest) = word.split_at_checked(sign.len_utf8())?;
        let is_number = rest.len() < 6 && rest.bytes().all(|digit| digit.is_ascii_digit());
        let is_letter = rest.len() == 1 && rest.bytes().all(|letter| letter.is_ascii_uppercase());
        (!rest.is_empty() && (is_number || is_letter)).then_some(Self { sign, rest })
    }

    fn is_of(&self, control: &Control) -> bool {
        match self.rest.parse() {
            Ok(number) => control.variable_class(self.sign, number).is_some(),
            Err(_) => {
                let letter = self.rest.chars().next();
                letter.is_some_and(|letter| control.letter_class(self.sign, letter).is_some())
            }
        }
    }
}
