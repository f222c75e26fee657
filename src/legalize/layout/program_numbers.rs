//! Numbers of programs on the target.
//!
//! Law: a program keeps its own number if the target has it; else it gets the one that the lock gives it, the one that it had
//! before an earlier conversion, the one that the name of its file begins with, or the next free one. So does one outside the library that is called by a number which the
//! target does not have. Side condition: no computed call finds a program that has its number by this conversion; if it may, that is
//! an assumption. Counter-example: `M98 P#1` and a macro that became O8000.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::{Numbers, Ranges, Summaries};
use crate::ir::{Block, Call, Callee, Module, StmtKind, TermKind};
use crate::legalize::calls::standing;
use crate::legalize::{Context, calls_of, span_of};
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// First number for main programs that have none on the source, and for subroutines made programs.
const FIRST_MAIN: u32 = 1000;
const FIRST_SUB: u32 = 8000;

/// The setting that says how long program numbers may be.
const DIGITS: &str = "setting.program_digits";

/// The numbers, and what the lock is to remember of them.
#[derive(Clone, Debug, Default)]
pub struct ProgramNumbers {
    /// The number of each program that has a name.
    pub of: Vec<(ProgramName, u32)>,
    /// What was chosen, by what names the program on the source.
    pub chosen: BTreeMap<String, u32>,
}

/// Gives every program that has a name a number.
pub fn run(module: &Module, context: &mut Context<'_>) {
    refuse_shadows(module, context);
    let looked_for = computed_calls(module);
    let numbers = choose(module, &looked_for, context);
    report_looked_for(module, &looked_for, &numbers.of, context);
    context.numbers = numbers;
}

/// Refuses programs of the library that the target's profile names as standing there: one would be written over the other.
fn refuse_shadows(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        let Some(name @ ProgramName::Number(number)) = &program.name else { continue };
        let name = name.short();
        let Some(entry) = context.target.standing().entry_of(*number) else {
            let standing = context.target.standing();
            let near = standing.is_taken(*number) || *number >= LOCKED && standing.any_from(LOCKED);
            if near && !context.target.leaves_number(*number) {
                let what = format!(
                    "the target's profile names programs under 'programs' that stand on the machine, and {name} keeps its number there: if a \
                     program of this number stands there too, this one would be written over it"
                );
                let help = format!(
                    "if one stands there, leave this program out, and name it in 'programs' where it does the same; if the number is free, say \
                     so in the target's profile: program_numbers = [\"{name}\"]"
                );
                let told = Diagnostic::new(Code::Conditional, program.site.span, what);
                context.add(index, told.with_help(help));
            }
            continue;
        };
        let what = format!(
            "the target's profile says under 'programs' that {name} stands on the machine ('{entry}'), and this program is \
             {name}: it would be written over the other"
        );
        let help = "take it out of 'programs' in the profile, or leave this program out";
        context.add(index, Diagnostic::new(Code::NoEquivalent, program.site.span, what).with_help(help));
    }
}

/// The numbers to look through for a program, in their order: those that the profile leaves to programs, else all.
fn numbers_from(first: u32, max: u32, left: &[(u32, u32)]) -> impl Iterator<Item = u32> + use<> {
    let runs = match left {
        [] => vec![(first, max), (1, first - 1)],
        left => left.to_vec(),
    };
    runs.into_iter().flat_map(|(first, last)| first..=last)
}

