// Properties of the parts of the pages that need no browser: `node test/units.mjs`.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import test from "node:test";
import { build } from "esbuild";

/** A module of a page. */
async function load(name, page = "live") {
  const { outputFiles } = await build({ entryPoints: [`src/${page}/${name}.ts`], bundle: true, format: "esm", write: false });
  return import(`data:text/javascript,${encodeURIComponent(outputFiles[0].text)}`);
}

const [{ Run }, { layOut }, { quantity }] = await Promise.all(["run", "layout", "quantity"].map((name) => load(name)));
const { subjects } = await load("subjects");
const { statusText } = await load("controls");
const { csv } = await load("cells", "report");
const example = JSON.parse(await readFile("test/live-example.json", "utf8"));
const hello = example.find(({ type }) => type === "hello");
const [pattern] = example.find(({ type }) => type === "ticks").frames;

/** Ticks with one recorded tip each, whose position is the number of the tick. */
function ticks(from, to) {
  const contour = (tick) => [{ whisker: 0, point: [tick, 0], spread: null, error: null }];
  return Array.from({ length: to - from }, (_, index) => ({ ...pattern, tick: from + index, time: (from + index) / 30, contour: contour(from + index) }));
}

test("a long run is thinned, and keeps all cells of its map", () => {
  const run = new Run(hello);
  const cells = (tick) => ({ cell: 0.005, origin: [0, 0], free: [[tick, 0, 1]], blocked: [[tick, 2, 2]], route: [], target: null });
  for (let from = 0; from < 120_000; from += 3000) {
    run.add(ticks(from, from + 3000).map((frame) => ({ ...frame, map: frame.tick % 15 === 0 ? cells(frame.tick) : null })));
  }
  const expected = Array.from({ length: 8000 }, (_, index) => 15 * index);
  for (const kind of ["free", "blocked"]) {
    assert.deepEqual(run.history.frames.flatMap(({ map }) => (map?.[kind] ?? []).map(([row]) => row)), expected);
  }
});

test("every tick that was left out is asked for once, the newest ones first", () => {
  const run = new Run(hello);
  run.add(ticks(4000, 4010));
  run.add(ticks(4100, 4110));
  run.expect(4200);
  const asked = [];
  for (let range = run.request(); range !== undefined; range = run.request()) {
    assert.equal(run.request(), undefined, "one answer is expected");
    asked.push(range);
    run.fill(ticks(...range));
  }
  assert.ok(asked.every(([from], index) => index === 0 || asked[index - 1][0] > from), String(asked));
  assert.deepEqual(run.history.frames.map(({ tick }) => tick), Array.from({ length: 4200 }, (_, tick) => tick));
});

test("a run has finished only when all of its past is loaded", () => {
  const run = new Run(hello);
  const status = { ...example.find(({ state }) => state === "finished"), verdict: "completed", reason: null, metrics: null };
  run.expect(1501);
  const [from, to] = run.request();
  assert.equal(statusText(status, run.past), "loading the past: 0 of 1501 ticks");
  run.fill(ticks(from, to));
  assert.equal(statusText(status, run.past), `loading the past: ${to - from} of 1501 ticks`);
  assert.equal(statusText({ ...status, state: "running" }, run.past), "running");
  run.fill(ticks(...run.request()));
  assert.equal(statusText(status, run.past), "finished: completed");
});

test("what rounding leaves of an angle is 0, and a number without a unit is shown as it is", () => {
  assert.equal(quantity(-3.77e-131, "rad"), "0 rad");
  assert.equal(quantity(1e-12, "rad"), "1.00e-6 urad");
  assert.equal(quantity(1e-20, ""), "1.00e-20");
});

test("a long run is thinned, and keeps its newest ticks and every recorded tip", () => {
  const run = new Run(hello);
  for (let from = 0; from < 120_000; from += 3000) {
    run.add(ticks(from, from + 3000));
  }
  const { frames } = run.history;
  assert.ok(frames.length <= 40_000, String(frames.length));
  assert.deepEqual(frames.slice(-3000).map(({ tick }) => tick), ticks(117_000, 120_000).map(({ tick }) => tick));
  assert.deepEqual(frames.flatMap(({ contour }) => contour.map(({ point }) => point[0])), Array.from({ length: 120_000 }, (_, tick) => tick));
});

test("a value of a plot that was set in one tick is kept while a long run is thinned", () => {
  const run = new Run(hello);
  const single = [1, 1000, 30_001];
  for (let from = 0; from < 120_000; from += 3000) {
    run.add(ticks(from, from + 3000).map((frame) => ({ ...frame, plots: [single.includes(frame.tick) ? frame.tick : null] })));
  }
  assert.deepEqual(run.history.frames.flatMap(({ plots: [value] }) => (value === null ? [] : [value])), single);
});

