//! Locals that have no value, and arguments that nobody asked for.

use super::looked::{Findings, Looked};
use super::unset;
use crate::canon::{Role, Sys};
use crate::diag::Code;
use crate::ir::analysis::{Vars, calls_of};
use crate::ir::{
    BlockId, Callee, Class, Cond, Expr, NcItem, Place, Program, Relation, StmtKind, TermKind, Var,
};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A local of a program that a person starts is read, and on some way there nothing has set it.
pub(super) fn unset(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, program) in looked.programs().filter(|(at, _)| looked.is_main(*at)) {
        for (var, read) in unset_reads(looked, at, program) {
            let name = looked.name(var);
            let then = read.then();
            let message = format!("{name} is read here, and on some way here nothing has set it: {then}");
            findings.add(program.file, Code::UnsetLocal, read.span, message);
        }
    }
}

/// A call leaves out an argument that its program reads without asking whether it is there.
pub(super) fn missing_argument(looked: &Looked<'_>, findings: &mut Findings) {
    let mut needs: BTreeMap<usize, BTreeMap<Var, Read>> = BTreeMap::new();
    for site in looked.sites().iter().filter(|site| site.call.level) {
        let Some(callee) = site.callee.filter(|callee| !looked.has_hole(*callee)) else { continue };
        let Some(program) = looked.module.programs.get(callee) else { continue };
        let needs = needs.entry(callee).or_insert_with(|| unset_reads(looked, callee, program));
        for (var, read) in needs {
            if site.call.arguments.iter().any(|argument| argument.local == var.number) {
                continue;
            }
            let letter = looked.control.argument_letter(var.number);
            let letter = letter.map(|letter| format!("{letter}, ")).unwrap_or_default();
            let (name, shown, line) =
                (looked.name(*var), looked.shown(callee), looked.line(callee, read.span));
            let then = read.then();
            let message =
                format!("the call does not give {letter}{name}, which {shown} reads at line {line}: {then}");
            findings.add(
                looked.module.programs[site.program].file,
                Code::MissingArgument,
                site.span,
                message,
            );
        }
    }
}

/// A call gives an argument that its program never reads.
pub(super) fn unread_argument(looked: &Looked<'_>, findings: &mut Findings) {
    let mut reads: BTreeMap<usize, Option<Vars>> = BTreeMap::new();
    let mut mentioned: BTreeMap<(usize, Var), bool> = BTreeMap::new();
    for site in looked.sites().iter().filter(|site| site.call.level) {
        let Some(callee) = site.callee else { continue };
        let Some(read) = reads.entry(callee).or_insert_with(|| reads_of(looked, callee)) else { continue };
        for argument in &site.call.arguments {
            let var = Var { class: Class::Local, number: argument.local };
            if read.contains(var)
                || argument.value == Expr::Vacant
                || *mentioned.entry((callee, var)).or_insert_with(|| mentions(looked, callee, var))
            {
                continue;
            }
            let (name, shown) = (looked.name(var), looked.shown(callee));
            let letter = looked.control.argument_letter(var.number);
            let letter = letter.map(|letter| format!("{letter}, ")).unwrap_or_default();
            let message = format!("the call gives {letter}{name}, and {shown} never reads it");
            findings.add(looked.module.programs[site.program].file, Code::UnreadArgument, site.span, message);
        }
    }
}

/// A local is set and no block reads it.
pub(super) fn never_read(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, program) in looked.programs() {
        let called = looked.called(at);
        // Whoever calls it with its own locals may read them after it.
        if called.without || !(looked.is_main(at) || called.with_level) {
            continue;
        }
        let Some(read) = reads_of(looked, at) else { continue };
        let mut told = BTreeSet::new();
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            if let StmtKind::Assign { target: Place::Var(var), .. } = &stmt.kind
                && var.class == Class::Local
                && !read.contains(*var)
                && told.insert(*var)
                && !is_named_more(looked, at, *var)
            {
                let message = format!("{} is set here, and nothing reads it", looked.name(*var));
                findings.add(program.file, Code::NeverRead, stmt.site.span, message);
            }
        }
    }
}

/// Blocks that are looked at before calls.
const MOST: usize = 1 << 20;

