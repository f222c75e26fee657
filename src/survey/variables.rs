//! Variables that programs use and the table of their control has not, and its rotary axes: whether the machine has them, its
//! profile says.

use super::Survey;
use super::filled::{ASKS, TELLS, after_dialect, spliced};
use super::shape::{NAMED, Places};
use crate::canon::{Op, Role};
use crate::diag::Asks;
use crate::dialect::{Control, Machine, Profile, Question, VariableRun};
use crate::ir::Module;
use crate::library::ProgramReport;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Numbers so near to one another are asked as one run: a shop's variables stand together.
const NEAR: u32 = 100;

/// A run of variables that the table has not.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct AskedVariables {
    /// The name before the number.
    pub name: String,
    /// The first that programs use.
    pub first: u32,
    /// The last that programs use.
    pub last: u32,
    /// How many programs wait for one of them.
    pub programs: usize,
    /// The first places, as `file:line`.
    pub places: Vec<String>,
}

impl AskedVariables {
    /// The run as a profile has it: `#901011-#901131`.
    pub fn run(&self) -> String {
        let Self { name, first, last, .. } = self;
        if first == last { format!("{name}{first}") } else { format!("{name}{first}-{name}{last}") }
    }

    /// The run as an answer: variables that keep their values, as most of those that a machine has more of.
    pub(super) fn entry(&self) -> String {
        format!("{} retained", self.run())
    }
}

/// The variables that programs wait for, in order of their numbers.
pub(super) fn asked(
    places: &Places<'_>,
    source: &Control,
    programs: &[ProgramReport],
) -> Vec<AskedVariables> {
    let Some(name) = source.numbered() else { return Vec::new() };
    if !source.classes().iter().any(|class| class.name == name && class.class == "retained") {
        return Vec::new();
    }
    // Those of which the profile says that they are not there.
    let said = source.profile().variables.iter().flatten().filter_map(|text| VariableRun::read(text));
    let missing: Vec<VariableRun> = said.filter(VariableRun::is_missing).collect();
    let mut found: BTreeMap<u32, (BTreeSet<usize>, Vec<String>)> = BTreeMap::new();
    for (at, program) in programs.iter().enumerate() {
        for finding in &program.diagnostics {
            let Some(Asks::Variable { number }) = finding.asks.as_deref() else { continue };
            if missing.iter().any(|run| run.holds(name, *number, false)) {
                continue;
            }
            let (waiting, named) = found.entry(*number).or_default();
            waiting.insert(at);
            if named.len() < NAMED {
                named.push(places.at(program.file, finding.span));
            }
        }
    }
    let is_free = |number: u32| {
        source.variable_class(name, number).is_none()
            && source.numbered_state(number).is_none()
            && source.system_under(name, number).is_none()
    };
    let mut runs: Vec<(AskedVariables, BTreeSet<usize>)> = Vec::new();
    for (number, (waiting, named)) in found {
        let joins = |last: u32| number - last <= NEAR && (last + 1..number).all(is_free);
        match runs.last_mut().filter(|(run, _)| joins(run.last)) {
            Some((run, programs)) => {
                run.last = number;
                programs.extend(waiting);
                let new = named.into_iter().filter(|place| !run.places.contains(place)).collect::<Vec<_>>();
                run.places.extend(new.into_iter().take(NAMED.saturating_sub(run.places.len())));
            }
            None => {
                let name = name.to_owned();
                let run = AskedVariables { name, first: number, last: number, programs: 0, places: named };
                runs.push((run, waiting));
            }
        }
    }
    runs.into_iter().map(|(run, programs)| AskedVariables { programs: programs.len(), ..run }).collect()
}

