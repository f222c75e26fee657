//! By what single passes of a thread run out at their end.
//!
//! Law: on each control a setting or a parameter says it, and no word. Where both are known and differ, passes that do not run out on the source
//! are put between the codes that switch it off and on again on the target; else the target must be set as the source is. Side condition: the
//! block that ends the passes follows on every way, with no thread of many passes before it. Where one of them is not known a person must
//! look, once for the library. Of two controls without such a setting both have the parameter of their maker.
//! Counter-example: a first block of a thread of many passes, which changes the parameter on a control that has both.

use super::left_settings::{Left, left_of};
use super::setting_values::{So, tell};
use super::settings::{setting, stand_in};
use super::thread_form::apart;
use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Setting};
use crate::ir::{Block, Module, Nc, NcItem, Program, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::codes::ahead::ahead;
use crate::legalize::{Context, Modal};
use std::collections::BTreeMap;

/// What says it: its name, and in leads, if the profile gives that.
type By = Option<(String, Option<f64>)>;

/// Settles it for a library; true where it writes codes.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let own =
        [context.source, context.target].map(|control| setting(control, Op::Threading, Role::ThreadRunOut));
    let is_set = own.iter().any(Option::is_some);
    let (ours, theirs) = (by(context.source, module), by(context.target, module));
    let known = |one: &By| one.as_ref().and_then(|(_, value)| *value);
    match (known(&ours), known(&theirs)) {
        (Some(here), Some(there)) if (here - there).abs() < 1e-9 => false,
        (Some(here), Some(_)) => settle(module, here, &theirs, context),
        _ if is_set => {
            ask(module, (&ours, &theirs), context);
            false
        }
        _ => false,
    }
}

/// What says it on a control. A parameter that blocks before threads set to something else is not known.
fn by(control: &Control, module: &Module) -> By {
    let own = setting(control, Op::Threading, Role::ThreadRunOut);
    let stands = stand_in(control, Op::Threading, Role::ThreadRunOut);
    let is_own = own.is_some();
    let found = own.or(stands)?;
    Some((found.0.to_owned(), found.1.filter(|leads| is_own || !is_changed(*leads, module))))
}

/// True where a block of the library before threads may set another run-out.
fn is_changed(leads: f64, module: &Module) -> bool {
    let mut setups =
        module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    setups.any(|stmt| {
        let Some(nc) = stmt.kind.nc().filter(|nc| nc.has(Op::ThreadingSetup)) else { return false };
        let words = [Role::ThreadForm, Role::ThreadRunOut].into_iter();
        let mut values: Vec<_> = words.filter_map(|role| Some((role, nc.word(role)?.clone()))).collect();
        let known = apart(&mut values);
        let mut run_outs = values.iter().filter(|(role, _)| *role == Role::ThreadRunOut);
        !known || run_outs.any(|(_, value)| value.constant().is_none_or(|own| (own - leads).abs() > 1e-9))
    })
}

/// Makes passes run out as they do on the source, by codes or by what the target must be set to.
fn settle(module: &mut Module, leads: f64, theirs: &By, context: &mut Context<'_>) -> bool {
    let codes = [Op::ThreadRunOutOff, Op::ThreadRunOutOn];
    let has = codes.iter().all(|op| context.target.code_for(*op, &BTreeMap::new()).is_some());
    let (mut changed, mut kept) = (false, Vec::new());
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        let Some(span) = stmts.find(|stmt| stmt.kind.has_op(Op::ThreadingPass)).map(|stmt| stmt.site.span)
        else {
            continue;
        };
        if leads == 0.0
            && has
            && switched(program, &program.ids().map(|id| facts.at(index, id)).collect::<Vec<_>>())
        {
            changed = true;
            continue;
        }
        let Some((name, Some(there))) = theirs else { continue };
        let whole = context.target.setting_row(name).map_or(1.0, Setting::whole);
        let as_set = |value: f64| (value * whole * 1e6).round() / 1e6;
        let is = (Op::ThreadingPass, Role::ThreadRunOut);
        if let Some(what) = left_of(is, Some(leads), Some(*there), context.target) {
            let (name, value) = (Some(name.as_str().into()), Some(as_set(leads)));
            let left = So::Left(Left { what, name, value, unit: None });
            kept.push((index, vec![(span, String::new(), String::new(), left)]));
            continue;
        }
        let (kind, number) = name.split_once('.').unwrap_or(("setting", name));
        let what = format!(
            "{kind} {number} of the {} must be {} while this program runs: its single passes of threads run out by that; its profile says {}",
            context.target.dialect().title,
            as_set(leads),
            as_set(*there)
        );
        let help = format!(
            "set it so before the program is run; if the machine is always set so, write in its profile, under [{kind}s]: {number} = \"{}\"",
            as_set(leads)
        );
        let told = Diagnostic::new(Code::Conditional, span, what.as_str()).with_help(help);
        let predicate = Predicate::Setting(name.as_str().into(), as_set(leads));
        context.add_once(index, &what, told.assuming(predicate));
    }
    tell(kept, &[], module, context);
    changed
}

