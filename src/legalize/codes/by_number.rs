//! Codes known by their number only: computed ones, and those of a machine's builder.
//!
//! Law: a number means the same on both controls where both tables give it the same operation with the same fixed
//! operands. Every number that the value may be is looked up, those of a loop's counter too; where that set is not known, the code is a
//! condition that a reviewer must accept where both controls number their codes by one scheme, else an error. So is a code that
//! the program may have found in force, which only one that runs before it can have put there. A computed code
//! is a whole number: where both controls round it, what they round it to is looked up.
//! Counter-example: `G#1` with `#1` = 47, which offsets on one control and engraves on the other.

use super::found_codes::FoundCodes;
use crate::assume::Predicate;
use crate::canon::{Group, Op, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::{Assigned, Constant, Ranges, Values};
use crate::ir::{BlockId, Expr, Module, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::by_program::look_at_each;
use crate::legalize::features::Feature;
use crate::legalize::variables::computed_numbers::Written;
use crate::legalize::variables::state::additional;
use crate::text::Span;
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

/// Checks every code that is known by its number.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let shared = &*context;
    let in_force = LazyLock::new(|| FoundCodes::of(module));
    let all = look_at_each(module, |index, _| {
        let has_any = shared.may_concern(index, |features| features.has(Feature::Code));
        if has_any { look(index, module, shared, &in_force) } else { Default::default() }
    });
    let mut found: Vec<(usize, Span, (char, Finding))> = Vec::new();
    // Programs with words beside such a code: a code that both have may take them otherwise.
    let mut worded: BTreeSet<(usize, char)> = BTreeSet::new();
    for (index, (met, known)) in all.into_iter().enumerate() {
        let origin = context.origin(index);
        for (span, numbers) in known {
            let held = context.computed_codes.entry((origin, span)).or_insert(Some(Vec::new()));
            *held = held.take().zip(numbers).map(|(mut all, more)| {
                all.extend(more);
                all
            });
        }
        worded.extend(met.iter().filter(|met| met.worded).map(|met| (index, met.letter)));
        found.extend(met.into_iter().map(|met| (index, met.span, (met.letter, met.finding))));
    }
    let mut letters: BTreeMap<char, Letter> = BTreeMap::new();
    for (index, span, (letter, finding)) in &found {
        let known = letters.entry(*letter).or_insert_with(|| Letter {
            number_alike: context.number_alike(*letter),
            alike: alike(*letter, context.source, context.target),
        });
        let by_scheme = if known.number_alike { Code::Conditional } else { Code::NoEquivalent };
        let (code, what) = match finding {
            Finding::Other(code) => {
                let note = note(code, context.source);
                let title = &context.source.dialect().title;
                let what = match makers_own(code, context.source) {
                    Some(kind) => {
                        format!("{code}{note} is {kind} of the {title} that has no equal on the target")
                    }
                    None => format!("{code}{note} may mean something else on the target"),
                };
                (Code::NoEquivalent, what)
            }
            Finding::Read(code) => {
                let what = format!(
                    "the code that was read earlier is put in force again: {code} may mean something else \
                     on the target, and must not be in force when it is read"
                );
                (by_scheme, what)
            }
            Finding::Any(letter) => {
                let what = match known.number_alike {
                    true => format!(
                        "the number of the {letter} code is computed: make sure that every code it may be \
                         means the same on the target"
                    ),
                    false => format!(
                        "the number of the {letter} code is computed, and the target numbers its codes otherwise: write \
                         each code that it may be into a block of its own, after an IF"
                    ),
                };
                (by_scheme, what)
            }
        };
        let help = match finding {
            Finding::Other(code) if makers_own(code, context.source).is_some() => Some(instead(code)),
            Finding::Other(code) => Some(format!(
                "if the machine's builder made {code}, say in the source's profile what becomes of it: [[site]] with code, a \
                 text, and name (in both profiles), target or do"
            )),
            Finding::Read(_) | Finding::Any(_) => None,
        };
        let own = found.partition_point(|(other, ..)| other < index);
        let own = found.iter().skip(own).take_while(|(other, ..)| other == index);
        let places = own.filter(|(.., (other, _))| other == letter).map(|(_, span, _)| *span).collect();
        let mut same = known.alike.clone();
        if worded.contains(&(*index, *letter)) {
            let words = |control: &'_ Control, number| {
                control.code(*letter, number, &[]).map(|row| row.words.clone())
            };
            same.retain(|number| words(context.source, *number) == words(context.target, *number));
        }
        let predicate = Predicate::Codes { letter: *letter, places, same };
        let told = Diagnostic::new(code, *span, what.clone()).assuming(predicate);
        let told = match help {
            Some(help) => told.with_help(help),
            None => told,
        };
        let told = match finding {
            Finding::Other(name) => match name.get(1..).and_then(|number| number.parse().ok()) {
                Some(number) => told.asking(*letter, number),
                None => told,
            },
            Finding::Read(_) | Finding::Any(_) => told,
        };
        context.add_once(*index, &what, told);
    }
}

