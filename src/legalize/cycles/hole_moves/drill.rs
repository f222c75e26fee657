//! What a drilling cycle was told, at a place of a program.

use crate::canon::{Group, Op, Role};
use crate::ir::analysis::Modal;
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::{Class, Expr, Nc, NcItem, Var};

/// What a cycle is told, by the number that its register has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Told {
    Retract,
    Bottom,
    Peck,
    Clear,
    Dwell,
    Initial,
}

impl Told {
    pub const ALL: [Self; 6] =
        [Self::Retract, Self::Bottom, Self::Peck, Self::Clear, Self::Dwell, Self::Initial];

    /// The register that holds it while a program does not know it.
    pub const fn register(self, first: u32) -> Var {
        Var { class: Class::Static, number: first + self as u32 }
    }

    /// The word that says it; the initial plane has none.
    pub const fn role(self) -> Option<Role> {
        match self {
            Self::Retract => Some(Role::CycleR),
            Self::Bottom => Some(Role::Z),
            Self::Peck => Some(Role::CycleQ),
            Self::Clear => Some(Role::PeckClear),
            Self::Dwell => Some(Role::CycleDwell),
            Self::Initial => None,
        }
    }
}

/// A value that a cycle was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    /// None was told.
    None,
    /// A number.
    Is(f64),
    /// What its register holds.
    Held,
    /// Told on some ways only.
    Lost,
}

impl Value {
    fn join(self, other: Self) -> Self {
        match (self, other) {
            _ if self == other => self,
            (Self::Is(_) | Self::Held, Self::Is(_) | Self::Held) => Self::Held,
            _ => Self::Lost,
        }
    }
}

/// Where the tool stands along Z under a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Height {
    Initial,
    Retract,
    Unknown,
}

/// A cycle in force.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drill {
    /// None where ways disagree.
    pub op: Option<Op>,
    pub told: [Value; 6],
    /// Whether the retract plane and the bottom were told in incremental words; none if the ways to it disagree.
    pub incremental: [Option<bool>; 2],
    pub height: Height,
    /// The first peck, by how much each later one is less, and the least one, where they are told.
    pub uneven: [Option<f64>; 3],
    /// A word that no moves are known for.
    pub strange: bool,
}

/// The words of [`Drill::uneven`].
const UNEVEN: [Role; 3] = [Role::PeckFirst, Role::PeckLess, Role::PeckLeast];

impl Drill {
    fn new(op: Op, initial: Value) -> Self {
        let mut told = [Value::None; 6];
        told[Told::Initial as usize] = initial;
        let incremental = [Some(true), Some(false)];
        Self { op: Some(op), told, incremental, height: Height::Initial, uneven: [None; 3], strange: false }
    }

    pub fn told(&self, what: Told) -> Value {
        self.told[what as usize]
    }

    fn joined(mut self, other: &Self) -> Self {
        if self.op != other.op {
            self.op = None;
        }
        for (mine, theirs) in self.told.iter_mut().zip(other.told) {
            *mine = mine.join(theirs);
        }
        for (mine, theirs) in self.incremental.iter_mut().zip(other.incremental) {
            if *mine != theirs {
                *mine = None;
            }
        }
        if self.height != other.height {
            self.height = Height::Unknown;
        }
        self.strange |= other.strange || self.uneven != other.uneven;
        self
    }

    /// As [`Self::joined`]; an initial plane that is not the same on both is in no register.
    fn same_start(self, other: &Self) -> Self {
        let (mine, theirs) = (self.told(Told::Initial), other.told(Told::Initial));
        let mut joined = self.joined(other);
        joined.told[Told::Initial as usize] = if mine == theirs { mine } else { Value::Lost };
        joined
    }

    /// Takes the words of a block. A word that may be vacant is told or not, which its register knows.
    fn tell(&mut self, nc: &Nc, incremental: Option<bool>, vacant: bool) {
        for what in Told::ALL {
            let Some(word) = what.role().and_then(|role| nc.word(role)) else { continue };
            let before = self.told(what);
            self.told[what as usize] = match word.constant() {
                Some(number) => Value::Is(number),
                None if vacant && before == Value::Lost => Value::Lost,
                None => Value::Held,
            };
            if let Some(kind) = self.incremental.get_mut(what as usize) {
                *kind = incremental;
            }
        }
        for (told, role) in self.uneven.iter_mut().zip(UNEVEN) {
            if let Some(word) = nc.word(role) {
                *told = word.constant();
                self.strange |= told.is_none();
            }
        }
        self.strange |= [Role::CycleI, Role::CycleJ].iter().any(|role| nc.word(*role).is_some());
    }
}

/// Which cycle is in force.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cycle {
    Off,
    /// What stood before the library ran: the control's own, if any.
    Outside,
    On(Drill),
    /// One of the library on some ways, none on others: what names a cycle here begins one or goes on with it.
    Maybe(Drill),
    /// One of the library on some ways, none or the control's own on others.
    Mixed,
}

