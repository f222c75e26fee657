//! How the programs of a side stand to each other: which of them call which, and what runs call each.
//!
//! Worked out once for a side, whatever the number of programs that are verified.

use super::program_texts::ProgramTexts;
use crate::canon::{Op, Role};
use crate::control::{ProgramRef, Run, trace};
use crate::dialect::CodeHead;
use crate::syntax::{ExprKind, Item, ItemKind, ProgramName, Word, for_each_item};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Calls nest no deeper than this on an emulated control, so what lies deeper no run comes to.
const DEEPEST: usize = 100;

/// The programs of a side.
#[derive(Debug, Default)]
pub struct Links {
    /// All programs, in the order of files and places.
    programs: Vec<ProgramRef>,
    /// The first file of each name.
    files: HashMap<String, usize>,
    /// Of each file, by the names that are written; none for those without.
    named: Vec<HashMap<Option<ProgramName>, Vec<ProgramRef>>>,
    /// Of each file, by their names as runs have them.
    ran: Vec<HashMap<String, Vec<ProgramRef>>>,
    /// What the text of each calls, each program once, in the order of the text.
    callees: HashMap<ProgramRef, Vec<ProgramRef>>,
    /// The other programs whose texts call each.
    callers: HashMap<ProgramRef, Vec<ProgramRef>>,
    /// Those with a call of which the text does not say what it calls.
    open: HashSet<ProgramRef>,
    /// True for each of A, B and C that the profile lists, or that a program has a word of.
    rotary: [bool; 3],
    /// True where a program begins a call at each move.
    has_modal_calls: bool,
    /// True where a program returns to a block of its caller.
    returns_to_blocks: bool,
    /// True where a program may select a work offset other than the standard six.
    selects_more: bool,
}

/// G54 to G59.
const STANDARD_OFFSETS: f64 = 6.0;

/// The letters of the rotary axes.
const ROTARY: [char; 3] = ['A', 'B', 'C'];

/// The operations whose blocks give their words to what they call.
const ARGUMENTS: [Op; 3] = [Op::CallMacro, Op::CallModal, Op::CallModalEach];

impl Links {
    /// Reads the texts of a side.
    pub fn new(side: &ProgramTexts<'_>) -> Self {
        let mut links = Self::default();
        for (file, loaded) in side.library.files.iter().enumerate() {
            links.files.entry(loaded.name.to_owned()).or_insert(file);
            links.named.push(HashMap::new());
            links.ran.push(HashMap::new());
            let all = (0..).map(|program| ProgramRef { file, program });
            all.take_while(|program| side.has(*program)).for_each(|program| links.take_in(side, program));
        }
        for axis in side.control.profile().axes.iter().flatten() {
            // A is the fourth axis.
            let rotary = (axis.number() as usize).checked_sub(4).and_then(|at| links.rotary.get_mut(at));
            rotary.into_iter().for_each(|has| *has = true);
        }
        links
    }

    /// True if a program that was edited calls the same and moves the same axes as before.
    pub fn hold_in(
        &self,
        (before, now): (&ProgramTexts<'_>, &ProgramTexts<'_>),
        program: ProgramRef,
    ) -> bool {
        rotary_in(before, program) == rotary_in(now, program)
            && callees_of(now, program) == self.callees(program)
    }

