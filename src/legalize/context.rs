//! What every pass is given: both controls, and a place for what it finds.

mod findings;

use super::Modal;
use super::analyses::Analyses;
use super::by_program::look_at_each;
use super::features::Features;
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Row, Side};
use crate::ir::analysis::{ModalFacts, Summaries, computed_calls::CalledPrograms};
use crate::ir::{Module, Var};
use crate::legalize::layout::{earlier::Earlier, program_numbers::ProgramNumbers};
use crate::legalize::registers::{interface::Interface, locked::Locked, map::Registers};
use crate::legalize::variables::computed_numbers::Reached;
use crate::opt::Level;
use crate::syntax::ProgramName;

use crate::text::Span;
use findings::Findings;
use foldhash::{HashMap, HashSet};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

/// The controls of a conversion and the findings so far.
pub struct Context<'a> {
    /// The control the programs were written for.
    pub source: &'a Control,
    /// The control they are to run on.
    pub target: &'a Control,
    /// The modal state in which a program starts that nothing in the library calls.
    pub entry: Modal,
    /// True where the last program goes on after its text, as a piece of a longer one.
    pub goes_on: bool,
    /// Where lowering found errors, by program of the source: of those blocks the module may not have every word.
    pub faults: Vec<Vec<Span>>,
    /// For each program the one of the source that it comes from: passes add programs.
    pub origins: Vec<usize>,
    /// What computed numbers of variables reach, until registers are taken.
    pub(super) reached: Reached,
    /// What stands in the library, as it was last counted: perhaps less by now, never more.
    pub(super) features: Features,
    /// What stands in each program as it is now; none of one that was changed since it was counted.
    counted: Vec<Option<Features>>,
    /// What is known of the library as it is now.
    pub(super) analyses: Analyses,
    /// How much is optimized.
    pub level: Level,
    /// True where a G code by a computed number was written out: a run may come in any that its number can be.
    pub(super) chained: bool,
    /// True where the library drills, and its holes became moves.
    pub(super) drills: bool,
    /// What heads of an earlier conversion say, from the pass `heads` on.
    pub(super) earlier: Earlier,
    /// What earlier runs chose.
    pub locked: Locked<'a>,
    /// The temporaries and statics that are needed after calls, from the pass `temporaries` on.
    pub(super) over_calls: BTreeSet<Var>,
    /// What programs hold copies of, from the pass `merged` on.
    pub copied: Vec<Copied>,
    /// The arguments that come from outside the library or go there, from the pass `frames` on.
    pub(super) interface: Interface,
    /// By program: its own locals that it reads before it sets them, as it calls them; on a target without locals, from the
    /// pass `frames` on.
    pub(super) taken: BTreeMap<ProgramName, BTreeSet<String>>,
    /// By program: its locals that every call gives a value, from the pass `vacancy-flags` on.
    pub(super) always: BTreeMap<ProgramName, BTreeSet<String>>,
    /// The register of each variable, from the pass `registers` on.
    pub registers: Registers,
    /// The number of each program, from the pass `program-numbers` on.
    pub numbers: ProgramNumbers,
    /// The operations that the target has M codes for, once they were asked for.
    pub(super) m_codes: OnceLock<BTreeSet<Op>>,
    /// The operations that the target has codes for.
    pub(super) had: OnceLock<BTreeSet<Op>>,
    /// By program of the source and block: what its computed G codes may be, if that is known; from the pass `codes` on.
    pub computed_codes: BTreeMap<(usize, Span), Option<Vec<f64>>>,
    /// By program of the source and block: the stops that stand for a code of the source which stops nothing there.
    pub(super) stood_in: BTreeSet<(usize, Span)>,
    /// The programs of the source in which every read waits until the moves before it are done.
    pub waiting: BTreeSet<usize>,
    findings: Findings,
    /// Questions of behaviour that programs were seen to rest on.
    rested: HashSet<(usize, Side, Question)>,
    /// What is said of those that nothing confirms.
    facts: HashMap<(Side, Question), Diagnostic>,
}

/// A program whose blocks another one holds a copy of.
#[derive(Clone, Debug, PartialEq)]
pub struct Copied {
    /// Who holds it, by program of the source.
    pub caller: usize,
    /// What it is a copy of.
    pub callee: usize,
    /// Where the call stands.
    pub span: Span,
    /// What the copied program is called on the source.
    pub name: String,
}

