use super::{Numbers, Ranges, Values, evaluate};
use crate::canon::Func;
use crate::ir::analysis::Summaries;
use crate::ir::eval::{self, Memory};
use crate::ir::text::parse;
use crate::ir::{BinOp, Class, Expr, Place, Program, StmtKind, Var};

/// Operands of every kind: sets of few, bounds of whole numbers and of any.
fn sets() -> Vec<(Values, Vec<f64>)> {
    let halves = |low: i32, high: i32| (low..=high).map(|n| f64::from(n) / 2.0).collect::<Vec<_>>();
    let wholes = |low: i32, high: i32| (low..=high).map(f64::from).collect::<Vec<_>>();
    let mut sets = Vec::new();
    for (low, high) in [(-3, -1), (-2, 0), (-2, 2), (0, 0), (0, 3), (1, 4), (3, 3)] {
        let (first, last) = (f64::from(low), f64::from(high));
        sets.push((Values::of(wholes(low, high)), wholes(low, high)));
        sets.push((Values::whole(first, last), wholes(low, high)));
        sets.push((Values::Between { low: first, high: last, whole: false }, halves(2 * low, 2 * high)));
        sets.push((Values::of(halves(2 * low, 2 * high)), halves(2 * low, 2 * high)));
    }
    sets
}

const A: Var = Var { class: Class::Local, number: 1 };
const B: Var = Var { class: Class::Local, number: 2 };

fn has(values: &Values, value: f64) -> bool {
    values.contains(value)
}

#[test]
fn arithmetic_gives_all_that_it_may_give() {
    use BinOp::{Add, And, Div, Mod, Mul, Or, Sub, Xor};
    for op in [Add, Sub, Mul, Div, Mod, And, Or, Xor] {
        for (a, each_a) in sets() {
            for (b, each_b) in sets() {
                let expr = Expr::binary(op, Expr::Var(A), Expr::Var(B));
                let found = evaluate(&expr, &|var| if var == A { a.clone() } else { b.clone() });
                for (x, y) in each_a.iter().flat_map(|x| each_b.iter().map(move |y| (*x, *y))) {
                    let Ok(result) = eval::binary(op, x, y) else { continue };
                    assert!(has(&found, result), "{x} {op:?} {y} is {result}, not in {found:?}");
                }
            }
        }
    }
}

#[test]
fn functions_give_all_that_they_may_give() {
    for func in [Func::Fix, Func::Fup, Func::Round, Func::Abs] {
        for (a, each) in sets() {
            let found = evaluate(&Expr::Call(func, [Expr::Var(A)].into()), &|_| a.clone());
            for x in each {
                let result = eval::function(func, &[x], &Memory::default()).unwrap();
                assert!(has(&found, result), "{func:?} of {x} is {result}, not in {found:?}");
            }
        }
    }
    let negative = evaluate(&Expr::Negate(Box::new(Expr::Var(A))), &|_| Values::whole(-1.0, 3.0));
    assert_eq!(negative, Values::whole(-3.0, 1.0));
}

#[test]
fn sums_and_masks_are_as_narrow_as_they_can_be() {
    let of = |text: &str| {
        let text = format!("program O1 {{\nblock0:\n local.2 = {text}\n end\n}}\n");
        let module = parse(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        let StmtKind::Assign { value, .. } = &module.programs[0].blocks[0].stmts[0].kind else { panic!() };
        evaluate(value, &|_| Values::whole(1.0, 10.0))
    };
    assert_eq!(of("500 + local.1"), Values::whole(501.0, 510.0));
    assert_eq!(of("500 + (local.1 * 2)"), Values::whole(502.0, 520.0));
    assert_eq!(of("local.1 mod 4"), Values::whole(0.0, 3.0));
    assert_eq!(of("100 + (local.1 and 7)"), Values::whole(100.0, 107.0));
    assert_eq!(of("fix(local.1 / 2)"), Values::whole(0.0, 5.0));
}

/// The numbers that the index of the last assignment to a computed variable may be, in the first program.
fn numbers(body: &str) -> Numbers {
    let text = format!("program O1 {{\n{body}\n}}\n");
    let module = parse(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    let summaries = Summaries::of(&module);
    let program = &module.programs[0];
    index_of(program, &Ranges::of(program, &summaries))
}

/// The numbers of the last computed variable that a program assigns.
fn index_of(program: &Program, ranges: &Ranges<'_>) -> Numbers {
    let mut found = None;
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            if let StmtKind::Assign { target: Place::Indirect(_, index), .. } = &stmt.kind {
                found = Some(ranges.at(id, at, index).numbers());
            }
        }
    }
    found.expect("a computed number")
}

fn all(runs: &[(u32, u32)]) -> Numbers {
    Numbers::of(runs.iter().copied())
}

#[test]
fn a_loop_bounds_what_it_counts() {
    let counted = |from: &str, cond: &str, step: &str| {
        numbers(&format!(
            "block0:\n local.1 = {from}\n jump block1\nblock1:\n branch {cond} ? block2 : block3\nblock2:\n #[500 + local.1] = 0\n local.1 = local.1 {step}\n jump block1\nblock3:\n end"
        ))
    };
    assert_eq!(counted("1", "local.1 le 10", "+ 1"), all(&[(501, 510)]));
    assert_eq!(counted("1", "local.1 lt 40", "+ 1"), all(&[(501, 539)]));
    assert_eq!(counted("30", "local.1 ge 3", "- 1"), all(&[(503, 530)]));
    // The last turn that is made is the one of 99.
    assert_eq!(counted("1", "not(local.1 gt 99)", "+ 2"), all(&[(501, 599)]));
    // Its last turn is not known.
    assert_eq!(counted("1", "local.1 lt common.100", "+ 1"), all(&[(501, u32::MAX)]));
    // It may start at a fraction, which a control may round up.
    assert_eq!(counted("local.9", "local.1 le 10", "+ 1"), all(&[(0, 511)]));
}

