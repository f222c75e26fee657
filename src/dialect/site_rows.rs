//! Lays the codes of a machine's builder over a table, and refuses what cannot be one.

use super::control_codes::address;
use super::overlay::Overlay;
use super::reader::closest;
use super::site::{SiteCode, Without, fingerprint};
use super::{Beside, CodeHead, CodeMeaning, Dialect, Subscript, SystemVariable, VariableRun};
use crate::canon::{Act, Group, Op, Role, Sys};
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};

impl Overlay {
    /// Adds the codes of the machine's builder; they stand for the table's own of that number.
    pub(super) fn site(&mut self, dialect: &mut Dialect) {
        let mut written: BTreeMap<Act, String> = BTreeMap::new();
        let mut seen: Vec<(CodeHead, Vec<Beside>)> = Vec::new();
        let profile = self.profile.clone();
        let owner = LazyCell::new(|| fingerprint(&profile));
        for site in profile.site.clone() {
            let act = site.act(|| *owner);
            let row = site.row(act);
            let (Some(head), Some(beside)) = (row.head(), row.beside()) else {
                let message = format!("'{}' is not a code", site.code);
                self.site_fault(&site, message, "write a letter and a number: 'M20'");
                continue;
            };
            if seen.contains(&(head, beside.clone())) {
                let message = format!("{} stands in the profile twice", site.code);
                self.site_fault(&site, message, "keep one of the two");
                continue;
            }
            seen.push((head, beside));
            self.check_site(&site, &row, dialect);
            if let Some(act) = act.filter(|_| site.preferred)
                && let Some(other) = written.insert(act, site.code.clone())
            {
                let message = format!("{other} and {} have one name", site.code);
                let help = "give each a name of its own; if both do the same, put preferred = false at the one that is \
                            not to be written";
                self.site_fault(&site, message, help);
            }
            self.site_variables(&site, dialect);
            if site.calls.is_some() {
                self.check_call(&site, dialect);
            }
            match site.calls {
                Some(_) if site.target.is_none() => dialect.codes.retain(|old| old.head() != Some(head)),
                _ => lay(dialect, row),
            }
        }
    }

    fn site_fault(&mut self, site: &SiteCode, message: String, help: &str) {
        self.fault(&format!("site:{}", site.code), message, help.into());
    }

    fn check_site(&mut self, site: &SiteCode, row: &CodeMeaning, dialect: &Dialect) {
        let code = &site.code;
        if matches!(site.without, Some(Without::Stop | Without::Alarm)) && site.text.trim().is_empty() {
            let help =
                "write in a few words what the operator must do or know there: text = \"chuck air on\"";
            let message =
                format!("{code} has no 'text', which is the message of the stop or alarm in its place");
            self.site_fault(site, message, help);
        }
        if row.op.is_flow()
            || matches!(row.op, Op::MachineSpecific | Op::Act | Op::Builder) && site.op.is_some()
        {
            let message = format!("'{code}' cannot mean '{}'", row.op);
            let help = "leave 'op' out; for a code that calls a program write calls = 9010";
            self.site_fault(site, message, help);
        }
        let axes = || row.fixed.keys().chain(row.words.values()).any(|role| role.is_axis());
        if row.op == Op::MirrorOn && code.starts_with('M') && site.op.is_some() && !axes() {
            let message = format!("'{code}' does not say which axis it mirrors");
            let help = "name the code of the target with its axis in place of op: target = \"G51.1 X0\"; or write fixed = { \"axis.x\" = 0 } \
                        beside op";
            self.site_fault(site, message, help);
        }
        if matches!(row.op, Op::OutputOn | Op::OutputOff) && !row.fixed.contains_key(&Role::Output) {
            let message = format!("'{code}' does not say which output it switches");
            let help = "write fixed = { \"output.bit\" = 24 }: the number that programs of the other control know it by";
            self.site_fault(site, message, help);
        }
        self.check_with(site);
        self.check_answers(site);
        self.check_words(site, row);
        if site.op.is_none() && (site.calls.is_none() || site.target.is_some()) {
            self.check_beside(site, row, dialect);
        }
        if site.op.is_none() {
            self.check_standard(site, row, dialect);
        }
    }