test("the plots of a policy have their units, and a value without a quantity has its name", () => {
  const plots = [{ name: "bend", unit: "rad", choices: [] }, { name: "touches", unit: "", choices: ["false", "true"] }];
  const added = subjects(new Run({ ...hello, plots })).filter(({ title }) => plots.some(({ name }) => name === title));
  assert.deepEqual(added.map(({ unit, choices }) => [unit, choices]), plots.map(({ unit, choices }) => [unit, choices]));
  const frame = { ...pattern, plots: [0.1, null] };
  assert.deepEqual(added.map(({ series: [{ value }] }) => value(frame)), [0.1, null]);
});

test("the nearest tick of a time is found, and states are joined to spans without a gap", () => {
  const run = new Run(hello);
  const states = (tick) => (tick < 10 ? [0] : tick < 15 ? [1, 2] : [1, 3]);
  run.add(ticks(0, 20).map((frame) => ({ ...frame, states: states(frame.tick) })));
  assert.equal(run.history.nearest(7.4 / 30).tick, 7);
  assert.equal(run.history.nearest(7.6 / 30).tick, 8);
  assert.deepEqual(run.history.spans.map(({ state, from, to }) => [state, Math.round(from * 30), Math.round(to * 30)]), [[0, 0, 10], [2, 10, 15], [3, 15, 19]]);
});

test("boxes of a level do not overlap, fit into the width, and have all arrows between them", () => {
  // Thirty states in each of two levels, with arrows by a fixed rule.
  const count = 30;
  const states = Array.from({ length: 2 * count }, (_, index) => ({ name: `Name${"x".repeat(index % 9)}${index}`, parent: index < count ? null : 0, initial: index % count === 0, behaviour: null }));
  const transitions = states.flatMap((_, state) => [3, 7].map((step) => ({ state, target: (state * step + 1) % states.length, end: null, guard: null, text: "" })));
  const { chart } = new Run({ ...hello, chart: { states, transitions } });
  for (const level of [chart.root, chart.nodes[0]]) {
    for (const width of [360, 700]) {
      const arrows = chart.arrows(level);
      const { boxes, curves, height } = layOut(level, arrows, width);
      assert.equal(curves.length, arrows.length);
      assert.ok(level.children.every((child) => boxes.some(({ item }) => item === child)));
      boxes.forEach((a, index) => {
        assert.ok(a.x >= 0 && a.x + a.width <= width && a.y >= 0 && a.y + a.height <= height, JSON.stringify(a.x));
        const overlapping = boxes.slice(index + 1).filter((b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height);
        assert.equal(overlapping.length, 0);
      });
    }
  }
});

test("a transition from inside a state is one of that state, unless it stays inside", () => {
  const { chart } = new Run(hello);
  const shown = (level) => chart.arrows(level).map(({ from, to, transitions }) => `${from.name}>${to.name ?? to} ${transitions.length}`);
  assert.deepEqual(shown(chart.root), ["Exploring>Along 1", "Along>Retrieve 3"]);
  assert.deepEqual(shown(chart.nodes[1]), ["Turn>Straight 1", "Straight>Retrieve 1"]);
});

test("quantities have prefixes and three digits", () => {
  const cases = [[0.00054, "rad", "540 urad"], [0.05, "m/s", "50 mm/s"], [Math.PI / 6, "rad", "30 deg"], [-Math.PI / 3, "rad/s", "-60 deg/s"], [-0.0123456, "m", "-12.3 mm"], [0, "s", "0 s"], [12.345, "s", "12.3 s"], [30, "", "30"], [0.002, "m^2", "0.002 m^2"], [0.5, "1/m", "0.5 1/m"], [0.128, "", "0.128"], [0.0009999, "m", "1 mm"]];
  for (const [value, unit, text] of cases) {
    assert.equal(quantity(value, unit), text);
  }
});

test("no cell of an exported table is evaluated by a spreadsheet, and figures stay as they are", () => {
  for (const text of ["=cmd|' /C calc'!A0", "+1+cmd", "-2+3", "@SUM(A1)", "\t=1", "-x", "=1", "+", "-0.5 mm=1"]) {
    const cell = csv({ headings: [text], rows: [] }).trimEnd().replace(/^"|"$/g, "");
    assert.ok(cell.startsWith("'"), JSON.stringify(cell));
  }
  for (const text of ["-0.5", "+0.4 ± 0.24", "-12.5 %", "+3", "-1e-5", "-0.5 mm", "0.031 ± 0.002", "disk"]) {
    assert.equal(csv({ headings: [text], rows: [] }), `${text}\r\n`);
  }
});
