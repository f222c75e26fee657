//! Programs that call others, on a control whose calls reach no farther than the file.
//!
//! Law: what a call of a program runs is that program's blocks up to its return; a copy of them after the caller's own
//! blocks, called as a part of the caller, does the same and returns to the same place. The copy is made once, whoever
//! calls it in this file, and its temporaries are no one else's. Side conditions: the library has the program; it does
//! not call itself, by whatever way; locals are statics by now ([`crate::legalize::registers::frames`]).
//! What is called and returns is written as a part of its callers only. A file holds one program there: what else stands
//! in a file of the source is refused if nothing calls it. Counter-example: `M98 P9010` with O9010 outside of the library.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{
    Block, BlockId, Callee, Class, Comment, Expr, Module, Place, Program, SourceInfo, Stmt, StmtKind,
    TermKind, Var,
};
use crate::legalize::calls::inlined;
use crate::legalize::context::Copied;
use crate::legalize::layout::heads::counts;
use crate::legalize::registers::frames::repeats;
use crate::legalize::registers::names::OF;
use crate::legalize::rewrite::highest_temp;
use crate::legalize::{Context, calls_of};
use crate::syntax::ProgramName;
use crate::text::{Span, VariableName, variable_names, variable_to_set};
use std::collections::{BTreeMap, BTreeSet};

/// True if calls on the target reach parts of the same program alone.
pub fn concerns(target: &Control) -> bool {
    let code = |op| target.code_for(op, &BTreeMap::new());
    code(Op::CallLocal).is_some() && code(Op::CallProgram).is_none()
}

/// Copies what programs call into them.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let counts = context.target.code_for(Op::CallLocal, &BTreeMap::new());
    if context.target.letter(Role::CallCount, counts).is_none() {
        module.programs.iter_mut().for_each(|program| repeats::loops(program, |_| true));
    }
    let names: BTreeMap<ProgramName, usize> =
        module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.clone()?, at))).collect();
    let calls: Vec<BTreeMap<usize, Span>> =
        module.programs.iter().map(|program| called(program, &names)).collect();
    let before = module.programs.clone();
    for (index, program) in module.programs.iter_mut().enumerate() {
        let all = reached(index, &calls);
        if all.contains_key(&index) {
            let what = "the program calls itself, by whatever way: the target has no recursion";
            context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, program.site.span, what));
            continue;
        }
        let own = program.blocks.len();
        merge(program, &all, &before, &names, context.source);
        if let Some(most) = context.target.limit("call.all")
            && !inlined::run(program, most, own)
        {
            let what = format!(
                "calls nest deeper than the {most} levels that the target takes, and the program grows too large where \
                 they are written out: move one of the calls up to a program nearer the main program"
            );
            let span = program.site.span;
            context.add_once(index, &what, Diagnostic::new(Code::NoEquivalent, span, what.clone()));
        }
        for (callee, span) in all {
            let name = before[callee].name.as_ref().map(|name| name.short().into_owned()).unwrap_or_default();
            let [caller, callee] = [index, callee].map(|at| context.origins[at]);
            context.copied.push(Copied { caller, callee, span, name });
        }
    }
    leave_first(module, &calls, context);
}

/// The programs of the library that a program calls itself, and where.
fn called(program: &Program, names: &BTreeMap<ProgramName, usize>) -> BTreeMap<usize, Span> {
    let mut found = BTreeMap::new();
    for block in &program.blocks {
        for call in calls_of(block) {
            if let Callee::Program(name) = &call.callee
                && let Some(callee) = names.get(name)
            {
                found.entry(*callee).or_insert(block.term.site.span);
            }
        }
    }
    found
}

/// All that a program comes to by calls, in the order it comes to them, with the place of its own call.
fn reached(index: usize, calls: &[BTreeMap<usize, Span>]) -> BTreeMap<usize, Span> {
    let mut found: BTreeMap<usize, Span> = BTreeMap::new();
    let mut open: Vec<(usize, Span)> = calls[index].iter().map(|(callee, span)| (*callee, *span)).collect();
    while let Some((callee, span)) = open.pop() {
        if found.insert(callee, span).is_none() {
            open.extend(calls[callee].keys().map(|next| (*next, span)));
        }
    }
    found
}

/// Appends the programs, and makes their calls ones of blocks.
fn merge(
    program: &mut Program,
    all: &BTreeMap<usize, Span>,
    library: &[Program],
    names: &BTreeMap<ProgramName, usize>,
    source: &Control,
) {
    let mut entries: BTreeMap<usize, BlockId> = BTreeMap::new();
    for (callee, span) in all {
        let (shift, temps) = (program.blocks.len() as u32, highest_temp(program));
        entries.insert(*callee, BlockId(shift));
        let body = &library[*callee];
        let span = Some(*span).filter(|_| body.file != program.file);
        let mut blocks: Vec<Block> =
            body.blocks.iter().map(|block| copy(block, shift, temps, span)).collect();
        if let Some(first) = blocks.first_mut() {
            first.labels.clear();
            headline(body, span).into_iter().for_each(|line| first.stmts.insert(0, line));
        }
        let known: BTreeSet<Var> = program.held.iter().map(|(var, _)| *var).collect();
        let held = body.held.iter().filter(|(var, _)| !known.contains(var));
        program.held.extend(held.map(|(var, name)| (*var, format!("{name}{}", of(body)))));
        name_locals(&mut blocks, body, program, source);
        program.blocks.extend(blocks);
    }
    for block in &mut program.blocks {
        if let TermKind::Call { call, .. } = &mut block.term.kind
            && let Callee::Program(name) = &call.callee
            && let Some(entry) = names.get(name).and_then(|callee| entries.get(callee))
        {
            call.callee = Callee::Block(*entry);
        }
    }
}

