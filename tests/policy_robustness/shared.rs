//! Random policies whose parts use each other several times, so that a few lines have exponentially many uses.

use std::fmt::Write;

use crate::random::Random;

/// How parts of one kind use each other. In its texts, `#` stands for the number of a part, `@` for the number of the part that it uses,
/// and `%` for the number of the use.
struct Kind {
    /// The first part: right, or with an error.
    bases: &'static [&'static str],
    /// Another part, with `~` for its uses.
    link: &'static str,
    /// One use, and what is between two of them.
    one: &'static str,
    between: &'static str,
    /// What uses the last part: items, and statements of a state.
    items: &'static [&'static str],
    statements: &'static [&'static str],
}

const NONE: &[&str] = &[];

#[rustfmt::skip]
const KINDS: [Kind; 22] = [
    // Records and lists, with values and defaults.
    Kind { bases: &["type R#(a: number, b: position)", "type R#(a: Nope)", "type R#(a: number)", "type R#(a: R#)"], link: "type R#(~)", one: "f%: R@", between: ", ",
        items: &["state Ur(r: R#) { stop }", "type Z = list of 3 R# var kept = Z()", "law ur(r: R#) { }", "behaviour ur(r: R#) { exit out(r: R#) initial S state S { after 1 s -> exit out(r) } }"], statements: NONE },
    Kind { bases: &["type L# = list of 1 number", "type L# = list of 1 Nope", "type L# = list of 99 number"], link: "type L# = list of 2 L@ type M#(~)", one: "f%: L@", between: ", ",
        items: &["var kept# = L#()", "state Ul(l: L#) { when l.count > 1 -> A }", "let ul(l: L#) = l.newest"], statements: &["let l = L#()"] },
    Kind { bases: &["type T#(a: number = 1) let r# = T#()", "type T#(a: Nope) let r# = T#(1)", "type T#(a: number) let r# = T#(1)"], link: "type T#(~) let r# = if true then T#(r@, r@) else T#(r@, r@)", one: "f%: T@", between: ", ",
        items: &["var kept_r = r#"], statements: &["let r = r#", "log \"r\", r#.f0"] },
    Kind { bases: &["type D#(x: number = 1)", "type D#(x: number = nothing)", "type D#(x: number = D#().x)"], link: "type D#(x: number = ~)", one: "D@().x", between: " + ",
        items: &["let ud = D#()", "var kept_d = D#()"], statements: &["let d = D#().x"] },
    // Laws and derived values.
    Kind { bases: &["law l#() { hold }", "law l#() { }", "law l#() { do nothing() }", "law l#() { let a = 1 m + 1 s }", "law l#() { set n = 1 }", "law l#() { do l#() }"], link: "law l#() { ~ }", one: "do l@()", between: " ",
        items: NONE, statements: &["do l#()", "if r0.touching { do l#() }"] },
    Kind { bases: &["law h#(x: number, w: whisker) { record w }", "law h#(x: number, w: whisker) { }", "law h#(x: Nope, w: whisker) { }"], link: "law h#(x: number, w: whisker) { let y = x ~ }", one: "do h@(x + y, w)", between: " ",
        items: NONE, statements: &["do h#(1, r0)", "entry { do h#(n, r0) }"] },
    Kind { bases: &["law i#() { stop }", "law i#() { }", "law i#() { log \"a\", nothing }"], link: "law i#() { if r0.touching { ~ } else { ~ } }", one: "do i@()", between: " } else if r0.touching { ",
        items: NONE, statements: &["do i#()"] },
    Kind { bases: &["let v# = 1", "let v# = nothing", "let v# = time", "let v# = 1 m + 1 s", "let v# = v#"], link: "let v# = ~", one: "v@", between: " + ",
        items: &["state Uv { when v# > v# -> A }"], statements: &["let v = v#", "plot v = v#"] },
    Kind { bases: &["let w# = 1 m", "let w# = 2"], link: "let w# = ~", one: "w@", between: " * ", items: NONE, statements: &["let w = w#"] },
    Kind { bases: &["let g#(x: number) = x", "let g#(x: number) = lowpass(x, 1 Hz)", "let g#(x: number) = nothing"], link: "let g#(x: number) = ~", one: "g@(g@(x))", between: " * ",
        items: &["state Ug { when g#(n) > 1 for 1 s -> A }"], statements: &["set n = g#(n)"] },
    Kind { bases: &["let p# = body.position", "let p# = nowhere"], link: "let p# = position(|~|, 1 m)", one: "p@", between: " - ", items: NONE, statements: &["let p = p#"] },
    // Defaults.
    Kind { bases: &["let d#(x: number = 1) = x", "let d#(x: number = nothing) = x", "let d#(x: number = d#()) = x"], link: "let d#(x: number = ~) = x", one: "d@()", between: " + ",
        items: &["state Ud(x: number = d#() + d#()) { when x > 1 -> Ud }"], statements: &["let d = d#()"] },
    Kind { bases: &["law k#(x: number = 1) { }", "law k#(x: number = nothing) { }"], link: "let e#(x: number = 1) = x law k#(x: number = e#()) { ~ }", one: "do k@()", between: " ", items: NONE, statements: &["do k#()"] },
    // Conditional expressions and conditions with shared parts.
    Kind { bases: &["let c# = 1", "let c# = nothing", "let c# = r0.base_angle / 1 rad"], link: "let c# = if c@ > 1 then c@ else (if ~ then c@ else c@)", one: "c@ < 2", between: " and ", items: NONE, statements: &["let c = c#"] },
    Kind { bases: &["let t#(x: bool) = x and r0.touching", "let t#(x: bool) = not x", "let t#(x: bool) = nothing"], link: "let t#(x: bool) = t@(~)", one: "t@(x)", between: " or ",
        items: &["never t#(r0.base_angle > 1 mrad)", "always t#(time > 1 s) within 1 s", "state Ut { assume t#(time > 2 s) when t#(r0.touching) -> A }"], statements: &["let t = t#(true)"] },
    Kind { bases: &["let s#(x: bool) = x"], link: "let s#(x: bool) = ~", one: "s@(x)", between: " and ", items: &["never s#(time > 1 s)", "always when s#(time > 1 s) -> Failure(\"s\")"], statements: NONE },
    // Behaviours, alone and with exits and values.
    Kind { bases: &["behaviour b# { initial S state S { stop } }", "behaviour b# { initial S state S { do nothing() } }", "behaviour b# { initial S state S is b# { } }"], link: "behaviour b# { initial S0 ~ }", one: "state S% is b@ { }", between: " ",
        items: &["state Ub is b# { }", "behaviour ub { initial A state A is b# { } state B is b# { } }"], statements: NONE },
    Kind { bases: &["behaviour x#(n: number) { exit out(x: number) initial S state S { after 1 s -> exit out(n) } }"], link: "behaviour x#(n: number) { exit out(x: number) initial S0(n) ~ }", one: "state S%(k: number = 1) is x@(k + n) { on out(x) -> exit out(x + x) }", between: " ",
        items: &["state Ux is x#(1) { on out(x) -> A }"], statements: NONE },
    // Monitors.
    Kind { bases: &["monitor m#(x: number) { var a = x on e { set a = a + 1 } }", "monitor m#(x: number) { }", "monitor m#(x: Nope) { var a = x on e { } }", "monitor m#(x: m#) { var a = 1 on e { } }"], link: "monitor m#(~) { var a = f0.a on e { tell f0.e tell f0.e } }", one: "f%: m@", between: ", ",
        items: &["law um(m: m#) { tell m.e }", "behaviour um(m: m#) { initial S state S { tell m.e } }"], statements: NONE },
    Kind { bases: &["monitor o# { var a = 1 on e { set a = a + 1 } }", "monitor o# { var a = 1 on e { set b = 1 } }", "monitor o# { var a = 1 on e { tell o#.e } }"], link: "monitor o# { var a = 1 on e { ~ } }", one: "tell o@.e", between: " ", items: NONE, statements: &["tell o#.e"] },
    Kind { bases: &["monitor c(x: number, y: number = x) { var a = x } monitor q# is c(1, 2)", "monitor c(x: number, y: number = 1) { var a = x + y } monitor q# is c(1)"], link: "monitor q# is c(~)", one: "q@.a", between: " + ", items: NONE, statements: &["let q = q#.a"] },
    // Many of the same.
    Kind { bases: &["param n# = 1", "var n# = 1"], link: "let a# = 1 law a#(a#: number) { } type E# = a or b or c ~", one: "whisker w#_%", between: " ", items: NONE, statements: NONE },
];

