//! Statements, and the ends of blocks that are no jumps.

use super::Emitter;
use super::lines::Kind;
use crate::canon::{Func, Op, Role};
use crate::diag::Code;
use crate::ir::{BinOp, Block, Call, Callee, Expr, PrintPart, Stmt, StmtKind, TermKind};
use crate::text::likeness;

impl<'p> Emitter<'p> {
    /// Writes a statement on a line of its own.
    pub(super) fn statement(&mut self, stmt: &'p Stmt) {
        match &stmt.kind {
            StmtKind::Comment => {
                self.begin(&stmt.site, Kind::Words);
                self.flush_comments();
            }
            StmtKind::Nc(nc) => self.block_of_words(&stmt.site, nc),
            StmtKind::Alarm { number, text } => self.alarm(stmt, number, text),
            StmtKind::StopMessage { text, .. } => {
                self.shown(stmt, None, text);
                self.begin(&stmt.site, Kind::Words);
                self.code(Op::Stop);
                self.finish();
            }
            kind => {
                self.begin(&stmt.site, Kind::Macro);
                self.macro_statement(kind);
                self.finish();
            }
        }
        self.page.skip_next = None;
    }

    /// An alarm: the text is shown, and then the control halts, because it takes no root of a negative number and cannot
    /// go on from there (seed 000:544; facts/fadal-target.md 4).
    fn alarm(&mut self, stmt: &'p Stmt, number: &Expr, text: &str) {
        self.shown(stmt, Some(number), text);
        self.begin(&stmt.site, Kind::Macro);
        // Nothing is ever written there.
        self.out.push_str("R9=");
        let below = Expr::binary(BinOp::Sub, Expr::Number(0.0), Expr::Number(1.0));
        self.value(&Expr::Call(Func::Sqrt, [below].into()));
        self.finish();
    }

    /// Shows a text when all moves are done: `ALARM 1 TEXT` where it has a number.
    fn shown(&mut self, stmt: &'p Stmt, number: Option<&Expr>, text: &str) {
        let mut parts = Vec::new();
        let text = text.trim();
        match number {
            Some(Expr::Number(number)) => parts.push(PrintPart::Text(format!("ALARM {number} {text}"))),
            Some(number) => {
                parts.push(PrintPart::Text("ALARM ".into()));
                parts.push(PrintPart::Value(number.clone()));
                parts.push(PrintPart::Text(format!(" {text}")));
            }
            None => parts.push(PrintPart::Text(text.to_owned())),
        }
        for kind in [StmtKind::Sync, StmtKind::Print { serial: false, parts: parts.into(), stay: false }] {
            self.begin(&stmt.site, Kind::Macro);
            self.macro_statement(&kind);
            self.finish();
        }
    }

    /// Writes a macro statement, without its mark.
    pub(super) fn macro_statement(&mut self, kind: &StmtKind) {
        match kind {
            StmtKind::Assign { target, value } => {
                self.place(target);
                self.out.push('=');
                self.value(value);
            }
            StmtKind::Print { serial, parts, .. } => {
                let name = if *serial { "print.serial" } else { "print" };
                if self.out.has_statement(name) {
                    self.out.push_str(if *serial { "SPRINT " } else { "PRINT " });
                    self.parts_of(parts);
                }
            }
            StmtKind::Input { serial, target } => {
                let name = if *serial { "input.serial" } else { "input" };
                if self.out.has_statement(name) {
                    self.out.push_str(if *serial { "SINPUT " } else { "INPUT " });
                    self.place(target);
                }
            }
            StmtKind::Sync if self.out.has_statement("wait") => self.out.push_str("WAIT"),
            StmtKind::ModalCall(_) | StmtKind::ModalCallOff => self.out.unmapped("a modal call"),
            StmtKind::Output(_) => self.out.unmapped("formatted output"),
            StmtKind::OpenPort | StmtKind::ClosePort => self.out.unmapped("the opening of a port"),
            StmtKind::LimitLookahead(_) => self.out.unmapped("a limit on reading ahead"),
            StmtKind::SetNames { .. } => self.out.unmapped("names of variables"),
            StmtKind::ClearAll(_) => self.out.unmapped("the clearing of all variables"),
            StmtKind::Alarm { .. } | StmtKind::StopMessage { .. } => {
                self.out.unmapped("a message after THEN")
            }
            StmtKind::Comment | StmtKind::Nc(_) | StmtKind::Sync => {}
        }
    }

