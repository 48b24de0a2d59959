//! Positions of nodes and arrows.

use super::order::order;
use super::settle::{Wish, settle};
use super::{Arrow, Edge, Layout, Node, Position, Route};

/// Least distance between neighbours in a layer (px).
const BESIDE: f64 = 22.0;
/// Least distance between two lines in a layer (px).
const LINES: f64 = 14.0;
/// Least and greatest distance between layers (px).
const BETWEEN: (f64, f64) = (16.0, 64.0);
/// Additional distance between layers for each px of horizontal motion of a line.
const SLOPE: f64 = 0.2;
/// Distances between the ends of arrows on one side of a node: the least and the preferred one (px).
const PORTS: (f64, f64) = (14.0, 36.0);
/// Number of passes of the horizontal positions.
const PASSES: usize = 60;
/// Number of rounds in which lines are straightened.
const ROUNDS: usize = 3;
/// Weight of the straightness of a line between nodes, relative to that at its ends.
const STIFFNESS: f64 = 8.0;

/// An element of a layer: a node, a label, or a line that passes through the layer.
struct Vertex {
    layer: usize,
    /// Its extent to the left and to the right of its axis (px).
    reach: (f64, f64),
    height: f64,
    x: f64,
}

impl Vertex {
    fn is_line(&self) -> bool {
        self.height == 0.0
    }

    /// The least distance between its axis and that of its right neighbour.
    fn distance(&self, right: &Self) -> f64 {
        let room = if self.is_line() && right.is_line() { LINES } else { BESIDE };
        self.reach.1 + room + right.reach.0
    }
}

/// A part of an arrow between two consecutive layers.
struct Segment {
    upper: usize,
    lower: usize,
    /// Its offsets from the axes of the upper and the lower vertex, to the right positive (px).
    ports: (f64, f64),
    /// True if the offset is given.
    fixed: (bool, bool),
}

/// An arrow as vertices from top to bottom: its upper node, the vertices between, its lower node.
struct Chain {
    vertices: Vec<usize>,
    /// Index of its first segment.
    first: usize,
    /// Index of the label among the vertices.
    label: usize,
    leads_up: bool,
}

/// The layout of `nodes` in the layers of `ranks`, with `arrows`.
pub(in crate::report::chart) fn layout(nodes: &[Node], arrows: &[Arrow], ranks: &[usize]) -> Layout {
    let mut net = Net::new(nodes, arrows, ranks);
    net.attach(nodes);
    net.place_vertices();
    net.finish(nodes)
}

struct Net {
    /// The nodes first, with their indices.
    vertices: Vec<Vertex>,
    segments: Vec<Segment>,
    chains: Vec<Chain>,
    /// The vertices of each layer, from left to right. Nodes are in the even layers.
    layers: Vec<Vec<usize>>,
}

impl Net {
    fn new(nodes: &[Node], arrows: &[Arrow], ranks: &[usize]) -> Self {
        let vertex = |(node, rank): (&Node, &usize)| {
            let half = 0.5 * node.size.0;
            let height = node.size.1.max(node.beside.1);
            Vertex { layer: 2 * rank, reach: (half, half + node.beside.0), height, x: 0.0 }
        };
        let mut net = Self {
            vertices: nodes.iter().zip(ranks).map(vertex).collect(),
            segments: Vec::new(),
            chains: Vec::new(),
            layers: Vec::new(),
        };
        for arrow in arrows {
            net.thread(arrow);
        }
        let last = net.vertices.iter().map(|vertex| vertex.layer).max().unwrap_or(0);
        let mut layers = vec![Vec::new(); last + 1];
        for (index, vertex) in net.vertices.iter().enumerate() {
            layers[vertex.layer].push(index);
        }
        let at = |vertex: usize, port: f64| if port == 0.0 { 0.0 } else { 0.5 * port / net.vertices[vertex].reach.0 };
        let end =
            |&Segment { upper, lower, ports, .. }: &Segment| (upper, lower, (at(upper, ports.0), at(lower, ports.1)));
        net.layers = order(layers, &net.segments.iter().map(end).collect::<Vec<_>>());
        // A node with a size at the top is a title, which is the leftmost.
        let is_title =
            |&vertex: &usize| nodes.get(vertex).is_some_and(|node| node.edge == Some(Edge::Top) && node.size.1 > 0.0);
        if let Some(top) = net.layers.first_mut() {
            top.sort_by_key(|vertex| !is_title(vertex));
        }
        net
    }

