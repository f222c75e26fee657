//! From lengths to pixels.

use super::Point;
use std::fmt::Write;

/// The extent of a drawing, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    low: (f64, f64),
    high: (f64, f64),
}

impl Bounds {
    /// Round all points; the zero point alone where there is none.
    pub fn of(points: impl Iterator<Item = (f64, f64)>) -> Self {
        let finite = points.filter(|(x, y)| x.is_finite() && y.is_finite());
        let all = finite.fold(None, |bounds: Option<Bounds>, (x, y)| {
            let old = bounds.unwrap_or(Bounds { low: (x, y), high: (x, y) });
            Some(Bounds {
                low: (old.low.0.min(x), old.low.1.min(y)),
                high: (old.high.0.max(x), old.high.1.max(y)),
            })
        });
        all.unwrap_or(Bounds { low: (0.0, 0.0), high: (0.0, 0.0) })
    }
}

/// A drawing's place on the sheet.
#[derive(Clone, Copy, Debug)]
pub struct View {
    bounds: Bounds,
    corner: (f64, f64),
    size: f64,
    scale: f64,
    shift: (f64, f64),
    unit: &'static str,
    /// What stands at a tick of the upward axis for a length of 1: 2 where radii are drawn and diameters told.
    upward: f64,
}

impl View {
    /// Fits an extent into a square at a corner of the sheet.
    pub fn new(bounds: Bounds, corner: (f64, f64), size: f64) -> Self {
        let (wide, high) = (bounds.high.0 - bounds.low.0, bounds.high.1 - bounds.low.1);
        let span = wide.max(high);
        let span = if span > 0.0 { span } else { 1.0 };
        let scale = size * 0.86 / span;
        let shift = (corner.0 + (size - wide * scale) / 2.0, corner.1 + (size + high * scale) / 2.0);
        Self { bounds, corner, size, scale, shift, unit: "mm", upward: 1.0 }
    }

    /// The same with another unit of length than millimetres.
    pub fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// The same with diameters at the upward axis, where radii are drawn.
    pub fn with_diameters(self, diameters: bool) -> Self {
        Self { upward: if diameters { 2.0 } else { 1.0 }, ..self }
    }

    /// True where diameters stand at the upward axis.
    pub fn tells_diameters(&self) -> bool {
        self.upward > 1.0
    }

    /// The larger side of the extent, millimetres.
    pub fn span(&self) -> f64 {
        self.size * 0.86 / self.scale
    }

