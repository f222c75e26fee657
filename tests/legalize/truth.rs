//! Comparisons as values.

use crate::harness::{DOMAIN, control, expressions, legalized, module, observe, program};
use macroglot::ir::eval::Ending;
use macroglot::ir::{Expr, Module};

fn without_truths(before: &Module) -> Module {
    let (after, found) = legalized("truth", before, &control("haas"), &control("fanuc"));
    assert!(found.is_empty(), "{found:?}");
    assert!(!expressions(&after).iter().any(|e| matches!(e, Expr::Truth(_))), "{after}");
    after
}

/// Both do the same for every pair of operands and every position of the switch.
fn same(text: &str) {
    let before = module(text);
    let after = without_truths(&before);
    for a in DOMAIN {
        for b in DOMAIN {
            for switches in [&[][..], &[1]] {
                let (old, new) = (observe(&before, &[a, b], switches), observe(&after, &[a, b], switches));
                assert_eq!(old, new, "{a:?} {b:?} {switches:?}\n{after}");
            }
        }
    }
}

#[test]
fn every_relation_over_the_domain() {
    for relation in ["eq", "ne", "lt", "le", "gt", "ge"] {
        let before = program(&format!(" global.9 = 10 + truth(local.1 {relation} local.2)"));
        let after = without_truths(&before);
        for a in DOMAIN {
            for b in DOMAIN {
                let (x, y) = (a.unwrap_or(0.0), b.unwrap_or(0.0));
                let holds = match relation {
                    "eq" => a.is_some() == b.is_some() && x == y,
                    "ne" => a.is_some() != b.is_some() || x != y,
                    "lt" => x < y,
                    "le" => x <= y,
                    "gt" => x > y,
                    _ => x >= y,
                };
                let (trace, result) = observe(&after, &[a, b], &[]);
                assert_eq!((trace.ending, result), (Ending::End, Some(if holds { 11.0 } else { 10.0 })));
            }
        }
    }
}

#[test]
fn compound_and_nested() {
    same(
        "program O1 {\nblock0:\n global.9 = truth(all(local.1 gt 0, not(local.2 eq vacant))) * 2 + truth(truth(local.1 lt 1) eq truth(local.2 lt 1))\n end\n}",
    );
}

#[test]
fn in_conditions_of_loops() {
    same(
        "program O1 {\nblock0:\n global.9 = 0\n jump block1\nblock1:\n branch truth(global.9 lt 3) * truth(local.1 ge local.2) ne 0 ? block2 : block3\nblock2:\n global.9 = global.9 + 1\n jump block1\nblock3:\n end\n}",
    );
}

#[test]
fn a_skipped_block_evaluates_nothing() {
    same("program O1 {\nblock0:\n global.9 = 7\n global.9 = truth(1 / local.1 gt local.2) skip 1\n end\n}");
}
