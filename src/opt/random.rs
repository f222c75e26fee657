//! Random programs do the same before and after all passes, at every level.

use super::{Level, PASSES, run};
use crate::ir::eval::{self, Ending, Memory, Trace};
use crate::ir::text::parse;
use crate::ir::{Class, Module, Var, validate};
use proptest::prelude::*;

const VARS: [&str; 9] =
    ["tmp.1", "tmp.2", "tmp.3", "local.1", "local.2", "common.101", "global.1", "global.2", "global.3"];

fn exprs() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        3 => prop::sample::select(&VARS[..]).prop_map(str::to_owned),
        2 => prop::sample::select(&["0", "1", "2.5", "-0.5", "359.9", "99999999"][..]).prop_map(str::to_owned),
    ];
    leaf.prop_recursive(2, 6, 2, |inner| {
        let op = prop::sample::select(&["+", "-", "*", "/", "mod"][..]);
        prop_oneof![
            (inner.clone(), op, inner.clone()).prop_map(|(a, op, b)| format!("({a} {op} {b})")),
            inner.clone().prop_map(|a| format!("-({a})")),
            inner.clone().prop_map(|a| format!("sqrt({a})")),
            inner.prop_map(|a| format!("round({a})")),
        ]
    })
}

fn conds() -> impl Strategy<Value = String> {
    let relation = prop::sample::select(&["eq", "ne", "lt", "ge"][..]);
    prop_oneof![
        4 => (exprs(), relation, exprs()).prop_map(|(a, relation, b)| format!("{a} {relation} {b}")),
        1 => Just("switch 1".to_owned()),
        1 => Just("local.1 eq vacant".to_owned()),
    ]
}

fn stmts() -> impl Strategy<Value = String> {
    let site = prop::sample::select(&["", "", " N7", " skip 1", " \"NOTE\""][..]);
    let var = prop::sample::select(&VARS[..]);
    let kind = prop_oneof![
        // Copies, of which a temporary has one side.
        4 => (prop::sample::select(&VARS[..3]), var.clone()).prop_map(|(to, from)| format!("{to} = {from}")),
        4 => (var.clone(), prop::sample::select(&VARS[..2])).prop_map(|(to, from)| format!("{to} = {from}")),
        4 => (var, exprs()).prop_map(|(var, value)| format!("{var} = {value}")),
        2 => prop::sample::select(&VARS[..]).prop_map(|var| format!("nc motion.linear axis.x={var}")),
        1 => Just("local.1 = vacant".to_owned()),
        1 => Just("#[local.2] = tmp.1".to_owned()),
        1 => Just("clear global".to_owned()),
    ];
    (kind, site).prop_map(|(kind, site)| format!("    {kind}{site}\n"))
}

/// A program of five blocks, some of which may hold nothing but a jump.
fn programs(name: u32) -> impl Strategy<Value = String> {
    let to = || 0..5u32;
    let term = prop_oneof![
        4 => to().prop_map(|to| format!("jump block{to}")),
        4 => (conds(), to(), to()).prop_map(|(cond, then, otherwise)| format!("branch {cond} ? block{then} : block{otherwise}")),
        1 => (to(), to()).prop_map(|(entry, next)| format!("call block{entry} -> block{next}")),
        1 => to().prop_map(|next| format!("call O2 level (1: tmp.1) -> block{next}")),
        1 => to().prop_map(|next| format!("call O2 -> block{next}")),
        2 => Just("return".to_owned()),
        1 => Just("return to 30".to_owned()),
        2 => Just("end".to_owned()),
    ];
    let site = prop::sample::select(&["", "", " N9"][..]);
    let block = (prop::collection::vec(stmts(), 0..7), term, site);
    prop::collection::vec(block, 5).prop_map(move |blocks| {
        let mut text = format!("program O{name} file 0 {{\n");
        for (id, (stmts, term, site)) in blocks.into_iter().enumerate() {
            let label = if id == 3 { " (N30)" } else { "" };
            text += &format!("block{id}{label}:\n{}    {term}{site}\n", stmts.concat());
        }
        text + "}\n"
    })
}

fn observe(module: &Module, start: (Option<f64>, f64), switches: &[u8]) -> (Trace, Vec<(Var, Option<u64>)>) {
    let mut memory = Memory { switches: switches.to_vec(), ..Memory::new() };
    memory.set(Var { class: Class::Local, number: 1 }, start.0);
    memory.set(Var { class: Class::Global, number: 1 }, Some(start.1));
    let trace = eval::run(module, 0, &mut memory, &[], 200);
    let shared = memory.vars.iter().filter(|(var, _)| var.class.shared());
    (trace, shared.map(|(var, value)| (*var, value.map(f64::to_bits))).collect())
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: proptest::test_runner::RngSeed::Fixed(23), cases: 600, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn programs_do_the_same(main in programs(1), sub in programs(2)) {
        let before = parse(&format!("{main}{sub}")).unwrap();
        prop_assert!(validate(&before).is_ok());
        for level in [Level::O1, Level::O2] {
            let mut after = before.clone();
            run(&mut after, PASSES, level).unwrap();
            for start in [(None, 0.0), (Some(1.0), 2.5), (Some(-0.5), -1.0)] {
                for switches in [&[][..], &[1]] {
                    let (old, new) = (observe(&before, start, switches), observe(&after, start, switches));
                    match (&old.0.ending, &new.0.ending) {
                        // Fewer blocks take fewer steps: what both did must agree.
                        (Ending::Steps, _) | (_, Ending::Steps) => {
                            let both = old.0.events.len().min(new.0.events.len());
                            prop_assert_eq!(&old.0.events[..both], &new.0.events[..both]);
                        }
                        // Such runs are not followed further, but get as far.
                        (Ending::Unsupported(_), _) => prop_assert_eq!(&old.0, &new.0),
                        _ => prop_assert_eq!(&old, &new, "{}", after),
                    }
                }
            }
        }
    }
}
