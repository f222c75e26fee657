//! Milling on the face and on the side of a part while C follows (V1 to V9 of docs/lathe.md).
//!
//! While it lasts, Y of the machine's position is a length: on the face that of the second axis of the plane, from the centre of the spindle; on
//! the side that round the part. C of the position stays as it was at the start, and is brought up to date at the end. Blocks come in
//! whatever words the control has for that length, and go on in words of Y, with X as a diameter.

use super::EXACT;
use crate::canon::{Group, Op, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::scenario::Axes;
use crate::control::trace::{Plane, Trace};
use std::f64::consts::TAU;

/// The places of the axes.
const X: usize = 0;
const Y: usize = 1;
const C: usize = 5;

/// How near to the centre of the spindle a way may pass before nobody knows what C does: millimetres.
const NEAR: f64 = 1e-6;

/// Into how many parts an arc is cut to count how far C turns along it.
const STEPS: u32 = 720;

/// What is milled.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// The face, in a plane of X and a length.
    Face,
    /// The side, which lies so far from the centre of the spindle: millimetres.
    Side(f64),
}

/// The face or the side that a program mills.
#[derive(Clone, Debug)]
pub struct Surface {
    kind: Kind,
    /// Where the Y axis stands.
    y: f64,
    /// The plane to go back to on the face; the one that the program names on the side.
    plane: Plane,
    /// On the face, the degrees that C turned.
    turned: f64,
    /// On the face: -1 where X was negative at the start.
    side: f64,
}

