//! Codes by a computed number, where the target has other numbers or takes none that is computed.
//!
//! Law: a block whose code has one of a few numbers does what the block with that number's constant code does, so a
//! comparison with each number, and the block with its code after it, does the same. A number that is vacant leaves
//! the code away. Where the analysis of values shows that no other number can come, the last comparison is left out;
//! else an alarm stands after it, and the numbers are those that come of the constants that the text has: an operator
//! who edits one may run into it, so that is a condition. Side conditions: each number is whole, its code on the source
//! is known, calls nothing, and changes the meaning of no word and of no other code of its block.
//! Counter-example: `G#1 X5.` with `#1` = 4, where X is the time of a dwell.

use crate::assume::Predicate;
use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, OperandPlace, Side};
use crate::ir::analysis::{Assigned, Constant, Ranges, Summaries, Values};
use crate::ir::{
    BlockId, Builder, Cond, Expr, Module, Nc, NcItem, Program, Relation, SourceInfo, Stmt, StmtKind, TermKind,
};
use crate::legalize::Context;
use crate::legalize::by_program::look_at_each;
use crate::legalize::codes::by_number::is_same;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::{Part, rebuild, unless_skipped};
use std::cell::LazyCell;
use std::collections::BTreeMap;

/// Most codes that a block is written out for.
const MOST: usize = 8;

/// True if the library has codes that are known by number only.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    has_codes(features)
}

fn has_codes(features: &Features) -> bool {
    features.has(Feature::Code)
}

/// Writes codes by computed numbers out; gives the programs that have any which can be.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> Vec<usize> {
    let summaries = context.summaries(module);
    let shared = &*context;
    let found = look_at_each(module, |index, program| {
        let has_any = shared.may_concern(index, has_codes);
        if has_any { chains(program, &summaries, shared) } else { Default::default() }
    });
    let mut changed = Vec::new();
    for (index, (program, chains)) in module.programs.iter_mut().zip(found).enumerate() {
        if chains.is_empty() {
            continue;
        }
        changed.push(index);
        for ((id, at), chain) in &chains {
            context.chained |= chain.letter == 'G';
            let span = program.blocks[id.index()].stmts[*at].site.span;
            for (fact, note) in &chain.doubts {
                let finding = context.source.unconfirmed(Side::Source, fact, note.as_deref(), span);
                context.add_once(index, fact, finding);
            }
            if chain.may_miss {
                let letter = chain.letter;
                let codes: Vec<String> =
                    chain.choices.iter().map(|choice| format!("{letter}{}", choice.number)).collect();
                let what = format!(
                    "the number of the {letter} code is computed: it becomes {}, as the numbers in the program have \
                     it, and any other stops with an alarm",
                    codes.join(" or ")
                );
                let same = chain.choices.iter().map(|choice| choice.number).collect();
                let predicate = Predicate::Codes { letter, places: vec![span], same };
                context.add(index, Diagnostic::new(Code::Conditional, span, what).assuming(predicate));
            }
        }
        write_out(program, chains);
    }
    changed
}

/// A computed code as it will be written.
struct Chain {
    letter: char,
    /// The item of the block that it is.
    item: usize,
    value: Expr,
    choices: Vec<Choice>,
    may_be_vacant: bool,
    /// The number may be that of no choice.
    may_miss: bool,
    /// Facts of the source that nothing confirms, with their notes.
    doubts: Vec<(String, Option<String>)>,
}

struct Choice {
    number: f64,
    /// What stands in the place of the code; none if it ends the program.
    items: Option<Vec<NcItem>>,
    rewinds: bool,
}

/// The blocks of a program that are written out, by place.
fn chains(
    program: &Program,
    summaries: &Summaries,
    context: &Context<'_>,
) -> BTreeMap<(BlockId, usize), Chain> {
    let mut found = BTreeMap::new();
    let values = Known {
        assigned: Assigned::new(program, summaries),
        sure: LazyCell::new(|| Ranges::of_any_inputs_and_codes(program, summaries)),
        likely: LazyCell::new(|| Ranges::of_constants_and_codes(program, summaries)),
    };
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            if let StmtKind::Nc(nc) = &stmt.kind
                && let Some(chain) = chain(&values, (id, at), nc, context)
            {
                found.insert((id, at), chain);
            }
        }
    }
    found
}

/// The values of a program's variables.
struct Known<'p, S, L> {
    assigned: Assigned<'p>,
    /// Whatever an operator edits.
    sure: LazyCell<Ranges<'p>, S>,
    /// Where nobody edits anything.
    likely: LazyCell<Ranges<'p>, L>,
}

