//! The passes of a thread whose numbers are computed, as a loop.
//!
//! Law: the loop works out depth after depth as the cycle does (docs/lathe.md, P5 to P8), and makes the moves of a pass for each.
//! Side conditions: the angle and the number of finishing passes are known, and the blocks before say where the cycle begins, as
//! numbers or by variables that still hold what they held there. Where the thread goes no way along X, or along Z, the division for
//! its sense is an alarm. A height or a first depth of 0 or less is an alarm, as it is of the cycle. Error bound: a pass that would
//! end less than 0.00001 above the last depth of the roughing is that one. Counter-example: a start in increments.

pub(super) mod sums;

use super::cycle_values::Values;
use super::groove_loops::Groove;
use super::pen::{Laid, Pen};
use super::thread_passes::{RUN_OUT, UNKNOWN, alone, depths, is_of_thread, rounded, runs_out_by};
use crate::canon::{Func, Op, Role};
use crate::dialect::Control;
use crate::ir::{Cond, Expr, Nc, NcItem, Program, Relation, SourceInfo, Stmt, StmtKind, TermKind, Var};
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use crate::text::Span;
use std::collections::VecDeque;
pub(super) use sums::{counts, difference, moved, product, quotient, sum, whole};

/// A thread whose numbers are computed; X as diameters, depths and the taper as radii.
#[derive(Debug)]
pub(super) struct Loop {
    site: SourceInfo,
    from: [Expr; 2],
    end: [Expr; 2],
    height: Expr,
    first: Expr,
    least: Expr,
    allowance: Expr,
    /// True where each pass is deeper by the same.
    even: bool,
    /// Where the passes take both flanks in turn: whether the first one takes the leading one.
    leading: Option<bool>,
    /// How far along Z a flank goes with a depth of 1.
    slope: f64,
    taper: Expr,
    /// The lead and the start of the spindle.
    words: Vec<NcItem>,
    finishes: usize,
    /// True where single passes cut it, which run out.
    singles: bool,
    /// The most digits that the target takes.
    digits: Option<u32>,
}

impl Loop {
    /// The loop for a thread; if there is none: why.
    pub(super) fn of(
        stmt: &Stmt,
        values: &Values,
        leading: Option<bool>,
        from: [Option<Expr>; 2],
        (source, target): (&Control, &Control),
    ) -> Result<Self, &'static str> {
        let nc = alone(stmt, is_of_thread)?;
        let value = |role: Role| values.iter().find(|(found, _)| *found == role).map(|(_, value)| value);
        let number = |role: Role| match value(role) {
            Some(value) => value.constant().ok_or(UNKNOWN),
            None => Ok(0.0),
        };
        let run_out = number(Role::ThreadRunOut)?;
        if run_out != 0.0 && !runs_out_by(run_out, nc, target) {
            return Err(RUN_OUT);
        }
        let [Some(x), Some(z)] = from else { return Err(UNKNOWN) };
        let end = |whole: Role, step: Role, at: &Expr| match (nc.word(whole), nc.word(step)) {
            (Some(to), None) => Ok(to.clone()),
            (None, Some(by)) => Ok(sum(at.clone(), by.clone())),
            _ => Err(UNKNOWN),
        };
        let way = number(Role::ThreadInfeed)?;
        let both = way == 2.0 || way == 4.0;
        let angle = number(Role::ThreadAngle)?;
        let own = |role: Role| nc.word(role).or(value(role)).map(|value| whole(value.clone(), role, source));
        let kept = [Role::Lead, Role::ThreadStart];
        let kept = kept.into_iter().filter_map(|role| Some(NcItem::Word(role, nc.word(role)?.clone())));
        let found = Self {
            site: stmt.site.clone(),
            end: [end(Role::X, Role::StepX, &x)?, end(Role::Z, Role::StepZ, &z)?],
            from: [x, z],
            height: own(Role::ThreadHeight).ok_or(UNKNOWN)?,
            first: own(Role::ThreadFirst).ok_or(UNKNOWN)?,
            least: own(Role::ThreadLeast).unwrap_or(Expr::Number(0.0)),
            allowance: own(Role::ThreadAllowance).unwrap_or(Expr::Number(0.0)),
            even: way > 2.0,
            leading: if both { Some(leading.ok_or(UNKNOWN)?) } else { None },
            slope: rounded((angle / 2.0).to_radians().tan(), target.numbers().digits),
            taper: nc.word(Role::Taper).cloned().unwrap_or(Expr::Number(0.0)),
            words: kept.collect(),
            finishes: number(Role::ThreadFinishes)? as usize,
            singles: run_out != 0.0,
            digits: target.numbers().digits,
        };
        found.is_readable().then_some(found).ok_or(UNKNOWN)
    }

    /// True where a value is computed, and none is a count of increments.
    fn is_readable(&self) -> bool {
        let [x, z] = &self.from;
        let [to_x, to_z] = &self.end;
        let all = [x, z, to_x, to_z, &self.height, &self.first, &self.least, &self.allowance, &self.taper];
        all.iter().any(|value| value.constant().is_none()) && !all.iter().any(|value| counts(value))
    }
}