impl Cycle {
    /// This one and another; the tool stands at `z` on the ways of each.
    fn join(&mut self, other: &Self, z: (Option<f64>, Option<f64>)) {
        let mine = std::mem::replace(self, Self::Mixed);
        *self = match (mine, other) {
            (Self::On(mine), Self::On(theirs)) => Self::On(mine.joined(theirs)),
            (Self::Off, Self::Off) => Self::Off,
            (Self::Off | Self::Outside, Self::Off | Self::Outside) => Self::Outside,
            (mine, theirs) => match (mine.begun(z.0), theirs.clone().begun(z.1)) {
                (Some(mine), Some(theirs)) => Self::Maybe(mine.same_start(&theirs)),
                _ => Self::Mixed,
            },
        };
    }

    /// The cycle that the next block which names one goes on with, or begins where the tool stands, at `z`.
    fn begun(self, z: Option<f64>) -> Option<Drill> {
        match self {
            Self::On(drill) | Self::Maybe(drill) => Some(drill),
            Self::Off => Some(Drill { op: None, ..Drill::new(Op::CycleDrill, start(z)) }),
            Self::Outside | Self::Mixed => None,
        }
    }
}

/// The initial plane of a cycle that begins here.
fn start(z: Option<f64>) -> Value {
    z.map_or(Value::Lost, Value::Is)
}

/// What is known where something leads.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Known {
    /// The program's coordinate along Z, where it is a number.
    pub z: Option<f64>,
    pub cycle: Cycle,
}

impl Known {
    pub const OUTSIDE: Self = Self { z: None, cycle: Cycle::Outside };

    /// The initial plane of a cycle that is named here, where that is a number and no register has it yet.
    pub fn begins_at(&self) -> Option<f64> {
        match &self.cycle {
            Cycle::On(_) => None,
            Cycle::Maybe(drill) => match drill.told(Told::Initial) {
                Value::Is(plane) => Some(plane),
                _ => None,
            },
            Cycle::Off | Cycle::Outside | Cycle::Mixed => self.z,
        }
    }

    /// After something that may do anything.
    pub fn lose(&mut self) {
        self.z = None;
        if matches!(self.cycle, Cycle::On(_) | Cycle::Maybe(_)) {
            self.cycle = Cycle::Mixed;
        }
    }

    /// Takes a block. `modal` is what is in force after it, and a word of it may be `vacant`.
    pub fn step(&mut self, nc: &Nc, modal: &Modal, rules: Runs, vacant: bool) {
        let incremental = modal.op(Group::Distance).map(|op| op == Op::Incremental);
        if let Some(op) = nc.ops().filter(|op| op.is_cycle()).last() {
            let initial = start(self.z);
            self.cycle = match std::mem::replace(&mut self.cycle, Cycle::Mixed) {
                Cycle::On(drill) | Cycle::Maybe(drill) => Cycle::On(Drill { op: Some(op), ..drill }),
                Cycle::Mixed => Cycle::Mixed,
                Cycle::Off | Cycle::Outside => Cycle::On(Drill::new(op, initial)),
            };
        } else if modal.op(Group::Cycle) == Some(Op::CycleOff) && self.cycle != Cycle::Outside
            || nc.has(Op::CycleOff)
        {
            self.cycle = Cycle::Off;
        } else if matches!(self.cycle, Cycle::Maybe(_)) && !is_nothing_to_cycles(nc) {
            self.cycle = Cycle::Mixed;
        }
        let Cycle::On(drill) = &mut self.cycle else {
            let mixed = self.cycle == Cycle::Mixed;
            return self.stand(nc, incremental, mixed);
        };
        drill.tell(nc, incremental, vacant);
        if nc.ops().any(|op| !keeps_height(op)) || nc.word(Role::LengthOffset).is_some() {
            self.z = None;
            drill.height = Height::Unknown;
        }
        if rules.drills(nc) {
            let stood = (drill.height, self.z);
            let [_, back] = drill.ends(rules.back(modal));
            (drill.height, self.z) = back;
            if vacant && unplaced(nc).is_some() && back != stood {
                (drill.height, self.z) = (Height::Unknown, None);
            }
        }
    }

    /// Where the tool stands after a block that drills nothing.
    fn stand(&mut self, nc: &Nc, incremental: Option<bool>, mixed: bool) {
        let shifts = nc.ops().any(|op| !keeps_height(op))
            || nc.word(Role::LengthOffset).is_some()
            || nc.word(Role::WorkOffset).is_some();
        if shifts || mixed {
            self.z = None;
        }
        let lasting =
            |op: Op| keeps_height(op) || op.group() == Group::LengthComp || op.group() == Group::WorkOffset;
        if let Some(word) = nc.word(Role::Z) {
            let known = nc.ops().all(lasting) && !nc.ops().any(Op::takes_axes) && !mixed;
            self.z = word.constant().filter(|_| known).and_then(|to| match incremental? {
                true => Some(self.z? + to),
                false => Some(to),
            });
        }
    }
}

