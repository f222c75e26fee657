//! The pecks of a groove, or of a deep hole, as moves.
//!
//! Law: a column is fed into in pecks, with a way back in rapid after each but the last one, and the tool goes out in rapid to where it began, and on to
//! the next column (docs/lathe.md, G2 to G8). Side conditions: the place where the cycle begins, the end, the peck, the step, the relief and the way back
//! are known numbers. Error bound: half of the sixth decimal, or of the last that the target has a digit for. Counter-example: a start
//! that a called program leaves.

use super::cycle_values::Values;
use super::place::Place;
use super::thread_passes::{UNKNOWN, alone, rounded};
use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::ir::{Expr, Nc, NcItem, SourceInfo, Stmt, StmtKind};

/// A groove: an axis along which it pecks, and one across; X as diameters, lengths as radii.
struct Groove {
    along: Axis,
    across: Axis,
    peck: f64,
    step: f64,
    relief: f64,
    back: f64,
}

/// An axis: from where the cycle came, where it ends, and how much of a coordinate a length of 1 is.
struct Axis {
    role: Role,
    from: f64,
    end: f64,
    counts: f64,
}

impl Axis {
    /// The sense of the way; 0 where there is none.
    fn sense(&self) -> f64 {
        let way = self.end - self.from;
        if way.abs() <= SAME { 0.0 } else { way.signum() }
    }

    /// So far from the start, as a coordinate.
    fn at(&self, length: f64) -> f64 {
        self.from + self.sense() * self.counts * length
    }

    /// The lengths from the start at which parts of a length end, the last one at the end.
    fn parts(&self, part: f64) -> Result<Vec<f64>, &'static str> {
        let whole = (self.end - self.from).abs() / self.counts;
        let mut out = Vec::new();
        while part > 0.0 && part * ((out.len() + 1) as f64) < whole - SAME {
            if out.len() > MOST {
                return Err(LONG);
            }
            out.push(part * (out.len() + 1) as f64);
        }
        out.push(whole);
        Ok(out)
    }
}

/// A move along one axis: whether it is a rapid one, and its place.
type Move = (bool, Role, f64);

impl Groove {
    fn of(nc: &Nc, values: &Values, from: Place) -> Result<Self, &'static str> {
        let number = |role: Role| match nc.word(role) {
            Some(value) => value.constant().map(Some).ok_or(UNKNOWN),
            None => Ok(None),
        };
        let axis = |role: Role, step: Role, from: Option<f64>, counts: f64| -> Result<Option<Axis>, _> {
            let end = match (number(role)?, number(step)?) {
                (Some(to), None) => to,
                (None, Some(by)) => from.ok_or(UNKNOWN)? + by,
                (None, None) => return Ok(None),
                _ => return Err(UNKNOWN),
            };
            Ok(Some(Axis { role, from: from.ok_or(UNKNOWN)?, end, counts }))
        };
        let x = axis(Role::X, Role::StepX, from.x(), 2.0)?;
        let z = axis(Role::Z, Role::StepZ, from.z(), 1.0)?;
        let lengths = [number(Role::GrooveX)?.unwrap_or(0.0), number(Role::GrooveZ)?.unwrap_or(0.0)];
        let (along, across, [peck, step]) = match nc.has(Op::FaceGroove) {
            true => (z, x, [lengths[1], lengths[0]]),
            false => (x, z, lengths),
        };
        let along = along.filter(|axis| axis.sense() != 0.0).ok_or(UNKNOWN)?;
        // Without the word of the other axis there is one column, and nothing is left at its bottom (G4).
        let relief = number(Role::GrooveRelief)?.filter(|_| across.is_some()).unwrap_or(0.0);
        let across = across.unwrap_or(Axis { role: Role::Z, from: 0.0, end: 0.0, counts: 1.0 });
        let back = values.iter().find(|(role, _)| *role == Role::CutRetract);
        let back = back.and_then(|(_, value)| value.constant()).ok_or(UNKNOWN)?;
        let alarms = [peck, step, relief, back].iter().any(|length| *length < 0.0)
            || (across.sense() != 0.0 && step == 0.0);
        if alarms {
            return Err(ALARM);
        }
        Ok(Self { along, across, peck, step, relief, back })
    }

    /// All moves, but those of no length.
    fn moves(&self) -> Result<Vec<Move>, &'static str> {
        let (along, across) = (&self.along, &self.across);
        let pecks = along.parts(self.peck)?;
        let columns = if across.sense() == 0.0 { Vec::new() } else { across.parts(self.step)? };
        if (columns.len() + 1) * (2 * pecks.len() + 2) > MOST {
            return Err(LONG);
        }
        let mut out = Vec::new();
        for (count, column) in std::iter::once(0.0).chain(columns).enumerate() {
            if count > 0 {
                out.push((true, across.role, across.at(column)));
            }
            for (at, peck) in pecks.iter().enumerate() {
                out.push((false, along.role, along.at(*peck)));
                if at + 1 < pecks.len() && self.back > 0.0 {
                    out.push((true, along.role, along.at(peck - self.back)));
                }
            }
            if count > 0 && self.relief > 0.0 {
                out.push((true, across.role, across.at(column - self.relief)));
            }
            out.push((true, along.role, along.from));
        }
        if across.sense() != 0.0 {
            out.push((true, across.role, across.from));
        }
        Ok(out)
    }
}

/// The blocks of a groove, in place of its cycle; if there are none: why.
pub(super) fn all(
    stmt: &Stmt,
    values: &Values,
    from: Place,
    target: &Control,
) -> Result<Vec<Stmt>, &'static str> {
    let nc = alone(stmt, is_of_groove)?;
    let digits = target.numbers().digits;
    let moves = Groove::of(nc, values, from)?.moves()?;
    // Feed and speed count from the first move on, which is one at the feed.
    let first = nc.items.iter().filter(|item| matches!(item, NcItem::Word(Role::Feed | Role::Speed, _)));
    let mut first: Vec<NcItem> = first.cloned().collect();
    let mut was = None;
    let made = moves.into_iter().enumerate().map(|(at, (rapid, role, place))| {
        let op = NcItem::Op(if rapid { Op::Rapid } else { Op::Linear });
        let mut items: Vec<NcItem> = Some(op).filter(|_| was != Some(rapid)).into_iter().collect();
        was = Some(rapid);
        items.push(NcItem::Word(role, Expr::Number(rounded(place, digits))));
        items.append(&mut first);
        let own = SourceInfo { span: stmt.site.span, ..SourceInfo::default() };
        let site = if at == 0 { stmt.site.clone() } else { own };
        Stmt { kind: StmtKind::Nc(Nc { items }), site }
    });
    Ok(made.collect())
}

/// True for the code and the words of a groove's cycle, and for what counts from its first move on.
pub(super) fn is_of_groove(item: &NcItem) -> bool {
    match item {
        NcItem::Op(op) => matches!(op, Op::Groove | Op::FaceGroove),
        NcItem::Word(role, _) => matches!(
            role,
            Role::X
                | Role::Z
                | Role::StepX
                | Role::StepZ
                | Role::Feed
                | Role::Speed
                | Role::GrooveX
                | Role::GrooveZ
                | Role::GrooveRelief
                | Role::CutRetract
        ),
        NcItem::Code(..) => false,
    }
}

/// More blocks are not written out.
const MOST: usize = 500;
/// What lies no farther apart is one place.
const SAME: f64 = 1e-9;

const LONG: &str = "they are more than 500 blocks";
const ALARM: &str = "a peck, a step or a way back is negative, or a step is 0";
