//! Operands that a target does not take where they stand.

use crate::harness::{DOMAIN, control, legalized, observe, program};
use macroglot::ir::{Expr, Module, StmtKind, TermKind};

/// What expressions are made of.
const PIECES: [&str; 8] = [
    "abs(@)",
    "(@ + 3)",
    "(2 - @)",
    "(@ * local.2)",
    "sin(@) / 2",
    "(local.2 - @ * @)",
    "-(@)",
    "#[fix(abs(@)) mod 2 + 1]",
];

/// An expression of pieces inside one another, picked by the digits of a number.
fn nested(mut pick: usize, depth: usize) -> String {
    let mut text = "local.1".to_owned();
    for _ in 0..depth {
        text = PIECES[pick % PIECES.len()].replace('@', &text);
        pick /= 3;
    }
    text
}

fn is_variable(e: &Expr) -> bool {
    matches!(e, Expr::Var(_))
}

fn is_literal(e: &Expr) -> bool {
    matches!(e, Expr::Number(_))
}

/// One step, as the quick reference of seed 004 (lines 1631 to 1642) lists them.
fn is_step(e: &Expr) -> bool {
    match e {
        Expr::Binary(_, operands) => {
            is_variable(&operands[0]) && (is_variable(&operands[1]) || is_literal(&operands[1]))
        }
        Expr::Call(_, arguments) => arguments.iter().all(is_variable),
        // No such thing is there at all: it is refused later.
        Expr::Indirect(_, number) => is_variable(number) || is_literal(number),
        e => is_variable(e) || is_literal(e),
    }
}

fn steps(module: &Module) -> impl Iterator<Item = &Expr> {
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    stmts.filter_map(|stmt| match &stmt.kind {
        StmtKind::Assign { value, .. } => Some(value),
        _ => None,
    })
}

fn same(before: &Module, after: &Module) {
    for a in DOMAIN {
        for b in [None, Some(0.0), Some(-1.5), Some(2.0)] {
            let [was, is] = [before, after].map(|module| observe(module, &[a, b], &[]).1);
            assert_eq!(was, is, "{before}\n{after}");
        }
    }
}

#[test]
fn one_step_an_assignment_computes_the_same() {
    let (source, target) = (control("fanuc"), control("cc100"));
    for pick in 0..300 {
        let before = program(&format!(" global.9 = {}", nested(pick * 41 + 7, 4)));
        let (after, found) = legalized("operands", &before, &source, &target);
        assert!(found.is_empty());
        assert!(steps(&after).all(is_step), "{after}");
        same(&before, &after);
    }
}

#[test]
fn a_comparison_with_0_goes_the_same_way() {
    let (source, target) = (control("fadal"), control("cc100"));
    for relation in ["eq", "ne", "lt", "le", "gt", "ge"] {
        for pick in 0..30 {
            let e = nested(pick * 41 + 7, 2);
            let before = program(&format!(
                " global.9 = 1\n branch 2 {relation} {e} + 0 ? block1 : block2\nblock1:\n global.9 = 2\n end\nblock2:\n"
            ));
            let (after, _) = legalized("operands", &before, &source, &target);
            for block in &after.programs[0].blocks {
                if let TermKind::Branch { cond, .. } = &block.term.kind
                    && let macroglot::ir::Cond::Compare(_, a, b) = &**cond
                {
                    assert!(is_variable(a) && *b == Expr::Number(0.0), "{after}");
                }
            }
            assert!(steps(&after).all(is_step), "{after}");
            same(&before, &after);
        }
    }
}