/// What takes the place of a cycle.
#[derive(Debug)]
pub(super) enum Made {
    /// The passes of a thread.
    Thread(Loop),
    /// The pecks of a groove.
    Groove(Groove),
}

/// Writes the loops of a program, each with the block and the place in it where the cycle stands.
pub(super) fn write(program: &mut Program, loops: Vec<((usize, usize), Made)>) {
    let (mut loops, mut place) = (VecDeque::from(loops), (0, 0));
    let mut temps = highest_temp(program);
    rebuild(program, &mut |builder, part| {
        if let Part::Start(id) = &part {
            place = (id.index(), 0);
            return;
        }
        let here = loops.front().is_some_and(|(at, _)| *at == place);
        match if here { loops.pop_front() } else { None } {
            Some((_, Made::Thread(found))) => Pen { builder, temps: &mut temps, found: &found }.write(),
            Some((_, Made::Groove(found))) => {
                Pen { builder, temps: &mut temps, found: &found }.write();
            }
            None => part.keep(builder),
        }
        place.1 += 1;
    });
}

/// What all passes of a thread are made from.
#[derive(Clone)]
struct Held {
    from: [Expr; 2],
    end: [Expr; 2],
    height: Expr,
    /// 1 where the passes go toward larger X, -1 toward smaller ones; the same of Z, where the passes begin at different places.
    sense: [Expr; 2],
    /// 1 where a pass takes the far flank, else 0.
    far: Option<Expr>,
}

