//! Prints modules, programs, statements and terminators.

use super::lex::quote;
use super::print_expr::class_name;
use crate::ir::{
    Call, Callee, Expr, Module, Nc, NcItem, OutputPart, PrintPart, Program, SourceInfo, Stmt, StmtKind,
    TermKind, Terminator,
};
use crate::syntax::{Label, ProgramName};
use crate::text::Span;
use std::fmt::{Display, Formatter, Result};

/// The text of a module.
pub fn print(module: &Module) -> String {
    module.to_string()
}

impl Display for Module {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        for (var, name) in &self.names {
            writeln!(f, "name {var} {}", quote(name))?;
        }
        self.programs.iter().try_for_each(|program| write!(f, "{program}"))
    }
}

impl Display for Program {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let name = self.name.as_ref().map_or("unnamed".into(), program_name);
        write!(f, "program {name} file {}", self.file)?;
        site(f, &self.site)?;
        writeln!(f, " {{")?;
        self.held.iter().try_for_each(|(var, name)| writeln!(f, "    holds {var} {}", quote(name)))?;
        for (id, block) in self.ids().zip(&self.blocks) {
            write!(f, "{id}")?;
            if !block.labels.is_empty() {
                let labels: Vec<String> = block.labels.iter().map(label).collect();
                write!(f, " ({})", labels.join(", "))?;
            }
            writeln!(f, ":")?;
            block.stmts.iter().try_for_each(|stmt| writeln!(f, "    {stmt}"))?;
            writeln!(f, "    {}", block.term)?;
        }
        writeln!(f, "}}")
    }
}

impl Display for Stmt {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{}", self.kind)?;
        site(f, &self.site)
    }
}

impl Display for Terminator {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{}", self.kind)?;
        site(f, &self.site)
    }
}

impl Display for StmtKind {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let port = |serial: bool| if serial { "serial " } else { "" };
        match self {
            StmtKind::Comment => f.write_str("comment"),
            StmtKind::Assign { target, value } => write!(f, "{target} = {value}"),
            StmtKind::ClearAll(class) => write!(f, "clear {}", class_name(*class)),
            StmtKind::Nc(nc) => write!(f, "{nc}"),
            StmtKind::ModalCall(call) => write!(f, "modal {call}"),
            StmtKind::ModalCallOff => f.write_str("modal.off"),
            StmtKind::Alarm { number, text } => write!(f, "alarm {number} {}", quote(text)),
            StmtKind::StopMessage { number, text } => write!(f, "stop {number} {}", quote(text)),
            StmtKind::Output(parts) => {
                let parts = parts.iter().map(|part| match part {
                    OutputPart::Text(text) => quote(text),
                    OutputPart::Value { value, whole, fraction } => format!("{value}: {whole}, {fraction}"),
                });
                write!(f, "output [{}]", parts.collect::<Vec<_>>().join(", "))
            }
            StmtKind::OpenPort => f.write_str("port.open"),
            StmtKind::ClosePort => f.write_str("port.close"),
            StmtKind::Print { serial, parts, stay } => {
                let parts = parts.iter().map(|part| match part {
                    PrintPart::Text(text) => quote(text),
                    PrintPart::Value(value) => value.to_string(),
                });
                let stay = if *stay { " stay" } else { "" };
                write!(f, "print {}[{}]{stay}", port(*serial), parts.collect::<Vec<_>>().join(", "))
            }
            StmtKind::Input { serial, target } => write!(f, "input {}{target}", port(*serial)),
            StmtKind::Sync => f.write_str("sync"),
            StmtKind::LimitLookahead(count) => write!(f, "lookahead {count}"),
            StmtKind::SetNames { first, names } => {
                let names: Vec<String> = names.iter().map(|name| quote(name)).collect();
                write!(f, "names {first} [{}]", names.join(", "))
            }
        }
    }
}

impl Display for Nc {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str("nc")?;
        // An operation between words needs no fence: it ends at a blank.
        let value = |e: &Expr| if matches!(e, Expr::Binary(..)) { format!("({e})") } else { e.to_string() };
        self.items.iter().try_for_each(|item| match item {
            NcItem::Op(op) => write!(f, " {op}"),
            NcItem::Word(role, e) => write!(f, " {role}={}", value(e)),
            NcItem::Code(letter, e) if letter.is_ascii_uppercase() => write!(f, " {letter}={}", value(e)),
            NcItem::Code(letter, e) => write!(f, " {}={}", quote(&letter.to_string()), value(e)),
        })
    }
}

impl Display for TermKind {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            TermKind::Jump(to) => write!(f, "jump {to}"),
            TermKind::Branch { cond, then, otherwise } => write!(f, "branch {cond} ? {then} : {otherwise}"),
            TermKind::Computed { value, targets } => {
                let targets: Vec<String> =
                    targets.iter().map(|(number, to)| format!("{number}: {to}")).collect();
                write!(f, "computed {value} {{{}}}", targets.join(", "))
            }
            TermKind::Call { call, next } => write!(f, "call {call} -> {next}"),
            TermKind::Return { to: None } => f.write_str("return"),
            TermKind::Return { to: Some(to) } => write!(f, "return to {to}"),
            TermKind::Chain(name) => write!(f, "chain {}", program_name(name)),
            TermKind::End { rewind } => f.write_str(if *rewind { "end rewind" } else { "end" }),
            TermKind::Stray => f.write_str("stray"),
        }
    }
}

impl Display for Call {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match &self.callee {
            Callee::Program(name) => f.write_str(&program_name(name))?,
            Callee::Block(entry) => write!(f, "{entry}")?,
            Callee::Computed(number) => write!(f, "computed {number}")?,
            Callee::Cycle(number) => write!(f, "cycle {number}")?,
        }
        if self.level {
            f.write_str(" level")?;
        }
        if !self.arguments.is_empty() {
            let arguments = self.arguments.iter().map(|a| format!("{}: {}", a.local, a.value));
            write!(f, " ({})", arguments.collect::<Vec<_>>().join(", "))?;
        }
        self.count.iter().try_for_each(|count| write!(f, " times {count}"))
    }
}

fn site(f: &mut Formatter<'_>, site: &SourceInfo) -> Result {
    if site.span != Span::default() {
        write!(f, " @{}..{}", site.span.start, site.span.end)?;
    }
    site.sequence.get().iter().try_for_each(|number| write!(f, " N{number}"))?;
    site.skip.iter().try_for_each(|level| write!(f, " skip {level}"))?;
    site.comments.iter().try_for_each(|comment| {
        write!(f, " {}{}", if comment.leading { "^" } else { "" }, quote(&comment.text))
    })
}

fn program_name(name: &ProgramName) -> String {
    match name {
        ProgramName::Number(number) => format!("O{number}"),
        ProgramName::Name(name) => quote(name),
    }
}

fn label(label: &Label) -> String {
    match label {
        Label::Number(number) => format!("N{number}"),
        Label::Name(name) => {
            let plain = name.starts_with(|c: char| c.is_ascii_alphabetic())
                && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
            if plain { format!(":{name}") } else { format!(":{}", quote(name)) }
        }
    }
}
