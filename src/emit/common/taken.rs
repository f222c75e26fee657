//! Which registers a program takes, and what people called the values in them: the comment at its head.

use crate::emit::{Index, Naming};
use crate::ir::{Class, Program};
use std::collections::{BTreeMap, BTreeSet};

/// A register: its name before the number, and its number.
type Place = (Box<str>, u32);

/// The registers of a program.
#[derive(Debug, Default)]
pub(in crate::emit) struct Taken {
    /// What they hold, as the source calls it. One that several values share has the name of each.
    pub named: BTreeMap<Place, String>,
    /// Those that hold values in between alone.
    pub scratch: BTreeSet<Place>,
}

impl Taken {
    /// Of a program whose variables have their registers.
    pub fn of(program: &Program, names: &Naming) -> Self {
        let mut held: BTreeMap<_, Vec<&str>> = BTreeMap::new();
        for (var, name) in &program.held {
            let names = held.entry(*var).or_default();
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let mut taken = Self::default();
        program.variables(&mut |var| {
            let Some(register) = names.variable(var) else { return };
            let Index::Number(number) = register.index else { return };
            let place = (register.name.clone(), number);
            let name = match (var.class, held.get(&var)) {
                (_, Some(names)) => Some(names.join(" ")),
                (Class::Temp | Class::Static | Class::Register, None) => None,
                (_, None) => register.label.clone(),
            };
            match name {
                Some(name) => drop(taken.named.insert(place, name.to_uppercase())),
                None => drop(taken.scratch.insert(place)),
            }
        });
        // One that keeps its name needs no word.
        taken.named.retain(|(name, number), label| *label != format!("{name}{number}"));
        taken
    }
}
