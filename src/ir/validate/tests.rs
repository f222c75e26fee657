use super::*;
use crate::canon::Op;
use crate::ir::text::parse;
use crate::ir::{Expr, Stmt, StmtKind};

/// What is wrong with a program of these lines.
fn problems(lines: &[&str]) -> Vec<Problem> {
    let text = format!("program O1 {{\nblock0:\n{}\n}}\n", lines.join("\n"));
    let module = parse(&text).unwrap();
    match validate(&module) {
        Ok(_) => Vec::new(),
        Err(all) => all.into_iter().map(|invalid| invalid.problem).collect(),
    }
}

fn var(class: Class, number: u32) -> Var {
    Var { class, number }
}

#[test]
fn sound_programs_pass() {
    for line in [
        "nc motion.rapid cycle.off axis.x=-increments(10) coolant.mist coolant.flood",
        "nc path.exact.once dwell dwell.ms=increments(5) stop",
        "nc builder builder=1 builder=2",
        "nc G=local.1 M=3",
        "modal O5 level (1: increments(2), 26: vacant)",
        "local.33 = vacant",
        "tmp.70000 = atan(1, 2) + atan(1)",
        "clear param",
    ] {
        assert_eq!(problems(&[line, "end"]), [], "{line}");
    }
    assert_eq!(problems(&["computed local.1 {10: block1}", "block1 (N10, :A):", "end"]), []);
}

#[test]
fn breaches_are_found() {
    let found = |line: &str, problem: Problem| assert_eq!(problems(&[line, "end"]), [problem], "{line}");
    found("nc end", Problem::Flow(Op::End));
    found("nc motion.rapid motion.linear", Problem::Group(Group::Motion));
    found("nc coolant.flood coolant.off", Problem::Group(Group::Coolant));
    found("nc axis.x=1 axis.x=2", Problem::Role(Role::X));
    found("nc T=1", Problem::Letter('T'));
    found("nc axis.x=(1 + increments(2))", Problem::Increments);
    found("nc axis.x=-(-increments(2))", Problem::Increments);
    found("nc G=increments(2)", Problem::Increments);
    found("local.1 = increments(2)", Problem::Increments);
    found("local.34 = 1", Problem::Variable(var(Class::Local, 34)));
    found("local.1 = common.0", Problem::Variable(var(Class::Common, 0)));
    found("global.5 = vacant", Problem::NeverVacant(var(Class::Global, 5)));
    found("clear local", Problem::Clear);
    found("local.1 = pow(2)", Problem::Arity { func: Func::Pow, count: 1 });
    found("local.1 = inf", Problem::NotFinite);
    found("comment skip 10", Problem::Skip(10));
    found("modal O5 level (1: 1, 1: 2)", Problem::ArgumentTwice(1));
    found("modal O5 (1: 1)", Problem::NoLevel);
    found("modal O5 level (34: 1)", Problem::Variable(var(Class::Local, 34)));
    found("modal block9", Problem::NoBlock(BlockId(9)));
}

#[test]
fn terminators() {
    assert_eq!(problems(&["end skip 1"]), [Problem::Skip(1)]);
    assert_eq!(problems(&["jump block7"]), [Problem::NoBlock(BlockId(7))]);
    assert!(problems(&["branch switch 1 ? block0 : block0 skip 1"]).is_empty());
    assert_eq!(problems(&["branch switch 1 ? block0 : block0 skip 2"]), [Problem::Skip(2)]);
    assert_eq!(problems(&["branch switch 0 ? block0 : block0"]), [Problem::Skip(0)]);
    let jump = |targets: &str| problems(&[&format!("computed 1 {{{targets}}}"), "block1 (N10):", "end"]);
    assert_eq!(jump("10: block0"), [Problem::Label { label: 10, target: BlockId(0) }]);
    assert_eq!(jump(""), [Problem::LabelLeftOut(10)]);
    assert_eq!(jump("10: block1, 10: block1"), [Problem::LabelTwice(10)]);
}

#[test]
fn a_program_has_an_entry() {
    let module = parse("program O1 {\n}\n").unwrap();
    let all = validate(&module).unwrap_err();
    assert_eq!(all[0].to_string(), "program 0 (O1): has no block");
}

#[test]
fn an_error_names_its_place() {
    let module = parse("program O7 {\nblock0:\n jump block1\nblock1:\n sync\n local.0 = 1\n end\n}").unwrap();
    let all = validate(&module).unwrap_err();
    assert_eq!(all[0].to_string(), "program 0 (O7), block1, statement 1: no variable local.0");
}

#[test]
fn deep_expressions_are_refused() {
    let mut module = parse("program O7 {\nblock0:\n end\n}").unwrap();
    let deep = (1..eval_depth()).fold(Expr::Number(1.0), |e, _| Expr::Negate(Box::new(e)));
    for (value, valid) in [(deep.clone(), true), (Expr::Negate(Box::new(deep)), false)] {
        let kind = StmtKind::LimitLookahead(value);
        module.programs[0].blocks[0].stmts =
            thin_vec::thin_vec![Stmt { kind, site: crate::ir::SourceInfo::default() }];
        assert_eq!(validate(&module).is_ok(), valid);
    }
}

fn eval_depth() -> usize {
    crate::ir::eval::MAX_DEPTH
}
