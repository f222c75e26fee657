//! The words of a block in milling on a face, in those of the other control.

use super::known::moved;
use super::{AXIS, STEPS, VACANT};
use crate::canon::{Group, Op, Role};
use crate::ir::{BinOp, Expr, Nc, NcItem};

/// True for a word that counts in the plane, or may.
pub fn counts(nc: &Nc) -> bool {
    let arc = |role: Role| matches!(role, Role::ArcI | Role::ArcJ | Role::ArcK | Role::ArcRadius);
    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_axis() || arc(*role)))
}

/// True for an operation that may stand in such milling (V4 of docs/lathe.md).
pub fn may_stand(op: Op) -> bool {
    let groups =
        [Group::RadiusComp, Group::FeedMode, Group::Distance, Group::Plane, Group::Spindle, Group::Coolant];
    groups.contains(&op.group())
        || matches!(op, Op::Rapid | Op::Linear | Op::ArcCw | Op::ArcCcw | Op::Dwell | Op::CycleOff)
        || matches!(op, Op::Stop | Op::OptionalStop | Op::Act | Op::Builder)
}

/// Rewrites the words, of which X may be `vacant`, from where the tool stands, as far as that is known; what stands in the way, if anything does.
pub fn rewrite(nc: &mut Nc, by_c: bool, vacant: bool, at: [Option<f64>; 2]) -> Option<&'static str> {
    if nc.has(Op::Dwell) {
        return None;
    }
    if by_c && !to_places(nc, at) {
        return Some(STEPS);
    }
    for item in &mut nc.items {
        let NcItem::Word(role, value) = item else { continue };
        match *role {
            Role::C if by_c => *role = Role::Y,
            Role::Y if !by_c => *role = Role::C,
            Role::X => {
                let Some(other) = scaled(value, by_c, vacant) else { return Some(VACANT) };
                *value = other;
            }
            Role::Z | Role::StepZ => {}
            Role::StepX | Role::StepY | Role::StepC => return Some(STEPS),
            role if role.is_axis() || !may_count(role) => return Some(AXIS),
            _ => {}
        }
    }
    None
}

/// Makes places of increments; false where it is not known from where they count.
fn to_places(nc: &mut Nc, at: [Option<f64>; 2]) -> bool {
    let twins = [(Role::StepX, Role::X, at[0]), (Role::StepC, Role::C, at[1])];
    for (step, place, at) in twins {
        let both = nc.word(place).is_some();
        for item in &mut nc.items {
            let NcItem::Word(role, value) = item else { continue };
            if *role != step {
                continue;
            }
            let Some(to) = moved(at, value).filter(|_| !both) else { return false };
            *item = NcItem::Word(place, Expr::Number(to));
        }
    }
    true
}

/// False for words of corners, angles, tools and of the axis of a plane that is not there.
fn may_count(role: Role) -> bool {
    !matches!(
        role,
        Role::ArcK | Role::CornerRadius | Role::CornerChamfer | Role::LineAngle | Role::Turret | Role::Repeat
    )
}

/// X of a control that counts radii as a diameter.
pub fn doubled(value: &Expr) -> Expr {
    scaled(value, false, false).unwrap_or_else(|| value.clone())
}

/// Half of X for the control that counts radii, twice for the other one; none where a vacant one would become a number.
fn scaled(value: &Expr, by_c: bool, vacant: bool) -> Option<Expr> {
    let (op, factor) = if by_c { (BinOp::Div, 0.5) } else { (BinOp::Mul, 2.0) };
    Some(match value {
        Expr::Number(number) => Expr::Number(number * factor),
        Expr::Increments(count) => Expr::Increments(count * factor),
        Expr::Negate(inner) if matches!(**inner, Expr::Number(_) | Expr::Increments(_)) => {
            Expr::Negate(Box::new(scaled(inner, by_c, false)?))
        }
        _ if vacant => return None,
        value => Expr::binary(op, value.clone(), Expr::Number(2.0)),
    })
}
