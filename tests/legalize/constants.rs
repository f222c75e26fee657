//! Constants longer than the target takes.

use crate::harness::{control, expressions, legalized, program, result};
use macroglot::diag::Code;
use macroglot::ir::Expr;

/// Digits as the control counts them (seed 001: 0.12345678 has nine).
fn digits(value: f64) -> usize {
    format!("{}", value.abs()).bytes().filter(u8::is_ascii_digit).count()
}

#[test]
fn sums_of_short_ones_give_the_value_or_say_what() {
    let target = control("fanuc");
    assert_eq!(target.numbers().digits, Some(8), "seed 001: eight digits");
    let values = [
        1e-9,
        0.4999999,
        99_999_999.0,
        100_000_000.0,
        123_456_789.0,
        0.123456789,
        0.01745329252,
        -57.29577951,
        std::f64::consts::PI,
        1e15,
        1e-15,
        0.1 + 0.2,
        -0.000012345678901,
        9_876_543_210.125,
        1e22,
        12345.6789,
    ];
    for value in values {
        let before = program(&format!(" global.9 = {value}"));
        let (after, found) = legalized("constants", &before, &control("fadal"), &target);
        let long = digits(value) > 8;
        for e in expressions(&after) {
            if let Expr::Number(n) = e {
                assert!(digits(*n) <= 8, "{value}: {n} is left\n{after}");
            }
        }
        let made = result(&after, &[]).unwrap();
        let codes: Vec<Code> = found.iter().map(|finding| finding.code).collect();
        if made == value {
            assert_eq!(codes, [], "{value}");
        } else {
            // The finding says what it became.
            assert!(long && (made - value).abs() <= 4.0 * f64::EPSILON * value.abs(), "{value} {made}");
            assert_eq!(codes, [Code::NearlyEqual], "{value} {made}");
            assert!(found[0].message.contains(&format!("{made}")), "{}", found[0].message);
        }
        if !long {
            assert_eq!(before, after);
        }
    }
}

#[test]
fn a_long_constant_in_a_word_is_computed_before_the_block() {
    let before = program(" nc motion.linear axis.x=123.456789012 axis.y=1.5");
    let (after, _) = legalized("constants", &before, &control("fadal"), &control("fanuc"));
    let block = &after.programs[0].blocks[0];
    assert_eq!(block.stmts.len(), 2, "{after}");
    assert_eq!(block.stmts[1].kind.to_string(), "nc motion.linear axis.x=tmp.1 axis.y=1.5");
}
