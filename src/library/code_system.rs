//! Lathe programs of another G code system than the one that they are read by.
//!
//! Law: where no profile says the system of a lathe whose control has several, its programs are read by the table's. A code
//! that this system has not, or that it has as something that the block cannot be, and that another one has, says that the
//! machine is set to another. Then no program of the library is read: G98 is a feed a minute in one system and a return in
//! another, and a program without any such code would be read wrongly without a sign of it.
//! Counter-example: a code that no system has is the machine builder's, and a code that the profile gives a program is a call.

use super::Input;
use super::machine_kind::{names_machine, place};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{CODE_SYSTEM, CodeMeaning, Control, Plain, Start};
use crate::ir::Module;
use crate::syntax::{Block, ExprKind, ItemKind, for_each_item, parse_file};
use crate::text::Span;

/// A code that shows another system: where it is, and what.
struct Sign {
    file: usize,
    span: Span,
    what: String,
}

/// Refuses the programs of a library in which a code shows another system than the one that is assumed.
pub(super) fn report(module: &Module, inputs: &[Input], control: &Control, found: &mut [Vec<Diagnostic>]) {
    let Some((system, row)) = control.open_code_system() else { return };
    let systems = Systems::of(control, system, &row.values);
    let is_shown = inputs.iter().any(|input| systems.shows_own(input));
    let signs = inputs.iter().enumerate().filter_map(|(file, input)| systems.sign(file, input, is_shown));
    let signs: Vec<Sign> = signs.collect();
    let Some(first) = signs.first() else { return };
    let values =
        systems.others.iter().map(|(name, _)| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ");
    let help = format!(
        "write {CODE_SYSTEM} = {values} under [settings] in the machine's profile, or {CODE_SYSTEM} = \"{system}\" if it is this one after \
         all: the control's parameters show which it is"
    );
    for (program, found) in module.programs.iter().zip(found) {
        let start = program.site.span.start;
        let mates = module.programs.iter().filter(|other| other.file == program.file);
        let end = mates.map(|other| other.site.span.start).filter(|other| *other > start).min();
        let place_of_own = start..end.unwrap_or(u32::MAX);
        let is_own = |sign: &&Sign| sign.file == program.file && place_of_own.contains(&sign.span.start);
        let (span, what) = match signs.iter().find(is_own) {
            Some(sign) => (sign.span, sign.what.clone()),
            // What says nothing to a machine is the same in all systems.
            None if !names_machine(program) => continue,
            None => {
                let there = place(inputs, first.file, first.span);
                let what = format!("the library shows another G code system: in {there}, {}", first.what);
                (program.site.span, what)
            }
        };
        let told = Diagnostic::new(Code::CodeSystem, span, what).with_help(help.clone());
        found.push(told.lacking(format!("setting.{CODE_SYSTEM}")));
    }
}

/// True where another G code system of a lathe's control has a code.
pub fn is_of_another(control: &Control, code: f64) -> bool {
    control.open_code_system().is_some_and(|(system, row)| {
        let systems = Systems::of(control, system, &row.values);
        systems.others.iter().any(|(_, other)| other.code('G', code, &[]).is_some())
    })
}

/// A lathe's control by each of its other G code systems, where no profile says the system; what is said to be in force when
/// programs begin is left out.
pub fn by_other_systems(control: &Control) -> Vec<(String, Control)> {
    let Some((system, row)) = control.open_code_system() else { return Vec::new() };
    Systems::of(control, system, &row.values).others
}

/// The systems of a control.
struct Systems<'c> {
    /// The one that is assumed.
    own: &'c Control,
    name: &'c str,
    /// The others, by name.
    others: Vec<(String, Control)>,
}

/// A block as its words say: its letters with their values, and where each G code stands.
#[derive(Default)]
struct Words {
    all: Vec<(char, Option<f64>)>,
    codes: Vec<(f64, Span)>,
}

impl Words {
    /// Those of a block; `seen` is told of every item.
    fn of(block: &Block, mut seen: impl FnMut(&ItemKind)) -> Self {
        let mut words = Self::default();
        for_each_item(&block.items, &mut |item| {
            seen(&item.kind);
            let ItemKind::Word(word) = &item.kind else { return };
            let value = word.value.as_ref().and_then(|value| match &value.kind {
                ExprKind::Number(number) => Some(number.value),
                _ => None,
            });
            words.all.push((word.letter, value));
            words.codes.extend(value.filter(|_| word.letter == 'G').map(|value| (value, item.span)));
        });
        words
    }

