use super::*;
use crate::ir::text::parse;
use crate::ir::{BlockId, Class, Module, Var};
use std::collections::BTreeSet;

fn module(body: &str) -> Module {
    parse(&format!("program O1 {{\n{body}\n}}\n")).unwrap()
}

fn ids(all: &[u32]) -> Vec<BlockId> {
    all.iter().copied().map(BlockId).collect()
}

fn var(text: &str) -> Var {
    let (class, number) = text.split_once('.').unwrap();
    let class = match class {
        "local" => Class::Local,
        "common" => Class::Common,
        "tmp" => Class::Temp,
        _ => Class::Global,
    };
    Var { class, number: number.parse().unwrap() }
}

#[test]
fn graph_of_a_nest_of_loops() {
    let module = module(
        "block0:\n jump block1
block1:\n branch local.1 lt 3 ? block2 : block6
block2:\n jump block3
block3:\n branch local.2 lt 3 ? block4 : block5
block4:\n jump block3
block5:\n jump block1
block6:\n end
block7:\n jump block6",
    );
    let cfg = Cfg::of(&module.programs[0]);
    assert_eq!(cfg.preds(BlockId(3)), ids(&[2, 4]));
    assert_eq!(cfg.preds(BlockId(6)), ids(&[1, 7]));
    let place = |id: u32| cfg.order().iter().position(|other| *other == BlockId(id));
    assert_eq!(place(7), None);
    let before = |a: u32, b: u32| place(a) < place(b);
    assert!(before(0, 1) && before(1, 2) && before(3, 4) && before(3, 5));
}

#[test]
fn calls_of_blocks_enter_and_return() {
    let module = module(
        "block0:\n call block2 -> block1\nblock1:\n end\nblock2 (N9):\n return\nblock3 (N5):\n return to 9",
    );
    let whole = Cfg::whole(&module.programs[0], false);
    assert_eq!(whole.succs(BlockId(0)), ids(&[2]));
    let hub = whole.succs(BlockId(2))[0];
    assert_eq!(whole.succs(hub), ids(&[0, 1]));
    assert_eq!(whole.succs(BlockId(3)).len(), 2);
    let steps = Cfg::of(&module.programs[0]);
    assert_eq!((steps.succs(BlockId(0)), steps.roots()), (&ids(&[1])[..], &ids(&[0, 2])[..]));
}

#[test]
fn returns_go_on_after_calls_of_their_part() {
    let module = module(
        "block0:\n call block3 -> block1\nblock1:\n call block4 -> block2\nblock2:\n end\nblock3:\n return\n\
         block4:\n return\nblock5:\n return",
    );
    let whole = Cfg::whole(&module.programs[0], false);
    let after = |part| {
        let hubs = whole.succs(BlockId(part)).iter();
        hubs.flat_map(|hub| whole.succs(*hub).to_vec()).collect::<Vec<_>>()
    };
    assert_eq!(after(3), ids(&[1]));
    assert_eq!(after(4), ids(&[2]));
    // Nothing reaches it.
    assert_eq!(after(5), ids(&[0, 1, 2]));
}

fn live(module: &Module, block: u32) -> Vec<String> {
    let live = Liveness::of(&module.programs[0], Ways::of(module));
    let temps = (1..=3).map(|number| var(&format!("tmp.{number}")));
    temps.filter(|temp| live.is_live_before(BlockId(block), *temp)).map(|v| v.to_string()).collect()
}

#[test]
fn liveness_within_a_program() {
    let module = module(
        "block0:\n tmp.1 = local.1\n tmp.3 = 5\n branch tmp.1 lt 3 ? block1 : block2
block1:\n nc axis.x=local.2\n tmp.2 = 1 skip 1\n jump block2\nblock2:\n common.101 = tmp.2 + tmp.3\n end",
    );
    // tmp.2 may be skipped, so that it is read as it was at the entry.
    assert_eq!(live(&module, 0), ["tmp.2"]);
    assert_eq!(live(&module, 1), ["tmp.2", "tmp.3"]);
}

#[test]
fn liveness_across_calls() {
    let body = |call: &str, other: &str| {
        let caller = format!("block0:\n tmp.1 = 1\n tmp.2 = 2\n {call}\nblock1:\n tmp.1 = 3\n end");
        parse(&format!("program O1 {{\n{caller}\n{other}\n}}\nprogram O2 {{\nblock0:\n return\n}}\n"))
            .unwrap()
    };
    let behind = |module: &Module| {
        let live = Liveness::of(&module.programs[0], Ways::of(module));
        let mut found = Vec::new();
        live.backward(BlockId(0), &mut |at, is_live| found.push((at, is_live(&var("tmp.1")))));
        found
    };
    // Another program, in the library or not, does not see them; a body in the same one does.
    for call in ["call O2 -> block1", "call O9 -> block1"] {
        assert_eq!(behind(&body(call, "")), [(1, false), (0, false)], "{call}");
    }
    let own = body("call block2 -> block1", "block2:\n common.100 = tmp.1\n return");
    assert_eq!(behind(&own), [(1, true), (0, true)]);
}

#[test]
fn writes_of_callees() {
    let module = parse(
        "program O1 {\nblock0:\n call O2 -> block1\nblock1:\n call O9 level -> block2\nblock2:\n end\n}
program O2 {\nblock0:\n common.105 = local.7 + common.106\n common.107 = common.105\n tmp.1 = 1\n return\n}\n",
    )
    .unwrap();
    let summaries = Summaries::of(&module);
    let callee = summaries.by_program(module.programs[1].name.as_ref().unwrap());
    assert_eq!(callee.vars, [var("common.105"), var("common.107")].into_iter().collect());
    assert!(callee.classes.is_empty());
    // A callee outside the library writes all that is shared.
    let caller = summaries.by_program(module.programs[0].name.as_ref().unwrap());
    assert!(caller.contains(var("common.100")) && !caller.contains(var("local.1")));
}

