use super::*;
use crate::canon::{Func, Op, Role, Sys};
use crate::ir::*;
use crate::syntax::{Label, ProgramName};
use crate::text::Span;
use proptest::prelude::*;

/// One of everything.
const SAMPLE: &str = r#"name common.500 "LIM\"IT"
program O9010 file 2 @0..5 N1 "BORE" {
block0:
    comment @1..2 ^"AHEAD" "BEHIND"
    local.1 = 2 * (local.2 + 3) @6..20 N10 skip 1
    #[local.1 + 1] = vacant
    sys wcs[1, tmp.3] = -local.2 mod 2
    nc motion.linear axis.x=-increments(10) feed=(local.9 / 2) G=local.9
    nc
    modal O100 level (1: 2.5, 2: local.3)
    modal.off
    alarm 3 "NO"
    stop 1 "LOOK"
    output ["A ", local.1: 5, 3]
    port.open
    port.close
    print serial ["A", global.5] stay
    input param.9
    clear global
    sync
    lookahead 0
    names common.510 ["A", "B"]
    branch all(local.1 eq vacant, not(switch 2), any(register.0 lt 0, 1 ge sin(30))) ? block1 : block2
block1 (N20, :LOOP, :"a b"):
    call O100 level (1: 2.5) times local.1 -> block2
block2:
    computed #[local.1] {10: block0, 20: block1}
block3:
    call block1 -> block4
block4:
    call computed local.1 -> block5
block5:
    call cycle 81 -> block6
block6:
    return to local.1
block7:
    end rewind
block8:
    chain "ABC"
block9:
    stray N5
}
program unnamed file 0 {
block0:
    return
}
"#;

#[test]
fn prints_what_it_reads() {
    assert_eq!(print(&parse(SAMPLE).unwrap()), SAMPLE);
}

#[test]
fn reads_the_example_of_the_documentation() {
    let lines = include_str!("mod.rs").lines().skip_while(|l| !l.contains("```text")).skip(1);
    let text: Vec<&str> = lines.take_while(|l| !l.contains("```")).map(|l| &l[3..]).collect();
    let module = parse(&text.join("\n")).unwrap();
    let program = &module.programs[0];
    assert_eq!(program.name, Some(ProgramName::Number(9010)));
    assert_eq!(program.blocks[1].labels[..], [Label::Number(20), Label::Name("LOOP".into())]);
    let stmt = &program.blocks[0].stmts[0];
    assert_eq!(
        (stmt.site.span, stmt.site.sequence.get(), stmt.site.skip),
        (Span::new(6, 20), Some(10), Some(1))
    );
    assert!(stmt.site.comments[0].leading && !stmt.site.comments[1].leading);
    let StmtKind::Nc(nc) = &program.blocks[0].stmts[1].kind else { panic!() };
    assert!(nc.has(Op::Linear));
    assert_eq!(nc.word(Role::Feed), Some(&Expr::Increments(10.0)));
}

#[test]
fn says_where_a_text_is_wrong() {
    for (text, place) in [
        ("program O1 file 0 {\nblock0:\n    jump blok1\n}\n", (3, 10)),
        ("program O1 file 0 {\nblock1:\n    end\n}\n", (2, 1)),
        ("program O1 {\nblock0:\n    local.1 = 1 2\n    end\n}", (3, 17)),
        ("program O1 {\nblock0:\n    nc axis.q=1\n    end\n}", (3, 8)),
        ("program O1 {\nblock0:\n    comment \"A\n", (3, 13)),
        ("nonsense", (1, 1)),
    ] {
        let error = parse(text).unwrap_err();
        assert_eq!((error.line, error.column), place, "{text}: {error}");
    }
}

#[test]
fn nesting_is_limited_not_fatal() {
    let stmt = |value: &str| parse(&format!("program O1 {{\nblock0:\n local.1 = {value}\n end\n}}"));
    assert!(stmt(&format!("{}1{}", "(".repeat(100), ")".repeat(100))).is_ok());
    assert!(stmt(&format!("{}1{}", "(".repeat(100_000), ")".repeat(100_000))).is_err());
    assert!(stmt(&"-(".repeat(100_000)).is_err());
    assert!(stmt(&vec!["1"; 270].join(" + ")).is_ok());
    assert!(stmt(&vec!["1"; 100_000].join(" + ")).is_err());
    // Chains within brackets add up.
    let step = format!("{} + 1)", vec!["1"; 100].join(" + "));
    let nested = format!("{}1{}", "(".repeat(100), format!(" + {step}").repeat(100));
    assert!(stmt(&nested).is_err());
}

