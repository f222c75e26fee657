//! Codes of a machine's builder that profiles name.
//!
//! Law: codes of two machines that the shop gives one name do the same. A code whose name the target has not becomes what
//! the source's profile says: it is left out, or is a stop that tells the operator what to do, or an alarm. A person looks at
//! each of these, once for all programs. Side condition: the target's code takes each word that stands beside the source's.
//! Counter-example: `M14 P5` where P is a level, and `M88` of the other machine, which knows no levels.

use crate::assume::Predicate;
use crate::canon::{Act, Auxiliary, Op, Role};
use crate::diag::{Asks, Code, Diagnostic};
use crate::dialect::{SiteCode, Without};
use crate::ir::{Expr, Module, NcItem, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::codes::beside_moves::belongs;
use crate::legalize::codes::left_zeros;
use crate::text::Span;

/// Number of the alarm that stands for a code.
const ALARM: f64 = 100.0;

/// Puts what the profiles say in the place of codes that the target has not.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let zeros = left_zeros::of(module, context);
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            if !block.stmts.iter().any(|stmt| stmt.kind.has_op(Op::Act)) {
                continue;
            }
            for stmt in std::mem::take(&mut block.stmts) {
                replace(stmt, index, &mut block.stmts, context);
            }
        }
    }
    left_zeros::tell(module, &zeros, context);
}

/// Lays down a statement, or what stands for the code in it.
fn replace(mut stmt: Stmt, index: usize, out: &mut Stmts, context: &mut Context<'_>) {
    let span = stmt.site.span;
    let StmtKind::Nc(nc) = &mut stmt.kind else { return out.push(stmt) };
    let named = nc.word(Role::Act).and_then(Expr::constant).and_then(Act::of);
    let Some(act) = named.filter(|_| nc.has(Op::Act)) else { return out.push(stmt) };
    if let Some(row) = context.target.code_of(act) {
        let dropped = |item: &NcItem| match item {
            NcItem::Word(role, _) => act.word_name(*role).is_some_and(|word| Act::is_dropped(&word)),
            _ => false,
        };
        nc.items.retain(|item| !dropped(item));
        let taken = |role: &Role| row.words.values().any(|word| word == role);
        let strange = nc.items.iter().find_map(|item| match item {
            NcItem::Word(role, _) if role.is_act_word() && !taken(role) => act.word_name(*role),
            _ => None,
        });
        if let Some(word) = strange {
            let what = format!(
                "{} of the target takes no word '{word}', which {} has here",
                row.code,
                of(act, context)
            );
            let letter = letter_of(act, &word, context);
            let help = format!(
                "name its letter in the target's profile: words = {{ {letter} = \"{word}\" }} at {}",
                row.code
            );
            let (code, name) = (row.code.as_str().into(), word.as_str().into());
            let told = Diagnostic::new(Code::NoEquivalent, span, what).with_help(help);
            context.add(index, told.asking_for(Asks::Word { target: true, code, letter, name }));
        }
        return out.push(stmt);
    }
    let site = context.source.site_of(act).cloned();
    nc.items.retain(|item| *item != NcItem::Op(Op::Act) && !belongs(item, &NcItem::Op(Op::Act)));
    let stands = stands_for(act, site.as_ref(), index, span, context);
    let emptied = nc.items.is_empty();
    let Some(kind) = stands else {
        if emptied {
            stmt.kind = StmtKind::Comment;
        }
        // A block with nothing in it may be more than nothing to a control.
        if !emptied || stmt.site.sequence.is_some() || !stmt.site.comments.is_empty() {
            out.push(stmt);
        }
        return;
    };
    if matches!(kind, StmtKind::StopMessage { .. }) {
        context.stood_in.insert((context.origin(index), span));
    }
    if emptied {
        stmt.kind = kind;
        return out.push(stmt);
    }
    let late = context.source.acts(Auxiliary::Other).late;
    let aside = Stmt { kind, site: SourceInfo { span, skip: stmt.site.skip, ..SourceInfo::default() } };
    if late {
        out.extend([stmt, aside]);
    } else {
        let head = Stmt { site: std::mem::replace(&mut stmt.site, aside.site), kind: aside.kind };
        out.extend([head, stmt]);
    }
}

/// The letter that a word has at the source's code, by the name that the shop gave it.
fn letter_of(act: Act, word: &str, context: &Context<'_>) -> char {
    let words = context.source.site_of(act).map(|site| &site.words);
    let letters = words.into_iter().flatten().filter(|(_, name)| *name == word);
    letters.filter_map(|(letter, _)| letter.chars().next()).next().unwrap_or('P')
}

/// What takes the place of a code that the target does not have; none if nothing does.
fn stands_for(
    act: Act,
    site: Option<&SiteCode>,
    index: usize,
    span: Span,
    context: &mut Context<'_>,
) -> Option<StmtKind> {
    let name = of(act, context);
    let told = |becomes: &str, check: &str| {
        let answer = site.and_then(|site| site.without).map_or("", Without::name);
        format!("{name} {becomes}, as the source's profile says (do = \"{answer}\"): {check}")
    };
    let text = || site.map(|site| site.text.clone()).unwrap_or_default();
    let (what, kind) = match site.and_then(|site| site.without) {
        Some(Without::Omit) => (told("is left out", "make sure that the target does not need it"), None),
        Some(Without::Stop) => {
            let kind = StmtKind::StopMessage {
                number: Box::new(Expr::Number(1.0)),
                text: text().to_uppercase().into(),
            };
            let check = "make sure that the operator can do it then: the spindle goes on turning, unless the program stops it before";
            (told("is a stop", check), Some(kind))
        }
        Some(Without::Alarm) => {
            let kind =
                StmtKind::Alarm { number: Box::new(Expr::Number(ALARM)), text: text().to_uppercase().into() };
            (told("is an alarm", "make sure that no run comes there"), Some(kind))
        }
        Some(Without::Same) | None => {
            let title = &context.target.dialect().title;
            let what = format!("no code of {title} does what {name} does");
            let (code, given) = match site {
                Some(site) => (site.code.clone(), site.name.clone()),
                None => ("it".into(), None),
            };
            let asks = given.as_deref().map(|name| Asks::There { name: name.into() });
            let help = match given {
                Some(name) => format!(
                    "if the target has a code for it, put it into the target's profile: [[site]] with code, \
                     name = \"{name}\" and text; else write do = \"omit\", \"stop\" or \"alarm\" at {code} in the source's"
                ),
                None => format!("say in the source's profile what becomes of it: target = \"M88\" at {code}"),
            };
            let told = Diagnostic::new(Code::NoEquivalent, span, what).with_help(help);
            context.add(
                index,
                match asks {
                    Some(asks) => told.asking_for(asks),
                    None => told,
                },
            );
            return None;
        }
    };
    // Once for the library: the profile says it, and no program does.
    let told = Diagnostic::new(Code::Conditional, span, what.clone()).asked_once();
    context.add_once(index, &what, told.assuming(Predicate::Substitute(Op::Act)));
    kind
}

/// A code for people: as it is written, and what it does.
fn of(act: Act, context: &Context<'_>) -> String {
    match context.source.site_of(act) {
        Some(site) => site.shown(),
        None => format!("'{}'", act.shown()),
    }
}
