//! Writes the flags of a program, and asks them.

use super::conditions::{rewritten, settled};
use super::marks::{At, Marks, unsigned};
use super::outside::given_by;
use crate::canon::Op;
use crate::dialect::{Control, Question};
use crate::ir::{
    Argument, BlockId, Builder, Call, Callee, Class, Cond, Expr, Nc, NcItem, Place, Program, Relation,
    SourceInfo, Stmt, StmtKind, TermKind, Terminator, Var,
};
use crate::legalize::registers::names::numbered_name;
use crate::legalize::rewrite::{Part, rebuild, unless_skipped};
use crate::text::{Span, variable_to_set};

/// Rewrites one program.
pub(super) fn program(index: usize, program: &mut Program, marks: &Marks, source: &Control) {
    let mut at: At = (BlockId(0), 0);
    rebuild(program, &mut |builder, part| match part {
        Part::Start(id) => at = (id, 0),
        Part::Stmt(_) if marks.needless(index, at.0) => {}
        Part::Stmt(stmt) => {
            Here { index, at, marks, source }.stmt(stmt, builder);
            at.1 += 1;
        }
        Part::Term(term) => Here { index, at, marks, source }.end(term, builder),
    });
}

/// A place in a program.
struct Here<'h> {
    index: usize,
    at: At,
    marks: &'h Marks,
    source: &'h Control,
}

impl Here<'_> {
    /// The flag of what may be vacant here.
    fn flag(&self, e: &Expr) -> Option<Var> {
        match e {
            Expr::Var(var) if self.marks.may(self.index, self.at, e) => self.marks.flag(self.index, *var),
            _ => None,
        }
    }

    fn conditions(&self, e: &mut Expr) {
        e.walk_mut(&mut |e| {
            if let Expr::Truth(cond) = e {
                self.condition(cond);
            }
        });
    }

    fn condition(&self, cond: &mut Cond) {
        let old = std::mem::replace(cond, Cond::Switch(0));
        *cond = rewritten(old, &|e| self.flag(e));
    }

    fn stmt(&self, mut stmt: Stmt, builder: &mut Builder) {
        stmt.kind.exprs_mut(&mut |e| self.conditions(e));
        let extra = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
        let written = match &stmt.kind {
            StmtKind::Assign { target: Place::Var(var), value } => Some((*var, self.value_flag(value))),
            StmtKind::Input { target: Place::Var(var), .. } => Some((*var, Expr::Number(1.0))),
            // The operator sets what the message names.
            _ => self.set_by_hand(&stmt).map(|var| (var, Expr::Number(1.0))),
        };
        match stmt.kind {
            StmtKind::Nc(nc) => self.nc(nc, stmt.site, builder),
            StmtKind::ModalCall(mut call) => {
                self.call(&mut call);
                builder.push(StmtKind::ModalCall(call), stmt.site);
            }
            // A copy of itself must take its flag after the value.
            kind => builder.push(kind, stmt.site),
        }
        if let Some((var, value)) = written
            && let Some(flag) = self.marks.flag(self.index, var)
            && value != Expr::Var(flag)
        {
            builder.push(StmtKind::Assign { target: Place::Var(flag), value }, extra);
        }
    }

    /// The variable with a flag that the message of a stop names.
    fn set_by_hand(&self, stmt: &Stmt) -> Option<Var> {
        let text = match &stmt.kind {
            StmtKind::StopMessage { text, .. } => text,
            StmtKind::Nc(nc) if nc.has(Op::Stop) && self.source.is(Question::MessageShowsComment) => {
                &*stmt.site.comments.first()?.text
            }
            _ => return None,
        };
        let named = variable_to_set(text, &[self.source.numbered()?])?;
        let name = format!("{}{}", named.prefix, named.number);
        let classes = [Class::Local, Class::Common, Class::Retained, Class::Global, Class::Parametric];
        let mut vars = classes.map(|class| Var { class, number: named.number }).into_iter();
        vars.find(|var| {
            self.marks.flag(self.index, *var).is_some()
                && numbered_name(*var, self.source).as_deref() == Some(&*name)
        })
    }

    /// What the flag of a variable becomes that gets this value.
    fn value_flag(&self, value: &Expr) -> Expr {
        match value {
            Expr::Vacant => Expr::Vacant,
            value => self.flag(value).map_or(Expr::Number(1.0), Expr::Var),
        }
    }

    fn end(&self, mut term: Terminator, builder: &mut Builder) {
        term.kind.exprs_mut(&mut |e| self.conditions(e));
        match &mut term.kind {
            TermKind::Branch { cond, then, otherwise } => {
                self.condition(cond);
                // A question to what always has a value, or never, is none.
                if let (Some(way), None) = (settled(cond), term.site.skip) {
                    let (to, passed) = if way { (*then, *otherwise) } else { (*otherwise, *then) };
                    term.kind = TermKind::Jump(to);
                    // Past what is not written, no jump is needed that anybody reads.
                    if self.marks.needless(self.index, passed) && term.site.comments.is_empty() {
                        term.site.span = Span::default();
                    }
                }
            }
            TermKind::Call { call, .. } => self.call(call),
            _ => {}
        }
        builder.end(term.kind, term.site);
    }

    /// Arguments bring their flags.
    fn call(&self, call: &mut Call) {
        if !call.level || matches!(call.callee, Callee::Cycle(_)) {
            return;
        }
        let flagged = |argument: &&Argument| self.marks.passes(self.index, call, argument.local);
        let flags = call.arguments.iter().filter(flagged).map(|argument| {
            let local = Var { class: Class::Local, number: argument.local };
            Argument { local: local.flag().number, value: self.value_flag(&argument.value) }
        });
        let flags: Vec<Argument> = flags.filter(|argument| argument.value != Expr::Vacant).collect();
        call.arguments.extend(flags);
        for local in self.marks.outside.flagged(call) {
            let given = given_by(call, local).map(|argument| self.value_flag(&argument.value));
            let value = given.filter(|flag| *flag != Expr::Vacant).unwrap_or(Expr::Number(0.0));
            let flag = Var { class: Class::Local, number: local }.flag();
            call.arguments.push(Argument { local: flag.number, value });
        }
    }

    /// A block once with and once without each word that may be vacant.
    fn nc(&self, mut nc: Nc, site: SourceInfo, builder: &mut Builder) {
        nc.items.retain(|item| !matches!(item, NcItem::Word(_, Expr::Vacant)));
        let flags = nc.items.iter().enumerate().filter_map(|(at, item)| match item {
            NcItem::Word(_, value) => Some((at, self.flag(unsigned(value))?)),
            _ => None,
        });
        let flags: Vec<(usize, Var)> = flags.take(super::MOST_WORDS).collect();
        if flags.is_empty() {
            return builder.push(kind_of(nc), site);
        }
        let end = builder.fresh();
        unless_skipped(builder, site.skip, end);
        let mut site = Some(SourceInfo { skip: None, ..site });
        each_way(&nc, &flags, &mut Vec::new(), &mut site, builder, end);
        builder.start(end);
    }
}

