//! What became of each program.

use super::normal::Normal;
use super::renamed::{Votes, name};
use super::result::{Note, ProgramDiff, Renamed, Verdict};
use super::sides::{Texts, file_of, line_of};
use super::structure::{moved, structure};
use super::whole::Levels;
use crate::control::ProgramRef;
use crate::syntax::ProgramName;
use crate::verify::{
    Job, Listing, Moment, Outcome, ProgramCertificate, Reason, Side, SymbolMap, Why, Witness, class_of,
    listed, verify,
};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Reasons that are told of a program, at the most.
const REASONS: usize = 8;

/// Which programs go together, and which of them anything changed for.
pub struct Changes<'c> {
    texts: [&'c Texts; 2],
    one_machine: bool,
    /// Old programs with their counterparts.
    pairs: Vec<(ProgramRef, ProgramRef)>,
    gone: Vec<ProgramRef>,
    added: Vec<ProgramRef>,
    /// Programs that are known by another number now.
    renumbered: BTreeSet<ProgramRef>,
    /// Old programs that something changed for, in them or in what they call.
    touched: BTreeSet<ProgramRef>,
    /// Those of them that differ by the names of variables alone, with all that they call.
    only_names: BTreeSet<ProgramRef>,
    /// Variables under other names.
    pub renamed: Vec<Renamed>,
}

impl<'c> Changes<'c> {
    /// Looks at the texts. `names` learns what has another name now.
    pub fn new(
        (source, ours): (&Side<'_>, &'c Texts),
        (target, theirs): (&Side<'_>, &'c Texts),
        one_machine: bool,
        names: &mut SymbolMap,
    ) -> Self {
        let renumbered = if one_machine { renumbered(source, target, names) } else { BTreeSet::new() };
        let (mut pairs, mut gone) = (Vec::new(), Vec::new());
        let mut taken: BTreeSet<ProgramRef> = BTreeSet::new();
        for program in source.programs() {
            let there = names.counterpart(source, *program, target).filter(|there| !taken.contains(there));
            // Of several with one number each has its own place.
            let there = there
                .or_else(|| at_its_place((source, *program), target).filter(|there| !taken.contains(there)));
            match there.filter(|there| taken.insert(*there)) {
                Some(there) => pairs.push((*program, there)),
                None => gone.push(*program),
            }
        }
        let added: Vec<ProgramRef> =
            target.programs().iter().copied().filter(|program| !taken.contains(program)).collect();
        let mut votes = Votes::default();
        let of = |texts: &'c Texts, program: &ProgramRef| texts.get(program).map_or(&[][..], Vec::as_slice);
        pairs.iter().for_each(|(old, new)| votes.add(of(ours, old), of(theirs, new)));
        gone.iter().for_each(|old| votes.add(of(ours, old), &[]));
        added.iter().for_each(|new| votes.add(&[], of(theirs, new)));
        let mut renamed = Vec::new();
        if one_machine {
            renamed = votes.renamed(source.control);
            name(names, &renamed, source.control);
        }
        let mut changes = Self {
            texts: [ours, theirs],
            one_machine,
            pairs,
            gone,
            added,
            renumbered,
            touched: BTreeSet::new(),
            only_names: BTreeSet::new(),
            renamed,
        };
        changes.touched = changes.touched_in(source, target);
        changes.only_names = changes.only_names_in(source);
        changes
    }

