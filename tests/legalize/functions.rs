//! Functions by arithmetic: each over the domain and over what its documentation says of bounds and ends.

use crate::harness::{DOMAIN, control, control_with, expressions, legalized, program, result};
use macroglot::diag::{Code, Diagnostic};
use macroglot::dialect::Control;
use macroglot::ir::{BinOp, Expr, Module};

/// Angles, sines and plain numbers beside the domain.
const MORE: [f64; 28] = [
    -99_999_999.0,
    -720.0,
    -400.25,
    -359.9,
    -270.0,
    -200.0,
    -180.0,
    -135.0,
    -90.0,
    -45.0,
    -30.0,
    -2.5,
    -1.5,
    -1e-9,
    1e-3,
    2.0,
    3.25,
    30.0,
    45.0,
    60.0,
    89.999,
    90.0,
    135.0,
    179.999,
    180.0,
    270.0,
    1234.5,
    123_456.789,
];

fn operands() -> Vec<Option<f64>> {
    DOMAIN.into_iter().chain(MORE.map(Some)).collect()
}

/// An expression legalized for a target, which can say all of it then.
fn emulated(expr: &str, source: &Control, target: &Control) -> (Module, Vec<Diagnostic>) {
    let (module, found) = legalized("functions", &program(&format!(" global.9 = {expr}")), source, target);
    for e in expressions(&module) {
        match e {
            Expr::Call(function, arguments) => {
                assert!(
                    target.function(*function, arguments.len()).is_some(),
                    "{expr}: {function} is left\n{module}"
                );
            }
            Expr::Binary(BinOp::Mod, ..) => panic!("{expr}: a remainder is left\n{module}"),
            _ => {}
        }
    }
    (module, found)
}

fn codes(found: &[Diagnostic]) -> Vec<Code> {
    found.iter().map(|finding| finding.code).collect()
}

/// How far off a value may be.
#[derive(Clone, Copy)]
enum Bound {
    /// Not at all; zeros of both signs are one.
    Exact,
    /// So many units of the last digit.
    Ulps(f64),
    /// A part of the value.
    Part(f64),
    /// So much.
    Off(f64),
}

impl Bound {
    fn holds(self, got: f64, wanted: f64) -> bool {
        let off = (got - wanted).abs();
        match self {
            Bound::Exact => got == wanted,
            Bound::Ulps(n) => off <= n * f64::EPSILON * wanted.abs(),
            Bound::Part(part) => off <= part * wanted.abs(),
            Bound::Off(most) => off <= most,
        }
    }
}

/// Compares a function of one operand with what it must be; `wanted` is none where the machine must stop.
fn one(module: &Module, operands: &[Option<f64>], bound: Bound, wanted: impl Fn(f64) -> Option<f64>) {
    for a in operands {
        let (got, wanted) = (result(module, &[*a]), wanted(a.unwrap_or(0.0)));
        let good = got.zip(wanted).map_or(got == wanted, |(got, wanted)| bound.holds(got, wanted));
        assert!(good, "{a:?}: {got:?}, not {wanted:?}\n{module}");
    }
}

/// The same for two operands.
fn two(module: &Module, operands: &[Option<f64>], bound: Bound, wanted: impl Fn(f64, f64) -> Option<f64>) {
    for a in operands {
        for b in operands {
            let (got, wanted) = (result(module, &[*a, *b]), wanted(a.unwrap_or(0.0), b.unwrap_or(0.0)));
            let good = got.zip(wanted).map_or(got == wanted, |(got, wanted)| bound.holds(got, wanted));
            assert!(good, "{a:?} {b:?}: {got:?}, not {wanted:?}\n{module}");
        }
    }
}

/// The controls that lack a function.
fn lacking(wanted: &str) -> Vec<Control> {
    let function = macroglot::canon::Func::find(wanted).unwrap();
    let all = ["fadal", "fanuc", "haas", "cc100"].map(control);
    all.into_iter().filter(|c| c.function(function, *function.arity().end()).is_none()).collect()
}

#[test]
fn sign() {
    for target in lacking("sign") {
        let (module, found) = emulated("sign(local.1)", &control("fadal"), &target);
        assert_eq!(codes(&found), []);
        one(&module, &operands(), Bound::Exact, |a| Some(if a < 0.0 { -1.0 } else { 1.0 }));
    }
}

