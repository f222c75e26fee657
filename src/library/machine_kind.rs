//! Programs of a lathe among those of a library that is read as a mill's.
//!
//! Law: a program is for a lathe if its own text has more signs of a lathe than of a mill. A sign of a lathe is a letter
//! that only a lathe has; Y, a length offset and a change by M6 are signs of a mill. Y is none beside tool words with an
//! offset in them, if no length and no change shows a mill. What a lathe program calls, what calls it and what stands in
//! its file are a lathe's too, unless their own text is a mill's. What both kinds lead to may be for either. A program
//! without NC words does the same on both machines. A program without any sign follows the rest of its library, if no
//! program there is a mill's. If the library has programs of both kinds and the program a code that means something else
//! on a lathe (G90, G92, G94, G98), nobody can tell: it is refused too. A machine profile may say `machine = "mill"`. Then
//! only what no mill has is a sign, and only programs that are linked with such a program go with it.

use super::Input;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Axis, Control, Machine};
use crate::ir::{Callee, Module, Nc, NcItem, Program, StmtKind};
use crate::legalize::calls_of;
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// How strong signs are, together, that settle the kind of a program.
const ENOUGH: u32 = 3;

/// How strong signs of a mill are that no lathe program has by chance.
const SURELY: u32 = 2;

/// Signs of a mill: the axis, which lathes with live tools have too, and what no lathe has.
const Y: &str = "Y";
const Y_COUNTS: u32 = 5;
const LENGTH: &str = "a tool length offset";
const CHANGE: &str = "a tool change by M6";

/// What a program's own text says of its machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Signs {
    lathe: u32,
    mill: u32,
    /// The first sign of a lathe: where it is, and what.
    pub(super) first: Option<(Span, String)>,
}

impl Signs {
    pub(super) fn is_lathe(&self) -> bool {
        self.lathe >= ENOUGH && self.lathe > self.mill
    }

    fn are_none(&self) -> bool {
        self.mill == 0 && self.lathe == 0
    }

    fn is_mill(&self) -> bool {
        self.mill > 0 && self.mill >= self.lathe
    }

    /// True where it is a mill's by more than a weak sign.
    pub(super) fn is_surely_mill(&self) -> bool {
        self.is_mill() && self.mill >= SURELY
    }

    /// What the text of a program says, of a file with these bytes.
    pub(super) fn of(program: &Program, found: &[Diagnostic], bytes: &[u8], source: &Control) -> Self {
        let mut signs = Self::default();
        let mut seen = BTreeSet::new();
        let mut is_sure = false;
        for finding in found.iter().filter(|finding| finding.code == Code::LatheProgram) {
            let text = bytes.get(finding.span.start as usize);
            // A letter that is no axis of a mill is one of a machine with another axis too.
            let weight = if text.is_some_and(|letter| b"UVWuvw".contains(letter)) { 2 } else { ENOUGH };
            if seen.insert(finding.message.clone()) {
                signs.lathe += weight;
                is_sure |= weight == ENOUGH;
                // What lowering says of it is the sign.
                signs.first.get_or_insert((finding.span, finding.message.to_string()));
            }
        }
        let mut words = BTreeSet::new();
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            let lathe = lathe_signs(nc, source).filter(|_| source.profile().machine.is_none());
            for (weight, what) in lathe {
                if words.insert(what) {
                    signs.lathe += weight;
                    signs.first.get_or_insert((stmt.site.span, what.to_owned()));
                }
            }
            signs.mill += mill_signs(nc).filter(|(_, what)| words.insert(what)).map(|(n, _)| n).sum::<u32>();
        }
        let mills = [LENGTH, CHANGE].iter().any(|what| words.contains(what));
        if is_sure && words.contains(Y) && !mills {
            // A lathe has Y too: across its live tools, and as the second axis of a face.
            signs.mill -= Y_COUNTS;
        }
        signs
    }
}

fn has(nc: &Nc, role: Role) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Word(found, _) if *found == role))
}

/// What in a block is a lathe's, or more often a lathe's than a mill's.
fn lathe_signs(nc: &Nc, source: &Control) -> impl Iterator<Item = (u32, &'static str)> {
    let listed = |axis| source.profile().axes.as_ref().is_some_and(|axes| axes.contains(&axis));
    let (u, w) = (has(nc, Role::U) && !listed(Axis::U), has(nc, Role::W) && !listed(Axis::W));
    let signs = [
        (u, 2, "U is the increment of X on a lathe"),
        (w, 2, "W is the increment of Z on a lathe"),
        (
            nc.has(Op::ReferenceReturn) && (u || w),
            1,
            "a return to the reference position by U or W belongs to a lathe program",
        ),
        (nc.has(Op::SurfaceSpeed), 2, "constant surface speed belongs to a lathe program"),
        (
            nc.has(Op::SetPosition) && has(nc, Role::Feed),
            ENOUGH,
            "a feed beside G92, for a thread, belongs to a lathe program",
        ),
    ];
    signs.into_iter().filter(|(there, _, _)| *there).map(|(_, weight, what)| (weight, what))
}

