//! Values come from the makers' texts (`corpus`) and from arithmetic on paper.

use super::*;
use crate::ir::{Class, Var};

fn call(func: Func, arguments: &[f64]) -> Result<f64, Alarm> {
    function(func, arguments, &Memory::new())
}

#[test]
fn whole_numbers() {
    // FIX and FUP of -1.2 are the maker's; the halves follow from "away from zero".
    for (func, x, result) in [
        (Func::Fix, -1.2, -1.0),
        (Func::Fix, 2.8, 2.0),
        (Func::Fix, -2.8, -2.0),
        (Func::Fup, -1.2, -2.0),
        (Func::Fup, 1.2, 2.0),
        (Func::Fup, 1e-9, 1.0),
        (Func::Round, 0.5, 1.0),
        (Func::Round, -0.5, -1.0),
        (Func::Round, 2.5, 3.0),
        (Func::Round, 0.4999999, 0.0),
        (Func::Round, 1.5, 2.0),
        (Func::Sign, 0.0, 1.0),
        (Func::Sign, -0.5, -1.0),
        (Func::Abs, -7.5, 7.5),
    ] {
        assert_eq!(call(func, &[x]), Ok(result), "{func} of {x}");
    }
    assert_eq!(call(Func::RoundPlaces, &[1.2345, 2.0]), Ok(1.23));
}

#[test]
fn remainder_rounds_first_and_takes_the_dividends_sign() {
    // 7.5 becomes 8; 27 MOD 20 is the makers' example.
    for (a, b, result) in [(7.5, 2.0, 0.0), (27.0, 20.0, 7.0), (-7.0, 3.0, -1.0), (7.0, -3.0, 1.0)] {
        assert_eq!(binary(BinOp::Mod, a, b), Ok(result));
    }
    assert_eq!(binary(BinOp::Mod, 1.0, 0.4), Err(Alarm::DivideByZero));
}

#[test]
fn bits_of_rounded_operands() {
    assert_eq!(binary(BinOp::And, 12.0, 10.0), Ok(8.0));
    assert_eq!(binary(BinOp::Or, 12.0, 3.4), Ok(15.0));
    assert_eq!(binary(BinOp::Xor, 12.0, 9.5), Ok(6.0)); // 12 xor 10
    assert_eq!(binary(BinOp::And, -1.0, 255.0), Ok(255.0));
    assert_eq!(binary(BinOp::And, 4e9, 1.0), Err(Alarm::Bits));
}

#[test]
fn angles_are_degrees() {
    for (func, x, result) in [
        (Func::Sin, 30.0, 0.5),
        (Func::Sin, -30.0, -0.5),
        (Func::Sin, 390.0, 0.5),
        (Func::Sin, 180.0, 0.0),
        (Func::Cos, 60.0, 0.5),
        (Func::Cos, -90.0, 0.0),
        (Func::Cos, 180.0, -1.0),
        (Func::Tan, 45.0, 1.0),
        (Func::Tan, 135.0, -1.0),
        (Func::Asin, 0.5, 30.0),
        (Func::Asin, -1.0, -90.0),
        (Func::Acos, -1.0, 180.0),
        (Func::Acos, 0.5, 60.0),
        (Func::Acos, 0.0, 90.0),
        (Func::Atan, -1.0, -45.0),
        (Func::Atan, 0.0, 0.0),
    ] {
        assert_eq!(call(func, &[x]), Ok(result), "{func} of {x}");
    }
    // sin 20 and tan 20, from a printed table.
    assert!((call(Func::Sin, &[20.0]).unwrap() - 0.342_020_143_325_668_7).abs() < 1e-15);
    assert!((call(Func::Tan, &[20.0]).unwrap() - 0.363_970_234_266_202_4).abs() < 1e-15);
}

#[test]
fn arc_tangent_of_two_arguments() {
    // The maker's example: -1 and -1 give 225, or -135.
    let mut env = Memory::new();
    assert_eq!(function(Func::Atan, &[-1.0, -1.0], &env), Ok(225.0));
    assert_eq!(function(Func::Atan, &[0.0, -1.0], &env), Ok(180.0));
    assert_eq!(function(Func::Atan, &[-0.0, -1.0], &env), Ok(180.0));
    assert_eq!(function(Func::Atan, &[-1.0, 0.0], &env), Ok(270.0));
    assert_eq!(function(Func::Atan, &[-1e-30, 1.0], &env), Ok(0.0));
    env.atan = AtanRange::Signed;
    assert_eq!(function(Func::Atan, &[-1.0, -1.0], &env), Ok(-135.0));
    assert_eq!(function(Func::Atan, &[0.0, 0.0], &env), Err(Alarm::Domain(Func::Atan)));
}

