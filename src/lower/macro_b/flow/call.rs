//! Calls: of programs, of parts of this program, of macros with arguments, and the
//! codes that a machine profile makes call programs.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Alias, CodeMeaning, Machine, Question};
use crate::ir::eval::whole;
use crate::ir::{BinOp, Call, Callee, Expr, SourceInfo, StmtKind, TermKind};
use crate::lower::common::otherwise;
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::codes::CodeId;
use crate::lower::macro_b::expressions::At;
use crate::lower::macro_b::parts::Words;
use crate::syntax::{Expr as Expression, ProgramName, Word};
use crate::text::Span;

/// A code that leaves the block, and where it stands among the words.
#[derive(Clone, Copy)]
pub struct Flow<'a> {
    pub row: &'a CodeMeaning,
    pub at: usize,
}

/// The words of a block with a call: those of the call, and the others.
pub struct Parts<'a> {
    own: Vec<(Role, &'a Word, Span)>,
    /// The words that are not the call's.
    pub rest: Words<'a>,
}

impl<'a> Parts<'a> {
    /// The value of a call's word as it is written.
    fn written(&self, role: Role) -> Option<&'a Expression> {
        let (_, word, _) = self.own.iter().find(|(other, _, _)| *other == role)?;
        word.value.as_ref()
    }
}

impl<'a> Lowering<'a> {
    /// The words of a block: a call or a jump with the words beside it, or NC words.
    pub fn words(&mut self, words: &Words<'a>, site: &SourceInfo) {
        let mut found =
            words.iter().enumerate().filter_map(|(at, (word, _))| Some((at, self.flow_code(word)?)));
        let (first, second) = (found.next(), found.next());
        match (first, second) {
            (None, _) => self.nc(words, site),
            // After a macro call M30. is an argument.
            (Some((at, id)), second) if second.is_none() || self.takes_arguments(id) => {
                self.flow_word(id, at, words, site);
            }
            _ => {
                let message = "two codes of this block call, jump or end: only one of them can";
                self.findings.not_understood(site.span, message);
            }
        }
    }

    /// The code of a word that calls, jumps or ends.
    pub fn flow_code(&mut self, word: &Word) -> Option<CodeId> {
        let id = self.constant_code(word)?;
        let code = self.codes.get(id)?;
        if code.alias.is_some() {
            // In a program that a code calls, the codes that call programs are plain ones.
            return (!self.aliased || self.control.is(Question::CallAliasNested)).then_some(id);
        }
        code.row.is_some_and(|row| row.op.is_flow()).then_some(id)
    }

    fn takes_arguments(&self, id: CodeId) -> bool {
        self.codes.get(id).is_some_and(|code| match code.alias {
            Some(alias) => alias.arguments,
            None => code.row.is_some_and(|row| matches!(row.op, Op::CallMacro | Op::CallModal)),
        })
    }

    fn flow_word(&mut self, id: CodeId, at: usize, words: &Words<'a>, site: &SourceInfo) {
        let Some(code) = self.codes.get(id) else { return };
        if let Some(alias) = code.alias {
            return self.alias_call(alias, at, words, site);
        }
        let Some(row) = self.row_beside(id, words) else { return };
        self.rest_on_code(id, row, words.get(at).map_or(site.span, |(_, span)| *span));
        let flow = Flow { row, at };
        match row.op {
            Op::CallMacro | Op::CallModal => self.macro_call(flow, words, site),
            Op::CallModalOff => {
                self.modal_call_off(words.get(at).map_or(site.span, |(_, span)| *span));
                self.builder.push(StmtKind::ModalCallOff, site.clone());
                let mut rest = words.clone();
                rest.remove(at);
                if !rest.is_empty() {
                    let message = "words beside the end of a modal call: they are taken to act after it";
                    self.findings.add(Diagnostic::new(Code::WordsBesideCall, site.span, message));
                    self.nc(&rest, site);
                }
            }
            Op::CallProgram | Op::CallLocal => self.program_call(flow, words, site),
            Op::Return => self.returning(flow, words, site),
            Op::JumpInputOff => self.jump_on_input(flow, words, site),
            Op::End | Op::EndRewind => self.ending(flow, words, site),
            _ => {
                let message = format!("{} has no counterpart on other controls", row.code);
                self.findings.not_understood(site.span, message);
            }
        }
    }

