//! Numbers without a decimal point, where the target does not count them as the source does.
//!
//! Law: n increments are `n * increment` of the unit in force, for an angle of a degree. Side condition: the unit is known, from the
//! text or from a machine profile (a program that is called from both units has none); else the number keeps its form only where both controls count alike.
//! A program that names one unit is taken to be in it after what it calls, where nothing of that can leave another.
//! Where no source says what the target counts, a number gets its point all the same if the unit is known.
//! Counter-example: `G#1`, which puts back the unit of the caller.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{BareLength, Control, Machine, Units};
use crate::ir::{Block, BlockId, Call, Expr, Module, NcItem, Program, StmtKind, TermKind};
use crate::legalize::moves::units::exit::ExitUnit;
use crate::legalize::{Context, Modal, ModalFacts, Setting};
use crate::text::Span;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What is said where the unit is not known, and where it rests on what the library has not.
#[derive(Clone, Copy)]
pub(in crate::legalize) struct Texts {
    pub unknown: &'static str,
    pub guessed: &'static str,
}

const TEXTS: Texts = Texts {
    unknown: "a number without a decimal point counts increments, and their size depends on the unit in force, which is \
              not known here",
    guessed: "a number without a decimal point is taken in the unit that the program names: a called program outside \
              the library must not change it",
};

/// Converts counts of increments that the target reads otherwise.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let (source, target) = (context.source, context.target);
    let keeps = |local: u32| kept_by(local, source, target);
    // With a point a number rests on the source alone; without a unit it stays as it is.
    let asked = target.machine() == Machine::Mill
        && source.name() != target.name()
        && !target.numbers().origin.is_settled()
        && target.profile().decimal_point.is_none();
    if !has_any(module, &counts) {
        return false;
    }
    // No unit hangs on a count.
    let units = InForce::of(module, context);
    if asked && target.bare_length() == BareLength::Increments && same_increments(source, target) {
        take(module, context, &units, None, counts, &mut |kind, units| match kind {
            Counted::Stmt(StmtKind::Nc(nc)) => nc.items.iter_mut().all(|item| match item {
                NcItem::Word(Role::Feed, _) => true,
                NcItem::Word(role, value) => convert(value, role.is_angle(), units, source),
                _ => true,
            }),
            _ => true,
        });
        context.forget();
    }
    take(module, context, &units, Some(TEXTS), counts, &mut |kind, units| match kind {
        Counted::Stmt(StmtKind::Nc(nc)) => nc.items.iter_mut().all(|item| match item {
            NcItem::Word(role, value) => word(value, *role, units, source, target),
            _ => true,
        }),
        Counted::Stmt(StmtKind::ModalCall(call)) => arguments(call, units, source, keeps),
        Counted::Call(call) => arguments(call, units, source, keeps),
        Counted::Stmt(_) => true,
    });
    true
}

/// Converts those of the arguments of modal calls: they count in the unit where the call is opened, and
/// the moves after which the macro runs may be in the other one.
pub(in crate::legalize) fn of_modal_calls(module: &mut Module, context: &mut Context<'_>) {
    let source = context.source;
    let modal = |block: &Block| block.stmts.iter().any(|s| matches!(s.kind, StmtKind::ModalCall(_)));
    each(module, context, Some(TEXTS), modal, &mut |kind, units| match kind {
        Counted::Stmt(StmtKind::ModalCall(call)) => arguments(call, units, source, |_| false),
        _ => true,
    });
}

/// What may have counts of increments in it.
pub(in crate::legalize) enum Counted<'m> {
    Stmt(&'m mut StmtKind),
    Call(&'m mut Call),
}

impl Counted<'_> {
    fn again(&mut self) -> Counted<'_> {
        match self {
            Self::Stmt(kind) => Counted::Stmt(kind),
            Self::Call(call) => Counted::Call(call),
        }
    }
}

