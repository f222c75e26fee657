//! From syntax to programs that are ready to run.

use super::Style;
use super::code::*;
use super::expressions::Expressions;
use super::loops::{Mark, match_loops, set_ends};
use super::meaning;
use crate::control::library::Library;
use crate::control::outcome::Stop;
use crate::diag::{Code, Severity};
use crate::dialect::{Control, Machine, Question, Row};
use crate::syntax::{self, Fence, Item, ItemKind, OutputPart, Target};
use crate::text::{Span, decode};
use std::collections::HashMap;
use std::sync::Arc;

/// Of each word its letter, whether a comma stands before it, and whether its value is written.
type Shape = Vec<(char, bool, bool)>;

/// Prepares programs of a library.
pub struct Compiler<'c> {
    pub control: &'c Control,
    pub style: &'static Style,
    /// The bytes that the blocks are read from.
    pub source: &'c [u8],
    /// Where the branches stand that were met.
    pub branches: Vec<Span>,
    /// How many stand before those.
    pub before: usize,
    /// What words without a code mean, by their letters.
    pub plain: HashMap<Shape, Option<Arc<Meaning>>>,
}

/// What is gathered while a block is read.
struct Gather {
    steps: Vec<Step>,
    words: Vec<Word>,
    facts: Vec<String>,
    shown: Option<String>,
}

impl<'c> Compiler<'c> {
    /// One that has met nothing yet.
    pub fn new(control: &'c Control, style: &'static Style, source: &'c [u8]) -> Self {
        Self { control, style, source, branches: Vec::new(), before: 0, plain: HashMap::new() }
    }
}

