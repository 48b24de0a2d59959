//! The layout of nested states. The inside of each state with inner states has its own layout, and is a box in the
//! layout around it.
//!
//! Arrows that leave a box pass through its upper or lower side, and continue outside in the same direction. Therefore
//! the inside can be laid out before the position of the box is known. The positions at which arrows pass the side
//! follow from the inside.

use super::layout::{Arrow, Edge, Layout, Node, Position, Route, Size, layout, ranks};
use super::symbol::Symbol;
use vibrissa_language::chart::Chart;
use vibrissa_runtime::math;

/// Margin between a box and its inside (px).
const MARGIN: f64 = 14.0;

/// An arrow between two symbols. Neither contains the other.
#[derive(Clone, Copy)]
pub(super) struct Span {
    /// Index of the symbol at its start.
    pub(super) from: usize,
    /// Index of the symbol at its end.
    pub(super) to: usize,
    /// The size of its label.
    pub(super) label: Size,
}

/// Positions of all symbols and arrows. The origin is the upper left corner.
pub(super) struct Arrangement {
    /// The centre and the size of each symbol.
    pub(super) symbols: Vec<(Position, Size)>,
    /// The path of each arrow.
    pub(super) routes: Vec<Route>,
    /// The size of the arrangement.
    pub(super) size: Size,
}

/// Arranges `symbols` and `spans`. The symbols at which paths begin come first. `beside` is the space to the right of
/// each symbol.
pub(super) fn arrange(chart: &Chart, symbols: &[Symbol], beside: &[Size], spans: &[Span]) -> Arrangement {
    let nest = Nest { chart, symbols, beside, spans };
    let inside = nest.lay_out(None, &[]);
    let empty = || Route { points: Vec::new(), label: (0.0, 0.0) };
    let mut arrangement = Arrangement {
        symbols: vec![((0.0, 0.0), (0.0, 0.0)); symbols.len()],
        routes: spans.iter().map(|_| empty()).collect(),
        size: inside.size,
    };
    for (symbol, position, size) in inside.symbols {
        arrangement.symbols[symbol] = (position, size);
    }
    for (span, route) in inside.routes {
        arrangement.routes[span] = route;
    }
    arrangement
}

struct Nest<'a> {
    chart: &'a Chart,
    symbols: &'a [Symbol],
    beside: &'a [Size],
    spans: &'a [Span],
}

/// An arrow that passes a side of a box.
#[derive(Clone, Copy)]
struct Passage {
    span: usize,
    edge: Edge,
}

/// The inside of a box, relative to its upper left corner.
struct Inside {
    size: Size,
    symbols: Vec<(usize, Position, Size)>,
    /// The paths of the arrows in it, or parts of them.
    routes: Vec<(usize, Route)>,
    /// The horizontal position of each passage.
    passages: Vec<f64>,
}

