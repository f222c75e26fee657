//! The end of a mode that reads far ahead, where macro statements after it wait for that.
//!
//! Law: a control reads one block ahead, or many while a mode of quality is in force. Where such a mode ends, empty blocks follow, and
//! then a macro statement reads or writes a variable that programs share, the program holds that statement back: a device outside
//! may read the variable, or write it. A target that reads ahead whatever the mode gets its limit of one block there, and is let free
//! where the source begins such a mode again or returns; a target with a wait gets that. Side condition: no move comes between, and
//! cutter compensation is not in force; else it is for review. Counter-example: the same end of a mode before a way home, which no
//! statement waits for: it is left out with a note, as other modes of quality are (`substitutes`).

use super::compensated::{Compensated, Effect};
use super::lookahead::HOLD_BACK;
use super::waits::{SUPPOSED, SUPPOSED_HELP};
use crate::assume::Predicate;
use crate::canon::{Op, Role, ends_quality};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{
    BlockId, Expr, Module, Nc, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind,
};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::layout::blanks::is_empty;
use std::collections::{BTreeMap, BTreeSet};

/// True where a mode of quality may end, and the target has none and reads ahead.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let early = context.target.behaviour(Question::LookaheadRunsEarly);
    features.op(Op::PathQuality) && early.is_none_or(|row| row.value != "false")
}

/// How the target holds statements back.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Limit,
    Wait,
    None,
}

/// Holds back what the source holds back; true if that changed anything.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let target = context.target;
    let way = if target.code_for(Op::LimitLookahead, &BTreeMap::new()).is_some() {
        Way::Limit
    } else if target.statement("wait").is_some() {
        Way::Wait
    } else {
        Way::None
    };
    let ends: Vec<Vec<End>> = module.programs.iter().map(|program| ends(program, context)).collect();
    if ends.iter().all(Vec::is_empty) {
        return false;
    }
    let summaries = context.summaries(module);
    let compensated = Compensated::of(module, &summaries, context);
    let mut changed = false;
    for (index, ends) in ends.into_iter().enumerate() {
        let (mut held, mut span) = (BTreeMap::new(), None);
        for end in ends {
            let (in_force, effects) = compensated.at(index, end.block.index());
            let last = effects.iter().take_while(|(at, _)| *at < end.at).last();
            let under = last.map_or(in_force, |(_, effect)| *effect == Effect::Begins);
            let free = way == Way::Wait || !under;
            if end.waits && free && way != Way::None {
                held.insert((end.block, end.at), end.empties);
                span = span.or(Some(end.site.span));
            } else {
                let told = Diagnostic::new(Code::Conditional, end.site.span, OPEN).with_help(OPEN_HELP);
                context.add(index, told);
            }
        }
        let Some(span) = span else { continue };
        let program = &mut module.programs[index];
        hold(program, &held, way);
        changed = true;
        if way == Way::Limit {
            let told = Diagnostic::new(Code::QualityDropped, span, HELD);
            context.add_once(index, HELD, told.assuming(Predicate::Substitute(Op::PathQuality)));
            let_free(program, index, context);
        }
    }
    for (index, span) in compensated.supposed.into_iter().filter(|_| changed && way == Way::Limit) {
        context.add(index, Diagnostic::new(Code::Conditional, span, SUPPOSED).with_help(SUPPOSED_HELP));
    }
    changed
}

const OPEN: &str = "a mode that reads far ahead ends here, and empty blocks follow: the source reads no farther than a block ahead from here on. The \
     target reads ahead as before, so what follows may read or write variables before the moves before it are done";

const OPEN_HELP: &str = "check what follows: if a device outside the control reads or writes these variables, limit the reading ahead by hand";

const HELD: &str = "the end of a mode that reads far ahead, before statements that wait for it, becomes a limit on reading ahead, and its beginning the end \
     of the limit";

const UNDER: &str =
    "cutter compensation may begin while reading ahead is limited: the target takes no limit then";

/// A place where such a mode ends and empty blocks follow.
struct End {
    block: BlockId,
    at: usize,
    empties: usize,
    /// True where a statement comes next that shares variables.
    waits: bool,
    site: SourceInfo,
}

/// The mode that a block begins or ends, where it stands beside no words of a move.
fn mode(nc: &Nc) -> Option<f64> {
    let of_arc = |item: &NcItem| {
        matches!(item, NcItem::Word(Role::ArcI | Role::ArcJ | Role::ArcK | Role::ArcRadius, _))
    };
    let alone = nc.has(Op::PathQuality) && !nc.names_axis() && !nc.items.iter().any(of_arc);
    nc.word(Role::Quality).and_then(Expr::constant).filter(|_| alone)
}

fn ends(program: &Program, context: &Context<'_>) -> Vec<End> {
    let mut found = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            let Some(mode) = stmt.kind.nc().and_then(mode).filter(|mode| ends_quality(*mode)) else {
                continue;
            };
            let stays = context.target.code_for(Op::PathQuality, &BTreeMap::from([(Role::Quality, mode)]));
            let rest = &block.stmts[at + 1..];
            // A line with nothing on it is no block to every control.
            let is_block = |stmt: &&Stmt| stmt.site.span.start < stmt.site.span.end;
            let empties = rest.iter().take_while(|stmt| is_empty(stmt)).filter(is_block).count();
            if stays.is_none() && empties > 0 {
                let waits = shares_next(program, id, at + 1);
                found.extend((waits || empties >= HOLD_BACK).then(|| End {
                    block: id,
                    at,
                    empties,
                    waits,
                    site: stmt.site.clone(),
                }));
            }
        }
    }
    found
}

