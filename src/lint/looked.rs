//! What rules see, and where they put what they find.

use super::state::{self, Noted};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::{Cfg, Summaries, calls_of, reachable, span_of};
use crate::ir::{Block, BlockId, Call, Callee, Module, Program, Stmt, StmtKind, TermKind, Var};
use crate::legalize::name_of;
use crate::library::Input;
use crate::syntax::ProgramName;
use crate::text::{LineIndex, Span};
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A library as rules see it: lowered, not changed by any pass.
pub struct Looked<'a> {
    /// The files.
    pub inputs: &'a [Input],
    /// Their control.
    pub control: &'a Control,
    /// All programs.
    pub module: &'a Module,
    names: BTreeMap<&'a ProgramName, usize>,
    sites: Vec<Site<'a>>,
    called: Vec<Called>,
    holes: Vec<bool>,
    modal: bool,
    ends: Vec<bool>,
    summaries: OnceCell<Summaries>,
    cfgs: Vec<OnceCell<Cfg>>,
    noted: OnceCell<Vec<Noted>>,
    lines: Vec<OnceCell<LineIndex>>,
}

/// A call where it stands.
#[derive(Clone, Copy)]
pub(super) struct Site<'a> {
    pub program: usize,
    pub block: BlockId,
    pub call: &'a Call,
    pub span: Span,
    /// The program that is called, where the library has it.
    pub callee: Option<usize>,
}

/// How programs of the library call a program.
#[derive(Clone, Copy, Default)]
pub(super) struct Called {
    /// With a level of locals of its own.
    pub with_level: bool,
    /// With the locals of the caller.
    pub without: bool,
}

impl<'a> Looked<'a> {
    /// Looks at a library.
    pub fn new(inputs: &'a [Input], control: &'a Control, module: &'a Module) -> Self {
        let named = module.programs.iter().enumerate();
        let names: BTreeMap<_, _> = named.filter_map(|(at, p)| Some((p.name.as_ref()?, at))).collect();
        let mut sites = Vec::new();
        let mut called = vec![Called::default(); module.programs.len()];
        for (program, id, block) in blocks(module) {
            for call in calls_of(block) {
                let callee = match &call.callee {
                    Callee::Program(name) => names.get(name).copied(),
                    _ => None,
                };
                if let Some(called) = callee.and_then(|callee| called.get_mut(callee)) {
                    called.with_level |= call.level;
                    called.without |= !call.level;
                }
                sites.push(Site { program, block: id, call, span: span_of(block, call), callee });
            }
            if let TermKind::Chain(name) = &block.term.kind
                && let Some(called) = names.get(name).and_then(|callee| called.get_mut(*callee))
            {
                called.without = true;
            }
        }
        let hole = |program: &Program| {
            let text = inputs.get(program.file).map_or(&[][..], |input| &input.bytes);
            program.blocks.iter().flat_map(|block| &block.stmts).any(|stmt| is_hole(stmt, text))
        };
        Self {
            inputs,
            control,
            module,
            names,
            sites,
            called,
            holes: module.programs.iter().map(hole).collect(),
            ends: module.programs.iter().map(ends_run).collect(),
            modal: module.programs.iter().flat_map(|program| &program.blocks).any(has_modal_call),
            summaries: OnceCell::new(),
            cfgs: module.programs.iter().map(|_| OnceCell::new()).collect(),
            noted: OnceCell::new(),
            lines: inputs.iter().map(|_| OnceCell::new()).collect(),
        }
    }