fn chain<'p>(
    values: &Known<'p, impl FnOnce() -> Ranges<'p>, impl FnOnce() -> Ranges<'p>>,
    (id, at): (BlockId, usize),
    nc: &Nc,
    context: &Context<'_>,
) -> Option<Chain> {
    let (source, target) = (context.source, context.target);
    let mut computed = nc.items.iter().enumerate().filter_map(|(at, item)| match item {
        NcItem::Code(letter, value) if value.constant().is_none() => Some((at, *letter, value)),
        _ => None,
    });
    let (item, letter, value) = computed.next().filter(|_| computed.next().is_none())?;
    let few = |values: Values| match values {
        Values::Few(numbers) if !numbers.is_empty() => Some(numbers),
        // Of a loop's counter the bounds are known.
        Values::Between { low, high, whole: true } if high - low < MOST as f64 => {
            Some((0..MOST).map(|more| low + more as f64).take_while(|number| *number <= high).collect())
        }
        _ => None,
    };
    let sure = few(values.sure.at(id, at, value));
    let found = match value {
        Expr::Var(var) => values.assigned.at(*var, id, at),
        _ => None,
    };
    let may_be_vacant =
        value.may_be_vacant() && found.as_ref().is_none_or(|found| found.contains(&Constant::Vacant));
    // What was read of a group with few codes is one of them, whatever anybody edits.
    let in_force = |constant: &Constant| matches!(constant, Constant::State(..));
    let is_read = found.as_ref().is_some_and(|found| !found.is_empty() && found.iter().all(in_force));
    let listed = found.and_then(|found| {
        let numbers = found.into_iter().filter(|constant| *constant != Constant::Vacant);
        let number = |constant| match constant {
            Constant::Number(number) => Some(vec![number]),
            Constant::State(Sys::Modal, group) => read_codes(&group, source),
            _ => None,
        };
        let mut numbers = numbers.map(number).collect::<Option<Vec<_>>>()?.concat();
        numbers.sort_by(f64::total_cmp);
        numbers.dedup();
        Some(numbers)
    });
    let (may_miss, is_listed) = (sure.is_none() && !is_read, listed.is_some());
    let numbers = listed.or(sure).or_else(|| few(values.likely.at(id, at, value))).filter(|numbers| {
        (1..=MOST).contains(&numbers.len()) && numbers.iter().all(|n| n.fract() == 0.0 && *n >= 0.0)
    })?;
    // The target takes the number as it is: all that it may be are known, or both controls number their codes alike.
    let taken = target.form(OperandPlace::Code).is_some() && (is_listed || context.number_alike(letter));
    if taken && numbers.iter().all(|number| is_same(letter, *number, source, target)) {
        return None;
    }
    let mut doubts = Vec::new();
    let mut choices = Vec::new();
    for number in numbers {
        choices.push(choice(nc, letter, number, source, &mut doubts)?);
    }
    Some(Chain { letter, item, value: value.clone(), choices, may_be_vacant, may_miss, doubts })
}

/// The codes of a modal group by its number, for a group of which each code is listed: whatever a program reads there is one of them.
fn read_codes(group: &[f64], source: &Control) -> Option<Vec<f64>> {
    let [number] = group else { return None };
    let closed = [Group::Distance, Group::ReturnPlane, Group::Plane];
    let group = closed.into_iter().find(|group| group.number().is_some_and(|n| f64::from(n) == *number))?;
    let rows = source.dialect().codes.iter().filter(|row| row.op.group() == group && row.preferred);
    rows.map(|row| row.head().filter(|head| head.letter == 'G').map(|head| head.number())).collect()
}