/// What in a block is a mill's.
fn mill_signs(nc: &Nc) -> impl Iterator<Item = (u32, &'static str)> {
    let length = nc.has(Op::LengthPlus) || nc.has(Op::LengthMinus);
    // Every machine that has the axis sends it home.
    let home = nc.ops().any(|op| op == Op::MachineOnce || op.is_return());
    let signs = [
        (has(nc, Role::Y) && !home, Y_COUNTS, Y),
        (has(nc, Role::Y) && home, 1, "a return of Y"),
        (length, 3, LENGTH),
        (nc.has(Op::ToolChange), 2, CHANGE),
        (has(nc, Role::RadiusOffset), 1, "a cutter radius by D"),
    ];
    signs.into_iter().filter(|(there, _, _)| *there).map(|(_, weight, what)| (weight, what))
}

/// Refuses the programs of a lathe that are read as a mill's, each with one reason that says where the sign was seen.
pub fn report(module: &Module, inputs: &[Input], source: &Control, found: &mut [Vec<Diagnostic>]) {
    if source.machine() != Machine::Mill {
        return;
    }
    let told = source.profile().machine.is_some();
    let programs = module.programs.iter().zip(&*found);
    let bytes = |program: &Program| inputs.get(program.file).map_or(&[][..], |input| &input.bytes);
    let signs: Vec<Signs> =
        programs.map(|(program, found)| Signs::of(program, found, bytes(program), source)).collect();
    if !signs.iter().any(Signs::is_lathe) {
        if !told && signs.iter().all(Signs::are_none) {
            ask(module, source, found);
        }
        return;
    }
    let edges = edges(module);
    let lathe = spread(&signs, &edges, Signs::is_lathe, Signs::is_mill);
    let mill = spread(&signs, &edges, Signs::is_mill, Signs::is_lathe);
    let first = signs.iter().position(Signs::is_lathe).unwrap_or(0);
    for (at, found) in found.iter_mut().enumerate() {
        let open = !told && !signs[at].is_mill();
        let seen = match (lathe[at], mill[at]) {
            (Some(seen), None) => Some(seen),
            (None, None) if open && mill.iter().all(Option::is_none) => Some(first),
            (None, None) if open && may_turn(&module.programs[at]) => None,
            _ => continue,
        };
        if !names_machine(&module.programs[at]) || found.iter().any(|d| d.code == Code::LatheProgram) {
            continue;
        }
        let Some(seen) = seen else {
            found.push(Diagnostic::new(Code::LatheProgram, module.programs[at].site.span, EITHER));
            continue;
        };
        let Some((span, sign)) = &signs[seen].first else { continue };
        let own = seen == at;
        let what = if own {
            format!("the program looks like a lathe program: {sign}")
        } else {
            let place = place(inputs, module.programs[seen].file, *span);
            format!("the program belongs with lathe programs: in {place}, {sign}")
        };
        let span = if own { *span } else { module.programs[at].site.span };
        let help = "name a machine profile with machine = \"lathe\", or with machine = \"mill\" if the \
                    program is for a mill";
        found.push(Diagnostic::new(Code::LatheProgram, span, what).with_help(help));
    }
    if signs.iter().any(Signs::is_mill) {
        let all = found.iter_mut().flatten().filter(|finding| finding.code == Code::LatheProgram);
        all.for_each(say_of_two_machines);
    }
}

/// Asks the kind of machine of programs that may be a lathe's, in a library without any sign: they move along X and Z alone, and have a code that
/// is a feed mode on a lathe, where a mill has it for its drilling cycles, and no such cycle.
fn ask(module: &Module, source: &Control, found: &mut [Vec<Diagnostic>]) {
    let asked: Vec<usize> = (0..module.programs.len()).filter(|at| is_open(&module.programs[*at])).collect();
    if asked.is_empty() || super::kind::as_lathe(source).is_none() {
        return;
    }
    for at in asked {
        let finding = Diagnostic::new(Code::Conditional, module.programs[at].site.span, OPEN);
        found[at].push(finding.with_help(OPEN_HELP));
    }
}

