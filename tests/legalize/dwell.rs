//! Times of dwells, on the controls that have one.

use crate::harness::{DOMAIN, control, legalized, observe, program};
use macroglot::canon::{Op, Role};
use macroglot::dialect::Control;
use std::collections::BTreeMap;

fn takes(target: &Control, role: Role) -> bool {
    target.letter(role, target.code_for(Op::Dwell, &BTreeMap::new())).is_some()
}

/// The milliseconds that the first event of a run dwells.
fn milliseconds(event: &str) -> Option<f64> {
    let value = |name: &str| event.split(' ').find_map(|word| word.strip_prefix(name)?.parse::<f64>().ok());
    value("dwell.ms=").or_else(|| Some(value("dwell.s=")? * 1000.0))
}

#[test]
fn constants_keep_their_time_in_a_word_that_the_target_has() {
    // Seconds as people write them, many of which times 1000 are no whole number in binary.
    let seconds = [0.0, 0.001, 0.07, 0.29, 0.5, 1.001, 1.005, 2.0, 4.35, 8.2, 16.1, 32.768, 99.999, 9999.999];
    for name in ["fadal", "fanuc", "haas"] {
        let target = control(name);
        for s in seconds {
            let ms: f64 = format!("{:.0}", s * 1000.0).parse().unwrap();
            for body in [format!(" nc dwell dwell.s={s}"), format!(" nc dwell dwell.ms={ms}")] {
                let (after, found) = legalized("dwell", &program(&body), &control("haas"), &target);
                let (trace, _) = observe(&after, &[], &[]);
                let event = &trace.events[0];
                assert!(found.is_empty(), "{found:?}");
                assert!((milliseconds(event).unwrap() - ms).abs() < 1e-6, "{body}: {event}");
                let role = if event.contains("dwell.ms") { Role::DwellMs } else { Role::DwellS };
                assert!(takes(&target, role), "{body} on {name}: {event}");
            }
        }
    }
}

#[test]
fn computed_times_are_the_same_time() {
    for name in ["fadal", "fanuc", "haas"] {
        let target = control(name);
        for (word, unit) in [("dwell.s", 1000.0), ("dwell.ms", 1.0)] {
            let before = program(&format!(" nc dwell {word}=(local.1 + 1)"));
            let (after, _) = legalized("dwell", &before, &control("fanuc"), &target);
            for a in DOMAIN {
                let (trace, _) = observe(&after, &[a], &[]);
                let wanted = (a.unwrap_or(0.0) + 1.0) * unit;
                let got = milliseconds(&trace.events[0]).unwrap();
                assert!(
                    (got - wanted).abs() <= 4.0 * f64::EPSILON * wanted.abs(),
                    "{a:?}: {:?}",
                    trace.events
                );
            }
        }
    }
}
