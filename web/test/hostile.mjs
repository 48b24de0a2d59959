// Fragments of links that somebody wrote to harm the page or its reader.
import { deflateRawSync } from "node:zlib";

/** The fragment of a link. */
export const fragment = (value) => `#1${deflateRawSync(typeof value === "string" || Buffer.isBuffer(value) ? value : JSON.stringify(value)).toString("base64url")}`;

/** Markup that sets `window.hacked` or loads something, if it is ever read as such. */
const MARKUP = [
  "<img src=x onerror=hacked=1>", "<script>hacked=1</script>", "<svg onload=hacked=1>", "javascript:hacked=1", "'><iframe src=//evil.example>", "${hacked=1}",
  "{{constructor.constructor('hacked=1')()}}", "<style>@import'//evil.example'</style>", "</script><script>hacked=1</script>", "<a href=javascript:hacked=1>x</a>",
];

/** A policy that compiles, with a text wherever the language has room for one. */
const everywhere = (text) => `# ${text}
machine m
whisker r0  # ${text}
param speed = 50 mm/s in 1 .. 200 mm/s  # ${text}
type Side = left or right  # ${text}
initial Going
# ${text}
state Going {
  plot way = |body.position - body.position|
  entry { log "${text}", r0 }
  steer body along direction(body.yaw) at speed turning 0 deg/s
  when r0.touching -> Success("${text}")
}
`;

/** Records or laws of which each contains two of those before. */
const doubled = (line, last) => Array.from({ length: 26 }, (_, index) => line(index)).join("\n") + last;

/** The links. `scene` is the text of a scenario that can be simulated. */
export function hostileLinks(scene) {
  const good = { policy: everywhere("good"), scenario: scene, set: {} };
  const policies = [
    "(".repeat(100_000), `machine m initial A ${"state A { ".repeat(2000)}`, `machine m initial A state A { ${"if true { ".repeat(5000)} }`,
    `machine m\nwhisker r0\ninitial A\ntype R0(a: number, b: number)\n${doubled((n) => `type R${n + 1}(a: R${n}, b: R${n})`, "\ntype L = list of 2 R23\nlet f = L()\nstate A { stop when f.count > 1 -> A }")}`,
    `machine m initial A law l0() { stop }\n${doubled((n) => `law l${n + 1}() { do l${n}() do l${n}() }`, "\nstate A { do l26() }")}`,
    `machine m initial A state A { stop when ${"not ".repeat(50_000)}true -> A }`, `machine m initial A state A { stop when ${"1 + ".repeat(50_000)}1 > 0 -> A }`,
    "machine m use \"../../etc/passwd\" initial A state A { stop }", "\0\u202e\ufeff", "\ud800", "x".repeat(1_000_000), `machine ${"m".repeat(500_000)} initial A state A { stop }`,
    `machine m ${Array.from({ length: 3000 }, (_, n) => `state S${n} { stop when time > ${n} s -> S${(n + 1) % 3000} }`).join("\n")} initial S0`,
    "machine m initial A state A { stop when time > 0 s -> B } state B { stop when time > 0 s -> A }", `machine m initial A state A { ${"log \"x\" ".repeat(5000)} stop }`,
  ];
  const scenarios = [
    "a: &a [x, x]\nb: [*a, *a, *a, *a]\n".repeat(50), Array.from({ length: 30 }, (_, n) => `a${n}: &a${n} [${n > 0 ? `*a${n - 1}, *a${n - 1}` : "x, x"}]`).join("\n"), "[".repeat(50_000), `${"- ".repeat(50_000)}x`,
    "objects:\n  - circle: {centre: [0 m, 0 m], radius: 1e300 m}\n", "objects:\n  - outline: {file: /etc/passwd}\n", "policy: ../../etc/passwd\n", "objects: []\nstop: {time: 1e18 s}\n",
    "objects:\n  - circle: {centre: [.nan m, .inf m], radius: -1 m}\n", `objects:\n${"  - circle: {centre: [0 m, 0.6 m], radius: 0.1 m}\n".repeat(5000)}`, "rig: {sensing: {sample_rate: 1e12 Hz}}\n", "!!js/function 'function(){hacked=1}'\n",
  ];
  const fragments = [
    "#1", "#1=", "#1AAAA", "#1%00", "#1\u{1f980}", `#1${"A".repeat(100_000)}`, `#${"1".repeat(1_100_000)}`, "#policy=", "#policy=%", `#policy=${"%28".repeat(30_000)}`, "#__proto__", "#playground", "#:~:text=hacked",
    ...["null", "[]", "3", "{", "", "\"x\"", "{}", "{\"policy\":1,\"scenario\":[]}"].map(fragment), fragment(`${"[".repeat(200_000)}`), fragment(`${"{\"a\":".repeat(100_000)}`),
    // A mebibyte becomes one of 64 MiB, and of 1 GiB.
    fragment(Buffer.alloc(1 << 26)), fragment(Buffer.alloc(1 << 30)), fragment(Buffer.from([0xff, 0xfe, 0x80])),
    fragment(`{"scenario":"","policy":"","set":{"__proto__":1,"constructor":2}}`), fragment({ ...good, set: null }), fragment({ ...good, set: { speed: 1e308, x: "1" } }), fragment({ ...good, set: { speed: -0.05 } }),
    fragment({ ...good, set: Object.fromEntries(Array.from({ length: 50_000 }, (_, n) => [`p${n}`, n])) }),
  ];
  const links = MARKUP.flatMap((bad) => [
    fragment({ ...good, policy: everywhere(bad) }), fragment({ ...good, policy: bad }), fragment({ ...good, scenario: bad }), fragment({ ...good, scenario: scene.replace("name: disk", `name: '${bad.replaceAll("'", "''")}'`) }),
    fragment({ ...good, scenario: `${scene}\nrig: {whiskers: {'${bad.replaceAll("'", "''")}': {base: [53 mm, -30 mm]}}}\n` }),
    fragment({ ...good, set: { [bad]: 1 } }), `#1${bad}`, `#policy=${encodeURIComponent(bad)}`,
  ]);
  links.push(...policies.map((policy) => fragment({ ...good, policy })), ...scenarios.map((scenario) => fragment({ ...good, scenario })), ...fragments);
  // Damaged bytes of a good link.
  const whole = fragment(good);
  for (let index = 0; index < 20; index += 1) {
    const bytes = Buffer.from(whole);
    bytes[2 + ((index * 131) % (bytes.length - 2))] = 65 + index;
    links.push(bytes.toString());
  }
  return links;
}