#[test]
fn outside_the_domain_is_an_alarm() {
    for (func, arguments) in [
        (Func::Sqrt, &[-1e-9][..]),
        (Func::Asin, &[1.5]),
        (Func::Acos, &[-1.5]),
        (Func::Ln, &[0.0]),
        (Func::Tan, &[90.0]),
        (Func::Tan, &[-90.0]),
        (Func::Pow, &[-8.0, 0.5]),
        (Func::Pow, &[0.0, -1.0]),
        (Func::Bin, &[10.0]),
        (Func::Bcd, &[-1.0]),
    ] {
        assert_eq!(call(func, arguments), Err(Alarm::Domain(func)));
    }
    assert_eq!(call(Func::Exp, &[1e9]), Err(Alarm::Overflow));
    assert_eq!(call(Func::Sin, &[]), Err(Alarm::Arity(Func::Sin)));
    assert_eq!(binary(BinOp::Div, 1.0, -0.0), Err(Alarm::DivideByZero));
}

#[test]
fn binary_coded_decimal() {
    assert_eq!(call(Func::Bcd, &[12.0]), Ok(18.0)); // 0x12
    assert_eq!(call(Func::Bin, &[18.0]), Ok(12.0));
    assert_eq!(call(Func::Bcd, &[99_999_999.0]), Ok(2_576_980_377.0)); // 0x9999_9999
}

#[test]
fn vacancy() {
    let vacant = Expr::Var(Var { class: Class::Local, number: 1 });
    let env = Memory::new();
    let cond = |relation, b: Expr| holds(&Cond::Compare(relation, vacant.clone(), b), &env);
    assert_eq!(eval(&vacant, &env), Ok(None));
    assert_eq!(cond(Relation::Equal, Expr::Vacant), Ok(true));
    assert_eq!(cond(Relation::Equal, Expr::Number(0.0)), Ok(false));
    assert_eq!(cond(Relation::NotEqual, Expr::Number(0.0)), Ok(true));
    assert_eq!(cond(Relation::GreaterEqual, Expr::Number(0.0)), Ok(true));
    assert_eq!(cond(Relation::Less, Expr::Number(0.0)), Ok(false));
    assert_eq!(eval(&Expr::Negate(Box::new(vacant.clone())), &env), Ok(Some(-0.0)));
    let temp = Expr::Var(Var { class: Class::Temp, number: 1 });
    assert_eq!(eval(&temp, &env), Ok(Some(0.0)));
}

#[test]
fn deep_nesting_is_an_alarm() {
    let mut expr = Expr::Number(1.0);
    (0..MAX_DEPTH).for_each(|_| expr = Expr::Negate(Box::new(expr.clone())));
    assert_eq!(eval(&expr, &Memory::new()), Err(Alarm::Depth));
}

/// Runs the first program of a text.
fn trace(text: &str, memory: &mut Memory, answers: &[f64]) -> Trace {
    let module = crate::ir::text::parse(text).unwrap();
    run(&module, 0, memory, answers, 1000)
}

#[test]
fn runs_loops_calls_and_levels() {
    let text =
        "program O1 {\nblock0:\n local.1 = 7\n tmp.1 = 5\n call O2 level (1: 2, 3: vacant) times 2 -> block1
block1:\n nc motion.linear axis.x=local.1 axis.y=local.9 feed=tmp.1\n input global.5\n call block3 -> block2
block2:\n alarm 3 \"DONE\"\n end\nblock3:\n local.1 = local.1 * global.5\n return\n}
program O2 {\nblock0:\n tmp.1 = 1\n common.100 = common.100 + local.1\n local.1 = local.1 + 1
 branch local.3 eq vacant ? block1 : block2\nblock1:\n return\nblock2:\n stray\n}\n";
    let mut memory = Memory::new();
    let done = trace(text, &mut memory, &[3.0]);
    // Arguments are not loaded again for the second run: 2, then 3.
    assert_eq!(done.events, ["nc motion.linear axis.x=7 feed=5", "alarm 3 DONE"]);
    assert_eq!(done.ending, Ending::Stopped);
    assert_eq!(memory.var(Var { class: Class::Common, number: 100 }), Some(5.0));
    assert_eq!(memory.var(Var { class: Class::Local, number: 1 }), Some(21.0));
}

#[test]
fn runs_are_bounded() {
    let ending = |body: &str| trace(&format!("program O1 {{\n{body}\n}}"), &mut Memory::new(), &[]).ending;
    assert_eq!(ending("block0:\n jump block0"), Ending::Steps);
    assert!(matches!(ending("block0:\n call O1 level -> block0"), Ending::Unsupported(_)));
    assert_eq!(ending("block0:\n local.1 = sqrt(-1)\n end"), Ending::Alarm(Alarm::Domain(Func::Sqrt)));
    assert_eq!(ending("block0:\n computed 7 {}"), Ending::Alarm(Alarm::Variable));
}