/// The letters of the axes that programs move and that not every machine of the kind has: those that turn, and Y of a lathe.
pub(super) fn further_axes(source: &Control, module: &Module) -> Vec<Role> {
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let mut roles = [(Role::Y, false), (Role::A, false), (Role::B, false), (Role::C, false)];
    let mut on_face = false;
    // Letters that are axes on one such lathe are corners and angles on another.
    let corners = source.corner_setting().is_some();
    for nc in stmts.filter_map(|stmt| stmt.kind.nc()) {
        // In the plane of a face Y is a length that C makes.
        on_face = nc.has(Op::PolarPlane) || on_face && !nc.has(Op::PolarPlaneOff);
        for (role, moved) in &mut roles {
            let lathe = source.machine() == Machine::Lathe;
            // Beside X or Z of such a lathe A may be the angle of a line, and C a chamfer: what moves an axis stands alone somewhere.
            let drawn = [Role::X, Role::Z, Role::StepX, Role::StepZ];
            let drawn = lathe && corners && drawn.iter().any(|role| nc.word(*role).is_some());
            let counts = match role {
                Role::Y => lathe && !on_face,
                Role::A | Role::C => !drawn,
                _ => true,
            };
            *moved |= counts && nc.word(*role).is_some();
        }
    }
    roles.into_iter().filter(|(_, moved)| *moved).map(|(role, _)| role).collect()
}

/// The line of a profile that lists the axes: those that every machine of the kind has, and those that the programs move.
pub(super) fn axes_line(survey: &Survey<'_>, control: &Control) -> String {
    let lathe = control.profile().machine == Some(Machine::Lathe);
    let lettered = control.behaviour(Question::AxesNumbered).is_some_and(|row| row.value == "letter");
    let letters = survey.further_axes.iter().filter_map(|role| control.letter(*role, None));
    let more: String = letters.map(|(letter, _)| format!(", \"{letter}\"")).collect();
    let (first, how) = match (lathe, lettered) {
        (true, _) => ("\"X\", \"Z\"", "in the order of the control's axis numbers"),
        (_, true) => ("\"X\", \"Y\", \"Z\"", "those that the machine has"),
        (_, false) => ("\"X\", \"Y\", \"Z\"", "in the order of the control's axis numbers"),
    };
    format!("axes = [{first}{more}] # {how}")
}

/// All variables of the machine with those that are asked: what `variables` of its profile would be.
pub(super) fn all(source: &Control, asked: &[AskedVariables]) -> Vec<String> {
    let stated = source.profile().variables.clone();
    let own = stated.unwrap_or_else(|| {
        let mut runs: Vec<(String, u32, u32)> = Vec::new();
        for class in source.classes().iter().filter(|class| class.class != "letter") {
            match runs.last_mut() {
                Some((name, _, last)) if *name == class.name && class.first == last.saturating_add(1) => {
                    *last = class.last;
                }
                _ => runs.push((class.name.clone(), class.first, class.last)),
            }
        }
        runs.into_iter().map(|(name, first, last)| format!("{name}{first}-{name}{last}")).collect()
    });
    own.into_iter().chain(asked.iter().map(AskedVariables::entry)).collect()
}