    /// Inserts vertices into the layers between an arrow's nodes. The label is in the layer next to the start of the
    /// arrow.
    fn thread(&mut self, arrow: &Arrow) {
        let leads_up = self.vertices[arrow.from].layer > self.vertices[arrow.to].layer;
        let (upper, lower) = if leads_up { (arrow.to, arrow.from) } else { (arrow.from, arrow.to) };
        let between = self.vertices[upper].layer + 1..self.vertices[lower].layer;
        let label = if leads_up { between.len() } else { 1 };
        let mut chain = Chain { vertices: vec![upper], first: self.segments.len(), label, leads_up };
        for layer in between {
            let (width, height) = if chain.vertices.len() == label { arrow.label } else { (0.0, 0.0) };
            chain.vertices.push(self.vertices.len());
            self.vertices.push(Vertex { layer, reach: (0.5 * width, 0.5 * width), height, x: 0.0 });
        }
        chain.vertices.push(lower);
        let segments = chain.vertices.iter().zip(&chain.vertices[1..]);
        let segment = |(&upper, &lower)| Segment { upper, lower, ports: (0.0, 0.0), fixed: (false, false) };
        self.segments.extend(segments.map(segment));
        let [at_upper, at_lower] = if leads_up { [arrow.ports[1], arrow.ports[0]] } else { arrow.ports };
        if let (Some(port), Some(first)) = (at_upper, self.segments.get_mut(chain.first)) {
            (first.ports.0, first.fixed.0) = (port, true);
        }
        if let (Some(port), Some(last)) = (at_lower, self.segments.last_mut()) {
            (last.ports.1, last.fixed.1) = (port, true);
        }
        self.chains.push(chain);
    }

    /// True if a segment reaches a node from above or from below at an offset that is not given.
    fn is_free(&self, segment: usize, node: usize, from_above: bool) -> bool {
        let Segment { upper, lower, fixed, .. } = self.segments[segment];
        if from_above { lower == node && !fixed.1 } else { upper == node && !fixed.0 }
    }

    /// Distributes the ends of the arrows along the sides of the nodes, in the order of their other ends.
    fn attach(&mut self, nodes: &[Node]) {
        let mut positions = vec![0; self.vertices.len()];
        for layer in &self.layers {
            layer.iter().enumerate().for_each(|(position, &vertex)| positions[vertex] = position);
        }
        for node in 0..nodes.len() {
            let mut above: Vec<_> = (0..self.segments.len()).filter(|&k| self.is_free(k, node, true)).collect();
            above.sort_by_key(|&k| positions[self.segments[k].upper]);
            let mut below: Vec<_> = (0..self.segments.len()).filter(|&k| self.is_free(k, node, false)).collect();
            below.sort_by_key(|&k| positions[self.segments[k].lower]);
            let vertex = &mut self.vertices[node];
            let least = 0.5 * PORTS.0 * (above.len().max(below.len()) as f64 + 1.0);
            let wider = (least - vertex.reach.0).max(0.0);
            vertex.reach = (vertex.reach.0 + wider, vertex.reach.1 + wider);
            let width = 2.0 * vertex.reach.0;
            let port = |position: usize, count: usize| {
                let step = PORTS.1.min(width / (count as f64 + 1.0));
                step * (position as f64 - 0.5 * (count as f64 - 1.0))
            };
            for (position, &segment) in above.iter().enumerate() {
                self.segments[segment].ports.1 = port(position, above.len());
            }
            for (position, &segment) in below.iter().enumerate() {
                self.segments[segment].ports.0 = port(position, below.len());
            }
        }
    }

    /// Computes the position of every vertex within its layer, with segments as straight as possible.
    fn place_vertices(&mut self) {
        // For each vertex: its neighbours, the offset between the two for a straight segment, and the weight.
        let mut pulls: Vec<Vec<(usize, f64, f64)>> = self.vertices.iter().map(|_| Vec::new()).collect();
        for &Segment { upper, lower, ports, .. } in &self.segments {
            let lines = [upper, lower].iter().filter(|&&end| self.vertices[end].is_line()).count();
            let stiffness = if lines == 2 { STIFFNESS } else { 1.0 };
            pulls[upper].push((lower, ports.1 - ports.0, stiffness));
            pulls[lower].push((upper, ports.0 - ports.1, stiffness));
        }
        for layer in 0..self.layers.len() {
            self.settle_layer(layer, &pulls);
        }
        for pass in 0..PASSES {
            for index in 0..self.layers.len() {
                let layer = if pass % 2 == 0 { self.layers.len() - 1 - index } else { index };
                self.settle_layer(layer, &pulls);
            }
        }
        // The space for one arrow can be useful for another.
        for _ in 0..ROUNDS {
            self.straighten();
        }
        let left = self.vertices.iter().map(|vertex| vertex.x - vertex.reach.0).fold(f64::INFINITY, f64::min);
        for vertex in &mut self.vertices {
            vertex.x -= left;
        }
    }

    fn settle_layer(&mut self, layer: usize, pulls: &[Vec<(usize, f64, f64)>]) {
        let mut before: Option<&Vertex> = None;
        let mut wishes = Vec::with_capacity(self.layers[layer].len());
        for &index in &self.layers[layer] {
            let vertex = &self.vertices[index];
            let distance = before.map_or(0.0, |before| before.distance(vertex));
            let weight: f64 = pulls[index].iter().map(|(_, _, stiffness)| stiffness).sum();
            let pulled =
                |&(other, offset, stiffness): &(usize, f64, f64)| stiffness * (self.vertices[other].x + offset);
            let sum: f64 = pulls[index].iter().map(pulled).sum();
            wishes.push(if weight > 0.0 {
                Wish { position: sum / weight, weight, distance }
            } else {
                Wish { position: vertex.x, weight: 1e-3, distance }
            });
            before = Some(vertex);
        }
        for (&index, x) in self.layers[layer].iter().zip(settle(&wishes)) {
            self.vertices[index].x = x;
        }
    }

