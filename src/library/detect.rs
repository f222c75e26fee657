//! Which control a library is written for, by its text.

use super::Input;
use crate::dialect::{CODE_SYSTEM, Control, Entry, Plain, registry};
use crate::syntax::{ExprKind, ItemKind, for_each_item, parse_file};
use rayon::prelude::*;
use std::sync::LazyLock;

/// Bytes of each file that are looked at: of a few files, and of many.
const HEAD: usize = 16 * 1024;
const SHORT: usize = 2 * 1024;
const FEW: usize = 40;

/// By how much of the text a control is clearly ahead of another.
const AHEAD: f64 = 0.15;

/// By how little it is ahead where nothing is decided, of another family and of its own.
const NEAR: f64 = 0.02;
const NEAR_OF_FAMILY: f64 = 0.055;

/// What the text says.
#[derive(Clone, Debug, PartialEq)]
pub enum Detected {
    /// One control reads it, and no other does as well.
    Sure(&'static Entry),
    /// These read it alike.
    Unsure(Vec<&'static Entry>),
    /// Most of it looks like the first, and a file, which is named, like the second.
    Mixed(&'static Entry, String, &'static Entry),
}

/// How many blocks there are, and how many of them a control reads without fault and has the codes of.
#[derive(Clone, Copy, Debug, Default)]
struct Score {
    good: usize,
    all: usize,
}

impl Score {
    fn share(self) -> f64 {
        if self.all > 0 { self.good as f64 / self.all as f64 } else { 0.0 }
    }

    /// True where this control reads clearly more: some blocks, and a good part of all.
    fn is_far_above(self, other: Self) -> bool {
        self.share() > 0.5 && self.good >= other.good + 3 && self.share() > other.share() + AHEAD
    }

    fn add(self, other: Self) -> Self {
        Self { good: self.good + other.good, all: self.all + other.all }
    }
}

/// Reads the heads of the files by every control's grammar: the one that finds fewest faults, and
/// most words its table has a meaning for, is the one, where it is ahead of the others and no file is clearly
/// another control's. A file that shows nothing goes with the others.
pub fn detect(inputs: &[Input]) -> Detected {
    let files = scores(inputs, if inputs.len() <= FEW { HEAD } else { SHORT });
    let mut whole = of_all(&files);
    whole.sort_by(|a, b| b.0.share().total_cmp(&a.0.share()));
    let best = whole.first().map_or(0.0, |(score, _)| score.share());
    let family = |entry: &Entry| entry.dialect().ok().map(|dialect| dialect.family.clone());
    let of_best = whole.first().and_then(|(_, entry)| family(entry));
    // Controls of one family have most blocks in common: a few that one alone has not tell little.
    let is_near = |(score, entry): &&(Score, &'static Entry)| {
        let margin = if family(entry) == of_best { NEAR_OF_FAMILY } else { NEAR };
        score.share() >= best - margin
    };
    let near: Vec<&'static Entry> = whole.iter().filter(is_near).map(|(_, entry)| *entry).collect();
    let Some(first) = near.first() else { return Detected::Unsure(near) };
    for (input, file) in inputs.iter().zip(&files) {
        let of = |entry: &Entry| file.iter().find(|(_, e)| *e == entry).map_or(Score::default(), |(s, _)| *s);
        let above = |(score, _): &&(Score, _)| near.iter().all(|near| score.is_far_above(of(near)));
        if let Some((_, other)) = file.iter().filter(above).max_by_key(|(score, _)| score.good) {
            return Detected::Mixed(first, input.name.clone(), other);
        }
    }
    match near.as_slice() {
        [one] if best > 0.5 => Detected::Sure(one),
        _ => Detected::Unsure(near),
    }
}

/// By control, how much of the heads of the files it reads without fault and has the codes of: 1 is all. The best is first.
pub fn likeness(inputs: &[Input]) -> Vec<(&'static Entry, f64)> {
    let mut all = of_all(&scores(inputs, if inputs.len() <= FEW { HEAD } else { SHORT }));
    all.sort_by(|a, b| b.0.share().total_cmp(&a.0.share()));
    all.into_iter().map(|(score, entry)| (entry, score.share())).collect()
}

/// What programs look like that are said to be written for `named`: a sentence, where another control clearly reads
/// more of them, or of one file.
pub fn looks_like(inputs: &[Input], named: &str) -> Option<String> {
    let step = inputs.len().div_ceil(FEW).max(1);
    let some: Vec<Input> = inputs.iter().step_by(step).map(head).collect();
    if kinds(&Control::plain(named)?).iter().any(|control| reads_most(control, &some)) {
        return None;
    }
    let files = scores(&some, SHORT);
    let of = |scores: &[(Score, &Entry)]| scores.iter().find(|(_, e)| e.name == named).map(|(s, _)| *s);
    let told = |scores: &[(Score, &'static Entry)], what: &str| {
        let own = of(scores)?;
        let (best, entry) = scores.iter().max_by_key(|(score, _)| score.good)?;
        best.is_far_above(own).then(|| {
            format!(
                "{what} looks like {}: of {} blocks it reads {}, and {named} reads {}",
                entry.name, best.all, best.good, own.good
            )
        })
    };
    let single = || some.iter().zip(&files).find_map(|(input, file)| told(file, &input.name));
    told(&of_all(&files), "the text").or_else(single)
}

/// True where a control reads so much of each file that none can read clearly more: the others need not be asked.
fn reads_most(control: &Control, inputs: &[Input]) -> bool {
    let most = |score: Score| score.share() + AHEAD >= 1.0;
    let files: Vec<Score> = inputs.par_iter().map(|input| score(control, &input.bytes)).collect();
    files.iter().copied().all(most) && most(files.into_iter().fold(Score::default(), Score::add))
}

/// The start of a file, to its last whole line.
fn head(input: &Input) -> Input {
    Input { path: input.path.clone(), name: input.name.clone(), bytes: start(&input.bytes, SHORT).to_vec() }
}

fn start(bytes: &[u8], most: usize) -> &[u8] {
    match bytes.get(..most) {
        Some(head) => {
            let end = head.iter().rposition(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(most);
            head.get(..end).unwrap_or(head)
        }
        None => bytes,
    }
}

/// Every control without a profile: kinds of machines that two controls share tell neither from the other.
static CONTROLS: LazyLock<Vec<(Control, &'static Entry)>> = LazyLock::new(|| {
    let plain = |entry: &'static Entry| Some((Control::plain(entry.name)?, entry));
    registry::all().iter().filter_map(plain).collect()
});

/// A control as a mill, and as a lathe by each of its systems.
fn kinds(control: &Control) -> Vec<Control> {
    let lathe = super::kind::as_lathe(control);
    let systems = lathe.iter().flat_map(|lathe| match lathe.open_code_system() {
        Some((_, row)) => row.values.iter().filter_map(|system| of_system(lathe, system)).collect(),
        None => vec![lathe.clone()],
    });
    std::iter::once(control.clone()).chain(systems).collect()
}

fn of_system(lathe: &Control, system: &str) -> Option<Control> {
    let mut profile = lathe.profile().clone();
    profile.settings.insert(CODE_SYSTEM.into(), Plain::Word(system.into()));
    Control::new(lathe.entry(), profile).ok()
}

/// How each control reads each file.
fn scores(inputs: &[Input], most: usize) -> Vec<Vec<(Score, &'static Entry)>> {
    let of = |input: &Input| {
        CONTROLS.iter().map(|(c, entry)| (score(c, start(&input.bytes, most)), *entry)).collect()
    };
    inputs.par_iter().map(of).collect()
}

fn of_all(files: &[Vec<(Score, &'static Entry)>]) -> Vec<(Score, &'static Entry)> {
    let sum = |at: usize| {
        files.iter().filter_map(|file| file.get(at)).map(|(s, _)| *s).fold(Score::default(), Score::add)
    };
    registry::all().iter().enumerate().map(|(at, entry)| (sum(at), entry)).collect()
}

/// The blocks without fault whose codes the table knows.
fn score(control: &Control, bytes: &[u8]) -> Score {
    let mut score = Score::default();
    for block in parse_file(bytes, control.entry().parse).blocks {
        let mut known = block.errors.is_empty();
        for_each_item(&block.items, &mut |item| {
            if let ItemKind::Word(word) = &item.kind
                && let ('G' | 'M', Some(value)) = (word.letter, &word.value)
                && let ExprKind::Number(number) = &value.kind
            {
                known &= control.code(word.letter, number.value, &[]).is_some();
            }
        });
        score.all += 1;
        score.good += usize::from(known);
    }
    score
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::gather;

    fn corpus(dialect: &str) -> Vec<Input> {
        let found = gather(&[format!("{}/corpus/{dialect}", env!("CARGO_MANIFEST_DIR")).into()], &[]);
        assert!(found.errors.is_empty());
        found.programs
    }

    #[test]
    fn the_corpus_looks_like_itself() {
        for entry in registry::all() {
            let inputs = corpus(entry.name);
            assert_eq!(looks_like(&inputs, entry.name), None);
            match detect(&inputs) {
                Detected::Sure(found) => assert_eq!(found.name, entry.name),
                Detected::Unsure(near) => assert!(near.iter().any(|near| near.name == entry.name)),
                Detected::Mixed(_, file, like) => panic!("{file} is taken as {}", like.name),
            }
        }
    }

    /// Its G71 and G76 are no codes of the mill's table, and G95 is none of system A.
    #[test]
    fn a_lathe_program_is_read_as_a_lathes() {
        let file =
            |name: &str, text: &str| Input { path: name.into(), name: name.into(), bytes: text.into() };
        let a = "O1\nT0101\nG50 S2000\nG96 S180 M3\nG0 X52. Z2.\nG71 U2. R.5\nG71 P1 Q2 U.4 W.1 F.2\nN1 G0 X20.\nN2 G1 Z-20.\n\
                 G70 P1 Q2\nG75 R.5\nG75 X10. P2000 F.1\nG28 U0 W0\nM30\n";
        let b = "O2\nT0202\nG92 S2000\nG95 G90\nG77 X40. Z-5. F.2\nG78 X38. Z-5. F1.5\nG79 X0. Z1. F.2\nG33 Z-5. F1.5\nM30\n";
        for text in [a, b] {
            assert_eq!(looks_like(&[file("a.nc", text)], "fanuc"), None, "{text}");
        }
    }

    #[test]
    fn a_wrong_name_is_told() {
        for (own, named) in [("fadal", "fanuc"), ("fadal", "cc100"), ("cc100", "haas"), ("fanuc", "fadal")] {
            let told = looks_like(&corpus(own), named).unwrap_or_default();
            assert!(
                told.contains(&format!("looks like {own}")) || own == "fanuc" && told.contains("haas"),
                "{told}"
            );
        }
    }

    #[test]
    fn a_folder_of_two_kinds_is_not_guessed() {
        let mut inputs = corpus("fanuc");
        let plain = Input { path: "p.nc".into(), name: "p.nc".into(), bytes: b"O1\nG0 X1.\nM30\n".to_vec() };
        inputs.push(plain);
        assert!(!matches!(detect(&inputs), Detected::Mixed(..)));
        inputs.extend(corpus("fadal").into_iter().filter(|input| input.name == "o800-dhole.nc"));
        let Detected::Mixed(most, file, like) = detect(&inputs) else { panic!("{:?}", detect(&inputs)) };
        assert_eq!((file.as_str(), like.name), ("o800-dhole.nc", "fadal"));
        assert!(["fanuc", "haas"].contains(&most.name));
        assert!(
            looks_like(&inputs, "fanuc").is_some_and(|told| told.contains("o800-dhole.nc looks like fadal"))
        );
    }
}