/// A code that is known by its number, of which something is to be said.
struct Met {
    span: Span,
    letter: char,
    finding: Finding,
    /// True where words stand beside it.
    worded: bool,
}

/// A computed G code, and the numbers that it may be, if they are known.
type Computed = (Span, Option<Vec<f64>>);

/// The codes of a program of which something is to be said, and what each computed G code may be.
fn look(
    index: usize,
    module: &Module,
    context: &Context<'_>,
    in_force: &LazyLock<FoundCodes, impl FnOnce() -> FoundCodes>,
) -> (Vec<Met>, Vec<Computed>) {
    let Some(program) = module.programs.get(index) else { return Default::default() };
    let (source, target) = (context.source, context.target);
    let rounds = [source, target].iter().all(|control| control.is(Question::IntegerWordRounds));
    let summaries = LazyCell::new(|| context.summaries(module));
    let written = LazyCell::new(|| {
        let standard = !additional::may_select(module, context);
        Written::in_program(program, &summaries, standard, (source, target))
    });
    let misses = |place, bank, number: &Expr, var| written.misses(place, bank, number, var);
    let assigned = LazyCell::new(|| Assigned::new(program, &summaries).with(&misses));
    let ranges = LazyCell::new(|| Ranges::of_constants_and_codes(program, &summaries));
    let (mut met, mut computed) = (Vec::new(), Vec::new());
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            for item in &nc.items {
                let NcItem::Code(letter, value) = item else { continue };
                let listed = numbers(value, &assigned, id, at, source);
                let mut numbers = listed.or_else(|| counted(&ranges.at(id, at, value)));
                if rounds && value.constant().is_none() {
                    numbers.iter_mut().flatten().for_each(|n| n.number = n.number.round());
                }
                if *letter == 'G' && value.constant().is_none() {
                    let known = numbers.as_ref().map(|all| all.iter().map(|n| n.number).collect());
                    computed.push((stmt.site.span, known));
                }
                let differs = |n: &Number| !is_same(*letter, n.number, source, target);
                // What nobody can have put in force where it is read is none of them.
                let never = |n: &Number| {
                    let row = source.code(*letter, n.number, &[]);
                    // Nor what the target has not at all: no program can put it in force there.
                    let lacks = |op: Op| {
                        target.code(*letter, n.number, &[]).is_none()
                            && target.code_for(op, &BTreeMap::new()).is_none()
                    };
                    n.read
                        && differs(n)
                        && row.is_some_and(|row| lacks(row.op) || !in_force.may_find(index, row.op))
                };
                numbers.iter_mut().for_each(|numbers| numbers.retain(|number| !never(number)));
                if let Some(finding) = check(*letter, numbers, source, target) {
                    let worded = nc.items.iter().any(|item| matches!(item, NcItem::Word(..)));
                    met.push(Met { span: stmt.site.span, letter: *letter, finding, worded });
                }
            }
        }
    }
    (met, computed)
}

