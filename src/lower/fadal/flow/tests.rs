//! What is found must not hang on the order in which runs are looked at.

use super::{Flow, Others, Shape};
use crate::dialect::Control;
use crate::lower::common::programs;
use crate::syntax::{fadal::parse_line, parse_file, testing};

/// Blocks of which what one leaves changes what others mean.
const BLOCKS: [&str; 24] = [
    "G1 X1.",
    "G2 X1. I1.",
    "G0",
    "G81 X0 Z-1. R0+.1 F9.",
    "G80",
    "X2.",
    "Y3.",
    "M45",
    "G90",
    "G91 X.5 L3",
    "L101",
    "L203",
    "L+R2",
    "L301 G66",
    "L401 G66",
    "G67",
    "R2+100.",
    "R2+301.",
    "R2+901.",
    "R2+R3",
    "M98 P2",
    "M98 P3",
    "#IF V1=1 THEN GOTO :A",
    "#SET RND 2",
];

fn text(seed: &mut u64) -> String {
    let mut draw = |limit: u64| {
        *seed ^= *seed << 13;
        *seed ^= *seed >> 7;
        *seed ^= *seed << 17;
        *seed % limit
    };
    let mut blocks = |count: u64| -> String {
        (0..draw(count)).map(|_| format!("{}\n", BLOCKS[draw(24) as usize])).collect()
    };
    let subs: String = (1..5).map(|sub| format!("L{sub}00\n{}M17\n", blocks(4))).collect();
    let main = format!("{}#:A\n{}", blocks(8), blocks(8));
    format!(
        "O1\n{subs}M30\n{main}#IF V2=1 THEN GOTO :A\n{}M2\nO2\n{}M99\nO3\n{}M99\n",
        blocks(5),
        blocks(4),
        blocks(4)
    )
}

fn check(source: &str, seed: &mut u64) {
    let control = Control::plain("fadal").unwrap();
    let parsed = parse_file(source.as_bytes(), parse_line);
    let texts = programs(&parsed.blocks);
    let others = Others::of(&texts, &control);
    for (at, text) in texts.iter().enumerate() {
        let shape = Shape::new(text.blocks, &control);
        let found = Flow::new(text.blocks, &control, &shape, (&others, at));
        let mut lefts = Vec::new();
        for round in 0..3 {
            let ranks = (0..shape.leaders.len() as u32).map(|run| match round {
                0 => u32::MAX - run,
                _ => {
                    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    (*seed >> 40) as u32
                }
            });
            let other = Flow::ranked(ranks.collect(), text.blocks, &control, &shape, (&others, at));
            for leader in &shape.leaders {
                assert_eq!(found.at(*leader), other.at(*leader), "block {leader} of {source}");
            }
            lefts.push(other.left());
        }
        let left = found.left();
        assert!(lefts.iter().all(|other| *other == left), "{source}");
    }
}

#[test]
fn what_is_found_does_not_hang_on_the_order_of_visits() {
    for seed in 1..400u64 {
        let mut seed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        check(&text(&mut seed), &mut seed);
    }
    for (_, source) in testing::programs("fadal") {
        check(&String::from_utf8_lossy(&source), &mut 1);
    }
}
