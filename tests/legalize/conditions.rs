//! Compound conditions by branches.

use crate::harness::{DOMAIN, control, legalized, module, observe};
use macroglot::ir::{Cond, Module, TermKind};

fn simple(cond: &Cond) -> bool {
    match cond {
        Cond::Compare(..) | Cond::Switch(_) => true,
        Cond::Not(inner) => matches!(**inner, Cond::Switch(_)),
        _ => false,
    }
}

/// Splits the branches of a module for a control that takes one comparison only.
fn split(before: &Module) -> Module {
    let (after, found) = legalized("conditions", before, &control("fanuc"), &control("cc100"));
    assert!(found.is_empty(), "{found:?}");
    for block in after.programs.iter().flat_map(|program| &program.blocks) {
        if let TermKind::Branch { cond, .. } = &block.term.kind {
            assert!(simple(cond), "{after}");
        }
    }
    after
}

#[test]
fn both_go_the_same_way() {
    let conditions = [
        "all(local.1 gt 0, local.2 gt 0)",
        "any(local.1 gt 0, local.2 gt 0)",
        "all(local.1 ge 0.5, any(local.2 lt 1, local.1 eq local.2), local.2 ne vacant)",
        "any(all(local.1 eq vacant, local.2 eq vacant), all(local.1 gt 1, local.2 gt 1))",
        "not(all(local.1 gt 0, any(local.2 gt 0, not(local.1 eq 1))))",
        "not(not(any(local.1 eq 1.5, switch 1)))",
        "all(not(switch 1), local.1 le local.2)",
        "any(switch 1, all(local.1 eq local.2, switch 2))",
        // Evaluated on the source whatever the first comparison says: a divisor of 0 stops the machine.
        "all(local.1 ne 0, 1 / local.1 gt local.2)",
        "any(local.1 eq 0, 1 / local.1 gt local.2)",
        "any(local.2 lt 0, sqrt(local.1) ge 0.5, not(local.2 mod 2 eq 0))",
        // A computed number may be out of range, and what it holds may be vacant.
        "all(local.2 ne 0.5, #[local.1] eq vacant)",
        "any(#[local.1 + 1] ne local.2, 1 / local.2 gt 0)",
        "all(#[local.1] ge 0, #[local.2] eq #[local.1])",
        // The divisor of a remainder is rounded, and bits must fit a word.
        "any(local.1 lt 5, local.1 mod 0.4 gt 2)",
        "any(local.1 lt 5, local.1 * 100 or 1 gt 2)",
        // A switch that decides is no reason to skip the rest.
        "all(switch 1, 1 / local.1 gt 0)",
        // Overflow in one operand.
        "any(local.1 lt 5, exp(local.1) gt 2)",
    ];
    for cond in conditions {
        let text = format!(
            "program O1 {{\nblock0:\n branch {cond} ? block1 : block2\nblock1:\n global.9 = 1\n end\nblock2:\n global.9 = 2\n end\n}}"
        );
        let before = module(&text);
        let after = split(&before);
        for a in DOMAIN {
            for b in DOMAIN {
                for switches in [&[][..], &[1], &[2], &[1, 2]] {
                    let (old, new) =
                        (observe(&before, &[a, b], switches), observe(&after, &[a, b], switches));
                    assert_eq!(old, new, "{a:?} {b:?} {switches:?}\n{after}");
                }
            }
        }
    }
}

#[test]
fn comments_and_number_stay_with_the_first_branch() {
    let text = "program O1 {\nblock0:\n branch all(local.1 gt 0, local.2 gt 0) ? block1 : block2 @5..20 N10 \"BOTH\"\nblock1:\n end\nblock2:\n end\n}";
    let after = split(&module(text));
    let sites: Vec<_> = after.programs[0]
        .blocks
        .iter()
        .filter(|block| matches!(block.term.kind, TermKind::Branch { .. }))
        .map(|block| {
            (block.term.site.sequence.get(), block.term.site.comments.len(), block.term.site.span.start)
        })
        .collect();
    assert_eq!(sites, [(Some(10), 1, 5), (None, 0, 5)]);
}
