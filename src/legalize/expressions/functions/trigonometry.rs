//! TAN, ASIN, ACOS and the two-argument ATAN.

use super::emulated::{Emulated, apply, number};
use crate::canon::Func;
use crate::dialect::{Control, Question};
use crate::ir::{BinOp, Cond, Expr, Relation};
use crate::legalize::{PreStatement, Rewriter};

/// Law: `SIN[a]/COS[a]`. Off by at most two units of the last digit; at 90 degrees it divides by
/// what the control has for `COS[90]`, as the tangent itself would.
pub fn tan(a: Expr, rewriter: &mut Rewriter<'_>) -> Emulated {
    let a = rewriter.held(a);
    Emulated::Exact(Expr::binary(BinOp::Div, apply(Func::Sin, a.clone()), apply(Func::Cos, a)))
}

/// ASIN and ACOS: the target's own where their ranges agree, else by the arc tangent.
///
/// Law: `ASIN[x] = ATAN[x/SQRT[1-x*x]]` for x inside -1 and 1, `90*x` at them; `ACOS[x] = 90 - ASIN[x]`.
/// Near the ends `1-x*x` loses digits: off by at most 1e-7 degrees.
pub fn inverse(
    function: Func,
    a: Expr,
    rewriter: &mut Rewriter<'_>,
    source: &Control,
    target: &Control,
) -> Emulated {
    let question = if function == Func::Asin { Question::AsinRange } else { Question::AcosRange };
    let range = |control: &Control| control.behaviour(question).map(|b| b.value.clone()).unwrap_or_default();
    let (wanted, got) = (range(source), range(target));
    if target.function(function, 1).is_some() {
        let value = apply(function, a);
        return match (wanted.as_str(), got.as_str()) {
            (w, g) if w == g && w != "unknown" => Emulated::Exact(value),
            ("270..90", "-90..90") => Emulated::Exact(wrapped(value, rewriter)),
            ("-90..90", "270..90") => Emulated::Exact(unwrapped(value, rewriter)),
            _ => Emulated::Near(
                value,
                format!(
                    "the result's range is {wanted} on the source and {got} on \
                                               the target"
                ),
            ),
        };
    }
    let x = rewriter.held(a);
    let square = Expr::binary(BinOp::Mul, x.clone(), x.clone());
    let root = rewriter.materialize(apply(Func::Sqrt, Expr::binary(BinOp::Sub, number(1.0), square)));
    let zero = Cond::Compare(Relation::Equal, Expr::Var(root), number(0.0));
    let asin = rewriter.materialize(Expr::binary(BinOp::Mul, number(90.0), x.clone()));
    // The divisor is made 1 where it would be 0; the quotient is not used there.
    let divisor = rewriter.materialize(Expr::Var(root));
    rewriter.first(PreStatement::When(zero.clone(), divisor, number(1.0)));
    let inside = apply(Func::Atan, Expr::binary(BinOp::Div, x, Expr::Var(divisor)));
    rewriter.first(PreStatement::When(zero.negated(), asin, inside));
    let value = match function {
        Func::Asin if wanted == "270..90" => wrapped(Expr::Var(asin), rewriter),
        Func::Asin => Expr::Var(asin),
        _ => Expr::binary(BinOp::Sub, number(90.0), Expr::Var(asin)),
    };
    Emulated::Near(value, "computed by the arc tangent, with an error of at most 1e-7 degrees".into())
}

/// An angle of -90 to 90 as one of 270 to 360 and 0 to 90.
fn wrapped(angle: Expr, rewriter: &mut Rewriter<'_>) -> Expr {
    turned_where(Relation::Less, 0.0, 360.0, angle, rewriter)
}

/// An angle of 270 to 360 and 0 to 90 as one of -90 to 90.
fn unwrapped(angle: Expr, rewriter: &mut Rewriter<'_>) -> Expr {
    turned_where(Relation::Greater, 180.0, -360.0, angle, rewriter)
}

/// An angle, turned by some degrees where it stands in this relation to a limit.
fn turned_where(relation: Relation, limit: f64, by: f64, angle: Expr, rewriter: &mut Rewriter<'_>) -> Expr {
    let angle = rewriter.materialize(angle);
    let beyond = Cond::Compare(relation, Expr::Var(angle), number(limit));
    let turned = Expr::binary(BinOp::Add, Expr::Var(angle), number(by));
    rewriter.first(PreStatement::When(beyond, angle, turned));
    Expr::Var(angle)
}

/// The two-argument arc tangent: the target's own where form and range agree, else by quadrants.
///
/// Law: with q the one-argument arc tangent of y/x: q where x > 0; q+180 where x < 0; where x = 0,
/// 90 or -90 by the sign of y; where both are 0, a quotient of zeros stops the machine, as the function does. For the
/// range 0..360, 360 is added to what is negative; for -180..180, 360 is taken from what is above 180. Exact up to
/// the quotient's last digit; a direction less than that below 0 comes out as 360.
pub fn atan2(y: Expr, x: Expr, rewriter: &mut Rewriter<'_>, source: &Control, target: &Control) -> Emulated {
    let range = |control: &Control| {
        control.behaviour(Question::Atan2Range).map(|b| b.value.clone()).unwrap_or_default()
    };
    let wanted = range(source);
    if target.function(Func::Atan, 2).is_some() && wanted == range(target) && wanted.contains("..") {
        return Emulated::Exact(Expr::Call(Func::Atan, [y, x].into()));
    }
    if target.function(Func::Atan, 1).is_none() {
        return super::missing(Func::Atan.name(), target);
    }
    let (y, x) = (rewriter.held(y), rewriter.held(x));
    let compare = |relation, a: &Expr| Cond::Compare(relation, a.clone(), number(0.0));
    let divisor = rewriter.materialize(x.clone());
    rewriter.first(PreStatement::When(compare(Relation::Equal, &x), divisor, y.clone()));
    let angle =
        rewriter.materialize(apply(Func::Atan, Expr::binary(BinOp::Div, y.clone(), Expr::Var(divisor))));
    let turned = |by: f64| Expr::binary(BinOp::Add, Expr::Var(angle), number(by));
    rewriter.first(PreStatement::When(compare(Relation::Less, &x), angle, turned(180.0)));
    let upright = |relation| Cond::And(vec![compare(Relation::Equal, &x), compare(relation, &y)]);
    if x.constant().is_none_or(|x| x == 0.0) {
        rewriter.first(PreStatement::When(upright(Relation::Greater), angle, number(90.0)));
        rewriter.first(PreStatement::When(upright(Relation::Less), angle, number(-90.0)));
    }
    match wanted.as_str() {
        "0..360" => {
            rewriter.first(PreStatement::When(
                compare(Relation::Less, &Expr::Var(angle)),
                angle,
                turned(360.0),
            ));
            Emulated::Exact(Expr::Var(angle))
        }
        "-180..180" => {
            let above = Cond::Compare(Relation::Greater, Expr::Var(angle), number(180.0));
            rewriter.first(PreStatement::When(above, angle, turned(-360.0)));
            Emulated::Exact(Expr::Var(angle))
        }
        _ => {
            let above = Cond::Compare(Relation::Greater, Expr::Var(angle), number(180.0));
            rewriter.first(PreStatement::When(above, angle, turned(-360.0)));
            Emulated::Near(
                Expr::Var(angle),
                "no manual gives the range of the source's two-argument form; -180 to 180 is taken".into(),
            )
        }
    }
}
