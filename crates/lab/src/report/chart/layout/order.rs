//! Order of the vertices in each layer.

/// Number of sweeps over all layers that reduce crossings.
const SWEEPS: usize = 24;

/// Segments between vertices of neighbouring layers: the upper vertex, the lower vertex, and the offset at each, from
/// -0.5 at the left end of the vertex to 0.5 at its right end.
type Segments = [(usize, usize, (f64, f64))];

/// Orders the vertices of each layer so that few of `segments` cross. It uses barycentres, layer by layer, alternately
/// down and up, and exchanges of neighbours. Returns the best order.
pub(super) fn order(mut layers: Vec<Vec<usize>>, segments: &Segments) -> Vec<Vec<usize>> {
    let count = layers.iter().map(Vec::len).sum();
    let mut neighbours = vec![[Vec::new(), Vec::new()]; count];
    for &(upper, lower, (at_upper, at_lower)) in segments {
        neighbours[lower][ABOVE].push((upper, at_upper));
        neighbours[upper][BELOW].push((lower, at_lower));
    }
    let mut best = (crossings(&layers, &neighbours), layers.clone());
    for sweep in 0..SWEEPS {
        let side = if sweep % 2 == 0 { ABOVE } else { BELOW };
        let mut positions = positions(&layers, count);
        let down = 0..layers.len();
        let sequence: Vec<usize> = if side == ABOVE { down.collect() } else { down.rev().collect() };
        for index in sequence {
            let layer = &mut layers[index];
            let barycentre = |vertex: &usize| {
                let near = &neighbours[*vertex][side];
                let sum: f64 = near.iter().map(|&near| position(near, &positions)).sum();
                if near.is_empty() { positions[*vertex] as f64 } else { sum / near.len() as f64 }
            };
            layer.sort_by(|a, b| barycentre(a).total_cmp(&barycentre(b)));
            renumber(layer, &mut positions);
        }
        exchange(&mut layers, &neighbours, &mut positions);
        let found = crossings(&layers, &neighbours);
        if found < best.0 {
            best = (found, layers.clone());
        }
    }
    best.1
}

/// Index of the neighbours above.
const ABOVE: usize = 0;
/// Index of the neighbours below.
const BELOW: usize = 1;

/// A vertex and the offset of a segment at it.
type End = (usize, f64);

/// The neighbours of each vertex, above and below.
type Neighbours = [[Vec<End>; 2]];

fn position((vertex, at): End, positions: &[usize]) -> f64 {
    positions[vertex] as f64 + at
}

/// Exchanges neighbouring vertices if that reduces the number of crossings.
fn exchange(layers: &mut [Vec<usize>], neighbours: &Neighbours, positions: &mut [usize]) {
    for layer in layers {
        for left in 0..layer.len().saturating_sub(1) {
            let (a, b) = (layer[left], layer[left + 1]);
            let cost = |a: usize, b: usize, positions: &[usize]| {
                [ABOVE, BELOW]
                    .map(|side| inversions(&neighbours[a][side], &neighbours[b][side], positions))
                    .iter()
                    .sum::<usize>()
            };
            if cost(b, a, positions) < cost(a, b, positions) {
                layer.swap(left, left + 1);
                positions.swap(a, b);
            }
        }
    }
}

/// Number of crossings between the segments to `of_left` and the segments to `of_right` of a vertex further right.
fn inversions(of_left: &[End], of_right: &[End], positions: &[usize]) -> usize {
    let crossed = |a: End| of_right.iter().filter(|&&b| position(b, positions) < position(a, positions)).count();
    of_left.iter().map(|&a| crossed(a)).sum()
}

fn crossings(layers: &[Vec<usize>], neighbours: &Neighbours) -> usize {
    let positions = positions(layers, neighbours.len());
    let of_pair =
        |left: usize, right: usize| inversions(&neighbours[left][BELOW], &neighbours[right][BELOW], &positions);
    let of_layer = |layer: &Vec<usize>| {
        let pairs =
            layer.iter().enumerate().flat_map(|(k, &left)| layer[k + 1..].iter().map(move |&right| (left, right)));
        pairs.map(|(left, right)| of_pair(left, right)).sum::<usize>()
    };
    layers.iter().map(of_layer).sum()
}

/// The position of each vertex in its layer.
fn positions(layers: &[Vec<usize>], count: usize) -> Vec<usize> {
    let mut positions = vec![0; count];
    for layer in layers {
        renumber(layer, &mut positions);
    }
    positions
}

fn renumber(layer: &[usize], positions: &mut [usize]) {
    for (position, &vertex) in layer.iter().enumerate() {
        positions[vertex] = position;
    }
}
