//! Programs that a fault of macroglot itself broke.
//!
//! Law: what broke the contract of the IR in one program is not written, and neither is what calls it, however far up: what a caller
//! was taken to find after the call may rest on it. All other programs are written: each is compared with its source, whatever the fault
//! was. A caller by a computed number is for review, as where any callee is refused.

use super::refused_calls::{Link, Linked};
use crate::diag::{Code, Diagnostic};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// Refuses the programs that are broken, with what is wrong, and those that call them; gives all of them.
pub(super) fn refuse(
    broken: &BTreeMap<usize, Vec<String>>,
    links: &[Link],
    found: &mut [Vec<Diagnostic>],
) -> BTreeSet<usize> {
    for (at, faults) in broken {
        if let Some(all) = found.get_mut(*at) {
            all.push(Diagnostic::new(Code::Internal, Span::default(), faults.join("; ")));
        }
    }
    let mut refused: BTreeSet<usize> = broken.keys().copied().collect();
    let mut changed = !refused.is_empty();
    while std::mem::take(&mut changed) {
        for link in links {
            let Linked::Program { at, name, .. } = &link.callee else { continue };
            if !refused.contains(at) || refused.contains(&link.caller) {
                continue;
            }
            changed |= refused.insert(link.caller);
            if let Some(all) = found.get_mut(link.caller) {
                let what = format!("calls {name}, which a fault of macroglot itself refuses");
                all.push(Diagnostic::new(Code::Internal, link.span, what));
            }
        }
    }
    refused
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_calls_a_broken_program_is_refused_and_nothing_else() {
        let call = |caller, at, name: &str| Link {
            caller,
            callee: Linked::Program { at, name: name.into(), made: false },
            span: Span::new(3, 5),
        };
        // 0 calls 1, which calls the broken 2; 3 calls 4; 2 calls 4.
        let links = [call(0, 1, "O2"), call(1, 2, "O3"), call(3, 4, "O5"), call(2, 4, "O5")];
        let broken = BTreeMap::from([(2, vec!["block 1: increments inside a value".to_owned()])]);
        let mut found = vec![Vec::new(); 5];
        assert_eq!(refuse(&broken, &links, &mut found), BTreeSet::from([0, 1, 2]));
        let told: Vec<usize> = found.iter().map(Vec::len).collect();
        assert_eq!(told, [1, 1, 1, 0, 0]);
        assert!(found.iter().flatten().all(|finding| finding.code == Code::Internal));
        assert!(found[0][0].message.contains("O2") && found[2][0].message.contains("increments"));
    }

    #[test]
    fn nothing_is_refused_where_nothing_is_broken() {
        let mut found = vec![Vec::new(); 2];
        assert!(refuse(&BTreeMap::new(), &[], &mut found).is_empty());
        assert!(found.iter().all(Vec::is_empty));
    }
}