/// True for a program that a lathe may have, as it has codes that mean other things there.
fn is_open(program: &Program) -> bool {
    let ncs = || program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc());
    let any = |is: &dyn Fn(Op) -> bool| ncs().any(|nc| nc.ops().any(is));
    let feeds = any(&|op| matches!(op, Op::ReturnInitial | Op::ReturnR));
    let mills = any(&|op| op.is_cycle() || matches!(op, Op::PlaneXy | Op::PlaneYz));
    feeds && !mills && [Role::X, Role::Z].iter().all(|role| ncs().any(|nc| has(nc, *role)))
}

const OPEN: &str = "nothing in the library shows whether it is of a mill or of a lathe; this program moves along X and Z alone, and has G codes that are other things on \
                    a lathe: it is read as a mill's";
const OPEN_HELP: &str = "say it in the machine profile: machine = \"mill\" or \"lathe\"";

const EITHER: &str =
    "the library has programs of lathes and of mills, and nothing in this one shows which of them it is for";

/// True where a program moves along X or Z, and has a code that is a cut or a mode of another kind on a lathe.
fn may_turn(program: &Program) -> bool {
    let ncs = || program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc());
    let other = |op: Op| {
        use Op::*;
        matches!(op, Absolute | SetPosition | FeedPerMinute | ReturnInitial | ReturnR) || op.is_cycle()
    };
    ncs().any(|nc| has(nc, Role::X) || has(nc, Role::Z)) && ncs().any(|nc| nc.ops().any(other))
}

/// Adds how a folder with the programs of two machines is converted.
fn say_of_two_machines(finding: &mut Diagnostic) {
    let help = finding.help.take().map(|help| format!("{help}. "));
    let help = help.unwrap_or_else(|| "name a machine profile with machine = \"mill\" or \"lathe\". ".into());
    let more = "The library has programs of a mill too: macroglot.toml can make two libraries of the folder, where `only` \
                and `except` say which files are of which";
    finding.help = Some(format!("{help}{more}").into());
}

/// True where a program has words of NC code, which mean other things on another kind of machine.
pub(super) fn names_machine(program: &Program) -> bool {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if !nc.items.is_empty()))
}

/// File and line of a place.
pub(super) fn place(inputs: &[Input], file: usize, span: Span) -> String {
    let Some(input) = inputs.get(file) else { return "another file".into() };
    let before = input.bytes.get(..span.start as usize).unwrap_or_default();
    let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
    format!("line {line} of {}", input.name)
}

/// The neighbours of each program: those of its file, those it calls and those that call it.
fn edges(module: &Module) -> Vec<BTreeSet<usize>> {
    let mut edges = vec![BTreeSet::new(); module.programs.len()];
    let mut join = |a: usize, b: usize| {
        edges[a].insert(b);
        edges[b].insert(a);
    };
    let mut names: BTreeMap<&ProgramName, Vec<usize>> = BTreeMap::new();
    for (at, program) in module.programs.iter().enumerate() {
        if at > 0 && module.programs[at - 1].file == program.file {
            join(at - 1, at);
        }
        program.name.iter().for_each(|name| names.entry(name).or_default().push(at));
    }
    for (at, program) in module.programs.iter().enumerate() {
        for call in program.blocks.iter().flat_map(calls_of) {
            // Of two programs of one name either may be meant.
            if let Callee::Program(name) = &call.callee
                && let Some([callee]) = names.get(name).map(Vec::as_slice)
            {
                join(at, *callee);
            }
        }
    }
    edges
}

