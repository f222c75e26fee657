//! Codes of the machine that stand in one block.

/// What codes change: a block has one of each kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Spindle,
    Coolant,
    /// The tool in the spindle.
    Tool,
    /// A stop: no other M code stands beside it.
    Stop,
    /// A word without an M code.
    Word,
}

/// Codes of a control: as they are written, and what they change.
pub type Codes = [(&'static str, Part)];

/// Of codes drawn by number: those that may stand in one block, of which `most` are M codes, and the others.
pub fn apart(drawn: &[usize], codes: &Codes, most: usize) -> [Vec<&'static str>; 2] {
    let mut taken: Vec<(&str, Part)> = Vec::new();
    let mut others = Vec::new();
    for (text, part) in drawn.iter().map(|code| codes[code % codes.len()]) {
        let clashes = |(other, there): &(&str, Part)| {
            let letters = ["S", "T"].iter().any(|letter| text.contains(letter) && other.contains(letter));
            letters || *there == part || (part == Part::Stop) != (*there == Part::Stop)
        };
        let many = taken.iter().filter(|(_, part)| *part != Part::Word).count();
        if taken.iter().any(clashes) || (part != Part::Word && many >= most) {
            others.push(text);
        } else {
            taken.push((text, part));
        }
    }
    [taken.into_iter().map(|(text, _)| text).collect(), others]
}
