//! Programs that are called and not in the library: whether they stand on the target.

use super::Survey;
use super::filled::{ASKS, after_dialect, spliced};
use super::shape::Missing;
use crate::dialect::Profile;

/// The programs that may stand on the target and that its profile does not name, those that free most programs first; with
/// the number there, where the target has no such number.
pub(super) fn entries(survey: &Survey<'_>) -> Vec<String> {
    missing(survey).into_iter().map(|(_, entry)| entry).collect()
}

fn missing<'s>(survey: &'s Survey<'_>) -> Vec<(&'s Missing, String)> {
    let [source, target] = survey.controls;
    let has_locals = [source, target].iter().all(|control| {
        let mut classes = control.classes().iter();
        classes.any(|class| class.class == "local")
    });
    let is_asked = survey.goes && has_locals;
    let numbers = &survey.rest.lock.programs;
    let all = survey.shape.missing.iter().filter(|_| is_asked).filter_map(|missing| {
        let number = missing.number().filter(|number| target.standing().number_of(*number).is_none())?;
        let there = numbers.get(&missing.name).filter(|there| **there != number);
        let entry = match there {
            Some(there) => format!("O{number} as O{there}"),
            None => format!("O{number}"),
        };
        Some((missing, entry))
    });
    let mut all: Vec<(&Missing, String)> = all.collect();
    all.sort_by_key(|(missing, _)| std::cmp::Reverse((missing.frees, missing.programs)));
    all
}

/// The target's profile with the question of such programs: one line, or more in the list that it has.
pub(super) fn asked_in(text: &str, survey: &Survey<'_>) -> String {
    let all = missing(survey);
    let Some((first, _)) = all.first() else { return text.to_owned() };
    let Ok(profile) = Profile::read(text) else { return text.to_owned() };
    let list = all.iter().map(|(_, entry)| format!("\"{entry}\"")).collect::<Vec<_>>().join(", ");
    let calls = if first.programs == 1 {
        "1 program calls".into()
    } else {
        format!("{} programs call", first.programs)
    };
    let about = format!(
        "those that stand on this machine and do the same as on the source, which are not in the library ({calls} the first)"
    );
    match profile.place("programs") {
        None => {
            let line = format!("{ASKS} programs = [{list}] # {about}\n");
            spliced(text, after_dialect(text, &profile), &line)
        }
        Some(place) => {
            // A line in the list is a comment, whatever stands before it.
            let at = place.start + 1;
            let end = if text.get(at..).is_some_and(|rest| rest.starts_with('\n')) { "" } else { "\n" };
            spliced(text, at, &format!("\n{ASKS} {list}, # {about}{end}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Profile, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    fn target(text: &str) -> String {
        let program =
            |name: &str, text: &str| Input { path: name.into(), name: name.into(), bytes: text.into() };
        let inputs = [
            program("a.nc", "O1\nG65 P9810 Z1.\nG65 P9811 X1.\nM30\n"),
            program("b.nc", "O2\nG65 P9811 Z1.\nG65 P910002\nM30\n"),
        ];
        let source = Control::from_profile("dialect = \"fanuc\"\n").unwrap();
        let target = Control::from_profile(text).unwrap();
        filled(&survey(&inputs, &source, Some(&target)), Side::Target, Some(text)).unwrap()
    }

    #[test]
    fn programs_that_are_missing_are_asked_in_one_line_those_of_most_programs_first() {
        let text = target("dialect = \"haas\"\n");
        let lines: Vec<&str> = text.lines().filter(|line| line.contains("programs = [")).collect();
        assert_eq!(lines.len(), 1, "{text}");
        let list = "#? programs = [\"O9811\", \"O9810\", \"O910002 as O8000\"] # those that stand";
        assert!(lines[0].starts_with(list), "{text}");
        assert_eq!(target(&text), text);
    }

    #[test]
    fn what_is_answered_stays_and_the_rest_is_asked_in_its_list() {
        let text = target("dialect = \"haas\"\nprograms = [\"O9811\"]\n");
        assert!(text.contains("#? \"O9810\", \"O910002 as O8000\", # those"), "{text}");
        assert_eq!(Profile::read(&text).unwrap().programs, ["O9811"]);
        assert_eq!(target(&text), text);
        let opened = text.replace("#? \"O9810\", ", "\"O9810\", ");
        assert_eq!(Profile::read(&opened).unwrap().programs, ["O9810", "O910002 as O8000", "O9811"]);
        let done = target("dialect = \"haas\"\nprograms = [\"O9800-O9899\", \"O910002 as O8123\"]\n");
        assert!(!done.contains("#? \"") && !done.contains("#? programs"), "{done}");
    }
}
