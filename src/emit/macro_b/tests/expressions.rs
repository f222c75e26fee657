use super::*;
use crate::canon::Sys;

/// The right side of `#100=`.
fn value(dialect: &str, expr: Expr) -> String {
    line(dialect, set(100, expr)).strip_prefix("#100=").unwrap().to_owned()
}

#[test]
fn brackets_keep_the_tree_and_no_more() {
    let atan2 = || call(Func::Atan, [v(1), v(2)]);
    for (expr, text) in [
        (add(v(1), n(2.0)), "#1+2"),
        (sub(sub(v(1), v(2)), v(3)), "#1-#2-#3"),
        (sub(v(1), sub(v(2), v(3))), "#1-[#2-#3]"),
        (add(v(1), add(v(2), v(3))), "#1+[#2+#3]"),
        (mul(add(v(1), v(2)), v(3)), "[#1+#2]*#3"),
        (add(mul(v(1), v(2)), v(3)), "#1*#2+#3"),
        (mul(div(v(1), v(2)), v(3)), "#1/#2*#3"),
        (div(v(1), mul(v(2), v(3))), "#1/[#2*#3]"),
        (bin(BinOp::Mod, v(1), n(2.0)), "#1 MOD 2"),
        // Which of the two comes first no maker's text says.
        (bin(BinOp::Or, add(v(1), v(2)), v(3)), "[#1+#2] OR #3"),
        (sub(bin(BinOp::Or, v(1), n(1.0)), n(3.0)), "[#1 OR 1]-3"),
        (bin(BinOp::Xor, v(1), sub(n(1.0), n(3.0))), "#1 XOR [1-3]"),
        (mul(v(1), bin(BinOp::And, v(2), n(7.0))), "#1*[#2 AND 7]"),
        (bin(BinOp::Mod, mul(v(1), v(2)), n(7.0)), "[#1*#2] MOD 7"),
        (add(v(1), bin(BinOp::Mod, v(2), n(7.0))), "#1+[#2 MOD 7]"),
        (bin(BinOp::Or, bin(BinOp::Or, v(1), v(2)), v(3)), "#1 OR #2 OR #3"),
        (bin(BinOp::And, add(v(1), v(2)), n(7.0)), "[#1+#2] AND 7"),
        (neg(v(1)), "-#1"),
        (neg(neg(v(1))), "-[-#1]"),
        (neg(neg(neg(v(1)))), "-[-[-#1]]"),
        (neg(add(v(1), v(2))), "-[#1+#2]"),
        (add(neg(v(1)), v(2)), "-#1+#2"),
        (mul(neg(v(1)), v(2)), "[-#1]*#2"),
        (mul(v(1), neg(v(2))), "#1*[-#2]"),
        (sub(v(1), neg(v(2))), "#1-[-#2]"),
        (bin(BinOp::Or, neg(v(1)), v(2)), "[-#1] OR #2"),
        (mul(add(neg(v(1)), v(2)), v(3)), "[-#1+#2]*#3"),
        (n(-5.0), "-5"),
        (mul(v(1), n(-2.0)), "#1*[-2]"),
        (add(n(-5.0), v(1)), "-5+#1"),
        (sub(v(1), n(-5.0)), "#1+5"),
        (mul(add(v(1), n(-5.0)), v(2)), "[#1-5]*#2"),
        (sub(v(1), add(v(2), n(-5.0))), "#1-[#2-5]"),
        (neg(n(-5.0)), "-[-5]"),
        (n(-0.0), "-0"),
        (call(Func::Sin, [neg(v(1))]), "SIN[-#1]"),
        (neg(call(Func::Sin, [v(1)])), "-SIN[#1]"),
        (mul(call(Func::Fix, [div(v(1), n(2.0))]), n(2.0)), "FIX[#1/2]*2"),
        (atan2(), "ATAN[#1]/[#2]"),
        (div(atan2(), v(3)), "[ATAN[#1]/[#2]]/#3"),
        (add(atan2(), v(3)), "[ATAN[#1]/[#2]]+#3"),
        (neg(atan2()), "-[ATAN[#1]/[#2]]"),
        (call(Func::Abs, [atan2()]), "ABS[ATAN[#1]/[#2]]"),
        (div(call(Func::Atan, [n(1.0)]), n(10.0)), "[ATAN[1]]/10"),
        (add(call(Func::Atan, [v(1)]), n(10.0)), "ATAN[#1]+10"),
        (call(Func::Pow, [add(v(1), v(2)), n(2.0)]), "POW[#1+#2,2]"),
        (indirect(v(1)), "#[#1]"),
        (indirect(indirect(add(v(1), n(1.0)))), "#[#[#1+1]]"),
        (neg(indirect(v(1))), "-#[#1]"),
        (Expr::Vacant, "#0"),
    ] {
        assert_eq!(value("fanuc", expr), text);
    }
}