impl<'a> Context<'a> {
    /// A context without findings, for a library of so many programs.
    pub fn new(source: &'a Control, target: &'a Control, programs: usize) -> Self {
        let findings = Findings::of(programs);
        let (rested, facts) = Default::default();
        Self {
            source,
            target,
            entry: Modal::unknown(),
            goes_on: false,
            faults: Vec::new(),
            origins: (0..programs).collect(),
            reached: Reached::default(),
            features: Features::default(),
            counted: Vec::new(),
            analyses: Analyses::default(),
            level: Level::default(),
            chained: false,
            drills: false,
            earlier: Earlier::default(),
            locked: Locked::default(),
            over_calls: BTreeSet::new(),
            interface: Interface::default(),
            taken: BTreeMap::new(),
            always: BTreeMap::new(),
            copied: Vec::new(),
            registers: Registers::default(),
            numbers: ProgramNumbers::default(),
            m_codes: OnceLock::new(),
            had: OnceLock::new(),
            stood_in: BTreeSet::new(),
            computed_codes: BTreeMap::new(),
            waiting: BTreeSet::new(),
            findings,
            rested,
            facts,
        }
    }

    /// True where both controls are known to give one answer, or have what is known by one row of a base.
    pub fn agree(&self, question: Question) -> bool {
        let (ours, theirs) = (self.source.behaviour(question), self.target.behaviour(question));
        ours.zip(theirs).is_some_and(|(ours, theirs)| {
            let one_row = ours.origin.table.is_some() && ours.origin.table == theirs.origin.table;
            ours.value == theirs.value && (one_row || ours.value != "unknown")
        })
    }

    /// True where both controls number the codes of a letter by one scheme: rows of one base.
    pub fn number_alike(&self, letter: char) -> bool {
        let [ours, theirs] = [self.source, self.target].map(|control| {
            let rows = control.dialect().codes.iter().filter(|row| row.code.starts_with(letter));
            rows.filter_map(|row| row.origin.table.as_deref()).collect::<BTreeSet<&str>>()
        });
        !ours.is_disjoint(&theirs)
    }

    /// What is in force at every block of the library.
    pub(super) fn modal_facts(&self, module: &Module) -> Arc<ModalFacts> {
        self.analyses.modal_facts(module, &self.entry)
    }

    /// The same where runs begin in another state.
    pub(super) fn modal_facts_from(&self, module: &Module, entry: &Modal) -> Arc<ModalFacts> {
        self.analyses.modal_facts(module, entry)
    }

    /// The same where runs that find no known one of absolute and incremental coordinates begin in absolute ones.
    pub(super) fn facts_from_absolute(&self, module: &Module) -> Arc<ModalFacts> {
        let mut entry = self.entry.clone();
        if entry.op(Group::Distance).is_none() {
            entry.start_in(Op::Absolute);
        }
        self.analyses.modal_facts(module, &entry)
    }

    /// Counts what stands in each program, unless that is known.
    pub(super) fn count(&mut self, module: &Module) {
        let known = self.take_counted();
        let of = |index: usize, program| Features::of_known(known.get(index).copied().flatten(), program);
        self.keep_counted(look_at_each(module, of));
    }

    /// Keeps what was counted in each program, and what that makes of the library.
    pub(super) fn keep_counted(&mut self, programs: impl IntoIterator<Item = Features>) {
        self.counted = programs.into_iter().map(Some).collect();
        self.features = Features::default();
        self.counted.iter().flatten().for_each(|features| self.features.add_all(features));
    }

    /// What was counted in each program, where that is still so.
    pub(super) fn take_counted(&mut self) -> Vec<Option<Features>> {
        std::mem::take(&mut self.counted)
    }

    /// False where it is known of a program, as it was before the present pass, that it has nothing of these.
    pub(super) fn may_concern(&self, program: usize, these: impl Fn(&Features) -> bool) -> bool {
        self.counted.get(program).and_then(Option::as_ref).is_none_or(these)
    }

    /// Forgets what is known of the library as it was: it is another now.
    pub(super) fn forget(&mut self) {
        self.analyses.drop_all();
        self.counted.clear();
    }

    /// The same where only these programs are others.
    pub(super) fn forget_some(&mut self, programs: &[usize]) {
        self.analyses.drop_all();
        for index in programs {
            if let Some(counted) = self.counted.get_mut(*index) {
                *counted = None;
            }
        }
    }

    /// What programs of the library may write.
    pub(super) fn summaries(&self, module: &Module) -> Arc<Summaries> {
        self.analyses.summaries(module)
    }

    /// Which programs the calls of the library run.
    pub(super) fn called(&self, module: &Module) -> Arc<CalledPrograms> {
        self.analyses.called(module)
    }

    /// The program of the source that one of the module was made of.
    pub fn origin(&self, program: usize) -> usize {
        self.origins.get(program).copied().unwrap_or(program)
    }

    /// Adds a finding to a program.
    pub fn add(&mut self, program: usize, diagnostic: Diagnostic) {
        self.findings.add(self.origin(program), diagnostic);
    }

