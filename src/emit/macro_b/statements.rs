//! Statements, and the ends of blocks that are no jumps.

use super::Emitter;
use crate::canon::{Op, Role, Sys};
use crate::diag::Code;
use crate::dialect::Question;
use crate::emit::common::comments::{is_writable, write_comment};
use crate::emit::common::lines::Kind;
use crate::emit::common::reach::is_steady;
use crate::ir::{
    Block, Cond, Expr, Nc, NcItem, OutputPart, Place, Relation, SourceInfo, Stmt, StmtKind, TermKind, Var,
};
use thin_vec::ThinVec;

impl<'p> Emitter<'p> {
    /// Writes a statement on a line of its own.
    pub(super) fn statement(&mut self, stmt: &'p Stmt) {
        let held = std::mem::replace(&mut self.holds_back, false);
        match &stmt.kind {
            StmtKind::Comment => {
                self.comment(&stmt.site, held);
                self.holds_back = held;
            }
            StmtKind::Nc(_) => {
                self.begin(&stmt.site, Kind::Words, None);
                self.words_of(stmt);
                self.out.finish();
            }
            StmtKind::Assign { target, value } => {
                self.begin(&stmt.site, Kind::Macro, None);
                self.assign(target, value);
                self.out.finish();
            }
            StmtKind::Alarm { number, text } => self.message(&stmt.site, Sys::Alarm, number, text),
            StmtKind::StopMessage { number, text } => {
                self.message(&stmt.site, Sys::StopMessage, number, text);
            }
            kind => {
                let alone = matches!(kind, StmtKind::Output(_) | StmtKind::SetNames { .. });
                self.begin(&stmt.site, if alone { Kind::Alone } else { Kind::Words }, None);
                self.special(kind);
                self.out.finish();
                self.holds_back = matches!(kind, StmtKind::LimitLookahead(_));
            }
        }
    }

    fn special(&mut self, kind: &StmtKind) {
        match kind {
            StmtKind::ModalCall(call) => self.call_by(Op::CallModal, call),
            StmtKind::ModalCallOff => self.code(Op::CallModalOff),
            StmtKind::Output(parts) => self.output(parts),
            StmtKind::OpenPort if self.out.has_statement("output.open") => self.out.word("POPEN"),
            StmtKind::ClosePort if self.out.has_statement("output.close") => self.out.word("PCLOS"),
            StmtKind::LimitLookahead(count) => self.words(&Nc {
                items: vec![NcItem::Op(Op::LimitLookahead), NcItem::Word(Role::Lookahead, count.clone())],
            }),
            StmtKind::SetNames { first, names } => self.set_names(*first, names),
            StmtKind::Print { .. } => self.out.unmapped("output without a number format"),
            StmtKind::Input { .. } => self.out.unmapped("a question to the operator"),
            StmtKind::ClearAll(_) => self.out.unmapped("the clearing of all variables"),
            StmtKind::Sync => self.out.unmapped("a wait for the moves ahead"),
            _ => {}
        }
    }

    /// Writes a comment, or an empty block: one for a block of the source, and all that hold back a control that
    /// reads ahead.
    fn comment(&mut self, site: &'p SourceInfo, held: bool) {
        let repeated = self.out.is_last_span(site.span);
        let under = self.out.line.under.take();
        self.out.carry(site);
        if self.out.is_waiting() {
            self.begin(site, Kind::Words, None);
            self.out.finish();
        } else if (held || !repeated) && !site.span.is_empty() {
            self.begin(site, Kind::Words, None);
            self.out.word(";");
            self.out.finish();
        }
        self.out.line.under = under;
    }

    /// Writes the words of a statement that is a block of them.
    pub(super) fn words_of(&mut self, stmt: &'p Stmt) {
        if let StmtKind::Nc(nc) = &stmt.kind {
            self.words(nc);
        }
    }

    fn assign(&mut self, target: &Place, value: &Expr) {
        self.out.space();
        match target {
            Place::Var(var) => self.variable(*var),
            Place::Indirect(bank, number) => self.indirect(*bank, number),
            Place::System(state, subscripts) => self.state(*state, subscripts, true),
        }
        self.out.push('=');
        self.value(value);
    }

