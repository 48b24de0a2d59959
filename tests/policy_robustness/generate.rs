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
const RULES: [Rule; 35] = [
    // Truths, numbers, angles, lengths, times, speeds, vectors, whiskers, contours.
    rule(
        'b',
        4,
        &[
            "true",
            "false",
            "%w.touching",
            "%c.ready",
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
            "near(%p, %l)",
            "lost(%w)",
            "at_limit(%w, %a)",
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
            "exp(%n)",
            "floor(%n)",
            "min(%n, %n)",
            "max(%n, %n)",
            "clamp(%n, %n, %n)",
            "sin(%a)",
            "cos(%a)",
            "tan(%a)",
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
            "%w.base_angle",
            "-%a",
            "(%a + %a)",
            "(%n * %a)",
            "angle(%v)",
            "angle(%p - %p)",
            "turn(%a, %a)",
            "wrap(%a)",
            "asin(%n)",
            "acos(%n)",
            "|%a|",
            "max(%a, %a)",
            "lowpass(%a, 2 Hz)",
            "bow(%c.curvature, %l)",
            "%w.yaw",
        ],
    ),
    rule(
        'l',
        3,
        &[
            "10 mm",
            "0 m",
            "%w.length",
            "%w.tip_deviation",
            "|%p - %p|",
            "sqrt(%l * %l)",
            "(%l - %l)",
            "(%n * %l)",
            "(%s * %t)",
            "min(%l, %l)",
        ],
    ),
    rule('t', 3, &["100 ms", "time", "pause", "(%n * %t)", "(%t + %t)", "(%l / %s)", "clamp(%t, 0 s, 2 s)"]),
    rule('s', 2, &["speed", "50 mm/s", "(%n * speed)", "min(%s, %s)", "(%l / %t)"]),
    rule(
        'v',
        3,
        &[
            "vector(1, 0)",
            "%c.tangent",
            "direction(body.yaw)",
            "%c.normal",
            "%c.tangent(%l)",
            "%c.normal(%l)",
            "unit(%p - %p)",
            "(%v + %v)",
            "(%n * %v)",
            "-%v",
            "rotate(%v, %a)",
            "unit(%v)",
            "(%p - body.position) / (%l)",
            "(%w.tip_at(%a) / %l)",
        ],
    ),
    // Places in the world.
    rule(
        'p',
        3,
        &["body.position", "%w.tip", "%w.base", "%c.end", "%c.point(%l)", "position(%l, %l)", "blend(%p, %p, %n)"],
    ),
    rule('d', 2, &["direction(%a)", "%c.tangent", "unit(%v)", "-%d", "rotate(%d, %a)"]),
    rule('w', 2, &["r0", "l0"]),
    rule('c', 1, &["%w.contour"]),
    // Statements; those without a law of the policy itself; those that command nothing.
    rule(
        'S',
        2,
        &[
            "%Q",
            "%R",
            "do go(%w, %s)",
            "do follow(%c, %s)",
            "if %b { %S }",
            "if %b { %S } else if %b { %S } else { %S }",
            "%S %S",
        ],
    ),
    rule(
        'Q',
        3,
        &[
            "hold",
            "stop",
            "%R",
            "if %b { %Q }",
            "if %b { %Q } else { %Q }",
            "steer body along %v at %s turning %n * 1 deg/s",
            "steer body along %v at %s facing %a",
            "steer %w along %v at %s facing %a",
            "do swipe(%w, %a, %s)",
            "do detach(%w, %d, %s)",
        ],
    ),
    rule(
        'R',
        3,
        &[
            "record %w",
            "mark lost %w",
            "mark found %w",
            "plot far = %l",
            "plot is_on = %b",
            "log \"here\"",
            "log \"there\", %w, %v, %s",
            "if %b { let k = %n record %w }",
            "if %b { let c = %c if c.ready { mark found %w } }",
            "if %b { %R } else { %R }",
        ],
    ),
    // Targets from anywhere; from the state that holds others, from deeper in it, and from the plainer one; transitions to them.
    rule(
        'G',
        2,
        &[
            "First",
            "Failure(\"why\")",
            "Second(%w)",
            "Third(%n, %l)",
            "Outer(%w)",
            "Outer(%w).Middle(%n)",
            "Outer(%w).Inner(%n, %l)",
            "Outer(%w).Middle(%n).Innermost",
            "resume Outer(%w)",
            "Plain.Inside(%w)",
            "Plain",
            "resume Plain",
        ],
    ),
    rule(
        'H',
        2,
        &[
            "Inner(%n, %l)",
            "Middle(%n)",
            "resume Middle(%n)",
            "Middle(%n).Innermost",
            "First",
            "Second(%w)",
            "Outer(%w)",
            "resume Plain",
            "Failure(\"outside\")",
        ],
    ),
    rule(
        'K',
        2,
        &[
            "Innermost",
            "Beside",
            "Inner(%n, %l)",
            "Middle(%n)",
            "resume Middle(%n)",
            "Third(%n, %l)",
            "resume Outer(%w)",
        ],
    ),
    rule('Y', 2, &["First", "Inside(%w)", "Plain", "Outer(%w).Middle(%n)", "resume Outer(%w)", "Failure(\"plain\")"]),
    rule(
        'T',
        1,
        &[
            "when %b for 0.1 s -> %G",
            "when %b -> %G",
            "when %b for %t -> %G",
            "after %t -> %G",
            "after 1 s -> %G",
            "%T %T",
        ],
    ),
    rule(
        'I',
        1,
        &[
            "when %b for 0.1 s -> %H",
            "when %b -> %H",
            "when %b for %t -> %H",
            "after %t -> %H",
            "after 1 s -> %H",
            "%I %I",
        ],
    ),
    rule(
        'J',
        1,
        &[
            "when %b for 0.1 s -> %K",
            "when %b -> %K",
            "when %b for %t -> %K",
            "after %t -> %K",
            "after 1 s -> %K",
            "%J %J",
        ],
    ),
    rule('Z', 1, &["when %b for 0.1 s -> %Y", "when %b -> %Y", "when %b for %t -> %Y", "after %t -> %Y"]),
    rule('P', 1, &["", "var kept = %n", "var kept = 0 entry { set kept = %n }", "var kept = %n exit { record %w }"]),
    rule('A', 2, &["", "%F", "always when %b -> %G", "always when %b for %t -> %G"]),
    // A behaviour that a state uses, perhaps with another in it, and monitors.
    rule(
        'N',
        2,
        &[
            "",
            "monitor seen { var much = %n if %b { set much = %n } }",
            "behaviour wander(w: whisker, x: number) { exit far(d: length) exit gone initial Start var own = x when %b -> exit gone \
            state Start { stop set own = %n when w.touching -> Later after %t -> exit far(%l) } state Later { hold when x > own -> exit far(w.length) } } \
            state Used(w: whisker) is wander(w, %n) { on far(d) -> Third(%n, d) on gone -> %G %T }",
            "monitor felt(w: whisker, x: number) { var most = x let more = most + 1 if w.touching { set most = more } } monitor right is felt(r0, %n) monitor left is felt(l0, right.most) \
            behaviour outer { exit done initial Run state Run is inner(r0) { on full(n) -> exit done on none -> Run } } \
            behaviour inner(w: whisker) { exit full(x: number) exit none record w when w.touching -> exit full(2) after 1 s -> exit none } \
            state Used is outer { on done -> First when left.most > %n -> %G }",
        ],
    ),
    rule('F', 1, &["", "failsafe -> %G"]),
    // What is expected of a run, and tests.
    rule(
        'e',
        2,
        &[
            "run.completed",
            "run.visits(First) == 1",
            "run.failed",
            "not run.timed_out",
            "run.diverged",
            "run.time < 2 * pause",
            "run.time_in(Outer) <= clamp(gain, 0, 1) * run.time",
            "run.visits(Innermost) > twice(run.coverage)",
            "max(run.error_p95, run.error_mean) < run.error_max / gain",
            "run.hausdorff != 1 mm",
            "(%e and %e)",
            "(%e or not %e)",
        ],
    ),
    rule(
        'E',
        1,
        &[
            "",
            "test \"one\" in \"a.yaml\" { expect %e }",
            "test \"one\" in \"../a.yaml\" { set gain = 1 expect %e expect %e } test \"two\" in \"a.yaml\" { expect %e }",
        ],
    ),
    // Laws and values of the standard library, or what stands for them: to read it takes longer than most else. The policy's own.
    rule(
        'U',
        4,
        &[
            "%u %g",
            "%u %g",
            "%g %u",
            "%u use std.guards (lost, at_limit) use std.swipe (swipe)",
            "use std.guards use std.swipe use std.tunnel use std.retrieval (detach)",
        ],
    ),
    rule(
        'u',
        1,
        &["law detach(w: whisker, surface: direction, fast: speed) { steer w along -surface at fast turning 0 rad/s }"],
    ),
    rule(
        'g',
        1,
        &["let lost(w: whisker) = not w.touching let at_limit(w: whisker, limit: angle) = |w.base_angle| > limit \
            law swipe(w: whisker, target: angle, fast: speed) { steer w along w.contour.tangent at fast facing target }"],
    ),
    rule(
        'D',
        1,
        &["let twice(x: number) = gain * x + x let both(a: whisker, b: whisker) = a.touching and b.touching \
            let near(place: position, within: length) = |place - body.position| < within let bow(c: angle / length, d: length) = c * d \
            law follow(c: contour, fast: speed) { if c.ready { steer body along c.tangent at fast facing angle(c.tangent(5 mm)) } else { hold } }"],
    ),
    // States, and whole policies: of one file, of several, a library.
    rule(
        'B',
        1,
        &[
            "type Spot(place: position, far: length = 3 mm) type Spots = list of 3 position var spots = Spots() initial First state First { var kept = 0 %S set kept = %n + kept %T %T } state Second(w: whisker) { var kept = %n %S set kept = max(kept, %n) let spot = Spot(%p, far: %l) set spots = spots.with(spot.place) \
            if |spots.nearest(%p) - spot.place| < spots.count * spot.far { record w } record w %S %T %F } \
            state Third(x: number, d: length) { %P %S when x > %n and d > %l -> %G %T } \
            state Outer(w: whisker) { initial Middle(%n) var held = %n failsafe -> %H entry { set held = %n mark lost w } record w %I \
            state Inner(x: number, d: length) { var own = x set own = lowpass(own, 1 Hz) + held set held = own / 2 %S when d > %l -> Middle(x) %I exit { mark found w } } \
            state Middle(y: number) { initial Innermost set held = y %S state Innermost { %S %J failsafe -> %K } state Beside { when %b for pause -> Innermost %J } %J } } \
            state Plain { initial Inside(%w) state Inside(w: whisker) { %S %Z } %Z exit { record %w } } %A %A %N",
        ],
    ),
    rule(
        'M',
        3,
        &[
            "machine m whisker r0, l0 param speed = 50 mm/s in 1 .. 200 mm/s param gain = 1 in -2 .. 2 param pause = 0.1 s %U %D \
            let bend = (r0.base_angle - l0.base_angle) / 2 law go(w: whisker, fast: speed) { if %b { steer w along %v at fast facing %a } else { hold } } %B %E",
            "machine m whisker r0, l0 param speed = 50 mm/s in 1 .. 200 mm/s param gain = 1 in -2 .. 2 param pause = 0.1 s use \"0.fsm\" (go) %U %D \
            let bend = (r0.base_angle - l0.base_angle) / 2 %B %E\n----\n\
            library zero use \"1.fsm\" use \"./laws/../1.fsm\" (inner) law go(w: whisker, fast: speed) { do inner(w, w, fast) }\n----\n%L",
            "machine m whisker r0, l0 param speed = 50 mm/s param gain = 1 param pause = 0.1 s use \"0.fsm\" (twice, both, near, bow, follow) use \"2.fsm\" (go) %U \
            let bend = (r0.base_angle - l0.base_angle) / 2 %B %E\n----\n\
            library zero let gain = 2 %D\n----\n%L\n----\nlibrary two use \"laws/../1.fsm\" law go(w: whisker, fast: speed) { do inner(w, w, fast) }",
        ],
    ),
    rule(
        'L',
        1,
        &[
            "library one %U %D let gain = 2 let pause = 0.1 s let bend = 1 mrad law inner(r0: whisker, l0: whisker, speed: speed) { %Q %Q }",
        ],
    ),
];

/// Forms beyond which only the shortest are taken.
const LARGEST: usize = 400;

/// A random policy, now and then a library.
pub(crate) fn policy(random: &mut Random) -> String {
    let mut text = String::new();
    let is_library = random.below(20) == 0;
    expand(if is_library { 'L' } else { 'M' }, random, &mut 0, 0, &mut text);
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
