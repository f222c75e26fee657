//! Colours statics: two share a register if neither is written, by whatever program or by an operator whom a stop asks for
//! it, while the other is live.

use crate::canon::Op;
use crate::ir::analysis::{BitRow, LiveStatics, Temps};
use crate::ir::{Block, BlockId, Class, Expr, Module, Place, Program, Stmt, StmtKind, TermKind, Var};
use crate::legalize::registers::names::whose;
use crate::text::variable_names;

/// The colours of a library's statics.
pub(super) struct Statics {
    live: LiveStatics,
    /// By place in the universe.
    colours: Vec<u32>,
    /// By program: what callers need after calls that come to run it.
    through: Vec<BitRow>,
}

/// What lives at the same time as what.
struct Interference {
    apart: Vec<BitRow>,
    /// What is copied to one another, and would best share a register.
    copies: Vec<(usize, usize)>,
}

impl Statics {
    /// Of a library; none if it has no statics.
    ///
    /// `prefixes` are what stands before the numbers of variables on the source.
    pub fn of(module: &Module, prefixes: &[&str]) -> Option<Self> {
        let mut any = false;
        for program in &module.programs {
            program.variables(&mut |var| any |= var.class == Class::Static);
        }
        if !any {
            return None;
        }
        let live = LiveStatics::of(module);
        let colours = Interference::of(module, &live, prefixes).colours();
        let through = live.through(module);
        Some(Self { live, colours, through })
    }

    /// The colour of a static.
    pub fn colour(&self, var: Var) -> Option<u32> {
        self.colours.get(self.live.universe().place(var)?).copied()
    }

    /// The colours of a set.
    pub fn colours(&self, row: &BitRow) -> Temps {
        let mut colours = Temps::default();
        let places = self.colours.iter().enumerate().filter(|(at, _)| row.has(*at));
        places.for_each(|(_, colour)| colours.insert(*colour));
        colours
    }

    /// The highest colour.
    pub fn highest(&self) -> u32 {
        self.colours.iter().copied().max().unwrap_or(0)
    }

    /// The colours of what callers need after calls that come to run a program.
    pub fn through(&self, program: usize) -> Temps {
        self.colours(&self.through[program])
    }

    /// The colours of what callers need after calls.
    pub fn over_calls(&self) -> impl Iterator<Item = u32> + '_ {
        let any = |at: &usize| self.through.iter().any(|row| row.has(*at));
        (0..self.colours.len()).filter(any).map(|at| self.colours[at])
    }

    /// The colours of all that a program, its callees included, may write.
    pub fn written(&self, program: usize) -> Temps {
        self.colours(self.live.written(program))
    }

    /// By block, and by statement with one more for its end: the colours of what is live after it.
    pub fn live_after(&self, index: usize, program: &Program) -> Vec<Vec<Temps>> {
        let mut all: Vec<Vec<Temps>> =
            program.blocks.iter().map(|block| vec![Temps::default(); block.stmts.len() + 1]).collect();
        self.live.each_end(program, index, &mut |id, block, end| {
            let after = &mut all[id.index()];
            after[block.stmts.len()] = self.colours(end);
            self.live
                .backward(index, block, &mut end.clone(), &mut |at, _, live| after[at] = self.colours(live));
        });
        all
    }
}

impl Interference {
    fn of(module: &Module, live: &LiveStatics, prefixes: &[&str]) -> Self {
        let universe = live.universe();
        let apart = vec![universe.none(); universe.vars().len()];
        let mut found = Self { apart, copies: Vec::new() };
        for (index, program) in module.programs.iter().enumerate() {
            live.each_end(program, index, &mut |_: BlockId, block: &Block, end: &BitRow| {
                if let TermKind::Call { call, .. } = &block.term.kind {
                    for callee in live.callees(index, call) {
                        found.over_call(end, live.written(callee));
                    }
                }
                live.backward(index, block, &mut end.clone(), &mut |_, stmt, after| {
                    found.write(stmt, after, live);
                    for name in named_at_stop(stmt, prefixes) {
                        let held = program.held.iter().find(|(_, held)| *held == name);
                        if let Some(at) = held.and_then(|(var, _)| live.universe().place(*var)) {
                            found.apart[at].join(after);
                        }
                    }
                });
            });
        }
        found.mirror();
        found
    }

    /// What is live over a call, and what the call may write.
    fn over_call(&mut self, after: &BitRow, written: &BitRow) {
        for (_, apart) in self.apart.iter_mut().enumerate().filter(|(at, _)| after.has(*at)) {
            apart.join(written);
        }
    }

    fn write(&mut self, stmt: &Stmt, after: &BitRow, live: &LiveStatics) {
        let Some(Place::Var(var)) = stmt.kind.target() else { return };
        let Some(at) = live.universe().place(*var) else { return };
        let mut after = after.clone();
        // Under block skip the old value may survive.
        if let StmtKind::Assign { value: Expr::Var(from), .. } = &stmt.kind
            && stmt.site.skip.is_none()
            && let Some(from) = live.universe().place(*from)
        {
            // Both hold the same from here on; whoever writes one of them later sets them apart.
            after.remove(from);
            self.copies.push((at, from));
        }
        self.apart[at].join(&after);
    }

    fn mirror(&mut self) {
        for one in 0..self.apart.len() {
            self.apart[one].remove(one);
            for other in 0..one {
                if self.apart[one].has(other) {
                    self.apart[other].insert(one);
                } else if self.apart[other].has(one) {
                    self.apart[one].insert(other);
                }
            }
        }
    }

    /// The lowest colour that no neighbour has, or that of a copy if it is free.
    fn colours(&self) -> Vec<u32> {
        let mut colours: Vec<u32> = Vec::with_capacity(self.apart.len());
        for (at, apart) in self.apart.iter().enumerate() {
            let mut taken = Temps::default();
            let coloured = colours.iter().enumerate();
            coloured.filter(|(other, _)| apart.has(*other)).for_each(|(_, colour)| taken.insert(*colour));
            let partners = self.copies.iter().filter_map(|(a, b)| match at {
                _ if at == *a => colours.get(*b),
                _ if at == *b => colours.get(*a),
                _ => None,
            });
            let shared = partners.copied().find(|colour| !taken.has(*colour));
            colours.push(shared.unwrap_or_else(|| lowest(&taken, 0)));
        }
        colours
    }
}

/// The variables that a stop's text names: whoever reads it may set them.
pub(super) fn named_at_stop(stmt: &Stmt, prefixes: &[&str]) -> Vec<String> {
    let comments = || stmt.site.comments.iter().map(|comment| &*comment.text).collect();
    let texts: Vec<&str> = match &stmt.kind {
        StmtKind::StopMessage { text, .. } => vec![text],
        StmtKind::Nc(nc) if nc.has(Op::Stop) => comments(),
        _ => Vec::new(),
    };
    let names = |text| {
        let names = variable_names(text, prefixes).into_iter();
        names.map(move |name| format!("{}{}{}", name.prefix, name.number, whose(&text[name.at.end..])))
    };
    texts.into_iter().flat_map(names).collect()
}

/// The lowest colour after `first` that is not taken.
pub(super) fn lowest(taken: &Temps, first: u32) -> u32 {
    let mut lowest = first + 1;
    while taken.has(lowest) {
        lowest += 1;
    }
    lowest
}
