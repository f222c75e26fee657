//! Functions that the target lacks, by arithmetic that it has.
//!
//! Each file holds one group: its law, its domain and how far off it may be.
//! A function without an emulation is an error; one whose emulation is off by
//! more than the last digit of binary64 brings a review diagnostic with its bound.

mod angles;
mod bits;
mod decimal;
mod emulated;
mod exponential;
mod modulo;
mod rounding;
mod trigonometry;
mod whole;

use crate::assume::Predicate;
use crate::canon::Func;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{BinOp, Expr, Program};
use crate::legalize::{Context, Rewriter, rewrite_program};
use emulated::{Emulated, missing};
use thin_vec::ThinVec;
pub use whole::of_magnitudes_only;

/// Replaces the functions that the target lacks.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let mut found = Vec::new();
    let (source, target) = (context.source, context.target);
    let changed = rewrite_program(program, is_function, &mut |e, _, rewriter| {
        let span = rewriter.span;
        let (name, function, emulated) = match e {
            Expr::Call(function, arguments) => {
                let own = target.function(function, arguments.len()).is_some();
                let emulated = call(function, arguments, rewriter, source, target);
                (function.name(), Some(function).filter(|_| !own), emulated)
            }
            Expr::Binary(BinOp::Mod, operands) if !modulo::is_native(&operands, target) => {
                let [a, b] = *operands;
                ("mod", None, modulo::by_division(a, b, rewriter, target))
            }
            Expr::Binary(op @ (BinOp::And | BinOp::Or | BinOp::Xor), operands) => {
                let [a, b] = *operands;
                ("bits", None, bits::bits(op, a, b, rewriter, target))
            }
            other => return other,
        };
        if let Some(least) = target.numbers().least
            && matches!(function, Some(Func::Exp | Func::Ln | Func::Pow))
            && !matches!(emulated, Emulated::Missing(_))
        {
            let what =
                format!("{name}: values in between may be smaller than {least}, which the target may refuse");
            found.push((Code::Conditional, span, what, None));
        }
        match emulated {
            Emulated::Exact(value) => value,
            Emulated::Near(value, why) => {
                found.push((Code::NearlyEqual, span, format!("{name}: {why}"), None));
                value
            }
            Emulated::Inside(value, why, domain) => {
                let inside = function.map(|function| (function, domain));
                found.push((Code::NearlyEqual, span, format!("{name}: {why}"), inside));
                value
            }
            Emulated::Missing(why) => {
                found.push((Code::NoEquivalent, span, why, None));
                Expr::Number(0.0)
            }
        }
    });
    // Emulations bring in angles, and both bring in whole parts.
    let turned = angles::run(program, target);
    let changed = whole::run(program, target) || turned || changed;
    for (code, span, message, inside) in &found {
        let finding = Diagnostic::new(*code, *span, message.clone());
        let finding = match *inside {
            Some((function, domain)) => {
                let alike = found.iter().filter(|(.., other)| other == inside).map(|(_, span, ..)| *span);
                finding.assuming(Predicate::Arguments { function, places: alike.collect(), domain })
            }
            None => finding,
        };
        context.add_once(index, &format!("{}{message}", code.number()), finding);
    }
    changed
}

/// True for what this is about.
fn is_function(e: &Expr) -> bool {
    use BinOp::{And, Mod, Or, Xor};
    matches!(e, Expr::Call(..) | Expr::Binary(Mod | And | Or | Xor, ..))
}

fn call(
    function: Func,
    mut arguments: ThinVec<Expr>,
    rewriter: &mut Rewriter<'_>,
    source: &Control,
    target: &Control,
) -> Emulated {
    let keep = target.function(function, arguments.len()).is_some();
    let second = if arguments.len() > 1 { arguments.pop() } else { None };
    let Some(first) = arguments.pop() else { return missing(function.name(), target) };
    match (function, second) {
        // ROUND inside a word is another function on these controls: it stands alone.
        (Func::Round, None) if rewriter.in_word && keep => {
            Emulated::Exact(rounding::nearest(first, rewriter, target))
        }
        (Func::RoundIncrement, None)
            if target.behaviour(Question::RoundInAddress).is_some_and(|b| b.value == "increment") =>
        {
            Emulated::Exact(Expr::Call(function, [first].into()))
        }
        (Func::Atan, Some(second)) => trigonometry::atan2(first, second, rewriter, source, target),
        (Func::Asin | Func::Acos, None) => trigonometry::inverse(function, first, rewriter, source, target),
        (_, second) if keep => {
            Emulated::Exact(Expr::Call(function, [Some(first), second].into_iter().flatten().collect()))
        }
        (Func::Round | Func::Fup | Func::Bcd | Func::Bin, None)
            if target.function(Func::Fix, 1).is_none() =>
        {
            missing(function.name(), target)
        }
        (Func::Round, None) => Emulated::Exact(rounding::nearest(first, rewriter, target)),
        (Func::Abs, None) => Emulated::Exact(whole::magnitude(first, rewriter)),
        (Func::Tan, None) => trigonometry::tan(first, rewriter),
        (Func::Sign, None) => rounding::sign(first, rewriter),
        (Func::Fup, None) => rounding::fup(first, rewriter),
        (Func::RoundPlaces, Some(places)) => rounding::round_places(first, &places, rewriter, target),
        (Func::Bcd, None) => decimal::bcd(first, rewriter),
        (Func::Bin, None) => decimal::bin(first, rewriter),
        (Func::Exp, None) => exponential::exp(first, rewriter),
        (Func::Ln, None) => exponential::ln(first, rewriter),
        (Func::Pow, Some(power)) => exponential::pow(first, power, rewriter, target),
        _ => missing(function.name(), target),
    }
}