impl Compiler<'_> {
    /// Prepares the program at a place of a library.
    pub fn program(&mut self, library: &Library<'_>, place: usize) -> Program {
        let mut program = Program::default();
        let mut marks = Vec::new();
        for stretch in library.stretches(place) {
            let branches = self.branches.len();
            let blocks = library.with_stretch(place, &stretch, |blocks| self.blocks(blocks));
            for (at, block) in (stretch.first..).zip(&blocks) {
                if let Some(number) = block.sequence {
                    program.labels.entry(number).or_default().push(at);
                }
                marks.extend(Mark::of(at, block));
            }
            program.count += blocks.len();
            let held = stretch.is_held().then_some(blocks);
            program.parts.push(CodePart { stretch, branches, held });
        }
        match_loops(&mut program, &marks);
        let Program { parts, ends, .. } = &mut program;
        for CodePart { stretch, held, .. } in parts {
            held.iter_mut().for_each(|blocks| set_ends(blocks, stretch.first, ends, self.style));
        }
        program.branches = std::mem::take(&mut self.branches);
        program
    }

    /// Prepares blocks of a program that are not held.
    pub fn part(
        &mut self,
        library: &Library<'_>,
        place: usize,
        program: &Program,
        part: &CodePart,
    ) -> Vec<Block> {
        self.before = part.branches;
        let mut blocks = library.with_stretch(place, &part.stretch, |blocks| self.blocks(blocks));
        set_ends(&mut blocks, part.stretch.first, &program.ends, self.style);
        blocks
    }

    fn blocks(&mut self, blocks: &[syntax::Block]) -> Vec<Block> {
        let made = blocks.iter().map(|block| {
            let sequence = self.sequence(&block.items);
            self.block(block, sequence)
        });
        made.collect()
    }

    /// The block's sequence number, where a jump finds it: at its head, on some controls anywhere.
    fn sequence(&self, items: &[Item]) -> Option<u32> {
        let anywhere = self.control.is(Question::SequenceAnywhere);
        for item in items {
            match &item.kind {
                ItemKind::Sequence { number, .. } => return Some(*number),
                ItemKind::Skip(_) | ItemKind::Comment(_) | ItemKind::Program(_) | ItemKind::EndOfBlock => {}
                _ if anywhere => {}
                _ => return None,
            }
        }
        None
    }

    fn block(&mut self, block: &syntax::Block, sequence: Option<u32>) -> Block {
        let mut gather = Gather { steps: Vec::new(), words: Vec::new(), facts: Vec::new(), shown: None };
        // What has no value is an alarm where it is computed, and a statement after a condition may never be.
        let at_run_time = |code| matches!(code, Code::DivisionByZero | Code::FunctionDomain);
        let mut faults = block.errors.iter().filter(|error| error.code.severity() == Severity::Error);
        let fault = faults.find(|error| !at_run_time(error.code));
        if let Some(fault) = fault {
            let step = match self.style.alarm_of(fault.code) {
                Some(number) => Step::Alarm(Stop::alarm(number, fault.message.clone())),
                None => Step::Unreadable(fault.message.clone()),
            };
            gather.steps.push(step);
        } else {
            let text = self.comment(&block.items);
            gather.shown = self.shown(&block.items);
            self.items(&block.items, &text, &mut gather);
            self.flush(&mut gather);
            self.shared_block(&block.items, &mut gather.facts);
            let is_within = |item: &Item| matches!(&item.kind, ItemKind::Comment(comment) if comment.fence == Fence::Within);
            syntax::for_each_item(&block.items, &mut |item| {
                if is_within(item) {
                    self.rest_on_statement("comment.in.brackets", &mut gather.facts);
                }
            });
        }
        gather.facts.sort();
        gather.facts.dedup();
        gather.facts.shrink_to_fit();
        gather.steps.shrink_to_fit();
        Block { span: block.span, sequence, steps: gather.steps, facts: gather.facts }
    }

    /// The text that an alarm or a message of the block shows: the first comment after the statement.
    fn comment(&self, items: &[Item]) -> String {
        let statement = items.iter().position(|item| !matches!(item.kind, ItemKind::Comment(_)));
        let mut texts = items.iter().skip(statement.unwrap_or(0)).filter_map(|item| match &item.kind {
            ItemKind::Comment(comment) if comment.fence != Fence::Within => Some(self.text(comment.text)),
            _ => None,
        });
        texts.next().unwrap_or_default()
    }

    /// The comment after the words of a block, which a stop shows.
    fn shown(&self, items: &[Item]) -> Option<String> {
        let words = items.iter().rposition(|item| matches!(item.kind, ItemKind::Word(_)))?;
        items.iter().skip(words).find_map(|item| match &item.kind {
            ItemKind::Comment(comment)
                if comment.fence != Fence::Within && self.control.is(Question::MessageShowsComment) =>
            {
                Some(self.text(comment.text))
            }
            _ => None,
        })
    }

    fn text(&self, span: Span) -> String {
        decode(span.of(self.source)).into_owned()
    }

    /// Several statements in one block, or a statement and words.
    fn shared_block(&self, items: &[Item], facts: &mut Vec<String>) {
        let words = items.iter().any(|item| matches!(item.kind, ItemKind::Word(_)));
        let statements = items.iter().filter(|item| {
            use ItemKind::*;
            matches!(item.kind, Assign { .. } | If { .. } | Do { .. } | End { .. } | Goto(_))
        });
        let statements: Vec<&Item> = statements.collect();
        let assigns = |item: &&Item| matches!(item.kind, ItemKind::Assign { .. });
        if statements.len() > 1 && statements.iter().all(assigns) {
            self.rest_on_behaviour(Question::AssignSharesBlock, facts);
        } else if statements.len() > 1 || (words && !statements.is_empty()) {
            self.rest_on_behaviour(Question::StatementSharesBlock, facts);
        }
    }

    /// Notes a fact that is not confirmed, or that the table denies or leaves open.
    fn rest_on_behaviour(&self, question: Question, facts: &mut Vec<String>) {
        let sure = self
            .control
            .behaviour(question)
            .is_some_and(|row| row.origin.is_settled() && row.value == "true");
        if !sure {
            facts.push(question.fact().into());
        }
    }

    fn rest_on_statement(&self, name: &str, facts: &mut Vec<String>) {
        match self.control.statement(name) {
            Some(row) if row.origin.is_settled() => {}
            Some(row) => facts.push(row.fact()),
            None => facts.push(format!("statement:{name}")),
        }
    }

    fn items(&mut self, items: &[Item], text: &str, gather: &mut Gather) {
        let jumps = |item: &&Item| matches!(item.kind, ItemKind::Goto(_));
        // A block skip after the jump leaves out what stands after it, and not the jump.
        let after = items.iter().skip_while(|item| !jumps(item));
        let skips = after.clone().any(|item| matches!(item.kind, ItemKind::Skip(_)));
        let jump = after.clone().next().filter(|_| self.control.is(Question::GotoActsLast) && !skips);
        for (at, item) in items.iter().enumerate() {
            if let ItemKind::Skip(level) = item.kind {
                let before = self.before(items.get(..at).unwrap_or_default(), gather);
                gather.steps.push(Step::Skip { level: level.unwrap_or(1), before });
            }
            if jump.is_none() || !jumps(&item) {
                self.item(item, text, gather);
            }
        }
        if let Some(jump) = jump {
            self.item(jump, text, gather);
        }
    }

    /// The words gathered so far, by themselves: the last of these items.
    fn before(&mut self, items: &[Item], gather: &mut Gather) -> Vec<Step> {
        let words = items.iter().filter(|item| matches!(item.kind, ItemKind::Word(_)));
        let others = words.clone().count().saturating_sub(gather.words.len());
        let shown = gather.shown.clone();
        let mut alone = Gather { steps: Vec::new(), words: Vec::new(), facts: Vec::new(), shown };
        for item in words.skip(others) {
            self.item(item, "", &mut alone);
        }
        self.flush(&mut alone);
        gather.facts.append(&mut alone.facts);
        alone.steps
    }

    fn item(&mut self, item: &Item, text: &str, gather: &mut Gather) {
        let control = self.control;
        match &item.kind {
            ItemKind::Word(word) => {
                let Some(value) = &word.value else {
                    gather.steps.push(Step::Unreadable("a word without a value".into()));
                    return;
                };
                let mut expressions = Expressions::new(control, &mut gather.facts);
                let spoken = expressions.word(word.letter, word.comma, value);
                gather.words.push(spoken);
                if let Some(what) = self.turret_fault(word, value) {
                    gather.steps.push(Step::Unreadable(what.into()));
                }
            }
            ItemKind::Assign { target, value, .. } => {
                let mut expressions = Expressions::new(control, &mut gather.facts);
                let (target, value) = (expressions.variable(target), expressions.value(value));
                let step = match expressions.signal(&target) {
                    Some(alarm) => Step::Signal { alarm, value, text: text.into() },
                    None => Step::Assign { target, value },
                };
                gather.steps.push(step);
            }
            ItemKind::If { condition, body, bare, .. } => {
                self.conditional((condition, body, *bare), text, gather)
            }
            ItemKind::Do { condition, number } => {
                self.flush(gather);
                let condition = condition.as_ref().map(|condition| {
                    let mut expressions = Expressions::new(control, &mut gather.facts);
                    (expressions.condition(condition), self.branch(condition.span))
                });
                // The number stands in for the place of the end, which is found later.
                gather.steps.push(Step::While { condition, tail: *number as usize });
            }
            ItemKind::End { number } => {
                self.flush(gather);
                gather.steps.push(Step::Repeat { head: *number as usize });
            }
            ItemKind::Goto(target) => {
                self.flush(gather);
                let target = match target {
                    Target::Sequence(number) => Goto::Number(*number),
                    Target::Computed(value) => {
                        self.rest_on_statement("goto.computed", &mut gather.facts);
                        Goto::Computed(Expressions::new(control, &mut gather.facts).value(value))
                    }
                    Target::Label(_) => {
                        gather.steps.push(Step::Unreadable("no such labels".into()));
                        return;
                    }
                };
                let branch = self.branch(item.span);
                gather.steps.push(Step::Goto { target, branch });
            }
            ItemKind::SetNames { first, names } => {
                gather.steps.push(Step::Names { first: *first, names: names.clone() });
            }
            ItemKind::Output { binary, parts } => {
                self.rest_on_statement("output.formatted", &mut gather.facts);
                let parts = parts.iter().map(|part| match part {
                    OutputPart::Text(span) => Part::Text(self.text(*span).replace('*', " ")),
                    OutputPart::Value { value, whole, fraction } => Part::Value {
                        value: Expressions::new(control, &mut gather.facts).value(value),
                        whole: *whole,
                        fraction: *fraction,
                    },
                });
                let parts = parts.collect();
                gather.steps.push(Step::Output { binary: *binary, parts });
            }
            ItemKind::Skip(_)
            | ItemKind::Tape
            | ItemKind::EndOfBlock
            | ItemKind::Program(_)
            | ItemKind::Sequence { .. }
            | ItemKind::Comment(_) => {}
            ItemKind::OpenPort | ItemKind::ClosePort => {
                gather.steps.push(Step::Port { open: item.kind == ItemKind::OpenPort });
            }
            _ => gather.steps.push(Step::Unreadable("a statement that this control does not have".into())),
        }
    }

    /// A T word of a lathe with digits of which nobody says whose they are.
    fn turret_fault(&self, word: &syntax::Word, value: &syntax::Expr) -> Option<&'static str> {
        let syntax::ExprKind::Number(number) = &value.kind else { return None };
        if word.letter != 'T' || word.comma || self.control.machine() != Machine::Lathe {
            return None;
        }
        self.control.turret_word().fault(number.digits, number.value)
    }

    fn conditional(
        &mut self,
        (condition, body, bare): (&syntax::Expr, &[Item], bool),
        text: &str,
        gather: &mut Gather,
    ) {
        self.flush(gather);
        if bare {
            self.rest_on_statement("if.bare", &mut gather.facts);
        }
        if body.iter().any(|item| matches!(item.kind, ItemKind::Word(_))) {
            self.rest_on_behaviour(Question::ThenWords, &mut gather.facts);
        }
        let branch = self.branch(condition.span);
        let condition = Expressions::new(self.control, &mut gather.facts).condition(condition);
        let shown = self.shown(body);
        let mut inner = Gather { steps: Vec::new(), words: Vec::new(), facts: Vec::new(), shown };
        let own = self.comment(body);
        self.items(body, if own.is_empty() { text } else { &own }, &mut inner);
        self.flush(&mut inner);
        gather.facts.append(&mut inner.facts);
        gather.steps.push(Step::If { condition, branch, body: inner.steps });
    }

    fn branch(&mut self, span: Span) -> usize {
        self.branches.push(span);
        self.before + self.branches.len() - 1
    }

    /// What words mean. Without a code among them their letters say it, so that the many blocks of plain moves share
    /// one.
    fn meaning(&mut self, words: &[Word]) -> Option<Arc<Meaning>> {
        if words.iter().any(|word| meaning::is_code(word.letter, word.comma)) {
            return meaning::fixed(self.control, self.style, words).map(Arc::new);
        }
        let shape = words.iter().map(|word| (word.letter, word.comma, word.form.is_literal())).collect();
        let found = self.plain.entry(shape);
        found.or_insert_with(|| meaning::fixed(self.control, self.style, words).map(Arc::new)).clone()
    }

    /// Puts the words gathered so far into the steps.
    fn flush(&mut self, gather: &mut Gather) {
        if gather.words.is_empty() {
            return;
        }
        let mut words = std::mem::take(&mut gather.words);
        words.shrink_to_fit();
        let meaning = self.meaning(&words);
        gather.facts.extend(meaning.iter().flat_map(|meaning| meaning.facts.iter().cloned()));
        gather.steps.push(Step::Words(Words { words, meaning, shown: gather.shown.clone() }));
    }
}
