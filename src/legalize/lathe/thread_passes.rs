//! The passes of a thread's cycle as moves: those that the target's cycle does not make, or all of them.
//!
//! Law: a pass is a move to where the thread begins at its depth, the thread, and the way out and back, as the cycle makes it
//! (docs/lathe.md, P5 to P8). Side conditions: the place where the cycle begins, the end, the height, the taper, the angle and the depths
//! are known numbers, and the thread runs out nowhere, or as the single passes of the target do. Error bound: half of the sixth decimal, or of the last that the target has a digit for. Counter-example: a start that a called program
//! leaves.

use super::cycle_values::Values;
use super::place::Place;
use super::settings::{setting, takes};
use crate::canon::{Group, Op, Role};
use crate::dialect::Control;
use crate::ir::{Expr, Nc, NcItem, SourceInfo, Stmt, StmtKind};

/// A thread: from where the cycle came, and where it ends at full depth, X as diameters; height and taper as radii.
struct Thread {
    from: (f64, f64),
    end: (f64, f64),
    height: f64,
    taper: f64,
    lead: Option<f64>,
    /// The angle of the spindle at which it begins, thousandths of a degree.
    start: Option<f64>,
    /// Between the flanks, degrees.
    angle: f64,
    /// The most digits that the target takes.
    digits: Option<u32>,
}

/// A pass: its depth from the crest, and whether it follows the flank that the tool comes to last.
type Pass = (f64, bool);

impl Thread {
    /// The thread of a cycle; none where a number of it is not known.
    fn of(nc: &Nc, angle: f64, from: Place, target: &Control) -> Option<Self> {
        let number = |role: Role| nc.word(role).map_or(Some(None), |value| value.constant().map(Some));
        let from = (from.x()?, from.z()?);
        let whole = |whole: Role, step: Role, at: f64| -> Option<f64> {
            match (number(whole)?, number(step)?) {
                (Some(to), None) => Some(to),
                (None, Some(by)) => Some(at + by),
                (None, None) => Some(at),
                _ => None,
            }
        };
        let end = (whole(Role::X, Role::StepX, from.0)?, whole(Role::Z, Role::StepZ, from.1)?);
        let (height, taper) = (number(Role::ThreadHeight)??, number(Role::Taper)?.unwrap_or(0.0));
        let (lead, start) = (number(Role::Lead)?, number(Role::ThreadStart)?);
        let digits = target.numbers().digits;
        let thread = Self { from, end, height, taper, lead, start, angle, digits };
        // Beyond twice the height no pass begins.
        let way = (end.1 - from.1).abs() - 2.0 * height * thread.slope();
        (end.0 != from.0 && way > 0.0).then_some(thread)
    }

    /// How far along Z a flank goes with a depth of 1.
    fn slope(&self) -> f64 {
        (self.angle / 2.0).to_radians().tan()
    }

    fn word(&self, role: Role, value: f64) -> NcItem {
        NcItem::Word(role, Expr::Number(rounded(value, self.digits)))
    }

    /// Where a pass begins along Z, where it ends along X, and its taper.
    fn pass(&self, (depth, far): Pass) -> (f64, f64, f64) {
        let (from, end) = (self.from, self.end);
        // How much of the way to the root the place along Z stands for.
        let along = if far { 2.0 * self.height - depth } else { depth };
        let z = from.1 + (end.1 - from.1).signum() * along * self.slope();
        let x = end.0 - 2.0 * (end.0 - from.0).signum() * (self.height - depth);
        (z, x, self.taper * (end.1 - z) / (end.1 - from.1))
    }

    /// The moves of a pass.
    fn moves(&self, pass: Pass) -> [Nc; 4] {
        let word = |role: Role, value: f64| self.word(role, value);
        let (from, end) = (self.from, self.end);
        let (z, x, taper) = self.pass(pass);
        let begin = x + 2.0 * taper;
        let mut thread = vec![NcItem::Op(Op::Thread), word(Role::X, x), word(Role::Z, end.1)];
        thread.extend(self.lead.map(|lead| word(Role::Lead, lead)));
        thread.extend(self.start.map(|start| word(Role::ThreadStart, start)));
        let moves = [
            vec![NcItem::Op(Op::Rapid), word(Role::X, begin), word(Role::Z, z)],
            thread,
            vec![NcItem::Op(Op::Rapid), word(Role::X, from.0)],
            vec![word(Role::Z, from.1)],
        ];
        moves.map(|items| Nc { items })
    }

    /// Passes by the code of single ones, each from where it begins along Z, and the way there and back.
    fn singles(&self, passes: impl Iterator<Item = Pass>) -> Vec<Nc> {
        let to = |z: f64| vec![NcItem::Op(Op::Rapid), self.word(Role::Z, z)];
        let mut out = Vec::new();
        let mut stands = None;
        for pass in passes {
            let (z, x, taper) = self.pass(pass);
            if stands != Some(z) {
                out.push(to(z));
                stands = Some(z);
            }
            let words = [self.word(Role::X, x), self.word(Role::Z, self.end.1)];
            let mut pass = vec![NcItem::Op(Op::ThreadingPass)];
            pass.extend(words);
            pass.extend((taper != 0.0).then(|| self.word(Role::Taper, taper)));
            pass.extend(self.lead.map(|lead| self.word(Role::Lead, lead)));
            pass.extend(self.start.map(|start| self.word(Role::ThreadStart, start)));
            out.push(pass);
        }
        out.push(to(self.from.1));
        out.into_iter().map(|items| Nc { items }).collect()
    }

