//! The pecks of a groove, or of a deep hole, whose numbers are computed, as a loop.
//!
//! Law: column after column is fed into, peck after peck, as the cycle does (docs/lathe.md, G2 to G8). Side conditions: the
//! blocks before say where the cycle begins, as numbers or by variables that still hold what they held there; where the step
//! between columns is computed, they lie between places that are known. A negative peck,
//! and a step of 0 or less, are an alarm, as they are of the cycle. Error bound: a peck that would end less than 0.00001 above the
//! bottom goes to the bottom, and a step that would end so near to the last column goes there. Counter-example: a start in
//! increments.

use super::cycle_values::Values;
use super::groove_passes::is_of_groove;
use super::pen::{Laid, Pen};
use super::thread_loops::{counts, difference, moved, product, quotient, sum, whole};
use super::thread_passes::{UNKNOWN, alone, rounded};
use crate::canon::{Func, Op, Role};
use crate::dialect::Control;
use crate::ir::{BlockId, Cond, Expr, Nc, NcItem, Relation, SourceInfo, Stmt, StmtKind, TermKind, Var};
use crate::text::Span;

/// A groove whose numbers are computed; X as diameters, lengths as radii.
#[derive(Debug)]
pub(super) struct Groove {
    site: SourceInfo,
    along: Axis,
    across: Option<Axis>,
    peck: Expr,
    step: Expr,
    back: Expr,
    /// How far the tool goes from the stock at the bottom of a column after the first.
    relief: Expr,
    /// The feed.
    words: Vec<NcItem>,
    /// The speed of the spindle.
    speed: Option<NcItem>,
    /// The most digits that the target takes.
    digits: Option<u32>,
}

/// An axis: from where the cycle came, where it ends, and how much of a coordinate a length of 1 is.
#[derive(Clone, Debug)]
struct Axis {
    role: Role,
    from: Expr,
    end: Expr,
    counts: f64,
}

impl Groove {
    /// The loop for a groove; if there is none: why.
    pub(super) fn of(
        stmt: &Stmt,
        values: &Values,
        from: [Option<Expr>; 2],
        (source, target): (&Control, &Control),
    ) -> Result<Self, &'static str> {
        let nc = alone(stmt, is_of_groove)?;
        let told = |role: Role| values.iter().find(|(found, _)| *found == role).map(|(_, value)| value);
        let length =
            |role: Role| nc.word(role).or(told(role)).map(|value| whole(value.clone(), role, source));
        let [x, z] = from;
        let axis =
            |role: Role, step: Role, from: Option<Expr>, counts: f64| match (nc.word(role), nc.word(step)) {
                (None, None) => Ok(None),
                (Some(to), None) => {
                    Ok(Some(Axis { role, from: from.ok_or(UNKNOWN)?, end: to.clone(), counts }))
                }
                (None, Some(by)) => {
                    let from = from.ok_or(UNKNOWN)?;
                    Ok(Some(Axis { role, end: sum(from.clone(), by.clone()), from, counts }))
                }
                _ => Err(UNKNOWN),
            };
        let (x, z) = (axis(Role::X, Role::StepX, x, 2.0)?, axis(Role::Z, Role::StepZ, z, 1.0)?);
        let lengths = [Role::GrooveX, Role::GrooveZ].map(|role| length(role).unwrap_or(Expr::Number(0.0)));
        let (along, across, [peck, step]) = match (nc.has(Op::FaceGroove), lengths) {
            (true, [x_length, z_length]) => (z, x, [z_length, x_length]),
            (false, lengths) => (x, z, lengths),
        };
        let of = |wanted: Role| {
            let is = move |item: &&NcItem| matches!(item, NcItem::Word(role, _) if *role == wanted);
            nc.items.iter().filter(is).cloned()
        };
        let found = Self {
            site: stmt.site.clone(),
            along: along.ok_or(UNKNOWN)?,
            across: across.filter(|axis| axis.from != axis.end),
            peck,
            step,
            back: told(Role::CutRetract).cloned().ok_or(UNKNOWN)?,
            relief: length(Role::GrooveRelief).unwrap_or(Expr::Number(0.0)),
            words: of(Role::Feed).collect(),
            speed: of(Role::Speed).next(),
            digits: target.numbers().digits,
        };
        (found.is_readable() && found.is_sound()).then_some(found).ok_or(UNKNOWN)
    }

    /// True where none of its values is a count of increments.
    fn is_readable(&self) -> bool {
        let places = [Some(&self.along), self.across.as_ref()].into_iter().flatten();
        let places = places.flat_map(|axis| [&axis.from, &axis.end]);
        !places.chain([&self.peck, &self.step, &self.back, &self.relief]).any(counts)
    }

    /// True where no known number of it is an alarm, and a computed step leads somewhere.
    fn is_sound(&self) -> bool {
        let along = self.along.way().is_none_or(|way| way != 0.0);
        let step = match (&self.across, self.step.constant()) {
            (None, step) => step.is_some_and(|step| step >= 0.0),
            (Some(_), Some(step)) => step > 0.0,
            (Some(across), None) => across.way().is_some_and(|way| way != 0.0),
        };
        let least = |value: &Expr| value.constant().is_none_or(|value| value >= 0.0);
        along && step && least(&self.peck) && least(&self.relief)
    }
}

