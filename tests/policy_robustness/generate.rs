//! Random policies by rules, most of them well typed.

use crate::random::Random;

/// What a mark stands for: the forms at the front, as many as the number says, hold no further mark of their own kind.
struct Rule {
    mark: char,
    ends: usize,
    forms: &'static [&'static str],
}

const fn rule(mark: char, ends: usize, forms: &'static [&'static str]) -> Rule {
    Rule { mark, ends, forms }
}

/// In a form, `%` and a mark stand for what the mark's rule gives.
const RULES: [Rule; 14] = [
    // Truths, numbers, angles, lengths, times.
    rule(
        'b',
        4,
        &[
            "true",
            "false",
            "%w.touching",
            "%w.contour.ready",
            "not %b",
            "(%b and %b)",
            "(%b or %b)",
            "%w == %w",
            "%n < %n",
            "%n >= %n",
            "%a > %a",
            "%a <= %a",
            "%l < %l",
            "%t > %t",
            "%n == %n",
            "%n != %n",
            "both(%w, %w)",
        ],
    ),
    rule(
        'n',
        7,
        &[
            "0",
            "1",
            "0.5",
            "1e9",
            "gain",
            "%w.sense",
            "%w.side",
            "-%n",
            "(%n + %n)",
            "(%n - %n)",
            "(%n * %n)",
            "%n / (%n)",
            "|%n|",
            "sqrt(%n)",
            "min(%n, %n)",
            "max(%n, %n)",
            "clamp(%n, %n, %n)",
            "sin(%a)",
            "cos(%a)",
            "sign(%l)",
            "abs(%n)",
            "(%l / %l)",
            "(%a / %a)",
            "dot(%v, %v)",
            "cross(%v, %v)",
            "|%v|",
            "lowpass(%n, 5 Hz)",
            "pid(%n, %n, 1 Hz, 0 s, %n)",
            "twice(%n)",
        ],
    ),
    rule(
        'a',
        5,
        &[
            "20 urad",
            "90 deg",
            "bend",
            "body.yaw",
            "%w.deflection",
            "-%a",
            "(%a + %a)",
            "(%n * %a)",
            "angle(%v)",
            "turn(%a, %a)",
            "|%a|",
            "max(%a, %a)",
            "lowpass(%a, 2 Hz)",
            "%w.contour.curvature * %l",
            "%w.yaw",
        ],
    ),
    rule(
        'l',
        3,
        &["10 mm", "0 m", "%w.length", "|%w.tip - %w.base|", "(%l - %l)", "(%n * %l)", "(%s * %t)", "min(%l, %l)"],
    ),
    rule('t', 3, &["100 ms", "time", "pause", "(%n * %t)", "(%t + %t)", "(%l / %s)"]),
    rule('s', 2, &["speed", "50 mm/s", "(%n * speed)", "min(%s, %s)", "(%l / %t)"]),
    rule(
        'v',
        3,
        &[
            "vector(1, 0)",
            "%w.contour.tangent",
            "direction(body.yaw)",
            "unit(%w.tip - %w.base)",
            "(%v + %v)",
            "(%n * %v)",
            "-%v",
            "rotate(%v, %a)",
            "unit(%v)",
            "(%w.tip - body.position) / (%l)",
            "(%w.tip_at(%a) / %l)",
        ],
    ),
    rule('w', 2, &["r0", "l0"]),
    // Statements, targets, transitions.
    rule(
        'S',
        5,
        &[
            "hold",
            "stop",
            "record %w",
            "if %b { let k = %n record %w }",
            "if %b { %S }",
            "if %b { %S } else { %S }",
            "if %b { %S } else if %b { %S } else { %S }",
            "do go(%w, %s)",
            "steer body along %v at %s turning %n * 1 deg/s",
            "steer body along %v at %s facing %a",
            "steer %w along %v at %s facing %a",
            "%S %S",
        ],
    ),
    rule('G', 2, &["First", "Failure(\"why\")", "Second(%w)", "Third(%n, %l)"]),
    rule('T', 1, &["when %b -> %G", "when %b for %t -> %G", "after %t -> %G", "%T %T"]),
    rule('P', 1, &["", "var kept = %n", "var kept = 0 entry { set kept = %n }", "var kept = %n exit { record %w }"]),
    rule('A', 1, &["", "always when %b -> %G", "always when %b for %t -> %G"]),
    rule(
        'M',
        1,
        &[
            "machine m whisker r0, l0 param speed = 50 mm/s in 1 .. 200 mm/s param gain = 1 in -2 .. 2 param pause = 0.1 s \
        let bend = (r0.deflection - l0.deflection) / 2 let twice(x: number) = gain * x + x let both(a: whisker, b: whisker) = a.touching and b.touching \
        law go(w: whisker, fast: speed) { if %b { steer w along %v at fast facing %a } else { hold } } \
        initial First state First { var kept = 0 %S set kept = %n + kept %T %T } state Second(w: whisker) { var kept = %n %S set kept = max(kept, %n) record w %S %T } \
        state Third(x: number, d: length) { %P %S when x > %n and d > %l -> %G %T } %A",
        ],
    ),
];

/// Forms beyond which only the shortest are taken.
const LARGEST: usize = 400;

/// A random policy.
pub(crate) fn policy(random: &mut Random) -> String {
    let mut text = String::new();
    expand('M', random, &mut 0, 0, &mut text);
    text
}

fn expand(mark: char, random: &mut Random, forms: &mut usize, depth: usize, text: &mut String) {
    let Some(rule) = RULES.iter().find(|rule| rule.mark == mark) else { unreachable!("no rule for {mark}") };
    *forms += 1;
    // What branches must end: the deeper, the more often it does.
    let ends = *forms > LARGEST || random.below(5) < depth;
    let form = random.pick(&rule.forms[..if ends { rule.ends } else { rule.forms.len() }]);
    let mut parts = form.split('%');
    text.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let mut rest = part.chars();
        let Some(mark) = rest.next() else { continue };
        expand(mark, random, forms, depth + 1, text);
        text.push_str(rest.as_str());
    }
}