/// Takes a block where it begins, ends, or stands in such milling; gives the words that the machine goes by.
pub fn block(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<Option<Command>, Stop> {
    let changes = |op: &&Op| matches!(op, Op::PolarPlane | Op::PolarPlaneOff | Op::Cylinder);
    let Some(op) = command.ops.iter().find(changes).copied() else {
        let Some(surface) = machine.lathe.surface.clone() else { return Ok(None) };
        return inside(machine, &surface, command, trace).map(Some);
    };
    let ends =
        op == Op::PolarPlaneOff || op == Op::Cylinder && command.word(Role::CylinderRadius) == Some(0.0);
    if ends && machine.lathe.surface.is_none() {
        return Ok(None);
    }
    let other = command.words.iter().any(|(role, _)| *role != Role::CylinderRadius);
    if other || command.ops.len() > 1 {
        return Err(Stop::unnamed(format!("{op} is not alone in its block")));
    }
    if machine.side != crate::control::trace::Side::Off {
        return Err(Stop::unnamed(format!("{op} while the radius of the tool is compensated")));
    }
    if machine.cycle.is_some() {
        return Err(Stop::unnamed(format!("{op} in a drilling cycle")));
    }
    if ends {
        end(machine, op)?
    } else {
        begin(machine, op, command, trace)?
    }
    Ok(None)
}

fn begin(machine: &mut Machine, op: Op, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    if machine.lathe.surface.is_some() {
        return Err(Stop::unnamed(format!("{op} where such a milling is in force already")));
    }
    let (c, shift) = (machine.position[C] - machine.frame.shift(C), machine.frame.shift(Y));
    let (kind, along) = if op == Op::Cylinder {
        let radius = command.word(Role::CylinderRadius).map(|radius| radius * machine.unit());
        let Some(radius) = radius.filter(|radius| *radius > 0.0) else {
            return Err(Stop::unnamed("the radius of a cylinder is left out, or negative"));
        };
        (Kind::Side(radius), c.to_radians() * radius)
    } else {
        match machine.rules.face_by_c.ask(trace) {
            None => return Err(Stop::unnamed("no source says how a face is programmed on this control")),
            Some(false) if wrapped(c).abs() > EXACT => {
                return Err(Stop::unnamed("milling on a face begins while C does not stand at 0"));
            }
            Some(_) => {}
        }
        (Kind::Face, 0.0)
    };
    let x = machine.position[X] - machine.frame.shift(X);
    let side = if x < 0.0 { -1.0 } else { 1.0 };
    machine.lathe.surface =
        Some(Surface { kind, y: machine.position[Y], plane: machine.plane, turned: 0.0, side });
    machine.position[Y] = along + shift;
    // A control that names C takes the plane of X and C by itself.
    if kind == Kind::Face && machine.rules.face_by_c.peek() == Some(true) {
        machine.plane = Plane::Xy;
    } else if kind != Kind::Face {
        machine.plane = Plane::Yz;
    }
    Ok(())
}

/// Puts X and C where the tool is, and Y where its axis is.
fn end(machine: &mut Machine, op: Op) -> Result<(), Stop> {
    let Some(surface) = machine.lathe.surface.take() else { return Ok(()) };
    if (op == Op::PolarPlaneOff) != (surface.kind == Kind::Face) {
        machine.lathe.surface = Some(surface);
        return Err(Stop::unnamed(format!("{op} ends a milling that another code began")));
    }
    let along = machine.position[Y] - machine.frame.shift(Y);
    match surface.kind {
        Kind::Face => {
            let x = machine.position[X] - machine.frame.shift(X);
            let reach = (x / 2.0).hypot(along);
            if along.abs() > EXACT || x * surface.side < 0.0 {
                machine.position[X] = 2.0 * reach * surface.side + machine.frame.shift(X);
            }
            let mut turned = surface.turned;
            if reach > EXACT {
                // Whole turns by the way, the rest by the place.
                let angle = along.atan2(x / 2.0).to_degrees() - surface.half();
                turned = angle + 360.0 * ((turned - angle) / 360.0).round();
            }
            machine.position[C] += tidy(turned);
        }
        Kind::Side(radius) => {
            machine.position[C] = tidy((along / radius).to_degrees()) + machine.frame.shift(C);
        }
    }
    machine.position[Y] = surface.y;
    if surface.kind != Kind::Face || machine.rules.face_by_c.peek() == Some(true) {
        machine.plane = surface.plane;
    }
    Ok(())
}

/// Without the last digits, which only the way of computing it has.
fn tidy(degrees: f64) -> f64 {
    (degrees * 1e9).round() / 1e9
}

/// A block while it lasts, in words of Y.
fn inside(
    machine: &mut Machine,
    surface: &Surface,
    command: &Command,
    trace: &mut Trace,
) -> Result<Command, Stop> {
    let by_c = surface.kind != Kind::Face || machine.rules.face_by_c.peek() == Some(true);
    if let Some(op) = command.ops.iter().find(|op| !is_allowed(**op)) {
        let what = command.own_code.clone().unwrap_or_else(|| op.to_string());
        return Err(Stop::unnamed(format!("{what} in {}", surface.kind.name())));
    }
    let motion = command.of(Group::Motion).unwrap_or(machine.motion);
    let goes = |role: Role| role.is_axis() || role.is_step();
    if motion == Op::Rapid && command.words.iter().any(|(role, _)| goes(*role)) && !command.has(Op::Dwell) {
        if by_c {
            return Err(Stop::unnamed(format!("rapid traverse in {}", surface.kind.name())));
        }
        trace.doubt("machine:lathe.face.rapid");
    }
    let arc = matches!(motion, Op::ArcCw | Op::ArcCcw);
    if arc
        && surface.kind != Kind::Face
        && [Role::X, Role::StepX].iter().any(|role| command.word(*role).is_some())
    {
        return Err(Stop::unnamed("X in an arc in cylindrical interpolation"));
    }
    let mut out = command.clone();
    for (role, value) in &mut out.words {
        *value *= surface.kind.scale(machine, role, by_c)?;
    }
    for (role, off) in &mut out.rounded {
        *off *= surface.kind.scale(machine, role, by_c)?;
    }
    if let Some(op) = command.of(Group::Plane).filter(|_| by_c) {
        out.ops.retain(|op| op.group() != Group::Plane);
        if surface.kind == Kind::Face {
            trace.doubt("machine:lathe.face.plane");
        } else if let Some(surface) = &mut machine.lathe.surface {
            surface.plane = match op {
                Op::PlaneXy => Plane::Xy,
                Op::PlaneZx => Plane::Zx,
                _ => Plane::Yz,
            };
        }
    }
    Ok(out)
}

/// True for what may stand in such milling; of anything else no source was read (V4, V7).
fn is_allowed(op: Op) -> bool {
    let groups =
        [Group::RadiusComp, Group::FeedMode, Group::Distance, Group::Plane, Group::Spindle, Group::Coolant];
    groups.contains(&op.group())
        || matches!(op, Op::Rapid | Op::Linear | Op::ArcCw | Op::ArcCcw | Op::Dwell | Op::CycleOff)
        || matches!(op, Op::Stop | Op::OptionalStop | Op::Act | Op::Builder)
        || op.is_flow()
}

impl Surface {
    /// The angle of X in the plane of a face at the start, degrees.
    fn half(&self) -> f64 {
        if self.side < 0.0 { 180.0 } else { 0.0 }
    }
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Face => "polar interpolation",
            Self::Side(_) => "cylindrical interpolation",
        }
    }

    /// Makes the role of a word the one that the machine goes by; what its value is multiplied by.
    fn scale(self, machine: &Machine, role: &mut Role, by_c: bool) -> Result<f64, Stop> {
        let refused = |role: Role| Err(Stop::unnamed(format!("{role} in {}", self.name())));
        match (*role, self) {
            (Role::C | Role::StepC, Self::Face) if by_c => {
                *role = if *role == Role::C { Role::Y } else { Role::StepY };
                Ok(1.0)
            }
            (Role::C | Role::StepC, Self::Side(radius)) => {
                *role = if *role == Role::C { Role::Y } else { Role::StepY };
                Ok(TAU / 360.0 * radius / machine.unit())
            }
            (Role::Y | Role::StepY, _) if by_c => refused(*role),
            (Role::X, Self::Face) if !by_c => Ok(2.0),
            (Role::C | Role::StepC | Role::StepX | Role::StepY, Self::Face) if !by_c => refused(*role),
            (Role::ArcI | Role::ArcJ | Role::ArcK, Self::Side(_)) | (Role::ArcK, Self::Face) => {
                refused(*role)
            }
            (Role::CornerRadius | Role::CornerChamfer | Role::LineAngle | Role::Turret, _) => refused(*role),
            _ => Ok(1.0),
        }
    }
}

