//! What becomes of each statement of a program, and how it is laid down.

use super::starts::{self, Kept};
use super::turn::Turn;
use super::{COMPUTED, Made, Maker, START, VACANT, is_arc};
use crate::canon::{Group, Op, Role};
use crate::ir::analysis::programmed::Programmed;
use crate::ir::analysis::{Modal, Summaries};
use crate::ir::{BlockId, Builder, Class, Expr, Nc, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Var};
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::BTreeSet;

/// What is known of a program from others.
pub(super) struct Library<'l> {
    pub summaries: &'l Summaries,
    /// The programs that move nothing.
    pub still: &'l BTreeSet<ProgramName>,
    /// The locals that every call of the program sets.
    pub given: &'l BTreeSet<Var>,
    /// True where another plane than XY may be in force unnamed.
    pub other_planes: bool,
}

/// What becomes of a program.
pub(super) struct Plan {
    /// By block, by statement, with the axes whose absolute words are where the tool then stands.
    made: Vec<Vec<(Made, [bool; 2])>>,
    temps: u32,
    /// What holds the last absolute words of X and Y, if an arc reads them.
    copies: Option<[Var; 2]>,
    pub changes: bool,
    /// True where an arc was worked out from where it begins.
    pub rests: bool,
    pub refused: Vec<(&'static str, Span)>,
    /// Arcs whose radius is taken to be positive.
    pub positive: Vec<Span>,
    /// Arcs whose end is taken to lie on them.
    pub turned: Vec<Span>,
}

impl Plan {
    pub fn of(
        program: &Program,
        library: &Library<'_>,
        modal: &dyn Fn(BlockId) -> Modal,
        faulty: &dyn Fn(Span) -> bool,
    ) -> Self {
        let temps = highest_temp(program);
        let mut plan = Self {
            made: Vec::new(),
            temps,
            copies: None,
            changes: false,
            rests: false,
            refused: Vec::new(),
            positive: Vec::new(),
            turned: Vec::new(),
        };
        let shaped = |stmt: &Stmt| stmt.kind.nc().is_some_and(super::has_shape);
        if !program.blocks.iter().flat_map(|block| &block.stmts).any(shaped) {
            return plan;
        }
        let summaries = library.summaries;
        let named = Programmed::of(program, summaries, modal);
        let vacant = starts::vacant(program, summaries, library.given);
        let comes_back = starts::comes_back(program, summaries, library.still);
        let kept = starts::of(program, (library.still, comes_back), modal, &vacant);
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = modal(id);
            let mut here = named.at(id).cloned();
            let mut copied = kept.at(id).copied().unwrap_or(Kept([false; 2]));
            copied.enter(block, comes_back);
            let mut made = Vec::with_capacity(block.stmts.len());
            for (stmt, vacant) in block.stmts.iter().zip(&vacant[id.index()]) {
                let start = here.as_ref().and_then(Programmed::words);
                let before = copied;
                state.step(stmt);
                here.iter_mut().for_each(|here| here.step(stmt, &state, summaries));
                copied.step(stmt, &state, vacant);
                let axes = stmt.kind.nc().map_or([false; 2], |nc| starts::named(nc, &state, vacant));
                let arc = stmt.kind.nc().is_some_and(|nc| is_arc(nc, &state));
                let what = if arc && !faulty(stmt.site.span) {
                    plan.arc(stmt, &state, (start, before), (library.other_planes, vacant.contains(&true)))
                } else {
                    Made::Kept
                };
                made.push((what, axes));
            }
            plan.made.push(made);
        }
        plan
    }