    fn take_in(&mut self, side: &ProgramTexts<'_>, program: ProgramRef) {
        let callees = callees_of(side, program);
        let moved = rotary_in(side, program);
        self.rotary.iter_mut().zip(moved).for_each(|(all, here)| *all |= here);
        for callee in callees.iter().filter(|callee| **callee != program) {
            self.callers.entry(*callee).or_default().push(program);
        }
        self.callees.insert(program, callees);
        if side.text(program).iter().any(|block| calls_something(side, &block.items)) {
            self.open.insert(program);
        }
        for block in side.text(program) {
            let ops = || words(&block.items).filter_map(|word| op(side, word));
            // `M#1` beside a call is an argument, and no code.
            let own = !gives_arguments(side, &block.items);
            let computed = own && ops().any(|op| op.is_none());
            self.has_modal_calls |=
                computed || ops().any(|op| matches!(op, Some(Op::CallModal | Op::CallModalEach)));
            let names = words(&block.items).any(|word| word.letter == 'P');
            let returns = own && ops().any(|op| op == Some(Op::Return));
            self.returns_to_blocks |= names && (computed || returns);
            for_each_item(&block.items, &mut |item| {
                let ItemKind::Word(word) = &item.kind else { return };
                self.selects_more |= own && word.letter == 'G' && may_select_more(side, word, names);
            });
        }
        let name = side.name(program);
        if let (Some(named), Some(ran)) = (self.named.last_mut(), self.ran.last_mut()) {
            named.entry(name.cloned()).or_default().push(program);
            ran.entry(name.map_or_else(String::new, as_run)).or_default().push(program);
        }
        self.programs.push(program);
    }

    /// All programs, in the order of files and places.
    pub fn programs(&self) -> &[ProgramRef] {
        &self.programs
    }

    /// The first file of this name.
    pub fn file(&self, name: &str) -> Option<usize> {
        self.files.get(name).copied()
    }

    /// The programs of a file that have this name, or none.
    pub fn named(&self, file: usize, name: Option<&ProgramName>) -> &[ProgramRef] {
        let named = self.named.get(file).and_then(|named| named.get(&name.cloned()));
        named.map_or(&[], Vec::as_slice)
    }

    /// What the text of a program calls.
    pub fn callees(&self, program: ProgramRef) -> &[ProgramRef] {
        self.callees.get(&program).map_or(&[], Vec::as_slice)
    }

    /// True where another program calls it: then that one has set what it takes.
    pub fn is_called(&self, program: ProgramRef) -> bool {
        self.callers.contains_key(&program)
    }

    /// False if a program calls another one neither by itself nor through what it calls.
    pub fn may_reach(&self, caller: ProgramRef, program: ProgramRef) -> bool {
        let mut all = self.called_from(caller, |_| true).into_iter();
        all.any(|at| at == program || self.open.contains(&at))
    }

    /// True for a program that may call another one: one that its text names, or one that it does not name.
    pub fn may_call(&self, program: ProgramRef) -> bool {
        !self.callees(program).is_empty() || self.open.contains(&program)
    }

    /// True where some program may begin a call at each move, so that moves of those that it calls are calls too.
    pub fn has_modal_calls(&self) -> bool {
        self.has_modal_calls
    }

    /// True where some program may return to a block of its caller that it names.
    pub fn returns_to_blocks(&self) -> bool {
        self.returns_to_blocks
    }

    /// True where some program may select a work offset other than the standard six.
    pub fn selects_more(&self) -> bool {
        self.selects_more
    }

    /// True for each of A, B and C that the machine has by its profile, or that a program has a word of.
    pub fn rotary(&self) -> [bool; 3] {
        self.rotary
    }

    /// A program, then those that it calls, then those that these call, each once; `follows` says which to go on to.
    pub fn called_from(&self, program: ProgramRef, follows: impl Fn(&ProgramRef) -> bool) -> Vec<ProgramRef> {
        follow(program, |at| self.callees(at), follows)
    }

    /// The other programs whose texts call a program, by themselves or through others, in the order of files and places.
    pub fn calling(&self, program: ProgramRef) -> BTreeSet<ProgramRef> {
        let all = follow(program, |at| self.callers.get(&at).map_or(&[], Vec::as_slice), |_| true);
        all.into_iter().filter(|caller| *caller != program).collect()
    }

    /// The programs that a run calls so: several without a name stand in one file.
    pub fn of_run(&self, ran: &trace::Program) -> &[ProgramRef] {
        self.ran.get(ran.file).and_then(|names| names.get(&ran.name)).map_or(&[], Vec::as_slice)
    }

