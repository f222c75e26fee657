//! What the ways to a place named: the last numbers of tool offsets, whatever they did, and the groups of codes.

use super::touches::Touches;
use crate::canon::{Group, Op, Role};
use crate::ir::{Expr, Nc, NcItem};

/// The last number that a tool offset was named by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Last {
    /// Not known: some way here named none, or one that is not followed.
    #[default]
    Unknown,
    /// Every way here named one, not all the same, or one that is computed.
    Named,
    /// This one.
    Number(u32),
}

impl Last {
    fn join(self, other: Self) -> Self {
        match (self, other) {
            _ if self == other => self,
            (Last::Unknown, _) | (_, Last::Unknown) => Last::Unknown,
            _ => Last::Named,
        }
    }
}

/// What every way to a place named.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Named {
    length: Last,
    radius: Last,
    /// A bit for each group of which every way here has a code.
    groups: u32,
}

impl Named {
    /// The last number of a tool offset, by the role of its word.
    pub fn last(&self, role: Role) -> Last {
        match role {
            Role::LengthOffset => self.length,
            Role::RadiusOffset => self.radius,
            _ => Last::Unknown,
        }
    }

    /// True where every way here has a code of the group.
    pub fn has(&self, group: Group) -> bool {
        self.groups & bit(group) != 0
    }

    /// Takes a block's words and codes.
    pub(super) fn step(&mut self, nc: &Nc) {
        use Op::{Builder, CycleOther, MachineSpecific, ProbeOther};
        let own = |op: Op| matches!(op, Builder | CycleOther | MachineSpecific | ProbeOther);
        if nc.ops().any(own) || nc.items.iter().any(|item| matches!(item, NcItem::Code('G', _))) {
            // A computed code may be any of its letter, and what a machine's own code does is not known.
            *self = Self::default();
            return;
        }
        nc.ops().for_each(|op| self.groups |= bit(op.group()));
        // No maker's text says whether the end of an offset leaves its number readable.
        for (role, last, end) in [
            (Role::LengthOffset, &mut self.length, Op::LengthOff),
            (Role::RadiusOffset, &mut self.radius, Op::RadiusOff),
        ] {
            if names(nc, role) || nc.has(end) {
                *last = value(nc, role).map_or(Last::Unknown, |value| match value.constant() {
                    Some(number) => Last::Number(number as u32),
                    None => Last::Named,
                });
            }
        }
    }

    /// After a call: what its routine does not name is as it was named before the call.
    pub(super) fn keep(&mut self, before: Self, touches: &Touches) {
        if touches.named {
            return;
        }
        self.groups |= before.groups;
        if !touches.length {
            self.length = before.length;
        }
        if !touches.radius {
            self.radius = before.radius;
        }
    }

    /// Joins what other ways named; true where that changed anything.
    pub(super) fn join(&mut self, other: Self) -> bool {
        let joined = Self {
            length: self.length.join(other.length),
            radius: self.radius.join(other.radius),
            groups: self.groups & other.groups,
        };
        std::mem::replace(self, joined) != joined
    }
}

fn bit(group: Group) -> u32 {
    1u32.checked_shl(group as u32).unwrap_or(0)
}

fn names(nc: &Nc, role: Role) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Word(own, _) if *own == role))
}

/// The number of the one word of this role in a block: one that is surely there, and that is the same after the block.
pub fn value(nc: &Nc, role: Role) -> Option<&Expr> {
    let mut words = nc.items.iter().filter_map(|item| match item {
        NcItem::Word(own, value) if *own == role => Some(value),
        _ => None,
    });
    let value = words.next().filter(|_| words.next().is_none())?;
    if let Some(number) = value.constant() {
        return (number >= 0.0 && number.fract() == 0.0 && number < f64::from(u16::MAX)).then_some(value);
    }
    let mut reads = value.may_be_vacant();
    value.walk(&mut |part| {
        reads |= matches!(part, Expr::System(..) | Expr::Indirect(..) | Expr::Increments(_));
    });
    (!reads).then_some(value)
}