    /// Counts the end of a modal call, and says where this program has begun none before.
    fn modal_call_off(&mut self, span: Span) {
        match self.modal_calls.checked_sub(1) {
            Some(left) => self.modal_calls = left,
            None => {
                let what = "no modal call begins before this block: this can end only a modal call of a \
                            caller";
                self.findings.add(Diagnostic::new(Code::ModalCallNotOpen, span, what));
            }
        }
    }

    /// Sorts the words of a block with a call: those whose role beside it is one of `roles`, and the rest.
    pub fn parts(&mut self, flow: Flow<'a>, words: &Words<'a>, roles: &[Role]) -> Parts<'a> {
        let mut parts = Parts { own: Vec::new(), rest: Words::new() };
        for (at, &(word, span)) in words.iter().enumerate() {
            let explicit = (!word.comma)
                .then(|| flow.row.words.get(word.letter.encode_utf8(&mut [0; 4]) as &str))
                .flatten()
                .copied();
            match explicit.or_else(|| usual(flow.row.op, word.letter)) {
                _ if at == flow.at => {}
                Some(role) if roles.contains(&role) => {
                    if parts.own.iter().any(|(other, _, _)| *other == role) {
                        self.findings.not_understood(span, format!("{} is in this block twice", word.letter));
                    }
                    parts.own.push((role, word, span));
                }
                _ => parts.rest.push((word, span)),
            }
        }
        parts
    }

    /// The value of a call's word.
    pub fn part(&mut self, parts: &Parts<'a>, role: Role) -> Option<Expr> {
        let (_, word, span) = parts.own.iter().find(|(other, _, _)| *other == role)?;
        match &word.value {
            Some(value) => Some(self.expr(value, At::Word(role))),
            None => {
                self.findings.not_understood(*span, format!("{} has no value", word.letter));
                None
            }
        }
    }

    fn count(&mut self, parts: &Parts<'a>, site: &SourceInfo) -> Option<Expr> {
        let count = match self.part(parts, Role::CallCount) {
            Some(count) => count,
            None => match self.part(parts, Role::CallAgain)? {
                Expr::Number(again) => Expr::Number(again + 1.0),
                again => Expr::binary(BinOp::Add, again, Expr::Number(1.0)),
            },
        };
        if count.constant() == Some(0.0) {
            match self.findings.behaviour(Question::RepeatZero, site.span) {
                Some("once") => return None,
                Some(_) => {}
                None => self.unknown_behaviour(Question::RepeatZero, site.span),
            }
        }
        let once = self.control.behaviour(Question::RepeatZero).filter(|row| row.value == "once");
        if count.constant().is_none() && once.is_some() {
            self.findings.not_understood(site.span, otherwise(Question::RepeatZero, "once"));
        }
        (count != Expr::Number(1.0)).then_some(count)
    }

    /// `M98`, `M97`: no new level of locals; the words beside it act first.
    fn program_call(&mut self, flow: Flow<'a>, words: &Words<'a>, site: &SourceInfo) {
        let roles = [Role::Program, Role::Sequence, Role::CallCount, Role::CallAgain];
        let parts = self.parts(flow, words, &roles);
        let mut count = self.count(&parts, site);
        let program = self.part(&parts, Role::Program);
        let sequence = self.part(&parts, Role::Sequence);
        let callee = match (program, sequence) {
            (Some(program), None) => match program.constant() {
                Some(number) => {
                    let (number, digits) = self.repeat_digits(number, &parts, site.span);
                    count = count.or(digits);
                    self.program(number, site.span)
                }
                None => Some(Callee::Computed(program)),
            },
            (None, Some(sequence)) => match sequence.constant().and_then(whole) {
                Some(number) => Some(Callee::Block(self.target(number, site.span))),
                None => {
                    let written = parts.written(Role::Sequence);
                    self.check_beside_call(flow, &parts.rest);
                    self.run_first(&parts, site);
                    return self.call_computed_block(written, &sequence, count.as_ref(), site);
                }
            },
            (Some(program), Some(sequence)) => self.part_of_program(&program, &sequence, site.span),
            (None, None) => {
                self.findings
                    .not_understood(site.span, format!("{} does not say what it calls", flow.row.code));
                None
            }
        };
        self.check_beside_call(flow, &parts.rest);
        self.run_first(&parts, site);
        let Some(callee) = callee else { return };
        let level = self.has_own_locals(site);
        self.call(Call { callee, level, arguments: Vec::new(), count }, false, site);
    }

    /// A program from one of its sequence numbers on: the name of the part that is made of it.
    fn part_of_program(&mut self, program: &Expr, sequence: &Expr, span: Span) -> Option<Callee> {
        let number = |value: &Expr| value.constant().and_then(whole).filter(|number| *number > 0);
        let Some((program, sequence)) = number(program).zip(number(sequence)) else {
            let what = "the number of the called program, or that of the block at which it starts, is computed: write the numbers";
            self.findings.not_understood(span, what);
            return None;
        };
        Some(Callee::Program(ProgramName::part(program, sequence)))
    }

    /// A length or a radius beside a call of a program, without a code that takes it: it may say where the program starts.
    fn check_beside_call(&mut self, flow: Flow<'a>, rest: &Words<'a>) {
        let mut coded = false;
        for (word, _) in rest {
            let row = self.constant_code(word).and_then(|id| self.codes.get(id)?.row);
            coded |= row.is_some_and(|row| matches!(row.op.group(), Group::LengthComp | Group::RadiusComp));
        }
        let starts = flow.row.words.get("H") == Some(&Role::Sequence);
        if starts && coded {
            let what = "H beside this call may be the tool length of the block's other code, or the sequence number at which the \
                        subprogram starts: give each a block of its own";
            let span = rest.first().map_or(Span::default(), |(_, span)| *span);
            return self.findings.not_understood(span, what);
        }
        let found = rest.iter().find(|(word, _)| matches!(word.letter, 'H' | 'D') && !word.comma);
        let Some(&(word, span)) = found.filter(|_| !coded) else { return };
        if self.control.machine() != Machine::Mill {
            return;
        }
        let (letter, code) = (word.letter, &flow.row.code);
        let what = format!("{letter} beside {code} is taken as an offset number that acts before the call");
        let told = Diagnostic::new(
            Code::Conditional,
            span,
            match letter {
                'H' => format!(
                    "{what}; on some controls it is the sequence number at which the subprogram starts"
                ),
                _ => format!("{what}; no source says it"),
            },
        );
        let help = "if it is, say 'call_start' under [settings] of the machine's profile; else give it a block of its own before the call";
        self.findings.add(match letter {
            'H' => told.with_help(help).lacking("setting.call_start"),
            _ => told.with_help("give it a block of its own before the call"),
        });
    }

    /// On controls that have it, `M98 P68003` calls O8003 six times: digits before the last four
    /// are the count, unless L gives one. Where program numbers have more digits they are all the number's.
    fn repeat_digits(&mut self, number: f64, parts: &Parts<'a>, span: Span) -> (f64, Option<Expr>) {
        let counted = parts.own.iter().any(|(role, _, _)| matches!(role, Role::CallCount | Role::CallAgain));
        let Some(row) = self.control.statement("call.repeat.digits") else { return (number, None) };
        let is_a_number = number <= f64::from(self.control.text().program_max);
        if number < 10_000.0 || is_a_number || counted || number.fract() != 0.0 {
            return (number, None);
        }
        self.findings.rest_on(row, span);
        let count = (number / 10_000.0).trunc();
        (number % 10_000.0, (count != 1.0).then_some(Expr::Number(count)))
    }

    fn program(&mut self, number: f64, span: Span) -> Option<Callee> {
        match whole(number).filter(|_| number.fract() == 0.0 && number > 0.0) {
            Some(number) => Some(Callee::Program(ProgramName::Number(number))),
            None => {
                self.findings.not_understood(span, format!("{number} is not a program number"));
                None
            }
        }
    }

    /// `G65`, `G66`: a new level of locals, set by the other words of the block.
    fn macro_call(&mut self, flow: Flow<'a>, words: &Words<'a>, site: &SourceInfo) {
        let modal = flow.row.op == Op::CallModal;
        let parts = self.parts(flow, words, &[Role::Program, Role::CallCount, Role::CallAgain]);
        let before = words.iter().take(flow.at).any(|(word, _)| !matches!(word.letter, 'P' | 'L'));
        if before {
            let message = "words before the macro call: the call must come first, and alone";
            self.findings.add(Diagnostic::new(Code::MacroCallNotAlone, site.span, message));
        }
        let count = self.count(&parts, site);
        let Some(program) = self.part(&parts, Role::Program) else {
            return self
                .findings
                .not_understood(site.span, "the macro call has no P: it does not say what it calls");
        };
        let callee = match program.constant() {
            Some(number) => self.program(number, site.span),
            None => Some(Callee::Computed(program)),
        };
        let arguments = self.arguments(&parts.rest);
        if count.is_some() && !arguments.is_empty() {
            match self.findings.behaviour(Question::CallRepeatReloadsArguments, site.span) {
                Some("true") => {}
                Some(_) => {
                    let message = "the repeats of this call do not set the arguments again: each pass \
                                   starts with what the pass before left";
                    self.findings.add(Diagnostic::new(Code::RepeatKeepsLocals, site.span, message));
                }
                None => self.unknown_behaviour(Question::CallRepeatReloadsArguments, site.span),
            }
        }
        let Some(callee) = callee else { return };
        self.call(Call { callee, level: true, arguments, count }, modal, site);
    }

    /// A code that the machine profile makes call a program.
    fn alias_call(&mut self, alias: Alias, at: usize, words: &Words<'a>, site: &SourceInfo) {
        let callee = Callee::Program(ProgramName::Number(alias.program));
        let mut rest = words.clone();
        rest.remove(at);
        if !alias.arguments {
            if !rest.is_empty() {
                self.nc(&rest, site);
            }
            let level = self.has_own_locals(site);
            return self.call(Call { callee, level, arguments: Vec::new(), count: None }, false, site);
        }
        if at > 0 {
            let message = "words before a code that calls a macro: the code must come first, and alone";
            self.findings.add(Diagnostic::new(Code::MacroCallNotAlone, site.span, message));
        }
        let repeat = rest.iter().position(|(word, _)| word.letter == 'L' && !word.comma);
        let count = repeat.map(|at| rest.remove(at)).and_then(|(word, _)| {
            let value = word.value.as_ref()?;
            Some(self.expr(value, At::Word(Role::CallCount)))
        });
        let arguments = self.arguments(&rest);
        self.call(Call { callee, level: true, arguments, count }, alias.modal, site);
    }

    /// True where a subprogram does not see its caller's locals.
    pub fn has_own_locals(&mut self, site: &SourceInfo) -> bool {
        let answer = self.findings.behaviour(Question::LocalsSharedBySubprogram, site.span);
        if answer.is_none() {
            self.unknown_behaviour(Question::LocalsSharedBySubprogram, site.span);
        }
        answer == Some("false")
    }

    /// Calls at once, or from here on after each move.
    pub fn call(&mut self, call: Call, modal: bool, site: &SourceInfo) {
        // What is called may leave another motion mode behind.
        self.motion.join();
        if modal {
            if self.findings.is(Question::CallModalBlockCalls, site.span) {
                self.findings.not_understood(
                    site.span,
                    "on this control the block of a modal call calls \
                                                         at once: that is not converted",
                );
            }
            if !self.findings.is(Question::CallModalSetsLocalsOnce, site.span) {
                self.findings.not_understood(
                    site.span,
                    "on this control a modal call sets its arguments again \
                                                each time: that is not converted",
                );
            }
            self.modal_calls += 1;
            return self.builder.push(StmtKind::ModalCall(Box::new(call)), site.clone());
        }
        self.builder.end_then(site.clone(), |next| TermKind::Call { call: Box::new(call), next });
    }
}

/// The roles of a call's own letters where its row does not list them.
fn usual(op: Op, letter: char) -> Option<Role> {
    match (op, letter) {
        (Op::CallMacro | Op::CallModal | Op::CallProgram, 'P') => Some(Role::Program),
        (Op::CallLocal | Op::Return | Op::JumpInputOff, 'P') => Some(Role::Sequence),
        (Op::JumpInputOff, 'Q') => Some(Role::Input),
        (Op::CallMacro | Op::CallModal | Op::CallProgram | Op::CallLocal, 'L') => Some(Role::CallCount),
        _ => None,
    }
}