    /// True where the block has no other letters.
    fn is_alone(&self, letters: &str) -> bool {
        self.all.iter().all(|(letter, _)| letters.contains(*letter))
    }

    fn value(&self, letter: char) -> Option<f64> {
        self.all.iter().find(|(found, _)| *found == letter).and_then(|(_, value)| *value)
    }

    fn has(&self, letters: &str) -> bool {
        self.all.iter().any(|(letter, _)| letters.contains(*letter))
    }
}

impl<'c> Systems<'c> {
    fn of(own: &'c Control, name: &'c str, values: &[String]) -> Self {
        let others = values.iter().filter(|value| *value != name).filter_map(|value| {
            let mut profile = own.profile().clone();
            profile.settings.insert(CODE_SYSTEM.into(), Plain::Word(value.clone()));
            // What is said to be in force when programs begin is said in the codes of the assumed one.
            profile.start = Start::default();
            Some((value.clone(), Control::new(own.entry(), profile).ok()?))
        });
        Self { own, name, others: others.collect() }
    }

    /// True where a block of a file is what the assumed system alone has: a limit of the speed (`G50 S3000`), the pass of a thread with its
    /// lead (`G92 X20. Z-30. F2.`), a return by increments (`G28 U0 W0`).
    fn shows_own(&self, input: &Input) -> bool {
        let limits = |control: &Control, code: f64, words: &Words| {
            control.code('G', code, &words.all).is_some_and(|row| row.op == Op::LimitSpeed)
        };
        parse_file(&input.bytes, self.own.entry().parse_items).blocks.iter().any(|block| {
            let words = Words::of(block, |_| {});
            let own = |(code, _): &(f64, Span)| {
                limits(self.own, *code, &words)
                    && !self.others.iter().any(|(_, other)| limits(other, *code, &words))
            };
            words.has("S") && words.is_alone("GNSMT") && words.codes.iter().any(own)
                || words
                    .codes
                    .iter()
                    .any(|(code, _)| self.cuts_thread(*code, &words) || self.steps_home(*code, &words))
        })
    }

    /// True for a pass of a thread to a place, with its lead, by a code that no other system has for one.
    fn cuts_thread(&self, code: f64, words: &Words) -> bool {
        let cuts = |control: &Control| {
            control.code('G', code, &words.all).is_some_and(|row| row.op == Op::ThreadingPass)
        };
        let is_whole = words.has("XU") && words.has("ZW") && words.has("F") && words.is_alone("GNXZUWFIRM");
        is_whole && cuts(self.own) && !self.others.iter().any(|(_, other)| cuts(other))
    }

    /// True for a return in increments that only the assumed system has letters for.
    fn steps_home(&self, code: f64, words: &Words) -> bool {
        let steps = |control: &Control| {
            let row = control.code('G', code, &words.all).filter(|row| row.op == Op::ReferenceReturn);
            let step = |letter: char| control.role(letter, false, row).is_some_and(Role::is_step);
            row.is_some() && words.all.iter().any(|(letter, _)| step(*letter))
        };
        let only = words.is_alone("GNUWM");
        only && steps(self.own) && !self.others.iter().any(|(_, other)| steps(other))
    }

    /// The first code of a file that shows another system; `is_shown` where another block shows that it is the assumed one.
    fn sign(&self, file: usize, input: &Input, is_shown: bool) -> Option<Sign> {
        let (mut fed, mut faced) = (false, false);
        for block in parse_file(&input.bytes, self.own.entry().parse_items).blocks {
            let words = Words::of(&block, |item| {
                fed &= !matches!(item, ItemKind::Program(_));
                faced &= !matches!(item, ItemKind::Program(_));
            });
            fed |= words.has("FE");
            for (code, span) in &words.codes {
                let other =
                    self.other(*code, &words, fed, is_shown).or_else(|| self.unlike(*code, &words, faced));
                if let Some(what) = other {
                    return Some(Sign { file, span: *span, what });
                }
                let op = self.own.code('G', *code, &words.all).map(|row| row.op);
                faced |= matches!(op, Some(Op::FacingSetup | Op::RoughFacing)) && !words.is_alone("GPQN");
            }
        }
        None
    }

