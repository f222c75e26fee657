//! Whether circumstances can send a run another way than it went.
//!
//! A run goes by its conditions, its computed jumps, calls and codes, and what is skipped. Where none of them rests on anything
//! that differs from scenario to scenario, every run takes this way: ways that are left are left for good. What they rest on is
//! read off the texts of the programs that the run came through, whatever the order of their blocks: a variable rests on
//! all that any of them writes into it, a local on all words of any block, for each may be an argument.

mod exposed;
mod own;

use crate::canon::{Op, Sys};
use crate::control::trace::{EventKind, Place};
use crate::control::{End, ProgramRef, Run};
use crate::dialect::Control;
use crate::syntax::{
    Expr, ExprKind, Index, Item, ItemKind, Target, TestSubject, VarRef, Word, for_each_expr, for_each_item,
};
use crate::verify::sides::{Side, class_of, name_of};
use exposed::exposed;
pub use own::by_own_numbers;
use std::collections::{BTreeMap, BTreeSet};

/// What something rests on.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Node {
    /// The circumstances.
    Outside,
    /// A variable.
    Variable(String),
    /// What is written where nobody knows which variable is meant.
    Any,
    /// What calls give to locals.
    Arguments,
    /// The condition register, on controls that have one.
    Register,
}

/// Letters that send no run elsewhere: what they say moves, and no more.
const ONLY_MOVE: &str = "XYZUVWIJRDHF";

/// True where every run takes the way that a run came to its end by. `is_free` says of a variable whether scenarios start it
/// with one value or another.
pub fn is_settled(side: &Side<'_>, run: &Run, is_free: &dyn Fn(&str) -> bool) -> bool {
    // What a program that nobody knows leaves sends the run anywhere.
    let open = |what: &EventKind| matches!(what, EventKind::Asked { .. } | EventKind::Outside(_));
    if run.events.iter().any(|event| open(&event.what)) {
        return false;
    }
    let mut rests = Rests::new(side.control);
    let programs: BTreeSet<ProgramRef> =
        run.programs.iter().flat_map(|ran| side.links().of_run(ran)).copied().collect();
    // Another run may go on where the control stopped this one, but not where a statement alone makes it stop.
    let ends_so = match &run.end {
        End::Ended => true,
        End::Alarm { stop, .. } if stop.program_number.is_some() => true,
        End::Alarm { at, .. } => rests.stops_at(side, &programs, (run, *at)),
        _ => false,
    };
    if !ends_so {
        return false;
    }
    let mut read = BTreeSet::new();
    for text in programs.iter().map(|program| side.text(*program)) {
        for block in text {
            for_each_item(&block.items, &mut |item| rests.item(item));
        }
        read.extend(exposed(text, side.control));
    }
    rests.are_settled(&|name| is_free(name) && read.contains(name))
}

struct Rests<'c> {
    control: &'c Control,
    /// What each rests on.
    on: BTreeMap<Node, BTreeSet<Node>>,
    /// What the way of a run rests on.
    ways: BTreeSet<Node>,
    /// True if a code gives words to locals.
    gives_arguments: bool,
    /// True if codes in force may be those that the machine began with.
    modes_are_open: bool,
    /// True if something may write any variable: a message that the operator answers, a block that is not read.
    is_open: bool,
}

impl<'c> Rests<'c> {
    fn new(control: &'c Control) -> Self {
        let (on, ways) = (BTreeMap::new(), BTreeSet::new());
        Self { control, on, ways, gives_arguments: false, modes_are_open: false, is_open: false }
    }

    /// Takes in what a block without words rests on that raised an alarm. False for any other.
    fn stops_at(
        &mut self,
        side: &Side<'_>,
        programs: &BTreeSet<ProgramRef>,
        (run, at): (&Run, Place),
    ) -> bool {
        let file = run.programs.get(at.program as usize).map(|ran| ran.file);
        let texts = programs.iter().filter(|program| Some(program.file) == file).map(|p| side.text(*p));
        let Some(block) = texts.flatten().find(|block| block.span == at.span) else { return false };
        if block.items.iter().any(|item| matches!(item.kind, ItemKind::Word(_) | ItemKind::If { .. })) {
            return false;
        }
        let mut read = BTreeSet::new();
        for_each_expr(&block.items, &mut |e| {
            if let ExprKind::Variable(variable) = &e.kind {
                read.extend(self.read(variable));
            }
        });
        self.ways.extend(read);
        true
    }

    fn item(&mut self, item: &Item) {
        use ItemKind::*;
        match &item.kind {
            Skip(_) => _ = self.ways.insert(Node::Outside),
            Word(word) => self.word(word),
            Assign { target, value, .. } => self.assign(target, value),
            If { condition, .. } => self.goes_by(condition),
            Do { condition: Some(condition), .. } => self.goes_by(condition),
            Goto(Target::Computed(to)) | Start(to) => self.goes_by(to),
            Branch { target, .. } => {
                self.ways.insert(Node::Register);
                if let Target::Computed(to) = target {
                    self.goes_by(to);
                }
            }
            Test(TestSubject::Variable(variable)) => {
                let read = self.read(variable);
                self.rest(Node::Register, read);
            }
            Test(_) => self.rest(Node::Register, [Node::Outside].into()),
            Step { target, .. } => {
                let read = self.read(target);
                self.write(target, read.clone());
                self.rest(Node::Register, read);
            }
            Timer(target) => self.write(target, [Node::Outside].into()),
            Input { targets, .. } => {
                targets.iter().for_each(|target| self.write(target, [Node::Outside].into()));
            }
            Transfer { cells, .. } => {
                for cell in cells.iter().filter(|cell| !cell.store) {
                    self.write(&cell.variable, [Node::Outside].into());
                }
            }
            // It empties them, always the same.
            Clear(_) => {}
            Unparsed => {
                self.ways.insert(Node::Outside);
                self.is_open = true;
            }
            _ => {}
        }
    }

