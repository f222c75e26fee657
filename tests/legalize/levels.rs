//! Random libraries do the same on a control without locals and without vacancy: what the evaluator sees before the
//! passes that give flags, frames and shared registers, and after them. Registers begin with what an earlier program may
//! have left there.

use crate::harness::{control, module};
use macroglot::diag::Severity;
use macroglot::ir::eval::{Ending, Memory, Trace, run};
use macroglot::ir::{Class, Module, Var, validate};
use macroglot::legalize::{Context, pipeline};
use proptest::prelude::*;

const PROGRAMS: u32 = 4;
const BLOCKS: u32 = 4;
const VARS: [&str; 7] = ["local.1", "local.2", "local.3", "local.4", "common.101", "common.102", "tmp.1"];
const PLACES: [&str; 8] =
    ["local.1", "local.2", "local.3", "local.4", "common.101", "common.102", "tmp.1", "tmp.2"];

fn values() -> impl Strategy<Value = String> {
    let var = || prop::sample::select(&VARS[..]);
    prop_oneof![
        4 => var().prop_map(str::to_owned),
        2 => (var(), var()).prop_map(|(a, b)| format!("{a} + {b} * 2")),
        2 => prop::sample::select(&["0", "1", "2.5", "-7"][..]).prop_map(str::to_owned),
    ]
}

fn conds() -> impl Strategy<Value = String> {
    let var = || prop::sample::select(&VARS[..]);
    let relation = || prop::sample::select(&["eq", "ne", "lt", "ge"][..]);
    prop_oneof![
        2 => (var(), relation(), var()).prop_map(|(a, relation, b)| format!("{a} {relation} {b}")),
        2 => (var(), relation()).prop_map(|(a, relation)| format!("{a} {relation} 0")),
        1 => (0..4usize, prop::sample::select(&["eq", "ne"][..])).prop_map(|(a, relation)| format!("{} {relation} vacant", VARS[a])),
    ]
}

fn stmts() -> impl Strategy<Value = String> {
    let skip = prop::sample::select(&["", "", "", " skip 1"][..]);
    let word = || prop::sample::select(&VARS[..]);
    let kind = prop_oneof![
        6 => (prop::sample::select(&PLACES[..7]), values()).prop_map(|(to, value)| {
            // A temporary is never vacant.
            if to.starts_with("tmp") { format!("{to} = {value} + 1") } else { format!("{to} = {value}") }
        }),
        1 => (0..4usize).prop_map(|local| format!("{} = vacant", VARS[local])),
        3 => (word(), word()).prop_map(|(x, y)| format!("nc motion.linear axis.x={x} axis.y={y}")),
    ];
    (kind, skip).prop_map(|(kind, skip)| format!("    {kind}{skip}\n"))
}

/// A program of four blocks that go on at later ones and call later programs: every run ends.
fn programs(name: u32) -> impl Strategy<Value = String> {
    let term = (conds(), 1..=BLOCKS, 1..=BLOCKS, name + 1..=PROGRAMS + 1, values(), values(), 0..10u32);
    let block = (prop::collection::vec(stmts(), 0..5), term);
    prop::collection::vec(block, BLOCKS as usize).prop_map(move |blocks| {
        let mut text = format!("program O{name} file 0 {{\n");
        let end = if name == 1 { "end" } else { "return" };
        for (id, (stmts, (cond, a, b, callee, first, second, kind))) in (0..).zip(blocks) {
            let start = if id == 0 { "    tmp.1 = 1\n    tmp.2 = 2\n" } else { "" };
            let (next, other) = ((id + a).min(BLOCKS - 1), (id + b).min(BLOCKS - 1));
            let term = match kind {
                _ if id == BLOCKS - 1 => end.to_owned(),
                0..=2 => format!("branch {cond} ? block{next} : block{other}"),
                3 => format!("jump block{next}"),
                _ if callee > PROGRAMS => format!("jump block{next}"),
                4 | 5 => format!("call O{callee} -> block{next}"),
                6 => format!("call O{callee} level (1: {first}) -> block{next}"),
                7 => format!("call O{callee} level (2: {first}, 1: {second}) -> block{next}"),
                8 => format!("call O{callee} level (3: vacant, 4: {second}) -> block{next}"),
                _ => format!("call O{callee} level () -> block{next}"),
            };
            text += &format!("block{id}:\n{start}{}    {term}\n", stmts.concat());
        }
        text + "}\n"
    })
}

