//! Too few registers: which program is set aside so that the others get theirs, and what is said of it.

use super::map::Registers;
use super::names::{MOST_NAMED, in_a_sentence, name_of};
use super::needs::class_of_colour;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Module, Var};
use crate::legalize::Context;
use std::collections::{BTreeMap, BTreeSet};

/// Who uses the variables of a library that has too few registers.
pub(super) struct Shortage {
    /// The programs that use each variable.
    uses: BTreeMap<Var, BTreeSet<usize>>,
    /// Programs that get no registers, each with the variables that it alone uses.
    aside: BTreeMap<usize, Vec<Var>>,
}

impl Shortage {
    pub fn of(module: &Module) -> Self {
        let mut uses: BTreeMap<Var, BTreeSet<usize>> = BTreeMap::new();
        for (index, program) in module.programs.iter().enumerate() {
            program.variables(&mut |var| _ = uses.entry(var).or_default().insert(index));
        }
        Self { uses, aside: BTreeMap::new() }
    }

    /// Sets aside the program that alone uses the most of what is `wanted`, and gives its variables; none if no program has
    /// any of its own, or only one is left.
    pub fn set_aside(&mut self, wanted: &BTreeSet<Var>, short: &[Var], context: &Context<'_>) -> Vec<Var> {
        let classes: BTreeSet<_> = short.iter().map(|var| class_of_colour(*var, context.target)).collect();
        let mut own: BTreeMap<usize, Vec<Var>> = BTreeMap::new();
        let mut users: BTreeSet<usize> = BTreeSet::new();
        for var in wanted.iter().filter(|var| classes.contains(&class_of_colour(**var, context.target))) {
            let all = self.uses.get(var).into_iter().flatten();
            let left: Vec<usize> = all.copied().filter(|user| !self.aside.contains_key(user)).collect();
            if let [one] = left[..] {
                own.entry(one).or_default().push(*var);
            }
            users.extend(left);
        }
        let most = own.into_iter().max_by_key(|(index, own)| (own.len(), std::cmp::Reverse(*index)));
        let Some((index, own)) = most.filter(|_| users.len() > 1) else { return Vec::new() };
        self.aside.insert(index, own.clone());
        own
    }

    /// Says once for each program what it gets no register for, and who has those that there are.
    pub fn report(&self, short: &[Var], registers: &Registers, module: &Module, context: &mut Context<'_>) {
        for (index, own) in &self.aside {
            let names = list(own, module, context.source);
            let what = format!(
                "the target has no register left for {names}, which only this program uses; the other programs \
                 of the library have theirs"
            );
            tell(*index, what, module, context);
        }
        let mut by_program: BTreeMap<usize, Vec<Var>> = BTreeMap::new();
        for var in short {
            let users = self.uses.get(var).into_iter().flatten();
            users.for_each(|user| by_program.entry(*user).or_default().push(*var));
        }
        for (index, lacks) in by_program {
            let names = list(&lacks, module, context.source);
            let classes: BTreeSet<_> =
                lacks.iter().map(|var| class_of_colour(*var, context.target)).collect();
            let rivals: Vec<Var> = registers.of.keys().copied().collect();
            let same = |var: &Var| classes.contains(&class_of_colour(*var, context.target));
            let rivals: Vec<Var> = rivals.into_iter().filter(same).collect();
            let taken = list(&rivals, module, context.source);
            let place = if classes.contains(&None) { "" } else { " that words take" };
            let what = format!(
                "the target has no register left for {names}; the registers{place} are taken by {taken}"
            );
            tell(index, what, module, context);
        }
    }
}

fn tell(index: usize, what: String, module: &Module, context: &mut Context<'_>) {
    let help = "use fewer variables, or convert the programs that need the most as a library of their own";
    let span = module.programs[index].site.span;
    context.add(index, Diagnostic::new(Code::OutOfRegisters, span, what).with_help(help));
}

/// The names of variables, and how many have none.
fn list(vars: &[Var], module: &Module, source: &Control) -> String {
    let mut names: Vec<String> = vars.iter().filter_map(|var| name_of(*var, module, source)).collect();
    let between = vars.len() - names.len();
    let more = names.len().saturating_sub(MOST_NAMED);
    names.truncate(MOST_NAMED);
    if more > 0 {
        names.push(format!("{more} more"));
    }
    match between {
        0 => {}
        1 => names.push("one value in between".into()),
        many => names.push(format!("{many} locals and values in between")),
    }
    in_a_sentence(&names)
}