#[test]
fn fup() {
    for name in ["haas", "fadal", "cc100"] {
        let (module, found) = emulated("fup(local.1)", &control("fanuc"), &control(name));
        assert_eq!(codes(&found), []);
        one(&module, &operands(), Bound::Exact, |a| Some(if a < 0.0 { a.floor() } else { a.ceil() }));
    }
}

#[test]
fn round() {
    let mut operands = operands();
    // The greatest number below a half: adding a half to it gives 1.
    operands
        .extend([0.49999999999999994, -0.49999999999999994, 4_503_599_627_370_497.5, -2.5, -3.5].map(Some));
    for name in ["fadal", "cc100"] {
        let (module, found) = emulated("round(local.1)", &control("fanuc"), &control(name));
        assert_eq!(codes(&found), []);
        one(&module, &operands, Bound::Exact, |a| Some(a.round()));
    }
}

/// The CC100 drops fractions by INC and DEC, of which nothing says what they do below zero (seed 004:1643).
#[test]
fn whole_parts_by_magnitude() {
    for (expr, wanted) in [("fix(local.1)", f64::trunc as fn(f64) -> f64), ("abs(local.1)", f64::abs)] {
        let (module, found) = emulated(expr, &control("fanuc"), &control("cc100"));
        assert_eq!(codes(&found), []);
        one(&module, &operands(), Bound::Exact, |a| Some(wanted(a)));
        let below = |e: &&Expr| matches!(e, Expr::Call(macroglot::canon::Func::Abs, _));
        assert_eq!(expressions(&module).iter().filter(|e| below(e)).count(), 0, "{module}");
    }
}

/// SIN and COS take -360 to 360 there: whole turns go (seed 004:1640).
#[test]
fn angles_within_a_turn() {
    let target = control("cc100");
    for (expr, wanted) in [("sin(local.1)", f64::sin as fn(f64) -> f64), ("cos(local.1)", f64::cos)] {
        let (module, found) = emulated(expr, &control("fanuc"), &target);
        assert_eq!(codes(&found), []);
        let angles = (-4000..=4000).map(|n| Some(f64::from(n) / 4.0)).chain(operands());
        for angle in angles {
            let got = result(&module, &[angle]).unwrap();
            let wanted = wanted((angle.unwrap_or(0.0) % 360.0).to_radians());
            assert!((got - wanted).abs() <= 1e-9, "{angle:?}: {got}, not {wanted}\n{module}");
        }
    }
    let (module, _) = emulated("sin(750)", &control("fanuc"), &target);
    assert!(expressions(&module).contains(&&Expr::Number(30.0)), "{module}");
}

#[test]
fn rounding_to_places() {
    for (places, scale) in [(0, 1.0), (1, 10.0), (4, 10_000.0)] {
        for name in ["fanuc", "haas"] {
            let (module, found) =
                emulated(&format!("round.places(local.1, {places})"), &control("fadal"), &control(name));
            assert_eq!(codes(&found), [Code::NearlyEqual]);
            one(&module, &operands(), Bound::Exact, |a| Some((a * scale).round() / scale));
        }
    }
    for expr in ["round.places(local.1, local.2)", "round.places(local.1, 10)", "round.places(local.1, 0.5)"]
    {
        let (_, found) = emulated(expr, &control("fadal"), &control("haas"));
        assert_eq!(codes(&found), [Code::NoEquivalent], "{expr}");
    }
}

#[test]
fn bcd_and_bin() {
    let wholes = [
        0.0,
        1.0,
        9.0,
        10.0,
        15.0,
        16.0,
        99.0,
        100.0,
        1234.0,
        65_535.0,
        9_999_999.0,
        10_000_000.0,
        12_345_678.0,
        99_999_999.0,
    ];
    // The digits of the number, read as hexadecimal ones.
    let bcd = |a: f64| i64::from_str_radix(&format!("{a}"), 16).unwrap() as f64;
    for target in lacking("bcd").into_iter().filter(|c| c.function(macroglot::canon::Func::Fix, 1).is_some())
    {
        let (module, found) = emulated("bcd(local.1)", &control("fanuc"), &target);
        assert_eq!(codes(&found), [Code::NearlyEqual]);
        one(&module, &wholes.map(Some), Bound::Exact, |a| Some(bcd(a)));
        let (module, found) = emulated("bin(local.1)", &control("fanuc"), &target);
        assert_eq!(codes(&found), [Code::NearlyEqual]);
        for whole in wholes {
            assert_eq!(result(&module, &[Some(bcd(whole))]), Some(whole));
        }
    }
}

