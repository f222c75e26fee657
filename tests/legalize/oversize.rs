//! Expressions that the target has no room for.

use crate::harness::{DOMAIN, control, legalized, observe, program};

/// What the pieces of long expressions are made of.
const PIECES: [&str; 6] =
    ["abs(@)", "(@ + local.2)", "(local.2 - @)", "(@ * local.2)", "sin(@) / 2", "#[fix(abs(@)) mod 2 + 1]"];

/// An expression of pieces inside one another, picked by the digits of a number.
fn nested(mut pick: usize, depth: usize) -> String {
    let mut text = "local.1".to_owned();
    for _ in 0..depth {
        text = PIECES[pick % PIECES.len()].replace('@', &text);
        pick /= 2;
    }
    text
}

#[test]
fn both_compute_the_same() {
    let mut cut = 0;
    for (source, target) in [("haas", "fanuc"), ("fanuc", "haas")] {
        for pick in 0..400 {
            let e = nested(pick * 37 + 5, 9);
            let before = program(&format!(" global.9 = {e}"));
            let (after, found) = legalized("split-expressions", &before, &control(source), &control(target));
            assert!(found.is_empty());
            cut += usize::from(after != before);
            for a in DOMAIN {
                for b in [None, Some(0.0), Some(-1.5), Some(2.0)] {
                    assert_eq!(
                        observe(&after, &[a, b], &[]).1,
                        observe(&before, &[a, b], &[]).1,
                        "{before}\n{after}"
                    );
                }
            }
        }
    }
    assert!(cut > 200, "only {cut} were cut");
}
