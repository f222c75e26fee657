//! The manual's programs: their motion, worked out here.

use crate::control::testing::*;
use crate::control::trace::EventKind;
use crate::control::{End, Run, Scenario};

fn corpus(names: &[&str], scenario: &Scenario) -> Run {
    run_corpus("fadal", names, scenario)
}

/// End, centre and distance off the circle of each arc.
fn arcs(run: &Run) -> Vec<([f64; 3], [f64; 3], f64)> {
    let arcs = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Arc { to, centre, off, .. } => Some((xyz(to), xyz(centre), *off)),
        _ => None,
    });
    arcs.collect()
}

/// The manual counts 100 holes; the block of the G81 drills too.
#[test]
fn o1234_and_o1235_drill_the_same_grid() {
    let run = corpus(&["o1234-drill-grid.nc"], &given(&[]));
    ended(&run);
    let first = holes(&run);
    near(first[0], [0.0, 0.0, -0.75]);
    let grid = (0..10).flat_map(|y| (1..=10).map(move |x| [f64::from(x), f64::from(y), -0.75]));
    assert_eq!(first.len(), 101);
    first[1..].iter().zip(grid).for_each(|(found, expected)| near(*found, expected));
    assert!(!doubts(&run).contains(&"behaviour:cycle.block.runs"));
}

/// Ten holes are asked for; the test `<` leaves the one at 324 degrees from the first out.
#[test]
fn o5_misses_its_last_hole() {
    let run = corpus(&["o5-bolt-pattern.nc"], &given(&[]));
    ended(&run);
    let holes = holes(&run);
    assert_eq!(holes.len(), 9);
    for (at, hole) in holes.iter().enumerate() {
        // X by the sine: 30 degrees from +Y are 60 from +X.
        let angle = (60.0 + 36.0 * at as f64).to_radians();
        near(*hole, [2.5 * angle.cos(), 2.5 * angle.sin(), -1.0]);
    }
}

/// The last step overshoots X by a hair, and the root of a negative number halts the run.
#[test]
fn o9_follows_its_ellipse() {
    let run = corpus(&["o9-ellipse.nc"], &answering(&[3.0, 2.0]));
    assert!(matches!(&run.end, End::Alarm { stop, .. } if stop.text.contains("SQR")));
    let points = feeds(&run);
    // From 1.5 down by hundredths; -1.5 itself is what cannot be had.
    assert_eq!(points.len(), 1 + 299);
    for (at, [x, y, z]) in points[1..].iter().enumerate() {
        assert!((x - (1.49 - 0.01 * at as f64)).abs() < 1e-9 && *z == -0.25);
        assert!(((x / 1.5).powi(2) + y * y - 1.0).abs() < 1e-9, "{x} {y}");
    }
}

/// 10 / 0.00077 turns are 12988 arcs of a degree, each ending on its own radius.
#[test]
fn o5757_winds_12988_arcs() {
    let run = corpus(&["o5757-spiral.nc"], &given(&[]));
    ended(&run);
    let arcs = arcs(&run);
    assert_eq!(arcs.len(), 12_988);
    for (at, (to, _, off)) in arcs.iter().enumerate() {
        let turn = (at + 1) as f64;
        let (sin, cos) = (turn % 360.0).to_radians().sin_cos();
        near(*to, [turn * 0.00077 * sin, turn * 0.00077 * cos, -0.25]);
        assert!(off.abs() < 1e-6);
    }
}

/// From 1.687 down by hundredths: 169 passes, each larger by 0.00087.
#[test]
fn o7_takes_169_passes() {
    let run = corpus(&["o7-taper-rectangle.nc"], &given(&[]));
    ended(&run);
    let points = feeds(&run);
    assert_eq!(points.len(), 1 + 169 * 7);
    for pass in 0..169 {
        let n = f64::from(pass);
        let (half, long, z) = (0.8736 + 0.00087 * n, 1.3556 + 0.00087 * n, -1.687 + 0.01 * n);
        let corners = [
            [0.0, -half, z],
            [long, -half, z],
            [long, half, z],
            [-long, half, z],
            [-long, -half, z],
            [0.0, -half, z],
            [0.0, -half, z + 0.01],
        ];
        let from = 1 + pass as usize * 7;
        points[from..from + 7].iter().zip(corners).for_each(|(found, expected)| near(*found, expected));
    }
}

/// The points of the D-hole about its centre, counter-clockwise: radius 2, blend 0.5, line at -0.7.
#[test]
fn o800_closes_its_contour() {
    let library = ["o1-dhole-main.nc", "o800-dhole.nc", "o900-rotate.nc"];
    let run = corpus(&library, &given(&[]));
    ended(&run);
    assert_eq!(holes(&run), [[2.0, -3.0, -0.6]]);
    let y = (1.5f64 * 1.5 - 0.2 * 0.2).sqrt();
    let tangent = (-0.2 * 2.0 / 1.5, y * 2.0 / 1.5);
    let at = |x: f64, y: f64| [2.0 + x, -3.0 + y, -0.3];
    let arcs = arcs(&run);
    assert_eq!(arcs.len(), 3);
    near(arcs[0].0, at(tangent.0, -tangent.1));
    near(arcs[0].1, at(-0.2, -y));
    near(arcs[1].0, at(tangent.0, tangent.1));
    near(arcs[1].1, at(0.0, 0.0));
    near(arcs[2].1, at(-0.2, y));
    assert!(arcs[0].2.abs() < 1e-9 && arcs[1].2.abs() < 1e-9);
    // As printed, -V6 puts the end of the last arc 0.4 off its circle.
    near(arcs[2].0, at(0.7, y));
    assert!((arcs[2].2 - 0.4).abs() < 1e-9);
    near(*feeds(&run).last().unwrap(), at(0.0, 0.0));
}