    /// The program that a number of a run's places stands for.
    pub fn at(&self, run: &Run, number: u32) -> Option<ProgramRef> {
        self.of_run(run.programs.get(number as usize)?).first().copied()
    }

    /// The programs that a run came through.
    pub fn entered<'r>(&'r self, run: &'r Run) -> impl Iterator<Item = ProgramRef> + 'r {
        run.programs.iter().filter_map(|ran| self.of_run(ran).first().copied())
    }

    /// True if a run came through a program.
    pub fn enters(&self, run: &Run, program: ProgramRef) -> bool {
        run.programs.iter().any(|ran| self.of_run(ran).contains(&program))
    }

    /// Every program that a run may have come through, and how it came to it first.
    pub fn entries<'r>(&self, run: &'r Run) -> BTreeMap<ProgramRef, &'r trace::Program> {
        let mut found = BTreeMap::new();
        for ran in &run.programs {
            for program in self.of_run(ran) {
                found.entry(*program).or_insert(ran);
            }
        }
        found
    }
}

/// A program, then those that it leads to, then those that these lead to, each once; `follows` says which to go on to.
fn follow<'l>(
    program: ProgramRef,
    next: impl Fn(ProgramRef) -> &'l [ProgramRef],
    follows: impl Fn(&ProgramRef) -> bool,
) -> Vec<ProgramRef> {
    let (mut all, mut seen) = (vec![program], HashSet::from([program]));
    let mut level = 0..1;
    for _ in 0..DEEPEST {
        for at in level.clone() {
            let leads = all.get(at).map_or(&[][..], |at| next(*at));
            all.extend(leads.iter().copied().filter(|to| follows(to) && seen.insert(*to)));
        }
        level = level.end..all.len();
        if level.is_empty() {
            break;
        }
    }
    all
}

/// What the text of a program calls, each program once.
fn callees_of(side: &ProgramTexts<'_>, program: ProgramRef) -> Vec<ProgramRef> {
    let mut seen = HashSet::new();
    let all = side.text(program).iter().flat_map(|block| calls(side, &block.items));
    all.filter(|callee| seen.insert(*callee)).collect()
}

/// True for a block that may call what its text does not name: by a number that is computed, by a code of its own, or by a
/// code that parameters make a call.
fn calls_something(side: &ProgramTexts<'_>, items: &[Item]) -> bool {
    let names = words(items).any(|word| word.letter == 'P' && number(word).is_some());
    words(items).any(|word| match word.letter {
        'P' => number(word).is_none(),
        _ if number(word).is_some_and(|number| side.control.alias(word.letter, number).is_some()) => true,
        'G' | 'M' => {
            let row = number(word).and_then(|number| side.control.code(word.letter, number, &[]));
            row.is_none_or(|row| match row.op {
                Op::CallCycle => false,
                op => matches!(op, Op::Builder | Op::Act) || !names && op.to_string().starts_with("call."),
            })
        }
        _ => false,
    }) || items.iter().any(|item| matches!(item.kind, ItemKind::If { .. }) && has_words(item))
}

/// True if words stand after a condition.
fn has_words(item: &Item) -> bool {
    let ItemKind::If { body, .. } = &item.kind else { return false };
    body.iter().any(|item| matches!(item.kind, ItemKind::Word(_)))
}

/// True for each rotary axis that a program has a word of. An argument of a macro is no such word.
fn rotary_in(side: &ProgramTexts<'_>, program: ProgramRef) -> [bool; 3] {
    let mut found = [false; 3];
    for block in side.text(program) {
        // A word with a comma is a corner.
        let letters = || words(&block.items).filter(|word| !word.comma).map(|word| word.letter);
        let axes = || letters().filter_map(|letter| ROTARY.iter().position(|axis| *axis == letter));
        if axes().next().is_some() && !gives_arguments(side, &block.items) {
            axes().for_each(|axis| found[axis] = true);
        }
    }
    found
}

