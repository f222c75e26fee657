//! Places in machine coordinates that programs name: where each lies on the target is told in its profile.

use super::filled::TELLS;
use crate::canon::{Op, Role};
use crate::dialect::{Control, Question};
use crate::ir::analysis::tool_word;
use crate::ir::{Module, Nc, NcItem, StmtKind};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// How many are listed at the most: those of most programs.
const MOST: usize = 20;

/// Places as their words, each with how many programs name it; the most frequent first. None if the target's profile says that its places
/// are the same.
pub(super) fn named(target: &Control, module: &Module) -> Vec<(String, usize)> {
    if target.behaviour(Question::MachinePlaces).is_some_and(|row| row.value == "same") {
        return Vec::new();
    }
    let mut all: BTreeMap<String, usize> = BTreeMap::new();
    for program in &module.programs {
        let mut own = BTreeSet::new();
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            let place = place(nc).filter(|place| target.machine_places().of(place, None).is_none());
            own.extend(place.map(|place| words(&place)));
        }
        own.into_iter().for_each(|place| *all.entry(place).or_default() += 1);
    }
    let mut all: Vec<(String, usize)> = all.into_iter().collect();
    all.sort_by_key(|(_, programs)| std::cmp::Reverse(*programs));
    all
}

/// The place of a move in machine coordinates, or without a tool offset, where all its words are numbers and one is not 0.
fn place(nc: &Nc) -> Option<Vec<(Role, f64)>> {
    let home = nc.has(Op::ReferenceReturn) || nc.has(Op::Reference2);
    let away = !home && tool_word::takes_offset(nc) == Some(true);
    if !nc.has(Op::MachineOnce) && !nc.has(Op::ShiftCancel) && !away {
        return None;
    }
    let mut place = Vec::new();
    for item in &nc.items {
        match item {
            NcItem::Word(role, value) if role.is_axis() && !role.is_step() => {
                place.push((*role, value.constant()?));
            }
            NcItem::Word(role, _) if role.is_step() => return None,
            _ => {}
        }
    }
    Some(place).filter(|place| place.iter().any(|(_, number)| *number != 0.0))
}

fn words(place: &[(Role, f64)]) -> String {
    let word = |(role, number): &(Role, f64)| {
        let letter = role.axis_number().and_then(|number| "XYZABC".chars().nth(number as usize - 1));
        let point = if number.fract() == 0.0 { "." } else { "" };
        letter.map(|letter| format!("{letter}{number}{point}"))
    };
    place.iter().filter_map(word).collect::<Vec<_>>().join(" ")
}

/// What a profile is told of them.
pub(super) fn told(all: &[(String, usize)]) -> String {
    let mut text = String::new();
    if all.is_empty() {
        return text;
    }
    let _ = writeln!(
        text,
        "{TELLS} Where a place of the old machine lies elsewhere here, say it above the first [section], with the words that the move gets:\n\
         {TELLS} machine_places = ["
    );
    for (place, programs) in all.iter().take(MOST) {
        let axes: Vec<&str> = place.split(' ').filter_map(|word| word.get(..1)).collect();
        let programs = if *programs == 1 { "1 program".to_owned() } else { format!("{programs} programs") };
        let _ = writeln!(text, "{TELLS}     \"{place} as {}\", # {programs}", axes.join(" "));
    }
    let _ = writeln!(text, "{TELLS} ]");
    text
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    #[test]
    fn places_are_listed_once_until_the_profile_says_where_they_lie() {
        let source = Control::from_profile("dialect = \"fanuc\"\nmachine = \"mill\"\n").unwrap();
        let listed = |more: &str| {
            let target = format!("dialect = \"haas\"\nmachine = \"mill\"\n{more}");
            let there = Control::from_profile(&target).unwrap();
            let input =
                |name: &str, text: &str| Input { path: name.into(), name: name.into(), bytes: text.into() };
            let head = "G21 G90 G17 G40 G49 G80\nG53 Z0\n";
            let inputs = [
                input(
                    "a.nc",
                    &format!("O1\n{head}G53 X-11. Y-13.5\nG53 X-11. Y-13.5\nG91 G53 Z0\nG90\nM30\n"),
                ),
                input("b.nc", &format!("O2\n{head}G53 X-11. Y-13.5\nG53 Y-2.\nG53 X#500\nM30\n")),
            ];
            let text = filled(&survey(&inputs, &source, Some(&there)), Side::Target, Some(&target)).unwrap();
            text.lines().filter(|line| line.starts_with("#:     ")).map(str::to_owned).collect::<Vec<_>>()
        };
        let both = ["#:     \"X-11. Y-13.5 as X Y\", # 2 programs", "#:     \"Y-2. as Y\", # 1 program"]
            .map(str::to_owned);
        assert_eq!(listed(""), both);
        assert_eq!(listed("[behaviours]\n\"machine.places\" = \"other\"\n"), both);
        assert!(listed("[behaviours]\n\"machine.places\" = \"same\"\n").is_empty());
        let said = "machine_places = [\"X-11. Y-13.5 as X-300. Y0\"]\n";
        assert_eq!(
            listed(said).iter().filter(|line| line.starts_with("#:")).cloned().collect::<Vec<_>>(),
            both[1..]
        );
    }
}