/// What a run does, and what it leaves in common variables: vacant and 0 are one there.
fn observe(module: &Module, garbage: Option<f64>, switches: &[u8]) -> (Trace, Vec<Option<u64>>) {
    let mut memory = Memory { switches: switches.to_vec(), ..Memory::new() };
    let commons = [101, 102].map(|number| Var { class: Class::Common, number });
    if garbage.is_some() {
        (1..=300).for_each(|number| memory.set(Var { class: Class::Static, number }, garbage));
        // Nothing is vacant there: what nobody has set is 0, and so is its flag.
        commons.iter().flat_map(|var| [*var, var.flag()]).for_each(|var| memory.set(var, Some(0.0)));
    }
    let trace = run(module, 0, &mut memory, &[], 5000);
    let left = commons.iter().map(|var| memory.vars.get(var).copied().flatten());
    let left = left.map(|value| Some(value.unwrap_or(0.0).to_bits()));
    (trace, left.collect())
}

fn lowered(before: &Module, passes: &[&str]) -> Option<Module> {
    let (source, target) = (control("fanuc"), control("fadal"));
    let mut module = before.clone();
    let mut context = Context::new(&source, &target, module.programs.len());
    for name in passes {
        let (_, pass) = pipeline::passes().find(|(_, pass)| pass.name == *name).unwrap();
        pass.apply(&mut module, &mut context);
        validate(&module).unwrap_or_else(|all| panic!("{name}: {}\n{module}", all[0]));
    }
    let refused = context.into_findings().concat().iter().any(|found| found.severity() == Severity::Error);
    (!refused).then_some(module)
}

fn agree(before: &Module, after: &Module, garbage: &[Option<f64>]) -> Result<(), TestCaseError> {
    for switches in [&[][..], &[1]] {
        let old = observe(before, None, switches);
        for garbage in garbage {
            let new = observe(after, *garbage, switches);
            prop_assert!(!matches!(old.0.ending, Ending::Steps | Ending::Unsupported(_)));
            prop_assert_eq!(&old, &new, "{}\n{}", before, after);
        }
    }
    Ok(())
}

/// Flags, frames and shared registers change nothing that the programs do.
fn same(programs: [String; 4]) -> Result<(), TestCaseError> {
    let before = module(&programs.concat());
    let Some(flagged) = lowered(&before, &["vacancy-flags"]) else { return Ok(()) };
    agree(&before, &flagged, &[None])?;
    let Some(framed) = lowered(&before, &["vacancy-flags", "frames"]) else { return Ok(()) };
    agree(&before, &framed, &[Some(0.0), Some(1.0), Some(-99.0)])?;
    let coloured = lowered(&before, &["vacancy-flags", "frames", "temporaries"]);
    agree(&before, &coloured.unwrap(), &[Some(0.0), Some(1.0), Some(-99.0)])
}

fn config(seed: u64) -> ProptestConfig {
    let rng_seed = proptest::test_runner::RngSeed::Fixed(seed);
    ProptestConfig { rng_seed, cases: 500, failure_persistence: None, ..ProptestConfig::default() }
}

// Two tests, which run side by side.
proptest! {
    #![proptest_config(config(29))]

    #[test]
    fn libraries_do_the_same(a in programs(1), b in programs(2), c in programs(3), d in programs(4)) {
        same([a, b, c, d])?;
    }
}

proptest! {
    #![proptest_config(config(30))]

    #[test]
    fn other_libraries_do_the_same(a in programs(1), b in programs(2), c in programs(3), d in programs(4)) {
        same([a, b, c, d])?;
    }
}
