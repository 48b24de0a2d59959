//! Which layer a node stands in.

use super::Edge;

/// The layer of each node, from 0 at the top, with those at the edges in layers of their own. Arrows (from, to) are those
/// between nodes that are at no edge.
pub(in crate::report::chart) fn ranks(edges: &[Option<Edge>], arrows: &[(usize, usize)]) -> Vec<usize> {
    let mut ranks = rank(edges.len(), arrows);
    let below_top = usize::from(edges.contains(&Some(Edge::Top)));
    let inside = ranks.iter().zip(edges).filter(|(_, edge)| edge.is_none()).map(|(rank, _)| rank + below_top);
    let bottom = inside.max().map_or(below_top, |last| last + 1);
    for (rank, edge) in ranks.iter_mut().zip(edges) {
        *rank = match edge {
            None => *rank + below_top,
            Some(Edge::Top) => 0,
            Some(Edge::Bottom) => bottom,
        };
    }
    ranks
}

/// The layer of each of `count` nodes, from 0 at the top, so that the ends of every arrow (from, to) stand in different layers.
///
/// Arrows lead down where they can: an arrow that leads back to a node from which the search for ways, begun at the first node,
/// came, leads up. Nodes stand as high as what leads to them allows, unless more arrows leave a node than lead there: such a
/// node stands as low as what it leads to allows, so that its arrows are short. No arrow may have one node for both ends.
fn rank(count: usize, arrows: &[(usize, usize)]) -> Vec<usize> {
    let arrows = without_cycles(count, arrows);
    let mut ranks = vec![0_usize; count];
    // Without cycles, the longest way has fewer arrows than there are nodes.
    for _ in 0..count {
        for &(from, to) in &arrows {
            ranks[to] = ranks[to].max(ranks[from] + 1);
        }
    }
    tighten(&mut ranks, &arrows);
    ranks
}

/// The arrows, with those turned round that would close a cycle.
fn without_cycles(count: usize, arrows: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let mut search = Search { arrows, progress: vec![Progress::New; count], turned: vec![false; arrows.len()] };
    for node in 0..count {
        search.visit(node);
    }
    let directed = arrows.iter().zip(search.turned);
    directed.map(|(&(from, to), turned)| if turned { (to, from) } else { (from, to) }).collect()
}

#[derive(Clone, Copy, PartialEq)]
enum Progress {
    New,
    Open,
    Done,
}

/// A search for ways, as deep as there are nodes at most.
struct Search<'a> {
    arrows: &'a [(usize, usize)],
    progress: Vec<Progress>,
    turned: Vec<bool>,
}

impl Search<'_> {
    fn visit(&mut self, node: usize) {
        if self.progress[node] != Progress::New {
            return;
        }
        self.progress[node] = Progress::Open;
        for (index, &(from, to)) in self.arrows.iter().enumerate() {
            if from == node {
                self.turned[index] = self.progress[to] == Progress::Open;
                self.visit(to);
            }
        }
        self.progress[node] = Progress::Done;
    }
}

/// Moves nodes down that more arrows leave than reach. Every move makes the arrows shorter in sum, so that there is an end.
fn tighten(ranks: &mut [usize], arrows: &[(usize, usize)]) {
    loop {
        let mut moved = false;
        for node in 0..ranks.len() {
            let leaving = arrows.iter().filter(|(from, _)| *from == node);
            let reaching = arrows.iter().filter(|(_, to)| *to == node).count();
            let lowest = leaving.clone().map(|&(_, to)| ranks[to] - 1).min();
            if let Some(lowest) = lowest
                && leaving.count() > reaching
                && lowest > ranks[node]
            {
                ranks[node] = lowest;
                moved = true;
            }
        }
        if !moved {
            return;
        }
    }
}