/// With V6 in both places the contour closes on its line.
#[test]
fn o800_mended_has_no_arc_off_its_circle() {
    let read = |name: &str| std::fs::read_to_string(format!("corpus/fadal/{name}")).unwrap();
    let mended = read("o800-dhole.nc").replace("R3=-V6", "R3=V6");
    let (main, rotate) = (read("o1-dhole-main.nc"), read("o900-rotate.nc"));
    let files = [("main", main.as_bytes()), ("o800", mended.as_bytes()), ("o900", rotate.as_bytes())];
    let run = run("fadal", &files, &given(&[]));
    ended(&run);
    assert!(arcs(&run).iter().all(|(_, _, off)| off.abs() < 1e-9));
    let y = (1.5f64 * 1.5 - 0.2 * 0.2).sqrt();
    near(arcs(&run)[2].0, [2.0 - 0.7, -3.0 + y, -0.3]);
}

/// Three slots of five passes, three arcs each; every line between is straight.
#[test]
fn the_slots_are_cut_to_depth() {
    let run = corpus(&["slot-parametric.nc"], &given(&[]));
    ended(&run);
    let arcs = arcs(&run);
    assert_eq!(arcs.len(), 3 * 5 * 3);
    assert!(arcs.iter().all(|(_, _, off)| off.abs() < 1e-9));
    // 0.1 twice, 0.05 and 0.01 below 0.01.
    let deepest = feeds(&run).iter().map(|point| point[2]).fold(0.0, f64::min);
    assert!((deepest - (0.01 - 0.26)).abs() < 1e-9, "{deepest}");
}

/// The macro goes on by one column a row, because it counts moves and not holes.
#[test]
fn o810_drills_where_its_moves_end() {
    let run = corpus(&["o10-row-column-main.nc", "o810-row-column.nc"], &given(&[]));
    ended(&run);
    let rows: [(f64, std::ops::RangeInclusive<i32>); 4] =
        [(0.0, 0..=3), (-1.0, 1..=4), (-2.0, 2..=5), (-3.0, 3..=6)];
    let places = rows.into_iter().flat_map(|(y, xs)| xs.map(move |x| [f64::from(x), y, -1.0]));
    let expected: Vec<[f64; 3]> = places.collect();
    let holes = holes(&run);
    assert_eq!(holes.len(), expected.len());
    holes.iter().zip(expected).for_each(|(found, expected)| near(*found, expected));
}

/// 0.015 deeper at each step from 0.1, until Z is at -1 or below; at three places.
#[test]
fn o4_drills_by_steps_at_each_place() {
    let run = corpus(&["o4-big-drill.nc"], &given(&[]));
    ended(&run);
    let down = feeds(&run).into_iter().filter(|point| point[2] < 0.1 - 1e-9).collect::<Vec<_>>();
    let steps = (1.1f64 / 0.015).ceil() as usize;
    assert_eq!(down.len(), 3 * steps);
    for (at, point) in down.iter().enumerate() {
        let (hole, step) = (at / steps, at % steps + 1);
        near(*point, [hole as f64, 0.0, 0.1 - 0.015 * step as f64]);
    }
    let dwells = run.events.iter().filter(
        |event| matches!(event.what, EventKind::Dwell { seconds } if (seconds - 0.0045).abs() < 1e-12),
    );
    assert_eq!(dwells.count(), 3 * steps);
}

/// A pocket of 3 by 2. The way out is printed as `Y+R4 G40 G90`, under G91: half the width back to the middle of the pocket,
/// where the contour began.
#[test]
fn o600_and_o700_cut_their_pockets() {
    let run = corpus(&["o600-rect-pocket.nc"], &answering(&[3.0, 2.0]));
    let walk = [[0.0, -1.0], [1.5, -1.0], [1.5, 1.0], [-1.5, 1.0], [-1.5, -1.0], [0.0, -1.0], [0.0, 0.0]];
    let points = feeds(&run);
    points[1..].iter().zip(walk).for_each(|(found, [x, y])| near(*found, [x, y, -0.25]));
    assert_eq!(points.len(), 1 + walk.len());
    assert!(!doubts(&run).contains(&"machine:distance.code.behind.words"));

    let run = corpus(&["o700-rect-pocket-radius.nc"], &answering(&[3.0, 2.0, 0.25]));
    let corners = [[1.5, -0.75], [1.25, 1.0], [-1.5, 0.75], [-1.25, -1.0]];
    let centres = [[1.25, -0.75], [1.25, 0.75], [-1.25, 0.75], [-1.25, -0.75]];
    let arcs = arcs(&run);
    assert_eq!(arcs.len(), 4);
    for ((to, centre, _), (corner, middle)) in arcs.iter().zip(corners.into_iter().zip(centres)) {
        near(*to, [corner[0], corner[1], -0.25]);
        near(*centre, [middle[0], middle[1], -0.25]);
    }
    near(feeds(&run)[feeds(&run).len() - 1], [0.0, 0.0, -0.25]);
}