fn choose(module: &Module, looked_for: &Numbers, context: &mut Context<'_>) -> ProgramNumbers {
    let earlier = context.locked.programs;
    let mut chosen: BTreeMap<String, u32> = BTreeMap::new();
    let mut taken: BTreeSet<u32> = earlier.values().copied().collect();
    // What stands in the machine, or comes there from another library, would be written over.
    let elsewhere = &context.locked.elsewhere.programs;
    let stands = |number: u32| context.target.standing().is_taken(number) || elsewhere.contains(&number);
    let names: BTreeSet<&ProgramName> = module.programs.iter().filter_map(|p| p.name.as_ref()).collect();
    for name in &names {
        if let ProgramName::Number(n) = name {
            taken.insert(*n);
        }
    }
    // Calls that leave the library keep their numbers free, too.
    for call in module.programs.iter().flat_map(|p| &p.blocks).flat_map(calls_of) {
        if let Callee::Program(ProgramName::Number(n)) = &call.callee {
            taken.insert(*n);
        }
    }
    // A computed call must not find a program that has its number by this conversion.
    let max = context.target.text().program_max;
    let bounded = looked_for.last().is_none_or(|last| last < max);
    // Numbers are only ever taken: each search goes on where the last one ended.
    let mut before = context.earlier.numbers.clone();
    let kept: BTreeSet<u32> = before.values().copied().collect();
    let left: Vec<(u32, u32)> = context.target.program_numbers().collect();
    let mut free = [FIRST_MAIN, FIRST_SUB].map(|first| numbers_from(first, max, &left));
    let of_files = by_files(module, max, &context.origins, &|n| {
        let open = left.is_empty() || context.target.leaves_number(n);
        open && !(taken.contains(&n) || kept.contains(&n) || stands(n) || bounded && looked_for.contains(n))
    });
    taken.extend(of_files.values().copied().flatten());
    // Longer numbers may be an option of the machine.
    let may_be_longer = context.target.setting_row(DIGITS).is_some()
        && !context.target.profile().settings.contains_key(DIGITS.trim_start_matches("setting."));
    let mut out = Vec::new();
    for (index, program) in module.programs.iter().enumerate() {
        let Some(name) = &program.name else { continue };
        let key = name.to_string();
        let number = match (chosen.get(&key).or_else(|| earlier.get(&key).filter(|n| !stands(**n))), name) {
            (_, ProgramName::Number(n)) if *n >= 1 && *n <= max => Some(*n),
            (Some(n), _) => Some(*n),
            _ => {
                let origin = context.origin(index);
                let before = before.remove(&origin);
                let sub = program.returns() && !program.ends();
                let is_free =
                    |n: &u32| !(taken.contains(n) || stands(*n) || bounded && looked_for.contains(*n));
                let new = |n: &u32| is_free(n) && !kept.contains(n);
                let of_file = of_files.get(&index).copied().flatten();
                before.filter(is_free).or(of_file).or_else(|| free[usize::from(sub)].find(new))
            }
        };
        match number {
            Some(number) => {
                if *name != ProgramName::Number(number) {
                    if let ProgramName::Number(_) = name {
                        let what = format!(
                            "{name} becomes {}: the target's program numbers end at {max}",
                            ProgramName::Number(number)
                        );
                        let found =
                            Diagnostic::new(Code::Renumbered, program.site.span, what).with_help(SELECT);
                        context.add(index, if may_be_longer { found.lacking_there(DIGITS) } else { found });
                    }
                    if of_files.contains_key(&index) && number_of_file(name) != Some(number) {
                        let what = format!("{name} becomes {}: {NOT_OF_FILE}", ProgramName::Number(number));
                        let found = Diagnostic::new(Code::Renumbered, program.site.span, what);
                        context.add(index, found.with_help(SELECT));
                    }
                    taken.insert(number);
                    chosen.insert(key, number);
                }
                out.push((name.clone(), number));
            }
            None => {
                let what = match left.is_empty() {
                    true => format!("no program number up to {max} is free for '{key}'"),
                    false => {
                        format!("no number of 'program_numbers' of the target's profile is free for '{key}'")
                    }
                };
                context.add(index, Diagnostic::new(Code::OutOfNumbers, program.site.span, what));
            }
        }
    }
    for (name, index, span) in missing(module, max, context) {
        let key = name.to_string();
        if let Some(number) = standing::number_of(&name, context) {
            chosen.insert(key, number);
            out.push((name, number));
            continue;
        }
        let given = chosen.get(&key).or_else(|| earlier.get(&key)).filter(|n| !stands(**n)).copied();
        let is_free = |n: &u32| {
            !(taken.contains(n) || kept.contains(n) || stands(*n) || bounded && looked_for.contains(*n))
        };
        let Some(number) = given.or_else(|| free[1].find(is_free)) else { continue };
        let what = format!(
            "{} is called as {}: the target's program numbers end at {max}",
            name.short(),
            ProgramName::Number(number)
        );
        let help = format!(
            "put a program of the new number that does the same on the target; macroglot.lock keeps the number for later \
             runs. If it stands there already, say so in the target's profile: programs = [\"{} as {}\"]",
            name.short(),
            ProgramName::Number(number).short()
        );
        context.add(index, Diagnostic::new(Code::OutsideLibrary, span, what).with_help(help));
        chosen.insert(key, number);
        out.push((name, number));
    }
    ProgramNumbers { of: out, chosen }
}

const SELECT: &str = "call and select it by its new number; macroglot.lock keeps the number for later runs";

const NOT_OF_FILE: &str = "the number that its file's name begins with is taken, begins the name of another file too (macroglot.lock may keep earlier ones), or is none that a main \
                           program should have on the target (from O9000 on programs are often locked)";

/// From here on programs are often locked against changes on the machine.
const LOCKED: u32 = 9000;