    fn old(&self, program: ProgramRef) -> &'c [Normal] {
        self.texts[0].get(&program).map_or(&[], Vec::as_slice)
    }

    fn new_text(&self, program: ProgramRef) -> &'c [Normal] {
        self.texts[1].get(&program).map_or(&[], Vec::as_slice)
    }

    /// The old programs that a change reaches.
    fn touched_in(&self, source: &Side<'_>, target: &Side<'_>) -> BTreeSet<ProgramRef> {
        let there: HashMap<ProgramRef, ProgramRef> = self.pairs.iter().copied().collect();
        let is_same = |old: &ProgramRef, new: &ProgramRef| {
            let known =
                |blocks: &[Normal]| blocks.iter().map(|block| block.known.clone()).collect::<Vec<_>>();
            self.one_machine && known(self.old(*old)) == known(self.new_text(*new))
        };
        let changed: BTreeSet<ProgramRef> =
            self.pairs.iter().filter(|(old, new)| !is_same(old, new)).map(|(old, _)| *old).collect();
        let nothing = changed.is_empty() && self.gone.is_empty() && self.added.is_empty();
        let is_touched = |(old, new): &(ProgramRef, ProgramRef)| {
            let reached = source.reached(*old);
            let counterparts: BTreeSet<ProgramRef> =
                reached.iter().filter_map(|program| there.get(program).copied()).collect();
            let open = reached.iter().any(|program| self.old(*program).iter().any(|block| block.open));
            // A program that calls find now and did not before, or found elsewhere.
            let other = target.reached(*new).into_iter().any(|program| !counterparts.contains(&program));
            reached.iter().any(|program| changed.contains(program) || !there.contains_key(program))
                || other
                || (open && !nothing)
        };
        self.pairs.iter().filter(|pair| is_touched(pair)).map(|(old, _)| *old).collect()
    }

    /// The old programs that differ by names alone. A number that is computed may reach a name.
    fn only_names_in(&self, source: &Side<'_>) -> BTreeSet<ProgramRef> {
        let of_name = |old: &String, new: &String| {
            old == new || self.renamed.iter().any(|one| one.old == *old && one.new == *new)
        };
        let same_block = |a: &Normal, b: &Normal| {
            let names = a.variables.len() == b.variables.len();
            let names = names && a.variables.iter().zip(&b.variables).all(|(old, new)| of_name(old, new));
            a.shape == b.shape && names && !a.computes && !b.computes
        };
        let same: BTreeSet<ProgramRef> = self
            .pairs
            .iter()
            .filter(|(old, new)| {
                let (ours, theirs) = (self.old(*old), self.new_text(*new));
                self.one_machine
                    && ours.len() == theirs.len()
                    && ours.iter().zip(theirs).all(|(a, b)| same_block(a, b))
            })
            .map(|(old, _)| *old)
            .collect();
        let all = |program: &ProgramRef| {
            let reached = source.reached(*program);
            let open = reached.iter().any(|program| self.old(*program).iter().any(|block| block.open));
            !open && reached.iter().all(|program| same.contains(program))
        };
        self.touched.iter().copied().filter(all).collect()
    }

    /// How many programs nothing changed for.
    pub fn untouched(&self) -> usize {
        self.pairs.iter().filter(|(old, _)| !self.touched.contains(old)).count()
    }
}

/// The program of the same name that stands at the same place of the file of the same name.
fn at_its_place((source, program): (&Side<'_>, ProgramRef), target: &Side<'_>) -> Option<ProgramRef> {
    let file = source.files.get(program.file)?.name;
    let there = ProgramRef { file: target.files.iter().position(|other| other.name == file)?, ..program };
    let is_there = target.programs().contains(&there) && source.name(program) == target.name(there);
    is_there.then_some(there)
}

/// Programs of which a file had one that is gone, and has one that is new: the same one under another number.
fn renumbered(source: &Side<'_>, target: &Side<'_>, names: &mut SymbolMap) -> BTreeSet<ProgramRef> {
    let known = |side: &Side<'_>, program: &ProgramRef| side.name(*program).cloned();
    let all =
        |side: &Side<'_>| side.programs().iter().filter_map(|p| known(side, p)).collect::<BTreeSet<_>>();
    let (ours, theirs) = (all(source), all(target));
    let single = source.files.len() == 1 && target.files.len() == 1;
    let mut found = BTreeSet::new();
    let lone = |side: &Side<'_>, file: usize, others: &BTreeSet<ProgramName>| {
        let here = side.programs().iter().filter(|program| program.file == file);
        let mut lone = here.filter(|p| known(side, p).is_none_or(|name| !others.contains(&name)));
        let first = lone.next().copied();
        first.filter(|_| lone.next().is_none())
    };
    for (at, file) in source.files.iter().enumerate() {
        let there = target.files.iter().position(|other| single || other.name == file.name);
        let old = lone(source, at, &theirs);
        let new = there.and_then(|there| lone(target, there, &ours));
        let (Some(old), Some(new)) = (old, new) else { continue };
        if let (Some(name), Some(ProgramName::Number(number))) = (known(source, &old), known(target, &new)) {
            names.programs.insert(name.to_string(), number);
            found.insert(old);
        }
    }
    found
}

