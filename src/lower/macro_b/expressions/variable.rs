//! Variables: by number, by name, by a computed number.

use super::place::At;
use crate::canon::Sys;
use crate::diag::{Asks, Code, Diagnostic};
use crate::dialect::{Control, Question, SystemVariable, registry};
use crate::ir::{Bank, BinOp, Class, Cond, Expr, Place, Relation, Var, constant_part, shifted};
use crate::lower::common::constant;
use crate::lower::macro_b::build::Lowering;
use crate::syntax::{Index, ItemKind, ParsedFile, VarRef};
use crate::text::Span;
use std::collections::BTreeMap;

/// The names that the programs of a file give to variables.
pub fn names(parsed: &ParsedFile<'_>, control: &Control) -> BTreeMap<String, Var> {
    let mut found = BTreeMap::new();
    for item in parsed.blocks.iter().flat_map(|block| &block.items) {
        let ItemKind::SetNames { first, names } = &item.kind else { continue };
        let Some(first) = user_variable(control, *first) else { continue };
        for (count, name) in names.iter().enumerate().filter(|(_, name)| !name.is_empty()) {
            found.insert(name.to_ascii_uppercase(), behind(first, count));
        }
    }
    found
}

fn user_variable(control: &Control, number: u32) -> Option<Var> {
    let number = control.cell("#", number);
    let row = control.variable_class("#", number)?;
    let class = match row.class.as_str() {
        "local" => Class::Local,
        "common" => Class::Common,
        "retained" => Class::Retained,
        "global" => Class::Global,
        _ => return None,
    };
    Some(Var { class, number })
}

impl<'a> Lowering<'a> {
    /// What a variable reads.
    pub fn read(&mut self, variable: &'a VarRef, depth: u32) -> Expr {
        if let Index::Bit(number, bit) = variable.index {
            return self.bit(number, bit, variable.span);
        }
        let Some(read) = self.variable(variable, depth) else { return Expr::Number(0.0) };
        if let Expr::System(state, _) = &read {
            let state = *state;
            self.early(state, variable.span);
        }
        read
    }

    /// The place that an assignment writes.
    pub fn target_place(&mut self, variable: &'a VarRef) -> Option<Place> {
        let span = variable.span;
        if let Index::Bit(..) = variable.index {
            self.findings.not_understood(span, "a single bit cannot be assigned to");
            return None;
        }
        match self.variable(variable, 0)? {
            Expr::Vacant => {
                self.findings.add(Diagnostic::new(
                    Code::NotWritable,
                    span,
                    "#0 is always vacant; nothing can be assigned to it",
                ));
                None
            }
            Expr::System(state, subscripts) => {
                let row = self.number_of(variable).and_then(|n| self.control.read_system("#", Some(n)));
                if row.is_some_and(|(_, _, row)| !row.access.contains('w')) {
                    let message = format!("'{state}' can be read, not written");
                    self.findings.add(Diagnostic::new(Code::NotWritable, span, message));
                }
                self.early(state, span);
                Some(Place::System(state, subscripts))
            }
            other => other.place(),
        }
    }

    fn number_of(&self, variable: &VarRef) -> Option<u32> {
        match &variable.index {
            Index::Number(number) => Some(*number),
            Index::Computed(index) => {
                let number = constant(index).and_then(crate::ir::eval::whole)?;
                if variable.name == "#" { Some(number) } else { self.of_run(variable, number) }
            }
            Index::Name(name) => self.control.system_named(name).and_then(|row| row.first),
            _ => None,
        }
    }

    /// The number of a variable with a name of the control's and a subscript: `[#_ABSIO[1]]`.
    fn of_run(&self, variable: &VarRef, subscript: u32) -> Option<u32> {
        self.control.number_named(variable.name.strip_prefix('#')?, subscript)
    }

    fn variable(&mut self, variable: &'a VarRef, depth: u32) -> Option<Expr> {
        let span = variable.span;
        match &variable.index {
            _ if variable.name != "#" => {
                if let Some(number) = self.number_of(variable) {
                    return self.numbered(number, span);
                }
                let message = format!("this control has no variable '{}' with that number", variable.name);
                let help = "write the variable's number, as #5001, or #[5000+#1] where it is computed";
                self.findings.add(Diagnostic::new(Code::NotUnderstood, span, message).with_help(help));
                None
            }
            Index::Number(number) => self.numbered(*number, span),
            Index::Computed(index) => match constant(index).filter(|n| n.fract() == 0.0 && *n >= 0.0) {
                Some(number) => self.numbered(crate::ir::eval::whole(number)?, span),
                None => {
                    let number = self.expr_at(index, At::Value, depth + 1);
                    Some(Expr::Indirect(Bank::Numbered, Box::new(self.cell(number, span))))
                }
            },
            Index::Name(name) => self.named(name, span),
            Index::None | Index::Letter(_) | Index::Bit(..) => {
                self.findings.not_understood(span, "the variable has no number");
                None
            }
        }
    }

