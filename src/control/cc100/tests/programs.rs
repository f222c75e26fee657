//! The course's programs: their motion, worked out here.

use super::corpus;
use crate::control::testing::*;
use crate::control::trace::EventKind;
use crate::control::{End, Run};

/// The datum that the programs give by VX and VY.
const DATUM: f64 = 200.0;

/// The corners that a program feeds through at one depth, from its datum.
#[track_caller]
fn walks(name: &str, depth: f64, corners: &[[f64; 2]]) -> Run {
    let run = corpus(name, &given(&[]));
    ended(&run);
    let cut: Vec<[f64; 3]> = feeds(&run).into_iter().filter(|at| (at[2] - depth).abs() < 1e-9).collect();
    // The first point is where the tool goes down.
    assert_eq!(cut.len(), corners.len() + 1, "{name}: {cut:?}");
    for (found, [x, y]) in cut[1..].iter().zip(corners) {
        near(*found, [DATUM + x, DATUM + y, depth]);
    }
    run
}

/// End, centre and sweep of each arc, from the datum.
fn arcs(run: &Run) -> Vec<([f64; 2], [f64; 2], f64)> {
    let arcs = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Arc { to, centre, sweep, off, .. } => {
            assert!(off.abs() < 1e-9);
            let flat = |at: [f64; 3]| [at[0] - DATUM, at[1] - DATUM];
            Some((flat(xyz(to)), flat(xyz(centre)), *sweep))
        }
        _ => None,
    });
    arcs.collect()
}

#[test]
fn example1_and_its_plain_form() {
    let corners = [[50.0, 0.0], [40.0, 25.0], [0.0, 25.0], [0.0, -10.0]];
    walks("example1-comp1.nc", -10.0, &corners);
    walks("example1-nc-comp1.nc", -10.0, &corners);
}

#[test]
fn example2_corners() {
    // V7 = 100 sin 30; V12 = sqr(50^2 - (V7 - 20)^2).
    walks("example2.nc", -10.0, &[[126.603, 0.0], [40.0, 50.0], [0.0, 20.0], [0.0, -10.0]]);
}

#[test]
fn problems_1_to_3() {
    walks("problem1-comp1.nc", -10.0, &[[120.0, 0.0], [120.0, 40.0], [0.0, 40.0], [0.0, -10.0]]);
    let corners = [[100.0, 0.0], [75.0, 50.0], [25.0, 50.0], [0.0, 0.0], [-5.0, -10.0]];
    walks("problem2-comp1.nc", -10.0, &corners);
    let corners = [[100.0, 0.0], [100.0, 60.0], [60.0, 60.0], [0.0, 30.0], [0.0, -10.0]];
    walks("problem3.nc", -10.0, &corners);
}

#[test]
fn problems_4_to_7() {
    let tan = |degrees: f64| degrees.to_radians().tan();
    let base = 80.0 / tan(76.0);
    walks("problem4.nc", -10.0, &[[base, 0.0], [0.0, 80.0], [0.0, -10.0]]);
    let rise = 40.0 * tan(40.0);
    let corners = [[60.0, 0.0], [100.0, rise], [100.0, 50.0 + rise], [0.0, 50.0 + rise], [0.0, -10.0]];
    walks("problem5.nc", -10.0, &corners);
    let roof = 50.0 + 50.0 * tan(40.0);
    let corners = [[100.0, 0.0], [100.0, 50.0], [50.0, roof], [0.0, 50.0], [0.0, -10.0]];
    walks("problem6.nc", -10.0, &corners);
    let slope = 30.0 * tan(30.0);
    let mut at = [0.0, 0.0];
    let moves = [
        [120.0, 0.0],
        [0.0, 40.0],
        [-30.0, slope],
        [0.0, 30.0],
        [-30.0, slope],
        [-30.0, -slope],
        [0.0, -30.0],
        [-30.0, -slope],
    ];
    let mut corners = vec![[0.0, 0.0]];
    for [x, y] in moves {
        at = [at[0] + x, at[1] + y];
        corners.push(at);
    }
    corners.push([at[0], -10.0]);
    walks("problem7.nc", -10.0, &corners);
}

/// Five slots, 15 long, 50 apart on a board of 300.
#[test]
fn problem8_cuts_its_slots() {
    for name in ["problem8a.nc", "problem8b-ok.nc"] {
        let run = corpus(name, &given(&[]));
        ended(&run);
        let ways: Vec<[f64; 3]> = feeds(&run);
        assert_eq!(ways.len(), 2 * 5, "{name}");
    }
    let run = corpus("problem8a.nc", &given(&[]));
    for (at, pair) in feeds(&run).chunks(2).enumerate() {
        let x = DATUM + 42.5 + 50.0 * at as f64;
        near(pair[0], [x, DATUM + 50.0, -5.0]);
        near(pair[1], [x + 15.0, DATUM + 50.0, -5.0]);
    }
}

