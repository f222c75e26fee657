//! A program from its name to its end.

use super::Emitter;
use super::labels::Labels;
use super::lines::Kind;
use crate::canon::Func;
use crate::emit::common::digits::write_integer;
use crate::emit::common::flow::{Abilities, Form, Plan};
use crate::emit::common::taken::Taken;
use crate::ir::analysis::{Arrivals, callees};
use crate::ir::{Block, BlockId, Cond, Expr, SourceInfo, StmtKind, TermKind};
use std::sync::LazyLock;

/// The site of a line that stands for nothing of the source.
static ELSEWHERE: LazyLock<SourceInfo> = LazyLock::new(SourceInfo::default);

impl<'p> Emitter<'p> {
    /// Writes the program.
    pub(super) fn program(&mut self) {
        let program = self.program;
        self.out.span = program.site.span;
        let count = program.blocks.len();
        let closed = program.blocks.iter().all(|block| {
            block.term.kind.successors().into_iter().chain(callees(block)).all(|to| to.index() < count)
        });
        if !closed {
            return self.out.unmapped("a jump to a block that does not exist");
        }
        let arrivals = Arrivals::of_program(program, |_| false);
        let abilities = Abilities {
            control: self.control,
            guarded: false,
            skips: true,
            then: self.control.statement("if.then").is_some(),
            then_messages: false,
            then_words: false,
            loops: 0,
        };
        let plan = Plan::new(program, &arrivals, abilities, |_| false);
        self.labels = Labels::new(program, &plan.labelled);
        self.header();
        self.taken_registers();
        if self.measures_angles() {
            self.begin(&program.site, Kind::Macro);
            self.out.push_str("SET DEGREES");
            self.finish();
        }
        let mut condition = None;
        for (at, (block, form)) in program.blocks.iter().zip(&plan.forms).enumerate() {
            self.label(at);
            self.page.under = plan.under.get(at).copied().flatten();
            condition = self.block(block, *form, condition);
        }
        self.page.under = None;
        self.label(count);
        self.end_comments();
    }

    /// Writes the block that names the program; only a comment may stand beside it.
    fn header(&mut self) {
        let site = &self.program.site;
        let Some(name) = &self.program.name else {
            return self.out.unmapped("a program without a number");
        };
        let most = self.control.text().program_max;
        let Some(number) = self.names.program(name).filter(|number| (1..=most).contains(number)) else {
            return self.out.unmapped(format_args!("the name of the program, {name}"));
        };
        self.begin(site, Kind::Words);
        self.out.push(self.out.forms.program);
        write_integer(&mut self.out.text, u64::from(number));
        self.finish();
    }

    /// Writes which registers the program takes, so that whoever reads it at the machine knows what they hold.
    fn taken_registers(&mut self) {
        if let Some(mark) = self.names.mark(self.program) {
            self.comment(mark);
        }
        let Taken { named, mut scratch } = Taken::of(self.program, self.names);
        let plane = ("R".into(), 0);
        if !named.contains_key(&plane) && self.sets_plane() {
            scratch.insert(plane);
        }
        let words = named.into_iter().map(|((name, number), label)| format!("{name}{number}={label}"));
        let mut words: Vec<String> = words.collect();
        let scratch: Vec<String> =
            scratch.into_iter().map(|(name, number)| format!("{name}{number}")).collect();
        words.extend((!scratch.is_empty()).then(|| "SCRATCH".to_owned()));
        words.extend(scratch);
        let (mut line, most) = (String::new(), self.widest_comment());
        for word in words {
            if !line.is_empty() && line.len() + 1 + word.len() > most {
                self.comment(&std::mem::take(&mut line));
            }
            line.push_str(if line.is_empty() { "" } else { " " });
            line.push_str(&word);
        }
        self.comment(&line);
    }

    /// True if words set R0, which holds nothing of the program's.
    fn sets_plane(&self) -> bool {
        let mut stmts = self.program.blocks.iter().flat_map(|block| &block.stmts);
        stmts.any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if self.sets_r0(nc)))
    }

    /// True if the program asks a function of an angle: the unit of angles may have been left at another.
    fn measures_angles(&self) -> bool {
        let mut found = false;
        let mut look = |value: &Expr| {
            value.walk(&mut |part| {
                found |= matches!(part, Expr::Call(Func::Sin | Func::Cos | Func::Tan | Func::Atan, _));
            });
        };
        for block in &self.program.blocks {
            block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
            block.term.kind.exprs(&mut look);
        }
        found
    }

    fn label(&mut self, at: usize) {
        if let Some(label) = self.labels.of(at).map(str::to_owned) {
            self.flush_comments();
            self.label_line(&label);
        }
    }

    /// Writes a block. `condition` stands before its one statement; what is handed back stands before the next block's.
    fn block(&mut self, block: &'p Block, form: Form, condition: Option<&'p Cond>) -> Option<&'p Cond> {
        match condition {
            Some(condition) => block.stmts.iter().for_each(|stmt| {
                self.begin(&stmt.site, Kind::Macro);
                self.test(condition, false);
                self.macro_statement(&stmt.kind);
                self.finish();
            }),
            None => block.stmts.iter().for_each(|stmt| self.statement(stmt)),
        }
        self.end(block, form)
    }

    fn end(&mut self, block: &'p Block, form: Form) -> Option<&'p Cond> {
        let site = &block.term.site;
        let condition = match &block.term.kind {
            TermKind::Branch { cond, .. } => Some(&**cond),
            _ => None,
        };
        match form {
            Form::Fall => self.carry(site),
            Form::Goto(to) => self.goto(site, to),
            Form::If { negated, to, otherwise } => {
                self.begin(site, Kind::Macro);
                condition.into_iter().for_each(|condition| self.test(condition, negated));
                self.jump(to);
                self.finish();
                self.page.skip_next = None;
                otherwise.into_iter().for_each(|to| self.goto(site, to));
            }
            Form::Then => {
                self.carry(site);
                return condition;
            }
            Form::Skip(level) => {
                self.carry(site);
                self.page.skip_next = Some(level);
            }
            Form::SkipGoto { level, to, otherwise } => {
                self.page.skip_next = Some(level);
                self.goto(site, to);
                otherwise.into_iter().for_each(|to| self.goto(&ELSEWHERE, to));
            }
            Form::While { .. } | Form::EndDo(_) => self.out.unmapped("a loop by WHILE"),
            Form::Own(then) => {
                self.leave(block);
                then.into_iter().for_each(|to| self.goto(site, to));
            }
        }
        None
    }

    /// `IF V1 LT 2. THEN `.
    fn test(&mut self, condition: &Cond, negated: bool) {
        self.out.push_str("IF ");
        self.condition(condition, negated);
        self.out.push_str(" THEN ");
    }

    fn goto(&mut self, site: &'p SourceInfo, to: BlockId) {
        self.begin(site, Kind::Macro);
        self.jump(to);
        self.finish();
        self.page.skip_next = None;
    }

    fn jump(&mut self, to: BlockId) {
        if self.out.has_statement("goto.label")
            && let Some(label) = self.labels.of(to.index()).map(str::to_owned)
        {
            self.out.push_str("GOTO :");
            self.out.push_str(&label);
        }
    }
}
