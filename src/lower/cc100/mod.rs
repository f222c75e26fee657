//! Lowering of the CC100.
//!
//! A file is one program; the cycle G8nn is the file `cyclenn`, or has another usual name for it. Blocks
//! are plain, but three things have no counterpart in other languages and are
//! worked out here on the whole program, each in a file of its own:
//!
//! * jumps look at a condition register that arithmetic sets by the way (`register`);
//! * INC and DEC throw a fraction away, if there is one (`whole`);
//! * a drilling cycle goes on over G0 and G1 (`cycle`).

mod block;
mod constants;
mod cycle;
mod flow;
mod holes;
mod operand;
mod parts;
mod register;
mod table;
#[cfg(test)]
mod tests;
mod tools;
mod value;
mod whole;
mod words;

use super::Lowered;
use super::common::{Findings, Nowhere, site_of};
use crate::canon::Op;
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Builder, Class, Comment, Expr, SourceInfo, StmtKind, Var};
use crate::syntax::{Block, Item, ItemKind, Label, ParsedFile, ProgramName, Target};
use crate::text::Span;
use constants::Constants;
use register::Source;
use std::collections::{BTreeMap, BTreeSet};

/// Lowers the program of a file. Files whose name is that of a cycle are
/// the maker's or the shop's cycles: their M2 returns to the program that called them.
pub fn lower(parsed: &ParsedFile<'_>, file: usize, name: &str, control: &Control) -> Lowered {
    let number = cycle_number(name);
    let mut lowering = Lowering::new(parsed, control, number.is_some());
    lowering.blocks();
    lowering.nowhere.close(&mut lowering.build);
    let Lowering { build, names, mut findings, ends, .. } = lowering;
    let span = Span::new(0, parsed.source.len() as u32);
    let mut program =
        build.finish(number.map(cycle_name), file, SourceInfo { span, ..SourceInfo::default() });
    let pasted = parts::take_mark(&mut program);
    parts::check(&program, &ends, pasted, &mut findings);
    register::resolve(&mut program, &mut findings);
    whole::resolve(&mut program, &mut findings);
    cycle::resolve(&mut program, &mut findings);
    let tape = parsed.blocks.iter().any(|b| b.items.iter().any(|i| i.kind == ItemKind::Tape));
    Lowered { programs: vec![(program, findings.take_list())], names, tape }
}

/// What shops put before the number of a cycle in the name of its file.
const CYCLE_FILES: [&str; 4] = ["cycle", "zyklus", "zyk", "cyc"];

/// The number of the cycle that a file holds: 20 for `cycle20-auto-offset.nc`, `ZYK20.NC` and `G820.NC`.
fn cycle_number(name: &str) -> Option<u32> {
    let stem = std::path::Path::new(name).file_stem()?.to_str()?.to_ascii_lowercase();
    let (rest, code) = match stem.strip_prefix("g8") {
        Some(rest) => (rest, true),
        None => (CYCLE_FILES.iter().find_map(|word| stem.strip_prefix(word))?, false),
    };
    let rest = if code { rest } else { rest.trim_start_matches([' ', '_', '-']) };
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    let goes_on = rest.get(digits.len()..)?.starts_with(char::is_alphanumeric);
    // Only the maker's word may have a letter after its number.
    let is_cycle = if code { digits.len() == 2 && !goes_on } else { !goes_on || stem.starts_with("cycle") };
    digits.parse().ok().filter(|_| is_cycle)
}

/// The name that calls find a cycle by.
fn cycle_name(number: u32) -> ProgramName {
    ProgramName::Name(format!("CYCLE{number}"))
}

