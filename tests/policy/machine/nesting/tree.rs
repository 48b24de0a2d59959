//! Random trees of states, and their texts.

use std::fmt::Write;

use proptest::prelude::*;
use proptest::sample::Index;

/// Ticks a second.
pub(crate) const RATE: f64 = 30.0;

/// A machine: states in states, and rules that hold always.
#[derive(Debug, Clone)]
pub(crate) struct Tree {
    /// An outer state comes before those in it; the first lies in none, and the machine begins in it.
    pub(crate) states: Vec<Node>,
    pub(crate) always: Vec<Rule>,
    /// The state that is written as a behaviour, which the state around it uses. It is alone in that state.
    pub(crate) behaviour: Option<usize>,
}

#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) parent: Option<usize>,
    /// Whether it is entered with a whisker, `a` and its number.
    pub(crate) has_argument: bool,
    /// The inner state that it begins in, and with what.
    pub(crate) initial: Option<(usize, Value)>,
    pub(crate) rules: Vec<Rule>,
    /// What its memory, `m` and its number, is set to by its entry, its body and its exit, if by any.
    pub(crate) sets: [Option<(usize, Value)>; 3],
    pub(crate) commands: bool,
}

#[derive(Debug, Clone)]
pub(crate) struct Rule {
    pub(crate) guard: Guard,
    pub(crate) target: usize,
    pub(crate) resume: bool,
    /// For every state on the way that is newly entered and takes an argument, its value.
    pub(crate) values: Vec<(usize, Value)>,
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Guard {
    /// When a whisker touches.
    When(usize),
    /// When it has touched for so many ticks.
    WhenFor(usize, usize),
    /// When the state has been active for so many ticks.
    After(usize),
}

/// A whisker.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Value {
    Bound(usize),
    /// What a state was entered with.
    Argument(usize),
    /// What a state remembers.
    Memory(usize),
}

/// What a random tree may have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Features {
    pub(crate) states: usize,
    pub(crate) rules: usize,
    pub(crate) times: bool,
    pub(crate) resume: bool,
    pub(crate) always: bool,
}

impl Tree {
    /// From the outermost state to `state`.
    pub(crate) fn way(&self, state: usize) -> Vec<usize> {
        let mut way: Vec<usize> = std::iter::successors(Some(state), |&state| self.states[state].parent).collect();
        way.reverse();
        way
    }

    /// Whether a state is the behaviour or in it.
    pub(crate) fn is_in_behaviour(&self, state: usize) -> bool {
        self.behaviour.is_some_and(|behaviour| self.way(state).contains(&behaviour))
    }

    /// The states whose memory and arguments a state knows: those on the way to it, from the behaviour on if it is in that.
    fn known(&self, state: usize) -> Vec<usize> {
        let mut way = self.way(state);
        if self.is_in_behaviour(state) {
            way.retain(|&state| self.is_in_behaviour(state));
        }
        way
    }

    /// Whether a rule leaves the behaviour.
    fn is_exit(&self, from: Option<usize>, rule: &Rule) -> bool {
        from.is_some_and(|from| self.is_in_behaviour(from)) && !self.is_in_behaviour(rule.target)
    }

    /// The rules that leave the behaviour, each with its number among those of its state.
    fn exits(&self) -> impl Iterator<Item = (usize, usize, &Rule)> {
        let rules = self
            .states
            .iter()
            .enumerate()
            .flat_map(|(from, node)| node.rules.iter().enumerate().map(move |(index, rule)| (from, index, rule)));
        rules.filter(|(from, _, rule)| self.is_exit(Some(*from), rule))
    }

    /// The values of a rule that its text has, in order.
    fn written(&self, from: Option<usize>, rule: &Rule) -> Vec<Value> {
        let entered = self.entered(from, rule.target).into_iter().filter(|&state| self.states[state].has_argument);
        entered.map(|state| rule.values.iter().find(|(of, _)| *of == state).unwrap().1).collect()
    }

    /// The states on the way to a rule's target that it enters, if it is a rule of `from`.
    pub(crate) fn entered(&self, from: Option<usize>, target: usize) -> Vec<usize> {
        let (from, way) = (from.map_or_else(Vec::new, |from| self.way(from)), self.way(target));
        let outer = &way[..way.len() - 1];
        let stay = outer.iter().zip(&from).take_while(|(outer, from)| outer == from).count();
        way[stay..].to_vec()
    }

    /// The tree as a policy. What happens is recorded: by a first whisker, what it is; by two, to which state; by the last,
    /// what the state was entered with or remembers.
    pub(crate) fn text(&self) -> String {
        let mut text = String::from("machine m whisker w0, w1, w2, w3, w4, w5, w6, w7 initial S0\n");
        self.write_inside(None, &mut text);
        for rule in &self.always {
            writeln!(text, "always {}", self.rule(None, None, rule)).unwrap();
        }
        if let Some(behaviour) = self.behaviour {
            self.write_inside(self.states[behaviour].parent, &mut text);
        }
        text
    }