    /// What becomes of an arc, that begins at a known place, or where what is copied says.
    fn arc(
        &mut self,
        stmt: &Stmt,
        state: &Modal,
        (start, copied): (Option<[Expr; 2]>, Kept),
        (other_planes, vacant): (bool, bool),
    ) -> Made {
        let span = stmt.site.span;
        let mut maker = Maker { temps: &mut self.temps, positive: false };
        let what = match maker.arc(stmt, state, start.clone(), other_planes) {
            Ok(pieces) => {
                let positive = maker.positive;
                let radius = stmt.kind.nc().and_then(|nc| nc.word(Role::ArcRadius)).map(Expr::constant);
                let moves = pieces.iter().filter(|stmt| stmt.kind.nc().is_some_and(super::has_shape)).count();
                self.rests |=
                    moves > 1 || radius.is_none_or(|radius| radius.is_some_and(|radius| radius < 0.0));
                self.positive.extend(positive.then_some(span));
                self.changes = true;
                return Made::Pieces(pieces);
            }
            Err(what) => what,
        };
        let turns = matches!(what, COMPUTED | START) && !vacant;
        let ccw = state.op(Group::Motion) == Some(Op::ArcCcw);
        let incremental = state.op(Group::Distance) == Some(Op::Incremental);
        let known = turns.then(|| Turn::of(stmt, ccw, incremental, start.clone())).flatten();
        let mut by_copies = || {
            let copies = self.copies.unwrap_or_else(|| {
                self.temps += 2;
                [1, 0].map(|back| Var { class: Class::Temp, number: self.temps - back })
            });
            let turn = Turn::of(stmt, ccw, incremental, Some(copies.map(Expr::Var)))?;
            self.copies = Some(copies);
            Some(turn)
        };
        match known.or_else(|| {
            if turns && start.is_none() && copied == Kept([true; 2]) { by_copies() } else { None }
        }) {
            Some(turn) => {
                self.turned.push(span);
                self.rests = true;
                self.changes = true;
                Made::Turn(turn)
            }
            None => {
                let absolute = state.op(Group::Distance) == Some(Op::Absolute);
                let what = match what {
                    COMPUTED if vacant => VACANT,
                    COMPUTED if absolute && start.is_none() && copied != Kept([true; 2]) => START,
                    what => what,
                };
                self.refused.push((what, span));
                Made::Kept
            }
        }
    }

    /// Lays the program down as planned.
    pub fn lay(self, program: &mut Program) {
        let Self { made, mut temps, copies, .. } = self;
        let mut blocks = made.into_iter();
        let mut here = Vec::new().into_iter();
        rebuild(program, &mut |builder, part| match part {
            Part::Start(_) => here = blocks.next().unwrap_or_default().into_iter(),
            Part::Term(_) => part.keep(builder),
            Part::Stmt(mut stmt) => {
                let (what, axes) = here.next().unwrap_or((Made::Kept, [false; 2]));
                let copies = copies.filter(|_| axes != [false; 2]);
                let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
                let words = copies.map(|copies| copied(&mut stmt, copies, axes, matches!(what, Made::Kept)));
                let copy = |builder: &mut Builder| {
                    for (target, value) in words.into_iter().flatten() {
                        let target = Place::Var(target);
                        builder.push(StmtKind::Assign { target, value }, site.clone());
                    }
                };
                match what {
                    Made::Kept => {
                        copy(builder);
                        builder.push(stmt.kind, stmt.site);
                    }
                    Made::Pieces(pieces) => {
                        pieces.into_iter().for_each(|stmt| builder.push(stmt.kind, stmt.site));
                        copy(builder);
                    }
                    Made::Turn(turn) => {
                        turn.lay(builder, &mut temps);
                        copy(builder);
                    }
                }
            }
        });
    }
}

/// What the copies of these axes get: the words of a block, which reads the copy where it would work a word out again.
fn copied(stmt: &mut Stmt, copies: [Var; 2], axes: [bool; 2], reads: bool) -> Vec<(Var, Expr)> {
    let StmtKind::Nc(Nc { items }) = &mut stmt.kind else { return Vec::new() };
    let mut out = Vec::new();
    for item in items {
        let NcItem::Word(role @ (Role::X | Role::Y), value) = item else { continue };
        let axis = usize::from(*role == Role::Y);
        if axes[axis] {
            out.push((copies[axis], value.clone()));
            if reads && !matches!(value, Expr::Number(_) | Expr::Var(_)) {
                *value = Expr::Var(copies[axis]);
            }
        }
    }
    out
}