    /// Why a code is of another system; none if it may be of the assumed one. `fed` is true where a feed or a lead stands in
    /// this block or before.
    fn other(&self, code: f64, words: &Words, fed: bool, is_shown: bool) -> Option<String> {
        if self.own.alias('G', code).is_some() || self.own.site_code('G', code).is_some() {
            return None;
        }
        let rows = self.others.iter().filter_map(|(name, control)| {
            let row = control.code('G', code, &words.all)?;
            Some((name.as_str(), row))
        });
        let rows: Vec<(&str, &CodeMeaning)> = rows.collect();
        let row = self.own.code('G', code, &words.all);
        let differs = |op: Op| rows.iter().any(|(_, other)| other.op != op);
        let why = match row.map(|row| row.op) {
            None if rows.is_empty() => return None,
            None => "no code of it",
            Some(op) if !differs(op) => return None,
            Some(op) if is_pass(op) && self.moves_besides(code, words) => {
                "a move in it, and the block has another one"
            }
            // In a line of safe codes it does nothing, and shops write it as they know it from mills.
            Some(Op::TurningPass) if is_shown && !words.has("XZUWF") => return None,
            Some(op) if is_pass(op) && !words.has("XZUW") => {
                "a pass along X and Z in it, and the block has neither"
            }
            Some(Op::ThreadingPass) if !fed => "a pass of a thread in it, and no lead stands before",
            Some(op) if op.group() == Group::Units && self.passes(&rows, words) => {
                "a unit in it, and the block is a pass"
            }
            Some(_) => return None,
        };
        Some(format!("G code system {} is assumed, G{code} is {why}; {}", self.name, told(&rows)))
    }

    /// Why the words of a cycle are another one's: a roughing that no block and no word tells anything of, where another system
    /// has a finishing; a count of passes that is no whole number, where another one has a way back.
    fn unlike(&self, code: f64, words: &Words, faced: bool) -> Option<String> {
        let rows = self.others.iter().filter_map(|(name, control)| {
            let row = control.code('G', code, &words.all)?;
            Some((name.as_str(), row))
        });
        let rows: Vec<(&str, &CodeMeaning)> = rows.collect();
        let elsewhere = |op: Op| rows.iter().any(|(_, row)| row.op == op);
        let row = self.own.code('G', code, &words.all)?;
        let passes = row.words.iter().find(|(_, role)| **role == Role::Passes);
        let passes = passes.and_then(|(letter, _)| words.value(letter.chars().next()?));
        let why = match row.op {
            Op::RoughFacing if words.is_alone("GPQN") && !faced && elsewhere(Op::Finish) => {
                "a roughing in it, and no block says how deep"
            }
            Op::PatternSetup
                if passes.is_some_and(|passes| passes.fract() != 0.0) && elsewhere(Op::TurningSetup) =>
            {
                "a repeated pattern in it, and R would be its count"
            }
            _ => return None,
        };
        Some(format!("G code system {} is assumed, G{code} is {why}; {}", self.name, told(&rows)))
    }

    /// True where the block has another code of the motion's group.
    fn moves_besides(&self, code: f64, words: &Words) -> bool {
        let others = words.codes.iter().filter(|(other, _)| *other != code);
        let mut ops =
            others.filter_map(|(other, _)| self.own.code('G', *other, &words.all)).map(|row| row.op);
        ops.any(|op| op.group() == Group::Motion)
    }

    /// True for a block that is a pass by another system: both axes and a feed, and no code that moves.
    fn passes(&self, rows: &[(&str, &CodeMeaning)], words: &Words) -> bool {
        let is_whole = words.has("XU") && words.has("ZW") && words.has("F");
        is_whole && rows.iter().any(|(_, row)| is_pass(row.op)) && !self.moves_besides(f64::NAN, words)
    }
}

fn is_pass(op: Op) -> bool {
    matches!(op, Op::TurningPass | Op::ThreadingPass | Op::FacingPass)
}

/// What a code is in other systems: `in B and C it is feed per turn`.
fn told(rows: &[(&str, &CodeMeaning)]) -> String {
    let mut by_meaning: Vec<(String, Vec<&str>)> = Vec::new();
    for (name, row) in rows {
        let meaning = meant(row.op);
        match by_meaning.iter_mut().find(|(known, _)| *known == meaning) {
            Some((_, names)) => names.push(name),
            None => by_meaning.push((meaning, vec![name])),
        }
    }
    let all = by_meaning.iter().map(|(meaning, names)| format!("in {} it is {meaning}", names.join(" and ")));
    all.collect::<Vec<_>>().join(", ")
}

/// What an operation is, in the words of its meaning.
fn meant(op: Op) -> String {
    let meaning = op.meaning().split(':').next().unwrap_or_default();
    let mut letters = meaning.trim().trim_end_matches('.').chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

#[cfg(test)]
mod tests;
