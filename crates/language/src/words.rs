//! The words of the language, and how to find them.
//!
//! All other lists of words follow from this table and from the rules of the grammar: completion, recovery from syntax
//! errors, the names in their messages, and the colours of editors.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::grammar::is_keyword;
use super::index::Expected;
use super::word::{Class, Position, Role, Word};

const FILE: Class = Class::new(Role::Declaration, &[Position::File], Expected::Nothing);
const ITEM: Class = Class::new(Role::Declaration, &[Position::Item], Expected::Nothing);
const LIBRARY: Class = Class::new(Role::Declaration, &[Position::Item, Position::Library], Expected::Nothing);
const ITEM_OR_STATE: Class = Class::new(Role::Declaration, &[Position::Item, Position::State], Expected::Nothing);
const EVERYWHERE: &[Position] = &[Position::Item, Position::State, Position::Statement];
const LET: Class = Class::new(
    Role::Declaration,
    &[Position::Item, Position::Library, Position::State, Position::Statement],
    Expected::Nothing,
);
const STATE: Class = Class::new(Role::Control, &[Position::State], Expected::Nothing);
const TRANSITION: Class = Class::new(Role::Control, &[Position::State, Position::Inside], Expected::Value);
const TEST: Class = Class::new(Role::Action, &[Position::Test], Expected::Value);
const COMMAND: Class = Class::new(Role::Action, &[Position::State, Position::Statement], Expected::Value);
const STATEMENT: Class = Class::new(Role::Action, EVERYWHERE, Expected::Value);
const IF: Class = Class::new(Role::Control, EVERYWHERE, Expected::Value);
const SET: Class =
    Class::new(Role::Action, &[Position::Item, Position::State, Position::Statement, Position::Test], Expected::Memory);
const INSIDE: Class = Class::new(Role::Control, &[Position::Inside], Expected::Value);
const ACTION: Class = Class::new(Role::Action, &[Position::Inside], Expected::Value);
const OPERATOR: Class = Class::new(Role::Operator, &[Position::Inside], Expected::Value);
const NOT: Class = Class::new(Role::Operator, &[Position::Value, Position::Run], Expected::Value);
const BOOL: Class = Class::new(Role::Constant, &[Position::Value, Position::Run], Expected::Value).complete();
const VALUE: Class = Class::new(Role::Variable, &[Position::Value], Expected::Value).complete();
const RUN: Class = Class::new(Role::Variable, &[Position::Run], Expected::Value).complete();
const TARGET: Class = Class::new(Role::Control, &[Position::Target], Expected::Value).complete();
const MARK: Class = Class::new(Role::Constant, &[Position::Mark], Expected::Value);
const NEED: Class = Class::new(Role::Variable, &[Position::Need], Expected::Value).complete();
const TIP_MODEL: Class = Class::new(Role::Constant, &[Position::TipModel], Expected::Value).complete();
const PROPERTY: Class = Class::new(Role::Control, &[Position::Property], Expected::Family);
const TYPE: Class = Class::new(Role::Control, &[Position::Type], Expected::Value);

/// Declares the words: the text and the class, then what editors insert and the meaning.
macro_rules! words {
    ($($text:literal $class:expr => $snippet:literal, $meaning:literal;)*) => {
        /// Every word that is not a function.
        pub(super) const WORDS: [Word; [$($text),*].len()] = [$(Word::new($text, $class, $snippet, $meaning),)*];
    };
}