/// What the verifier says of the old programs that a change reaches.
pub type Certificates = BTreeMap<ProgramRef, ProgramCertificate>;

/// Verifies the programs that anything changed for.
pub fn certificates(job: &Job<'_>, changes: &Changes<'_>) -> Certificates {
    let touched: Vec<ProgramRef> =
        changes.pairs.iter().map(|(old, _)| *old).filter(|old| changes.touched.contains(old)).collect();
    // Of no program named, all would be verified.
    match touched.is_empty() {
        true => BTreeMap::new(),
        false => touched.iter().copied().zip(verify(job, &touched).programs).collect(),
    }
}

/// The program that a picture shows: the first one that differs, else one that is not decided, else the first one.
pub fn pictured_one<'c>(
    changes: &Changes<'_>,
    certificates: &'c Certificates,
) -> Option<(ProgramRef, ProgramRef, Option<&'c Witness>)> {
    let rank = |old: &ProgramRef| match certificates.get(old).map(|certificate| certificate.outcome) {
        Some(Outcome::Different) => 0,
        Some(Outcome::Undecided) => 1,
        Some(Outcome::Same) | None => 2,
    };
    let (old, new) = changes.pairs.iter().min_by_key(|(old, _)| rank(old))?;
    let witness = certificates.get(old).and_then(|certificate| certificate.witness.as_ref());
    Some((*old, *new, witness))
}

/// What became of the programs that anything changed for.
pub fn programs(
    job: &Job<'_>,
    changes: &Changes<'_>,
    certificates: &Certificates,
    levels: Levels,
    most: usize,
) -> Vec<ProgramDiff> {
    let mut out: Vec<ProgramDiff> = changes
        .pairs
        .par_iter()
        .filter_map(|(old, new)| match certificates.get(old) {
            Some(certificate) => Some(changed(job, changes, (*old, *new), certificate, levels, most)),
            None => untouched(job, changes, (*old, *new), levels),
        })
        .collect();
    out.extend(changes.gone.iter().map(|old| alone(job.source, *old, true)));
    out.extend(changes.added.iter().map(|new| alone(job.target, *new, false)));
    out
}

fn paired(job: &Job<'_>, (old, new): (ProgramRef, ProgramRef)) -> ProgramDiff {
    let name = job.target.name(new).or(job.source.name(old));
    ProgramDiff {
        program: name.map(ToString::to_string),
        old: file_of(job.source, old),
        new: file_of(job.target, new),
        line: line_of(job.target, new),
        verdict: Verdict::Same,
        why: Vec::new(),
        structure: None,
        motion: None,
    }
}

/// A program that is the same for its control, where its text is not: a person wants to read so.
fn untouched(
    job: &Job<'_>,
    changes: &Changes<'_>,
    (old, new): (ProgramRef, ProgramRef),
    levels: Levels,
) -> Option<ProgramDiff> {
    let bytes = |side: &Side<'_>, program: ProgramRef| {
        let blocks = side.text(program);
        let span = blocks.first()?.span.to(blocks.last()?.span);
        Some(span.of(side.files.get(program.file)?.parsed.source).to_vec())
    };
    let mut out = paired(job, (old, new));
    let moved = out.old != out.new && job.source.files.len() + job.target.files.len() > 2;
    if bytes(job.source, old) == bytes(job.target, new) && !moved {
        return None;
    }
    out.why.push("nothing changed that the control reads".into());
    if moved && let (Some(from), Some(to)) = (&out.old, &out.new) {
        out.why.push(format!("it stands in {to} now, before in {from}"));
    }
    out.structure =
        levels.structure.then(|| structure(changes.old(old), changes.new_text(new), &changes.renamed));
    Some(out)
}