    /// Writes the states in a state, or the behaviour that it uses.
    fn write_inside(&self, parent: Option<usize>, text: &mut String) {
        for (index, node) in self.states.iter().enumerate().filter(|(_, node)| node.parent == parent) {
            let is_behaviour = self.behaviour == Some(index);
            let uses = self.behaviour.filter(|&behaviour| self.states[behaviour].parent == Some(index));
            let arguments = if node.has_argument { format!("(a{index}: whisker)") } else { String::new() };
            let used = match (uses, &node.initial) {
                (Some(_), Some((initial, value))) => format!("is {}", self.step(*initial, &[(*initial, *value)])),
                _ => String::new(),
            };
            writeln!(text, "{} S{index}{arguments} {used} {{", if is_behaviour { "behaviour" } else { "state" })
                .unwrap();
            match &node.initial {
                Some((initial, value)) if uses.is_none() => {
                    writeln!(text, "initial {}", self.step(*initial, &[(*initial, *value)])).unwrap();
                }
                _ => {}
            }
            for (from, number, rule) in self.exits() {
                let names: Vec<String> = (0..self.written(Some(from), rule).len()).map(|k| format!("x{k}")).collect();
                let list =
                    |list: &[String]| if list.is_empty() { String::new() } else { format!("({})", list.join(", ")) };
                if is_behaviour {
                    let typed: Vec<String> = names.iter().map(|name| format!("{name}: whisker")).collect();
                    writeln!(text, "exit e{from}_{number}{}", list(&typed)).unwrap();
                } else if uses.is_some() {
                    let target = self.target(Some(from), rule, Some(&names));
                    writeln!(text, "on e{from}_{number}{} -> {target}", list(&names)).unwrap();
                }
            }
            let begin = if node.has_argument { format!("a{index}") } else { format!("w{}", index % 8) };
            writeln!(text, "var m{index} = {begin}").unwrap();
            let tell =
                |event: usize| format!("record w{event} record w{} record w{} record m{index}", index / 8, index % 8);
            let set = |event: usize| {
                let set = node.sets[event].as_ref();
                set.map_or_else(String::new, |(of, value)| format!("set m{of} = {}", value.text()))
            };
            writeln!(text, "entry {{ {} {} }}", tell(0), set(0)).unwrap();
            writeln!(text, "{} {}", tell(1), set(1)).unwrap();
            if node.commands {
                writeln!(text, "steer body along vector(1, 0) at {index} m/s turning 0 rad/s").unwrap();
            }
            writeln!(text, "exit {{ {} {} }}", tell(2), set(2)).unwrap();
            for (number, rule) in node.rules.iter().enumerate() {
                let exit = self.is_exit(Some(index), rule).then_some((index, number));
                writeln!(text, "{}", self.rule(Some(index), exit, rule)).unwrap();
            }
            if uses.is_none() {
                self.write_inside(Some(index), text);
            }
            text.push_str("}\n");
        }
    }

    /// The text of a rule. `exit` are the state and the number of one that leaves the behaviour.
    fn rule(&self, from: Option<usize>, exit: Option<(usize, usize)>, rule: &Rule) -> String {
        let time = |ticks: usize| format!("{:?} s", ticks as f64 / RATE);
        let guard = match rule.guard {
            Guard::When(whisker) => format!("when w{whisker}.touching"),
            Guard::WhenFor(whisker, ticks) => format!("when w{whisker}.touching for {}", time(ticks)),
            Guard::After(ticks) => format!("after {}", time(ticks)),
        };
        let Some((state, number)) = exit else { return format!("{guard} -> {}", self.target(from, rule, None)) };
        let values: Vec<String> = self.written(from, rule).into_iter().map(Value::text).collect();
        let values = if values.is_empty() { String::new() } else { format!("({})", values.join(", ")) };
        format!("{guard} -> exit e{state}_{number}{values}")
    }

    /// The target of a rule. `names` stand for its values.
    fn target(&self, from: Option<usize>, rule: &Rule, names: Option<&[String]>) -> String {
        let entered = self.entered(from, rule.target);
        // Those without arguments may be left out; every other one is.
        let written =
            entered.iter().filter(|&&state| state == rule.target || self.states[state].has_argument || state % 2 == 0);
        let mut names = names.map(|names| names.iter());
        let steps: Vec<String> = written
            .map(|&state| match names.as_mut() {
                Some(names) if self.states[state].has_argument => format!("S{state}({})", names.next().unwrap()),
                _ => self.step(state, &rule.values),
            })
            .collect();
        format!("{}{}", if rule.resume { "resume " } else { "" }, steps.join("."))
    }

