//! What stands for the arguments of a program on a target whose calls give none.
//!
//! The conversion named a register for each local that callers give, and another one for whether it has a value where the
//! program asks. Who knows them can give arguments to the program by itself.

use super::names::class_of;
use super::symbol_map::SymbolMap;
use crate::dialect::Control;
use crate::ir::flag_of;
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// The registers of one argument.
#[derive(Clone, Debug)]
struct Place {
    /// The register that holds it; none if the program asks no more than whether it is given.
    value: Option<String>,
    /// The one that says whether it has a value; none if nothing asks for it, or where all callers give it.
    flag: Option<String>,
    /// True where every call gives it a value.
    always: bool,
}

/// The registers of a program's arguments, by the local that each is on the source.
#[derive(Clone, Debug, Default)]
pub struct Arguments(BTreeMap<String, Place>);

impl Arguments {
    /// Those of these locals of a program that the conversion named; none if it named none.
    pub fn of(
        program: &ProgramName,
        locals: impl Iterator<Item = String>,
        names: &SymbolMap,
        (source, target): (&Control, &Control),
    ) -> Option<Self> {
        let prefix = &target.classes().iter().find(|row| row.class != "letter")?.name;
        let register = |name: &str| {
            let number = names.arguments.get(name).or_else(|| names.variables.get(name))?;
            Some(format!("{prefix}{number}"))
        };
        let place = |local: String| {
            let own = format!("{local} of {}", program.short());
            let is_local = class_of(source, &local).is_some_and(|class| class.class == "local");
            let place = Place {
                value: register(&own),
                flag: register(&flag_of(&own)),
                always: names.always.contains(&own),
            };
            (is_local && (place.value.is_some() || place.flag.is_some())).then_some((local, place))
        };
        let all: BTreeMap<String, Place> = locals.filter_map(place).collect();
        // Two that are always given the same may share a register.
        let registers = || all.values().flat_map(|place| place.value.iter().chain(&place.flag));
        let is_apart = registers().collect::<BTreeSet<_>>().len() == registers().count();
        (!all.is_empty() && is_apart).then_some(Self(all))
    }

    /// True for a local that is one of them.
    pub fn has(&self, local: &str) -> bool {
        self.0.contains_key(local)
    }

    /// True for one that a call may leave out.
    pub fn may_be_vacant(&self, local: &str) -> bool {
        self.0.get(local).is_some_and(|place| !place.always)
    }

    /// Those that every call gives a value.
    pub fn always(&self) -> impl Iterator<Item = &String> {
        self.0.iter().filter(|(_, place)| place.always).map(|(local, _)| local)
    }

    /// Gives 0 to those that every call gives a value, where these locals have none.
    pub fn complete(&self, locals: &mut BTreeMap<String, f64>) {
        for local in self.always() {
            locals.entry(local.clone()).or_insert(0.0);
        }
    }

    /// Sets the registers as a caller does: to what the locals hold, and 0 for what has no value.
    pub fn give(&self, locals: &BTreeMap<String, f64>, registers: &mut BTreeMap<String, f64>) {
        for (local, place) in &self.0 {
            let held = locals.get(local);
            registers.extend(place.value.clone().map(|name| (name, held.copied().unwrap_or(0.0))));
            registers.extend(place.flag.clone().map(|name| (name, f64::from(u8::from(held.is_some())))));
        }
    }
}
