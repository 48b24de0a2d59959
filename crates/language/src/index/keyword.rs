//! Keywords: allowed positions, notation, meaning.

/// A position in which a keyword is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Position {
    /// At the beginning of a file.
    File,
    /// Outside of all braces.
    Item,
    /// In the braces of a state.
    State,
    /// In the braces of a test or a property.
    Test,
    /// In any braces.
    Statement,
    /// Within a statement.
    Inside,
    /// At a value.
    Value,
    /// At a value in a test.
    Run,
    /// At the name of a state.
    Target,
    /// After `mark`.
    Mark,
    /// After `needs`.
    Need,
    /// After `by`.
    TipModel,
    /// After the title of a property.
    Property,
    /// After the `=` of a type.
    Type,
}

/// A keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Keyword {
    pub(super) text: &'static str,
    pub(super) positions: &'static [Position],
    /// The text to insert, with placeholders `${1:…}`.
    pub(super) snippet: &'static str,
    pub(super) meaning: &'static str,
}

impl Keyword {
    /// True if a statement, a transition or an item begins with the keyword.
    pub(super) fn begins_statement(&self) -> bool {
        use Position::{File, Item, State, Statement, Test};
        self.positions.iter().any(|position| [File, Item, State, Statement, Test].contains(position))
    }

    /// The notation: the snippet without its placeholders' marks.
    pub(super) fn usage(&self) -> String {
        let mut usage = String::new();
        for (index, part) in self.snippet.split("${").enumerate() {
            match part.split_once('}').filter(|_| index > 0) {
                Some((field, rest)) => {
                    usage += field.split_once(':').map_or("\u{2026}", |(_, name)| name);
                    usage += rest;
                }
                None => usage += part,
            }
        }
        usage
    }
}

const fn entry(
    text: &'static str,
    positions: &'static [Position],
    snippet: &'static str,
    meaning: &'static str,
) -> Keyword {
    Keyword { text, positions, snippet, meaning }
}

const FILE: &[Position] = &[Position::File];
const ITEM: &[Position] = &[Position::Item];
const STATE: &[Position] = &[Position::State];
const ITEM_OR_STATE: &[Position] = &[Position::Item, Position::State];
const COMMAND: &[Position] = &[Position::State, Position::Statement];
const STATEMENT: &[Position] = &[Position::Item, Position::State, Position::Statement];
const INSIDE: &[Position] = &[Position::Inside];
const VALUE: &[Position] = &[Position::Value];
const TRUTH: &[Position] = &[Position::Value, Position::Run];
const TARGET: &[Position] = &[Position::Target];
const MARK: &[Position] = &[Position::Mark];
const NEED: &[Position] = &[Position::Need];
const TIP_MODEL: &[Position] = &[Position::TipModel];
const PROPERTY: &[Position] = &[Position::Property];