/// Takes what stands in the chosen blocks through `convert`, with the unit that is known there; what it cannot
/// convert is reported once a program. Without texts it stays as it is, and so does what rests on a program that the library
/// has not. True where there are such blocks.
pub(in crate::legalize) fn each(
    module: &mut Module,
    context: &mut Context<'_>,
    texts: Option<Texts>,
    chosen: impl Fn(&Block) -> bool,
    convert: &mut dyn FnMut(Counted<'_>, Option<Units>) -> bool,
) -> bool {
    let any = has_any(module, &chosen);
    if any {
        let units = InForce::of(module, context);
        take(module, context, &units, texts, chosen, convert);
    }
    any
}

fn has_any(module: &Module, chosen: &impl Fn(&Block) -> bool) -> bool {
    module.programs.iter().flat_map(|program| &program.blocks).any(chosen)
}

/// What is known of the units of a library.
struct InForce {
    /// By program, which it may leave.
    left: Vec<ExitUnit>,
    /// Which any of them may leave.
    all: ExitUnit,
    facts: Arc<ModalFacts>,
}

impl InForce {
    fn of(module: &Module, context: &Context<'_>) -> Self {
        let left = ExitUnit::of(module, context);
        let all = left.iter().copied().fold(ExitUnit::default(), ExitUnit::join);
        Self { left, all, facts: facts(module, context, all) }
    }
}

/// Does what [`each`] says, with what is known of the units.
fn take(
    module: &mut Module,
    context: &mut Context<'_>,
    InForce { left, all, facts }: &InForce,
    texts: Option<Texts>,
    chosen: impl Fn(&Block) -> bool,
    convert: &mut dyn FnMut(Counted<'_>, Option<Units>) -> bool,
) {
    for (index, program) in module.programs.iter_mut().enumerate() {
        let units = UnitsIn::of(program, index, facts, &chosen);
        let guesses = if units.is_known() { None } else { Some(guesses(program, left[index], &chosen)) };
        // What is in force where no program names a unit, or where all name the machine's.
        let machine = context.source.units().filter(|units| all.keeps(*units));
        let (mut unknown, mut guessed) = (None, None);
        let mut take = |mut counted: Counted<'_>, place: (BlockId, usize), span: Span| {
            if convert(counted.again(), units.at(place)) {
                return;
            }
            let guess = guesses.as_ref().and_then(|guesses| guesses.at(place)).or(machine);
            let guess = guess.filter(|_| texts.is_some() || !left[index].outside);
            if guess.is_some() && convert(counted, guess) {
                guessed.get_or_insert(span);
            } else {
                unknown.get_or_insert(span);
            }
        };
        for (id, block) in program.ids().zip(&mut program.blocks).filter(|(_, block)| chosen(block)) {
            for (at, stmt) in block.stmts.iter_mut().enumerate() {
                take(Counted::Stmt(&mut stmt.kind), (id, at), stmt.site.span);
            }
            if let TermKind::Call { call, .. } = &mut block.term.kind {
                take(Counted::Call(call), (id, block.stmts.len()), block.term.site.span);
            }
        }
        let Some(texts) = texts else { continue };
        report(index, texts, unknown, guessed.filter(|_| left[index].outside), context);
    }
}

/// Reports the first number whose unit is not known, and the first whose unit rests on what the library has not.
fn report(
    index: usize,
    texts: Texts,
    unknown: Option<Span>,
    guessed: Option<Span>,
    context: &mut Context<'_>,
) {
    if let Some(span) = unknown {
        let help = "name the unit in the program (G20, G21) or in the machine profile of the source";
        let finding = Diagnostic::new(Code::NoEquivalent, span, texts.unknown).with_help(help);
        context.add_once(index, texts.unknown, finding);
    }
    if let Some(span) = guessed {
        let what = texts.guessed;
        context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
    }
}

/// What is in force in the library, as far as that is known for sure.
fn facts(module: &Module, context: &Context<'_>, all: ExitUnit) -> Arc<ModalFacts> {
    let mut entry = context.entry.clone();
    if let (Setting::Unknown, Some(units)) = (entry.of(Group::Units), context.source.units()) {
        entry.start_in(if units == Units::Inch { Op::Inch } else { Op::Metric });
    }
    entry.one_unit = all.is_one();
    // Where no program names a unit, it is the machine's all through.
    let known = context.entry.op(Group::Units).is_some() || all != ExitUnit::default();
    // A unit that no run begins in, and no program names, is in force nowhere.
    let told = entry.op(Group::Units).is_some() || all.names_any();
    if known && told { context.modal_facts_from(module, &entry) } else { Arc::new(ModalFacts::unknown()) }
}

/// What a program that names one unit has in force where every way to a place names it, and nothing in the library that
/// it runs names another.
fn guesses(program: &Program, left: ExitUnit, chosen: &dyn Fn(&Block) -> bool) -> UnitsIn {
    if left.named().is_none_or(|units| !left.keeps(units)) {
        return UnitsIn::default();
    }
    let mut entry = Modal::unknown();
    entry.one_unit = true;
    let alone = Module { programs: vec![program.clone()], ..Module::default() };
    UnitsIn::of(program, 0, &ModalFacts::of(&alone, &entry), chosen)
}

/// The unit that counts in each statement of some blocks of a program, and at their ends.
#[derive(Default)]
struct UnitsIn(BTreeMap<BlockId, Vec<Option<Units>>>);

impl UnitsIn {
    fn of(program: &Program, index: usize, facts: &ModalFacts, chosen: &dyn Fn(&Block) -> bool) -> Self {
        let blocks = program.ids().zip(&program.blocks).filter(|(_, block)| chosen(block));
        let known = |id, block: &Block| match facts.unit_all_through(index, id, block) {
            Some(setting) => vec![unit(&setting); block.stmts.len() + 1],
            None => Self::in_block(block, facts.at(index, id)),
        };
        Self(blocks.map(|(id, block)| (id, known(id, block))).collect())
    }

    fn in_block(block: &Block, mut state: Modal) -> Vec<Option<Units>> {
        let mut found = Vec::with_capacity(block.stmts.len() + 1);
        for stmt in &block.stmts {
            // A modal call that the block sets off comes after its words.
            let mut words = state.clone();
            if let StmtKind::Nc(nc) = &stmt.kind {
                words.step_words(nc);
            }
            found.push(unit(&words.of(Group::Units)));
            state.step(stmt);
        }
        found.push(unit(&state.of(Group::Units)));
        found
    }

    fn is_known(&self) -> bool {
        self.0.values().flatten().all(Option::is_some)
    }

    fn at(&self, (block, at): (BlockId, usize)) -> Option<Units> {
        *self.0.get(&block)?.get(at)?
    }
}

/// True where a block has a count of increments.
fn counts(block: &Block) -> bool {
    let mut any = false;
    let mut look = |e: &Expr| {
        any |= match e {
            Expr::Negate(inner) => matches!(**inner, Expr::Increments(_)),
            e => matches!(e, Expr::Increments(_)),
        }
    };
    block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
    block.term.kind.exprs(&mut look);
    any
}

fn unit(setting: &Setting) -> Option<Units> {
    match setting {
        Setting::Known(Op::Inch, _) => Some(Units::Inch),
        Setting::Known(Op::Metric, _) => Some(Units::Metric),
        _ => None,
    }
}

pub(in crate::legalize) fn units_named(program: &Program) -> impl Iterator<Item = Units> + '_ {
    let ncs = program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| match &stmt.kind {
        StmtKind::Nc(nc) => Some(nc),
        _ => None,
    });
    ncs.flat_map(|nc| nc.ops()).filter_map(|op| match op {
        Op::Inch => Some(Units::Inch),
        Op::Metric => Some(Units::Metric),
        _ => None,
    })
}