#[test]
fn tan() {
    for target in lacking("tan") {
        let (module, found) = emulated("tan(local.1)", &control("fanuc"), &target);
        assert_eq!(codes(&found), []);
        // Where the cosine is 0 the machine stops, as for the tangent.
        one(&module, &operands(), Bound::Ulps(2.0), |a| {
            (a.rem_euclid(180.0) != 90.0).then(|| match a % 360.0 {
                turn if turn % 180.0 == 0.0 => 0.0,
                turn if turn.rem_euclid(180.0) == 45.0 => 1.0,
                turn if turn.rem_euclid(180.0) == 135.0 => -1.0,
                turn => turn.to_radians().tan(),
            })
        });
    }
}

/// Sines and cosines, close to the ends too.
fn sines() -> Vec<Option<f64>> {
    let near = (1..=53).flat_map(|n| [1.0 - 2f64.powi(-n), 2f64.powi(-n) - 1.0, 1.0 - 3.0 * 2f64.powi(-n)]);
    let even = (-1000..=1000).map(|n| f64::from(n) / 1000.0);
    DOMAIN.into_iter().chain(near.chain(even).map(Some)).collect()
}

#[test]
fn asin_and_acos_by_the_arc_tangent() {
    let bound = Bound::Off(1e-7);
    let inside = |x: f64| (-1.0..=1.0).contains(&x);
    for target in lacking("asin") {
        let (module, found) = emulated("asin(local.1)", &control("haas"), &target);
        assert_eq!(codes(&found), [Code::NearlyEqual]);
        one(&module, &sines(), bound, |x| inside(x).then(|| x.asin().to_degrees()));

        // Seed 001: ASIN yields 270 to 90 by way of 360 there.
        let (module, _) = emulated("asin(local.1)", &control("fanuc"), &target);
        one(&module, &sines(), bound, |x| {
            let angle = x.asin().to_degrees();
            inside(x).then_some(if angle < 0.0 { angle + 360.0 } else { angle })
        });

        let (module, found) = emulated("acos(local.1)", &control("fanuc"), &target);
        assert_eq!(codes(&found), [Code::NearlyEqual]);
        one(&module, &sines(), bound, |x| inside(x).then(|| x.acos().to_degrees()));
    }
}

#[test]
fn asin_of_the_target_in_the_range_of_the_source() {
    let (module, found) = emulated("asin(local.1)", &control("fanuc"), &control("haas"));
    assert_eq!(codes(&found), []);
    one(&module, &sines(), Bound::Off(1e-12), |x| {
        let angle = x.asin().to_degrees();
        (-1.0..=1.0).contains(&x).then_some(if angle < 0.0 { angle + 360.0 } else { angle })
    });
    let (module, found) = emulated("asin(local.1)", &control("haas"), &control("fanuc"));
    assert_eq!(codes(&found), []);
    one(&module, &sines(), Bound::Off(1e-12), |x| (-1.0..=1.0).contains(&x).then(|| x.asin().to_degrees()));
}

#[test]
fn atan_of_two_by_quadrants() {
    let signed = control_with("fanuc", "dialect = \"fanuc\"\n[parameters]\n6004.0 = 1\n");
    for name in ["fadal", "cc100"] {
        let (module, found) = emulated("atan(local.1, local.2)", &control("fanuc"), &control(name));
        assert_eq!(codes(&found), []);
        directions(&module, 0.0..=360.0);
        let (module, found) = emulated("atan(local.1, local.2)", &signed, &control(name));
        assert_eq!(codes(&found), []);
        directions(&module, -180.0..=180.0);
        // A source whose range nobody states: taken as -180 to 180, and said.
        let (module, found) = emulated("atan(local.1, local.2)", &control("haas"), &control(name));
        assert_eq!(codes(&found), [Code::NearlyEqual]);
        directions(&module, -180.0..=180.0);
    }
}

