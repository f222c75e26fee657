//! Which locals an argument list sets, worked out by hand from the manuals' lists: Fanuc seed 001 lines 1961 to 2080,
//! Haas seed 002 lines 503, 504 and 1694.

use super::{doubts, fanuc, haas, value};
use crate::control::Run;

/// The locals that a macro finds set.
fn locals(run: &Run) -> Vec<(u32, f64)> {
    let seen = |local: u32| Some((local, value(run, &format!("#{}", local + 100))?));
    (1..=33).filter_map(seen).collect()
}

fn text(list: &str) -> String {
    let copies: String = (1..=33).map(|local| format!("#{}=#{local}\n", local + 100)).collect();
    format!("O1\nG65 P1000 {list}\nM30\nO1000\n{copies}M99\n")
}

/// A list, what Fanuc makes of it, and what Haas makes of it.
type Case = (&'static str, &'static [(u32, f64)], &'static [(u32, f64)]);

const LISTS: &[Case] = &[
    ("I1. J2. K3.", &[(4, 1.0), (5, 2.0), (6, 3.0)], &[(4, 1.0), (5, 2.0), (6, 3.0)]),
    // Out of order: by place on a Fanuc, by letter on a Haas, where each stands once.
    ("K1. J2. I3.", &[(6, 1.0), (8, 2.0), (10, 3.0)], &[(4, 3.0), (5, 2.0), (6, 1.0)]),
    ("J2. I1.", &[(5, 2.0), (7, 1.0)], &[(4, 1.0), (5, 2.0)]),
    ("K1. I2.", &[(6, 1.0), (7, 2.0)], &[(4, 2.0), (6, 1.0)]),
    ("I1. K3. J2.", &[(4, 1.0), (6, 3.0), (8, 2.0)], &[(4, 1.0), (5, 2.0), (6, 3.0)]),
    ("J5. A1. I4.", &[(1, 1.0), (5, 5.0), (7, 4.0)], &[(1, 1.0), (4, 4.0), (5, 5.0)]),
    (
        "W1. V2. K3. I4. J5.",
        &[(6, 3.0), (7, 4.0), (8, 5.0), (22, 2.0), (23, 1.0)],
        &[(4, 4.0), (5, 5.0), (6, 3.0), (22, 2.0), (23, 1.0)],
    ),
    // One letter stands twice: by place on both.
    ("I1. I2.", &[(4, 1.0), (7, 2.0)], &[(4, 1.0), (7, 2.0)]),
    ("K1. K2. K3.", &[(6, 1.0), (9, 2.0), (12, 3.0)], &[(6, 1.0), (9, 2.0), (12, 3.0)]),
    (
        "A9. I1. J2. K3. I4. J5. K6. I7.",
        &[(1, 9.0), (4, 1.0), (5, 2.0), (6, 3.0), (7, 4.0), (8, 5.0), (9, 6.0), (10, 7.0)],
        &[(1, 9.0), (4, 1.0), (5, 2.0), (6, 3.0), (7, 4.0), (8, 5.0), (9, 6.0), (10, 7.0)],
    ),
    ("I1. J2. J3.", &[(4, 1.0), (5, 2.0), (8, 3.0)], &[(4, 1.0), (5, 2.0), (8, 3.0)]),
];

#[test]
fn lists_set_what_the_manuals_say() {
    for (list, on_fanuc, on_haas) in LISTS {
        assert_eq!(locals(&fanuc(&text(list))), *on_fanuc, "fanuc {list}");
        let run = haas(&text(list));
        assert_eq!(locals(&run), *on_haas, "haas {list}");
        assert!(!doubts(&run, "behaviour:arguments.order.ijk"), "{list}");
    }
}

/// `I I J`: J follows the second I, and is the first J. No text of the Haas says which of the two counts.
#[test]
fn what_no_text_says_is_in_doubt() {
    for (list, unsure) in
        [("I1. I2. J3.", true), ("K1. J2. K3.", true), ("I1. J2. I3. J4.", false), ("K1. I2.", false)]
    {
        let run = haas(&text(list));
        assert_eq!(doubts(&run, "behaviour:arguments.repeated.order"), unsure, "haas {list}");
        assert!(!doubts(&fanuc(&text(list)), "behaviour:arguments.repeated.order"), "fanuc {list}");
    }
    assert!(doubts(&haas(&text("I1. I2. D5.")), "behaviour:arguments.mixed.later.wins"));
}