#[test]
fn vacancy_follows_copies_and_tests() {
    let module = module(
        "block0:\n local.2 = local.1\n local.3 = local.1 + 0\n branch local.1 eq vacant ? block1 : block2
block1:\n local.1 = 5\n jump block3\nblock2:\n jump block3\nblock3:\n common.100 = local.1\n end",
    );
    let summaries = Summaries::of(&module);
    let none = BTreeSet::new();
    let vacancy = Vacancy::of(&module.programs[0], &summaries, &none);
    let may = |block, at, name: &str| vacancy.may_be_vacant(BlockId(block), at, var(name));
    assert!(may(0, 3, "local.2") && !may(0, 3, "local.3"));
    assert!(may(1, 0, "local.1") && !may(1, 1, "local.1"));
    assert!(!may(2, 0, "local.1") && !may(3, 0, "local.1"));
    assert!(may(3, 0, "common.100") && !may(3, 1, "common.100"));
    let assigned = Vacancy::of(&module.programs[0], &summaries, &[var("local.1")].into());
    assert!(!assigned.may_be_vacant(BlockId(0), 3, var("local.2")));
}

#[test]
fn vacancy_knows_what_calls_may_undo() {
    let text = |call: &str| {
        format!(
            "program O1 {{\nblock0:\n common.100 = 1\n local.1 = 1\n call {call} -> block1\nblock1:\n end\n}}
program O2 {{\nblock0:\n common.100 = vacant\n return\n}}\nprogram O3 {{\nblock0:\n local.1 = vacant\n return\n}}\n"
        )
    };
    for (call, common, local) in
        [("O2", true, false), ("O3", false, true), ("O3 level", false, false), ("O8", true, true)]
    {
        let module = parse(&text(call)).unwrap();
        let summaries = Summaries::of(&module);
        let vacancy = Vacancy::of(&module.programs[0], &summaries, &BTreeSet::new());
        let may = |name: &str| vacancy.may_be_vacant(BlockId(1), 0, var(name));
        assert_eq!((may("common.100"), may("local.1")), (common, local), "{call}");
    }
}

/// A part that sets #100 and unsets #102, called so often; #101 is none of its business.
#[test]
fn vacancy_after_calls_of_a_part() {
    for (times, set, unset) in [
        ("", false, true),
        (" times 1", false, true),
        (" times 3", false, true),
        (" times 0", true, true),
        (" times local.1", true, true),
    ] {
        let module = module(&format!(
            "block0:\n common.101 = 1\n common.102 = 1\n call block2{times} -> block1\nblock1:\n end\n\
             block2:\n common.100 = 5\n common.102 = vacant\n return"
        ));
        let summaries = Summaries::of(&module);
        let vacancy = Vacancy::of(&module.programs[0], &summaries, &BTreeSet::new());
        let may = |name: &str| vacancy.may_be_vacant(BlockId(1), 0, var(name));
        assert_eq!((may("common.100"), may("common.101"), may("common.102")), (set, false, unset), "{times}");
    }
}

#[test]
fn values_found_backwards() {
    let module = module(
        "block0:\n local.1 = sys modal[1]\n branch local.5 eq 1 ? block1 : block2
block1:\n local.2 = 3\n jump block3\nblock2:\n local.2 = local.1\n jump block3
block3:\n local.3 = local.2\n branch local.5 eq 2 ? block3 : block4\nblock4:\n local.4 = local.5\n end",
    );
    let summaries = Summaries::of(&module);
    let at =
        |name: &str, block, at| values_at(&module.programs[0], &summaries, var(name), BlockId(block), at);
    let modal = Constant::State(crate::canon::Sys::Modal, vec![1.0]);
    let mut both = at("local.3", 4, 0).unwrap();
    both.sort_by_key(|c| *c == modal);
    assert_eq!(both, [Constant::Number(3.0), modal]);
    assert_eq!(at("local.2", 1, 1), Some(vec![Constant::Number(3.0)]));
    assert_eq!(at("local.4", 4, 1), None);
    assert_eq!(at("local.5", 0, 0), None);
}

#[test]
fn large_programs_take_no_long() {
    // Limits are for a debug build on a busy machine.
    // A chain of 100,000 blocks, each with a temporary, a way back to the first and a way round the next.
    const COUNT: u32 = 100_000;
    let mut text = String::new();
    for id in 0..COUNT {
        let far = (id + 2).min(COUNT);
        let other = if id % 3 == 0 { 1 } else { far };
        text.push_str(&format!(
            "block{id}:\n tmp.{} = local.2 + tmp.2\n local.{} = tmp.{}\n branch local.1 lt {id} ? block{} : block{other}\n",
            id + 3,
            1 + id % 33,
            id + 3,
            id + 1
        ));
    }
    let module = module(&format!("{text}block{COUNT}:\n tmp.2 = 1\n end"));
    let started = std::time::Instant::now();
    let program = &module.programs[0];
    let summaries = Summaries::of(&module);
    let vacancy = Vacancy::of(program, &summaries, &BTreeSet::new());
    assert!(vacancy.may_be_vacant(BlockId(COUNT), 0, var("local.3")));
    let live = Liveness::of(program, Ways::of(&module));
    assert!(live.is_live_before(BlockId(COUNT - 1), var("tmp.2")));
    assert_eq!(values_at(program, &summaries, var("local.2"), BlockId(COUNT), 0), None);
    assert!(started.elapsed().as_secs() < 90, "{:?}", started.elapsed());
}