/// For each program the nearest of one kind that it is linked with, by ways that lead through none of the other kind.
fn spread(
    signs: &[Signs],
    edges: &[BTreeSet<usize>],
    kind: impl Fn(&Signs) -> bool,
    other: impl Fn(&Signs) -> bool,
) -> Vec<Option<usize>> {
    let mut reached: Vec<Option<usize>> = vec![None; signs.len()];
    let mut work: Vec<usize> = (0..signs.len()).filter(|at| kind(&signs[*at])).collect();
    work.iter().for_each(|at| reached[*at] = Some(*at));
    let mut next = 0;
    while let Some(&at) = work.get(next) {
        next += 1;
        for &neighbour in &edges[at] {
            if reached[neighbour].is_none() && !other(&signs[neighbour]) {
                reached[neighbour] = reached[at];
                work.push(neighbour);
            }
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::{Lock, Options, Outcome, convert};

    /// Which programs are refused as a lathe's, in order of the files.
    fn lathes(profile: &str, files: &[&str]) -> Vec<bool> {
        let inputs = files.iter().enumerate().map(|(at, text)| {
            let name = format!("f{at}.nc");
            Input { path: (&name).into(), name, bytes: text.as_bytes().to_vec() }
        });
        let source = Control::from_profile(profile).unwrap();
        let name = if source.name() == "haas" { "fanuc" } else { "haas" };
        let target = Control::plain(name).unwrap();
        let lock = Lock::new(source.name(), target.name());
        let made = convert(&inputs.collect::<Vec<_>>(), &source, &target, lock, Options::default());
        let refused = made.programs.iter().map(|program| {
            let told = program.diagnostics.iter().filter(|d| d.code == Code::LatheProgram).count();
            assert!(told == 0 || program.outcome == Outcome::Refused);
            told > 0
        });
        refused.collect()
    }

    const FANUC: &str = "dialect = \"fanuc\"";
    const HAAS: &str = "dialect = \"haas\"";
    /// A turned part: the form is that of seed 001.
    const TURNS: &str = "O1\nT0101\nG96 S200 M3\nG0 X50. Z2.\nM98 P2\nM30\n";
    const MILLS: &str = "O11\nT1 M6\nG90 G54 G0 X0. Y0.\nG43 H1 Z5.\nM98 P2\nM30\n";
    const PLAIN: &str = "O2\nG1 X40. F100.\nM99\n";

    #[test]
    fn what_a_lathe_program_calls_is_a_lathes_too() {
        assert_eq!(lathes(FANUC, &[TURNS, PLAIN]), [true, true]);
        assert_eq!(lathes(HAAS, &[TURNS, PLAIN]), [true, true]);
        // A macro that only computes is for any machine.
        assert_eq!(lathes(FANUC, &[TURNS, "O2\n#500=#500+1\nM99\n"]), [true, false]);
        let other = "O3\nG1 X40. F100.\nM30\n";
        // Without any sign it follows the folder. Where that has mill programs too, a code that is a cut on a lathe may be one.
        assert_eq!(lathes(FANUC, &[TURNS, other]), [true, true]);
        let mills = MILLS.replace("M98 P2\n", "");
        assert_eq!(lathes(FANUC, &[TURNS, other, &mills]), [true, false, false]);
        let pass = "O3\nG90 X40. Z-10. F.2\nX38.\nM99\n";
        assert_eq!(lathes(FANUC, &[TURNS, pass, &mills]), [true, true, false]);
        assert_eq!(lathes(FANUC, &[&format!("{TURNS}{other}"), MILLS]), [true, true, false]);
    }

    #[test]
    fn what_both_kinds_call_may_be_for_either() {
        assert_eq!(lathes(FANUC, &[TURNS, MILLS, PLAIN]), [true, false, false]);
    }

    #[test]
    fn signs_that_a_mills_table_reads_as_its_own() {
        assert_eq!(lathes(HAAS, &["O1\nG28 U0 W0\nG0 X50. Z2.\nM30\n"]), [true]);
        assert_eq!(lathes(HAAS, &["O1\nG0 X50. Z2.\nG1 W-5. F.2\nG1 U1.\nM30\n"]), [true]);
        assert_eq!(lathes(FANUC, &["O1\nG0 X50. Z2.\nG92 X48. Z-20. F1.5\nM30\n"]), [true]);
    }

    #[test]
    fn a_mill_is_none_by_a_weak_sign() {
        for mill in [
            "O1\nG0 X5. Y5.\nG1 U5. F100.\nW2.\nM30\n",
            "O1\nT0101 M6\nG43 H1 Z5.\nG76 X5. Y5. Z-5. R2. Q.1 F100.\nM30\n",
            "O1\nG96 S200\nG1 X5. F100.\nM30\n",
            "O1\nG1 W5. F100.\nM30\n",
            "O1\nG92 X0. Y0. Z0.\nG70 I5. J10. L4\nM30\n",
        ] {
            assert_eq!(lathes(HAAS, &[mill, "O5\nG1 X5. F100.\nM30\n"]), [false, false], "{mill}");
        }
        let profile = "dialect = \"haas\"\nmachine = \"mill\"";
        assert_eq!(lathes(profile, &["O1\nG28 U0 W0\nM30\n"]), [false]);
        // A profile that says so does not make a mill's of T0101, nor of what it is called by.
        assert_eq!(lathes(profile, &[TURNS, PLAIN, "O5\nG1 X5. F100.\nM30\n"]), [true, true, false]);
        // A mill with a W axis, told by its profile.
        let axes = "dialect = \"fanuc\"\naxes = [\"X\", \"Y\", \"Z\", \"W\"]";
        assert_eq!(lathes(axes, &["O1\nG28 W0\nG1 W-5. F100.\nM30\n"]), [false]);
    }
}
