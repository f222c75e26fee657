use super::*;
use crate::canon::{Group, Op};
use crate::ir::analysis::Setting;
use crate::ir::text::parse;

fn draw(seed: &mut u64, limit: u64) -> u64 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    *seed % limit
}

/// Statements after which something else is in force.
const STATEMENTS: [&str; 20] = [
    "nc motion.linear feed=100",
    "nc motion.rapid",
    "nc axis.x=1",
    "nc cycle.tap axis.x=2 axis.z=-1",
    "nc cycle.off",
    "nc units.inch",
    "nc units.metric",
    "nc feed=5",
    "nc length.plus offset.length=1",
    "nc length.plus offset.length=2 axis.z=5",
    "nc length.off",
    "nc reference.return axis.z=0",
    "nc reference.return axis.x=0",
    "nc wcs.select wcs.number=1",
    "nc wcs.select wcs.number=2",
    "nc spindle.cw",
    "nc spindle.stop",
    "nc tool=1",
    "nc tool.change",
    "nc wcs.machine.once axis.z=0",
];

fn module(seed: &mut u64) -> Module {
    let mut text = String::new();
    for name in 1..4 {
        let count = 1 + draw(seed, 5);
        text.push_str(&format!("program O{name} {{\n"));
        for id in 0..count {
            text.push_str(&format!("block{id}:\n"));
            for _ in 0..draw(seed, 3) {
                text.push_str(&format!(" {}\n", STATEMENTS[draw(seed, 20) as usize]));
            }
            let [a, b] = [draw(seed, count), draw(seed, count)];
            let callee = 1 + draw(seed, 3);
            text.push_str(&match draw(seed, 8) {
                0 => " end\n".to_owned(),
                1 | 2 => " return\n".to_owned(),
                3 => format!(" call block{a} -> block{b}\n"),
                4 => format!(" call O{callee} -> block{b}\n"),
                5 => format!(" jump block{a}\n"),
                _ => format!(" branch global.1 lt 3 ? block{a} : block{b}\n"),
            });
        }
        text.push_str("}\n");
    }
    parse(&text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn what_is_found_does_not_hang_on_the_order_of_visits() {
    for seed in 1..500u64 {
        let mut random = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let module = module(&mut random);
        let found = ModalFacts::of(&module, &Modal::unknown()).entries;
        for _ in 0..4 {
            let mut analysis = Analysis::new(&module, false);
            let ranks = found.iter().map(|_| draw(&mut random, 100) as u32).collect();
            analysis.entries = Routines::ranked(ranks);
            let other = analysis.run(&Modal::unknown()).entries;
            assert_eq!(found, other, "seed {seed}: {}", crate::ir::text::print(&module));
        }
    }
}

/// A run of a library: the blocks that it came to, each with what was in force there. Branches go either way.
fn run(module: &Module, program: usize, seed: &mut u64) -> Vec<((usize, BlockId), Modal)> {
    let by_name = |name: &ProgramName| module.programs.iter().position(|p| p.name.as_ref() == Some(name));
    let (mut place, mut state) = ((program, BlockId(0)), Modal::unknown().at_head());
    let (mut frames, mut came) = (Vec::new(), Vec::new());
    for _ in 0..60 {
        let Some(block) = module.programs[place.0].block(place.1) else { break };
        came.push((place, state.clone()));
        block.stmts.iter().for_each(|stmt| state.step(stmt));
        place = match &block.term.kind {
            TermKind::Call { call, next } => {
                frames.push((place.0, *next));
                match &call.callee {
                    Callee::Block(entry) => (place.0, *entry),
                    Callee::Program(name) => match by_name(name) {
                        Some(program) => (program, BlockId(0)),
                        None => break,
                    },
                    _ => break,
                }
            }
            TermKind::Return { .. } => match frames.pop() {
                Some(back) => back,
                None => break,
            },
            kind => {
                let ways = kind.successors();
                match ways.get(draw(seed, ways.len().max(1) as u64) as usize) {
                    Some(way) => (place.0, *way),
                    None => break,
                }
            }
        };
    }
    came
}

/// What is found of a block holds in each run that comes to it, from whichever caller.
#[test]
fn what_is_found_holds_in_every_run() {
    let mut looked = 0;
    for seed in 1..400u64 {
        let mut random = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let module = module(&mut random);
        let facts = ModalFacts::of(&module, &Modal::unknown());
        let called = Analysis::new(&module, false).called_programs();
        // What is called and returns is not begun by itself.
        let begun = |at: &usize| !called.contains(at) || !module.programs[*at].returns();
        for program in (0..module.programs.len()).filter(begun) {
            for _ in 0..10 {
                for ((index, id), state) in run(&module, program, &mut random) {
                    let Some(mut found) = facts.entries[facts.firsts[index] + id.index()].clone() else {
                        continue;
                    };
                    looked += 1;
                    let text =
                        || format!("seed {seed}: {id:?} of {index}\n{}", crate::ir::text::print(&module));
                    assert!(!found.join(&Arc::new(state)), "{}", text());
                }
            }
        }
    }
    assert!(looked > 10_000, "{looked}");
}

/// A macro that says nothing of the tool length leaves it to each of its callers, one with a length and one without.
#[test]
fn a_call_leaves_what_its_callee_does_not_touch() {
    let text = "program O1 {\nblock0:\n nc length.plus offset.length=7\n nc distance.absolute\n call O9 -> block1\n\
                block1:\n nc length.off\n nc distance.incremental\n call O9 -> block2\nblock2:\n end\n}\n\
                program O9 {\nblock0:\n nc feed=100\n nc plane.zx\n return\n}\n";
    let module = parse(text).unwrap();
    let facts = ModalFacts::of(&module, &Modal::unknown());
    let (first, second) = (facts.at(0, BlockId(1)), facts.at(0, BlockId(2)));
    assert_eq!(first.of(Group::LengthComp), Setting::Known(Op::LengthPlus, Some(7)));
    assert_eq!([first.op(Group::Distance), first.op(Group::Plane)], [Some(Op::Absolute), Some(Op::PlaneZx)]);
    assert_eq!(second.op(Group::LengthComp), Some(Op::LengthOff));
    assert_eq!(second.op(Group::Distance), Some(Op::Incremental));
    assert_eq!([first.feed(), second.feed()], [Some(100.0); 2]);
    // In the macro itself either may be in force.
    assert_eq!(facts.at(1, BlockId(0)).of(Group::Distance), Setting::Unknown);
}