/// A block without words does nothing.
fn kind_of(nc: Nc) -> StmtKind {
    if nc.items.is_empty() { StmtKind::Comment } else { StmtKind::Nc(nc) }
}

/// Asks the flags one after the other, and lays the block down without the words whose flag says so. The first that is
/// laid down has the sequence number and the comments.
fn each_way(
    nc: &Nc,
    flags: &[(usize, Var)],
    without: &mut Vec<usize>,
    site: &mut Option<SourceInfo>,
    builder: &mut Builder,
    end: BlockId,
) {
    let Some(((at, flag), rest)) = flags.split_first() else {
        let items = nc.items.iter().enumerate().filter(|(at, _)| !without.contains(at));
        let items: Vec<NcItem> = items.map(|(_, item)| item.clone()).collect();
        let here = site.take().unwrap_or_default();
        builder.push(kind_of(Nc { items }), here);
        return builder.end(TermKind::Jump(end), SourceInfo::default());
    };
    let (with, not) = (builder.fresh(), builder.fresh());
    let cond = Cond::Compare(Relation::LessEqual, Expr::Var(*flag), Expr::Number(0.0));
    let asked = site.as_ref().map(|site| SourceInfo { span: site.span, ..SourceInfo::default() });
    builder.end(
        TermKind::Branch { cond: Box::new(cond), then: not, otherwise: with },
        asked.unwrap_or_default(),
    );
    builder.start(with);
    each_way(nc, rest, without, site, builder, end);
    builder.start(not);
    without.push(*at);
    each_way(nc, rest, without, site, builder, end);
    without.pop();
}
