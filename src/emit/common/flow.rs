//! How the end of each block is written, given that blocks stand in source order.

use super::loops;
use crate::dialect::Control;
use crate::ir::analysis::{Arrivals, callees, part_under_skip};
use crate::ir::{Block, BlockId, Cond, Program, Stmt, StmtKind, TermKind};
use crate::legalize::ThenLines;

/// How the end of a block is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::emit) enum Form {
    /// Not at all: the block after it is the next one.
    #[default]
    Fall,
    /// `GOTO`.
    Goto(BlockId),
    /// `IF[..]GOTO`, and then perhaps `GOTO`.
    If {
        /// True for the opposite of the condition.
        negated: bool,
        /// Where the first goes.
        to: BlockId,
        /// Where the second goes.
        otherwise: Option<BlockId>,
    },
    /// `IF[..]THEN` before the one statement of the block after it.
    Then,
    /// `/` before the one line of the block after it.
    Skip(u8),
    /// `/GOTO`, and then perhaps `GOTO`.
    SkipGoto {
        /// The switch.
        level: u8,
        /// Where the first goes, while the switch is off.
        to: BlockId,
        /// Where the second goes, while it is on.
        otherwise: Option<BlockId>,
    },
    /// `WHILE[..]DOn`.
    While {
        /// True for the opposite of the condition.
        negated: bool,
        /// n.
        number: u32,
    },
    /// `ENDn`.
    EndDo(u32),
    /// As what it is (a call, a return, an end), and then perhaps `GOTO`.
    Own(Option<BlockId>),
}

/// How a program is laid out.
#[derive(Debug, Default)]
pub(in crate::emit) struct Plan {
    /// By block.
    pub forms: Vec<Form>,
    /// By block: the level of the `/` that stands before each of its lines.
    pub under: Vec<Option<u8>>,
    /// Which blocks need a sequence number; one more than there are blocks, for the end of the text.
    pub labelled: Vec<bool>,
}

/// What the target can write, as far as layout depends on it.
#[derive(Clone, Copy)]
pub(in crate::emit) struct Abilities<'c> {
    /// The target.
    pub control: &'c Control,
    /// True where a computed jump is stopped before it looks for an invented number: it takes two lines then.
    pub guarded: bool,
    /// `IF[..]THEN` before a macro statement.
    pub then: bool,
    /// `IF[..]THEN` before an alarm or a message.
    pub then_messages: bool,
    /// `IF[..]THEN` before words.
    pub then_words: bool,
    /// A block skip before each line of a part.
    pub skips: bool,
    /// Loops inside one another; 0 where there is no WHILE.
    pub loops: u32,
}

impl Plan {
    /// Lays a program out. `joined` tells whether a block's last statement and its end
    /// stand on one line.
    pub fn new(
        program: &Program,
        arrivals: &Arrivals,
        abilities: Abilities<'_>,
        joined: impl Fn(&Block) -> bool,
    ) -> Self {
        let count = program.blocks.len();
        let lines = ThenLines::new(abilities.control);
        let mut layout = Layout { program, arrivals, abilities, joined, lines, forms: vec![None; count] };
        let mut under = vec![None; count];
        for at in (0..count).filter(|_| abilities.skips) {
            if let Some((level, part)) = part_under_skip(program, arrivals, at) {
                layout.forms[at] = Some(Form::Fall);
                under[part].fill(Some(level));
            }
        }
        for found in loops::find(program, arrivals, abilities.loops) {
            layout.forms[found.header] = Some(Form::While { negated: found.negated, number: found.number });
            layout.forms[found.last] = Some(Form::EndDo(found.number));
        }
        // From the end, because whether a block is one line depends on the one after it.
        for at in (0..count).rev() {
            if layout.forms[at].is_none() {
                layout.forms[at] = Some(layout.form(at));
            }
        }
        let forms: Vec<Form> = layout.forms.into_iter().map(Option::unwrap_or_default).collect();
        let labelled = labelled(program, &forms);
        Self { forms, under, labelled }
    }
}

struct Layout<'a, F> {
    program: &'a Program,
    arrivals: &'a Arrivals,
    abilities: Abilities<'a>,
    joined: F,
    lines: ThenLines<'a>,
    forms: Vec<Option<Form>>,
}