/// Puts the passes of a program between the two codes; false, and nothing is changed, where the end of some is not known.
fn switched(program: &mut Program, states: &[Modal]) -> bool {
    let groups: Option<Vec<_>> = program.blocks.iter().zip(states).map(groups).collect();
    let Some(groups) = groups else { return false };
    for (block, groups) in program.blocks.iter_mut().zip(groups) {
        if groups.is_empty() {
            continue;
        }
        let mut out = Stmts::with_capacity(block.stmts.len() + 2 * groups.len());
        for (at, mut stmt) in std::mem::take(&mut block.stmts).into_iter().enumerate() {
            let span = stmt.site.span;
            if groups.iter().any(|(first, _)| *first == at) {
                out.push(ahead(&mut stmt, vec![NcItem::Op(Op::ThreadRunOutOff)]));
            }
            out.push(stmt);
            if groups.iter().any(|(_, last)| *last == at) {
                // After the block that ends the passes: a block without an axis may make the one in force once more.
                let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::ThreadRunOutOn)] });
                out.push(Stmt { kind, site: SourceInfo { span, ..SourceInfo::default() } });
            }
        }
        block.stmts = out;
    }
    true
}

/// The passes of a block: where they begin, and the statement that ends them. None where none of its own does, and where a pass may be in
/// force before: a block without an axis may make that once more.
fn groups((block, state): (&Block, &Modal)) -> Option<Vec<(usize, usize)>> {
    let (mut found, mut open, mut state) = (Vec::new(), None, state.clone());
    for (at, stmt) in block.stmts.iter().enumerate() {
        let before = state.op(Group::Motion);
        state.step(stmt);
        let StmtKind::Nc(nc) = &stmt.kind else {
            if open.is_some() && matches!(stmt.kind, StmtKind::ModalCall(_)) {
                return None;
            }
            continue;
        };
        let pass = nc.has(Op::ThreadingPass);
        if pass && stmt.site.skip.is_some() || open.is_some() && nc.has(Op::Threading) {
            return None;
        }
        let other = nc.ops().any(|op| op.group() == Group::Motion && op != Op::ThreadingPass);
        match open {
            None if pass => {
                before.filter(|op| !op.is_pass())?;
                open = Some(at);
            }
            Some(first) if other => {
                if stmt.site.skip.is_some() {
                    return None;
                }
                found.push((first, at));
                open = None;
            }
            _ => {}
        }
    }
    // The end of a program may not switch it on again: whoever runs next would find it off.
    open.is_none().then_some(found)
}

/// The target's setting as the source's profile has it, which blocks may have changed since: a run that begins with the program finds it so.
fn as_on_source(theirs: &By, context: &Context<'_>) -> Option<Predicate> {
    let (_, leads) = stand_in(context.source, Op::Threading, Role::ThreadRunOut)?;
    let (name, there) = theirs.as_ref()?;
    let whole = context.target.setting_row(name).map_or(1.0, Setting::whole);
    let leads = leads.filter(|leads| there.is_some_and(|there| (there - leads).abs() > 1e-9))?;
    Some(Predicate::Setting(name.as_str().into(), (leads * whole * 1e6).round() / 1e6))
}

/// Says that one of the two is not known.
fn ask(module: &Module, (ours, theirs): (&By, &By), context: &mut Context<'_>) {
    let of = |one: &By, control: &Control| {
        let name = one.as_ref().map_or_else(|| "a parameter".into(), |(name, _)| name.replacen('.', " ", 1));
        format!("{name} ({})", control.dialect().title)
    };
    let what = format!(
        "a single pass of a thread runs out at its end by {} on the source, and by {} on the target: make sure that both say the same",
        of(ours, context.source),
        of(theirs, context.target)
    );
    let open = |one: &By, control: &Control| {
        let open = one.as_ref().filter(|(name, value)| value.is_none() && control.leaves_open(name));
        open.map(|(name, _)| name.clone())
    };
    let changed = |one: &By, control: &Control| {
        let set = one.as_ref().filter(|(name, value)| value.is_none() && !control.leaves_open(name));
        set.map(|(name, _)| name.replacen('.', " ", 1))
    };
    let set = changed(ours, context.source).or_else(|| changed(theirs, context.target));
    let help = set.map(|name| {
        format!(
            "the profile says {name}, but first blocks of G76 in the library set it to another value (the third and fourth digit of their P): the last \
             one that ran counts. Write the first block of a G76 with the run-out of these passes before them, or look at which \
             program runs before"
        )
    });
    for (index, program) in module.programs.iter().enumerate() {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        if let Some(stmt) = stmts.find(|stmt| stmt.kind.has_op(Op::ThreadingPass)) {
            let mut finding = Diagnostic::new(Code::Conditional, stmt.site.span, what.clone());
            if let Some(name) = open(ours, context.source) {
                finding = finding.lacking(name);
            }
            if let Some(name) = open(theirs, context.target) {
                finding = finding.lacking_there(name);
            }
            if !program
                .blocks
                .iter()
                .flat_map(|block| &block.stmts)
                .any(|stmt| stmt.kind.has_op(Op::Threading))
                && let Some(as_there) = as_on_source(theirs, context)
            {
                finding = finding.assuming(as_there);
            }
            if let Some(help) = &help {
                finding = finding.with_help(help.clone());
            }
            context.add_once(index, &what, finding.asked_once());
        }
    }
}