/// A program on its way to the IR.
struct Lowering<'a> {
    parsed: &'a ParsedFile<'a>,
    control: &'a Control,
    findings: Findings<'a>,
    build: Builder,
    /// The first block of each `$n`.
    labels: BTreeMap<u32, BlockId>,
    /// Where jumps go to labels that no block has.
    nowhere: Nowhere,
    /// Labels that stand more than once.
    repeated: BTreeSet<u32>,
    /// True where a jump finds its label by a variable, so that labels must stay numbers.
    computed: bool,
    constants: Constants,
    names: BTreeMap<Var, String>,
    /// Blocks that go to the label that a value names.
    dispatches: Vec<(Expr, BlockId)>,
    /// What an assignment without arithmetic does to the condition register.
    load: Source,
    /// Labels whose first place is behind us.
    placed: BTreeSet<u32>,
    /// Where the program goes on after the blocks with a block skip that are being read.
    skipped: Option<BlockId>,
    is_cycle: bool,
    /// Where a cycle ends.
    ends: BTreeSet<Span>,
    temps: u32,
}

impl<'a> Lowering<'a> {
    fn new(parsed: &'a ParsedFile<'a>, control: &'a Control, is_cycle: bool) -> Self {
        let mut lowering = Self {
            parsed,
            control,
            findings: Findings::new(control),
            build: Builder::new(),
            labels: BTreeMap::new(),
            nowhere: Nowhere::default(),
            repeated: BTreeSet::new(),
            computed: parsed.blocks.iter().flat_map(|block| &block.items).any(is_computed),
            constants: Constants::of(&parsed.blocks),
            names: BTreeMap::new(),
            dispatches: Vec::new(),
            load: if control.is(Question::LoadSetsCondition) { Source::LoadThatSets } else { Source::Load },
            placed: BTreeSet::new(),
            skipped: None,
            is_cycle,
            ends: BTreeSet::new(),
            temps: 0,
        };
        for item in parsed.blocks.iter().flat_map(|block| &block.items) {
            if let ItemKind::Label(Label::Number(number)) = item.kind {
                if lowering.labels.contains_key(&number) {
                    lowering.repeated.insert(number);
                } else {
                    let id = lowering.build.fresh();
                    lowering.labels.insert(number, id);
                }
            }
        }
        lowering
    }

    fn blocks(&mut self) {
        let parsed = self.parsed;
        let mut rest = parsed.blocks.as_slice();
        while let Some((block, behind)) = rest.split_first() {
            rest = behind;
            let mut site = site_of(block, parsed.source);
            if self.stops(block)
                && let Some((message, behind)) = behind.split_first()
                && is_message(message)
                && self.findings.is(Question::MessageShowsComment, message.span)
            {
                let shown = site_of(message, parsed.source).comments;
                site.comments.extend(shown.into_iter().map(|comment| Comment { leading: false, ..comment }));
                rest = behind;
            }
            self.block(block, site);
        }
        self.end_skips();
    }

    /// True for a program stop. The comment after it is what the operator reads, and
    /// goes with it into one block, as other controls' programmers write it.
    fn stops(&self, block: &Block) -> bool {
        let letters = super::common::letters(&block.items);
        letters.iter().any(|(letter, value)| {
            let row = value.and_then(|number| self.control.code(*letter, number, &letters));
            row.is_some_and(|row| row.op == Op::Stop)
        })
    }

    /// Adds a statement.
    fn push(&mut self, kind: StmtKind, site: &SourceInfo) {
        self.build.push(kind, site.clone());
    }

    /// A variable of the compiler's own.
    fn temp(&mut self) -> Var {
        self.temps += 1;
        Var { class: Class::Temp, number: self.temps }
    }
}

/// True for a jump to the label that a variable names.
fn is_computed(item: &Item) -> bool {
    matches!(item.kind, ItemKind::Branch { target: Target::Computed(_), .. })
}

/// True for a block that is a comment and nothing else.
fn is_message(block: &Block) -> bool {
    let mut comment = false;
    let only = block.items.iter().all(|item| match item.kind {
        ItemKind::Comment(_) => {
            comment = true;
            true
        }
        ItemKind::Sequence { .. } | ItemKind::EndOfBlock => true,
        _ => false,
    });
    only && comment && block.errors.is_empty()
}
