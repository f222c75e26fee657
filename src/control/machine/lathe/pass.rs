//! Single passes of turning, threading and facing, which repeat with each block (B1 to B10).

use super::thread::Lead;
use super::way::Point;
use super::{alarm, sense};
use crate::canon::{Group, Op, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;

/// What the pass in force was told: its end in work coordinates, X as a radius, and its taper.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pass {
    x: Option<f64>,
    z: Option<f64>,
    taper: f64,
    /// True where a code for its own block came after the words.
    crossed: bool,
}

/// Takes a code of motion, which begins afresh (B7), and one for its own block, which may take away what the pass in force was told (B9).
pub fn cross(machine: &mut Machine, command: &Command) {
    if command.of(Group::Motion).is_some() {
        machine.lathe.pass = Pass::default();
    }
    let once = command.ops.iter().any(|op| op.is_for_its_block());
    machine.lathe.pass.crossed |= once && machine.motion.is_pass();
}

/// Makes a pass, if the block asks for one.
pub fn run(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let own = [Role::X, Role::StepX, Role::Z, Role::StepZ, Role::Taper, Role::TaperZ];
    if command.axes().any(|(axis, _)| axis != 0 && axis != 2) {
        return Err(alarm("PS0330", "a pass of an axis other than X and Z"));
    }
    let is_told = own.iter().any(|role| command.word(*role).is_some());
    let goes_on = machine.lathe.pass.is_told() && (is_told || switches(command));
    if machine.lathe.pass.crossed && goes_on {
        if machine.rules.pass_cleared.ask(trace) {
            machine.lathe.pass = Pass::default();
        }
        machine.lathe.pass.crossed = false;
    }
    if !(is_told || machine.lathe.pass.is_whole() && runs_again(machine, command, trace)) {
        return Ok(());
    }
    machine.lathe.after_cycle = false;
    let start = machine.position;
    let a = machine.tool_at();
    machine.lathe.pass.read(command, a, (machine.unit(), machine.incremental));
    let Pass { x: Some(x), z: Some(z), taper, .. } = machine.lathe.pass else {
        return Err(Stop::unnamed("the first block of a pass without X or without Z"));
    };
    trace.doubt("machine:lathe.pass.moves");
    if is_told && own[..4].iter().all(|role| command.word(*role).is_none()) {
        // The taper alone is no way.
        trace.doubt("behaviour:pass.empty");
    }
    let start_of_thread = command.word(Role::ThreadStart).unwrap_or(0.0);
    trace.rounded = machine.off_by() + 2.0 * machine.most_off(command, |_| true);
    match machine.motion {
        Op::FacingPass => facing(machine, (a, [x, z], taper), trace),
        op => {
            let cut = Line { a, e: [x, z], taper, thread: op == Op::ThreadingPass };
            turning(machine, cut, start_of_thread, trace)?;
        }
    }
    machine.settle(&start);
    Ok(())
}

/// True where the control makes the pass once more for M, S or T alone (B9).
fn runs_again(machine: &Machine, command: &Command, trace: &mut Trace) -> bool {
    switches(command) && machine.rules.pass_alone.ask(trace)
}

/// True for M, S or T, or another code than a wait, one for its own block, and those that say how words count.
fn switches(command: &Command) -> bool {
    let once = command.ops.iter().any(|op| op.is_for_its_block());
    let told = command.ops.iter().any(|op| *op != Op::Dwell && !op.only_counts())
        || [Role::Speed, Role::Tool, Role::Turret].iter().any(|role| command.word(*role).is_some());
    told && !once
}

impl Pass {
    /// True once it has been told anything.
    fn is_told(&self) -> bool {
        self.x.is_some() || self.z.is_some() || self.taper != 0.0
    }

    /// True once it has been told where it ends.
    fn is_whole(&self) -> bool {
        self.x.is_some() && self.z.is_some()
    }

    /// Takes the block's words; those it does not have stay (B7).
    fn read(&mut self, command: &Command, a: Point, (unit, incremental): (f64, bool)) {
        let place = |place: Role, step: Role, from: f64, scale: f64| {
            let by_step = command.word(step).map(|step| from + step * unit * scale);
            let of_word = |value: f64| value * unit * scale + if incremental { from } else { 0.0 };
            command.word(place).map(of_word).or(by_step)
        };
        self.x = place(Role::X, Role::StepX, a[0], 0.5).or(self.x);
        self.z = place(Role::Z, Role::StepZ, a[1], 1.0).or(self.z);
        let taper = command.word(Role::Taper).or(command.word(Role::TaperZ));
        self.taper = taper.map_or(self.taper, |taper| taper * unit);
    }
}

/// A cut along Z.
struct Line {
    a: Point,
    e: Point,
    taper: f64,
    thread: bool,
}

/// B3 and B4.
fn turning(machine: &mut Machine, cut: Line, start: f64, trace: &mut Trace) -> Result<(), Stop> {
    let Line { a, e, taper, thread } = cut;
    doubt_turned(taper, e[0] - a[0], trace);
    machine.rapid_way(Some(e[0] + taper), None, trace);
    if thread {
        let chamfer = machine.single_chamfer(machine.feed, trace);
        let lead = Lead { lead: machine.feed, start, change: 0.0, chamfer };
        machine.thread_way(Some(e[0]), Some(e[1]), &lead, trace)?;
        machine.rapid_way(Some(a[0]), None, trace);
    } else {
        machine.feed_way(Some(e[0]), Some(e[1]), trace);
        machine.feed_way(Some(a[0]), None, trace);
    }
    machine.rapid_way(None, Some(a[1]), trace);
    Ok(())
}

/// B5.
fn facing(machine: &mut Machine, (a, e, taper): (Point, Point, f64), trace: &mut Trace) {
    doubt_turned(taper, e[1] - a[1], trace);
    machine.rapid_way(None, Some(e[1] + taper), trace);
    machine.feed_way(Some(e[0]), Some(e[1]), trace);
    machine.feed_way(None, Some(a[1]), trace);
    machine.rapid_way(Some(a[0]), None, trace);
}

/// A taper that turns the sense of the infeed (B10).
fn doubt_turned(taper: f64, infeed: f64, trace: &mut Trace) {
    if sense(taper + infeed) != sense(infeed) {
        trace.doubt("machine:lathe.taper.turns");
    }
}