/// A call with the locals of its caller leaves one changed that the caller had set and reads afterwards.
pub(super) fn left_changed(looked: &Looked<'_>, findings: &mut Findings) {
    let mut left = MOST;
    for site in looked.sites().iter().filter(|site| !site.call.level) {
        let Some(callee) = site.callee else { continue };
        let (Some(caller), Some(body)) =
            (looked.module.programs.get(site.program), looked.module.programs.get(callee))
        else {
            continue;
        };
        let Some(TermKind::Call { next, .. }) = caller.block(site.block).map(|block| &block.term.kind) else {
            continue;
        };
        let seen = looked.summaries().by_call(site.call);
        let mut written: BTreeSet<Var> = seen.vars().filter(|var| var.class == Class::Local).collect();
        // The ways of a large program with very many calls are not all gone.
        let Some(rest) = left.checked_sub(caller.blocks.len()).filter(|_| !written.is_empty()) else {
            continue;
        };
        left = rest;
        let set = set_before(caller, site.block);
        written.retain(|var| set.contains(var));
        if written.is_empty() {
            continue;
        }
        let given = unset_reads(looked, callee, body);
        for var in written.into_iter().filter(|var| !given.contains_key(var)) {
            if !read_after(caller, *next, var) {
                continue;
            }
            let (name, shown) = (looked.name(var), looked.shown(callee));
            let message =
                format!("{shown} sets {name} too, which the caller has set and reads after the call");
            findings.add(caller.file, Code::LeftChanged, site.span, message);
        }
    }
}

/// The locals that the program has set where a block ends, on some way.
fn set_before(program: &Program, end: BlockId) -> BTreeSet<Var> {
    let mut ways: BTreeMap<BlockId, Vec<BlockId>> = BTreeMap::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        block.term.kind.successors().into_iter().for_each(|to| ways.entry(to).or_default().push(id));
    }
    let (mut seen, mut work, mut set) = (BTreeSet::from([end]), vec![end], BTreeSet::new());
    while let Some(id) = work.pop() {
        let stmts = program.block(id).into_iter().flat_map(|block| &block.stmts);
        set.extend(stmts.filter_map(|stmt| match stmt.kind.target() {
            Some(Place::Var(var)) if var.class == Class::Local => Some(*var),
            _ => None,
        }));
        let before = ways.get(&id).into_iter().flatten().copied();
        work.extend(before.filter(|from| seen.insert(*from)).collect::<Vec<_>>());
    }
    set
}

/// True where a variable is read from a block on before something sets it.
fn read_after(program: &Program, start: BlockId, var: Var) -> bool {
    let reads = |e: &Expr| {
        let mut found = false;
        e.variables(&mut |other| found |= other == var);
        found
    };
    let (mut seen, mut work) = (BTreeSet::from([start]), vec![start]);
    'blocks: while let Some(id) = work.pop() {
        let Some(block) = program.block(id) else { continue };
        for stmt in &block.stmts {
            let mut found = false;
            stmt.kind.exprs(&mut |e| found |= reads(e));
            if found {
                return true;
            }
            if stmt.kind.target() == Some(&Place::Var(var)) && stmt.site.skip.is_none() {
                continue 'blocks;
            }
        }
        let mut found = false;
        block.term.kind.exprs(&mut |e| found |= reads(e));
        if found {
            return true;
        }
        work.extend(
            block.term.kind.successors().into_iter().filter(|to| seen.insert(*to)).collect::<Vec<_>>(),
        );
    }
    false
}

/// True where a block of a program has the name of a variable beside what stands for it in the form: a word that was
/// not understood reads it.
fn mentions(looked: &Looked<'_>, at: usize, var: Var) -> bool {
    named(looked, at, var) > 0
}

/// The same of a variable that the program sets.
fn is_named_more(looked: &Looked<'_>, at: usize, var: Var) -> bool {
    let stmts = looked.module.programs.get(at).into_iter().flat_map(|program| &program.blocks);
    let sets =
        stmts.flat_map(|block| &block.stmts).filter(|stmt| stmt.kind.target() == Some(&Place::Var(var)));
    let places: BTreeSet<Span> = sets.map(|stmt| stmt.site.span).collect();
    named(looked, at, var) > places.len()
}

/// How many blocks of a program have the name of a variable outside of comments, each as often as it has it.
fn named(looked: &Looked<'_>, at: usize, var: Var) -> usize {
    let Some(program) = looked.module.programs.get(at) else { return 0 };
    let Some(input) = looked.inputs.get(program.file) else { return 0 };
    let name = looked.name(var).to_ascii_uppercase();
    let mut spans = BTreeSet::new();
    let mut count = 0;
    for site in program
        .blocks
        .iter()
        .flat_map(|block| block.stmts.iter().map(|stmt| &stmt.site).chain([&block.term.site]))
    {
        if !spans.insert(site.span) {
            continue;
        }
        let mut text = String::from_utf8_lossy(site.span.of(&input.bytes)).into_owned();
        for comment in &site.comments {
            text = text.replacen(&comment.text, "", 1);
        }
        let text = text.to_ascii_uppercase();
        let ends = |at: usize| !text[at + name.len()..].starts_with(|c: char| c.is_ascii_digit());
        count += text.match_indices(&name).filter(|(at, _)| ends(*at)).count();
    }
    count
}