impl Machine {
    /// True where the words of C are lengths: on a face (V1).
    pub fn takes_length(&self, role: Role) -> bool {
        let face = self.lathe.surface.as_ref().is_some_and(|surface| surface.kind == Kind::Face);
        face && matches!(role, Role::C | Role::StepC)
    }

    /// True where Y is made of degrees of C, which are not rounded as a length is.
    pub(in crate::control::machine) fn unrolls(&self) -> bool {
        self.lathe.surface.as_ref().is_some_and(|surface| surface.kind != Kind::Face)
    }
}

/// Whether arcs may be made in the plane in force; none if no such milling is in force.
pub fn arcs(machine: &Machine) -> Option<bool> {
    let surface = machine.lathe.surface.as_ref()?;
    Some(match surface.kind {
        Kind::Face => machine.plane == Plane::Xy,
        Kind::Side(_) => surface.plane != Plane::Xy,
    })
}

/// True where arcs turn the other way round in the plane of the trace: the program's plane goes from Z to C, that one from Y to Z.
pub fn flips(machine: &Machine) -> bool {
    let surface = machine.lathe.surface.as_ref();
    surface.is_some_and(|surface| surface.kind != Kind::Face && surface.plane == Plane::Zx)
}

/// Turns C along a straight way on a face.
pub fn line(machine: &mut Machine, from: &Axes, to: &Axes, trace: &mut Trace) {
    let Some(surface) = machine.lathe.surface.as_ref().filter(|surface| surface.kind == Kind::Face) else {
        return;
    };
    let place = |at: &Axes| ((at[X] - machine.frame.shift(X)) / 2.0, at[Y] - machine.frame.shift(Y));
    let (from, to) = (place(from), place(to));
    let angle = |at: (f64, f64)| at.1.atan2(at.0).to_degrees();
    let at_centre = |at: (f64, f64)| at.0.hypot(at.1) <= EXACT;
    let before = if at_centre(from) { surface.turned + surface.half() } else { angle(from) };
    let by = if at_centre(to) { 0.0 } else { wrapped(angle(to) - before) };
    // Through the centre C turns half round, or X goes on to the other side.
    if at_centre(to) && from != to || by.abs() > 180.0 - 1e-7 {
        trace.doubt("machine:lathe.face.centre");
    }
    if let Some(surface) = &mut machine.lathe.surface {
        surface.turned += by;
    }
}

/// The same along an arc about a middle, machine coordinates; its sweep in degrees.
pub fn arc(machine: &mut Machine, start: &Axes, middle: &Axes, sweep: f64, trace: &mut Trace) {
    let Some(surface) = machine.lathe.surface.as_ref().filter(|surface| surface.kind == Kind::Face) else {
        return;
    };
    let shift = (machine.frame.shift(X), machine.frame.shift(Y));
    let centre = ((middle[X] - shift.0) / 2.0, middle[Y] - shift.1);
    let (up, along) = ((start[X] - middle[X]) / 2.0, start[Y] - middle[Y]);
    let (radius, begins) = (up.hypot(along), along.atan2(up));
    if (centre.0.hypot(centre.1) - radius).abs() <= NEAR {
        trace.doubt("machine:lathe.face.centre");
    }
    let place = |step: u32| {
        let angle = begins + sweep.to_radians() * f64::from(step) / f64::from(STEPS);
        let at = (centre.0 + radius * angle.cos(), centre.1 + radius * angle.sin());
        at.1.atan2(at.0).to_degrees()
    };
    let by: f64 = (0..STEPS).map(|step| wrapped(place(step + 1) - place(step))).sum();
    let turned = surface.turned + by;
    if let Some(surface) = &mut machine.lathe.surface {
        surface.turned = turned;
    }
}

/// An angle between -180 and 180 degrees.
fn wrapped(degrees: f64) -> f64 {
    degrees - 360.0 * (degrees / 360.0).round()
}