    /// What a code does besides.
    fn check_with(&mut self, site: &SiteCode) {
        let Some(first) = site.with.first() else { return };
        let Some(op) = site.op else {
            let message = format!("{} does '{first}' with something that is not said", site.code);
            return self.site_fault(
                site,
                message,
                "write op = \"spindle.cw\" beside it: what the code does first",
            );
        };
        let mut all = std::iter::once(&op).chain(&site.with);
        if let Some(odd) = all.find(|op| !can_stand_together(**op)) {
            let message = format!("'{odd}' cannot be done together with something else");
            self.site_fault(site, message, "beside 'with' there are operations of spindle and coolant alone");
        } else if clash(op, &site.with) {
            self.site_fault(site, format!("{} switches one thing twice", site.code), "name each once");
        }
    }

    /// Keys that say two things of one code.
    fn check_answers(&mut self, site: &SiteCode) {
        let code = &site.code;
        let named = site.name.is_some() || site.target.is_some() || site.without.is_some();
        if site.op.is_some() && named {
            let help = "'op' says what it does: leave out 'name', 'target' and 'do'";
            self.site_fault(site, format!("{code} has two meanings"), help);
        }
        if site.target.is_some() && site.without.is_some() {
            let help = "leave out 'do', or 'target'";
            self.site_fault(site, format!("{code} has 'target' and 'do': one of them counts"), help);
        }
        let odd = |name: &String| {
            name.is_empty()
                || !name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-'))
        };
        let names = site.name.iter().chain(site.reads.values()).chain(site.sets.values());
        if let Some(name) = names.clone().find(|name| odd(name)) {
            let help = "write a name of letters, digits, points, '-' and '_': name = \"chuck.air.on\"";
            self.site_fault(site, format!("'{name}' is not a name"), help);
        }
        if let Some(target) = &site.target
            && !is_code(&CodeMeaning { code: target.clone(), ..site.row(None) })
        {
            let help = "name the code of the other machine, with the words that it always has: target = \"M88\", \"M19 P90\", \"M3 M8\"";
            self.site_fault(site, format!("'{target}' is not a code"), help);
        }
        let other = site.name.is_some() || site.without.is_some();
        if site.calls.is_some() && (site.op.is_some() || other) {
            let help = "'calls' says what it does: leave out 'op', 'name' and 'do'";
            self.site_fault(site, format!("{code} has two meanings"), help);
        }
        if site.arguments && site.builders_program().is_some() {
            let help = "leave 'arguments' out: the program is not converted, and words = { P = \"P\" } says what the target's code takes";
            self.site_fault(site, format!("{code} has 'arguments' and 'target'"), help);
        }
        if site.arguments && site.calls.is_none() {
            let help = "write calls = 9010 beside it: the program that gets them";
            self.site_fault(site, format!("{code} has arguments and calls no program"), help);
        }
    }

    /// Only some controls can make a code call a program.
    fn check_call(&mut self, site: &SiteCode, dialect: &Dialect) {
        if !dialect.settings.iter().any(|row| row.alias.is_some()) {
            let message =
                format!("{} calls a program, which no code of a builder does on this control", site.code);
            self.site_fault(site, message, "leave 'calls' out, and say by 'name' or 'do' what it does");
        } else if !site.words.is_empty() && site.target.is_none() {
            let help = "leave 'words' out: the letters of the block are arguments, or none of its business";
            self.site_fault(site, format!("{} has words and calls a program", site.code), help);
        }
    }

