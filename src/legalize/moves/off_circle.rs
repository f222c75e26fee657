//! Arcs whose end does not lie on their circle.
//!
//! Law: the end of an arc is as far from its centre as its start. Where the numbers of the text say otherwise by more than
//! words round, the program says no arc: one control stops at an alarm, another goes there by a curve of its own. So it is
//! reported, whatever both would do. Side conditions: the centre counts from the start; the words are numbers; absolute words
//! stand there only where the blocks just before say where the tool is. Counter-example: `G2 X#1 I5.`, which only a run decides.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::{self, BlockId, Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::moves::short_arcs::{is_arc, keeps, stands};
use crate::legalize::{Context, Modal};

/// How far an end may lie off, millimetres: digits that a post leaves out stay below it.
const MOST_OFF: f64 = 0.05;

/// Axes, their steps, and the words of a centre along them.
const AXES: [(Role, Role, Role); 3] = [
    (Role::X, Role::StepX, Role::ArcI),
    (Role::Y, Role::StepY, Role::ArcJ),
    (Role::Z, Role::StepZ, Role::ArcK),
];

/// True for arcs whose centre is known to count from their start. While a lathe mills with C its words are other ones.
pub fn concerns(features: &Features, source: &Control) -> bool {
    (features.op(Op::ArcCw) || features.op(Op::ArcCcw))
        && !features.op(Op::PolarPlane)
        && source.behaviour(Question::ArcCentre).is_some_and(|row| row.value == "incremental")
}

/// Reports arcs that end off their circle.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.facts_from_absolute(module);
    let lathe = context.source.machine() == Machine::Lathe;
    let plane = plane_of_all(module, lathe);
    for (index, program) in module.programs.iter().enumerate() {
        for (at, block) in program.blocks.iter().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            let mut place = Place { at: [None; 3], lathe, plane };
            for stmt in &block.stmts {
                state.step(stmt);
                let Some(nc) = stmt.kind.nc() else {
                    if !leaves_place(&stmt.kind) {
                        place.at = [None; 3];
                    }
                    continue;
                };
                if !stands(nc) || changes_tool(nc) {
                    place.at = [None; 3];
                }
                if sends(nc) || state.may_call() {
                    continue;
                }
                if let Some(off) = place.off(nc, &state).filter(|off| *off > MOST_OFF) {
                    context.add(index, Diagnostic::new(Code::Conditional, stmt.site.span, told(off)));
                }
                place.step(nc, &state, stmt.site.skip.is_some());
            }
        }
    }
}

/// The plane that programs begin in, by the kind of machine; none if a block of the library names another one.
fn plane_of_all(module: &Module, lathe: bool) -> Option<Op> {
    let plane = if lathe { Op::PlaneZx } else { Op::PlaneXy };
    let mut ops = (module.programs.iter().flat_map(|program| &program.blocks))
        .flat_map(|block| &block.stmts)
        .filter_map(|stmt| stmt.kind.nc())
        .flat_map(Nc::ops);
    (!ops.any(|op| op.group() == Group::Plane && op != plane)).then_some(plane)
}

/// True for what changes no coordinates: a write to an offset does (`#5221=1.`).
fn leaves_place(kind: &StmtKind) -> bool {
    matches!(kind, StmtKind::Comment | StmtKind::Assign { target: ir::Place::Var(_), .. })
}

/// True for what shifts coordinates by a tool's offset: until the next words, where the tool stands in them is not known.
fn changes_tool(nc: &Nc) -> bool {
    nc.word(Role::Tool).is_some() || nc.ops().any(|op| op.group() == Group::LengthComp)
}

/// True for what gives axis words another meaning, or the tool another place than they say.
fn sends(nc: &Nc) -> bool {
    let names_zero = |op: Op| matches!(op.group(), Group::Units | Group::Plane | Group::WorkOffset);
    nc.items.iter().any(|item| matches!(item, NcItem::Code(..)))
        || nc.ops().any(|op| op.takes_axes() || !keeps(op) && !names_zero(op))
}

fn told(off: f64) -> String {
    format!(
        "this arc ends {off:.2} mm off its circle: its end is not as far from its centre as its start. A control stops at an alarm \
         there, or goes to the end by a curve of its own: check the words of the centre, and those of the end"
    )
}

/// Where the tool stands, axis by axis; none if the blocks before do not say it.
struct Place {
    at: [Option<f64>; 3],
    /// True where X words are diameters.
    lathe: bool,
    /// The plane of blocks before which no code says one.
    plane: Option<Op>,
}

impl Place {
    /// Where an axis goes, from where it is: as far as numbers say it. The way of an axis that is not named is 0.
    fn way(&self, axis: usize, nc: &Nc, state: &Modal) -> Option<f64> {
        let (role, step, _) = AXES[axis];
        let real = if self.lathe && axis == 0 { 0.5 } else { 1.0 };
        let number = |word: &Expr| word.constant();
        let way = match (nc.word(role), nc.word(step)) {
            (None, None) => 0.0,
            (None, Some(step)) => number(step)?,
            (Some(word), None) => match state.op(Group::Distance)? {
                Op::Incremental => number(word)?,
                _ => number(word)? - self.at[axis]?,
            },
            (Some(_), Some(_)) => return None,
        };
        Some(way * real)
    }

    /// How far an arc ends off its circle, millimetres; none for what is no arc about a centre, or not of numbers alone.
    fn off(&self, nc: &Nc, state: &Modal) -> Option<f64> {
        if !is_arc(nc, state) || nc.word(Role::ArcRadius).is_some() {
            return None;
        }
        let (first, second) = match state.op(Group::Plane).or(self.plane)? {
            Op::PlaneXy => (0, 1),
            Op::PlaneZx => (2, 0),
            Op::PlaneYz => (1, 2),
            _ => return None,
        };
        let centre = |axis: usize| nc.word(AXES[axis].2).map_or(Some(0.0), Expr::constant);
        let centre = (centre(first)?, centre(second)?);
        let way = (self.way(first, nc, state)?, self.way(second, nc, state)?);
        let (radius, end) = (centre.0.hypot(centre.1), (way.0 - centre.0).hypot(way.1 - centre.1));
        let unit = if state.op(Group::Units) == Some(Op::Inch) { 25.4 } else { 1.0 };
        Some((end - radius).abs() * unit)
    }

    /// Goes where a block sends the tool.
    fn step(&mut self, nc: &Nc, state: &Modal, skips: bool) {
        let distance = state.op(Group::Distance);
        for (axis, (role, step, _)) in AXES.into_iter().enumerate() {
            let number = |word: &Expr| word.constant().filter(|_| !skips);
            match (nc.word(role), nc.word(step)) {
                (None, None) => {}
                (Some(word), None) if distance == Some(Op::Absolute) => self.at[axis] = number(word),
                (Some(word), None) | (None, Some(word)) => {
                    let known = distance.is_some() || nc.word(step).is_some();
                    self.at[axis] =
                        number(word).zip(self.at[axis]).map(|(way, at)| at + way).filter(|_| known);
                }
                (Some(_), Some(_)) => self.at[axis] = None,
            }
        }
    }
}
