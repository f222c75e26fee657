//! Dominators, by the iteration of Cooper, Harvey and Kennedy over reverse postorder.

use super::Cfg;
use crate::ir::BlockId;

/// Which blocks every way to a block passes.
#[derive(Clone, Debug, Default)]
pub struct Dominators {
    /// Immediate dominator, by block; none for roots, joins of roots and what cannot be reached.
    parent: Vec<Option<BlockId>>,
    /// First and last number of the block's subtree; none for what cannot be reached.
    range: Vec<Option<(u32, u32)>>,
}

impl Dominators {
    /// The dominators of a graph.
    pub fn of(cfg: &Cfg) -> Self {
        // Places in reverse postorder, moved up by one: 0 is a root above all roots.
        let order = cfg.order();
        let mut parent: Vec<Option<usize>> = vec![None; order.len() + 1];
        parent[0] = Some(0);
        cfg.roots().iter().filter_map(|root| cfg.place(*root)).for_each(|at| parent[at + 1] = Some(0));
        let mut is_root = vec![false; order.len() + 1];
        cfg.roots().iter().filter_map(|root| cfg.place(*root)).for_each(|at| is_root[at + 1] = true);
        let mut changed = true;
        while changed {
            changed = false;
            for (at, id) in order.iter().enumerate().map(|(at, id)| (at + 1, id)) {
                if is_root[at] {
                    continue;
                }
                let known = cfg.preds(*id).iter().filter_map(|p| cfg.place(*p)).map(|place| place + 1);
                let meet =
                    known.filter(|place| parent[*place].is_some()).reduce(|a, b| intersect(&parent, a, b));
                if meet.is_some() && parent[at] != meet {
                    parent[at] = meet;
                    changed = true;
                }
            }
        }
        let mut out = Self { parent: vec![None; cfg.len()], range: vec![None; cfg.len()] };
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); parent.len()];
        for (at, up) in parent.iter().enumerate().skip(1) {
            let Some(up) = *up else { continue };
            children[up].push(at);
            out.parent[order[at - 1].index()] = up.checked_sub(1).map(|place| order[place]);
        }
        out.number(order, &children);
        out
    }

    /// Numbers the tree in preorder, so that ancestry is a comparison.
    fn number(&mut self, order: &[BlockId], children: &[Vec<usize>]) {
        let mut next = 0u32;
        let mut stack: Vec<(usize, usize, u32)> = vec![(0, 0, 0)];
        while let Some((at, child, first)) = stack.last_mut() {
            if let Some(down) = children[*at].get(*child).copied() {
                *child += 1;
                next += 1;
                stack.push((down, 0, next));
                continue;
            }
            if let Some(id) = at.checked_sub(1).and_then(|place| order.get(place)) {
                self.range[id.index()] = Some((*first, next));
            }
            stack.pop();
        }
    }

    /// The nearest block that dominates this one and is not it.
    pub fn parent(&self, id: BlockId) -> Option<BlockId> {
        self.parent.get(id.index()).copied().flatten()
    }

    /// True where every way to `b` passes `a`; a block dominates itself. False where one of
    /// them cannot be reached.
    pub fn dominates(&self, a: BlockId, b: BlockId) -> bool {
        let range = |id: BlockId| self.range.get(id.index()).copied().flatten();
        let (Some((first, last)), Some((place, _))) = (range(a), range(b)) else { return false };
        (first..=last).contains(&place)
    }
}

fn intersect(parent: &[Option<usize>], mut a: usize, mut b: usize) -> usize {
    while a != b {
        let higher = if a > b { &mut a } else { &mut b };
        // The root is its own parent and the lowest of all: this ends.
        *higher = parent[*higher].unwrap_or(0);
    }
    a
}