impl Pen<'_, Loop> {
    fn write(mut self) {
        let found = self.found;
        if !found.site.comments.is_empty() || found.site.sequence.get().is_some() {
            self.builder.push(StmtKind::Comment, found.site.clone());
        }
        let [x, z] = found.from.clone().map(|value| self.held(value));
        let [to_x, to_z] = found.end.clone().map(|value| self.held(value));
        let [height, first] = [&found.height, &found.first].map(|value| self.held(value.clone()));
        let last = self.held(difference(height.clone(), found.allowance.clone()));
        let along = found.slope != 0.0;
        let sense = [self.sense(&x, &to_x), if along { self.sense(&z, &to_z) } else { Expr::Number(0.0) }];
        let far = found.leading.map(|leading| Expr::Number(f64::from(u8::from(!leading))));
        let held = Held { from: [x, z], end: [to_x, to_z], height, sense, far };
        match self.depths(&first, &last) {
            Some(depths) => self.unrolled(&held, depths),
            None => self.roughing(&held, &first, &last),
        }
        let held = Held { far: None, ..held };
        for _ in 0..found.finishes {
            self.pass(&held, &held.height);
        }
        if found.singles {
            self.block(vec![NcItem::Op(Op::Rapid), NcItem::Word(Role::Z, held.from[1].clone())]);
        }
    }

    /// The depths, where they are known.
    fn depths(&self, first: &Expr, last: &Expr) -> Option<Vec<f64>> {
        let (first, even) = (first.constant()?, self.found.even);
        let least = if even { first } else { self.found.least.constant()? };
        depths((first, even), least, last.constant()?)
    }

    /// Passes of known depths.
    fn unrolled(&mut self, held: &Held, depths: Vec<f64>) {
        for (at, depth) in depths.into_iter().enumerate() {
            let other = held
                .far
                .as_ref()
                .and_then(Expr::constant)
                .map(|far| if at % 2 == 0 { far } else { 1.0 - far });
            let pass = Held { far: other.map(Expr::Number), ..held.clone() };
            self.pass(&pass, &Expr::Number(rounded(depth, self.found.digits)));
        }
    }

    /// The passes down to the last depth, in a loop.
    fn roughing(&mut self, held: &Held, first: &Expr, last: &Expr) {
        self.alarm(first, last);
        let far = held.far.clone().map(|start| {
            let far = self.temp();
            self.set(far, start);
            far
        });
        let held = &Held { far: far.map(Expr::Var), ..held.clone() };
        let compare = |relation, depth: Var, other: Expr| Cond::Compare(relation, Expr::Var(depth), other);
        let (depth, count) = (self.temp(), self.temp());
        self.set(depth, first.clone());
        self.set(count, Expr::Number(1.0));
        let (head, again, done) = (self.builder.fresh(), self.builder.fresh(), self.builder.fresh());
        self.builder.start(head);
        let near = difference(last.clone(), Expr::Number(NEAR));
        self.set_if(compare(Relation::GreaterEqual, depth, near), depth, last.clone());
        self.pass(held, &Expr::Var(depth));
        let cond = Box::new(compare(Relation::GreaterEqual, depth, last.clone()));
        self.builder.end(TermKind::Branch { cond, then: done, otherwise: again }, self.site());
        self.builder.start(again);
        if let Some(far) = far {
            self.set(far, difference(Expr::Number(1.0), Expr::Var(far)));
        }
        self.set(count, sum(Expr::Var(count), Expr::Number(1.0)));
        let least = (!self.found.even && self.found.least.constant() != Some(0.0)).then(|| {
            let least = self.temp();
            self.set(least, sum(Expr::Var(depth), self.found.least.clone()));
            least
        });
        let times = match self.found.even {
            true => Expr::Var(count),
            false => Expr::Call(Func::Sqrt, [Expr::Var(count)].into()),
        };
        self.set(depth, product(first.clone(), times));
        if let Some(least) = least {
            // The greater of the two, without a branch that some runs never take.
            let apart = Expr::Call(Func::Abs, [difference(Expr::Var(depth), Expr::Var(least))].into());
            let twice = sum(sum(Expr::Var(depth), Expr::Var(least)), apart);
            self.set(depth, quotient(twice, Expr::Number(2.0)));
        }
        self.builder.end(TermKind::Jump(head), self.site());
        self.builder.start(done);
    }

    /// The moves of a pass of a depth.
    fn pass(&mut self, held: &Held, depth: &Expr) {
        let found = self.found;
        let ([x, from_z], [to_x, to_z]) = (&held.from, &held.end);
        let left = difference(held.height.clone(), depth.clone());
        let [sense_x, sense_z] = &held.sense;
        let back = product(product(Expr::Number(2.0), sense_x.clone()), left.clone());
        let at = match sense_x.constant() {
            Some(sense) => moved(to_x.clone(), Expr::Number(-2.0 * sense), left.clone()),
            None => difference(to_x.clone(), back),
        };
        let at = self.held(at);
        let begin = match found.slope == 0.0 {
            true => from_z.clone(),
            false => {
                let along = match &held.far {
                    Some(far) => sum(depth.clone(), product(product(Expr::Number(2.0), far.clone()), left)),
                    None => depth.clone(),
                };
                let slope = product(Expr::Number(found.slope), sense_z.clone());
                self.held(moved(from_z.clone(), slope, along))
            }
        };
        let taper = match (found.taper.constant(), found.slope == 0.0) {
            (Some(0.0), _) => Expr::Number(0.0),
            (_, true) => found.taper.clone(),
            _ => {
                let [here, whole] = [&begin, from_z].map(|from| difference(to_z.clone(), from.clone()));
                self.held(quotient(product(found.taper.clone(), here), whole))
            }
        };
        let (at_x, to_z) = (NcItem::Word(Role::X, at.clone()), NcItem::Word(Role::Z, to_z.clone()));
        let to_begin = NcItem::Word(Role::Z, begin);
        if found.singles {
            if found.slope != 0.0 {
                self.block(vec![NcItem::Op(Op::Rapid), to_begin]);
            }
            let taper = (taper.constant() != Some(0.0)).then_some(NcItem::Word(Role::Taper, taper));
            return self.cut(vec![NcItem::Op(Op::ThreadingPass), at_x, to_z], taper);
        }
        let begin_x = moved(at, Expr::Number(2.0), taper);
        self.block(vec![NcItem::Op(Op::Rapid), NcItem::Word(Role::X, begin_x), to_begin]);
        self.cut(vec![NcItem::Op(Op::Thread), at_x, to_z], None);
        self.block(vec![NcItem::Op(Op::Rapid), NcItem::Word(Role::X, x.clone())]);
        self.block(vec![NcItem::Word(Role::Z, from_z.clone())]);
    }

    fn cut(&mut self, mut items: Vec<NcItem>, taper: Option<NcItem>) {
        items.extend(taper);
        items.extend(self.found.words.iter().cloned());
        self.block(items);
    }

    /// An alarm where there is no first depth, or no depth at all, as the cycle has.
    fn alarm(&mut self, first: &Expr, last: &Expr) {
        let none = |value: &Expr| Cond::Compare(Relation::LessEqual, value.clone(), Expr::Number(0.0));
        let open = [first, last].into_iter().filter(|value| value.constant().is_none_or(|one| one <= 0.0));
        let mut open: Vec<Cond> = open.map(none).collect();
        let cond = match open.len() {
            0 => return,
            1 => open.swap_remove(0),
            _ => Cond::Or(open),
        };
        self.stop_if(cond, "THREAD WITHOUT DEPTH");
    }

    /// 1 or -1 by the way from one place to another.
    fn sense(&mut self, from: &Expr, to: &Expr) -> Expr {
        if let (Some(from), Some(to)) = (from.constant(), to.constant()) {
            return Expr::Number(if from == to { 0.0 } else { (to - from).signum() });
        }
        let sense = self.temp();
        self.set(sense, difference(to.clone(), from.clone()));
        let whole = Expr::Call(Func::Abs, [Expr::Var(sense)].into());
        self.set(sense, quotient(Expr::Var(sense), whole));
        Expr::Var(sense)
    }

    fn block(&mut self, mut items: Vec<NcItem>) {
        for item in &mut items {
            if let NcItem::Word(_, Expr::Number(value)) = item {
                *value = rounded(*value, self.found.digits);
            }
        }
        self.builder.push(StmtKind::Nc(Nc { items }), self.site());
    }

    /// Sets a variable under a condition.
    fn set_if(&mut self, cond: Cond, var: Var, value: Expr) {
        let (then, otherwise) = (self.builder.fresh(), self.builder.fresh());
        self.builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, self.site());
        self.builder.start(then);
        self.set(var, value);
        self.builder.start(otherwise);
    }
}

impl Laid for Loop {
    fn span(&self) -> Span {
        self.site.span
    }
}

/// A pass that ends so near to the last depth is the last one.
const NEAR: f64 = 0.00001;