/// What a program reads of its locals, with what it calls without a level; none where that cannot be told.
fn reads_of(looked: &Looked<'_>, start: usize) -> Option<Vars> {
    let (mut seen, mut work, mut read) = (BTreeSet::from([start]), vec![start], Vars::default());
    while let Some(at) = work.pop() {
        let program = looked.module.programs.get(at)?;
        if looked.has_hole(at) {
            return None;
        }
        for block in &program.blocks {
            let mut note = |e: &Expr| read.read(e);
            for stmt in &block.stmts {
                stmt.kind.exprs(&mut note);
            }
            block.term.kind.exprs(&mut note);
            for call in calls_of(block).filter(|call| !call.level) {
                match &call.callee {
                    Callee::Block(_) => {}
                    Callee::Program(name) => {
                        let callee = looked.program_of(name)?;
                        if seen.insert(callee) {
                            work.push(callee);
                        }
                    }
                    Callee::Computed(_) | Callee::Cycle(_) => return None,
                }
            }
            if let TermKind::Chain(_) = &block.term.kind {
                return None;
            }
        }
    }
    Some(read)
}

/// A read of a local that may be vacant.
#[derive(Clone, Copy)]
struct Read {
    span: Span,
    how: How,
}

/// What becomes of a vacant local where it is read.
#[derive(Clone, Copy, PartialEq)]
enum How {
    Speed,
    Word,
    Zero,
}

impl Read {
    fn then(self) -> &'static str {
        match self.how {
            How::Speed => "the word S is then as if it were not there, and the last speed stays in force",
            How::Word => "the word is then as if it were not there",
            How::Zero => "it then counts as 0",
        }
    }
}

/// The first read of each local that may be vacant where nothing is given; tests for vacant and copies are none.
fn unset_reads(looked: &Looked<'_>, at: usize, program: &Program) -> BTreeMap<Var, Read> {
    let mut found = BTreeMap::new();
    if looked.has_hole(at) {
        return found;
    }
    unset::visit(looked, program, &mut |block, at, unset| {
        let mut note = |e: &Expr, span: Span, how: How| {
            e.variables(&mut |var| {
                if unset(&var) {
                    found.entry(var).or_insert(Read { span, how });
                }
            });
        };
        let Some(stmt) = block.stmts.get(at) else {
            let span = block.term.site.span;
            if let TermKind::Branch { cond, .. } = &block.term.kind {
                compared(cond, &mut |e| note(e, span, How::Zero));
            } else if !matches!(block.term.kind, TermKind::Call { .. }) {
                block.term.kind.exprs(&mut |e| note(e, span, How::Zero));
            }
            return;
        };
        let span = stmt.site.span;
        match &stmt.kind {
            // A copy is as vacant as what it copies.
            StmtKind::Assign { target, value } => {
                target.exprs(&mut |e| note(e, span, How::Zero));
                if !matches!((target, value), (Place::Var(_), Expr::Var(_))) {
                    note(value, span, How::Zero);
                }
            }
            StmtKind::Nc(nc) => nc.items.iter().for_each(|item| match item {
                NcItem::Word(Role::Speed, value) if is_alone(value) => note(value, span, How::Speed),
                NcItem::Word(_, value) if is_alone(value) => note(value, span, How::Word),
                NcItem::Word(_, value) | NcItem::Code(_, value) => note(value, span, How::Zero),
                NcItem::Op(_) => {}
            }),
            StmtKind::ModalCall(_) => {}
            kind => kind.exprs(&mut |e| note(e, span, How::Zero)),
        }
    });
    found
}

/// A variable, with a sign or without.
fn is_alone(e: &Expr) -> bool {
    match e {
        Expr::Negate(inner) => matches!(**inner, Expr::Var(_)),
        e => matches!(e, Expr::Var(_)),
    }
}

/// Visits the operands of comparisons other than those that ask for vacant.
fn compared(cond: &Cond, f: &mut dyn FnMut(&Expr)) {
    match cond {
        Cond::Compare(Relation::Equal | Relation::NotEqual, a, b) if is_vacant(a) || is_vacant(b) => {}
        Cond::Compare(_, a, b) => {
            f(a);
            f(b);
        }
        Cond::And(all) | Cond::Or(all) => all.iter().for_each(|cond| compared(cond, f)),
        Cond::Not(inner) => compared(inner, f),
        Cond::Switch(_) => {}
    }
}

pub(super) fn is_vacant(e: &Expr) -> bool {
    matches!(e, Expr::Vacant | Expr::System(Sys::Empty, _))
}
