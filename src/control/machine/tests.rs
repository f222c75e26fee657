//! Places computed by hand.

use super::*;
use crate::canon::Role;
use crate::control::trace::EventKind;

fn machine(scenario: &Scenario) -> Machine {
    let control = Control::plain("fanuc").expect("the shipped table loads");
    Machine::new(Arc::new(Rules::new(&control)), &control, scenario)
}

fn run(machine: &mut Machine, ops: &[Op], words: &[(Role, f64)]) -> Vec<EventKind> {
    let command = Command { ops: ops.into(), words: words.iter().copied().collect(), ..Command::default() };
    let mut trace = Trace::new(1000, &[]);
    machine.run(&command, &mut trace).expect("no alarm");
    trace.events.into_iter().map(|event| event.what).collect()
}

fn feeds(happened: &[EventKind]) -> Vec<[f64; 3]> {
    let ends = happened.iter().filter_map(|what| match what {
        EventKind::Feed { to, .. } => Some([to.0[0], to.0[1], to.0[2]]),
        _ => None,
    });
    ends.collect()
}

#[test]
fn offsets_lengths_and_inches_add_up_to_machine_coordinates() {
    let mut scenario = Scenario::default();
    scenario.work_offsets.insert(2, [100.0, 50.0, -300.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    scenario.tools.insert(7, Tool { length: 80.0, length_wear: 0.5, ..Tool::default() });
    let mut machine = machine(&scenario);
    run(&mut machine, &[Op::SelectWork], &[(Role::WorkOffset, 2.0)]);
    run(&mut machine, &[Op::LengthPlus], &[(Role::LengthOffset, 7.0)]);
    let words = [(Role::X, 1.0), (Role::Y, 2.0), (Role::Z, 0.5)];
    run(&mut machine, &[Op::Inch, Op::Rapid, Op::Absolute], &words);
    // 100 + 25.4; 50 + 50.8; -300 + 80.5 + 12.7
    assert_eq!(machine.position()[..3], [125.4, 100.8, -206.8]);
    run(&mut machine, &[Op::Incremental], &[(Role::X, -1.0)]);
    assert!((machine.position()[0] - 100.0).abs() < 1e-9);
    assert!((machine.peek(Sys::WorkPosition, &[2]).unwrap() - 2.0).abs() < 1e-12);
}

#[test]
fn a_rotation_turns_places_and_keeps_the_untouched_axis() {
    let mut machine = machine(&Scenario::default());
    let words = [(Role::X, 10.0), (Role::Y, 0.0), (Role::Angle, 90.0)];
    run(&mut machine, &[Op::RotateOn], &words);
    run(&mut machine, &[Op::Rapid], &[(Role::X, 15.0), (Role::Y, 0.0)]);
    // (15, 0) turned by 90 degrees about (10, 0) is (10, 5).
    assert_eq!(machine.position()[..2], [10.0, 5.0]);
    run(&mut machine, &[], &[(Role::Y, 2.0)]);
    assert_eq!(machine.position()[..2], [8.0, 5.0]);
}

#[test]
fn arcs_by_centre_and_by_radius_find_the_same_circle() {
    for (op, centre, radius, to, sweep) in [
        (Op::ArcCcw, (0.0, 10.0), 10.0, (10.0, 10.0), 90.0),
        (Op::ArcCcw, (10.0, 0.0), -10.0, (10.0, 10.0), 270.0),
        (Op::ArcCw, (10.0, 0.0), 10.0, (10.0, 10.0), -90.0),
        (Op::ArcCw, (0.0, 10.0), -10.0, (10.0, 10.0), -270.0),
        (Op::ArcCw, (5.0, 0.0), 5.0, (10.0, 0.0), -180.0),
    ] {
        let ends = [(Role::X, to.0), (Role::Y, to.1)];
        let by_radius = [ends[0], ends[1], (Role::ArcRadius, radius)];
        let by_centre = [ends[0], ends[1], (Role::ArcI, centre.0), (Role::ArcJ, centre.1)];
        for words in [&by_radius[..], &by_centre[..]] {
            let happened = run(&mut machine(&Scenario::default()), &[op], words);
            let found = happened.iter().find_map(|what| match what {
                EventKind::Arc { centre, sweep, .. } => Some((centre.0[0], centre.0[1], *sweep)),
                _ => None,
            });
            let (x, y, turned) = found.expect("an arc");
            let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
            assert!(
                near(x, centre.0) && near(y, centre.1) && near(turned, sweep),
                "{op} {radius}: {x} {y} {turned}"
            );
        }
    }
}

#[test]
fn a_peck_cycle_under_incremental_words_keeps_its_planes() {
    let mut scenario = Scenario { peck_clearance: 0.5, ..Scenario::default() };
    scenario.start[2] = 50.0;
    let mut machine = machine(&scenario);
    // R 5 below 50 is 45; Z 12 below R is 33; pecks of 5: 40, 35, 33.
    let words =
        [(Role::X, 10.0), (Role::CycleR, -5.0), (Role::Z, -12.0), (Role::CycleQ, 5.0), (Role::Repeat, 2.0)];
    let happened = run(&mut machine, &[Op::Incremental, Op::CyclePeck], &words);
    let depth = |x: f64| [[x, 0.0, 40.0], [x, 0.0, 35.0], [x, 0.0, 33.0]];
    assert_eq!(feeds(&happened), [depth(10.0), depth(20.0)].concat());
    assert_eq!(machine.position()[..3], [20.0, 0.0, 50.0]);
    // The cycle stays in force, its repeat does not.
    let happened = run(&mut machine, &[Op::ReturnR], &[(Role::Y, 1.0)]);
    assert_eq!(feeds(&happened), [[20.0, 1.0, 40.0], [20.0, 1.0, 35.0], [20.0, 1.0, 33.0]]);
    assert_eq!(machine.position()[2], 45.0);
}

#[test]
fn a_peck_of_nothing_and_endless_repeats_end() {
    let mut machine = machine(&Scenario::default());
    let mut trace = Trace::new(500, &[]);
    let words =
        [(Role::X, 1.0), (Role::Z, -1e9), (Role::CycleR, 0.0), (Role::CycleQ, 1e-300), (Role::Repeat, 4e9)];
    let command = Command {
        ops: [Op::CyclePeck].into_iter().collect(),
        words: words.into_iter().collect(),
        ..Command::default()
    };
    machine.run(&command, &mut trace).expect("no alarm");
    assert!(trace.is_full());
}

#[test]
fn a_probe_stops_where_the_scenario_says() {
    let scenario = Scenario { probes: vec![Probe::Part(0.25)], ..Scenario::default() };
    let mut machine = machine(&scenario);
    run(&mut machine, &[Op::Probe], &[(Role::X, 40.0)]);
    assert_eq!(machine.peek(Sys::SkipPosition, &[1]), Some(10.0));
    run(&mut machine, &[Op::Probe], &[(Role::X, 40.0)]);
    assert_eq!(machine.peek(Sys::SkipPosition, &[1]), Some(40.0));
}