    /// The programs with their numbers.
    pub(super) fn programs(&self) -> impl Iterator<Item = (usize, &'a Program)> + use<'a> {
        self.module.programs.iter().enumerate()
    }

    /// The program of a name.
    pub(super) fn program_of(&self, name: &ProgramName) -> Option<usize> {
        self.names.get(name).copied()
    }

    /// All calls, in the order of programs.
    pub(super) fn sites(&self) -> &[Site<'a>] {
        &self.sites
    }

    /// How the library calls a program.
    pub(super) fn called(&self, program: usize) -> Called {
        self.called.get(program).copied().unwrap_or_default()
    }

    /// True for a program that a person starts: it ends the run, and nothing calls it.
    pub(super) fn is_main(&self, program: usize) -> bool {
        let called = self.called(program);
        !called.with_level && !called.without && self.ends.get(program).copied().unwrap_or_default()
    }

    /// True where a part of the program was not understood: what it does there is not known.
    pub(super) fn has_hole(&self, program: usize) -> bool {
        self.holes.get(program).copied().unwrap_or_default()
    }

    /// True where any program has such a part.
    pub(super) fn has_holes(&self) -> bool {
        self.holes.contains(&true)
    }

    /// True where moves may call macros.
    pub(super) fn has_modal_calls(&self) -> bool {
        self.modal
    }

    /// What programs write.
    pub(super) fn summaries(&self) -> &Summaries {
        self.summaries.get_or_init(|| Summaries::of(self.module))
    }

    /// The ways of a program, calls stepped over.
    pub(super) fn cfg(&self, program: usize) -> Option<&Cfg> {
        let cfg = self.cfgs.get(program)?;
        Some(cfg.get_or_init(|| Cfg::of(&self.module.programs[program])))
    }

    /// What is to be said of what is in force where.
    pub(super) fn noted(&self) -> &[Noted] {
        self.noted.get_or_init(|| state::noted(self))
    }

    /// A variable as people write it.
    pub(super) fn name(&self, var: Var) -> String {
        name_of(var, self.module, self.control).unwrap_or_else(|| "a value".into())
    }

    /// A program as people call it.
    pub(super) fn shown(&self, program: usize) -> String {
        let found = self.module.programs.get(program);
        match found.and_then(|program| program.name.as_ref()) {
            Some(name) => name.short().into_owned(),
            None => found
                .and_then(|program| self.inputs.get(program.file))
                .map_or_else(|| "the program".into(), |input| input.name.clone()),
        }
    }

    /// The number of the line that a place of a program stands in.
    pub(super) fn line(&self, program: usize, span: Span) -> u32 {
        let file = self.module.programs.get(program).map(|program| program.file);
        let found = file.and_then(|file| Some((self.inputs.get(file)?, self.lines.get(file)?)));
        found.map_or(1, |(input, lines)| {
            lines.get_or_init(|| LineIndex::new(&input.bytes)).place(span.start).0
        })
    }
}

/// All blocks of a library.
pub(super) fn blocks(module: &Module) -> impl Iterator<Item = (usize, BlockId, &Block)> {
    let programs = module.programs.iter().enumerate();
    programs
        .flat_map(|(at, program)| program.ids().zip(&program.blocks).map(move |(id, block)| (at, id, block)))
}

/// Where a block ends: its terminator, or the last statement of one that falls through.
pub(super) fn end_of(program: &Program, block: &Block) -> Span {
    let none = Span::default();
    if block.term.site.span != none {
        return block.term.site.span;
    }
    let last = block.stmts.iter().rev().map(|stmt| stmt.site.span).find(|span| *span != none);
    last.unwrap_or(program.site.span)
}

/// True where a program ends the run, and does not return itself: parts that it calls do.
fn ends_run(program: &Program) -> bool {
    if !program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::End { .. })) {
        return false;
    }
    !program.returns() || {
        let own = reachable(program, BlockId(0));
        let mut kinds = own.iter().filter_map(|id| program.block(*id)).map(|block| &block.term.kind);
        !kinds.any(|kind| matches!(kind, TermKind::Return { .. }))
    }
}

fn has_modal_call(block: &Block) -> bool {
    block.stmts.iter().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)))
}

/// True for a block that was read and not understood: it stands in the form as an empty one.
pub(super) fn is_hole(stmt: &Stmt, text: &[u8]) -> bool {
    if stmt.kind != StmtKind::Comment || !stmt.site.comments.is_empty() {
        return false;
    }
    let text = text.get(stmt.site.span.range()).unwrap_or_default().trim_ascii();
    let digits = |text: &[u8]| text.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut rest = text;
    if let [b'/', behind @ ..] = rest {
        rest = behind[digits(behind)..].trim_ascii_start();
    }
    if stmt.site.sequence.is_some() && rest.first().is_some_and(u8::is_ascii_alphabetic) {
        let behind = rest[1..].trim_ascii_start();
        let behind = behind.strip_prefix(b"+").unwrap_or(behind);
        rest = &behind[digits(behind)..];
    }
    rest.iter().any(u8::is_ascii_alphanumeric)
}

/// What rules found.
#[derive(Default)]
pub struct Findings {
    all: Vec<(usize, Diagnostic)>,
}

impl Findings {
    /// Adds a finding in a file.
    pub fn add(&mut self, file: usize, code: Code, span: Span, message: impl Into<Arc<str>>) {
        self.all.push((file, Diagnostic::new(code, span, message)));
    }

    /// All of them, in the order of files, places and codes, each once.
    pub(super) fn sorted(mut self) -> Vec<(usize, Diagnostic)> {
        let key = |(file, found): &(usize, Diagnostic)| (*file, found.span.start, found.span.end, found.code);
        self.all.sort_by_key(key);
        self.all.dedup_by(|a, b| key(a) == key(b) && a.1.message == b.1.message);
        self.all
    }
}