    /// Pixels of a point.
    pub fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (
            self.shift.0 + (x - self.bounds.low.0) * self.scale,
            self.shift.1 - (y - self.bounds.low.1) * self.scale,
        )
    }

    /// A length of 1, 2 or 5 times a power of ten that is about a fifth of the drawing.
    fn step(&self) -> f64 {
        let about = self.span() / 5.0;
        let ten = 10f64.powf(about.log10().floor());
        [5.0, 2.0, 1.0].into_iter().map(|unit| unit * ten).find(|step| *step <= about).unwrap_or(ten)
    }

    /// Ticks with their coordinates along both sides, lines through zero, and the names of the axes.
    pub fn axes(&self, (across, up): (char, char), out: &mut String) {
        let step = self.step();
        let (left, bottom) = (self.corner.0, self.corner.1 + self.size);
        let (right, top) = (left + self.size, self.corner.1);
        let _ = writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\">{across}</text><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{up}</text>",
            right + 4.0,
            bottom + 4.0,
            left - 4.0,
            top + 4.0
        );
        let ticks = |low: f64| {
            let first = (low / step).ceil() as i64;
            let last = ((low + self.size / self.scale) / step).floor() as i64;
            (first..=last.min(first.saturating_add(40))).map(move |at| at as f64 * step)
        };
        // What lies at the drawing's left and lower edges.
        let low = (
            self.bounds.low.0 - (self.shift.0 - left) / self.scale,
            self.bounds.low.1 - (bottom - self.shift.1) / self.scale,
        );
        for at in ticks(low.0) {
            let x = self.place((at, 0.0)).0;
            if x < left || x > left + self.size {
                continue;
            }
            let colour = if at == 0.0 { "#999" } else { "#eee" };
            let _ = writeln!(
                out,
                "<line x1=\"{x:.1}\" y1=\"{top:.1}\" x2=\"{x:.1}\" y2=\"{bottom:.1}\" stroke=\"{colour}\"/>"
            );
            let _ = writeln!(
                out,
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" font-size=\"10\">{}</text>",
                bottom + 12.0,
                digits(at)
            );
        }
        for at in ticks(low.1) {
            let y = self.place((0.0, at)).1;
            if y < self.corner.1 || y > bottom {
                continue;
            }
            let colour = if at == 0.0 { "#999" } else { "#eee" };
            let _ = writeln!(
                out,
                "<line x1=\"{left:.1}\" y1=\"{y:.1}\" x2=\"{right:.1}\" y2=\"{y:.1}\" stroke=\"{colour}\"/>"
            );
            let _ = writeln!(
                out,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" font-size=\"10\">{}</text>",
                left - 4.0,
                y + 4.0,
                digits(at * self.upward)
            );
        }
    }

    /// The three axes askew, small, where the drawing is free.
    pub fn cross(
        &self,
        points: impl Iterator<Item = Point>,
        project: fn(Point) -> (f64, f64),
        out: &mut String,
    ) {
        let foot = self.free_corner(points.map(project));
        let arm = self.span() * 0.1;
        for (label, end) in [("X", [arm, 0.0, 0.0]), ("Y", [0.0, arm, 0.0]), ("Z", [0.0, 0.0, arm])] {
            self.arrow(foot, project([0.0; 3]), project(end), label, out);
        }
    }

    /// Where the small axes stand: in the corner of the drawing that the fewest points come near.
    fn free_corner(&self, points: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
        let (low, high) = (self.corner.1 + 100.0, self.corner.1 + self.size - 30.0);
        let (left, right) = (self.corner.0 + 75.0, self.corner.0 + self.size - 75.0);
        let corners = [(left, high), (right, high), (left, low)];
        let mut near = [0_usize; 3];
        for point in points {
            let (x, y) = self.place(point);
            for (count, corner) in near.iter_mut().zip(corners) {
                *count += usize::from((x - corner.0).abs() < 75.0 && (y - corner.1).abs() < 100.0);
            }
        }
        let best = corners.into_iter().zip(near).min_by_key(|(_, count)| *count);
        best.map_or((left, high), |(corner, _)| corner)
    }

    /// A labelled line, for an axis.
    fn arrow(&self, corner: (f64, f64), from: (f64, f64), to: (f64, f64), label: &str, out: &mut String) {
        let (dx, dy) = ((to.0 - from.0) * self.scale, (to.1 - from.1) * self.scale);
        let (x, y) = (corner.0 + dx, corner.1 - dy);
        let _ = writeln!(
            out,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{x:.1}\" y2=\"{y:.1}\" stroke=\"#999\"/><text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"10\" fill=\"#555\">{label}</text>",
            corner.0, corner.1
        );
    }

    /// A bar with its length.
    pub fn scale(&self, out: &mut String) {
        let step = self.step();
        let (x, y) = (self.corner.0 + self.size - 12.0, self.corner.1 + 16.0);
        let from = x - step * self.scale;
        let _ = writeln!(
            out,
            "<path d=\"M{from:.1} {:.1}v4h{:.1}v-4\" fill=\"none\" stroke=\"#333\"/><text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"end\" font-size=\"10\">{} {}</text>",
            y - 4.0,
            x - from,
            y + 14.0,
            digits(step),
            self.unit
        );
    }
}

/// A round number without the noise of binary fractions.
fn digits(value: f64) -> f64 {
    format!("{value:.9}").parse().unwrap_or(value) + 0.0
}