/// How both controls number the codes of a letter.
struct Letter {
    /// True where they do so by one scheme.
    number_alike: bool,
    /// The codes that mean the same on both.
    alike: Vec<f64>,
}

enum Finding {
    /// This code has another meaning, or none.
    Other(String),
    /// So has this one, which stands for what was in force where the program read it.
    Read(String),
    /// Any code of the letter.
    Any(char),
}

/// A number that a code may be.
pub(in crate::legalize) struct Number {
    /// The number.
    pub number: f64,
    /// True where it stands for what was in force where the program read it.
    read: bool,
}

impl Number {
    /// True where it stands for what was in force where the program read it.
    pub(in crate::legalize) fn is_read(&self) -> bool {
        self.read
    }
}

/// The numbers that a code may be; none if that is not known.
pub(in crate::legalize) fn numbers<'p>(
    value: &Expr,
    assigned: &LazyCell<Assigned<'p>, impl FnOnce() -> Assigned<'p>>,
    id: BlockId,
    at: usize,
    source: &Control,
) -> Option<Vec<Number>> {
    if let Some(number) = value.constant() {
        return Some(vec![Number { number, read: false }]);
    }
    let Expr::Var(var) = value else { return None };
    let mut numbers = Vec::new();
    for constant in assigned.at(*var, id, at)? {
        match constant {
            Constant::Number(number) => numbers.push(Number { number, read: false }),
            Constant::Vacant => {}
            Constant::State(Sys::Modal, subscripts) => {
                let codes = codes_of_group(*subscripts.first()?, source)?.into_iter();
                numbers.extend(codes.map(|number| Number { number, read: true }));
            }
            Constant::State(..) => return None,
        }
    }
    Some(numbers)
}

/// Numbers of a loop's counter, at the most.
const MOST_COUNTED: f64 = 100.0;

/// The whole numbers between two bounds, as a loop counts through them. None if there are too many, or fractions among them.
fn counted(values: &Values) -> Option<Vec<Number>> {
    let (low, high) =
        values.bounds().filter(|(low, high)| values.all_whole() && high - low < MOST_COUNTED)?;
    let numbers = std::iter::successors(Some(low), |number| Some(number + 1.0));
    let numbers = numbers.take_while(|number| *number <= high).filter(|number| values.contains(*number));
    Some(numbers.map(|number| Number { number, read: false }).collect())
}

/// What the table says that a code of the source is.
fn note(code: &str, source: &Control) -> String {
    let row = source.dialect().codes.iter().find(|row| row.code == code);
    let note = row.and_then(|row| row.origin.note.as_deref());
    note.map_or(String::new(), |note| format!(" ({note})"))
}

/// What kind of thing a code is that the maker of the control gave it, and not the machine's builder.
fn makers_own(code: &str, source: &Control) -> Option<&'static str> {
    let row = source.dialect().codes.iter().find(|row| row.code == code)?;
    match row.op {
        Op::CycleOther => Some("a cycle"),
        Op::ProbeOther => Some("a code for measuring"),
        Op::MachineSpecific if code.starts_with('G') => Some("a code"),
        Op::MachineSpecific => Some("a function"),
        _ => None,
    }
}

/// What a person can do about such a code.
fn instead(code: &str) -> String {
    let profile = "say in the source's profile what becomes of it: [[site]] with code, a text, and name (in both \
                   profiles), op, target or do";
    if code.starts_with('G') {
        format!(
            "have your CAM write what {code} does as moves, or write them by hand, and convert those; or {profile}"
        )
    } else {
        format!("take {code} out if the part does not need it; or {profile}")
    }
}