    /// True where lowering found an error within a place: what the module lacks there the source may have.
    pub fn is_faulty(&self, program: usize, span: Span) -> bool {
        let faults = self.faults.get(self.origin(program)).map_or(&[][..], Vec::as_slice);
        faults.iter().any(|fault| span.start <= fault.start && fault.end <= span.end)
    }

    /// True where a place is refused already.
    pub fn is_refused(&self, program: usize, span: Span) -> bool {
        let origin = self.origin(program) as u32;
        let mut findings = self.findings.lists.iter().flatten();
        findings.any(|(at, found)| *at == origin && found.code == Code::NoEquivalent && found.span == span)
    }

    /// Adds findings whose texts are shared already.
    pub fn add_all(&mut self, program: usize, diagnostics: Vec<Diagnostic>) {
        let origin = self.origin(program);
        diagnostics.into_iter().for_each(|diagnostic| self.findings.push(origin, diagnostic));
    }

    /// Adds a finding unless the program has one about the same `fact`: what a reviewer must check once is said once.
    pub fn add_once(&mut self, program: usize, fact: &str, diagnostic: Diagnostic) {
        if self.findings.say(self.origin(program), fact) {
            self.add(program, diagnostic);
        }
    }

    /// Adds, once a program, that it rests on an unconfirmed fact of one of the controls.
    pub fn unconfirmed(
        &mut self,
        program: usize,
        side: Side,
        span: Span,
        fact: &str,
        what: impl Into<Arc<str>>,
    ) {
        let control = if side == Side::Source { self.source } else { self.target };
        let finding = Diagnostic::new(control.told_as(fact), span, what).with_fact(fact);
        self.add_once(program, &format!("{side} {fact}"), finding.with_help(control.to_settle(fact, side)));
    }

    /// Says, once a program, that it rests on how the source behaves, where no maker's text confirms that.
    pub fn rests_on_source(&mut self, program: usize, span: Span, question: Question) {
        self.rests_on(self.source, Side::Source, program, span, question);
    }

    /// As [`Context::rests_on_source`], of the target.
    pub fn rests_on_target(&mut self, program: usize, span: Span, question: Question) {
        self.rests_on(self.target, Side::Target, program, span, question);
    }

    /// Says, once a program, that the controls are known to give two answers.
    pub fn must_agree(&mut self, program: usize, span: Span, question: Question) {
        let answer = |control: &Control| {
            let row = control.behaviour(question).filter(|row| row.value != "unknown");
            row.map(|row| row.value.clone())
        };
        let answers = (answer(self.source), answer(self.target));
        if let (Some(ours), Some(theirs)) = answers
            && ours != theirs
        {
            let what = format!(
                "the controls differ in '{question}': '{ours}' on the source, '{theirs}' on the target ({})",
                question.meaning()
            );
            let finding = Diagnostic::new(Code::NoEquivalent, span, what);
            self.add_once(program, &format!("agree {question}"), finding);
        }
    }

    fn rests_on(&mut self, control: &Control, side: Side, program: usize, span: Span, question: Question) {
        if !self.rested.insert((self.origin(program), side, question)) {
            return;
        }
        let row = control.behaviour(question);
        // It has nothing that the question is about, and no profile can answer it.
        if row.is_none() && question.needs().is_some_and(|needs| needs != "said") {
            return;
        }
        if row.is_some_and(|row| row.origin.is_confirmed() && row.value != "unknown") {
            return;
        }
        let note = row.and_then(|row| row.origin.note.as_deref()).unwrap_or(question.meaning());
        let told = self.facts.entry((side, question));
        let told = told.or_insert_with(|| control.unconfirmed(side, question.fact(), Some(note), span));
        let finding = Diagnostic { span, ..told.clone() };
        self.add_once(program, &format!("{side} {}", question.fact()), finding);
    }

    /// Says, once a program, that it rests on which state a numbered variable is, where no maker's text confirms that.
    pub fn rests_on_number(&mut self, side: Side, program: usize, span: Span, number: u32) {
        let control = if side == Side::Source { self.source } else { self.target };
        let row = control.numbered_state(number).filter(|(.., row)| !row.origin.is_confirmed());
        if let Some((.., row)) = row {
            let finding = control.unconfirmed(side, &row.fact(), row.origin.note.as_deref(), span);
            self.add_once(program, &format!("{side} {}", row.fact()), finding);
        }
    }

    /// How many findings there are so far.
    pub fn found(&self) -> usize {
        self.findings.lists.iter().map(Vec::len).sum()
    }

    /// What was found, by program of the source.
    pub fn into_findings(self) -> Vec<Vec<Diagnostic>> {
        self.findings.into_all()
    }
}
