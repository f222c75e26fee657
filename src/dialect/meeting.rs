//! Two machines of one conversion: codes that the source's profile names on the target.

use super::control::Control;
use super::site::{SiteCode, Without};
use super::spelling::{Beside, CodeHead};
use super::{CodeMeaning, Machine, Mark, Question, faults_as_text, site_rows, standing_results};
use crate::canon::{Act, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::text::Span;
use std::collections::BTreeMap;

/// A code that the source's profile names on the target, and that cannot be that.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct NoMeeting(String);

impl Control {
    /// The source and the target of a conversion: what `target = "M88"` and `do = "same"` in the source's profile say of
    /// the target's codes is a row of the target's table, or of the source's where the target's code has a meaning in common
    /// terms.
    ///
    /// # Errors
    /// If the target has no such code, or one of another kind, or results of programs that stand there are no variables of the source.
    pub fn meeting(mut source: Self, mut target: Self) -> Result<(Self, Self), NoMeeting> {
        source.places_there.clone_from(&target.machine_places);
        match standing_results::met(&source, &target) {
            Ok(results) => target.standing_results = results,
            Err((line, why)) => {
                return Err(target.no_meeting(&format!("standing_results:{line}"), why, "target"));
            }
        }
        source.take_feeds_as_rapid(&target);
        let named: Vec<(SiteCode, String)> =
            (source.profile.site.iter()).filter_map(|site| Some((site.clone(), there(site)?))).collect();
        if named.is_empty() {
            return Ok((source, target));
        }
        let (mut ours, mut theirs) = (source.dialect.clone(), target.dialect.clone());
        let (mut faults, mut first) = (Vec::new(), Vec::new());
        for (site, code) in named {
            let Some(act) = source.act_of(&site) else { continue };
            let has =
                |row: &CodeMeaning| row.op == Op::Act && row.fixed.get(&Role::Act) == Some(&act.number());
            if target.dialect.codes.iter().any(has) {
                // The target's own profile has the name.
                continue;
            }
            match met(&site, act, &code, &target) {
                Ok(Met::Target(row)) => match second(&site, &row, &mut first, &source) {
                    Some((row, row_there)) => {
                        site_rows::lay(&mut theirs, row_there);
                        site_rows::lay(&mut ours, row);
                    }
                    None => site_rows::lay(&mut theirs, row),
                },
                Ok(Met::Source(row)) => site_rows::lay(&mut ours, row),
                Err(message) => faults.push(source.fault_at(&format!("site:{}", site.code), message)),
            }
        }
        if !faults.is_empty() {
            return Err(source.no_meeting_of(&faults, "source"));
        }
        Ok((source.with_rows(ours), target.with_rows(theirs)))
    }

    /// What is wrong at a place of the machine's profile.
    fn fault_at(&self, place: &str, message: String) -> Diagnostic {
        let span = self.profile.places.get(place).cloned().unwrap_or(0..0);
        let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Diagnostic::new(Code::MachineProfile, Span::new(offset(span.start), offset(span.end)), message)
    }

    fn no_meeting(&self, place: &str, message: String, side: &str) -> NoMeeting {
        self.no_meeting_of(&[self.fault_at(place, message)], side)
    }

    /// Faults of the machine's profile, as people read them.
    fn no_meeting_of(&self, faults: &[Diagnostic], side: &str) -> NoMeeting {
        let path = self.profile.file.as_deref();
        let text = path.and_then(|path| std::fs::read_to_string(path).ok()).unwrap_or_default();
        let name = path.map_or_else(|| format!("the {side}'s profile"), |path| path.display().to_string());
        NoMeeting(faults_as_text(&name, &text, faults).trim_end().to_owned())
    }

    /// Where the target's profile says that rapid will do for moves in machine coordinates that feed here, they are rapid.
    fn take_feeds_as_rapid(&mut self, target: &Self) {
        let will_do = target.behaviour(Question::MachineMoveFeed).is_some_and(|row| row.value == "rapid");
        let mut rows = self.dialect.behaviours.iter_mut();
        let row = rows.find(|row| row.question == Question::MachineMoveRapid && row.value != "true");
        let mills = self.profile.machine != Some(Machine::Lathe) && target.machine() == Machine::Mill;
        if let Some(row) = row.filter(|_| will_do && mills) {
            row.value = "true".into();
            row.origin.mark = Mark::Confirmed;
            self.rapid_will_do = true;
        }
    }

    /// True where moves in machine coordinates that feed are taken as rapid, as the target's profile says that rapid will do.
    pub fn rapid_will_do(&self) -> bool {
        self.rapid_will_do
    }
}

/// The rows of a second code of the source that becomes a code which one before it becomes: here it does what that one does, and the
/// target's code takes the words of both. None for the first of them, which `first` keeps.
fn second(
    site: &SiteCode,
    row: &CodeMeaning,
    first: &mut Vec<CodeMeaning>,
    source: &Control,
) -> Option<(CodeMeaning, CodeMeaning)> {
    // One that reads the last S would give its speed to the other.
    let spoken = source.act_of(site).is_some_and(|act| source.speed_word(act).is_some());
    let plain = site.reads.is_empty() && site.sets.is_empty() && site.fixed.is_empty() && !spoken;
    let same = |other: &&mut CodeMeaning| other.head() == row.head() && other.beside() == row.beside();
    let Some(other) = first.iter_mut().find(same).filter(|_| plain) else {
        first.extend(plain.then(|| row.clone()));
        return None;
    };
    let act = Act::of(*other.fixed.get(&Role::Act)?)?;
    let mut words = BTreeMap::new();
    for (letter, there) in &site.words {
        let role = if there.trim().is_empty() {
            act.word(&Act::dropped(letter))
        } else {
            let there = if site.target.is_some() { there } else { letter };
            let role = other.words.get(there).copied().or_else(|| act.word(&format!("{letter}.{there}")));
            other.words.extend(role.map(|role| (there.clone(), role)));
            role
        };
        words.extend(role.map(|role| (letter.clone(), role)));
    }
    let ours = CodeMeaning { words, preferred: false, ..site.row(Some(act)) };
    Some((ours, other.clone()))
}

/// The code of the target that a profile names.
fn there(site: &SiteCode) -> Option<String> {
    match (&site.target, site.without) {
        (Some(code), _) => Some(code.clone()),
        (None, Some(Without::Same)) => Some(site.code.clone()),
        _ => None,
    }
}

/// The row that a code of the source gives.
enum Met {
    /// Of the target: its code has the source's name.
    Target(CodeMeaning),
    /// Of the source: its code does what the target's does.
    Source(CodeMeaning),
}

fn met(site: &SiteCode, act: Act, code: &str, target: &Control) -> Result<Met, String> {
    let codes = codes(code).ok_or_else(|| format!("'{code}' is not a code"))?;
    if let [code] = codes.as_slice() {
        return met_one(site, act, code, target);
    }
    let mut ops = Vec::new();
    for code in &codes {
        let head = CodeHead::read(code);
        let row = head.and_then(|head| target.code(head.letter, head.number(), &[]));
        if row.is_none() {
            return Err(format!(
                "the table of the target has no {code}: say in the target's profile what it does, with op = \"spindle.cw\" or its like"
            ));
        }
        let row = row.filter(|row| site_rows::can_stand_together(row.op) && row.fixed.is_empty());
        let row = row.ok_or_else(|| {
            format!(
                "{code} of the target cannot stand beside another code here: only codes of spindle and coolant can. Give {} one code, \
                 or do = \"stop\"",
                site.code
            )
        })?;
        ops.push(row.op);
    }
    let op = ops.remove(0);
    if site_rows::clash(op, &ops) {
        return Err(format!("'{code}' switches one thing twice: name each code once"));
    }
    if !site.words.is_empty() {
        return Err(format!("{} becomes several codes, and has words: leave 'words' out", site.code));
    }
    Ok(Met::Source(CodeMeaning { op, with: ops, preferred: false, ..site.row(None) }))
}

/// Each code of a target, with its words: `M3 M8` are two, `G187 P1` is one.
fn codes(written: &str) -> Option<Vec<String>> {
    let mut codes: Vec<String> = Vec::new();
    for word in written.split(' ').filter(|word| !word.is_empty()) {
        match codes.last_mut() {
            Some(last) if !word.starts_with(['G', 'M']) => {
                last.push(' ');
                last.push_str(word);
            }
            _ => codes.push(CodeHead::read(word).map(|_| word.to_owned())?),
        }
    }
    Some(codes).filter(|codes| !codes.is_empty())
}

/// The row of one code of the target, which may have words with numbers beside it: `M19 P90`.
fn met_one(site: &SiteCode, act: Act, code: &str, target: &Control) -> Result<Met, String> {
    let named = CodeMeaning { code: code.into(), ..site.row(None) };
    let head = named.head().ok_or_else(|| format!("'{code}' is not a code"))?;
    let beside = named.beside().ok_or_else(|| format!("'{code}' is not a code"))?;
    let number = |word: &Beside| Some(f64::from(word.thousandths?) / 1000.0);
    let words: Vec<(char, Option<f64>)> = beside.iter().map(|word| (word.letter, number(word))).collect();
    // What only machines of its kind have a profile may name as a builder's code; so may it a mode of quality, which is
    // never written by itself.
    let standard = target.code(head.letter, head.number(), &words);
    let own = |op: Op| matches!(op, Op::Builder | Op::MachineSpecific | Op::PathQuality);
    let Some(standard) = standard.filter(|row| !own(row.op)) else {
        return Ok(Met::Target(builders(site, act, code)));
    };
    let mirrors = standard.op == Op::MirrorOff
        || standard.op == Op::MirrorOn
            && beside
                .iter()
                .any(|word| target.role(word.letter, false, Some(standard)).is_some_and(Role::is_axis));
    let switched = mirrors || matches!(standard.op.group(), Group::OneShot | Group::Spindle | Group::Coolant);
    if standard.op.is_flow() || !switched || standard.op == Op::ProbeOther {
        let meaning = standard.op.meaning().trim().trim_end_matches('.');
        let program = beside.iter().find(|word| word.letter == 'P').and_then(number);
        if let Some(program) = program.filter(|_| matches!(standard.op, Op::CallMacro | Op::CallProgram)) {
            let arguments = if standard.op == Op::CallMacro { ", arguments = true" } else { "" };
            return Err(format!(
                "{} cannot be {code} of the target, which calls a program: write calls = {program}{arguments} in place of target, and \
                 O{program} under 'programs' of the target's profile if it stands there",
                site.code
            ));
        }
        if standard.op == Op::MirrorOn {
            return Err(format!(
                "{} cannot be {code} of the target, which names no axis: write target = \"{code} X0\"",
                site.code
            ));
        }
        return Err(format!("{} cannot be {code} of the target, which is: {meaning}", site.code));
    }
    let role = |letter: char| {
        let role = target.role(letter, false, Some(standard));
        role.ok_or_else(|| format!("{code} of the target takes no word {letter}"))
    };
    let mut words = BTreeMap::new();
    for (letter, there) in &site.words {
        if there.trim().is_empty() {
            let act = standard.fixed.get(&Role::Act).and_then(|number| Act::of(*number));
            let role = act.and_then(|act| act.word(&Act::dropped(letter)));
            let role = role.ok_or_else(|| {
                format!(
                    "{code} of the target is a code of its own: leave {letter} out of the words of {}",
                    site.code
                )
            })?;
            words.insert(letter.clone(), role);
            continue;
        }
        let wanted = if site.target.is_some() { there } else { letter };
        words.insert(letter.clone(), role(wanted.chars().next().unwrap_or_default())?);
    }
    let (op, mut fixed) = (standard.op, standard.fixed.clone());
    for word in &beside {
        // What tells the row apart says nothing more.
        if standard.beside().is_some_and(|own| own.contains(word)) {
            continue;
        }
        let value = number(word).ok_or_else(|| format!("{} of '{code}' has no number", word.letter))?;
        let role = role(word.letter)?;
        fixed.insert(role, target.canonical(Some(standard), role, value));
    }
    Ok(Met::Source(CodeMeaning { op, fixed, words, ..site.row(None) }))
}

/// The row of a code that only builders have.
fn builders(site: &SiteCode, act: Act, code: &str) -> CodeMeaning {
    let row = site.row(Some(act));
    let words = match &site.target {
        None => row.words,
        Some(_) => {
            let letters = site.words.iter();
            let there = letters.filter(|(_, there)| !there.trim().is_empty());
            there.filter_map(|(letter, there)| Some((there.clone(), act.word(letter)?))).collect()
        }
    };
    CodeMeaning { code: code.into(), words, preferred: true, ..row }
}