    /// A row that is chosen by the letter of an axis says what the letter is: else the word would move that axis still.
    fn check_beside(&mut self, site: &SiteCode, row: &CodeMeaning, dialect: &Dialect) {
        for beside in row.beside().into_iter().flatten() {
            let letter = beside.letter.to_string();
            let moves = dialect.words.iter().any(|word| word.letter == letter && word.role.is_axis());
            if moves && !row.words.contains_key(&letter) {
                let help = match &site.target {
                    Some(target) => format!(
                        "say what becomes of it: words = {{ {letter} = \"\" }} where {target} takes no word for it, or the letter that {target} has for it"
                    ),
                    None => format!("say what it is: words = {{ {letter} = \"place\" }}"),
                };
                let message = format!("{} would leave {letter} as a move of its own", site.code);
                self.site_fault(site, message, &help);
            }
        }
    }

    fn check_words(&mut self, site: &SiteCode, row: &CodeMeaning) {
        let mut told: BTreeMap<&str, &str> = BTreeMap::new();
        for (letter, meaning) in &site.words {
            let stands = site.target.is_some() || site.without.is_some();
            let drops = meaning.trim().is_empty() && stands;
            if site.op.is_none()
                && !drops
                && let Some(other) = told.insert(meaning, letter)
            {
                let message = format!("{other} and {letter} of {} are both '{meaning}'", site.code);
                self.site_fault(site, message, "give each word a meaning of its own");
            }
            let is_letter = address(letter).is_some_and(|(letter, _)| letter.is_ascii_uppercase());
            if !(is_letter || letter.starts_with('R')) || matches!(letter.as_str(), "G" | "M" | "N" | "O") {
                let help = "write a letter and what it is: words = { P = \"level\" }";
                self.site_fault(site, format!("'{letter}' is not the letter of a word"), help);
            } else if site.op.is_some() && Role::find(meaning).is_none() {
                let near = closest(meaning, Role::ALL.iter().map(|role| role.name()));
                let help = match near {
                    Some(near) => format!("did you mean '{near}'?"),
                    None => "beside 'op' a word has a role: words = { F = \"dwell.s\" }".into(),
                };
                self.site_fault(site, format!("'{meaning}' is not the role of a word"), &help);
            } else if meaning.trim().is_empty() && !drops {
                let help = format!("name what it is: words = {{ {letter} = \"level\" }}");
                self.site_fault(site, format!("{letter} of {} has no name", site.code), &help);
            } else if site.target.is_some() && !drops && address(meaning).is_none() {
                let help = format!(
                    "beside 'target' a word becomes a letter of that code: words = {{ {letter} = \"P\" }}, or \"\" where that code \
                     takes no word for it"
                );
                self.site_fault(site, format!("'{meaning}' is not the letter of a word"), &help);
            } else if !row.words.contains_key(letter) {
                let most = Role::ACT_WORDS.len();
                let message = format!("the codes named as {} have more than {most} words in all", site.code);
                self.site_fault(site, message, "give each word the same name in both profiles");
            }
        }
    }

    /// A code that ends a program, calls one or sets a mode does so whatever a builder adds. Of a cycle that only this family
    /// of controls has a row says what becomes of it elsewhere.
    fn check_standard(&mut self, site: &SiteCode, row: &CodeMeaning, dialect: &Dialect) {
        let standard = (dialect.codes.iter())
            .filter(|old| old.head() == row.head() && old.beside() == row.beside())
            .find(|old| {
                let switched = matches!(old.op.group(), Group::OneShot | Group::Spindle | Group::Coolant)
                    || old.op == Op::CycleOther;
                old.op.is_flow() || !switched
            });
        if let Some(standard) = standard {
            let meaning = standard.op.meaning().trim().trim_end_matches('.');
            let message = format!("{} has a meaning of its own on this control: {meaning}", site.code);
            self.site_fault(site, message, "leave its row out: a builder cannot change what it does");
        }
    }

