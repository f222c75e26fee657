//! Names of variables in texts that people read, where the variable has another register on the target.
//!
//! Law: a text that names a variable of the programs names the register that holds it, so whoever reads it looks at, or
//! sets, the same value. Side condition: the text leaves no doubt that a variable is meant; else it stays as it is, and a
//! note says so. Counter-example: `(TOOL #5)`, where #5 is a variable too.

use crate::canon::{Op, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Comment, Module, PrintPart, Program, Stmt, StmtKind, Var, flag_of};
use crate::legalize::Context;
use crate::legalize::registers::names::{OF, numbered_name, whose};
use crate::text::{Span, VariableName, variable_names, variable_to_set};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// What the registers of variables are called, by prefix and number on the source, and by whose they are where a text says
/// it: `#1 of O9010`.
type Names = BTreeMap<(String, u32, String), String>;

/// Puts the target's names into texts.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let source = context.source;
    let prefixes = source.prefixes();
    let shared = of_library(&prefixes, context);
    let flags = flagged(context);
    // Where no message stops the machine, the operator is shown a text, stopped, and sets the register there.
    let sets = context.target.system_runs(Sys::StopMessage).next().is_none();
    // At a stop too, where its comment is shown.
    let stops = source.is(Question::MessageShowsComment);
    for (index, program) in module.programs.iter_mut().enumerate() {
        // Most programs have none of their own: what the library has is not copied for each.
        let own = (!program.held.is_empty()).then(|| {
            let names = of_program(program, &shared, &prefixes, context);
            let flagged = with_flags(program, &names, &flags, &prefixes);
            (names, flagged)
        });
        let (names, flagged) = own.as_ref().map_or((&shared, &flags), |(names, flagged)| (names, flagged));
        if names.is_empty() {
            continue;
        }
        let mut writer =
            Writer { names, flagged, prefixes: &prefixes, context, index, span: program.site.span };
        writer.comments(&mut program.site.comments);
        for block in &mut program.blocks {
            let asks = before_questions(&block.stmts);
            for (stmt, asks) in block.stmts.iter_mut().zip(asks) {
                writer.span = stmt.site.span;
                let asks_there = sets && stops && matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(Op::Stop));
                let shown = stmt.site.comments.first().filter(|_| asks_there);
                let asked = shown.and_then(|shown| writer.asked(&shown.text));
                let named = writer.comments(&mut stmt.site.comments);
                if let (Some(shown), Some(register)) = (stmt.site.comments.first_mut(), asked) {
                    writer.ask(&mut shown.text, &register);
                }
                writer.texts(&mut stmt.kind, sets, asks);
                if asks_there {
                    let set = named.filter(|register| writer.flagged.contains(register));
                    set.iter().for_each(|register| writer.set(register));
                }
            }
            writer.span = block.term.site.span;
            writer.comments(&mut block.term.site.comments);
        }
    }
}

/// The variables that all programs see and that moved.
fn of_library(prefixes: &[&str], context: &Context<'_>) -> Names {
    let shared = context.registers.of.iter().filter(|(var, _)| var.class.is_numbered());
    let named = shared.filter_map(|(var, register)| {
        let own = numbered_name(*var, context.source)?;
        let name = format!("{}{}", register.name, register.number);
        (own != name).then_some((key(&own, prefixes)?, name))
    });
    named.collect()
}

/// Those and the locals of a program, on a target without locals.
fn of_program(program: &Program, shared: &Names, prefixes: &[&str], context: &Context<'_>) -> Names {
    let register = |var: &Var| context.registers.of.get(var).map(|r| format!("{}{}", r.name, r.number));
    let locals = program.held.iter().filter_map(|(var, name)| {
        let whose = name.find(OF).map_or("", |at| &name[at..]);
        let (prefix, number, _) = key(name.strip_suffix(whose)?, prefixes)?;
        Some(((prefix, number, whose.to_owned()), register(var)?))
    });
    shared.iter().map(|(key, name)| (key.clone(), name.clone())).chain(locals).collect()
}

/// The registers of variables that may be vacant on the source, and have flags.
fn flagged(context: &Context<'_>) -> BTreeSet<String> {
    let flagged =
        context.registers.of.iter().filter(|(var, _)| context.registers.of.contains_key(&var.flag()));
    flagged.map(|(_, register)| format!("{}{}", register.name, register.number)).collect()
}

/// Those and what a program holds.
fn with_flags(
    program: &Program,
    names: &Names,
    flags: &BTreeSet<String>,
    prefixes: &[&str],
) -> BTreeSet<String> {
    let held = program.held.iter().filter_map(|(_, name)| key(name.strip_prefix(&flag_of(""))?, prefixes));
    flags.iter().cloned().chain(held.filter_map(|key| names.get(&key).cloned())).collect()
}

/// A name, where it is nothing more than that.
fn key(name: &str, prefixes: &[&str]) -> Option<(String, u32, String)> {
    let one = variable_names(name, prefixes).into_iter().next()?;
    (one.at == (0..name.len())).then_some((one.prefix, one.number, String::new()))
}

/// Numbers below count something more often than they name a variable.
const LEAST: u32 = 100;

/// The whole numbers that stand by themselves in a text.
fn bare_numbers(text: &str) -> impl Iterator<Item = u32> {
    let apart =
        |letter: char| letter.is_whitespace() || matches!(letter, '(' | ')' | ',' | ':' | ';' | '=' | '/');
    text.split(apart)
        .filter(|word| word.bytes().all(|byte| byte.is_ascii_digit()))
        .filter_map(|word| word.parse().ok())
}