    /// The blocks of passes.
    fn stmts(&self, passes: impl Iterator<Item = Pass>, stmt: &Stmt) -> Vec<Stmt> {
        stmts(passes.flat_map(|pass| self.moves(pass)), stmt)
    }
}

/// A number with six decimals, or as many as there are digits for.
pub(super) fn rounded(value: f64, digits: Option<u32>) -> f64 {
    let whole = value.abs().max(1.0).log10().floor() as i32 + 1;
    let decimals = digits.map_or(6, |digits| (digits as i32 - whole).clamp(0, 6));
    let factor = 10f64.powi(decimals);
    (value * factor).round() / factor
}

fn stmts(made: impl IntoIterator<Item = Nc>, stmt: &Stmt) -> Vec<Stmt> {
    let site = SourceInfo { span: stmt.site.span, ..SourceInfo::default() };
    made.into_iter().map(|nc| Stmt { kind: StmtKind::Nc(nc), site: site.clone() }).collect()
}

/// The blocks of so many finishing passes after a thread's cycle; none where a number of it is not known.
pub fn finishes(
    stmt: &Stmt,
    (angle, count): (f64, usize),
    from: Place,
    target: &Control,
) -> Option<Vec<Stmt>> {
    let nc = stmt.kind.nc().filter(|_| stmt.site.skip.is_none())?;
    let thread = Thread::of(nc, angle, from, target)?;
    Some(thread.stmts(std::iter::repeat_n((thread.height, false), count), stmt))
}

/// The blocks of so many finishing passes after a thread's cycle that runs out, by single passes, which run out as the cycle of the target does (docs/lathe.md
/// P9): the tool goes along Z to where the last pass of the cycle begins, and back after them. None where a number is not known.
pub(super) fn runs_out(
    stmt: &Stmt,
    (angle, count): (f64, usize),
    from: Place,
    target: &Control,
) -> Option<Vec<Stmt>> {
    let nc = stmt.kind.nc().filter(|_| stmt.site.skip.is_none())?;
    setting(target, Op::Threading, Role::ThreadRunOut).filter(|_| has_singles(nc, target))?;
    let thread = Thread::of(nc, angle, from, target)?;
    Some(stmts(thread.singles(std::iter::repeat_n((thread.height, false), count)), stmt))
}

/// True where single passes of the target take the words of a thread.
fn has_singles(nc: &Nc, target: &Control) -> bool {
    let has = |role: Role| takes(target, Op::ThreadingPass, role) || nc.word(role).is_none();
    takes(target, Op::ThreadingPass, Role::Lead) && has(Role::Taper) && has(Role::ThreadStart)
}

/// True where single passes of the target are known to run out so many leads: by a setting that the cycle runs out by too.
pub(super) fn runs_out_by(run_out: f64, nc: &Nc, target: &Control) -> bool {
    let gives = |row: &crate::dialect::Setting| row.gives == Some(Role::ThreadRunOut);
    let set = setting(target, Op::Threading, Role::ThreadRunOut)
        .filter(|_| target.dialect().settings.iter().any(gives));
    let leads = set.and_then(|(_, leads)| leads);
    leads.is_some_and(|leads| (leads - run_out).abs() < 1e-9) && has_singles(nc, target)
}

/// The block of a cycle that may be written out: it is not skipped, and has nothing beside what is of the cycle.
pub(super) fn alone(stmt: &Stmt, is_of: fn(&NcItem) -> bool) -> Result<&Nc, &'static str> {
    let nc = stmt.kind.nc().filter(|_| stmt.site.skip.is_none()).ok_or(SKIPPED)?;
    if nc.items.iter().all(is_of) { Ok(nc) } else { Err(BESIDE) }
}