/// A program that is gone, or new.
fn alone(side: &Side<'_>, program: ProgramRef, gone: bool) -> ProgramDiff {
    let file = file_of(side, program);
    let (old, new) = if gone { (file, None) } else { (None, file) };
    let why = if gone { "the program is gone" } else { "the program is new" };
    ProgramDiff {
        program: side.name(program).map(ToString::to_string),
        old,
        new,
        line: line_of(side, program),
        verdict: Verdict::Different,
        why: vec![why.into()],
        structure: None,
        motion: None,
    }
}

fn changed(
    job: &Job<'_>,
    changes: &Changes<'_>,
    (old, new): (ProgramRef, ProgramRef),
    certificate: &ProgramCertificate,
    levels: Levels,
    most: usize,
) -> ProgramDiff {
    let mut out = paired(job, (old, new));
    // Of two programs that differ by names alone each fact that no manual confirms is the same.
    let shared = changes.only_names.contains(&old);
    let reasons = certificate.reasons.iter().filter(|reason| !shared || reason.why != Why::Unconfirmed);
    let reasons: Vec<&Reason> = reasons.collect();
    out.verdict = match certificate.outcome {
        Outcome::Same => Verdict::Same,
        Outcome::Undecided if reasons.is_empty() => Verdict::Same,
        Outcome::Undecided => Verdict::Undecided,
        Outcome::Different => Verdict::Different,
    };
    if out.verdict == Verdict::Undecided {
        out.why.extend(reasons.iter().take(REASONS).map(|reason| reason.text.clone()));
        let cannot_run = reasons.iter().any(|reason| reason.why == Why::CannotRun);
        if cannot_run && job.source.files.len() <= 1 {
            let advice = "name the folder of the programs that it calls with --library, or compare folders";
            out.why.push(advice.into());
        }
    }
    if levels.structure {
        let (ours, theirs) = (changes.old(old), changes.new_text(new));
        out.structure = Some(match changes.one_machine {
            true => structure(ours, theirs, &changes.renamed),
            false => moved(ours, theirs, &registers(job)),
        });
    }
    if out.verdict == Verdict::Different && levels.motion {
        let listing = listed(job, old, certificate.witness.as_ref(), most);
        out.motion = Some(or_witness(listing, certificate));
    }
    if changes.renumbered.contains(&old) {
        let was = job.source.name(old).map(ToString::to_string).unwrap_or_default();
        let is = job.target.name(new).map(ToString::to_string).unwrap_or_default();
        let text = format!("program {was} is {is} now: what calls it must call the new number");
        let lines = [Some(line_of(job.source, old)), Some(line_of(job.target, new))];
        let note = Note { about: "program", text: text.clone(), old: lines[0], new: lines[1] };
        out.structure.iter_mut().for_each(|notes| notes.insert(0, note.clone()));
        out.verdict = Verdict::Different;
        out.why.push(text);
    }
    out
}

/// The listing; where it shows nothing, what the verifier saw: it tries more.
fn or_witness(mut listing: Listing, certificate: &ProgramCertificate) -> Listing {
    if let Some(witness) =
        certificate.witness.as_ref().filter(|_| listing.changes.is_empty() && listing.at_end.is_empty())
    {
        listing.differing = listing.differing.max(1);
        let place = |moment: &Option<Moment>| {
            moment.as_ref().map(|moment| format!("line {} '{}'", moment.line, moment.block.trim()))
        };
        let places: Vec<String> =
            [place(&witness.source), place(&witness.target)].into_iter().flatten().collect();
        let at = if places.is_empty() { String::new() } else { format!(" ({})", places.join(" -> ")) };
        listing.at_end.push(format!("{}{at}", witness.what));
    }
    listing
}

/// Where the target has the variables of the source, by the lock.
fn registers(job: &Job<'_>) -> Vec<(String, String)> {
    let prefix = job.target.control.classes().iter().find(|row| row.class != "letter");
    let Some(prefix) = prefix.map(|row| row.name.as_str()) else { return Vec::new() };
    let all = job.names.variables.iter().filter(|(name, _)| class_of(job.source.control, name).is_some());
    all.map(|(name, number)| (name.clone(), format!("{prefix}{number}"))).collect()
}