words! {
    "machine" FILE => "machine ${1:name}", "Begins a policy and names it.";
    "library" FILE => "library ${1:name}",
        "Begins a library, a file of laws, derived values, types, behaviours and monitors for other files, and names it. It contains nothing else but `use`.";
    "tests" FILE => "tests of \"${1:machine.fsm}\"",
        "Begins a test file, and names the file of the tested machine. The file contains only tests and properties, which `vibrissa test` runs instead of those in the machine's own file.";
    "use" LIBRARY.before(Expected::File) => "use ${1:std.swipe}",
        "Imports laws, derived values, types, behaviours and monitors of another file: all, or only those in parentheses. `use std.swipe` names a module of the standard library, and `use \"corner.fsm\"` a file, relative to the file that contains the `use`. What the other file imports itself is not imported again.";
    "whisker" ITEM => "whisker ${1:name}",
        "Binds whiskers of the rig by name, at most eight. `by` selects their contact estimator, and `if fitted` makes them optional.";
    "contour" ITEM => "contour ${1:middle} of ${2:7} points ${3:5 mm} apart",
        "A contour of positions, fed by `record position in name`, at most eight in a policy. Without a name, the keypoints of the contours of all whiskers. The default is 7 points 1 mm apart.";
    "needs" ITEM.before(Expected::Need) => "needs ${1:control_rate} in ${2:20} .. ${3:30 Hz}",
        "A rate of the loop, or the age of its samples, and the range that the policy was made for. A lower end without a unit has the unit of the upper end. A simulation warns outside of the range, and a robot that cannot hold it refuses the policy.";
    "type" LIBRARY => "type ${1:Side} = ${2:left} or ${3:right}",
        "A type: an enumeration such as `Side = left or right`, a record such as `Edge(place: position, way: direction)`, or a list such as `Places = list of 8 position`.";
    "param" ITEM => "param ${1:name} = ${2:50 mm/s} in ${3:1} .. ${4:200 mm/s}",
        "A number that a run may set within the range, or `true`, `false` or a value of an enumeration. The range is optional, and a lower end without a unit has the unit of the upper end.";
    "initial" ITEM_OR_STATE.before(Expected::Initial) => "initial ${1:State}",
        "The initial state of a run, which has no arguments and is not inside another state. In a state, the inner state that is entered first.";
    "var" ITEM_OR_STATE => "var ${1:name} = ${2:value}",
        "Memory, kept from tick to tick. It is set when the state is entered, or outside of states when a run starts, and by `set`.";
    "let" LET => "let ${1:name} = ${2:value}",
        "Names a value. Outside of braces it may have arguments with defaults, and is computed at every use.";
    "law" LIBRARY => "law ${1:name}(${2:w: whisker}) {\n  ${0}\n}",
        "Named statements, executed with `do`. They are inlined wherever they are used, so a law cannot use itself.";
    "state" ITEM_OR_STATE => "state ${1:Name} {\n  ${0}\n}",
        "A state with its statements, transitions and inner states.";
    "behaviour" LIBRARY => "behaviour ${1:name}(${2:w: whisker}) {\n  exit ${3:lost}\n  ${0}\n}",
        "A state machine with arguments and exits, the content of a state: `state Name is name(r0)`. It knows its arguments, its memory and the items of its file. Each use has separate memory.";
    "monitor" LIBRARY => "monitor ${1:name} {\n  var ${2:seen} = ${3:0}\n  ${0}\n}",
        "Memory with statements that run first in every tick. States read `name.seen`. With arguments, `monitor other is name(r0)` uses it. It cannot give a command, record or mark.";
    "always" ITEM_OR_STATE.before(Expected::Value) => "always when ${1:condition} -> ${2:Target}",
        "Outside of braces, a global transition. It belongs to every state and precedes the transitions of the state itself. With `within`, a contract: `always condition within time` is violated if the condition is false for that time.";
    "assume" ITEM_OR_STATE.before(Expected::Value) => "assume ${1:condition}",
        "A contract: the condition holds when the state is entered. It has no effect on the machine. Runs and the robot report a violation.";
    "never" ITEM_OR_STATE.before(Expected::Value) => "never ${1:condition}",
        "A contract: the condition holds in no tick of the state. With `for`, it never holds for that time without interruption.";
    "failsafe" ITEM_OR_STATE.before(Expected::Only("->")) => "failsafe -> ${1:Target}",
        "The fallback transition of a state. It is taken if the command is not finite, or if a tick exceeds the microstep limit. Without one, that of the nearest outer state is taken, or else that of the machine.";
    "test" ITEM => "test \"${1:title}\" in \"${2:scenario.yaml}\" {\n  expect ${0}\n}",
        "A run of the policy in a scenario, with expectations. The path of the scenario is relative to the file of the test.";
    "property" ITEM => "property \"${1:title}\" over ${2:convex-corner}(${3:angle in 30 deg .. 150 deg}) {\n  expect ${0}\n}",
        "Expectations that hold for every run in the scenes of a family.";
    "by" INSIDE.before(Expected::TipModel) => "by ${1:sliding}",
        "The contact estimator of the whiskers: `sliding`, `one_channel`, `polynomial`, `moment_and_shear`, `recursive` or, in a simulator, `truth`. The default is `sliding`.";
    "fitted" INSIDE => "fitted",
        "After `whisker a if`: these whiskers are optional. A missing whisker never touches, and its `a.fitted` is false.";
    "list" TYPE => "list of ${1:8} ${2:position}",
        "A list with at most so many elements of a type, from 1 to 16. A list is a value: `seen.with(w.tip)` is a list with a new element. A full list loses its oldest element.";
    "points" INSIDE.before(Expected::Nothing) => "points",
        "The number of the newest points to which the curve of a contour is fitted, from 3 to 16. More points have less noise, but the tangent follows a bend later.";
    "apart" INSIDE.complete() => "apart", "The minimum distance between two points of a contour, from 0.1 mm to 20 mm.";
    "is" INSIDE.before(Expected::Behaviour) => "is ${1:behaviour}",
        "The behaviour that is the content of the state, or the content of the monitor, with the values of its arguments.";
    "within" INSIDE => "within ${1:1 s}", "The time after which the condition of a contract has to hold again.";
    "over" PROPERTY => "over ${1:convex-corner}",
        "The family of the scenes, with the ranges of its parameters in parentheses.";
    "when" TRANSITION => "when ${1:condition} -> ${2:Target}",
        "A transition that is due when the condition holds. With `for`, the condition must have held at every tick for that time.";
    "after" STATE.before(Expected::Value) => "after ${1:5 s} -> ${2:Target}",
        "A transition that is due when the state has been active for that time, at the first tick at or after its end.";
    "entry" STATE => "entry {\n  ${0}\n}",
        "Statements that are executed when the state is entered, after its memory is set. They give no command.";
    "exit" STATE => "exit {\n  ${0}\n}",
        "Statements that are executed when the state is left for another state, before the values of the target are computed. They give no command, and are not executed at a failure, which ends the run at once. In a behaviour, `exit name(value: type)` declares an exit, and `-> exit name(value)` leads to it.";
    "on" STATE.before(Expected::Connected) => "on ${1:exit} -> ${2:Target}",
        "The target of an exit of the behaviour that the state uses. Names in parentheses are those of the exit's values. In a monitor, an event: the statements in braces are executed when a statement tells it.";
    "tell" STATEMENT.before(Expected::Monitor) => "tell ${1:monitor}.${2:event}",
        "Executes the statements of an event of a monitor at once. Values in parentheses are those of its arguments.";
    "plot" STATEMENT.before(Expected::Nothing) => "plot ${1:name} = ${2:value}",
        "Shows a value over time under a name: in the ticks, the picture and the tests of a run. The value is a number with any unit, a bool or a value of an enumeration. Several statements may set a plot, and the last one of a tick counts.";
    "log" STATEMENT.before(Expected::Nothing) => "log \"${1:message}\", ${2:value}",
        "Logs a message with the values behind it, in every tick in which it is executed. A message shows up to eight numbers, and a vector is two.";
    "set" SET => "set ${1:name} = ${2:value}", "Changes memory. In a test or a property, sets a parameter for the run.";
    "expect" TEST => "expect ${1:run.completed}", "A condition that must hold at the end of the run.";
    "if" IF => "if ${1:condition} {\n  ${0}\n}",
        "Executes the first block whose condition holds. As a value, `if condition then a else b` chooses one of two.";
    "if" VALUE => "if ${1:condition} then ${2:a} else ${3:b}",
        "One of two values of the same type. Both are always computed, so that filters in them miss no tick. Within another expression it stands in parentheses.";
    "then" INSIDE => "then ${1:a} else ${2:b}", "The values between which a condition chooses.";
    "do" STATEMENT.before(Expected::Law) => "do ${1:law}(${2:w})", "Executes the statements of a law.";
    "record" STATEMENT => "record ${1:w}",
        "Records the tip of a whisker in contact as a point of the estimated contour. No point is added while another part than the tip may touch. With `in`, records a position in a contour of positions, at most one per tick.";
    "mark" STATEMENT.before(Expected::Mark) => "mark ${1:lost} ${2:w}",
        "Marks for the score that a whisker has lost the contour at an edge, or has found contact again. Marks change nothing that a policy can read.";
    "steer" COMMAND => "steer ${1:body} along ${2:direction} at ${3:speed} facing ${4:angle}",
        "Moves the body, or the base of a whisker, in a direction of the world frame at a speed, and rotates the body. With a whisker the body has the speed, and its direction compensates for the motion of the base that the rotation causes. Speed and yaw rate are limited to those of the rig.";
    "hold" COMMAND.complete() => "hold",
        "Keeps the last command. After a `stop` it continues the stop, and after a `steer` it repeats the command with its velocities.";
    "stop" COMMAND.complete() => "stop",
        "Stops the platform and holds its pose. The platform is commanded to stand still for ten time constants of its servos, and then a controller compensates for every displacement.";
    "else" INSIDE => "else {\n  ${0}\n}", "The block that is executed, or the value, if no preceding condition holds.";
    "for" INSIDE => "for ${1:100 ms}", "The time for which the condition must have held at every tick.";
    "in" INSIDE.before(Expected::Nothing) => "in ${1:low} .. ${2:high}",
        "The range of a parameter or a need. In a test, the file of the scenario. After `record`, a contour of positions.";
    "of" INSIDE.before(Expected::Dimension) => "of ${1:length}",
        "The dimension of a vector's components. In a contour, the number of its points.";
    "along" ACTION => "along ${1:direction}",
        "The direction of the motion, a vector of any length. With a vector of length zero the platform does not translate.";
    "at" ACTION => "at ${1:speed}", "The speed of the motion.";
    "facing" ACTION => "facing ${1:angle}",
        "The heading to which the body rotates, in the shorter direction, by a controller with memory. The yaw rate is at most that of the rig's yaw controller, 45 deg/s by default.";
    "turning" ACTION => "turning ${1:0 deg/s}",
        "The yaw rate of the body, counter-clockwise positive. It resets the controller of `facing`, so `turning 0 deg/s` moves straight ahead.";
    "and" OPERATOR => "and", "True if both sides are true. Both sides are always computed.";
    "or" OPERATOR => "or", "True if at least one side is true. Both sides are always computed.";
    "->" INSIDE => "-> ${1:Target}", "The target of a transition.";
    "not" NOT => "not", "The negation of the comparison after it: `not a < b` negates `a < b`.";
    "true" BOOL => "true", "True.";
    "false" BOOL => "false", "False.";
    "body" VALUE => "body", "The platform.";
    "map" VALUE => "map", "What the robot knows of its surroundings by touch. A policy that uses it has one.";
    "time" VALUE => "time", "The time since the start of the run.";
    "state_time" VALUE => "state_time", "The time since the entry of the state that contains it.";
    "run" RUN => "run", "The whole run, in the expectations of a test.";
    "resume" TARGET.before(Expected::Resumed) => "resume ${1:State}",
        "Enters a state by history: the inner state that was active last becomes active again, with its earlier arguments. Memory, entry, filters and times start anew.";
    "sliding" TIP_MODEL => "sliding",
        "Estimates tip position and surface direction together, by a Kalman filter for a tip that slides along a surface. An error at the first touch decreases by a factor e for every centimetre of sliding. While another part than the tip may touch, it gives no point to record.";
    "moment_and_shear" TIP_MODEL => "moment_and_shear",
        "Estimates the contact from base angle and shear, on the tip or on the shaft, without history. The rig must measure forces. While the base angle changes faster than 0.6 mrad/s, it estimates no contact.";
    "recursive" TIP_MODEL => "recursive",
        "Estimates the tip recursively, with a fitted polynomial of order five for the base angle. Its accuracy is about that of `one_channel`.";
    "one_channel" TIP_MODEL => "one_channel",
        "Estimates the tip from the base angle alone, and assumes a surface parallel to the heading. The error is 0.2 mm for every degree between surface and heading.";
    "polynomial" TIP_MODEL => "polynomial",
        "Estimates the tip by a polynomial in the base angle, up to 500 urad, for a surface parallel to the heading.";
    "truth" TIP_MODEL => "truth",
        "An ideal sensor of the tip position, which separates errors of the policy from errors of perception. Only a simulator has it, and a robot refuses the policy.";
    "control_rate" NEED => "control_rate in ${1:20} .. ${2:30 Hz}", "The rate of ticks.";
    "sample_rate" NEED => "sample_rate in ${1:200} .. ${2:300 Hz}", "The rate of samples of every whisker.";
    "sample_age" NEED => "sample_age in 0 .. ${1:40 ms}",
        "The age of a sample: the time since its base angle was measured.";
    "lost" MARK => "lost", "The whisker has lost the contour at an edge.";
    "found" MARK => "found", "The whisker has found contact again.";
    "Success" TARGET => "Success(\"${1:reason}\")",
        "Ends the run as completed, whatever the `stop` of the scenario is. The platform stops, and the expectations of the scenario are checked.";
    "Failure" TARGET => "Failure(\"${1:reason}\")",
        "Ends the run as failed, without the exits of the active states. The platform stops.";
}

/// The words by their texts. Of two with the same text, the first.
static BY_TEXT: LazyLock<HashMap<&str, &Word>> =
    LazyLock::new(|| WORDS.iter().rev().map(|word| (word.text, word)).collect());

/// The word with this text.
pub(super) fn word(text: &str) -> Option<&'static Word> {
    BY_TEXT.get(text).copied()
}

/// The word with this text, if it is reserved, so that it cannot be a name.
pub(super) fn reserved(text: &str) -> Option<&'static Word> {
    word(text).filter(|word| is_keyword(word.text))
}

/// True if a text is reserved and an expression follows it.
pub(super) fn is_before_value(text: &str) -> bool {
    reserved(text).is_some_and(|word| word.next() == Some(Expected::Value))
}

/// The words that are allowed in a position.
pub(super) fn words_at(position: Position) -> impl Iterator<Item = &'static Word> {
    WORDS.iter().filter(move |word| word.is_at(position))
}
