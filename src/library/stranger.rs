//! A lock that another library wrote: what stands in the folder, or a file that was copied there.
//!
//! Law: a run of several programs that need the registers of such a lock is refused as a whole. Side condition: less than
//! half of the files that the lock names are of this run, and none of them is known to be the same source. Only the shop
//! knows whether both libraries run on one machine: a new choice may be wrong if they do, and refusing program by program
//! tells one thing many times. Counter-example: one new program, which is told of at its own place (MG0610).

use super::{Conversion, Input, Lock};
use crate::diag::Code;

/// Files that a message names.
const MOST_NAMED: usize = 3;

/// What to tell if this library cannot be converted beside the one that wrote `lock`; none if it can, or if the lock is its
/// own. `is_ours` says of an input that the folder has its conversion.
pub fn another_library(
    lock: &Lock,
    inputs: &[Input],
    is_ours: impl Fn(&Input) -> bool,
    conversion: &Conversion,
) -> Option<String> {
    let is_here = |file: &&String| inputs.iter().any(|input| input.name == **file);
    let (here, others): (Vec<&String>, Vec<&String>) = lock.files.iter().partition(is_here);
    if others.len() <= here.len() || inputs.iter().any(is_ours) {
        return None;
    }
    let in_the_way = |code| matches!(code, Code::LockConflict | Code::OutOfRegisters);
    let mut found = Vec::new();
    for program in &conversion.programs {
        found.extend(program.diagnostics.iter().find(|diagnostic| in_the_way(diagnostic.code)));
    }
    let first = found.iter().find(|diagnostic| diagnostic.code == Code::LockConflict).or(found.first())?;
    if found.len() < 2 {
        return None;
    }
    let mut names: Vec<&str> = others.iter().take(MOST_NAMED).map(|name| name.as_str()).collect();
    let more = others.len().saturating_sub(MOST_NAMED);
    let rest = format!("{more} more");
    if more > 0 {
        names.push(&rest);
    }
    Some(format!(
        "is the lock of another library ({}), and {} programs of this one need registers that it keeps; nothing was \
         written. If both run on one machine, convert them in one run; if they do not, use another --out, or delete the \
         lock to choose anew. The first of them: {}",
        names.join(", "),
        found.len(),
        first.message
    ))
}