/// The largest text (bytes).
const LARGEST: usize = 64 << 10;

/// A random policy with shared parts, perhaps of several files.
pub(crate) fn policy(random: &mut Random) -> String {
    let most = match random.below(32) {
        0 => LARGEST,
        1..4 => 8 << 10,
        _ => 2 << 10,
    };
    let mut text = String::from("machine m whisker r0 initial A var n = 1 ");
    let mut files = String::new();
    if random.below(6) == 0 {
        imports(random, &mut text, &mut files);
    }
    let (mut items, mut statements) = (String::new(), String::new());
    let kinds = 1 + random.below(3);
    for _ in 0..kinds {
        let kind = random.pick(&KINDS);
        let last = chain(kind, random, most / kinds, &mut text);
        for (uses, into) in [(kind.items, &mut items), (kind.statements, &mut statements)] {
            for _ in 0..random.below(3).min(uses.len()) {
                into.push_str(&numbered(random.pick::<&str>(uses), last, last, 0));
                into.push(' ');
            }
        }
    }
    let nested = nested(random, &statements);
    text + &items + &format!("state A {{ {nested} after 1 s -> Failure(\"late\") }}") + &files
}

/// Adds parts of a kind, and returns the number of the last one.
fn chain(kind: &Kind, random: &mut Random, most: usize, text: &mut String) -> usize {
    let most_uses = if random.below(4) == 0 { 30 } else { 3 };
    let width = 1 + random.below(most_uses);
    let length = [3, 6, 12, 25, 60, 5000][random.below(6)];
    let mut parts = vec![numbered(random.pick::<&str>(kind.bases), 0, 0, 0)];
    let mut size = parts[0].len();
    while parts.len() <= length {
        let (number, used) =
            (parts.len(), if random.below(50) == 0 { random.below(parts.len() + 1) } else { parts.len() - 1 });
        let uses: Vec<String> = (0..width).map(|place| numbered(kind.one, number, used, place)).collect();
        let part = numbered(kind.link, number, used, 0).replace('~', &uses.join(kind.between));
        size += part.len() + 1;
        if size > most {
            break;
        }
        parts.push(part);
    }
    let last = parts.len() - 1;
    // The order of items means nothing, except for running monitors and memory.
    match random.below(4) {
        0 => parts.reverse(),
        1 => parts.rotate_left(random.below(last + 1)),
        _ => {}
    }
    text.push_str(&parts.join("\n"));
    text.push('\n');
    last
}