/// Converts a word where it must be; false where it must be and cannot.
fn word(value: &mut Expr, role: Role, units: Option<Units>, source: &Control, target: &Control) -> bool {
    let bare = if role == Role::Feed { target.bare_feed() } else { target.bare_length() };
    let same = bare == BareLength::Increments && same_increments(source, target) && role != Role::Feed;
    if same && (units.is_none() || keeps_form(role, source, target)) {
        return true;
    }
    convert(value, role.is_angle(), units, source)
}

/// True where a number without a point stays as it is. Where it counts alike on the target as far as is known, but nobody is sure
/// of it, and in a cycle of a lathe, whose values are worked with, it gets its point.
fn keeps_form(role: Role, source: &Control, target: &Control) -> bool {
    let sure = target.profile().decimal_point.is_some() || target.numbers().origin.is_settled();
    let alike = source.name() == target.name();
    let worked = target.machine() == Machine::Lathe && !((role.is_axis() || role.is_step()) && alike);
    (sure || alike) && !worked
}

/// True where a number without a point counts the same after this argument's letter on both controls.
fn kept_by(local: u32, source: &Control, target: &Control) -> bool {
    let letter = target.argument_letter(local);
    let bare = letter.map_or(BareLength::Unknown, |letter| target.bare_argument(letter));
    let alike = counts_angles(local, source) == counts_angles(local, target);
    bare == BareLength::Increments && alike && same_increments(source, target)
}

/// True where a number without a point counts increments of angles after this argument's letter.
fn counts_angles(local: u32, control: &Control) -> bool {
    let word = control.argument_letter(local).and_then(|letter| control.word(letter, false));
    control.numbers().angle_arguments && word.is_some_and(|row| row.role.is_angle())
}

/// Converts the arguments of a call, but those whose local says that they are kept; false where one cannot be.
fn arguments(call: &mut Call, units: Option<Units>, source: &Control, kept: impl Fn(u32) -> bool) -> bool {
    let mut good = true;
    for argument in call.arguments.iter_mut().filter(|argument| !kept(argument.local)) {
        good &= convert(&mut argument.value, counts_angles(argument.local, source), units, source);
    }
    good
}

fn same_increments(source: &Control, target: &Control) -> bool {
    let (a, b) = (source.numbers(), target.numbers());
    (a.increment_mm, a.increment_inch, a.increment_degrees)
        == (b.increment_mm, b.increment_inch, b.increment_degrees)
}

fn convert(value: &mut Expr, angle: bool, units: Option<Units>, source: &Control) -> bool {
    let inner = match value {
        Expr::Negate(inner) => inner.as_mut(),
        other => other,
    };
    let Expr::Increments(count) = inner else { return true };
    // Zero is zero in every unit.
    let per_unit = match units {
        _ if *count == 0.0 => 1.0,
        _ if angle => 1.0 / source.numbers().increment_degrees,
        Some(Units::Metric) => 1.0 / source.numbers().increment_mm,
        Some(Units::Inch) => 1.0 / source.numbers().increment_inch,
        None => return false,
    };
    // Dividing by a whole number gives the decimal that a person would write.
    *inner = Expr::Number(*count / per_unit.round());
    true
}

/// Least increments of the source in a unit of length; none if the unit is not known.
pub(in crate::legalize) fn parts_of_unit(state: &Modal, source: &Control) -> Option<f64> {
    let named = state.op(Group::Units).map(|op| if op == Op::Inch { Units::Inch } else { Units::Metric });
    let numbers = source.numbers();
    named.or(source.units()).map(|unit| match unit {
        Units::Inch => (1.0 / numbers.increment_inch).round(),
        Units::Metric => (1.0 / numbers.increment_mm).round(),
    })
}