impl Drill {
    /// Where the tool stands before the retraction to the initial plane, and after a hole.
    fn ends(&self, back: Option<Op>) -> [(Height, Option<f64>); 2] {
        let number = |value: Value| if let Value::Is(number) = value { Some(number) } else { None };
        let initial = number(self.told(Told::Initial));
        let retract = match (self.told(Told::Retract), self.incremental[0]) {
            (Value::None, _) => initial,
            (Value::Is(by), Some(true)) => initial.map(|from| from + by),
            (Value::Is(at), Some(false)) => Some(at),
            _ => None,
        };
        let after = match back {
            Some(Op::ReturnR) => (Height::Retract, retract),
            Some(Op::ReturnInitial) => (Height::Initial, initial),
            _ => (Height::Unknown, None),
        };
        [(Height::Retract, retract), after]
    }
}

/// Which blocks drill on the source.
#[derive(Clone, Copy, Debug)]
pub(super) struct Runs {
    /// True if a block that begins a cycle drills at the position in it.
    pub with_place: bool,
    /// True if one drills where the tool stands, if it has none.
    pub without: bool,
    /// The same of one without any word of an axis or a plane.
    pub wordless: bool,
    /// True if a block with a new depth or retract plane alone drills where the tool stands.
    pub by_depth: bool,
    /// The return plane where no program names one.
    pub returns: Option<Op>,
}

impl Runs {
    /// The return plane in force.
    pub fn back(self, modal: &Modal) -> Option<Op> {
        modal.op(Group::ReturnPlane).or(self.returns)
    }

    /// True for a block that drills under a cycle in force.
    pub fn drills(self, nc: &Nc) -> bool {
        if nc.word(Role::Repeat).and_then(Expr::constant) == Some(0.0) {
            return false;
        }
        let place = nc.word(Role::X).is_some() || nc.word(Role::Y).is_some() || nc.has(Op::CycleHere);
        let depths = || nc.word(Role::Z).is_some() || nc.word(Role::CycleR).is_some();
        match (nc.ops().any(Op::is_cycle), place) {
            (true, true) => self.with_place,
            (false, true) => true,
            (true, false) if depths() || nc.names_axis() => self.without,
            (true, false) => self.wordless,
            (false, false) => depths() && self.by_depth,
        }
    }
}

/// The words of a hole's place, where all of them may be vacant: without them there is no hole.
pub(super) fn unplaced(nc: &Nc) -> Option<Vec<&Expr>> {
    let place: Vec<&Expr> = [Role::X, Role::Y].into_iter().filter_map(|role| nc.word(role)).collect();
    let open = !place.is_empty() && place.iter().all(|word| word.may_be_vacant());
    (open && !nc.has(Op::CycleHere) && !nc.ops().any(Op::is_cycle)).then_some(place)
}

/// True for what a cycle takes out of its block.
pub(super) fn tells(item: &NcItem) -> bool {
    match item {
        NcItem::Op(op) => op.is_cycle() || *op == Op::CycleHere,
        NcItem::Word(role, _) => {
            *role == Role::Repeat
                || UNEVEN.contains(role)
                || Told::ALL.iter().any(|what| what.role() == Some(*role))
        }
        NcItem::Code(..) => false,
    }
}

/// True for a block that neither moves nor tells a cycle anything.
fn is_nothing_to_cycles(nc: &Nc) -> bool {
    let tells = |what: Told| what.role().is_some_and(|role| nc.word(role).is_some());
    !nc.names_axis() && !Told::ALL.into_iter().any(tells) && nc.ops().all(keeps_height)
}

/// True for what leaves the tool's coordinate along Z alone.
pub(in crate::legalize::cycles) fn keeps_height(op: Op) -> bool {
    use Group::*;
    if matches!(op, Op::Probe | Op::ProbeOther | Op::Thread) {
        return false;
    }
    matches!(
        op.group(),
        Motion | Cycle | Distance | FeedMode | ReturnPlane | RadiusComp | Spindle | Coolant | PathMode
    ) || matches!(
        op,
        Op::PlaneXy
            | Op::CycleHere
            | Op::Stop
            | Op::OptionalStop
            | Op::Dwell
            | Op::OutputOn
            | Op::OutputOff
            | Op::Act
    )
}

impl Lattice for Known {
    fn join(&mut self, other: &Self) -> bool {
        let before = self.clone();
        let z = (self.z, other.z);
        if self.z != other.z {
            self.z = None;
        }
        self.cycle.join(&other.cycle, z);
        *self != before
    }
}
