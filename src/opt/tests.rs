use super::*;
use crate::canon::Func;
use crate::ir::eval::{AtanRange, Memory, eval, holds};
use crate::ir::text::{parse, print};
use crate::ir::{BinOp, Cond, Expr, Module, Relation};

/// The operands that tell rewritings apart.
const DOMAIN: [f64; 12] = [0.0, -0.0, 0.5, -0.5, 1.0, -1.0, 1.5, 2.5, 0.4999999, 359.9, 1e-9, 99_999_999.0];

fn operands() -> Vec<Expr> {
    DOMAIN.iter().map(|v| Expr::Number(*v)).chain([Expr::Vacant]).collect()
}

/// Folded or not, the value is the same to the last bit, and an alarm stays one.
fn folds_alike(e: Expr) {
    let mut folded = e.clone();
    fold(&mut folded);
    for atan in [AtanRange::Full, AtanRange::Signed] {
        let env = Memory { atan, ..Memory::new() };
        let [before, after] = [&e, &folded].map(|e| eval(e, &env).map(|v| v.map(f64::to_bits)));
        assert_eq!(after, before, "{e} became {folded}");
    }
}

#[test]
fn folding_keeps_every_value() {
    let ops = [BinOp::Add, BinOp::Sub, BinOp::Mul, BinOp::Div, BinOp::Mod, BinOp::And, BinOp::Or, BinOp::Xor];
    for a in operands() {
        folds_alike(Expr::Negate(Box::new(a.clone())));
        Func::ALL.iter().for_each(|f| folds_alike(Expr::Call(*f, [a.clone()].into())));
        for b in operands() {
            for op in ops {
                folds_alike(Expr::binary(op, a.clone(), b.clone()));
            }
            Func::ALL.iter().for_each(|f| folds_alike(Expr::Call(*f, [a.clone(), b.clone()].into())));
            let cond = Cond::Compare(Relation::Equal, a.clone(), b.clone());
            folds_alike(Expr::Truth(Box::new(cond)));
        }
    }
}

#[test]
fn folding_stops_short_of_what_no_literal_says() {
    let folded = |text: &str| {
        let mut module = parse(&format!("program O1 {{\nblock0:\n tmp.1 = {text}\n end\n}}")).unwrap();
        run(&mut module, &[&Fold], Level::O1).unwrap();
        let text = print(&module);
        text.lines().nth(2).and_then(|line| line.split(" = ").nth(1)).unwrap_or_default().to_owned()
    };
    for (from, to) in [
        ("2 + 3 * 4", "14"),
        ("1 / 3", "1 / 3"),
        ("1 / 0", "1 / 0"),
        ("sqrt(-1)", "sqrt(-1)"),
        ("-(0)", "-(0)"),
        ("sin(30)", "0.5"),
        ("sin(20)", "sin(20)"),
        ("atan(1, 1)", "45"),
        ("atan(-1, -1)", "atan(-1, -1)"),
        ("local.1 + 0", "local.1 + 0"),
        ("local.1 * 1", "local.1 * 1"),
        ("vacant + 1", "vacant + 1"),
        ("truth(1 lt 2)", "1"),
        ("truth(switch 1)", "truth(switch 1)"),
        ("1000 * 1000 * 1000", "1000000 * 1000"),
        ("1 / 1000000000", "1 / 1000000000"),
        ("99999999 + 0.5", "99999999 + 0.5"),
    ] {
        assert_eq!(folded(from), to, "{from}");
    }
}

#[test]
fn constant_conditions_settle_as_they_hold() {
    let relations = [
        Relation::Equal,
        Relation::NotEqual,
        Relation::Less,
        Relation::LessEqual,
        Relation::Greater,
        Relation::GreaterEqual,
    ];
    for a in operands() {
        for b in operands() {
            for relation in relations {
                let cond = Cond::Compare(relation, a.clone(), b.clone());
                let way = if holds(&cond, &Memory::new()).unwrap() { 1 } else { 2 };
                let text = format!(
                    "program O1 {{\nblock0:\n branch {cond} ? block1 : block2\nblock1:\n end\nblock2:\n stray\n}}"
                );
                let mut module = parse(&text).unwrap();
                run(&mut module, &[&Branches], Level::O1).unwrap();
                assert!(print(&module).contains(&format!("jump block{way}")), "{cond}");
            }
        }
    }
}

fn sample() -> Module {
    let text = "program O1 file 0 {\nblock0:\n    tmp.1 = 2 + 3\n    global.5 = tmp.1\n    end\nblock1:\n    stray\n}\n";
    parse(text).unwrap()
}

#[test]
fn passes_make_a_program_tidier_but_at_level_0() {
    let ran = |level| {
        let mut module = sample();
        run(&mut module, PASSES, level).unwrap();
        print(&module)
    };
    assert_eq!(ran(Level::O0), print(&sample()));
    assert_eq!(ran(Level::O1), "program O1 file 0 {\nblock0:\n    global.5 = 5\n    end\n}\n");
}

#[test]
fn large_programs_come_to_an_end() {
    let mut text = String::from("program O1 file 0 {\n");
    for id in 0..50_000 {
        text.push_str(&format!(
            "block{id}:\n tmp.1 = global.1 + {id}\n global.2 = tmp.1\n tmp.2 = 3\n branch global.1 lt {id} ? block0 : block{}\n",
            id + 1
        ));
    }
    let mut module = parse(&format!("{text}block50000:\n end\n}}")).unwrap();
    run(&mut module, PASSES, Level::O2).unwrap();
    assert!(module.programs[0].blocks.iter().all(|block| block.stmts.len() <= 1));
}