/// The direction of every point of the domain lies in the range, and is the right one.
fn directions(module: &Module, range: std::ops::RangeInclusive<f64>) {
    for y in operands() {
        for x in operands() {
            let got = result(module, &[y, x]);
            let (b, a) = (y.unwrap_or(0.0) + 0.0, x.unwrap_or(0.0) + 0.0);
            if (a, b) == (0.0, 0.0) {
                assert_eq!(got, None, "the point 0, 0 has no direction: the machine stops");
                continue;
            }
            let got = got.unwrap();
            // At the seam of the range a hair decides between its two ends.
            let off = (got - b.atan2(a).to_degrees()).rem_euclid(360.0);
            assert!(range.contains(&got) && off.min(360.0 - off) < 1e-12, "{y:?} {x:?}: {got}\n{module}");
        }
    }
}

/// What is said of a series: that it is nearly equal, and where a target may refuse small numbers that they come up.
fn of_series(target: &Control) -> Vec<Code> {
    let small = target.numbers().least.map(|_| Code::Conditional);
    small.into_iter().chain([Code::NearlyEqual]).collect()
}

#[test]
fn exp() {
    let operands: Vec<Option<f64>> =
        (-200..=200).map(|n| Some(f64::from(n) / 10.0)).chain([None, Some(1e-9)]).collect();
    for target in lacking("exp") {
        let (module, found) = emulated("exp(local.1)", &control("fanuc"), &target);
        assert_eq!(codes(&found), of_series(&target));
        one(&module, &operands, Bound::Part(1e-12), |a| Some(a.exp()));
    }
}

#[test]
fn ln() {
    let mut operands: Vec<Option<f64>> = (-90..=90).map(|n| Some(10f64.powf(f64::from(n) / 10.0))).collect();
    operands.extend(DOMAIN.into_iter().filter(|a| a.is_some_and(|a| a > 0.0)));
    operands.extend([Some(-0.5), Some(-1.0)]);
    for target in lacking("ln") {
        let (module, found) = emulated("ln(local.1)", &control("fanuc"), &target);
        assert_eq!(codes(&found), of_series(&target));
        one(&module, &operands, Bound::Off(1e-11), |a| (a > 0.0).then(|| a.ln()));
    }
}

#[test]
fn pow() {
    for target in lacking("pow") {
        for n in [1, 2, 3, 8] {
            let (module, found) = emulated(&format!("pow(local.1, {n})"), &control("fanuc"), &target);
            assert_eq!(codes(&found), of_series(&target));
            one(&module, &operands(), Bound::Ulps(8.0), |a| Some(a.powi(n)));
        }
        let (module, found) = emulated("pow(local.1, local.2)", &control("fanuc"), &target);
        assert_eq!(codes(&found), of_series(&target));
        for a in [0.5, 1.0, 1.5, 2.5, 10.0, 359.9] {
            for b in [None, Some(-2.5), Some(-1.0), Some(0.0), Some(0.5), Some(1.0), Some(3.0)] {
                let (got, wanted) = (result(&module, &[Some(a), b]).unwrap(), a.powf(b.unwrap_or(0.0)));
                assert!(Bound::Part(1e-10).holds(got, wanted), "{a} {b:?}: {got}, not {wanted}");
            }
        }
    }
}

#[test]
fn remainder_by_division() {
    for name in ["fadal", "haas", "cc100"] {
        let (module, found) = emulated("local.1 mod local.2", &control("fanuc"), &control(name));
        assert_eq!(codes(&found), []);
        two(&module, &operands(), Bound::Exact, |a, b| {
            let (a, b) = (a.round() as i64, b.round() as i64);
            (b != 0).then(|| (a % b) as f64)
        });
        // A constant divisor that rounds to 0 stops the machine as well.
        let (module, _) = emulated("local.1 mod 0.4", &control("fanuc"), &control(name));
        one(&module, &operands(), Bound::Exact, |_| None);
    }
}

#[test]
fn a_function_inside_another_keeps_its_place() {
    let (module, _) =
        emulated("2 * fup(local.1 + tan(local.2)) - fup(local.2)", &control("fanuc"), &control("fadal"));
    let fup = |a: f64| if a < 0.0 { a.floor() } else { a.ceil() };
    for (a, b) in [(0.25, 45.0), (-3.5, 135.0), (2.0, 0.0)] {
        let tan =
            [(45.0, 1.0), (135.0, -1.0), (0.0, 0.0)].into_iter().find(|(angle, _)| *angle == b).unwrap().1;
        assert_eq!(
            result(&module, &[Some(a), Some(b)]),
            Some(2.0 * fup(a + tan) - fup(b)),
            "{a} {b}\n{module}"
        );
    }
}
