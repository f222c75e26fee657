//! The solver against a walk of all ways through small random graphs.

use super::*;
use crate::ir::analysis::{CallGraph, Cfg};
use crate::ir::text::parse;
use crate::ir::{Block, BlockId, Module};
use std::borrow::Cow;

/// Numbers that look random, the same for a seed.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % limit
    }
}

/// A program of up to seven blocks, whose ends are drawn.
fn program(random: &mut Random) -> Module {
    let count = 1 + random.below(7);
    let mut text = String::from("program O1 {\n");
    for id in 0..count {
        let [a, b] = [random.below(count), random.below(count)];
        let end = match random.below(8) {
            0 => "end".into(),
            1 => "return".into(),
            2 | 3 => format!("jump block{a}"),
            4 => format!("call block{a} -> block{b}"),
            _ => format!("branch local.1 lt 3 ? block{a} : block{b}"),
        };
        text.push_str(&format!("block{id}:\n {end}\n"));
    }
    parse(&format!("{text}}}\n")).unwrap()
}

/// Sets of eight things as bits: what some way says, and what every way says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Sets {
    some: u8,
    every: u8,
}

impl Lattice for Sets {
    fn join(&mut self, other: &Self) -> bool {
        let joined = Self { some: self.some | other.some, every: self.every & other.every };
        std::mem::replace(self, joined) != joined
    }
}

/// What blocks add and take away, and what ways do.
struct Rules<const BACK: bool> {
    adds: Vec<u8>,
    takes: Vec<u8>,
    /// By `from` and `to`: closed ways, and ways that take something away.
    ways: Vec<u64>,
    entries: Vec<(BlockId, Sets)>,
}

impl<const BACK: bool> Rules<BACK> {
    fn of(random: &mut Random, cfg: &Cfg) -> Self {
        let count = cfg.len();
        let mut draw = |many: usize, limit: u64| (0..many).map(|_| random.below(limit)).collect::<Vec<_>>();
        let few = |bits: Vec<u64>| bits.chunks(2).map(|two| (two[0] & two[1]) as u8).collect();
        let (adds, takes) = (few(draw(2 * count, 256)), few(draw(2 * count, 256)));
        let ways = draw(count * count, 10);
        let mut entries = Vec::new();
        for _ in 0..1 + random.below(2) {
            let bits = random.below(256) as u8;
            entries.push((BlockId(random.below(count as u64) as u32), Sets { some: bits, every: bits }));
        }
        Self { adds, takes, ways, entries }
    }

    fn through(&self, id: usize, state: &mut Sets) {
        for bits in [&mut state.some, &mut state.every] {
            *bits = *bits & !self.takes[id] | self.adds[id];
        }
    }

    fn way(&self, from: BlockId, to: BlockId) -> u64 {
        self.ways[from.index() * self.adds.len() + to.index()]
    }
}

impl<const BACK: bool> Analysis for Rules<BACK> {
    type State = Sets;
    const DIRECTION: Direction = if BACK { Direction::Backward } else { Direction::Forward };

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, Sets)> {
        self.entries.clone()
    }

    fn block(&self, id: BlockId, _: &Block, state: &mut Sets) {
        self.through(id.index(), state);
    }

    fn edge<'s>(&self, from: BlockId, to: BlockId, state: &'s Sets) -> Option<Cow<'s, Sets>> {
        match self.way(from, to) {
            0 => None,
            1 => Some(Cow::Owned(Sets { some: state.some & 0xF0, every: state.every & 0xF0 })),
            _ => Some(Cow::Borrowed(state)),
        }
    }
}

/// What ways of any length bring to each block: each thing that one way may bring is followed by itself.
fn walked<const BACK: bool>(rules: &Rules<BACK>, blocks: usize, cfg: &Cfg) -> Vec<Option<Sets>> {
    let mut seen: BTreeSet<(BlockId, u8)> = rules.entries.iter().map(|(id, sets)| (*id, sets.some)).collect();
    let mut work: Vec<(BlockId, u8)> = seen.iter().copied().collect();
    while let Some((id, bits)) = work.pop() {
        let mut sets = Sets { some: bits, every: bits };
        if id.index() < blocks {
            rules.through(id.index(), &mut sets);
        }
        for to in if BACK { cfg.preds(id) } else { cfg.succs(id) } {
            let (from, into) = if BACK { (*to, id) } else { (id, *to) };
            let bits = match rules.way(from, into) {
                0 => continue,
                1 => sets.some & 0xF0,
                _ => sets.some,
            };
            if seen.insert((*to, bits)) {
                work.push((*to, bits));
            }
        }
    }
    let at = |id| {
        let all = seen.iter().filter(|(at, _)| *at == id).map(|(_, bits)| *bits);
        all.map(|bits| Sets { some: bits, every: bits })
            .reduce(|a, b| Sets { some: a.some | b.some, every: a.every & b.every })
    };
    (0..cfg.len()).map(|id| at(BlockId(id as u32))).collect()
}

