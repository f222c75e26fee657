//! Statements, and the ends of blocks that are no jumps.

use super::Emitter;
use super::lines::plain;
use super::words::by_variables;
use crate::canon::{Func, Op};
use crate::ir::{Block, Call, Callee, Expr, Place, SourceInfo, Stmt, StmtKind, TermKind, Var};

/// Characters of a block of loads: the longest parametric block that the course prints has 33.
const LOADS: usize = 33;

/// True if both load numbers for one block of the source: what a call is given, what is cleared.
pub(super) fn loaded_together(one: &Stmt, next: &Stmt) -> bool {
    let plain =
        |site: &SourceInfo| site.comments.is_empty() && site.sequence.is_none() && site.skip.is_none();
    let load = |stmt: &Stmt| matches!(&stmt.kind, StmtKind::Assign { target: Place::Var(_), value } if value.constant().is_some());
    load(one) && load(next) && one.site.span == next.site.span && plain(&next.site)
}

impl<'p> Emitter<'p> {
    /// Writes statements on lines of their own, but for loads of numbers, of which several share a line: none of them
    /// reads what another sets (seed 004:1602).
    pub(super) fn statements(&mut self, stmts: &'p [Stmt]) {
        let [first, _, ..] = stmts else { return stmts.iter().for_each(|stmt| self.statement(stmt)) };
        self.begin(&first.site);
        let mut loaded = Vec::new();
        for stmt in stmts {
            let StmtKind::Assign { target: target @ Place::Var(var), value } = &stmt.kind else { continue };
            // The last of two loads of one variable counts, in whatever order a block does them.
            let register = self.names.variable(*var);
            if self.is_long(LOADS) || loaded.contains(&register) {
                self.finish();
                self.open();
                loaded.clear();
            }
            loaded.push(register);
            self.space();
            self.assign(target, value);
        }
        self.finish();
    }

    /// Writes a statement on lines of its own.
    fn statement(&mut self, stmt: &'p Stmt) {
        let site = &stmt.site;
        match &stmt.kind {
            StmtKind::Comment => {
                self.out.span = site.span;
                self.carry(site);
                self.flush_comments();
            }
            StmtKind::Nc(nc) if nc.has(Op::Stop) && !by_variables(nc) => self.stop(stmt, ""),
            StmtKind::Nc(nc) if nc.has(Op::Stop) => {
                self.block_of_words(site, nc);
                self.finish_stop("");
            }
            StmtKind::Nc(nc) => self.block_of_words(site, nc),
            StmtKind::Alarm { number, text } => self.alarm(stmt, number, text),
            StmtKind::StopMessage { text, .. } => self.stop(stmt, text),
            StmtKind::Assign { target: Place::Var(to), value: Expr::Call(Func::Fix, of) } => {
                self.whole_part(site, *to, of);
            }
            StmtKind::Assign { target, value } => {
                self.begin(site);
                self.assign(target, value);
                self.finish();
            }
            // What is read after moves is read when they are done, as far as any source says.
            StmtKind::Sync => self.begin(site),
            kind => {
                self.begin(site);
                self.out.unmapped(lacks(kind));
            }
        }
    }

    /// `V31=V30`, `INC V31`, `DEC V31`: a step throws the fraction away (seed 004:1643).
    fn whole_part(&mut self, site: &'p SourceInfo, to: Var, of: &[Expr]) {
        let [Expr::Var(from)] = of else {
            self.begin(site);
            return self.out.unmapped("the whole part of this");
        };
        if !self.out.has_statement("step") {
            return;
        }
        self.begin(site);
        if self.names.variable(to).is_none() || self.names.variable(to) != self.names.variable(*from) {
            self.variable(to);
            self.out.push('=');
            self.variable(*from);
        }
        self.finish();
        for step in ["INC ", "DEC "] {
            self.open();
            self.out.push_str(step);
            self.variable(to);
            self.finish();
        }
    }