/// The blocks of a thread, in place of its cycle: `leading` says whether the passes of a thread that is cut on both flanks begin with
/// the one that the tool comes to first. If there are none: why.
pub(super) fn all(
    stmt: &Stmt,
    values: &Values,
    leading: Option<bool>,
    from: Place,
    target: &Control,
) -> Result<Vec<Stmt>, &'static str> {
    let nc = alone(stmt, is_of_thread)?;
    let number = |role: Role| match values.iter().find(|(found, _)| *found == role) {
        Some((_, value)) => value.constant().ok_or(UNKNOWN),
        None => Ok(0.0),
    };
    // Moves do not run out, and single passes by what the target is set to.
    let run_out = number(Role::ThreadRunOut)?;
    if run_out != 0.0 && !runs_out_by(run_out, nc, target) {
        return Err(RUN_OUT);
    }
    let thread = Thread::of(nc, number(Role::ThreadAngle)?, from, target).ok_or(UNKNOWN)?;
    let first = nc.word(Role::ThreadFirst).and_then(Expr::constant).ok_or(UNKNOWN)?;
    let (evenly, both) = match number(Role::ThreadInfeed)? {
        0.0 | 1.0 => (false, false),
        2.0 => (false, true),
        3.0 => (true, false),
        4.0 => (true, true),
        _ => return Err(UNKNOWN),
    };
    let leading = if both { leading.ok_or(FLANKS)? } else { true };
    let least = if evenly { first } else { number(Role::ThreadLeast)? };
    let allowance = number(Role::ThreadAllowance)?;
    let depths = depths((first, evenly), least, thread.height - allowance).ok_or(DEPTHS)?;
    let roughing =
        depths.into_iter().enumerate().map(|(at, depth)| (depth, both && (at % 2 == 1) == leading));
    let finishing = std::iter::repeat_n((thread.height, false), number(Role::ThreadFinishes)? as usize);
    let passes = roughing.chain(finishing);
    let mut made = match run_out == 0.0 {
        true => thread.stmts(passes, stmt),
        false => stmts(thread.singles(passes), stmt),
    };
    if let Some(head) = made.first_mut() {
        head.site = stmt.site.clone();
    }
    Ok(made)
}

/// True for the code and the words of a thread's cycle.
pub(super) fn is_of_thread(item: &NcItem) -> bool {
    match item {
        NcItem::Op(op) => *op == Op::Threading,
        NcItem::Word(role, _) => matches!(
            role,
            Role::X
                | Role::Z
                | Role::StepX
                | Role::StepZ
                | Role::Lead
                | Role::Taper
                | Role::ThreadStart
                | Role::ThreadHeight
                | Role::ThreadFirst
                | Role::ThreadAngle
                | Role::ThreadInfeed
                | Role::ThreadRunOut
        ),
        NcItem::Code(..) => false,
    }
}

/// The depths of the passes down to `last` (P5, P6): each takes off as much as the first one, or goes as much deeper; none where there
/// are none, or too many to write.
pub(super) fn depths((first, evenly): (f64, bool), least: f64, last: f64) -> Option<Vec<f64>> {
    if first <= 0.0 || last <= 0.0 || least < 0.0 {
        return None;
    }
    let mut out: Vec<f64> = Vec::new();
    loop {
        let count = (out.len() + 1) as f64;
        let next = if evenly { first * count } else { first * count.sqrt() };
        let next = out.last().map_or(next, |before| next.max(if evenly { next } else { before + least }));
        if next >= last - 1e-9 {
            out.push(last);
            return Some(out);
        }
        out.push(next);
        if out.len() >= MOST {
            return None;
        }
    }
}

/// True where the next block with axis words has a code for how it moves, or the program ends before one.
pub(super) fn says_how(next: &[Stmt], ends: bool) -> bool {
    let moves = next.iter().find_map(|stmt| match &stmt.kind {
        StmtKind::Nc(nc) if nc.names_axis() || nc.ops().any(|op| op.group() == Group::Motion) => Some(nc),
        _ => None,
    });
    moves.map_or(ends, |nc| {
        nc.ops().any(|op| op.group() == Group::Motion || op.is_lathe_cycle())
            || nc.ops().any(|op| op == Op::ReferenceReturn)
    })
}

/// More passes are not written out.
const MOST: usize = 200;

pub(super) const SKIPPED: &str = "a switch may skip its block";
pub(super) const BESIDE: &str = "another code or word stands in its block";
pub(super) const RUN_OUT: &str = "it runs out at its end, no source says by which way, and single passes of the target are not known to run out so";
pub(super) const UNKNOWN: &str = "where it begins, or a number of it, is not known here";
const FLANKS: &str = "in which order its flanks are cut is not known";
const DEPTHS: &str = "its depths make no pass, or more than 200";

#[cfg(test)]
mod tests {
    use super::depths;

    /// .4 times the roots of 1, 2, 3 and 4; the step after that is under .1.
    #[test]
    fn the_least_depth_counts_where_a_pass_would_take_less() {
        let found = depths((0.4, false), 0.1, 1.0).unwrap();
        let by_hand = [0.4, 0.565_685, 0.692_820, 0.8, 0.9, 1.0];
        assert_eq!(found.len(), by_hand.len());
        assert!(found.iter().zip(by_hand).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?}");
    }

    #[test]
    fn even_passes_end_at_the_last_depth() {
        assert_eq!(depths((0.25, true), 0.0, 0.6), Some(vec![0.25, 0.5, 0.6]));
        assert_eq!(depths((2.0, true), 0.0, 0.6), Some(vec![0.6]));
        assert_eq!(depths((0.001, true), 0.0, 0.6), None);
        assert_eq!(depths((0.0, false), 0.0, 0.6), None);
        assert_eq!(depths((0.1, false), 0.0, 0.0), None);
    }
}