#[test]
fn a_literal_at_the_head_is_an_input() {
    // #1 is assigned once; #2 is counted on, which an operator may begin elsewhere.
    let text = |index: &str| {
        let body = format!(
            "block0:\n local.1 = 5\n local.2 = 7\n jump block1\nblock1:\n #[{index}] = 0\n local.2 = local.2 + 1\n branch local.2 le 9 ? block1 : block2\nblock2:\n end"
        );
        format!("program O1 {{\n{body}\n}}\n")
    };
    let both = |index: &str| {
        let module = parse(&text(index)).unwrap();
        let (program, summaries) = (&module.programs[0], Summaries::of(&module));
        let kinds = [Ranges::of(program, &summaries), Ranges::of_any_inputs(program, &summaries)];
        kinds.map(|ranges| index_of(program, &ranges))
    };
    let any = all(&[(0, u32::MAX)]);
    assert_eq!(both("local.1"), [any.clone(), any.clone()]);
    assert_eq!(both("local.2"), [all(&[(7, 9)]), any]);
}

#[test]
fn a_computed_write_reaches_only_what_its_numbers_name() {
    // #1 to #3 are written, the counter is #5.
    let counter = |own: u32| {
        numbers(&format!(
            "block0:\n local.{own} = 1\n jump block1\nblock1:\n branch local.{own} le 3 ? block2 : block3\nblock2:\n #[local.{own}] = 77\n local.{own} = local.{own} + 1\n jump block1\nblock3:\n end"
        ))
    };
    assert_eq!(counter(5), all(&[(1, 3)]));
    // #2 counts, and is written with 77 when it is 2: the loop ends there.
    assert_eq!(counter(2), all(&[(1, 3)]));
}

#[test]
fn constants_are_joined_where_ways_meet() {
    let joined = |more: &str| {
        numbers(&format!(
            "block0:\n branch local.7 gt 0 ? block1 : block2\nblock1:\n local.1 = 500\n jump block3\nblock2:\n local.1 = 700\n jump block3\nblock3:\n{more} #[local.1 + 1] = 0\n end"
        ))
    };
    assert_eq!(joined(""), all(&[(501, 501), (701, 701)]));
    assert_eq!(joined(" local.1 = 520 skip 1\n"), all(&[(501, 501), (521, 521), (701, 701)]));
    assert_eq!(joined(" input local.1\n"), all(&[(0, u32::MAX)]));
    assert_eq!(joined(" sync\n"), all(&[(501, 501), (701, 701)]));
}

#[test]
fn what_a_call_may_write_is_forgotten() {
    let called = |index: &str, callee: &str| {
        numbers(&format!(
            "block0:\n branch local.9 gt 0 ? block1 : block1\nblock1:\n local.1 = 5\n common.101 = 6\n call {callee} -> block2\nblock2:\n #[{index}] = 0\n end\n}}\nprogram O2 {{\nblock0:\n local.1 = 3\n return\n}}\nprogram O3 {{\nblock0:\n common.101 = 3\n return"
        ))
    };
    let any = all(&[(0, u32::MAX)]);
    assert_eq!(called("common.101", "O2"), all(&[(6, 6)]));
    assert_eq!(called("common.101", "O3"), any);
    assert_eq!(called("common.101", "O4"), any);
    assert_eq!(called("local.1", "O2"), any);
    assert_eq!(called("local.1", "O2 level"), all(&[(5, 5)]));
    assert_eq!(called("local.1", "O3"), all(&[(5, 5)]));
}

#[test]
fn sets_of_numbers_are_joined_and_cut() {
    let set = all(&[(5, 9), (1, 3), (4, 4), (20, 30)]);
    assert_eq!(set.runs(), [(1, 9), (20, 30)]);
    assert_eq!(set.without([1, 5, 25, 40]).runs(), [(2, 4), (6, 9), (20, 24), (26, 30)]);
    assert_eq!(set.to_string(), "#1-#9, #20-#30");
    assert!(set.contains(9) && !set.contains(10) && set.contains(20) && !set.contains(0));
    assert!(set.holds(&all(&[(2, 3), (30, 30)])) && !set.holds(&all(&[(9, 10)])));
    assert_eq!(Values::one(2.5).numbers(), all(&[(2, 3)]));
    assert_eq!(Values::one(-2.0).numbers(), all(&[]));
    assert_eq!(Values::ANY.numbers(), all(&[(0, u32::MAX)]));
}

/// Three axes of six work offsets, as the manuals number them: the first and the last say it.
#[test]
fn runs_at_one_distance_are_told_by_the_first_and_the_last() {
    let offsets = (0..6).map(|number| (5221 + 20 * number, 5223 + 20 * number));
    let numbers: Numbers =
        Numbers::of([(1, 33), (500, 500)].into_iter().chain(offsets).chain([(7001, 7003), (7021, 7023)]));
    let told = "#1-#33, #500, #5221-#5223 and so on by 20 to #5321-#5323, #7001-#7003, #7021-#7023";
    assert_eq!(numbers.to_string(), told);
}
