//! The comment at a program's head that says which registers the conversion took.
//!
//! `(V1=#520 V2=#521 SCRATCH #100-#102)`: who reads the program at the machine sees what a variable was called, and
//! whoever uses those registers for something else sees that they are taken.

use super::Emitter;
use crate::ir::Class;
use crate::ir::analysis::VarSet;
use std::collections::{BTreeMap, BTreeSet};

/// Characters of a comment line, its brackets aside.
const WIDTH: usize = 60;

impl Emitter<'_> {
    /// Writes the comment, on as many lines as it takes; none if the program takes no register.
    pub(super) fn taken_registers(&mut self) {
        if let Some(mark) = self.names.mark(self.program) {
            self.out.comment_lines(mark);
        }
        let (mut named, mut scratch) = (BTreeMap::new(), BTreeSet::new());
        let mut vars = VarSet::default();
        self.program.variables(&mut |var| {
            vars.insert(var);
        });
        vars.iter().for_each(|var| {
            let Some(number) = self.register(var) else { return };
            let label = self.names.variable(var).and_then(|register| register.label.as_deref());
            match (label, var.class) {
                (_, Class::Temp | Class::Static | Class::Register) => drop(scratch.insert(number)),
                (Some(label), _) => drop(named.insert(number, label)),
                _ => {}
            }
        });
        let mut words: Vec<String> =
            named.into_iter().map(|(number, label)| format!("{}=#{number}", label.to_uppercase())).collect();
        let scratch: Vec<u32> = scratch.into_iter().collect();
        let mut before = "SCRATCH ";
        for run in scratch.chunk_by(|a, b| a + 1 == *b) {
            match run {
                [one] => words.push(format!("{before}#{one}")),
                [first, .., last] => words.push(format!("{before}#{first}-#{last}")),
                [] => {}
            }
            before = "";
        }
        let mut line = String::new();
        for word in words {
            if !line.is_empty() && line.len() + 1 + word.len() > WIDTH {
                self.out.comment_lines(&std::mem::take(&mut line));
            }
            line.push_str(if line.is_empty() { "" } else { " " });
            line.push_str(&word);
        }
        if !line.is_empty() {
            self.out.comment_lines(&line);
        }
    }
}