/// A length that 50 does not divide stops with its message, again and again.
#[test]
fn problem8b_shows_its_message() {
    let run = corpus("problem8b-error.nc", &crate::control::Scenario { steps: 500, ..given(&[]) });
    assert_eq!(run.end, End::StepBudget);
    let text = "INPUT VARIABLE IS NOT A MULTIPLE OF 50 - ENTER NEW VALUE OF V10";
    assert!(run.events.iter().any(|event| event.what == EventKind::Message { text: text.into() }));
}

/// Ten holes 32 apart, 30 degrees up from X50 Y50.
#[test]
fn problem9_drills_its_row() {
    let run = corpus("problem9-ok.nc", &given(&[]));
    ended(&run);
    let holes = holes(&run);
    assert_eq!(holes.len(), 10);
    for (at, hole) in holes.iter().enumerate() {
        let along = 32.0 * at as f64;
        let (sin, cos) = 30f64.to_radians().sin_cos();
        near(*hole, [DATUM + 50.0 + along * cos, DATUM + 50.0 + along * sin, -10.0]);
    }
    assert!(doubts(&run).contains(&"behaviour:repeat.counts"));
}

/// A minus before the radius is the short arc: quarters of 15 about the corners of the board.
#[test]
fn example4_rounds_its_corners_inward() {
    for name in ["example4-a.nc", "example4-b.nc"] {
        let run = corpus(name, &given(&[]));
        ended(&run);
        let expected = [([90.0, 15.0], [90.0, 0.0]), ([75.0, 50.0], [90.0, 50.0])];
        let found = arcs(&run);
        assert_eq!(found.len(), expected.len());
        for ((to, centre, sweep), (end, middle)) in found.into_iter().zip(expected) {
            near([to[0], to[1], sweep], [end[0], end[1], -90.0]);
            near([centre[0], centre[1], 0.0], [middle[0], middle[1], 0.0]);
        }
        assert!(doubts(&run).contains(&"behaviour:arc.radius.negative"));
    }
}

/// 0 to 360 degrees in steps of 2: 181 points of an ellipse of 300 by 180.
#[test]
fn example10_goes_round_its_ellipse() {
    for name in ["example10-ellipse.nc", "example10-ellipse-flex.nc"] {
        let run = corpus(name, &given(&[]));
        ended(&run);
        let from = |at: &[f64; 3]| [at[0] - 400.0, at[1] - 300.0, 0.0];
        let cut: Vec<[f64; 3]> = feeds(&run).iter().map(from).collect();
        let first = cut.iter().position(|at| (at[0] - 150.0).abs() < 1e-9 && at[1].abs() < 1e-9);
        let points = &cut[first.unwrap()..];
        // The way off the board follows.
        assert_eq!(points.len(), 181 + 1, "{name}");
        for (at, point) in points[..181].iter().enumerate() {
            let (sin, cos) = (2.0 * at as f64).to_radians().sin_cos();
            near(*point, [150.0 * cos, 90.0 * sin, 0.0]);
        }
    }
}

/// Shoulders of 80 about points 80 above the corners' height, a crown of 163 about (150, 330).
#[test]
fn example11_arcs_lie_on_their_circles() {
    let run = corpus("example11-panel.nc", &given(&[]));
    ended(&run);
    // Where the circles touch: along the line between the centres (150, 330) and (272, 540).
    let (dx, dy) = (150.0 - 28.0, 460.0 - 330.0 + 80.0);
    let reach = 163.0 + 80.0;
    let touch = [163.0 * dx / reach, 330.0 + 163.0 * dy / reach];
    let arcs = arcs(&run);
    let ends = [[150.0 + touch[0], touch[1]], [150.0 - touch[0], touch[1]], [28.0, 460.0]];
    // The sizes given fit to half a tenth only: the centres miss by as much.
    let centres = [[272.0, 540.0], [150.0, 330.0], [28.0, 540.0]];
    assert_eq!(arcs.len(), 3);
    for (at, (to, centre, sweep)) in arcs.iter().enumerate() {
        let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        assert!(apart(*to, ends[at]) < 1e-9, "{to:?}");
        assert!(apart(*centre, centres[at]) < 0.5, "{centre:?}");
        assert_eq!(*sweep > 0.0, at == 1);
        assert!(sweep.abs() < 90.0);
    }
}