    fn word(&mut self, word: &Word) {
        let Some(value) = &word.value else { return };
        if !ONLY_MOVE.contains(word.letter) {
            self.goes_by(value);
        }
        if let ('G' | 'M', ExprKind::Number(number)) = (word.letter, &value.kind) {
            let code = self.control.code(word.letter, number.value, &[]);
            let alias = self.control.alias(word.letter, number.value).is_some();
            let plain =
                |op: Op| !matches!(op, Op::CallMacro | Op::CallModal | Op::CallModalEach | Op::CallCycle);
            self.gives_arguments |= alias || !code.is_some_and(|row| plain(row.op));
            let is_told = code.is_some() || alias;
            if !is_told || code.is_some_and(|row| row.op == Op::JumpInputOff) {
                self.ways.insert(Node::Outside);
            }
        }
        let read = self.read_in(value);
        self.rest(Node::Arguments, read);
    }

    fn assign(&mut self, target: &VarRef, value: &Expr) {
        // Its text may ask for a variable.
        if self.state_of(target) == Some(Sys::StopMessage) {
            self.ways.insert(Node::Outside);
            self.is_open = true;
        }
        let read = self.read_in(value);
        self.rest(Node::Register, read.clone());
        self.write(target, read);
    }

    fn goes_by(&mut self, e: &Expr) {
        let read = self.read_in(e);
        self.ways.extend(read);
    }

    fn rest(&mut self, node: Node, on: BTreeSet<Node>) {
        self.on.entry(node).or_default().extend(on);
    }

    fn write(&mut self, target: &VarRef, mut on: BTreeSet<Node>) {
        if let Index::Computed(index) = &target.index {
            on.extend(self.read_in(index));
        }
        match name_of(target, self.control) {
            Some(name) => self.rest(Node::Variable(name), on),
            None => self.rest(Node::Any, on),
        }
    }

    /// The state of the machine that a variable is.
    fn state_of(&self, variable: &VarRef) -> Option<Sys> {
        let number = match &variable.index {
            Index::Number(number) | Index::Bit(number, _) => Some(*number),
            _ => None,
        };
        self.control.read_system(&variable.name, number).map(|(state, ..)| state)
    }

    fn read(&self, variable: &VarRef) -> BTreeSet<Node> {
        match (self.state_of(variable), name_of(variable, self.control)) {
            // The codes in force are what the program, and the state that it starts in, make them.
            (Some(Sys::Modal), _) if self.modes_are_open => [Node::Outside].into(),
            (Some(Sys::Modal | Sys::Empty | Sys::Pi | Sys::Euler), _) => BTreeSet::new(),
            (None, Some(name)) => [Node::Variable(name)].into(),
            _ => [Node::Outside].into(),
        }
    }

    fn read_in(&self, e: &Expr) -> BTreeSet<Node> {
        // Parsers limit how deep expressions nest.
        match &e.kind {
            ExprKind::Number(_) => BTreeSet::new(),
            ExprKind::Variable(variable) => self.read(variable),
            ExprKind::Negate(a) | ExprKind::Plus(a) | ExprKind::Not(a) | ExprKind::Group(a) => {
                self.read_in(a)
            }
            ExprKind::Binary(_, operands) => operands.iter().flat_map(|a| self.read_in(a)).collect(),
            ExprKind::Call { arguments, .. } => arguments.iter().flat_map(|a| self.read_in(a)).collect(),
        }
    }

    /// True if nothing that the way rests on differs from run to run.
    fn are_settled(&self, is_free: &dyn Fn(&str) -> bool) -> bool {
        self.is_closed(&self.ways, is_free)
    }

    /// True if nothing that these rest on differs from run to run.
    fn is_closed(&self, on: &BTreeSet<Node>, is_free: &dyn Fn(&str) -> bool) -> bool {
        let mut seen = BTreeSet::new();
        let mut open: Vec<Node> = on.iter().cloned().collect();
        while let Some(node) = open.pop() {
            if !seen.insert(node.clone()) {
                continue;
            }
            match &node {
                Node::Outside => return false,
                Node::Variable(name) => {
                    if is_free(name) {
                        return false;
                    }
                    open.push(Node::Any);
                    let class = class_of(self.control, name);
                    if self.gives_arguments && class.is_none_or(|class| class.class == "local") {
                        open.push(Node::Arguments);
                    }
                }
                Node::Any | Node::Arguments | Node::Register => {}
            }
            open.extend(self.on.get(&node).into_iter().flatten().cloned());
        }
        true
    }
}
