// Compares runs of the playground's module with those of the program: `node bits.mjs PROGRAM FOLDER`. Every number of every tick and of
// every result has to have the same bits.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";

const [program, folder] = process.argv.slice(2);
const { instance: { exports } } = await WebAssembly.instantiate(await readFile(join(folder, "vibrissa.wasm")));

/** The answer of the module to a request. */
function ask(request) {
  const bytes = Buffer.from(JSON.stringify(request));
  const address = exports.reserve(bytes.length);
  Buffer.from(exports.memory.buffer, address, bytes.length).set(bytes);
  const length = exports.answer();
  const answer = JSON.parse(Buffer.from(exports.memory.buffer, exports.answered(), length).toString());
  assert.equal(answer?.error, undefined);
  return answer;
}

/** The ticks and the result of a run in the module. */
function inModule(scenario, policy) {
  ask({ type: "start", scenario, policy });
  while (!ask({ type: "advance", ticks: 500, frames: false }).has_ended) {}
  const { lines } = ask({ type: "ticks" });
  return { ticks: lines.map((line) => JSON.parse(line)), result: ask({ type: "score" }).result };
}

/** The ticks and the result of a run of the program. */
async function inProgram(scenario, policy, file) {
  const options = ["run", scenario, "--policy", policy, "--simulator", "quasistatic", "--json", "--ticks", file];
  let output;
  try {
    output = execFileSync(program, options, { stdio: ["ignore", "pipe", "pipe"] });
  } catch (fault) {
    // An expectation of the scenario does not hold.
    assert.equal(fault.status, 1, String(fault.stderr));
    output = fault.stdout;
  }
  const ticks = (await readFile(file, "utf8")).trimEnd().split("\n").map((line) => JSON.parse(line));
  return { ticks, result: JSON.parse(output)[0] };
}

/** The keys of what belongs to the program and its computer: how it was made, and times of the computer. */
const OWN = ["provenance", "start_s", "wall_s", "realtime", "tick_us"];

/** A document without what belongs to the program and its computer. */
function common(document) {
  return Object.fromEntries(Object.entries(document).filter(([key]) => !OWN.includes(key)));
}

const directory = await mkdtemp(join(tmpdir(), "bits-"));
try {
  const { scenarios, policies } = ask({ type: "catalog" });
  const bench = scenarios.filter(({ name }) => !name.includes("/"));
  assert.ok(bench.length >= 10 && policies.length >= 2);
  const hash = createHash("sha256");
  let count = 0;
  for (const scenario of bench) {
    for (const policy of policies) {
      const own = inModule(scenario.text, policy.text);
      const other = await inProgram(scenario.name, policy.name, join(directory, "ticks.jsonl"));
      const name = `${policy.name} in ${scenario.name}`;
      assert.equal(own.ticks.length, other.ticks.length, name);
      own.ticks.forEach((tick, index) => assert.deepStrictEqual(common(tick), common(other.ticks[index]), `tick ${index} of ${name}`));
      assert.deepStrictEqual(common(own.result), common(other.result), name);
      hash.update(JSON.stringify([own.ticks.map(common), common(own.result)]));
      count += own.ticks.length;
    }
  }
  console.log(`${count} ticks of ${bench.length} scenes and ${policies.length} policies have the same bits (${hash.digest("hex").slice(0, 16)})`);
} finally {
  await rm(directory, { recursive: true });
}