/// True for a block whose words are what it gives to a macro.
fn gives_arguments(side: &ProgramTexts<'_>, items: &[Item]) -> bool {
    words(items).any(|word| {
        number(word).is_some_and(|number| {
            let alias = side.control.alias(word.letter, number);
            let row =
                || matches!(word.letter, 'G' | 'M').then(|| side.control.code(word.letter, number, &[]))?;
            alias
                .map_or_else(|| row().is_some_and(|row| ARGUMENTS.contains(&row.op)), |alias| alias.arguments)
        })
    })
}

/// What a code means; none inside where its number is computed, and none at all for a word that is no code.
fn op(side: &ProgramTexts<'_>, word: &Word) -> Option<Option<Op>> {
    let known = |number| side.control.code(word.letter, number, &[]).map_or(Op::Builder, |row| row.op);
    matches!(word.letter, 'G' | 'M').then(|| number(word).map(known))
}

/// True for a G code that may select a work offset other than the standard six; `names` says whether a P stands beside it.
fn may_select_more(side: &ProgramTexts<'_>, word: &Word, names: bool) -> bool {
    let Some(head) = number(word).and_then(|number| CodeHead::new('G', number)) else { return names };
    let mut rows = side.control.rows_of(head).filter(|row| row.op == Op::SelectWork);
    rows.any(|row| {
        let after = row.head().map_or(0.0, |first| head.number() - first.number());
        let fixed = row.fixed.get(&Role::WorkOffset);
        fixed.map_or(names, |first| first + after > STANDARD_OFFSETS)
    })
}

/// The words of a block that stand under no condition.
fn words(items: &[Item]) -> impl Iterator<Item = &Word> {
    items.iter().filter_map(|item| match &item.kind {
        ItemKind::Word(word) => Some(word),
        _ => None,
    })
}

/// The number that a word has; none if it is computed.
fn number(word: &Word) -> Option<f64> {
    match word.value.as_ref().map(|value| &value.kind) {
        Some(ExprKind::Number(number)) => Some(number.value),
        _ => None,
    }
}

/// A program's name as runs have it.
fn as_run(name: &ProgramName) -> String {
    name.short().into_owned()
}

/// The programs that a block may call: those whose numbers stand in its P words, those that parameters make its codes call, and
/// cycles that a code of theirs calls.
fn calls<'s>(side: &'s ProgramTexts<'_>, items: &'s [Item]) -> impl Iterator<Item = ProgramRef> + 's {
    items.iter().filter_map(|item| {
        let ItemKind::Word(word) = &item.kind else { return None };
        let Some(ExprKind::Number(number)) = word.value.as_ref().map(|value| &value.kind) else {
            return None;
        };
        if matches!(word.letter, 'G' | 'M' | 'T')
            && let Some(alias) = side.control.alias(word.letter, number.value)
        {
            return side.numbered(alias.program);
        }
        if word.letter == 'G' {
            let row = side.control.code('G', number.value, &[]).filter(|row| row.op == Op::CallCycle);
            return row.and_then(|_| side.library.cycle((number.value % 100.0) as u32));
        }
        let is_number = word.letter == 'P' && number.value >= 1.0 && number.value.fract() == 0.0;
        // A float outside the range becomes its nearest end.
        let called = || side.numbered(number.value as u32).filter(|_| may_name_program(side, items));
        is_number.then(called).flatten()
    })
}

/// False for a block in which P is known to be something else than the number of a program: a time, a block, a row of offsets.
fn may_name_program(side: &ProgramTexts<'_>, items: &[Item]) -> bool {
    let codes = words(items).filter(|word| matches!(word.letter, 'G' | 'M'));
    let mut has_other = false;
    for word in codes {
        let Some(head) = number(word).and_then(|number| CodeHead::new(word.letter, number)) else {
            return true;
        };
        let mut is_known = false;
        for row in side.control.rows_of(head) {
            let role = row.words.get("P").copied();
            if role == Some(Role::Program) || matches!(row.op, Op::Builder | Op::Act) {
                return true;
            }
            is_known = true;
            has_other |= role.is_some();
        }
        if !is_known {
            return true;
        }
    }
    !has_other
}