    /// Makes the path of each arrow vertical between its nodes, as far as its neighbours permit.
    fn straighten(&mut self) {
        let mut beside = vec![(None, None); self.vertices.len()];
        for pair in self.layers.iter().flat_map(|layer| layer.windows(2)) {
            beside[pair[0]].1 = Some(pair[1]);
            beside[pair[1]].0 = Some(pair[0]);
        }
        for chain in &self.chains {
            let mut rest = &chain.vertices[1..chain.vertices.len() - 1];
            while !rest.is_empty() {
                let (mut low, mut high, mut count) = (f64::NEG_INFINITY, f64::INFINITY, 0);
                for &index in rest {
                    let vertex = &self.vertices[index];
                    let left = beside[index].0.map(|left| &self.vertices[left]);
                    let right = beside[index].1.map(|right| &self.vertices[right]);
                    let least = left.map_or(low, |left| low.max(left.x + left.distance(vertex)));
                    let most = right.map_or(high, |right| high.min(right.x - vertex.distance(right)));
                    // The current position of the vertex is always possible, except for rounding errors.
                    if least > most && count > 0 {
                        break;
                    }
                    (low, high, count) = (least, most.max(least), count + 1);
                }
                let (run, behind) = rest.split_at(count);
                let mean = run.iter().map(|&index| self.vertices[index].x).sum::<f64>() / count as f64;
                for &index in run {
                    self.vertices[index].x = mean.clamp(low, high);
                }
                rest = behind;
            }
        }
    }

    fn finish(&self, nodes: &[Node]) -> Layout {
        let (bands, height) = self.bands();
        let middle = |vertex: &Vertex| 0.5 * (bands[vertex.layer].0 + bands[vertex.layer].1);
        let placed = self.vertices.iter().take(nodes.len());
        Layout {
            nodes: placed.map(|vertex| ((vertex.x, middle(vertex)), 2.0 * vertex.reach.0)).collect(),
            routes: self.chains.iter().map(|chain| self.route(chain, nodes, &bands)).collect(),
            size: (self.vertices.iter().map(|vertex| vertex.x + vertex.reach.1).fold(0.0, f64::max), height),
        }
    }

    /// The upper and the lower side of each layer, and the total height.
    fn bands(&self) -> (Vec<(f64, f64)>, f64) {
        let mut sideways = vec![0.0_f64; self.layers.len()];
        for segment in &self.segments {
            let (upper, lower) = (&self.vertices[segment.upper], &self.vertices[segment.lower]);
            let distance = lower.x + segment.ports.1 - upper.x - segment.ports.0;
            sideways[upper.layer] = sideways[upper.layer].max(distance.abs());
        }
        let mut y = 0.0;
        let mut bands = Vec::with_capacity(self.layers.len());
        for (layer, sideways) in self.layers.iter().zip(sideways) {
            let height = layer.iter().map(|&vertex| self.vertices[vertex].height).fold(0.0, f64::max);
            bands.push((y, y + height));
            y += height + (SLOPE * sideways).clamp(BETWEEN.0, BETWEEN.1);
        }
        let height = bands.last().map_or(0.0, |band| band.1);
        (bands, height)
    }

    fn route(&self, chain: &Chain, nodes: &[Node], bands: &[(f64, f64)]) -> Route {
        let mut points: Vec<Position> = Vec::with_capacity(2 * chain.vertices.len());
        for (k, pair) in chain.vertices.windows(2).enumerate() {
            let (upper, lower) = (&self.vertices[pair[0]], &self.vertices[pair[1]]);
            let (from, to) = self.segments[chain.first + k].ports;
            points.push((upper.x + from, bands[upper.layer].1));
            points.push((lower.x + to, bands[lower.layer].0));
        }
        // A node may be lower than its layer.
        let edge = |index: usize, side: f64| {
            let (top, bottom) = bands[self.vertices[index].layer];
            match nodes[index].edge {
                None => 0.5 * (top + bottom + side * nodes[index].size.1),
                Some(Edge::Top) => top,
                Some(Edge::Bottom) => bottom,
            }
        };
        if let (Some(&upper), Some(&lower)) = (chain.vertices.first(), chain.vertices.last())
            && let (Some(first), Some(last)) = (points.first().copied(), points.last().copied())
        {
            points.insert(0, (first.0, edge(upper, 1.0)));
            points.push((last.0, edge(lower, -1.0)));
        }
        let label = &self.vertices[chain.vertices[chain.label]];
        let band = bands[label.layer];
        if chain.leads_up {
            points.reverse();
        }
        points.dedup();
        Route { points, label: (label.x, 0.5 * (band.0 + band.1)) }
    }
}