fn numbers() -> impl Strategy<Value = f64> {
    let edges =
        vec![0.0, -0.0, 0.5, -1.5, 1e-9, 99_999_999.0, 359.9, 0.1 + 0.2, 1e300, f64::MIN_POSITIVE / 2.0];
    prop_oneof![prop::sample::select(edges), any::<f64>().prop_filter("finite", |f| f.is_finite())]
}

fn exprs() -> impl Strategy<Value = Expr> {
    let class = prop::sample::select(print_expr::CLASSES.iter().map(|(c, _)| *c).collect::<Vec<_>>());
    let leaf = prop_oneof![
        numbers().prop_map(Expr::Number),
        numbers().prop_map(Expr::Increments),
        Just(Expr::Vacant),
        (class, 0..1000u32).prop_map(|(class, number)| Expr::Var(Var { class, number })),
    ];
    let banks = prop::sample::select(vec![Bank::Numbered, Bank::Global, Bank::Parametric]);
    let ops = prop::sample::select(print_expr::OPERATORS.iter().map(|(op, ..)| *op).collect::<Vec<_>>());
    let relations = prop::sample::select(print_expr::RELATIONS.iter().map(|(r, _)| *r).collect::<Vec<_>>());
    leaf.prop_recursive(6, 40, 3, move |inner| {
        let list = prop::collection::vec(inner.clone(), 0..3);
        let compare = (relations.clone(), inner.clone(), inner.clone());
        let cond = compare.prop_map(|(r, a, b)| Cond::Compare(r, a, b));
        prop_oneof![
            inner.clone().prop_map(|a| Expr::Negate(Box::new(a))),
            (ops.clone(), inner.clone(), inner.clone()).prop_map(|(op, a, b)| Expr::binary(op, a, b)),
            (prop::sample::select(Func::ALL), list.clone()).prop_map(|(f, a)| Expr::Call(f, a.into())),
            (prop::sample::select(Sys::ALL), list).prop_map(|(s, a)| Expr::System(s, a.into())),
            (banks.clone(), inner.clone()).prop_map(|(b, a)| Expr::Indirect(b, Box::new(a))),
            (cond, 0..4).prop_map(|(cond, shape)| Expr::Truth(Box::new(match shape {
                0 => cond,
                1 => Cond::And(vec![cond.clone(), Cond::Switch(3), cond]),
                2 => Cond::Or(vec![cond]),
                _ => Cond::Not(Box::new(cond)),
            }))),
        ]
    })
}

fn module(stmts: Vec<Stmt>) -> Module {
    let mut builder = Builder::new();
    stmts.into_iter().for_each(|stmt| builder.push(stmt.kind, stmt.site));
    Module { programs: vec![builder.finish(None, 0, SourceInfo::default())], ..Module::default() }
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(17), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_value_reads_back_bit_for_bit(value in exprs(), text in ".*", role in prop::sample::select(Role::ALL)) {
        let site = SourceInfo { comments: [Comment { text, leading: true }].into(), sequence: Some(7).into(), ..SourceInfo::default() };
        let nc = Nc { items: vec![NcItem::Word(role, value.clone()), NcItem::Code('é', value.clone()), NcItem::Op(Op::End)] };
        let target = value.place().unwrap_or(Place::Indirect(Bank::Numbered, Box::new(value.clone())));
        let stmts = [StmtKind::Nc(nc), StmtKind::Assign { target, value }];
        let module = module(stmts.into_iter().map(|kind| Stmt { kind, site: site.clone() }).collect());
        let text = print(&module);
        let back = parse(&text).unwrap();
        prop_assert_eq!(&back, &module);
        // Equality of numbers does not see the sign of a zero; the text does.
        prop_assert_eq!(print(&back), text);
    }

    #[test]
    fn no_text_is_fatal(at in 0..SAMPLE.len(), with in "[ -~\\n]{0,6}", drop in 0..9usize) {
        let end = (at + drop).min(SAMPLE.len());
        let _ = parse(&format!("{}{with}{}", &SAMPLE[..at], &SAMPLE[end..]));
    }

    #[test]
    fn no_bytes_are_fatal(text in "\\PC*") {
        let _ = parse(&text);
    }
}