    /// `M0`, and after it what the operator reads: its text, or the comment behind a stop's own words.
    fn stop(&mut self, stmt: &'p Stmt, text: &str) {
        self.carry(&stmt.site);
        let behind = stmt.site.comments.iter().find(|comment| !comment.leading);
        let shown = behind.filter(|_| matches!(stmt.kind, StmtKind::Nc(_)));
        self.hold_back(shown);
        let text = shown.map_or(text, |comment| &comment.text);
        self.begin(&stmt.site);
        match &stmt.kind {
            StmtKind::Nc(nc) => self.words(nc),
            _ => self.code(Op::Stop),
        }
        self.finish_stop(text);
    }

    /// A jump to a stop that nothing gets past (seed 004:1568).
    fn alarm(&mut self, stmt: &'p Stmt, number: &Expr, text: &str) {
        self.begin(&stmt.site);
        let Some(number) = number.constant() else {
            return self.out.unmapped("an alarm whose number is computed");
        };
        let label = self.stop_of(plain(&format!("ALARM {number} {text}")));
        label.into_iter().for_each(|label| self.go_to(label));
    }

    /// The label of the stop that shows this; one serves all that show the same.
    pub(super) fn stop_of(&mut self, text: String) -> Option<u32> {
        let known = self.alarms.iter().find(|(_, other)| *other == text).map(|(label, _)| *label);
        if known.is_some() {
            return known;
        }
        let label = self.labels.of_stop()?;
        self.alarms.push((label, text));
        Some(label)
    }

    /// Writes the end of a block that leaves it.
    pub(super) fn leave(&mut self, block: &'p Block) {
        let alarm = block.stmts.last().is_some_and(|last| matches!(last.kind, StmtKind::Alarm { .. }));
        if alarm && matches!(block.term.kind, TermKind::End { .. }) {
            // Nothing comes here.
            return self.carry(&block.term.site);
        }
        self.begin(&block.term.site);
        match &block.term.kind {
            TermKind::Call { call, .. } => self.call(call),
            TermKind::Return { to: None } => self.code(Op::Return),
            TermKind::Return { .. } => self.out.unmapped("a return to a sequence number of the caller"),
            TermKind::End { .. } => self.code(Op::EndRewind),
            TermKind::Chain(_) => self.out.unmapped("the start of another program"),
            TermKind::Computed { .. } => self.out.unmapped("a computed jump"),
            TermKind::Jump(_) | TermKind::Branch { .. } | TermKind::Stray => {}
        }
        self.finish();
    }

    /// `G22 P1`.
    fn call(&mut self, call: &Call) {
        if call.level || !call.arguments.is_empty() {
            return self.out.unmapped("a call that opens a level of locals");
        }
        if call.count.as_ref().is_some_and(|count| count.constant() != Some(1.0)) {
            return self.out.unmapped("a call that repeats");
        }
        let label = match &call.callee {
            Callee::Block(entry) => self.labels.of(entry.index()),
            _ => return self.out.unmapped("a call of another program"),
        };
        self.code(Op::CallLocal);
        label.into_iter().for_each(|label| {
            self.word("P");
            self.out.integer(label);
        });
    }

    /// Writes the code of an operation that has no words.
    pub(super) fn code(&mut self, op: Op) {
        match self.spellings.bare_code(op) {
            Some(code) => self.word(&code.text),
            None => self.out.unmapped(format_args!("the operation '{op}'")),
        }
    }
}

/// What the control has nothing for.
fn lacks(kind: &StmtKind) -> &'static str {
    match kind {
        StmtKind::Output(_) | StmtKind::OpenPort | StmtKind::ClosePort => "output to a port",
        StmtKind::Print { .. } => "a print",
        StmtKind::Input { .. } => "a question to the operator",
        StmtKind::ClearAll(_) => "the clearing of all variables",
        StmtKind::LimitLookahead(_) => "a limit on reading ahead",
        StmtKind::SetNames { .. } => "names of variables",
        _ => "a modal call",
    }
}
