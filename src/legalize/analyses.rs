//! Analyses of a library that passes share: worked out when the first asks, dropped when one has changed what they read.

use crate::ir::Module;
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::{Modal, ModalFacts, Summaries};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// What is known of a library as it is now.
#[derive(Default)]
pub(super) struct Analyses {
    /// By the state in which runs begin.
    facts: Mutex<Vec<(Modal, Arc<ModalFacts>)>>,
    summaries: OnceLock<Arc<Summaries>>,
    called: OnceLock<Arc<CalledPrograms>>,
    /// The library that they are of: checked builds hold every question against it.
    of: OnceLock<Module>,
}

impl Analyses {
    /// What is in force at every block, if runs begin in the state `entry`.
    pub fn modal_facts(&self, module: &Module, entry: &Modal) -> Arc<ModalFacts> {
        self.check(module);
        let mut known = self.facts.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, facts)) = known.iter().find(|(other, _)| other == entry) {
            return Arc::clone(facts);
        }
        let facts = Arc::new(ModalFacts::of(module, entry));
        known.push((entry.clone(), Arc::clone(&facts)));
        facts
    }

    /// What programs may write.
    pub fn summaries(&self, module: &Module) -> Arc<Summaries> {
        self.check(module);
        self.summaries.get_or_init(|| Arc::new(Summaries::of(module))).clone()
    }

    /// Which programs calls run.
    pub fn called(&self, module: &Module) -> Arc<CalledPrograms> {
        self.check(module);
        self.called.get_or_init(|| Arc::new(CalledPrograms::of(module))).clone()
    }

    /// Forgets everything: the library is another now.
    pub fn drop_all(&mut self) {
        *self = Self::default();
    }

    fn check(&self, module: &Module) {
        if crate::CHECKED {
            let same = self.of.get_or_init(|| module.clone()) == module;
            assert!(same, "a pass asks for an analysis of a library that it has changed");
        }
    }
}