fn agrees<const BACK: bool>(seed: u64) {
    let mut random = Random(seed);
    let module = program(&mut random);
    let program = &module.programs[0];
    let cfg = if random.below(2) == 0 { Cfg::of(program) } else { Cfg::whole(program, true) };
    let rules = Rules::<BACK>::of(&mut random, &cfg);
    let (found, walked) = (solve(&rules, program, &cfg), walked(&rules, program.blocks.len(), &cfg));
    for (id, walked) in walked.into_iter().enumerate() {
        let here = found.at(BlockId(id as u32)).copied();
        assert_eq!(here, walked, "seed {seed}, block {id}, backwards: {BACK}");
    }
}

#[test]
fn finds_what_all_ways_bring() {
    for seed in 1..=2000 {
        agrees::<false>(seed * 0x9E37_79B9);
        agrees::<true>(seed * 0x9E37_79B9);
    }
}

/// Counts without end, so that only merging or a limit stops it.
struct Counts {
    gives_up: bool,
}

#[derive(Clone, Debug, PartialEq)]
struct Highest(u32);

impl Lattice for Highest {
    fn join(&mut self, other: &Self) -> bool {
        let before = self.0;
        self.0 = before.max(other.0);
        self.0 != before
    }
}

impl Analysis for Counts {
    type State = Highest;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, Highest)> {
        vec![(BlockId(0), Highest(0))]
    }

    fn block(&self, _: BlockId, _: &Block, state: &mut Highest) {
        state.0 = state.0.saturating_add(1);
    }

    fn merge(&self, state: &mut Highest, other: &Highest, before: u32) -> bool {
        let far = if self.gives_up && before >= 5 { Highest(u32::MAX) } else { other.clone() };
        state.join(&far)
    }
}

#[test]
fn ends_where_a_lattice_does_not() {
    let text = "program O1 {\nblock0:\n jump block1\nblock1:\n branch local.1 lt 3 ? block1 : block2\nblock2:\n end\n}\n";
    let module = parse(text).unwrap();
    let program = &module.programs[0];
    let cfg = Cfg::of(program);
    assert!(solve_within(&Counts { gives_up: false }, program, &cfg, 1000).is_none());
    let found = solve_within(&Counts { gives_up: true }, program, &cfg, 1000).unwrap();
    // Entered with 1, and six times from itself.
    assert_eq!(found.at(BlockId(0)), Some(&Highest(0)));
    assert_eq!(found.at(BlockId(1)), Some(&Highest(u32::MAX)));
}

/// All programs that chains of calls lead to or from, and whether each opens no level on some chain.
fn chains(calls: &[BTreeSet<(usize, bool)>], up: bool, from: usize) -> Vec<Option<bool>> {
    let mut seen = BTreeSet::from([(from, false)]);
    let mut work = vec![(from, false)];
    while let Some((at, level)) = work.pop() {
        for (caller, callee, opens) in calls
            .iter()
            .enumerate()
            .flat_map(|(caller, all)| all.iter().map(move |(to, level)| (caller, *to, *level)))
        {
            let (here, there) = if up { (callee, caller) } else { (caller, callee) };
            if here == at && seen.insert((there, level || opens)) {
                work.push((there, level || opens));
            }
        }
    }
    (0..calls.len())
        .map(|at| seen.contains(&(at, false)).then_some(false).or(seen.contains(&(at, true)).then_some(true)))
        .collect()
}

#[test]
fn finds_what_chains_of_calls_bring() {
    for seed in 1..=1000u64 {
        let mut random = Random(seed * 0x9E37_79B9);
        let count = 1 + random.below(6);
        let calls: Vec<BTreeSet<(usize, bool)>> = (0..count)
            .map(|_| {
                (0..random.below(4)).map(|_| (random.below(count) as usize, random.below(2) == 0)).collect()
            })
            .collect();
        let graph = CallGraph::new(calls.clone());
        // Each program has a bit that any call shows, and one that a level hides.
        let own: Vec<u32> = (0..count).map(|at| 0x101 << at).collect();
        let join = |mine: &mut u32, theirs: &u32, level: bool| {
            let before = *mine;
            *mine |= if level { theirs & 0xFF } else { *theirs };
            *mine != before
        };
        let (mut up, mut down) = (own.clone(), own);
        graph.bottom_up(&mut up, join);
        graph.top_down(&mut down, join);
        for from in 0..count as usize {
            for (found, is_up) in [(&up, true), (&down, false)] {
                for (at, chain) in chains(&calls, is_up, from).into_iter().enumerate() {
                    let bits = found[at] >> from & 0x101;
                    let expected = chain.map_or(0, |level| if level { 1 } else { 0x101 });
                    assert_eq!(bits, expected, "seed {seed}, from {from} at {at}, up: {is_up}");
                }
            }
        }
    }
}

#[test]
fn one_value_is_known_if_every_way_has_it() {
    let joined = |one: Option<u32>, two: Option<u32>| {
        let mut known = Same(one);
        (known.join(&Same(two)), known.0)
    };
    assert_eq!(joined(Some(1), Some(1)), (false, Some(1)));
    assert_eq!(joined(Some(1), Some(2)), (true, None));
    assert_eq!(joined(Some(1), None), (true, None));
    assert_eq!(joined(None, Some(1)), (false, None));
}
