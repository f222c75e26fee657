//! Arcs by their radius: each piece on the circle, none of more than 170 degrees, all of them the arc.

use crate::harness::{control, legalized};
use macroglot::ir::eval::{Memory, run};
use macroglot::ir::text::parse;
use macroglot::ir::{Class, Module, Var};

/// The words of the moves of a run that have a radius: X, Y and R.
fn pieces(module: &Module, set: &[f64]) -> Vec<[f64; 3]> {
    let mut memory = Memory::new();
    for (number, value) in (1..).zip(set) {
        memory.set(Var { class: Class::Global, number }, Some(*value));
    }
    let trace = run(module, 0, &mut memory, &[], 1000);
    let word = |event: &str, name: &str| -> Option<f64> {
        event.split(' ').find_map(|word| word.strip_prefix(name)?.parse().ok())
    };
    let piece = |event: &String| {
        Some([word(event, "axis.x=")?, word(event, "axis.y=")?, word(event, "arc.radius=")?])
    };
    trace.events.iter().filter_map(piece).collect()
}

/// Runs an arc from every angle over every sweep, and measures its pieces.
fn sweeps(text: &str, ccw: bool, incremental: bool) {
    let module = parse(text).expect("the text is right");
    let (module, _) = legalized("short-arcs", &module, &control("fanuc"), &control("cc100"));
    let sense = if ccw { 1.0 } else { -1.0 };
    for (radius, first) in [(5.0, 0.0), (5.0, 90.0), (0.4, 33.0), (250.0, 200.0)] {
        for sweep in (1..=360).map(f64::from).chain([0.5, 169.99, 170.01, 179.99, 180.01, 359.5]) {
            let (cx, cy) = (7.0, -11.0);
            let at = |degrees: f64| {
                let (sin, cos) = degrees.to_radians().sin_cos();
                [cx + radius * cos, cy + radius * sin]
            };
            let (start, end) = (at(first), at(first + sense * sweep));
            let to = if incremental { [end[0] - start[0], end[1] - start[1]] } else { end };
            let set = [start[0], start[1], to[0], to[1], cx - start[0], cy - start[1]];
            let (mut here, mut turned) = (start, 0.0);
            let all = pieces(&module, &set);
            assert!((1..=3).contains(&all.len()), "{sweep}: {all:?}");
            for [x, y, r] in &all {
                let to = if incremental { [here[0] + x, here[1] + y] } else { [*x, *y] };
                assert!((r - radius).abs() < 1e-9 * radius, "{sweep}: {r}");
                let off = (to[0] - cx).hypot(to[1] - cy) - radius;
                assert!(off.abs() < 1e-6 * radius, "{sweep}: off by {off}");
                let angle = |at: [f64; 2]| (at[1] - cy).atan2(at[0] - cx).to_degrees();
                let piece = (sense * (angle(to) - angle(here))).rem_euclid(360.0);
                assert!(piece <= 170.001, "{sweep}: a piece of {piece}");
                (here, turned) = (to, turned + piece);
            }
            assert!((turned - sweep).abs() < 1e-3, "{sweep} became {turned}: {all:?}");
            assert!((here[0] - end[0]).hypot(here[1] - end[1]) < 1e-9 * radius, "{sweep}: {here:?}");
        }
    }
}

#[test]
fn arcs_between_variables_are_cut_by_the_run() {
    for (ccw, op) in [(true, "motion.arc.ccw"), (false, "motion.arc.cw")] {
        let moves = "nc distance.absolute motion.linear axis.x=global.1 axis.y=global.2";
        let words = "axis.x=global.3 axis.y=global.4 arc.i=global.5 arc.j=global.6";
        sweeps(&format!("program O1 file 0 {{\nblock0:\n {moves}\n nc {op} {words}\n end\n}}\n"), ccw, false);
        let moves = format!("{moves}\n nc distance.incremental");
        sweeps(&format!("program O1 file 0 {{\nblock0:\n {moves}\n nc {op} {words}\n end\n}}\n"), ccw, true);
    }
}

/// The start is read from a copy where its variables change before the arc.
#[test]
fn the_start_of_an_arc_is_kept() {
    let text = "program O1 file 0 {\nblock0:\n nc distance.absolute motion.linear axis.x=(global.1 + 0) axis.y=global.2\n \
                global.1 = 0\n global.2 = 0\n nc motion.arc.ccw axis.x=global.3 axis.y=global.4 arc.i=global.5 arc.j=global.6\n \
                end\n}\n";
    sweeps(text, true, false);
}

/// Under a rotation about (2, 3) by any angle, in each sense that the numbers may have.
#[test]
fn places_under_a_rotation_are_turned() {
    let text = "program O1 file 0 {\nblock0:\n nc distance.absolute plane.xy rotate.on axis.x=2 axis.y=3 rotation.angle=global.1\n \
                nc motion.arc.cw axis.x=(global.2 * 1) axis.y=global.3 arc.radius=5\n end\n}\n";
    let module = parse(text).expect("the text is right");
    let (module, _) = legalized("rotations", &module, &control("fanuc"), &control("cc100"));
    for degrees in (-720..=720).step_by(7).map(f64::from) {
        for [x, y] in [[2.0, 3.0], [10.0, 3.0], [-4.5, 6.25], [0.0, 0.0]] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let wanted = [2.0 + (x - 2.0) * cos - (y - 3.0) * sin, 3.0 + (x - 2.0) * sin + (y - 3.0) * cos];
            let all = pieces(&module, &[degrees, x, y]);
            assert!(
                all.iter().any(|[a, b, _]| (a - wanted[0]).abs() + (b - wanted[1]).abs() < 1e-9),
                "{degrees} of ({x}, {y}): {all:?}, not {wanted:?}"
            );
        }
    }
}