fn numbered(form: &str, number: usize, used: usize, place: usize) -> String {
    form.replace('#', &number.to_string()).replace('@', &used.to_string()).replace('%', &place.to_string())
}

/// Adds files that use each other several times.
fn imports(random: &mut Random, text: &mut String, files: &mut String) {
    let most = if random.below(4) == 0 { 70 } else { 8 };
    let count = 1 + random.below(most);
    let by_name = random.below(2) == 0;
    for number in 0..count {
        let chosen = if by_name { format!(" (z{number}, y{number})") } else { String::new() };
        let _ = write!(text, "use \"{number}.fsm\"{chosen} ");
        let _ = write!(files, "\n----\nlibrary z{number} ");
        for used in (0..number).rev().take(1 + random.below(3)) {
            let chosen = if by_name { format!(" (z{used}, y{used}, z{used})") } else { String::new() };
            let _ = write!(files, "use \"{used}.fsm\"{chosen} use \"./x/../{used}.fsm\"{chosen} ");
        }
        // Now and then a file that uses one behind it, and so perhaps itself.
        if random.below(60) == 0 {
            let _ = write!(files, "use \"{}.fsm\" ", random.below(count));
        }
        let (law, value) = match number {
            0 => ("hold".to_owned(), "1".to_owned()),
            _ => (format!("do z{0}() do z{0}()", number - 1), format!("y{0} + y{0}", number - 1)),
        };
        let _ = write!(files, "law z{number}() {{ {law} }} let y{number} = {value}");
    }
    let _ = write!(text, "law imported() {{ do z{0}() do z{0}() let y = y{0} + y{0} }} ", count - 1);
}

/// Statements within conditions, as deep as may be.
fn nested(random: &mut Random, statements: &str) -> String {
    let depth = [0, 0, 0, 5, 60, 70][random.below(6)];
    let brackets = [0, 0, 0, 5, 60, 70][random.below(6)];
    let condition = format!("{}r0.touching{}", "(not ".repeat(brackets), ")".repeat(brackets));
    let all = if depth > 20 { "if true { " } else { "if r0.touching { } else { " };
    format!("{}{statements}{} if {condition} {{ hold }}", all.repeat(depth), " }".repeat(depth))
}
