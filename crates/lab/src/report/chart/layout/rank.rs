//! Layers of the nodes.

use super::Edge;

/// The layer of each node, from 0 at the top. Nodes at the sides of the layout have layers of their own. `arrows` are
/// the arrows (from, to) between all other nodes.
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

/// The layer of each of `count` nodes, from 0 at the top. The ends of every arrow (from, to) are in different layers.
///
/// Arrows lead down if possible. An arrow leads up if a depth-first search from the first node finds that it closes a
/// cycle. Nodes are as high as their incoming arrows permit. A node with more outgoing than incoming arrows is as low
/// as its outgoing arrows permit, so that its arrows are short. No arrow may have one node for both ends.
fn rank(count: usize, arrows: &[(usize, usize)]) -> Vec<usize> {
    let arrows = without_cycles(count, arrows);
    let mut ranks = vec![0_usize; count];
    // Without cycles, the longest path has fewer arrows than there are nodes.
    for _ in 0..count {
        for &(from, to) in &arrows {
            ranks[to] = ranks[to].max(ranks[from] + 1);
        }
    }
    tighten(&mut ranks, &arrows);
    ranks
}

/// The arrows. Those that close a cycle are reversed.
fn without_cycles(count: usize, arrows: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let mut search = Search { arrows, progress: vec![Progress::New; count], reversed: vec![false; arrows.len()] };
    for node in 0..count {
        search.visit(node);
    }
    let directed = arrows.iter().zip(search.reversed);
    directed.map(|(&(from, to), reversed)| if reversed { (to, from) } else { (from, to) }).collect()
}

#[derive(Clone, Copy, PartialEq)]
enum Progress {
    New,
    Open,
    Done,
}

/// A depth-first search, whose depth is at most the number of nodes.
struct Search<'a> {
    arrows: &'a [(usize, usize)],
    progress: Vec<Progress>,
    reversed: Vec<bool>,
}

impl Search<'_> {
    fn visit(&mut self, node: usize) {
        if self.progress[node] != Progress::New {
            return;
        }
        self.progress[node] = Progress::Open;
        for (index, &(from, to)) in self.arrows.iter().enumerate() {
            if from == node {
                self.reversed[index] = self.progress[to] == Progress::Open;
                self.visit(to);
            }
        }
        self.progress[node] = Progress::Done;
    }
}

/// Moves nodes with more outgoing than incoming arrows down. Every move reduces the total length of the arrows, so the
/// loop ends.
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