/// True where the next statement on some way reads or writes what programs share, before anything moves.
fn shares_next(program: &Program, from: BlockId, first: usize) -> bool {
    let (mut work, mut seen) = (vec![(from, first)], BTreeSet::new());
    'ways: while let Some((id, first)) = work.pop() {
        let Some(block) = program.block(id) else { continue };
        for stmt in block.stmts.iter().skip(first) {
            let mut shared = match stmt.kind.target() {
                Some(Place::Var(var)) => var.class.shared(),
                Some(_) => true,
                None => matches!(stmt.kind, StmtKind::Output(_) | StmtKind::Print { .. }),
            };
            stmt.kind.exprs(&mut |e| shared |= shares(e));
            match &stmt.kind {
                StmtKind::Nc(nc) if nc.items.is_empty() || nc.has(Op::Dwell) && !nc.moves() => {}
                StmtKind::Comment => {}
                StmtKind::Assign { .. } | StmtKind::Output(_) | StmtKind::Print { .. } if shared => {
                    return true;
                }
                StmtKind::Assign { .. } => {}
                _ => continue 'ways,
            }
        }
        let mut shared = false;
        block.term.kind.exprs(&mut |e| shared |= shares(e));
        match &block.term.kind {
            _ if shared => return true,
            TermKind::Call { .. } => {}
            kind => {
                work.extend(kind.successors().into_iter().filter(|id| seen.insert(*id)).map(|id| (id, 0)))
            }
        }
    }
    false
}

fn shares(e: &Expr) -> bool {
    let mut found = false;
    e.walk(&mut |e| {
        found |= match e {
            Expr::Var(var) => var.class.shared(),
            Expr::System(..) | Expr::Indirect(..) => true,
            _ => false,
        }
    });
    found
}

/// Puts the limit or the wait in the place of the ends, and lets the control free where such a mode begins again.
fn hold(program: &mut Program, held: &BTreeMap<(BlockId, usize), usize>, way: Way) {
    for (id, block) in (0u32..).map(BlockId).zip(&mut program.blocks) {
        let mut out = Stmts::with_capacity(block.stmts.len());
        for (at, mut stmt) in std::mem::take(&mut block.stmts).into_iter().enumerate() {
            let empties = held.get(&(id, at)).copied();
            let begins = || stmt.kind.nc().and_then(mode).is_some_and(|mode| !ends_quality(mode));
            let kind = match (empties, way) {
                (Some(_), Way::Wait) => Some(StmtKind::Sync),
                (Some(_), _) => Some(StmtKind::LimitLookahead(Expr::Number(1.0))),
                (None, Way::Limit) if begins() => Some(StmtKind::LimitLookahead(Expr::Number(0.0))),
                _ => None,
            };
            let Some(kind) = kind else {
                out.push(stmt);
                continue;
            };
            let span = stmt.site.span;
            let empty =
                || Stmt { kind: StmtKind::Comment, site: SourceInfo { span, ..SourceInfo::default() } };
            let rest = take_rest(&mut stmt);
            out.push(Stmt { kind, site: stmt.site });
            out.extend(rest.map(|kind| Stmt { kind, ..empty() }));
            let missing = HOLD_BACK.saturating_sub(empties.unwrap_or(HOLD_BACK));
            let missing = if way == Way::Limit { missing } else { 0 };
            out.extend(std::iter::repeat_with(empty).take(missing));
        }
        block.stmts = out;
    }
}

/// What else stands in the block of a mode.
fn take_rest(stmt: &mut Stmt) -> Option<StmtKind> {
    let StmtKind::Nc(nc) = &mut stmt.kind else { return None };
    let own = |item: &NcItem| {
        matches!(
            item,
            NcItem::Op(Op::PathQuality)
                | NcItem::Word(Role::Quality | Role::Builder | Role::Act1 | Role::Act2, _)
        )
    };
    nc.items.retain(|item| !own(item));
    (!nc.items.is_empty()).then(|| StmtKind::Nc(std::mem::take(nc)))
}

/// Ends the limit where a program returns with it, and tells where compensation begins under it.
fn let_free(program: &mut Program, index: usize, context: &mut Context<'_>) {
    let mut limited = vec![false; program.blocks.len()];
    let mut entered = vec![false; program.blocks.len()];
    let mut work = vec![BlockId(0)];
    while let Some(id) = work.pop() {
        let Some(block) = program.block(id) else { continue };
        entered[id.index()] = true;
        let mut state = limited[id.index()];
        for stmt in &block.stmts {
            match &stmt.kind {
                StmtKind::LimitLookahead(to) => state = to.constant() != Some(0.0),
                StmtKind::Nc(nc) if state && (nc.has(Op::RadiusLeft) || nc.has(Op::RadiusRight)) => {
                    let told = Diagnostic::new(Code::Conditional, stmt.site.span, UNDER)
                        .with_help("begin the mode that reads far ahead again before it");
                    context.add_once(index, UNDER, told);
                }
                _ => {}
            }
        }
        for next in block.term.kind.successors() {
            let Some(known) = limited.get_mut(next.index()) else { continue };
            let news = state && !*known;
            *known |= state;
            if news || !entered[next.index()] {
                work.push(next);
            }
        }
    }
    for (block, mut state) in program.blocks.iter_mut().zip(limited) {
        for stmt in &block.stmts {
            if let StmtKind::LimitLookahead(to) = &stmt.kind {
                state = to.constant() != Some(0.0);
            }
        }
        if state && matches!(block.term.kind, TermKind::Return { .. }) {
            let site = SourceInfo { span: block.term.site.span, ..SourceInfo::default() };
            block.stmts.push(Stmt { kind: StmtKind::LimitLookahead(Expr::Number(0.0)), site });
        }
    }
}