/// The codes that a modal variable may hold: those of the group that its number stands for.
fn codes_of_group(number: f64, source: &Control) -> Option<Vec<f64>> {
    let group = Group::ALL.iter().find(|group| group.number().is_some_and(|n| f64::from(n) == number))?;
    let codes = source.dialect().codes.iter().filter(|row| row.op.group() == *group);
    Some(codes.filter_map(|row| row.code.strip_prefix('G')?.parse().ok()).collect())
}

/// A code of a modal group of which the target has the operation, and under another number: what the group's
/// variable holds then is not the same on both.
pub(in crate::legalize) fn renumbered(group: f64, source: &Control, target: &Control) -> Option<String> {
    let group = Group::ALL.iter().find(|g| g.number().is_some_and(|n| f64::from(n) == group))?;
    let rows = source.dialect().codes.iter().filter(|row| row.op.group() == *group);
    let rows = rows.filter(|row| {
        // A rigid tap by a cycle of its own becomes a plain one.
        let plain = row.op == Op::CycleTapRigid && row.preferred;
        let there =
            target.code_for(row.op, &Default::default()).is_some() || row.op == Op::SelectWork || plain;
        let same = row.head().and_then(|head| target.code(head.letter, head.number(), &[]));
        there && same.is_none_or(|same| same.op != row.op)
    });
    let mut codes: Vec<&str> = rows.filter_map(|row| row.code.split(' ').next()).collect();
    codes.dedup();
    let more = if codes.len() > SHOWN { " and others" } else { "" };
    codes.truncate(SHOWN);
    (!codes.is_empty()).then(|| format!("{}{more}", codes.join(", ")))
}

/// Codes of a group that are named.
const SHOWN: usize = 6;

/// True for a code that means the same on both controls.
pub(in crate::legalize) fn is_same(letter: char, number: f64, source: &Control, target: &Control) -> bool {
    let (here, there) = (source.code(letter, number, &[]), target.code(letter, number, &[]));
    let unnamed = |op: Op| {
        matches!(op, Op::Builder | Op::MachineSpecific | Op::CycleOther | Op::ProbeOther | Op::PlaneOther)
    };
    here.zip(there).is_some_and(|(here, there)| here.does_the_same(there) && !unnamed(here.op))
}

/// The codes of a letter that mean the same on both controls.
fn alike(letter: char, source: &Control, target: &Control) -> Vec<f64> {
    let heads = source.dialect().codes.iter().filter_map(|row| row.head());
    let mut all: Vec<f64> = heads.filter(|head| head.letter == letter).map(|head| head.number()).collect();
    all.retain(|number| is_same(letter, *number, source, target));
    let apart = |question: Question| {
        let settled = |control: &Control| {
            let row = control.behaviour(question);
            row.filter(|row| row.origin.is_confirmed()).map(|row| row.value.clone())
        };
        settled(source).is_none() || settled(source) != settled(target)
    };
    // Under G91 words of a move in machine coordinates are places, increments or nothing. A return to the reference position
    // that no axis stands beside moves all of them, or none.
    let machine = apart(Question::MachineUnderIncremental);
    let returns = apart(Question::ReferenceAllAxes);
    all.retain(|number| match source.code(letter, *number, &[]).map(|row| row.op) {
        Some(Op::MachineOnce) => !machine,
        Some(op) if op.is_return() => !returns,
        _ => true,
    });
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

fn check(letter: char, numbers: Option<Vec<Number>>, source: &Control, target: &Control) -> Option<Finding> {
    let Some(numbers) = numbers else { return Some(Finding::Any(letter)) };
    // What a program names itself weighs more than what it may find in force.
    let other =
        numbers.into_iter().filter(|n| !is_same(letter, n.number, source, target)).min_by_key(|n| n.read)?;
    let code = format!("{letter}{}", other.number);
    Some(if other.read { Finding::Read(code) } else { Finding::Other(code) })
}