/// The source's profile with the question of such variables: one line, or more in the list that it has.
pub(super) fn asked_in(text: &str, survey: &Survey<'_>) -> String {
    let asked = &survey.variables;
    if asked.is_empty() {
        return text.to_owned();
    }
    let Ok(profile) = Profile::read(text) else { return text.to_owned() };
    let quoted = |entries: Vec<String>| {
        entries.iter().map(|entry| format!("\"{entry}\"")).collect::<Vec<_>>().join(", ")
    };
    let mut told = String::new();
    for run in asked.iter().take(NAMED) {
        let programs =
            if run.programs == 1 { "1 program".into() } else { format!("{} programs", run.programs) };
        let _ = writeln!(told, "{TELLS} {}: {programs}: {}", run.run(), run.places.join(", "));
    }
    let about = "variables that the control's table does not have: 'common' for 'retained' where they are empty after power-on, 'none' \
                 where the machine does not have them";
    match profile.place("variables") {
        None => {
            let list = quoted(all(survey.controls[0], asked));
            let line = format!("{told}{ASKS} variables = [{list}] # {about}\n");
            spliced(text, after_dialect(text, &profile), &line)
        }
        Some(place) => {
            // A line in the list is a comment, whatever stands before it.
            let at = place.start + 1;
            let end = if text.get(at..).is_some_and(|rest| rest.starts_with('\n')) { "" } else { "\n" };
            let list = quoted(asked.iter().map(AskedVariables::entry).collect());
            spliced(text, at, &format!("\n{ASKS} {list}, # {about}{end}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Profile, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    fn source(text: &str) -> String {
        let program = "O1\n#1=#404+#472\n#2=#901011\n#901053=#98000\nM30\n";
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: program.into() }];
        let source = Control::from_profile(text).unwrap();
        let target = Control::from_profile("dialect = \"haas\"\n").unwrap();
        filled(&survey(&inputs, &source, Some(&target)), Side::Source, Some(text)).unwrap()
    }

    #[test]
    fn variables_that_the_table_lacks_are_asked_in_one_line() {
        let text = source("dialect = \"fanuc\"\n");
        let lines: Vec<&str> = text.lines().filter(|line| line.contains("variables = [")).collect();
        let list = "#? variables = [\"#1-#33\", \"#100-#199\", \"#500-#999\", \"#404-#472 retained\", \"#98000 retained\", \
                    \"#901011-#901053 retained\"] # variables";
        assert!(lines.len() == 1 && lines[0].starts_with(list), "{text}");
        assert_eq!(source(&text), text);
        let opened = text.replace("#? variables", "variables");
        assert!(!source(&opened).contains("#? variables"), "{}", source(&opened));
    }

    #[test]
    fn what_the_machine_does_not_have_is_asked_no_more() {
        let asked = source("dialect = \"fanuc\"\n");
        let said = asked.replace("#? variables", "variables");
        let said =
            said.replace("#404-#472 retained", "#404-#472 none").replace("#98000 retained", "#98000 none");
        let text = source(&said);
        assert!(!text.contains("#? \"#") && !text.contains("#? variables"), "{text}");
        let control = Control::from_profile(&text).unwrap();
        let there = |number: u32| control.variable_class("#", number).is_some();
        assert!(there(500) && there(901011) && !there(404) && !there(98000));
        let twice =
            Control::from_profile("dialect = \"fanuc\"\nvariables = [\"#500-#999\", \"#600 none\"]\n");
        let faults = twice.map(|_| ()).unwrap_err();
        assert!(faults[0].message.contains("'#600 none' names variables that are there"), "{faults:?}");
    }

    /// What the machine has under another setting is a question of that setting.
    #[test]
    fn what_a_setting_brings_is_no_variable_of_the_machine() {
        let program = "O1\n#1=#2401\n#2=#[2600+#4120]\nM30\n";
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: program.into() }];
        let target = Control::from_profile("dialect = \"haas\"\n").unwrap();
        let open = |settings: &str| {
            let text = format!("dialect = \"fanuc\"\n{settings}");
            let source = Control::from_profile(&text).unwrap();
            let found = survey(&inputs, &source, Some(&target));
            assert_eq!(found.variables, [], "{settings}");
            filled(&found, Side::Source, Some(&text)).unwrap()
        };
        assert!(open("[settings]\noffset_memory = \"C\"\n").contains("#? 6000.3 = "));
        assert!(!open("[parameters]\n6000.3 = 0\n[settings]\noffset_memory = \"C\"\n").contains("#? 6000.3"));
        open("");
    }

    #[test]
    fn what_the_profile_names_stays_and_the_rest_is_asked_in_its_list() {
        let list = "\"#1-#33\", \"#500-#999\", \"#400-#499 common\"";
        let text = source(&format!("dialect = \"fanuc\"\nvariables = [{list}]\n"));
        assert!(text.contains("#? \"#98000 retained\", \"#901011-#901053 retained\", # variables"), "{text}");
        assert_eq!(Profile::read(&text).unwrap().variables.unwrap().len(), 3);
        assert_eq!(source(&text), text);
    }
}