/// The block with a constant code; none if that is another kind of block.
fn choice(
    nc: &Nc,
    letter: char,
    number: f64,
    source: &Control,
    doubts: &mut Vec<(String, Option<String>)>,
) -> Option<Choice> {
    if source.alias(letter, number).is_some() {
        return None;
    }
    let row = source.code(letter, number, &[])?;
    let ends = matches!(row.op, Op::End | Op::EndRewind);
    let words = nc.items.iter().any(|item| matches!(item, NcItem::Word(..)));
    let group = row.op.group();
    let clashes = |op: Op| op.group() == group && group != Group::OneShot;
    // Only the profile can say whether they are words of a builder's code.
    let of_machine = |role: Role| matches!(role, Role::Feed | Role::Speed | Role::Tool | Role::Turret);
    let loose = |item: &NcItem| matches!(item, NcItem::Word(role, _) if letter == 'G' || !of_machine(*role));
    let whose = row.op == Op::Act && (letter == 'G' || !nc.names_axis()) && nc.items.iter().any(loose);
    let odd = (row.op.is_flow() && !ends)
        || whose
        || row.op == Op::LimitLookahead
        || (words && !row.words.is_empty())
        || nc.ops().any(clashes)
        || !row.with.is_empty() && nc.ops().any(|op| row.with.iter().any(|with| with.group() == op.group()))
        || nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if row.fixed.contains_key(role)));
    if odd {
        return None;
    }
    if !row.origin.is_confirmed() {
        doubts.push((format!("code:{letter}{number}"), row.origin.note.clone()));
    }
    let unnamed = matches!(
        row.op,
        Op::Builder | Op::MachineSpecific | Op::CycleOther | Op::ProbeOther | Op::PlaneOther
    );
    let head = match unnamed {
        true => NcItem::Code(letter, Expr::Number(number)),
        false => NcItem::Op(row.op),
    };
    let fixed =
        row.fixed.iter().map(|(role, value): (&Role, &f64)| NcItem::Word(*role, Expr::Number(*value)));
    let with = row.with.iter().map(|op| NcItem::Op(*op));
    let items: Vec<NcItem> = std::iter::once(head).chain(with).chain(fixed).collect();
    Some(Choice { number, items: (!ends).then_some(items), rewinds: row.op == Op::EndRewind })
}

fn write_out(program: &mut Program, mut chains: BTreeMap<(BlockId, usize), Chain>) {
    let mut place = (BlockId(0), 0);
    rebuild(program, &mut |builder, part| match part {
        Part::Start(id) => place = (id, 0),
        Part::Stmt(stmt) => {
            let chain = chains.remove(&place);
            place.1 += 1;
            match (chain, stmt) {
                (Some(chain), Stmt { kind: StmtKind::Nc(nc), site }) => lay(builder, chain, &nc, site),
                (_, stmt) => Part::Stmt(stmt).keep(builder),
            }
        }
        term => term.keep(builder),
    });
}

/// One branch for each code, and the block with the code after it.
fn lay(builder: &mut Builder, chain: Chain, nc: &Nc, site: SourceInfo) {
    let place = SourceInfo { span: site.span, ..SourceInfo::default() };
    let after = builder.fresh();
    // Comments and number stand at the head.
    let kept = SourceInfo { skip: None, ..site.clone() };
    if !kept.comments.is_empty() || kept.sequence.is_some() {
        builder.push(StmtKind::Comment, kept);
    }
    unless_skipped(builder, site.skip, after);
    let without = |items: Option<&[NcItem]>| {
        let mut all = nc.items.clone();
        all.splice(chain.item..=chain.item, items.unwrap_or_default().iter().cloned());
        Nc { items: all }
    };
    let block = |builder: &mut Builder, choice: Option<&Choice>| {
        let items = choice.and_then(|choice| choice.items.as_deref());
        let nc = without(items);
        if !nc.items.is_empty() {
            builder.push(StmtKind::Nc(nc), place.clone());
        }
        match choice {
            Some(Choice { items: None, rewinds, .. }) => {
                builder.end(TermKind::End { rewind: *rewinds }, place.clone());
            }
            _ => builder.end(TermKind::Jump(after), SourceInfo::default()),
        }
    };
    let branch = |builder: &mut Builder, with: Expr, choice: Option<&Choice>| {
        let (then, otherwise) = (builder.fresh(), builder.fresh());
        let cond = Cond::Compare(Relation::Equal, chain.value.clone(), with);
        builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, place.clone());
        builder.start(then);
        block(builder, choice);
        builder.start(otherwise);
    };
    if chain.may_be_vacant {
        branch(builder, Expr::Vacant, None);
    }
    let last = chain.choices.last().filter(|_| !chain.may_miss);
    let branches = chain.choices.len() - usize::from(last.is_some());
    for choice in &chain.choices[..branches] {
        branch(builder, Expr::Number(choice.number), Some(choice));
    }
    match last {
        Some(choice) => block(builder, Some(choice)),
        None => {
            let alarm = StmtKind::Alarm { number: Expr::Number(1.0).into(), text: "NO SUCH CODE".into() };
            builder.push(alarm, place.clone());
            builder.end(TermKind::End { rewind: false }, place.clone());
        }
    }
    builder.start(after);
}