#[test]
fn an_operator_whose_rank_nobody_states_shares_no_bracket() {
    for (expr, text) in [
        (add(bin(BinOp::Mod, v(1), v(2)), n(1.0)), "[#1 MOD #2]+1"),
        (bin(BinOp::Mod, add(v(1), v(2)), v(3)), "[#1+#2] MOD #3"),
        (bin(BinOp::Or, bin(BinOp::Or, v(1), v(2)), v(3)), "[#1 OR #2] OR #3"),
    ] {
        assert_eq!(value("haas", expr), text);
    }
}

#[test]
fn a_comparison_is_a_value_where_the_control_says_so() {
    let truth = || Expr::Truth(Box::new(gt(4, 9.2)));
    assert_eq!(value("haas", truth()), "[#4 GT 9.2]");
    assert_eq!(value("haas", add(truth(), n(1.0))), "[#4 GT 9.2]+1");
    assert_eq!(refused("fanuc", &one([set(1, truth())])), [Code::Unmapped]);
}

#[test]
fn state_stands_at_the_number_of_its_subscripts() {
    let state = |sys, subscripts: &[Expr]| Expr::System(sys, subscripts.into());
    for (expr, text) in [
        (state(Sys::WorkPosition, &[n(1.0)]), "#5041"),
        (state(Sys::EndPosition, &[n(2.0)]), "#5002"),
        (state(Sys::Pi, &[]), "#3101"),
        (state(Sys::WorkOffset, &[n(2.0), n(1.0)]), "#5241"),
        (state(Sys::WorkOffset, &[n(101.0), n(3.0)]), "#7003"),
        (state(Sys::WorkPosition, &[v(1)]), "#[5040+#1]"),
        (state(Sys::WorkOffset, &[v(1), n(2.0)]), "#[5202+20*#1]"),
        (state(Sys::WorkOffset, &[add(v(1), n(1.0)), v(2)]), "#[5200+20*[#1+1]+#2]"),
        (state(Sys::Input, &[v(1)]), "#[1000+#1]"),
    ] {
        assert_eq!(value("fanuc", expr), text);
    }
    assert_eq!(refused("fanuc", &one([set(1, state(Sys::WorkOffset, &[n(9.0), n(1.0)]))])), [Code::Unmapped]);
    assert_eq!(refused("fanuc", &one([set(1, state(Sys::ToolTimeUsed, &[n(1.0)]))])), [Code::Unmapped]);
}

#[test]
fn digits_are_those_that_the_control_takes() {
    // Seed 001: eight digits, the zero before the point counts.
    assert_eq!(value("fanuc", n(12345678.0)), "12345678");
    assert_eq!(value("fanuc", n(1234.5678)), "1234.5678");
    assert_eq!(value("fanuc", n(0.1234567)), "0.1234567");
    assert_eq!(value("fanuc", n(0.12345678)), ".12345678");
    assert_eq!(value("fanuc", n(-0.12345678)), "-.12345678");
    assert_eq!(refused("fanuc", &one([set(1, n(12345.6789))])), [Code::NumberTooLong]);
    assert_eq!(refused("fanuc", &one([set(1, n(1e-9))])), [Code::NumberTooLong]);
    assert_eq!(value("haas", n(1e-9)), "0.000000001");
    assert_eq!(refused("haas", &one([set(1, n(f64::INFINITY))])), [Code::Unmapped]);
}

#[test]
fn brackets_nest_as_deep_as_the_control_allows() {
    let nested = |depth: u32| (0..depth).fold(v(1), |inner, _| call(Func::Sin, [inner]));
    assert_eq!(value("fanuc", nested(5)), "SIN[SIN[SIN[SIN[SIN[#1]]]]]");
    assert_eq!(refused("fanuc", &one([set(1, nested(6))])), [Code::NestsTooDeep]);
    assert_eq!(value("haas", nested(7)), "SIN[SIN[SIN[SIN[SIN[SIN[SIN[#1]]]]]]]");
    // Far past any control: an error, no overflow.
    assert!(refused("haas", &one([set(1, nested(5000))])).contains(&Code::Unmapped));
    let long = (0..5000).fold(v(1), |sum, _| add(sum, v(2)));
    assert!(refused("haas", &one([set(1, long)])).contains(&Code::Unmapped));
}

#[test]
fn what_has_no_row_is_refused() {
    for kind in [
        set(1, call(Func::RoundPlaces, [v(1), n(2.0)])),
        set(1, Expr::Increments(5.0)),
        set(1, Expr::Indirect(Bank::Global, Box::new(v(1)))),
        set(1, call(Func::RoundIncrement, [v(1)])),
    ] {
        assert_eq!(refused("fanuc", &one([kind])), [Code::Unmapped]);
    }
    let no_register = set(1, Expr::Var(Var { class: Class::Global, number: 1 }));
    assert_eq!(refused("fanuc", &one([no_register])), [Code::OutOfRegisters]);
    assert_eq!(refused("haas", &one([set(1, call(Func::Fup, [v(1)]))])), [Code::Unmapped]);
}