    fn step(&self, state: usize, values: &[(usize, Value)]) -> String {
        let value = values.iter().find(|(of, _)| *of == state && self.states[state].has_argument);
        value.map_or_else(|| format!("S{state}"), |(_, value)| format!("S{state}({})", value.text()))
    }
}

impl Value {
    fn text(self) -> String {
        match self {
            Self::Bound(whisker) => format!("w{whisker}"),
            Self::Argument(state) => format!("a{state}"),
            Self::Memory(state) => format!("m{state}"),
        }
    }
}

/// Choices from which a state or a rule is made once it is known what there is to choose from.
type Choices = Vec<Index>;

fn choices() -> impl Strategy<Value = Choices> {
    prop::collection::vec(any::<Index>(), 14)
}

/// A whisker that a state knows: a bound one, an argument or memory of it or of a state around it.
fn value(states: &[Node], way: &[usize], choice: Index) -> Value {
    let mut known: Vec<Value> = (0..4).map(|whisker| Value::Bound(2 * whisker + 1)).collect();
    for &state in way {
        known.push(Value::Memory(state));
        if states[state].has_argument {
            known.push(Value::Argument(state));
        }
    }
    known[choice.index(known.len())]
}

fn rule(tree: &Tree, from: Option<usize>, choices: &Choices, features: Features) -> Rule {
    let known = from.map_or_else(Vec::new, |from| tree.known(from));
    let mut target = choices[0].index(tree.states.len());
    if tree.is_in_behaviour(target) && !from.is_some_and(|from| tree.is_in_behaviour(from)) {
        // What is in a behaviour is entered with the state that uses it.
        target = tree.behaviour.and_then(|behaviour| tree.states[behaviour].parent).unwrap();
    }
    let whisker = choices[1].index(8);
    let ticks = 1 + choices[2].index(4);
    let guard = match choices[3].index(4) {
        0 if features.times => Guard::WhenFor(whisker, ticks),
        1 if features.times && from.is_some() => Guard::After(ticks),
        _ => Guard::When(whisker),
    };
    let value = |(level, state): (usize, usize)| (state, self::value(&tree.states, &known, choices[4 + level]));
    Rule {
        guard,
        target,
        resume: features.resume && tree.states[target].initial.is_some() && choices[12].index(2) == 0,
        values: tree.entered(from, target).into_iter().enumerate().map(value).collect(),
    }
}

/// Random trees.
pub(crate) fn trees(features: Features) -> impl Strategy<Value = Tree> {
    let states = prop::collection::vec((choices(), any::<[bool; 2]>()), 2..=features.states);
    let rules = prop::collection::vec((any::<Index>(), choices()), 1..=features.rules);
    let always = prop::collection::vec(choices(), 0..=usize::from(features.always) * 2);
    (states, rules, always, prop::option::of(any::<Index>())).prop_map(move |(nodes, rules, always, behaviour)| {
        let mut tree = Tree { states: Vec::new(), always: Vec::new(), behaviour: None };
        for (index, (choices, [has_argument, commands])) in nodes.iter().enumerate() {
            // Beside the state before, in it, or beside one around it; at most five deep.
            let around = index.checked_sub(1).map_or_else(Vec::new, |before| tree.way(before));
            let depth = choices[0].index(around.len().min(4) + 1);
            tree.states.push(Node {
                parent: around[..depth].last().copied(),
                has_argument: *has_argument && index > 0,
                initial: None,
                rules: Vec::new(),
                sets: [const { None }; 3],
                commands: *commands,
            });
        }
        let only: Vec<usize> = (0..tree.states.len())
            .filter(|&state| {
                let parent = tree.states[state].parent;
                parent.is_some() && tree.states.iter().filter(|other| other.parent == parent).count() == 1
            })
            .collect();
        tree.behaviour = behaviour.filter(|_| !only.is_empty()).map(|choice| only[choice.index(only.len())]);
        for (index, (choices, _)) in nodes.iter().enumerate() {
            let way = tree.known(index);
            let inner: Vec<usize> =
                (0..tree.states.len()).filter(|&inner| tree.states[inner].parent == Some(index)).collect();
            if !inner.is_empty() {
                let begin = inner[choices[1].index(inner.len())];
                tree.states[index].initial = Some((begin, value(&tree.states, &way, choices[2])));
            }
            for event in 0..3 {
                if choices[3 + event].index(2) == 0 {
                    let of = way[choices[6 + event].index(way.len())];
                    tree.states[index].sets[event] = Some((of, value(&tree.states, &way, choices[9 + event])));
                }
            }
        }
        for (from, choices) in rules {
            let from = from.index(tree.states.len());
            let rule = rule(&tree, Some(from), &choices, features);
            tree.states[from].rules.push(rule);
        }
        for choices in always {
            let rule = rule(&tree, None, &choices, features);
            tree.always.push(rule);
        }
        tree
    })
}