/// The number that a name begins with, as the file of a program that has no other: 1102 of `1102-FLANSCH.NC`.
fn number_of_file(name: &ProgramName) -> Option<u32> {
    let ProgramName::Name(name) = name else { return None };
    let name = name.rsplit(['/', '\\']).next()?;
    let end = name.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(name.len());
    let (digits, rest) = name.split_at_checked(end)?;
    digits.parse().ok().filter(|_| !rest.starts_with(char::is_alphanumeric))
}

/// For each program whose file's name begins with a number: that number, if it is free and of no other file.
fn by_files(
    module: &Module,
    max: u32,
    origins: &[usize],
    is_free: &dyn Fn(u32) -> bool,
) -> BTreeMap<usize, Option<u32>> {
    let mut seen = BTreeSet::new();
    let is_first: Vec<bool> = origins.iter().map(|from| seen.insert(*from)).collect();
    let numbers = || {
        // A subroutine that became a program stands after the one that it comes from.
        let is_file = |(index, _): &(usize, _)| is_first.get(*index).copied().unwrap_or(true);
        let all = module.programs.iter().enumerate().filter(is_file);
        all.filter_map(|(index, program)| Some((index, number_of_file(program.name.as_ref()?)?)))
    };
    let mut files: BTreeMap<u32, usize> = BTreeMap::new();
    numbers().for_each(|(_, number)| *files.entry(number).or_default() += 1);
    let given = |number: u32| {
        let alone = files.get(&number) == Some(&1);
        (alone && (1..LOCKED.min(max.saturating_add(1))).contains(&number) && is_free(number))
            .then_some(number)
    };
    numbers().map(|(index, number)| (index, given(number))).collect()
}

/// The programs outside the library whose numbers the target does not have, or that have another one there, each with the first call of it.
fn missing(module: &Module, max: u32, context: &Context<'_>) -> Vec<(ProgramName, usize, Span)> {
    let known: BTreeSet<&ProgramName> = module.programs.iter().filter_map(|p| p.name.as_ref()).collect();
    let mut found: BTreeMap<ProgramName, (usize, Span)> = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            for call in calls_of(block) {
                let Callee::Program(name @ ProgramName::Number(number)) = &call.callee else { continue };
                let other = standing::number_of(name, context).is_some_and(|there| there != *number);
                if (*number > max || other) && !known.contains(name) {
                    found.entry(name.clone()).or_insert((index, span_of(block, call)));
                }
            }
        }
    }
    found.into_iter().map(|(name, (index, span))| (name, index, span)).collect()
}

fn computed(call: &Call) -> bool {
    matches!(call.callee, Callee::Computed(_))
}

/// The numbers of programs that computed calls look for.
fn computed_calls(module: &Module) -> Numbers {
    let callee = |block: &Block| match &block.term.kind {
        TermKind::Call { call, .. } => match &call.callee {
            Callee::Computed(number) => Some(number.clone()),
            _ => None,
        },
        _ => None,
    };
    let mut all = Numbers::default();
    if !module.programs.iter().flat_map(|program| &program.blocks).any(|block| calls_of(block).any(computed))
    {
        return all;
    }
    let summaries = Summaries::of(module);
    for program in &module.programs {
        let ranges = Ranges::of_any_inputs(program, &summaries);
        for (id, block) in program.ids().zip(&program.blocks) {
            // A modal one is called from wherever an axis moves.
            if block
                .stmts
                .iter()
                .any(|stmt| matches!(&stmt.kind, StmtKind::ModalCall(call) if computed(call)))
            {
                return Numbers::of([(0, u32::MAX)]);
            }
            if let Some(number) = callee(block) {
                all.join(&ranges.at(id, block.stmts.len(), &number).numbers());
            }
        }
    }
    all
}

/// Says where a computed call may look for a number that the conversion gave to a program.
fn report_looked_for(
    module: &Module,
    looked_for: &Numbers,
    given: &[(ProgramName, u32)],
    context: &mut Context<'_>,
) {
    let made = given.iter().filter(|(name, n)| *name != ProgramName::Number(*n) && looked_for.contains(*n));
    let made: BTreeSet<String> = made.map(|(_, number)| ProgramName::Number(*number).to_string()).collect();
    if made.is_empty() {
        return;
    }
    let what = format!(
        "the number of the called program is computed: it must not be one of {}, which this conversion \
         gave out",
        made.into_iter().collect::<Vec<_>>().join(", ")
    );
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            if calls_of(block).any(computed) {
                let told = Diagnostic::new(Code::Conditional, block.term.site.span, what.clone());
                context.add_once(index, &what, told);
            }
        }
    }
}