impl<F: Fn(&Block) -> bool> Layout<'_, F> {
    fn form(&self, at: usize) -> Form {
        let Some(block) = self.program.blocks.get(at) else { return Form::Fall };
        let next = BlockId(at as u32 + 1);
        let far = |to: BlockId| (to != next).then_some(to);
        match &block.term.kind {
            TermKind::Jump(to) if *to == next && self.is_written(at) => Form::Goto(*to),
            TermKind::Jump(to) => far(*to).map_or(Form::Fall, Form::Goto),
            TermKind::Branch { cond, then, otherwise } => self.branch(at, cond, *then, *otherwise),
            TermKind::Call { next: to, .. } => Form::Own(far(*to)),
            TermKind::Stray if next.index() == self.program.blocks.len() => Form::Fall,
            // The text ends here, which only its end can do.
            TermKind::Stray => Form::Goto(BlockId(self.program.blocks.len() as u32)),
            TermKind::Computed { .. }
            | TermKind::Return { .. }
            | TermKind::Chain(_)
            | TermKind::End { .. } => Form::Own(None),
        }
    }

    /// True for a jump to the next block that stands in the source: it goes to a label there.
    fn is_written(&self, at: usize) -> bool {
        let [block, next] = self.program.blocks.get(at..at + 2).unwrap_or_default() else { return false };
        !block.term.site.span.is_empty() && !next.labels.is_empty()
    }

    fn branch(&self, at: usize, cond: &Cond, then: BlockId, otherwise: BlockId) -> Form {
        let next = BlockId(at as u32 + 1);
        match cond {
            Cond::Switch(level) => self.switch(at, *level, then, otherwise),
            Cond::Not(inner) if matches!(**inner, Cond::Switch(_)) => {
                let Cond::Switch(level) = **inner else { return Form::Fall };
                self.switch(at, level, otherwise, then)
            }
            _ if self.is_then(at, cond, then, otherwise) => Form::Then,
            _ if then == next && otherwise != next => {
                Form::If { negated: true, to: otherwise, otherwise: None }
            }
            _ => Form::If { negated: false, to: then, otherwise: (otherwise != next).then_some(otherwise) },
        }
    }

    /// One statement that runs where the condition holds, and then, either way, what is after it.
    fn is_then(&self, at: usize, cond: &Cond, then: BlockId, otherwise: BlockId) -> bool {
        let body = at + 1;
        if then.index() != body || !self.arrivals.is_only_from(body, at) {
            return false;
        }
        let (Some(header), Some(block)) = (self.program.blocks.get(at), self.program.blocks.get(body)) else {
            return false;
        };
        let one_block = |span: crate::text::Span| !span.is_empty() && span == header.term.site.span;
        if !block.labels.is_empty() || self.forms[body].is_some_and(|form| matches!(form, Form::EndDo(_))) {
            return false;
        }
        match (block.stmts.as_slice(), &block.term.kind) {
            ([stmt], TermKind::Jump(join)) => {
                let macro_statement = match stmt.kind {
                    StmtKind::Assign { .. } => self.abilities.then,
                    StmtKind::Alarm { .. } | StmtKind::StopMessage { .. } => self.abilities.then_messages,
                    _ => false,
                };
                let words = matches!(stmt.kind, StmtKind::Nc(_));
                *join == otherwise
                    && join.index() == body + 1
                    && is_silent(block)
                    && self.lines.has_room(cond, &stmt.kind)
                    && stmt.site.skip.is_none()
                    && (stmt.site.sequence.is_none() || one_block(stmt.site.span))
                    && (macro_statement || (words && self.abilities.then_words && one_block(stmt.site.span)))
            }
            ([], TermKind::Return { to }) => {
                if to.is_some() && self.abilities.guarded {
                    return false;
                }
                otherwise.index() == body + 1 && self.abilities.then_words && one_block(block.term.site.span)
            }
            _ => false,
        }
    }

    fn switch(&self, at: usize, level: u8, on: BlockId, off: BlockId) -> Form {
        let next = BlockId(at as u32 + 1);
        if off == next && self.is_one_line(at + 1, at, on) {
            return Form::Skip(level);
        }
        // The control passes over the `/GOTO` while the switch is on.
        Form::SkipGoto { level, to: off, otherwise: (on != next).then_some(on) }
    }

    /// True where the block at `body` is one line that only `at` leads to, and where it does not go
    /// elsewhere goes on at `join`, which stands after it.
    fn is_one_line(&self, body: usize, at: usize, join: BlockId) -> bool {
        let Some(block) = self.program.blocks.get(body) else { return false };
        if !self.arrivals.is_only_from(body, at) || !block.labels.is_empty() {
            return false;
        }
        let looks = matches!(block.term.kind, TermKind::Computed { .. } | TermKind::Return { to: Some(_) });
        if looks && self.abilities.guarded {
            return false;
        }
        let behind = body + 1;
        let form = self.forms[body].unwrap_or_default();
        let ends = match form {
            Form::Fall if is_silent(block) => Some(0),
            Form::Goto(_) | Form::If { otherwise: None, .. } | Form::Own(None) => Some(1),
            Form::Then if join.index() == behind + 1 => return block.stmts.is_empty(),
            _ => None,
        };
        let Some(ends) = ends else { return false };
        let lines = match block.stmts.as_slice() {
            [] => ends,
            [_] if ends == 1 && (self.joined)(block) => 1,
            [stmt] if is_skippable(stmt) => 1 + ends,
            _ => return false,
        };
        lines == 1 && join.index() == behind
    }
}

/// True where the statement takes one line that may have a `/` of its branch.
fn is_skippable(stmt: &Stmt) -> bool {
    stmt.site.skip.is_none() && !matches!(stmt.kind, StmtKind::Comment)
}

/// True where nothing was written at the block's end, which is not written either.
fn is_silent(block: &Block) -> bool {
    block.term.site.comments.is_empty() && block.term.site.sequence.is_none()
}

/// Which blocks something goes to by their sequence number.
fn labelled(program: &Program, forms: &[Form]) -> Vec<bool> {
    let mut labelled = vec![false; program.blocks.len() + 1];
    let mut need = |block: BlockId| {
        if let Some(needed) = labelled.get_mut(block.index()) {
            *needed = true;
        }
    };
    for (block, form) in program.blocks.iter().zip(forms) {
        callees(block).for_each(&mut need);
        if let TermKind::Computed { targets, .. } = &block.term.kind {
            targets.iter().for_each(|(_, to)| need(*to));
        }
        match form {
            Form::Goto(to) => need(*to),
            Form::If { to, otherwise, .. } | Form::SkipGoto { to, otherwise, .. } => {
                need(*to);
                otherwise.iter().for_each(|to| need(*to));
            }
            Form::Own(then) => then.iter().for_each(|to| need(*to)),
            Form::Fall | Form::Then | Form::Skip(_) | Form::While { .. } | Form::EndDo(_) => {}
        }
    }
    labelled
}