/// Every keyword that is not a function.
pub(super) const KEYWORDS: [Keyword; 81] = [
    entry("machine", FILE, "machine ${1:name}", "Begins a policy and names it."),
    entry(
        "library",
        FILE,
        "library ${1:name}",
        "Begins a library, a file of laws, derived values, types, behaviours and monitors for other files, and names it. It contains nothing else but `use`.",
    ),
    entry(
        "tests",
        FILE,
        "tests of \"${1:machine.fsm}\"",
        "Begins a test file, and names the file of the tested machine. The file contains only tests and properties, which `vibrissa test` runs instead of those in the machine's own file.",
    ),
    entry(
        "use",
        ITEM,
        "use ${1:std.swipe}",
        "Imports laws, derived values, types, behaviours and monitors of another file: all, or only those in parentheses. `use std.swipe` names a module of the standard library, and `use \"corner.fsm\"` a file, relative to the file that contains the `use`. What the other file imports itself is not imported again.",
    ),
    entry(
        "whisker",
        ITEM,
        "whisker ${1:name}",
        "Binds whiskers of the rig by name, at most eight. `by` selects their contact estimator, and `if fitted` makes them optional.",
    ),
    entry(
        "by",
        INSIDE,
        "by ${1:sliding}",
        "The contact estimator of the whiskers: `sliding`, `one_channel`, `polynomial`, `moment_and_shear`, `recursive` or, in a simulator, `truth`. The default is `sliding`.",
    ),
    entry(
        "fitted",
        INSIDE,
        "fitted",
        "After `whisker a if`: these whiskers are optional. A missing whisker never touches, and its `a.fitted` is false.",
    ),
    entry(
        "list",
        &[Position::Type],
        "list of ${1:8} ${2:position}",
        "A list with at most so many elements of a type, from 1 to 16. A list is a value: `seen.with(w.tip)` is a list with a new element. A full list loses its oldest element.",
    ),
    entry(
        "contour",
        ITEM,
        "contour ${1:middle} of ${2:7} points ${3:5 mm} apart",
        "A contour of positions, fed by `record position in name`, at most eight in a policy. Without a name, the keypoints of the contours of all whiskers. The default is 7 points 1 mm apart.",
    ),
    entry(
        "points",
        INSIDE,
        "points",
        "The number of the newest points to which the curve of a contour is fitted, from 3 to 16. More points have less noise, but the tangent follows a bend later.",
    ),
    entry("apart", INSIDE, "apart", "The minimum distance between two points of a contour, from 0.1 mm to 20 mm."),
    entry(
        "needs",
        ITEM,
        "needs ${1:control_rate} in ${2:20} .. ${3:30 Hz}",
        "A rate of the loop, or the age of its samples, and the range that the policy was made for. A lower end without a unit has the unit of the upper end. A simulation warns outside of the range, and a robot that cannot hold it refuses the policy.",
    ),
    entry(
        "param",
        ITEM,
        "param ${1:name} = ${2:50 mm/s} in ${3:1} .. ${4:200 mm/s}",
        "A number that a run may set within the range, or `true`, `false` or a value of an enumeration. The range is optional, and a lower end without a unit has the unit of the upper end.",
    ),
    entry(
        "type",
        ITEM,
        "type ${1:Side} = ${2:left} or ${3:right}",
        "A type: an enumeration such as `Side = left or right`, a record such as `Edge(place: position, way: direction)`, or a list such as `Places = list of 8 position`.",
    ),
    entry(
        "initial",
        ITEM_OR_STATE,
        "initial ${1:State}",
        "The initial state of a run, which has no arguments and is not inside another state. In a state, the inner state that is entered first.",
    ),
    entry(
        "law",
        ITEM,
        "law ${1:name}(${2:w: whisker}) {\n  ${0}\n}",
        "Named statements, executed with `do`. They are inlined wherever they are used, so a law cannot use itself.",
    ),
    entry(
        "state",
        ITEM_OR_STATE,
        "state ${1:Name} {\n  ${0}\n}",
        "A state with its statements, transitions and inner states.",
    ),
    entry(
        "behaviour",
        ITEM,
        "behaviour ${1:name}(${2:w: whisker}) {\n  exit ${3:lost}\n  ${0}\n}",
        "A state machine with arguments and exits, the content of a state: `state Name is name(r0)`. It knows its arguments, its memory and the items of its file. Each use has separate memory.",
    ),
    entry(
        "monitor",
        ITEM,
        "monitor ${1:name} {\n  var ${2:seen} = ${3:0}\n  ${0}\n}",
        "Memory with statements that run first in every tick. States read `name.seen`. With arguments, `monitor other is name(r0)` uses it. It cannot give a command, record or mark.",
    ),
    entry(
        "is",
        INSIDE,
        "is ${1:behaviour}",
        "The behaviour that is the content of the state, or the content of the monitor, with the values of its arguments.",
    ),
    entry(
        "always",
        ITEM_OR_STATE,
        "always when ${1:condition} -> ${2:Target}",
        "Outside of braces, a global transition. It belongs to every state and precedes the transitions of the state itself. With `within`, a contract: `always condition within time` is violated if the condition is false for that time.",
    ),
    entry(
        "assume",
        ITEM_OR_STATE,
        "assume ${1:condition}",
        "A contract: the condition holds when the state is entered. It has no effect on the machine. Runs and the robot report a violation.",
    ),
    entry(
        "never",
        ITEM_OR_STATE,
        "never ${1:condition}",
        "A contract: the condition holds in no tick of the state. With `for`, it never holds for that time without interruption.",
    ),
    entry("within", INSIDE, "within ${1:1 s}", "The time after which the condition of a contract has to hold again."),
    entry(
        "failsafe",
        ITEM_OR_STATE,
        "failsafe -> ${1:Target}",
        "The fallback transition of a state. It is taken if the command is not finite, or if a tick exceeds the microstep limit. Without one, that of the nearest outer state is taken, or else that of the machine.",
    ),
    entry(
        "test",
        ITEM,
        "test \"${1:title}\" in \"${2:scenario.yaml}\" {\n  expect ${0}\n}",
        "A run of the policy in a scenario, with expectations. The path of the scenario is relative to the file of the test.",
    ),
    entry(
        "property",
        ITEM,
        "property \"${1:title}\" over ${2:convex-corner}(${3:angle in 30 deg .. 150 deg}) {\n  expect ${0}\n}",
        "Expectations that hold for every run in the scenes of a family.",
    ),
    entry(
        "over",
        PROPERTY,
        "over ${1:convex-corner}",
        "The family of the scenes, with the ranges of its parameters in parentheses.",
    ),
    entry(
        "let",
        STATEMENT,
        "let ${1:name} = ${2:value}",
        "Names a value. Outside of braces it may have arguments with defaults, and is computed at every use.",
    ),
    entry(
        "when",
        STATE,
        "when ${1:condition} -> ${2:Target}",
        "A transition that is due when the condition holds. With `for`, the condition must have held at every tick for that time.",
    ),
    entry(
        "after",
        STATE,
        "after ${1:5 s} -> ${2:Target}",
        "A transition that is due when the state has been active for that time, at the first tick at or after its end.",
    ),
    entry(
        "var",
        ITEM_OR_STATE,
        "var ${1:name} = ${2:value}",
        "Memory, kept from tick to tick. It is set when the state is entered, or outside of states when a run starts, and by `set`.",
    ),
    entry(
        "entry",
        STATE,
        "entry {\n  ${0}\n}",
        "Statements that are executed when the state is entered, after its memory is set. They give no command.",
    ),
    entry(
        "exit",
        STATE,
        "exit {\n  ${0}\n}",
        "Statements that are executed when the state is left for another state, before the values of the target are computed. They give no command, and are not executed at a failure, which ends the run at once. In a behaviour, `exit name(value: type)` declares an exit, and `-> exit name(value)` leads to it.",
    ),
    entry(
        "on",
        STATE,
        "on ${1:exit} -> ${2:Target}",
        "The target of an exit of the behaviour that the state uses. Names in parentheses are those of the exit's values. In a monitor, an event: the statements in braces are executed when a statement tells it.",
    ),
    entry(
        "tell",
        STATEMENT,
        "tell ${1:monitor}.${2:event}",
        "Executes the statements of an event of a monitor at once. Values in parentheses are those of its arguments.",
    ),
    entry(
        "plot",
        STATEMENT,
        "plot ${1:name} = ${2:value}",
        "Shows a value over time under a name: in the ticks, the picture and the tests of a run. The value is a number with any unit, a bool or a value of an enumeration. Several statements may set a plot, and the last one of a tick counts.",
    ),
    entry(
        "log",
        STATEMENT,
        "log \"${1:message}\", ${2:value}",
        "Logs a message with the values behind it, in every tick in which it is executed. A message shows up to eight numbers, and a vector is two.",
    ),
    entry(
        "set",
        &[Position::Item, Position::State, Position::Test, Position::Statement],
        "set ${1:name} = ${2:value}",
        "Changes memory. In a test or a property, sets a parameter for the run.",
    ),
    entry(
        "expect",
        &[Position::Test],
        "expect ${1:run.completed}",
        "A condition that must hold at the end of the run.",
    ),
    entry(
        "if",
        STATEMENT,
        "if ${1:condition} {\n  ${0}\n}",
        "Executes the first block whose condition holds. As a value, `if condition then a else b` chooses one of two.",
    ),
    entry(
        "if",
        VALUE,
        "if ${1:condition} then ${2:a} else ${3:b}",
        "One of two values of the same type. Both are always computed, so that filters in them miss no tick. Within another expression it stands in parentheses.",
    ),
    entry("then", INSIDE, "then ${1:a} else ${2:b}", "The values between which a condition chooses."),
    entry("do", STATEMENT, "do ${1:law}(${2:w})", "Executes the statements of a law."),
    entry(
        "record",
        STATEMENT,
        "record ${1:w}",
        "Records the tip of a whisker in contact as a point of the estimated contour. No point is added while another part than the tip may touch. With `in`, records a position in a contour of positions, at most one per tick.",
    ),
    entry(
        "mark",
        STATEMENT,
        "mark ${1:lost} ${2:w}",
        "Marks for the score that a whisker has lost the contour at an edge, or has found contact again. Marks change nothing that a policy can read.",
    ),
    entry(
        "steer",
        COMMAND,
        "steer ${1:body} along ${2:direction} at ${3:speed} facing ${4:angle}",
        "Moves the body, or the base of a whisker, in a direction of the world frame at a speed, and rotates the body. With a whisker the body has the speed, and its direction compensates for the motion of the base that the rotation causes. Speed and yaw rate are limited to those of the rig.",
    ),
    entry(
        "hold",
        COMMAND,
        "hold",
        "Keeps the last command. After a `stop` it continues the stop, and after a `steer` it repeats the command with its velocities.",
    ),
    entry(
        "stop",
        COMMAND,
        "stop",
        "Stops the platform and holds its pose. The platform is commanded to stand still for ten time constants of its servos, and then a controller compensates for every displacement.",
    ),
    entry(
        "else",
        INSIDE,
        "else {\n  ${0}\n}",
        "The block that is executed, or the value, if no preceding condition holds.",
    ),
    entry("for", INSIDE, "for ${1:100 ms}", "The time for which the condition must have held at every tick."),
    entry(
        "in",
        INSIDE,
        "in ${1:low} .. ${2:high}",
        "The range of a parameter or a need. In a test, the file of the scenario. After `record`, a contour of positions.",
    ),
    entry(
        "of",
        INSIDE,
        "of ${1:length}",
        "The dimension of a vector's components. In a contour, the number of its points.",
    ),
    entry(
        "along",
        INSIDE,
        "along ${1:direction}",
        "The direction of the motion, a vector of any length. With a vector of length zero the platform does not translate.",
    ),
    entry("at", INSIDE, "at ${1:speed}", "The speed of the motion."),
    entry(
        "facing",
        INSIDE,
        "facing ${1:angle}",
        "The heading to which the body rotates, in the shorter direction, by a controller with memory. The yaw rate is at most that of the rig's yaw controller, 45 deg/s by default.",
    ),
    entry(
        "turning",
        INSIDE,
        "turning ${1:0 deg/s}",
        "The yaw rate of the body, counter-clockwise positive. It resets the controller of `facing`, so `turning 0 deg/s` moves straight ahead.",
    ),
    entry("and", INSIDE, "and", "True if both sides are true. Both sides are always computed."),
    entry("or", INSIDE, "or", "True if at least one side is true. Both sides are always computed."),
    entry("->", INSIDE, "-> ${1:Target}", "The target of a transition."),
    entry("not", TRUTH, "not", "The negation of the comparison after it: `not a < b` negates `a < b`."),
    entry("true", TRUTH, "true", "True."),
    entry("false", TRUTH, "false", "False."),
    entry("body", VALUE, "body", "The platform."),
    entry("time", VALUE, "time", "The time since the start of the run."),
    entry("state_time", VALUE, "state_time", "The time since the entry of the state that contains it."),
    entry("run", &[Position::Run], "run", "The whole run, in the expectations of a test."),
    entry(
        "resume",
        TARGET,
        "resume ${1:State}",
        "Enters a state by history: the inner state that was active last becomes active again, with its earlier arguments. Memory, entry, filters and times start anew.",
    ),
    entry(
        "sliding",
        TIP_MODEL,
        "sliding",
        "Estimates tip position and surface direction together, by a Kalman filter for a tip that slides along a surface. An error at the first touch decreases by a factor e for every centimetre of sliding. While another part than the tip may touch, it gives no point to record.",
    ),
    entry(
        "moment_and_shear",
        TIP_MODEL,
        "moment_and_shear",
        "Estimates the contact from base angle and shear, on the tip or on the shaft, without history. The rig must measure forces. While the base angle changes faster than 0.6 mrad/s, it estimates no contact.",
    ),
    entry(
        "recursive",
        TIP_MODEL,
        "recursive",
        "Estimates the tip recursively, with a fitted polynomial of order five for the base angle. Its accuracy is about that of `one_channel`.",
    ),
    entry(
        "one_channel",
        TIP_MODEL,
        "one_channel",
        "Estimates the tip from the base angle alone, and assumes a surface parallel to the heading. The error is 0.2 mm for every degree between surface and heading.",
    ),
    entry(
        "polynomial",
        TIP_MODEL,
        "polynomial",
        "Estimates the tip by a polynomial in the base angle, up to 500 urad, for a surface parallel to the heading.",
    ),
    entry(
        "truth",
        TIP_MODEL,
        "truth",
        "An ideal sensor of the tip position, which separates errors of the policy from errors of perception. Only a simulator has it, and a robot refuses the policy.",
    ),
    entry("control_rate", NEED, "control_rate in ${1:20} .. ${2:30 Hz}", "The rate of ticks."),
    entry("sample_rate", NEED, "sample_rate in ${1:200} .. ${2:300 Hz}", "The rate of samples of every whisker."),
    entry(
        "sample_age",
        NEED,
        "sample_age in 0 .. ${1:40 ms}",
        "The age of a sample: the time since its base angle was measured.",
    ),
    entry("lost", MARK, "lost", "The whisker has lost the contour at an edge."),
    entry("found", MARK, "found", "The whisker has found contact again."),
    entry(
        "Success",
        TARGET,
        "Success(\"${1:reason}\")",
        "Ends the run as completed, whatever the `stop` of the scenario is. The platform stops, and the expectations of the scenario are checked.",
    ),
    entry(
        "Failure",
        TARGET,
        "Failure(\"${1:reason}\")",
        "Ends the run as failed, without the exits of the active states. The platform stops.",
    ),
];