    /// Makes the variables that a code reads or sets state of the machine, known by their names.
    fn site_variables(&mut self, site: &SiteCode, dialect: &mut Dialect) {
        for (variable, name) in site.reads.iter().chain(&site.sets) {
            let run = VariableRun::read(variable).filter(|run| run.first == run.last && !run.letter);
            let Some(run) = run else {
                let help = "write one variable and its name: sets = { \"#501\" = \"air.pressure\" }";
                self.site_fault(site, format!("'{variable}' is not a variable"), help);
                continue;
            };
            let number = Act::named(name).number() as u32;
            let here = |row: &SystemVariable| row.first == Some(run.first) && row.name == run.name;
            let mut shared = dialect.system.iter().filter(|row| row.state == Sys::Act);
            match shared.find(|row| here(row) || number_of(row) == Some(number)) {
                Some(row) if here(row) && number_of(row) == Some(number) => continue,
                Some(_) => {
                    let message = format!("{variable} and '{name}' are paired otherwise at another code");
                    self.site_fault(site, message, "one variable has one name");
                    continue;
                }
                None => {}
            }
            take_out(dialect, &run);
            dialect.system.insert(0, state_of(&run, number, site));
        }
    }
}

/// Lays a row over the table's own of the same code.
pub(super) fn lay(dialect: &mut Dialect, row: CodeMeaning) {
    dialect.codes.retain(|old| old.head() != row.head() || old.beside() != row.beside());
    // The control's own spelling of an operation stays the one that is written.
    let taken = dialect.codes.iter().any(|old| old.op == row.op && old.fixed == row.fixed && old.preferred);
    let preferred = row.preferred && !taken && row.op != Op::Builder;
    dialect.codes.push(CodeMeaning { preferred, ..row });
}

/// Takes a variable out of the classes that programs may use freely.
fn take_out(dialect: &mut Dialect, run: &VariableRun) {
    let classes = std::mem::take(&mut dialect.variables);
    for class in classes {
        let holds = class.name == run.name
            && class.class != "letter"
            && (class.first..=class.last).contains(&run.first);
        if !holds {
            dialect.variables.push(class);
            continue;
        }
        if class.first < run.first {
            dialect.variables.push(super::VariableClass { last: run.first - 1, ..class.clone() });
        }
        if run.first < class.last {
            dialect.variables.push(super::VariableClass { first: run.first + 1, ..class });
        }
    }
}

/// The number of the name that a variable of a builder's code has.
fn number_of(row: &SystemVariable) -> Option<u32> {
    row.subscripts.first().map(|subscript| subscript.from)
}

fn state_of(run: &VariableRun, number: u32, site: &SiteCode) -> SystemVariable {
    SystemVariable {
        state: Sys::Act,
        name: run.name.clone(),
        alias: None,
        first: Some(run.first),
        subscripts: vec![Subscript { from: number, count: 1, step: 1, axis: false }],
        array: false,
        access: "rw".into(),
        most: None,
        fixed: Vec::new(),
        after: Vec::new(),
        machine: None,
        when: None,
        option: None,
        origin: site.row(None).origin,
    }
}

impl Without {
    /// As a profile spells it.
    pub const fn name(self) -> &'static str {
        match self {
            Without::Omit => "omit",
            Without::Stop => "stop",
            Without::Same => "same",
            Without::Alarm => "alarm",
        }
    }
}

/// True for an operation that one code may do together with another: what turns the spindle, and what switches coolant.
pub(super) fn can_stand_together(op: Op) -> bool {
    matches!(op.group(), Group::Spindle | Group::Coolant) && op != Op::SpindleOrient
}

/// True where an operation and others beside it switch one thing twice.
pub(super) fn clash(op: Op, with: &[Op]) -> bool {
    let groups: BTreeSet<Group> = std::iter::once(op).chain(with.iter().copied()).map(Op::group).collect();
    groups.len() <= with.len()
}

/// True for a code that is spelled right, with the words beside it.
fn is_code(row: &CodeMeaning) -> bool {
    row.head().is_some() && row.beside().is_some()
}
