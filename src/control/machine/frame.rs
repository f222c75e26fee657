//! From the coordinates of the program to those of the machine, and back.
//!
//! A programmed position is mirrored, scaled, turned, then shifted by the work offset, the
//! shifts over it and the tool length. Axes that none of the first three touch keep their
//! digits: nothing but the shift is added.

use crate::control::scenario::{AXES, Axes, Scenario};

/// The coordinate system in force.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// The selected work offset: 0 none, 1 to 6, 101 and up.
    pub number: u32,
    /// Its values.
    pub work: Axes,
    /// Shift of all work offsets.
    pub external: Axes,
    /// Shift by the local-shift code.
    pub local: Axes,
    /// Shift by the position-setting code.
    pub datum: Axes,
    /// Tool length along Z, with its sign.
    pub length: f64,
    /// The tool offset of a lathe.
    pub tool: Option<[f64; 3]>,
    /// Mirrored axes and about which coordinate.
    pub mirror: [Option<f64>; AXES],
    /// Scale factors and their centre.
    pub scale: Option<(Axes, Axes)>,
    /// Rotation.
    pub rotation: Option<Rotation>,
}

/// A rotation of two axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// The axes; a positive angle turns the first toward the second.
    pub axes: (usize, usize),
    /// Its centre, program coordinates.
    pub centre: (f64, f64),
    /// Its angle, degrees.
    pub degrees: f64,
}

impl Frame {
    pub(super) fn new(scenario: &Scenario) -> Self {
        Self { external: scenario.external_shift, ..Self::default() }
    }

    /// What is added to a coordinate at last.
    pub fn shift(&self, axis: usize) -> f64 {
        let shift = self.work[axis] + self.external[axis] + self.local[axis] + self.datum[axis];
        let shift = if axis == 2 { shift + self.length } else { shift };
        match self.tool.as_ref().and_then(|tool| tool.get(axis)) {
            Some(offset) => shift + offset,
            None => shift,
        }
    }

    /// The same of all axes.
    pub fn shifts(&self) -> Axes {
        std::array::from_fn(|axis| self.shift(axis))
    }

    /// True where more than a shift is in force.
    pub fn is_shaped(&self) -> bool {
        self.rotation.is_some() || self.scale.is_some() || self.mirror.iter().any(Option::is_some)
    }

    /// True where the frame turns the sense of arcs round.
    pub fn flips(&self, axes: (usize, usize)) -> bool {
        self.mirror[axes.0].is_some() != self.mirror[axes.1].is_some()
    }

    /// Machine coordinates of a programmed position.
    pub fn machine(&self, work: &Axes) -> Axes {
        let mut out = *work;
        for (value, mirror) in out.iter_mut().zip(self.mirror) {
            if let Some(centre) = mirror {
                *value = 2.0 * centre - *value;
            }
        }
        if let Some((factors, centre)) = &self.scale {
            for ((value, factor), centre) in out.iter_mut().zip(factors).zip(centre) {
                *value = centre + (*value - centre) * factor;
            }
        }
        if let Some(rotation) = &self.rotation {
            rotation.turn(&mut out, rotation.degrees);
        }
        for (axis, value) in out.iter_mut().enumerate() {
            *value += self.shift(axis);
        }
        out
    }

    /// Program coordinates of a machine position.
    pub fn program(&self, machine: &Axes) -> Axes {
        let mut out = *machine;
        for (axis, value) in out.iter_mut().enumerate() {
            *value -= self.shift(axis);
        }
        if let Some(rotation) = &self.rotation {
            rotation.turn(&mut out, -rotation.degrees);
        }
        if let Some((factors, centre)) = &self.scale {
            for ((value, factor), centre) in out.iter_mut().zip(factors).zip(centre) {
                if *factor != 0.0 {
                    *value = centre + (*value - centre) / factor;
                }
            }
        }
        for (value, mirror) in out.iter_mut().zip(self.mirror) {
            if let Some(centre) = mirror {
                *value = 2.0 * centre - *value;
            }
        }
        out
    }
}

impl Rotation {
    fn turn(&self, at: &mut Axes, degrees: f64) {
        let (sin, cos) = sin_cos(degrees);
        let (first, second) = self.axes;
        let (a, b) = (at[first] - self.centre.0, at[second] - self.centre.1);
        at[first] = self.centre.0 + a * cos - b * sin;
        at[second] = self.centre.1 + a * sin + b * cos;
    }
}

/// Sine and cosine of degrees, exact at the quarters.
pub(super) fn sin_cos(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    match turn {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => turn.to_radians().sin_cos(),
    }
}

/// What a move in machine coordinates does under incremental coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnderIncremental {
    /// It goes to its place, as under absolute ones.
    Place,
    /// It goes by its words from where it is.
    Increments,
    /// Nothing.
    Ignored,
}

impl UnderIncremental {
    /// By its name in the tables.
    pub fn read(value: &str) -> Option<Self> {
        match value {
            "place" => Some(Self::Place),
            "increments" => Some(Self::Increments),
            "ignored" => Some(Self::Ignored),
            _ => None,
        }
    }
}