impl Axis {
    /// How far it goes, as a coordinate, where that is known.
    fn way(&self) -> Option<f64> {
        Some(self.end.constant()? - self.from.constant()?)
    }
}

/// An axis whose values may be read again, how long its way is, and the way itself where its sense is not known.
struct Held {
    axis: Axis,
    long: Expr,
    way: Option<Expr>,
}

impl Pen<'_, Groove> {
    pub(super) fn write(mut self) {
        let found = self.found;
        if !found.site.comments.is_empty() || found.site.sequence.get().is_some() {
            self.builder.push(StmtKind::Comment, found.site.clone());
        }
        if let Some(speed) = found.speed.clone() {
            // Not alone: a pass may be in force.
            let items = vec![NcItem::Op(Op::Rapid), speed];
            self.builder.push(StmtKind::Nc(Nc { items }), self.site());
        }
        let along = self.axis(&found.along);
        let across = found.across.as_ref().map(|axis| self.axis(axis));
        let [peck, step, back, relief] =
            [&found.peck, &found.step, &found.back, &found.relief].map(|value| self.held(value.clone()));
        self.alarm(Relation::Less, &peck);
        self.alarm(Relation::LessEqual, &step);
        let Some(across) = across else { return self.column(&along, (&peck, &back), None) };
        self.alarm(Relation::Less, &relief);
        let column = self.temp();
        self.set(column, Expr::Number(0.0));
        let (head, next, done) = (self.builder.fresh(), self.builder.fresh(), self.builder.fresh());
        self.builder.start(head);
        let aside = (relief.constant() != Some(0.0)).then_some((&across, column, &relief));
        self.column(&along, (&peck, &back), aside);
        self.branch(Relation::GreaterEqual, (Expr::Var(column), across.long.clone()), [done, next], next);
        self.set(column, sum(Expr::Var(column), step));
        let (last, goes) = (self.builder.fresh(), self.builder.fresh());
        self.branch(Relation::GreaterEqual, (Expr::Var(column), near(&across.long)), [last, goes], last);
        self.set(column, across.long.clone());
        self.builder.start(goes);
        let place = self.at(&across, Expr::Var(column));
        self.go(Op::Rapid, &across.axis, place);
        self.builder.end(TermKind::Jump(head), self.site());
        self.builder.start(done);
        self.go(Op::Rapid, &across.axis, across.axis.from.clone());
    }

    /// The pecks of a column, the way from the stock at the side, and the way out.
    fn column(&mut self, along: &Held, (peck, back): (&Expr, &Expr), aside: Option<(&Held, Var, &Expr)>) {
        let (axis, from) = (&along.axis, along.axis.from.clone());
        let whole = match (peck.constant(), along.long.constant()) {
            (Some(peck), long) => peck == 0.0 || long.is_some_and(|long| peck >= long - NEAR),
            _ => false,
        };
        if !whole {
            let depth = self.temp();
            self.set(depth, Expr::Number(0.0));
            let (head, cut, bottom) = (self.builder.fresh(), self.builder.fresh(), self.builder.fresh());
            self.builder.start(head);
            self.set(depth, sum(Expr::Var(depth), peck.clone()));
            let deep = Cond::Compare(Relation::GreaterEqual, Expr::Var(depth), near(&along.long));
            let none = Cond::Compare(Relation::Equal, peck.clone(), Expr::Number(0.0));
            // A peck of 0 goes to the bottom at once.
            let cond = if peck.constant().is_some() { deep } else { Cond::Or(vec![none, deep]) };
            let branch = TermKind::Branch { cond: cond.into(), then: bottom, otherwise: cut };
            self.builder.end(branch, self.site());
            self.builder.start(cut);
            let place = self.at(along, Expr::Var(depth));
            self.go(Op::Linear, axis, place);
            let place = self.at(along, difference(Expr::Var(depth), back.clone()));
            self.go(Op::Rapid, axis, place);
            self.builder.end(TermKind::Jump(head), self.site());
            self.builder.start(bottom);
        }
        self.go(Op::Linear, axis, axis.end.clone());
        if let Some((across, column, relief)) = aside {
            // Not in the first column, which has stock on both sides (G4).
            let (goes, out) = (self.builder.fresh(), self.builder.fresh());
            self.branch(Relation::Equal, (Expr::Var(column), Expr::Number(0.0)), [out, goes], goes);
            let place = self.at(across, difference(Expr::Var(column), relief.clone()));
            self.go(Op::Rapid, &across.axis, place);
            self.builder.start(out);
        }
        self.go(Op::Rapid, axis, from);
    }

    /// A place so far from where the cycle came.
    fn at(&mut self, held: &Held, length: Expr) -> Expr {
        let Axis { from, counts, .. } = &held.axis;
        match &held.way {
            Some(way) => sum(from.clone(), quotient(product(way.clone(), length), held.long.clone())),
            None => {
                let sense = held.axis.way().map_or(0.0, f64::signum);
                moved(from.clone(), Expr::Number(sense * counts), length)
            }
        }
    }

    /// A move along one axis; a feed has the cycle's F.
    fn go(&mut self, op: Op, axis: &Axis, place: Expr) {
        let place = match place {
            Expr::Number(place) => Expr::Number(rounded(place, self.found.digits)),
            place => place,
        };
        let mut items = vec![NcItem::Op(op), NcItem::Word(axis.role, place)];
        if op == Op::Linear {
            items.extend(self.found.words.iter().cloned());
        }
        self.builder.push(StmtKind::Nc(Nc { items }), self.site());
    }

    fn axis(&mut self, axis: &Axis) -> Held {
        let [from, end] = [&axis.from, &axis.end].map(|value| self.held(value.clone()));
        let axis = Axis { from, end, ..axis.clone() };
        if let Some(way) = axis.way() {
            return Held { long: Expr::Number(way.abs() / axis.counts), axis, way: None };
        }
        let way = self.held(difference(axis.end.clone(), axis.from.clone()));
        let long = Expr::Call(Func::Abs, [way.clone()].into());
        let long = if axis.counts == 1.0 { long } else { quotient(long, Expr::Number(axis.counts)) };
        Held { long: self.held(long), axis, way: Some(way) }
    }

    /// An alarm where a value is of this kind, if it is computed.
    fn alarm(&mut self, relation: Relation, value: &Expr) {
        if value.constant().is_some() {
            return;
        }
        let cond = Cond::Compare(relation, value.clone(), Expr::Number(0.0));
        self.stop_if(cond, "GROOVE WITHOUT PECK");
    }

    /// Ends a block with a comparison, and goes on with one of the two that follow it.
    fn branch(
        &mut self,
        relation: Relation,
        (a, b): (Expr, Expr),
        [then, otherwise]: [BlockId; 2],
        next: BlockId,
    ) {
        let cond = Cond::Compare(relation, a, b).into();
        self.builder.end(TermKind::Branch { cond, then, otherwise }, self.site());
        self.builder.start(next);
    }
}

impl Laid for Groove {
    fn span(&self) -> Span {
        self.site.span
    }
}

/// A little less than a length.
fn near(long: &Expr) -> Expr {
    difference(long.clone(), Expr::Number(NEAR))
}

/// What ends so near to the end is the end.
const NEAR: f64 = 0.00001;