/// The keyword with this text.
pub(super) fn keyword(text: &str) -> Option<&'static Keyword> {
    KEYWORDS.iter().find(|word| word.text == text)
}

/// The keywords that are allowed in a position.
pub(super) fn keywords_at(position: Position) -> impl Iterator<Item = &'static Keyword> {
    KEYWORDS.iter().filter(move |word| word.positions.contains(&position))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grammar::is_keyword;

    #[test]
    fn every_word_of_the_grammar_is_explained() {
        let grammar = include_str!("../../grammar/fsm.pest");
        let rules = grammar.lines().filter(|line| line.starts_with("kw_"));
        let keywords: Vec<&str> = rules.filter_map(|line| line.split('"').nth(1)).collect();
        assert!(keywords.len() >= 30);
        for keyword in keywords {
            assert!(super::keyword(keyword).is_some_and(|word| !word.meaning.is_empty()), "{keyword}");
            assert!(is_keyword(keyword), "{keyword}");
        }
    }

    #[test]
    fn the_usage_of_a_word_is_its_snippet_in_plain_text() {
        let usage = |text| keyword(text).map(Keyword::usage);
        assert_eq!(usage("do").as_deref(), Some("do law(w)"));
        assert_eq!(usage("hold").as_deref(), Some("hold"));
        assert_eq!(usage("if").as_deref(), Some("if condition {\n  \u{2026}\n}"));
    }
}
