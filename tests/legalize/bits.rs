//! Bits of whole numbers by arithmetic: each operation over numbers and constants, beside the machine's own.

use crate::harness::{control, expressions, legalized, program, result};
use macroglot::diag::Code;
use macroglot::ir::{BinOp, Expr};

type Operation = fn(i32, i32) -> i32;

const OPERATIONS: [(&str, Operation); 3] =
    [("and", |a, b| a & b), ("or", |a, b| a | b), ("xor", |a, b| a ^ b)];

#[test]
fn bits_of_a_constant() {
    for (name, operation) in OPERATIONS {
        for mask in [0, 1, 2, 3, 8, 15, 128, 255, 0x4000_0001, 0x0101_0101] {
            let module = program(&format!(" global.9 = local.1 {name} {mask}"));
            let (module, found) = legalized("functions", &module, &control("haas"), &control("fadal"));
            let codes: Vec<Code> = found.iter().map(|finding| finding.code).collect();
            assert_eq!(codes, [Code::NearlyEqual], "{name} {mask}");
            let left = |e: &&Expr| matches!(e, Expr::Binary(BinOp::And | BinOp::Or | BinOp::Xor, _));
            assert!(!expressions(&module).iter().any(left), "{module}");
            let ends = [1023, 65_535, 65_536, 0x3FFF_FFFF, 0x7FFF_FFFE, i32::MAX, i32::MIN, -65_536];
            for a in (-300..=300).chain(ends) {
                let wanted = f64::from(operation(a, mask));
                assert_eq!(result(&module, &[Some(f64::from(a))]), Some(wanted), "{a} {name} {mask}");
            }
        }
    }
}

#[test]
fn bits_of_two_numbers() {
    let ends = [1023, 65_535, 65_536, 0x3FFF_FFFF, 0x7FFF_FFFE, i32::MAX, i32::MIN, -65_536];
    let all: Vec<i32> = (-40..=40).chain(ends).collect();
    for (name, operation) in OPERATIONS {
        let module = program(&format!(" global.9 = local.1 {name} local.2"));
        let (module, found) = legalized("functions", &module, &control("haas"), &control("fadal"));
        let codes: Vec<Code> = found.iter().map(|finding| finding.code).collect();
        assert_eq!(codes, [Code::NearlyEqual], "{name}");
        for (a, b) in all.iter().flat_map(|a| all.iter().map(move |b| (*a, *b))) {
            let wanted = f64::from(operation(a, b));
            let given = [Some(f64::from(a)), Some(f64::from(b))];
            assert_eq!(result(&module, &given), Some(wanted), "{a} {name} {b}");
        }
    }
}

#[test]
fn what_arithmetic_does_not_give_is_refused() {
    for expr in ["local.1 or 511", "local.1 xor -1", "local.1 and 2147483648"] {
        let module = program(&format!(" global.9 = {expr}"));
        let (_, found) = legalized("functions", &module, &control("haas"), &control("fadal"));
        assert!(found.iter().any(|finding| finding.code == Code::NoEquivalent), "{expr}");
    }
}