    /// `#3000=1 (TEXT)`.
    fn message(&mut self, site: &'p SourceInfo, state: Sys, number: &Expr, text: &str) {
        self.begin(site, Kind::Alone, Some(text));
        self.assign(&Place::System(state, ThinVec::new()), number);
        let text = text.trim();
        if !text.is_empty() {
            self.out.push(' ');
            write_comment(&mut self.out.text, text);
        }
        if !is_writable(text) {
            let message = format!("the message '{text}' cannot be shown as it is");
            self.out.review(Code::MessageAltered, message);
        }
        self.out.finish();
    }

    /// `DPRNT[X#1[53]*TEXT]`.
    fn output(&mut self, parts: &[OutputPart]) {
        if !self.out.has_statement("output.formatted") {
            return;
        }
        self.out.word("DPRNT[");
        for part in parts {
            match part {
                OutputPart::Text(text) => self.output_text(text),
                OutputPart::Value { value, whole, fraction } => {
                    match value {
                        Expr::Var(_) | Expr::System(..) => self.value(value),
                        _ => self.out.unmapped("the output of anything but a variable"),
                    }
                    // One digit each, eight in all, and not none.
                    if *whole > 8 || *fraction > 8 || !(1..=8).contains(&(whole + fraction)) {
                        self.out.unmapped(format_args!("{whole} and {fraction} digits of output"));
                    }
                    self.out.push('[');
                    self.out.integer(*whole);
                    self.out.integer(*fraction);
                    self.out.push(']');
                }
            }
        }
        self.out.push(']');
    }

    fn output_text(&mut self, text: &str) {
        for c in text.chars() {
            match c {
                ' ' => self.out.push('*'),
                'A'..='Z' | 'a'..='z' | '0'..='9' | '+' | '-' | '/' | '.' | ',' | ':' | '=' => {
                    self.out.push(c)
                }
                _ => return self.out.refuse(Code::TextUnwritable, format!("the output of '{c}'")),
            }
        }
    }