/// What comes after the name of a local of a program where it is a part of another one.
fn of(body: &Program) -> String {
    format!("{OF}{}", body.name.as_ref().map(|name| name.short()).unwrap_or_default())
}

/// Says in texts of a copied program that name a local of it whose that is, as it is called where it is copied to: the caller
/// may have one of the same number, which is another variable unless they share a level.
fn name_locals(blocks: &mut [Block], body: &Program, into: &Program, source: &Control) {
    let prefixes = source.prefixes();
    let of = |name: &VariableName| {
        let name = format!("{}{}", name.prefix, name.number);
        let (var, _) = body.held.iter().find(|(_, held)| *held == name)?;
        let (_, called) = into.held.iter().find(|(held, _)| held == var)?;
        called.strip_prefix(&name).map(str::to_owned)
    };
    let told = |text: &mut String, asked: Option<VariableName>| {
        for name in variable_names(text, &prefixes).into_iter().rev() {
            if (name.sure || asked.as_ref().is_some_and(|asked| asked.at == name.at))
                && let Some(of) = of(&name)
            {
                text.insert_str(name.at.end, &of);
            }
        }
    };
    for stmt in blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        stmt.site.comments.iter_mut().for_each(|comment| told(&mut comment.text, None));
        if let StmtKind::StopMessage { text, .. } | StmtKind::Alarm { text, .. } = &mut stmt.kind {
            let mut whole = String::from(std::mem::take(text));
            let asked = variable_to_set(&whole, &prefixes);
            told(&mut whole, asked);
            *text = whole.into();
        }
    }
}

/// What the copied program is called, as a comment at its head. One that was a part `($1)` of a program here before has a
/// number that an earlier conversion gave it, which nobody knows.
fn headline(body: &Program, span: Option<Span>) -> Option<Stmt> {
    let comments = || body.site.comments.iter().map(|comment| &comment.text);
    let part = comments().any(|text| counts(text));
    let name = body.name.iter().filter(|_| !part).map(|name| name.to_string());
    let words: Vec<String> = name.chain(comments().filter(|text| !counts(text)).cloned()).collect();
    if words.is_empty() {
        return None;
    }
    let comments = [Comment { text: words.join(" "), leading: false }].into_iter().collect();
    let site = SourceInfo { span: span.unwrap_or(body.site.span), comments, ..SourceInfo::default() };
    Some(Stmt { kind: StmtKind::Comment, site })
}

/// A block whose ids and temporaries are moved; of another file it stands for the place of the call.
fn copy(block: &Block, shift: u32, temps: u32, span: Option<Span>) -> Block {
    let mut block = block.clone();
    let var = |var: &mut Var| {
        if var.class == Class::Temp {
            var.number += temps;
        }
    };
    let each = |e: &mut Expr| {
        e.walk_mut(&mut |e| {
            if let Expr::Var(read) = e {
                var(read);
            }
        });
    };
    let (mut before, mut odd) = (None, false);
    for stmt in &mut block.stmts {
        stmt.kind.exprs_mut(&mut { each });
        match &mut stmt.kind {
            StmtKind::Assign { target: Place::Var(target), .. }
            | StmtKind::Input { target: Place::Var(target), .. } => var(target),
            _ => {}
        }
        // Neighbours of one block there are of one block here, and others are not.
        odd ^= before.replace(stmt.site.span).is_some_and(|before| before != stmt.site.span);
        stmt.site.span = span.map_or(stmt.site.span, |span| Span {
            end: span.end.saturating_sub(u32::from(odd)).max(span.start),
            ..span
        });
    }
    block.term.kind.exprs_mut(&mut { each });
    block.term.kind.for_each_target(&mut |id| id.0 += shift);
    // An end that stands nowhere in the source, such as that before a label, is written nowhere.
    if !block.term.site.span.is_empty() {
        block.term.site.span = span.unwrap_or(block.term.site.span);
    }
    block
}

/// Leaves the first program of each file, if it is more than a part of others.
fn leave_first(module: &mut Module, calls: &[BTreeMap<usize, Span>], context: &mut Context<'_>) {
    let mut files: BTreeSet<usize> = BTreeSet::new();
    let mut stays = Vec::new();
    for (index, program) in module.programs.iter().enumerate() {
        let is_called = calls.iter().any(|calls| calls.contains_key(&index));
        let first = files.insert(program.file);
        let stays_here = first && !(is_called && program.returns());
        stays.push(stays_here);
        if stays_here {
            continue;
        }
        let (code, what) = match is_called {
            true => (
                Code::Conditional,
                "calls on the target reach no other file: this program is written as a part of those that call it, and not by itself",
            ),
            false => (
                Code::NoEquivalent,
                "a file of the target holds one program, and nothing in the library calls this one: put it into a \
                 file of its own",
            ),
        };
        context.add_once(index, what, Diagnostic::new(code, program.site.span, what).asked_once());
    }
    let keep = |at: &mut usize| {
        *at += 1;
        stays[*at - 1]
    };
    let (mut program, mut origin) = (0, 0);
    module.programs.retain(|_| keep(&mut program));
    context.origins.retain(|_| keep(&mut origin));
}