impl Nest<'_> {
    /// Lays out the inner states of a state, or the outermost states, with the arrows that enter or leave.
    fn lay_out(&self, container: Option<usize>, passages: &[Passage]) -> Inside {
        let members: Vec<usize> =
            (0..self.symbols.len()).filter(|&index| self.symbols[index].container(self.chart) == container).collect();
        let spans: Vec<(usize, usize, usize)> = (0..self.spans.len())
            .filter_map(|span| {
                let Span { from, to, .. } = self.spans[span];
                let (from, to) = (self.member(from, container, &members)?, self.member(to, container, &members)?);
                (from != to).then_some((span, from, to))
            })
            .collect();
        let title = container.map(|state| Node {
            edge: Some(Edge::Top),
            size: Symbol::State(state).title_size(self.chart),
            beside: (0.0, 0.0),
        });
        let at_edge =
            passages.iter().map(|passage| Node { edge: Some(passage.edge), size: (0.0, 0.0), beside: (0.0, 0.0) });
        let edges: Vec<Option<Edge>> =
            members.iter().map(|_| None).chain(at_edge.clone().chain(title).map(|node| node.edge)).collect();
        let ranks = ranks(&edges, &spans.iter().map(|&(_, from, to)| (from, to)).collect::<Vec<_>>());

        // An arrow leaves a box in the same direction as it continues around it.
        let mut inner_passages: Vec<Vec<Passage>> = vec![Vec::new(); members.len()];
        for &(span, from, to) in &spans {
            let leads_down = ranks[from] < ranks[to];
            let edge = |is_lower: bool| if is_lower { Edge::Top } else { Edge::Bottom };
            inner_passages[from].push(Passage { span, edge: edge(!leads_down) });
            inner_passages[to].push(Passage { span, edge: edge(leads_down) });
        }
        let attached: Vec<Option<(usize, bool)>> = passages
            .iter()
            .map(|passage| {
                let Span { from, to, .. } = self.spans[passage.span];
                let leaves = self.member(from, container, &members).map(|member| (member, true));
                leaves.or_else(|| self.member(to, container, &members).map(|member| (member, false)))
            })
            .collect();
        for (passage, attached) in passages.iter().zip(&attached) {
            inner_passages[attached.map_or(0, |(member, _)| member)].extend(attached.is_some().then_some(*passage));
        }
        let inner: Vec<Option<Inside>> =
            members.iter().zip(&inner_passages).map(|(&member, passages)| self.box_of(member, passages)).collect();

        let size = |(&member, inner): (&usize, &Option<Inside>)| {
            inner.as_ref().map_or_else(|| self.symbols[member].size(self.chart), |inner| inner.size)
        };
        let nodes =
            members.iter().zip(&inner).map(|pair| Node { edge: None, size: size(pair), beside: self.beside[*pair.0] });
        let nodes: Vec<Node> = nodes.chain(at_edge).chain(title).collect();
        let port = |member: usize, span: usize| {
            let inner = inner[member].as_ref()?;
            let position = inner_passages[member].iter().position(|passage| passage.span == span)?;
            Some(inner.passages[position] - 0.5 * inner.size.0)
        };
        let own = spans.iter().map(|&(span, from, to)| Arrow {
            from,
            to,
            label: self.spans[span].label,
            ports: [port(from, span), port(to, span)],
        });
        let passing = passages.iter().enumerate().filter_map(|(k, passage)| {
            let (member, leaves) = attached[k]?;
            let (ends, ports) = ((member, members.len() + k), [port(member, passage.span), None]);
            let (from, to) = if leaves { ends } else { (ends.1, ends.0) };
            let ports = if leaves { ports } else { [ports[1], ports[0]] };
            Some(Arrow { from, to, label: (0.0, 0.0), ports })
        });
        let passing_spans = passages.iter().zip(&attached).filter(|(_, attached)| attached.is_some());
        let spans: Vec<usize> =
            spans.iter().map(|&(span, ..)| span).chain(passing_spans.map(|(passage, _)| passage.span)).collect();
        let layout = layout(&nodes, &own.chain(passing).collect::<Vec<_>>(), &ranks);
        Self::put_together(container.is_some(), layout, &nodes, &members, passages, &spans, inner)
    }

    /// The inside of a symbol with inner states.
    fn box_of(&self, symbol: usize, passages: &[Passage]) -> Option<Inside> {
        match self.symbols[symbol] {
            Symbol::State(state) if self.chart.inside(Some(state)).next().is_some() => {
                Some(self.lay_out(Some(state), passages))
            }
            _ => None,
        }
    }

    /// The member of a container that is a symbol or contains it.
    fn member(&self, symbol: usize, container: Option<usize>, members: &[usize]) -> Option<usize> {
        let mut symbol = self.symbols[symbol];
        while symbol.container(self.chart) != container {
            symbol = Symbol::State(symbol.container(self.chart)?);
        }
        members.iter().position(|&member| self.symbols[member] == symbol)
    }

    /// Moves the insides to the positions of their boxes, and joins the parts of paths.
    fn put_together(
        is_box: bool,
        layout: Layout,
        nodes: &[Node],
        members: &[usize],
        passages: &[Passage],
        spans: &[usize],
        inner: Vec<Option<Inside>>,
    ) -> Inside {
        let margin = if is_box { MARGIN } else { 0.0 };
        let moved = |(x, y): Position| (x + margin, y + margin);
        let size = (layout.size.0 + 2.0 * margin, layout.size.1 + 2.0 * margin);
        let mut inside = Inside {
            size,
            symbols: Vec::new(),
            routes: Vec::new(),
            passages: (0..passages.len()).map(|k| moved(layout.nodes[members.len() + k].0).0).collect(),
        };
        for (&span, route) in spans.iter().zip(layout.routes) {
            let mut points: Vec<Position> = route.points.into_iter().map(moved).collect();
            // An arrow that passes a side extends to it.
            if let Some(passage) = passages.iter().find(|passage| passage.span == span) {
                let y = if passage.edge == Edge::Top { 0.0 } else { size.1 };
                let is_at = |point: Option<&Position>| point.map_or(f64::INFINITY, |point| (point.1 - y).abs());
                if is_at(points.first()) < is_at(points.last()) {
                    points.insert(0, (points[0].0, y));
                } else if let Some(&(x, _)) = points.last() {
                    points.push((x, y));
                }
            }
            inside.routes.push((span, Route { points, label: moved(route.label) }));
        }
        for ((k, &member), inner) in members.iter().enumerate().zip(inner) {
            let (centre, width) = layout.nodes[k];
            let centre = moved(centre);
            let Some(inner) = inner else {
                inside.symbols.push((member, centre, (width, nodes[k].size.1)));
                continue;
            };
            let corner = (centre.0 - 0.5 * inner.size.0, centre.1 - 0.5 * inner.size.1);
            let moved = |(x, y): Position| (x + corner.0, y + corner.1);
            inside.symbols.push((member, centre, inner.size));
            inside
                .symbols
                .extend(inner.symbols.into_iter().map(|(symbol, position, size)| (symbol, moved(position), size)));
            for (span, route) in inner.routes {
                let points: Vec<Position> = route.points.into_iter().map(moved).collect();
                match inside.routes.iter_mut().find(|(known, _)| *known == span) {
                    Some((_, known)) => join(&mut known.points, points),
                    None => inside.routes.push((span, Route { points, label: moved(route.label) })),
                }
            }
        }
        inside
    }
}

/// Appends a part of a path to the end of the rest at which it continues.
fn join(points: &mut Vec<Position>, part: Vec<Position>) {
    let distance = |a: Option<&Position>, b: Option<&Position>| match (a, b) {
        (Some(a), Some(b)) => math::hypot(a.0 - b.0, a.1 - b.1),
        _ => f64::INFINITY,
    };
    if distance(part.last(), points.first()) < distance(points.last(), part.first()) {
        points.splice(0..0, part);
    } else {
        points.extend(part);
    }
    points.dedup_by(|a, b| math::hypot(a.0 - b.0, a.1 - b.1) < 0.01);
}