/// For each statement, whether a question comes next.
fn before_questions(stmts: &[Stmt]) -> Vec<bool> {
    let (mut asks, mut all) = (false, Vec::with_capacity(stmts.len()));
    for stmt in stmts.iter().rev() {
        all.push(asks);
        if stmt.kind != StmtKind::Comment {
            asks = matches!(stmt.kind, StmtKind::Input { .. });
        }
    }
    all.reverse();
    all
}

struct Writer<'w, 'c> {
    names: &'w Names,
    /// The registers whose variables have flags.
    flagged: &'w BTreeSet<String>,
    prefixes: &'w [&'w str],
    context: &'w mut Context<'c>,
    index: usize,
    span: Span,
}

impl Writer<'_, '_> {
    /// The register that the first comment names first.
    fn comments(&mut self, comments: &mut [Comment]) -> Option<String> {
        let named: Vec<_> = comments.iter_mut().map(|comment| self.take(&mut comment.text, None)).collect();
        named.into_iter().next().flatten()
    }

    /// `sets` where the operator sets a variable at any stop, `asks` for what stands before a question.
    fn texts(&mut self, kind: &mut StmtKind, sets: bool, asks: bool) {
        match kind {
            StmtKind::Alarm { text, .. } => {
                self.bare_numbers(text);
                drop(self.take_boxed(text, None));
            }
            StmtKind::StopMessage { text, .. } => {
                self.bare_numbers(text);
                // A message that begins with a name asks for it: `#5 DEPTH`.
                let asked = variable_to_set(text, self.prefixes).map(|name| name.at);
                let asks = self.asked(text).filter(|_| sets);
                if let Some(register) = self.take_boxed(text, asked).filter(|_| sets) {
                    self.set(&register);
                }
                if let Some(register) = asks {
                    let mut whole = String::from(std::mem::take(text));
                    self.ask(&mut whole, &register);
                    *text = whole.into();
                }
            }
            // What goes to a port may be read by a program, and comes back as it is.
            StmtKind::Print { serial: false, parts, .. }
                if asks || self.context.target.statement("print").is_some() =>
            {
                parts.iter_mut().for_each(|part| {
                    if let PrintPart::Text(text) = part {
                        self.take(text, None);
                    }
                });
            }
            _ => {}
        }
    }

    /// Asks a person to look at a text that may name a variable by its number alone: `SET 560 FIRST`.
    fn bare_numbers(&mut self, text: &str) {
        for number in bare_numbers(text).filter(|number| *number >= LEAST) {
            let found = self.prefixes.iter().find_map(|prefix| {
                let key = ((*prefix).to_owned(), number, String::new());
                self.names.get(&key).map(|name| (format!("{prefix}{number}"), name.clone()))
            });
            let Some((own, name)) = found else { continue };
            let what = format!(
                "the operator reads '{}': if that is {own}, write {name} into the text, which is where the target has it",
                text.trim()
            );
            self.context.add(self.index, Diagnostic::new(Code::Conditional, self.span, what));
        }
    }

    /// The register of the variable that a text asks for.
    fn asked(&self, text: &str) -> Option<String> {
        let name = variable_to_set(text, self.prefixes)?;
        self.names.get(&(name.prefix, name.number, String::new())).cloned()
    }

    /// Leaves no doubt that a text asks for a register: `TYPE #500` does, `TYPE V1` may count something.
    fn ask(&self, text: &mut String, register: &str) {
        let prefixes = self.context.target.prefixes();
        let is_it = |name: &VariableName| format!("{}{}", name.prefix, name.number) == register;
        if variable_to_set(text, &prefixes).is_none_or(|name| !is_it(&name))
            && let Some(name) = variable_names(text, &prefixes).into_iter().find(is_it)
        {
            text.insert(name.at.end, '=');
        }
    }

    /// Tells that the operator must set a register.
    fn set(&mut self, register: &str) {
        let set = "the message names a variable: the operator must set it in";
        let vacant = if self.flagged.contains(register) {
            "; it is no longer vacant then, but 0 if nothing is entered"
        } else {
            ""
        };
        let what = format!("{set} {register} at the stop, before cycle start{vacant}");
        self.context.add(self.index, Diagnostic::new(Code::Conditional, self.span, what));
    }

    /// The same for a text that never grows.
    fn take_boxed(&mut self, text: &mut Box<str>, asked: Option<Range<usize>>) -> Option<String> {
        let mut whole = String::from(std::mem::take(text));
        let first = self.take(&mut whole, asked);
        *text = whole.into();
        first
    }

    /// Puts the target's names into a text; gives the first of them. The name at `asked` counts as sure.
    fn take(&mut self, text: &mut String, asked: Option<Range<usize>>) -> Option<String> {
        let mut first = None;
        for found in variable_names(text, self.prefixes).into_iter().rev() {
            let whose = whose(&text[found.at.end..]).to_owned();
            let told = self.names.get(&(found.prefix.clone(), found.number, whose.clone()));
            if let Some(name) = told.filter(|_| !whose.is_empty()) {
                text.replace_range(found.at.start..found.at.end + whose.len(), name);
                first = Some(name.clone());
                continue;
            }
            let Some(name) = self.names.get(&(found.prefix, found.number, String::new())) else { continue };
            if found.sure || asked.as_ref() == Some(&found.at) {
                text.replace_range(found.at, name);
                first = Some(name.clone());
            } else {
                let what = format!(
                    "'{}' may name a variable, which is {name} on the target: the text stays as it is",
                    text.trim()
                );
                let note = Diagnostic::new(Code::NameInText, self.span, what);
                self.context.add_once(self.index, "names in texts", note);
            }
        }
        first
    }
}