    /// `SETVN 500[NAME,NAME]`.
    fn set_names(&mut self, first: Var, names: &[String]) {
        if !self.out.has_statement("setvn") {
            return;
        }
        let Some(number) = self.register(first) else {
            return self.out.unmapped("the names of variables without a register");
        };
        for (offset, name) in (0..).zip(names) {
            let var = Var { class: first.class, number: first.number.saturating_add(offset) };
            if self.register(var) != number.checked_add(offset) {
                return self.out.unmapped("names for variables that are not in a row here");
            }
            let letters = name.bytes().all(|b| b.is_ascii_graphic() && !b"()[]:,;%".contains(&b));
            if !letters || name.len() > 8 || !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
                return self.out.refuse(Code::TextUnwritable, format!("the variable name '{name}'"));
            }
        }
        self.out.word("SETVN ");
        self.out.integer(number);
        self.out.push('[');
        for (at, name) in names.iter().enumerate() {
            if at > 0 {
                self.out.push(',');
            }
            self.out.push_str(name);
        }
        self.out.push(']');
    }

    /// Writes the code of an operation that has no words.
    fn code(&mut self, op: Op) {
        let spellings = self.spellings;
        match spellings.bare_code(op) {
            Some(code) => self.out.word(&code.text),
            None => self.out.unmapped(format_args!("the operation '{op}'")),
        }
    }

    /// True where the last statement of a block and its end stand on one line: they came from one,
    /// and the words act first.
    pub(super) fn is_joined(&self, block: &Block) -> bool {
        let Some(stmt) = block.stmts.last() else { return false };
        let StmtKind::Nc(nc) = &stmt.kind else { return false };
        let site = &block.term.site;
        if stmt.site.span.is_empty() || stmt.site.span != site.span || stmt.site.skip.is_some() {
            return false;
        }
        let op = match &block.term.kind {
            TermKind::End { rewind } => end_op(*rewind),
            TermKind::Return { to: None } if self.control.is(Question::M99BlockMovesFirst) => Op::Return,
            TermKind::Call { call, .. } if self.style.words_beside_call && !call.level => {
                let letters = [Role::Program, Role::CallCount].map(|role| self.spellings.letter(role, &[]));
                let taken = |role: Role| {
                    let letter = self.spellings.letter(role, &[]).map(|(letter, _)| letter.0);
                    matches!(letter, Some('P' | 'L'))
                        || letters.iter().flatten().any(|(l, _)| Some(l.0) == letter)
                };
                let clash = nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if taken(*role)));
                if clash {
                    return false;
                }
                Op::CallProgram
            }
            _ => return false,
        };
        let spellings = self.spellings;
        let is_m = |op| spellings.bare_code(op).is_some_and(|code| code.is_m());
        let computed = nc.items.iter().any(|item| matches!(item, NcItem::Code('M', _)));
        let count = nc.ops().filter(|op| is_m(*op)).count();
        !computed && (!is_m(op) || count < spellings.m_codes.min(3))
    }

    /// Writes the end of a block that leaves it.
    pub(super) fn leave(&mut self, block: &'p Block, joined: bool) {
        match &block.term.kind {
            TermKind::Computed { value, .. } => self.guard(&block.term.site, value, self.out.labels.guard()),
            TermKind::Return { to: Some(to) } if to.constant().is_none() => {
                self.guard(&block.term.site, to, self.names.guard());
            }
            _ => {}
        }
        if !joined {
            self.begin(&block.term.site, Kind::Words, None);
        }
        match &block.term.kind {
            TermKind::Call { call, .. } => self.call_once(call),
            TermKind::Return { to } => self.return_to(to.as_ref()),
            TermKind::End { rewind } => self.code(end_op(*rewind)),
            TermKind::Chain(_) => self.out.unmapped("the start of another program"),
            TermKind::Computed { value, .. } if self.out.has_statement("goto.computed") => {
                self.out.word("GOTO ");
                match &**value {
                    Expr::Number(number) => self.out.number(*number, false),
                    value => self.behind_letter(value),
                }
            }
            TermKind::Computed { .. } | TermKind::Jump(_) | TermKind::Branch { .. } | TermKind::Stray => {}
        }
        self.out.finish();
    }

    /// Stops before a jump to a number that the source has no block of: `IF [#1 GT 8999] THEN #3000=1 (..)`.
    fn guard(&mut self, site: &'p SourceInfo, value: &Expr, floor: Option<u32>) {
        let Some(floor) = floor else { return };
        if !is_steady(value) || !self.out.has_statement("if.then") {
            let what = "a computed jump may look for any number, but this program needs a number that it must \
                 not find";
            return self.out.refuse(Code::NoSequenceNumber, what);
        }
        self.begin(site, Kind::Macro, None);
        let last = Expr::Number(f64::from(floor.saturating_sub(1)));
        let condition = Cond::Compare(Relation::Greater, value.clone(), last);
        self.out.word("IF ");
        self.bracketed_condition(&condition, false);
        self.out.push_str(" THEN");
        self.assign(&Place::System(Sys::Alarm, ThinVec::new()), &Expr::Number(1.0));
        self.out.push_str(" (NO SUCH BLOCK)");
        self.out.finish();
    }

    /// True where M99 P goes to a block of the caller; elsewhere it jumps in the program that runs.
    fn returns_to_caller(&self) -> bool {
        self.control.statement("return.to.sequence").is_some()
            && self.control.behaviour(Question::M99PJumpsHere).is_some_and(|row| row.value == "false")
    }

    fn return_to(&mut self, to: Option<&Expr>) {
        self.code(Op::Return);
        let Some(to) = to else { return };
        let spellings = self.spellings;
        let code = spellings.bare_code(Op::Return);
        let letter = spellings.letter(Role::Sequence, code.as_slice());
        match letter {
            Some(((letter, _), _)) if self.returns_to_caller() => {
                self.out.space();
                self.out.push(letter);
                self.word_value(Role::Sequence, to);
            }
            _ => self.out.unmapped("a return to a sequence number of the caller"),
        }
    }
}

fn end_op(rewind: bool) -> Op {
    if rewind { Op::EndRewind } else { Op::End }
}
