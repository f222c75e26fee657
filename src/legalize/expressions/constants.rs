//! Constants with more digits than the target takes.
//!
//! Law: a constant of up to sixteen digits is `(a + b/10^8) * 10^k` with a and b of eight digits each. The arithmetic rounds
//! twice more than the constant itself; where the result is another number of binary64, that is a review diagnostic.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Machine;
use crate::ir::{BinOp, Expr, Program};
use crate::legalize::features::is_long;
use crate::legalize::{Context, Position, rewrite_program};

/// Splits constants that are too long.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let Some(most) = context.target.numbers().digits.filter(|most| *most >= 8) else { return false };
    let mut changed = false;
    let (mut found, mut short) = (Vec::new(), Vec::new());
    let lathe = context.target.machine() == Machine::Lathe;
    rewrite_program(program, |e| matches!(e, Expr::Number(_)), &mut |e, position, rewriter| match e {
        Expr::Number(value)
            if is_long(value) && digits(value) > most && !matches!(position, Position::Argument(_)) =>
        {
            changed = true;
            // A place of a lathe may be one of a contour, which has only moves; and no cut is that fine.
            if let Position::Word(role) = position
                && lathe
                && role.is_length()
                && let Some(made) = shortened(value, most)
            {
                short.push((rewriter.span, value, made));
                return Expr::Number(made);
            }
            let (split, made) = split(value);
            // What a word says is compared with nothing: its last digits are no matter.
            let word = matches!(position, Position::Word(_));
            if made != value && !(word && (made - value).abs() <= value.abs() * 4.0 * f64::EPSILON) {
                found.push((rewriter.span, value, made));
            }
            // A word takes an expression only in brackets; a temporary reads better.
            if matches!(position, Position::Word(_)) { Expr::Var(rewriter.materialize(split)) } else { split }
        }
        other => other,
    });
    for (span, value, made) in short {
        let what = format!("the target takes {most} digits: {value} becomes {made}");
        context.add(index, Diagnostic::new(Code::NearlyEqual, span, what));
    }
    for (span, value, made) in found {
        let what = format!("the target takes {most} digits: {value} becomes a sum that gives {made}");
        context.add(index, Diagnostic::new(Code::NearlyEqual, span, what));
    }
    changed
}

/// Digits that the constant is written with, the zero before the point included.
fn digits(value: f64) -> u32 {
    format!("{}", value.abs()).bytes().filter(u8::is_ascii_digit).count() as u32
}

/// The number rounded to so many digits, unless fewer than five of them would stand after the point.
fn shortened(value: f64, most: u32) -> Option<f64> {
    let whole = value.abs().max(1.0).log10().floor() as u32 + 1;
    let places = most.checked_sub(whole).filter(|places| *places >= 5)?;
    let scale = 10f64.powi(places as i32);
    Some((value * scale).round() / scale)
}

/// The constant as a sum of two of eight digits, scaled; and what it evaluates to.
fn split(value: f64) -> (Expr, f64) {
    let text = format!("{:.15e}", value.abs());
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let digits: String = mantissa.bytes().filter(u8::is_ascii_digit).map(char::from).collect();
    let part = |from: usize| digits.get(from..from + 8).and_then(|d| d.parse::<f64>().ok()).unwrap_or(0.0);
    let number = |n: f64| Expr::Number(n);
    let op = |op, a, b| Expr::binary(op, a, b);
    let (a, b) = (part(0), part(8));
    let mut sum = number(a);
    let mut made = a;
    if b != 0.0 {
        // 10^8 itself has nine digits.
        sum = op(BinOp::Add, sum, op(BinOp::Div, op(BinOp::Div, number(b), number(1e4)), number(1e4)));
        made = a + b / 1e4 / 1e4;
    }
    let mut scale = exponent - 7;
    while scale != 0 {
        let step = scale.clamp(-7, 7);
        let factor = 10f64.powi(step.abs());
        if step < 0 {
            (sum, made) = (op(BinOp::Div, sum, number(factor)), made / factor);
        } else {
            (sum, made) = (op(BinOp::Mul, sum, number(factor)), made * factor);
        }
        scale -= step;
    }
    if value < 0.0 { (Expr::Negate(Box::new(sum)), -made) } else { (sum, made) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splits_stay_within_the_last_digit() {
        for value in
            [0.017453292519943295, 57.29577951308232, 7.139407583615936, -123456.789012, 1e-9, 9.87654321e12]
        {
            let (_, made) = split(value);
            assert!((made - value).abs() <= value.abs() * 4.0 * f64::EPSILON, "{value} {made}");
        }
    }

    #[test]
    fn places_lose_what_the_target_has_no_digit_for() {
        assert_eq!(shortened(0.42928932, 8), Some(0.4292893));
        assert_eq!(shortened(-12.42928937, 8), Some(-12.429289));
        assert_eq!(shortened(1234.56789, 8), None);
    }

    #[test]
    fn digits_count_the_leading_zero() {
        // Seed 001: 0.12345678 is nine digits, 1234.5678 eight.
        assert_eq!((digits(0.12345678), digits(1234.5678), digits(12345678.0)), (9, 8, 8));
    }
}