    fn parts_of(&mut self, parts: &[PrintPart]) {
        for (at, part) in parts.iter().enumerate() {
            if at > 0 {
                self.out.push(',');
            }
            match part {
                PrintPart::Text(text) => {
                    self.out.push('"');
                    let (mut before, mut all) = (' ', text.chars().peekable());
                    while let Some(c) = all.next() {
                        match c {
                            // One ends the text, and nobody says that the other one begins no comment in it.
                            '"' | '\'' => {
                                let inside = |c: char| c.is_alphabetic();
                                if !inside(before) || !all.peek().is_some_and(|next| inside(*next)) {
                                    self.out.push(' ');
                                }
                            }
                            ' '..='~' => self.out.push(c),
                            c => self.out.push_str(likeness(c).unwrap_or("?")),
                        }
                        before = c;
                    }
                    self.out.push('"');
                }
                PrintPart::Value(value) => self.value(value),
            }
        }
    }

    /// Writes the end of a block that leaves it.
    pub(super) fn leave(&mut self, block: &'p Block) {
        self.begin(&block.term.site, Kind::Words);
        match &block.term.kind {
            TermKind::Call { call, .. } => self.call(call),
            TermKind::Return { to: None } => self.code(Op::Return),
            TermKind::Return { .. } => self.out.unmapped("a return to a sequence number of the caller"),
            TermKind::End { rewind } => self.code(if *rewind { Op::EndRewind } else { Op::End }),
            TermKind::Chain(_) => self.out.unmapped("the start of another program"),
            TermKind::Computed { .. } => self.out.unmapped("a computed jump"),
            TermKind::Jump(_) | TermKind::Branch { .. } | TermKind::Stray => {}
        }
        self.finish();
        self.page.skip_next = None;
    }

    /// `M98 P800 L2`; `M98 P+R5`.
    fn call(&mut self, call: &Call) {
        if call.level || !call.arguments.is_empty() {
            return self.out.unmapped("a call that opens a level of locals");
        }
        match &call.callee {
            Callee::Program(name) => {
                let most = self.control.text().program_max;
                let Some(number) = self.names.program(name).filter(|number| (1..=most).contains(number))
                else {
                    return self.out.unmapped(format_args!("the name of the program, {name}"));
                };
                self.code(Op::CallProgram);
                self.out.push_str(" P");
                self.out.integer(number);
            }
            Callee::Computed(number) => {
                self.code(Op::CallProgram);
                self.out.push_str(" P");
                self.word_value(Role::Program, number, false);
            }
            Callee::Block(_) | Callee::Cycle(_) => return self.out.unmapped("a call of that kind"),
        }
        if let Some(count) = &call.count {
            let most = self.control.limit("repeat").map_or(f64::INFINITY, f64::from);
            if count.constant().is_some_and(|count| !(1.0..=most).contains(&count)) {
                self.out.refuse(Code::Unmapped, format!("a call runs 1 to {most} times here: write a loop"));
            }
            self.out.push_str(" L");
            self.word_value(Role::CallCount, count, false);
        }
    }

    /// Writes the code of an operation that has no words.
    fn code(&mut self, op: Op) {
        match self.spellings.bare_code(op) {
            Some(code) => self.word(&code.text),
            None => self.out.unmapped(format_args!("the operation '{op}'")),
        }
    }
}