    /// The variable with a number.
    pub fn numbered(&mut self, number: u32, span: Span) -> Option<Expr> {
        if number == 0 {
            return Some(Expr::Vacant);
        }
        if let Some(class) = self.control.variable_class("#", number) {
            self.findings.rest_on(class, span);
        }
        if let Some(row) = self.control.same_cells("#", number) {
            self.findings.rest_on(row, span);
        }
        if let Some(var) = user_variable(self.control, number) {
            return Some(Expr::Var(var));
        }
        let Some((state, subscripts, row)) = self.control.read_system("#", Some(number)) else {
            let told = match self.control.system_under("#", number) {
                Some((setting, value, stated)) => {
                    let short = setting.split_once('.').map_or(setting, |(_, short)| short);
                    let what = format!("the machine has #{number} only where {short} is {value}");
                    let help = "look at the machine, and write its value into its profile";
                    let told = Diagnostic::new(Code::NotUnderstood, span, what).with_help(help);
                    if stated { told } else { told.lacking(format!("{setting}={value}")) }
                }
                None => missing(self.control, number, span),
            };
            self.findings.add(told);
            return None;
        };
        self.findings.rest_on(row, span);
        if state == Sys::Empty {
            return Some(Expr::Vacant);
        }
        Some(Expr::System(state, subscripts.into_iter().map(|n| Expr::Number(f64::from(n))).collect()))
    }

    /// The computed number of a cell, where its constant part is a second number. That it stays among those is
    /// looked at where computed numbers are.
    fn cell(&mut self, number: Expr, span: Span) -> Expr {
        let Some(start) = constant_part(&number).and_then(crate::ir::eval::whole) else { return number };
        let Some(row) = self.control.same_cells("#", start) else { return number };
        self.findings.rest_on(row, span);
        shifted(number, f64::from(row.cell) - f64::from(row.first))
    }

    /// The variable with a name: one of this file's SETVN, or the control's own.
    fn named(&mut self, name: &str, span: Span) -> Option<Expr> {
        let name = name.to_ascii_uppercase();
        if let Some(var) = self.names.get(&name) {
            return Some(Expr::Var(*var));
        }
        if let Some((state, subscripts, row)) = self.system_name(&name) {
            self.findings.rest_on(row, span);
            if state == Sys::Empty {
                return Some(Expr::Vacant);
            }
            return Some(Expr::System(
                state,
                subscripts.into_iter().map(|n| Expr::Number(f64::from(n))).collect(),
            ));
        }
        let message = format!("no program of this file gives the name '{name}' to a variable");
        let help = "write the variable's number, or its SETVN into this file";
        self.findings.add(Diagnostic::new(Code::NotUnderstood, span, message).with_help(help));
        None
    }

    /// A variable that the control itself names.
    fn system_name(&self, name: &str) -> Option<(Sys, Vec<u32>, &'a SystemVariable)> {
        let row = self.control.system_named(name)?;
        let subscripts = match row.first {
            Some(first) => row.subscripts_of(first)?,
            None => [row.fixed.as_slice(), &row.after].concat(),
        };
        row.subscripts.is_empty().then_some((row.state, subscripts, row))
    }

    /// One bit of a system variable: 1 or 0.
    fn bit(&mut self, number: u32, bit: u32, span: Span) -> Expr {
        let whole = match self.numbered(number, span) {
            Some(whole @ Expr::System(..)) if bit < 32 => whole,
            Some(_) => {
                self.findings.not_understood(span, format!("no source says what bit {bit} of #{number} is"));
                return Expr::Number(0.0);
            }
            None => return Expr::Number(0.0),
        };
        let note = format!("the fraction in #{number}.{bit} is taken as a bit number");
        self.findings.unconfirmed("statement:read.bit".into(), Some(&note), span);
        let mask = Expr::Number(2f64.powi(bit as i32));
        let masked = Expr::binary(BinOp::And, whole, mask);
        Expr::Truth(Box::new(Cond::Compare(Relation::NotEqual, masked, Expr::Number(0.0))))
    }

    /// A control that reads ahead may see a state before the moves ahead of it are done.
    fn early(&mut self, state: Sys, span: Span) {
        let early =
            state.is_read_early() && !self.lookahead_limited && self.control.is(Question::LookaheadRunsEarly);
        if !early || self.builder.has_waited() || !self.codes.tell_early() {
            return;
        }
        if self.findings.behaviour(Question::SystemReadWaits, span) != Some("true") {
            let meaning = state.meaning().trim().trim_end_matches('.');
            let message = format!("'{state}' ({meaning}) may be read before earlier moves are done");
            let finding = Diagnostic::new(Code::EarlyRead, span, message);
            self.findings.add(finding.with_fact(Question::LookaheadRunsEarly.fact()));
        }
    }
}

/// The variable `count` places after `first`.
fn behind(first: Var, count: usize) -> Var {
    Var { number: first.number.saturating_add(count as u32), ..first }
}

/// What is told of a number that the table does not have. Where the table of a control of the family has it as one of the
/// system's, the machine has no variable of the shop there.
fn missing(control: &Control, number: u32, span: Span) -> Diagnostic {
    let what = format!("the table of this control has no variable #{number}");
    let family = &control.dialect().family;
    let others = registry::all().iter().filter_map(|entry| entry.dialect().ok());
    let mut others = others.filter(|other| other.family == *family && other.name != control.name());
    let is_it = |row: &&SystemVariable| row.name == "#" && row.first == Some(number);
    let found = others.find_map(|other| Some((&other.title, other.system.iter().find(is_it)?)));
    let Some((title, row)) = found else {
        let help = "if the machine has it as a variable of its own, name it in 'variables' of its profile, with all others. If it is one \
                    of the control's, look up what it reads, and write what the table has for that";
        let told = Diagnostic::new(Code::NotUnderstood, span, what).with_help(help);
        return told.asking_for(Asks::Variable { number });
    };
    let note = row.origin.note.as_deref().unwrap_or_else(|| row.state.meaning().trim());
    let what = format!("{what}; on a {title} it is one of the control's ({note})");
    let help = "if the program is written for that control, name that one as the source. Else write what this control has for it";
    Diagnostic::new(Code::NotUnderstood, span, what).with_help(help)
}
