//! The variables that a machine has: fewer than its control's table, or more.

use super::overlay::Overlay;
use super::profile::VariableRun;
use super::{Dialect, Mark, VariableClass};

/// The largest number that a variable may have (`ir::LAST_NUMBER`; flags have the numbers after it).
const LAST: u32 = 99_999_999;

/// So many variables a profile may name: registers are looked for among all of them.
const MOST: u64 = 100_000;

/// What variables may be that the table has not.
const KINDS: [&str; 2] = ["common", "retained"];

impl Overlay {
    /// Puts the variables that there are in the place of the table's.
    pub(super) fn keep_variables(&mut self, dialect: &mut Dialect) {
        let Some(present) = self.profile.variables.clone() else { return };
        let mut found: Vec<VariableClass> = Vec::new();
        let (mut count, mut missing) = (0, Vec::new());
        for text in &present {
            let Some(run) = self.runs("variables", std::slice::from_ref(text)).pop() else { continue };
            if run.is_missing() {
                missing.push((run, text));
                continue;
            }
            let classes = match &run.kind {
                None => narrowed(&dialect.variables, &run),
                Some(kind) => self.widened(dialect, &run, kind, text),
            };
            if run.kind.is_none() && (classes.is_empty() || !run.ends_within(&dialect.variables)) {
                let what = match classes.is_empty() {
                    true => format!("{} has no variables {text}", dialect.title),
                    false => format!("{} does not have all of the variables {text}", dialect.title),
                };
                self.fault(
                    &format!("variables:{text}"),
                    what,
                    format!("say what they are: '{text} common', kept until power-off, or '{text} retained'"),
                );
            }
            let twice = |class: &VariableClass| {
                found.iter().any(|other| {
                    other.name == class.name
                        && other.class != "letter"
                        && other.first <= class.last
                        && class.first <= other.last
                })
            };
            if classes.iter().any(twice) {
                let what = format!("'{text}' names variables that stand before it");
                self.fault(&format!("variables:{text}"), what, "name each variable once".into());
            }
            let size = |class: &VariableClass| u64::from(class.last.saturating_sub(class.first)) + 1;
            count += classes.iter().map(size).sum::<u64>();
            if count > MOST {
                let what = format!("with '{text}' there are {count} variables, more than {MOST}");
                self.fault(&format!("variables:{text}"), what, "name those that programs use".into());
                break;
            }
            found.extend(classes);
        }
        for (run, text) in missing {
            if found.iter().any(|class| run.meets(class)) {
                let what = format!("'{text}' names variables that are there by other entries");
                self.fault(&format!("variables:{text}"), what, "name each variable once".into());
            }
        }
        dialect.variables = found;
    }

    /// Variables that the table has not.
    fn widened(
        &mut self,
        dialect: &Dialect,
        run: &VariableRun,
        kind: &str,
        text: &str,
    ) -> Vec<VariableClass> {
        let place = format!("variables:{text}");
        let like = |class: &&VariableClass| class.name == run.name && class.class == kind;
        let Some(like) = dialect.variables.iter().find(like).filter(|_| KINDS.contains(&kind) && !run.letter)
        else {
            let what = format!("'{kind}' is no kind of variable {}{} may be", run.name, run.first);
            self.fault(
                &place,
                what,
                "write 'common' or 'retained' after them, for a control that has such".into(),
            );
            return Vec::new();
        };
        if run.last > LAST {
            let what =
                format!("{}{} is past {}{LAST}, the last that is converted", run.name, run.last, run.name);
            self.fault(&place, what, "leave it out: programs with such variables are refused".into());
            return Vec::new();
        }
        let state = dialect.system.iter().find(|row| {
            let (first, last) = (row.first.unwrap_or(u32::MAX), row.last().unwrap_or(0));
            row.name == run.name && first <= run.last && run.first <= last
        });
        if let Some(state) = state {
            let number = state.first.unwrap_or_default().max(run.first);
            let what = format!("{}{number} is '{}'", run.name, state.state);
            self.fault(&place, what, "leave the system variables out".into());
            return Vec::new();
        }
        let mut class = VariableClass { first: run.first, last: run.last, ..like.clone() };
        class.retained = Some(kind == "retained");
        class.origin.mark = Mark::Confirmed;
        vec![class]
    }
}

impl VariableRun {
    /// True where the run has a variable of the class.
    pub(super) fn meets(&self, class: &VariableClass) -> bool {
        class.name == self.name
            && (class.class == "letter") == self.letter
            && class.first <= self.last
            && self.first <= class.last
    }

    /// True where the first and the last variable of the run are there.
    fn ends_within(&self, classes: &[VariableClass]) -> bool {
        let end = |number: u32| Self { first: number, last: number, ..self.clone() };
        [self.first, self.last].into_iter().all(|at| classes.iter().any(|class| end(at).meets(class)))
    }
}

/// The variables of a run that the table has.
fn narrowed(classes: &[VariableClass], run: &VariableRun) -> Vec<VariableClass> {
    let of_run = |class: &&VariableClass| class.name == run.name && (class.class == "letter") == run.letter;
    let cut = |class: &VariableClass| {
        let (first, last) = (class.first.max(run.first), class.last.min(run.last));
        (first <= last).then(|| VariableClass { first, last, ..class.clone() })
    };
    classes.iter().filter(of_run).filter_map(cut).collect()
}
