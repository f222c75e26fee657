//! The functions, on numbers.
//!
//! Angles are degrees. Where the true result is a rational number it comes out exactly
//! (the sine of 30 is 0.5), so that a program that compares it behaves alike everywhere.

use super::env::{Alarm, AtanRange, Env};
use crate::canon::Func;

pub(super) fn call(func: Func, arguments: &[f64], env: &dyn Env) -> Result<f64, Alarm> {
    let outside = Err(Alarm::Domain(func));
    if !func.arity().contains(&arguments.len()) {
        return Err(Alarm::Arity(func));
    }
    let a = arguments.first().copied().unwrap_or(0.0);
    let b = arguments.get(1).copied();
    Ok(match (func, b) {
        (Func::Sin, _) => sin(a),
        (Func::Cos, _) => cos(a),
        (Func::Tan, _) => match tan(a) {
            Some(tangent) => tangent,
            None => return outside,
        },
        (Func::Asin | Func::Acos, _) if a.abs() > 1.0 => return outside,
        (Func::Asin, _) => asin(a),
        (Func::Acos, _) => 90.0 - asin(a),
        (Func::Atan, None) => atan(a),
        (Func::Atan, Some(b)) if a == 0.0 && b == 0.0 => return outside,
        (Func::Atan, Some(b)) => atan2(a, b, env.atan_range()),
        (Func::Sqrt, _) if a < 0.0 => return outside,
        (Func::Sqrt, _) => a.sqrt(),
        (Func::Abs, _) => a.abs(),
        (Func::Round, _) => a.round(),
        (Func::RoundIncrement, _) => {
            let step = env.increment()?;
            (a / step).round() * step
        }
        (Func::RoundPlaces, places) => {
            let scale = 10f64.powi(places.unwrap_or(0.0).round().clamp(-300.0, 300.0) as i32);
            (a * scale).round() / scale
        }
        (Func::Fix, _) => a.trunc(),
        (Func::Fup, _) => {
            if a < 0.0 {
                a.floor()
            } else {
                a.ceil()
            }
        }
        (Func::Sign, _) => {
            if a < 0.0 {
                -1.0
            } else {
                1.0
            }
        }
        (Func::Ln, _) if a <= 0.0 => return outside,
        (Func::Ln, _) => a.ln(),
        (Func::Exp, _) => a.exp(),
        (Func::Pow, Some(b)) if (a == 0.0 && b < 0.0) || (a < 0.0 && b.fract() != 0.0) => return outside,
        (Func::Pow, b) => a.powf(b.unwrap_or(0.0)),
        (Func::Bin, _) => convert(a, 16, 10).ok_or(Alarm::Domain(func))?,
        (Func::Bcd, _) => convert(a, 10, 16).ok_or(Alarm::Domain(func))?,
        (Func::AddPoint, _) => a * env.increment()?,
        (Func::Parameter, _) => env.parameter(arguments)?,
    })
}

/// The degrees 0..360 of the same direction; exact, as the remainder of floats is.
fn turn(degrees: f64) -> f64 {
    let rest = degrees % 360.0;
    if rest < 0.0 { rest + 360.0 } else { rest }
}

/// True where `angle` is one of `values`.
fn is(angle: f64, values: &[f64]) -> bool {
    values.contains(&angle)
}

fn sin(degrees: f64) -> f64 {
    match turn(degrees) {
        t if is(t, &[0.0, 180.0]) => 0.0,
        t if is(t, &[30.0, 150.0]) => 0.5,
        t if is(t, &[210.0, 330.0]) => -0.5,
        90.0 => 1.0,
        270.0 => -1.0,
        _ => (degrees % 360.0).to_radians().sin(),
    }
}

fn cos(degrees: f64) -> f64 {
    match turn(degrees) {
        t if is(t, &[90.0, 270.0]) => 0.0,
        t if is(t, &[60.0, 300.0]) => 0.5,
        t if is(t, &[120.0, 240.0]) => -0.5,
        0.0 => 1.0,
        180.0 => -1.0,
        _ => (degrees % 360.0).to_radians().cos(),
    }
}

fn tan(degrees: f64) -> Option<f64> {
    match turn(degrees) {
        t if is(t, &[90.0, 270.0]) => None,
        t if is(t, &[0.0, 180.0]) => Some(0.0),
        t if is(t, &[45.0, 225.0]) => Some(1.0),
        t if is(t, &[135.0, 315.0]) => Some(-1.0),
        _ => Some((degrees % 360.0).to_radians().tan()),
    }
}

fn asin(sine: f64) -> f64 {
    match sine.abs() {
        0.5 => 30f64.copysign(sine),
        1.0 => 90f64.copysign(sine),
        _ => sine.asin().to_degrees(),
    }
}

fn atan(tangent: f64) -> f64 {
    if tangent.abs() == 1.0 { 45f64.copysign(tangent) } else { tangent.atan().to_degrees() }
}

/// The angle of the point (`x`, `y`), not both 0. The sign of a zero does not count.
fn atan2(y: f64, x: f64, range: AtanRange) -> f64 {
    let (y, x) = (y + 0.0, x + 0.0);
    let angle = if y.abs() == x.abs() {
        (if x < 0.0 { 135f64 } else { 45.0 }).copysign(y)
    } else {
        y.atan2(x).to_degrees()
    };
    match range {
        AtanRange::Full if angle < 0.0 => {
            // A direction a hair below the axis is 0 when 360 less the hair rounds to 360.
            let full = angle + 360.0;
            if full == 360.0 { 0.0 } else { full }
        }
        _ => angle,
    }
}

/// Reads the eight digits of `value` in one radix and weighs them in another.
fn convert(value: f64, from: u32, to: u32) -> Option<f64> {
    let limit = f64::from(from).powi(8);
    let rounded = value.round();
    if !(0.0..limit).contains(&rounded) {
        return None;
    }
    let (mut rest, mut weight, mut out) = (rounded as u64, 1u64, 0u64);
    while rest > 0 {
        let digit = rest % u64::from(from);
        if digit > 9 {
            return None;
        }
        out += digit * weight;
        rest /= u64::from(from);
        weight *= u64::from(to);
    }
    Some(out as f64)
}
