// Opens the live page of the program in Chromium, light and dark, narrow and wide, and uses it by keyboard alone: `node live.mjs PROGRAM`.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { browser, checkFit, open, tabTo } from "./browser.mjs";
import { serve as serveBy } from "./program.mjs";

const [program] = process.argv.slice(2);
const root = join(import.meta.dirname, "../..");
const scratch = await mkdtemp(join(tmpdir(), "vibrissa-live-"));

const serve = (options, use) => serveBy(program, options, use);

/** The index of the shown tick. */
async function shownTick(page) {
  return Number(await page.inputValue(".slider"));
}

/** Waits until the state of the run matches. */
async function expectStatus(page, pattern) {
  await page.waitForFunction((source) => new RegExp(source).test(document.querySelector(".status").textContent), pattern.source);
}

/** Waits until this tick is shown. */
async function expectTick(page, tick) {
  await page.waitForFunction((tick) => document.querySelector(".time").textContent.endsWith(`tick ${tick}`), tick);
}

const run = ["run", "scenarios/disk.yaml", "--policy", "policies/thesis.fsm", "--simulator", "quasistatic", "--paused", "--break", "Swiping", "--live"];

for (const colorScheme of ["light", "dark"]) {
  for (const width of [400, 1600]) {
    await serve(run, (address) =>
      open(address, colorScheme, width, async (page) => {
        await expectStatus(page, /paused at the start/);
        await page.keyboard.press("p");
        await expectStatus(page, /running/);
        await page.waitForFunction(() => Number(document.querySelector(".slider").value) > 5);
        await page.keyboard.press("p");
        await expectStatus(page, /paused/);
        await checkFit(page, colorScheme, width);
        for (const part of [".scene .whisker", ".scene .objects", ".box.active", ".guards li:not([hidden])", ".plot .strip rect", ".plot .curve", ".figures dd", ".counterfactual input"]) {
          assert.ok((await page.$$(part)).length > 0, `${part} is missing`);
        }
        const strips = await page.$$eval(".plot", (plots) => plots.every((plot) => plot.querySelector(".strip rect")));
        assert.ok(strips, "each plot has the states above it");
      }),
    );
  }
}

await serve(run, async (address) => {
  const size = (await (await fetch(address)).arrayBuffer()).byteLength;
  assert.ok(size <= 500_000, `the page has ${size} bytes`);
  await open(address, "dark", 1600, async (page) => {
    await expectStatus(page, /paused at the start/);
    // A breakpoint of the command line is on the page, and marked in the chart.
    assert.match(await page.textContent(".breakpoints"), /Swiping/);

    // Single steps, by button and by key.
    await tabTo(page, "button[aria-label*='execute one tick']");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.querySelector(".time").textContent !== "");
    let tick = await shownTick(page);
    await page.keyboard.press("s");
    await expectTick(page, tick + 1);

    // The run stops where the breakpoint is.
    await page.keyboard.press("p");
    await expectStatus(page, /paused at Swiping/);
    tick = await shownTick(page);

    // The slider shows the past, and the newest tick on request.
    await tabTo(page, ".slider");
    await page.keyboard.press("ArrowLeft");
    await expectTick(page, tick - 1);
    await page.keyboard.press("[");
    await page.waitForFunction((tick) => Number(document.querySelector(".slider").value) < tick - 1, tick);
    await page.keyboard.press("l");
    await expectTick(page, tick);

    // The chart is shown one level at a time.
    const level = () => page.textContent(".path [aria-current]");
    const deep = await level();
    await page.keyboard.press("u");
    await page.waitForFunction((deep) => document.querySelector(".path [aria-current]").textContent !== deep, deep);
    await tabTo(page, ".box[aria-label*='inner states']");
    const inner = await page.evaluate(() => document.activeElement.getAttribute("aria-label").split(",")[0]);
    await page.keyboard.press("Enter");
    await page.waitForFunction((inner) => document.querySelector(".path [aria-current]").textContent === inner, inner);
    // A state outside of the level, with a dashed frame, leads to the level that has it.
    await tabTo(page, ".box.outside[role=button]");
    const outside = await page.evaluate(() => document.activeElement.getAttribute("aria-label").split(",")[0]);
    await page.keyboard.press("Enter");
    await page.waitForFunction((inner) => document.querySelector(".path [aria-current]").textContent !== inner, inner);
    await page.waitForFunction((outside) => outside.split(" / ").at(-1) === document.activeElement.getAttribute("aria-label")?.split(",")[0], outside);

    // A guard has a distance and a plot.
    await tabTo(page, ".guards button[aria-label^='plot']");
    const plots = (await page.$$(".plot")).length;
    await page.keyboard.press("Enter");
    await page.waitForFunction((plots) => document.querySelectorAll(".plot").length > plots, plots);

    // A guard has a breakpoint.
    await tabTo(page, ".guards button[aria-label*='pause when']");
    const count = (await page.$$(".breakpoints li")).length;
    for (const change of [1, 0]) {
      await page.keyboard.press("Enter");
      await page.waitForFunction((count) => document.querySelectorAll(".breakpoints li").length === count, count + change);
    }

    // A condition becomes a breakpoint. One that cannot be read is explained.
    await tabTo(page, ".add input");
    await page.keyboard.type("no_such_thing > 1");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.querySelector("form.add + p").textContent.includes("no_such_thing"));
    await page.keyboard.press("Control+a");
    await page.keyboard.type("time > 8 s");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.querySelector(".breakpoints").textContent.includes("time > 8 s"));
    await page.keyboard.down("Shift");
    await tabTo(page, "button[aria-label*='remove the breakpoint Swiping']");
    await page.keyboard.up("Shift");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => !document.querySelector(".breakpoints").textContent.includes("Swiping"));

    // A changed parameter shows another run beside this one, in both kinds.
    for (const [kind, name] of [["recorded", "Recorded samples"], ["closed_loop", "Closed loop"]]) {
      await tabTo(page, ".kinds input");
      if ((await page.evaluate(() => document.activeElement.value)) !== kind) {
        await page.keyboard.press("ArrowDown");
      }
      await tabTo(page, ".fields input[type='number']");
      await page.keyboard.press("ArrowUp");
      await page.waitForFunction((name) => document.querySelector(".result .hint").textContent.startsWith(name) && /End at/.test(document.querySelector(".summary").textContent), name);
      assert.ok((await page.$$(".result .strip rect")).length > 1);
    }
  });
});

// The start is drawn before the first tick. A policy has its own plots, and the figures count neither pauses nor wall time.
const policy = join(scratch, "plots.fsm");
await writeFile(policy, `machine plots
whisker r0
type Side = left or right
initial Go
state Go {
  plot bend = |r0.base_angle|
  plot touches = r0.touching
  plot side = if r0.touching then Side.right else Side.left
  record r0
  steer body along direction(body.yaw) at 50 mm/s turning 0 deg/s
  after 15 s -> Success("done")
}
`);
await serve(["run", "scenarios/disk.yaml", "--policy", policy, "--simulator", "quasistatic", "--paused", "--live-speed", "max", "--live"], (address) =>
  open(address, "dark", 1600, async (page) => {
    await expectStatus(page, /paused at the start/);
    await page.waitForFunction(() => {
      const { width, height } = document.querySelector(".scene svg").viewBox.baseVal;
      const isInside = (part) => {
        const box = part.getBBox();
        return box.width + box.height > 5 && box.x >= 0 && box.y >= 0 && box.x + box.width <= width && box.y + box.height <= height;
      };
      const parts = [".objects", ".platform:not(.other)", ".whisker"].map((part) => [...document.querySelectorAll(`.scene ${part}`)]);
      return parts.every((parts) => parts.length > 0 && parts.every(isInside));
    });
    assert.equal(await page.textContent(".time"), "", "no tick is shown");

    /** The text of a figure. */
    const figure = (name) => page.evaluate((name) => [...document.querySelectorAll(".figures div")].find((part) => part.querySelector("dt").textContent === name).querySelector("dd").textContent, name);
    for (const tick of [0, 1]) {
      await page.waitForTimeout(300);
      await page.keyboard.press("s");
      await expectTick(page, tick);
      assert.equal(await figure("period"), "–", "a pause is no period");
    }
    await page.keyboard.press("S");
    await expectTick(page, 31);
    assert.match(await figure("period"), /s$/);
    const guard = await page.textContent(".guards li:not([hidden]) .distance");
    assert.match(guard, /^1\.0\d s of 15 s elapsed$/);

    const plots = await page.$$eval(".plot", (plots) => Object.fromEntries(plots.map((plot) => [plot.querySelector("h3").textContent, [...plot.querySelectorAll("output, .tick")].map(({ textContent }) => textContent)])));
    assert.match(plots["bend"][0], /rad$|^0 rad/);
    assert.ok(["false", "true"].every((name) => plots["touches"].includes(name)) && plots["touches"][0] === "false", String(plots["touches"]));
    assert.ok(["left", "right"].every((name) => plots["side"].includes(name)) && plots["side"][0] === "left", String(plots["side"]));

    await page.keyboard.press("p");
    await expectStatus(page, /finished: .*coverage [\d.]+ %/);
    await page.waitForFunction(() => document.querySelector(".time").textContent.startsWith("15."));
    const coverage = await figure("coverage");
    assert.ok(parseFloat(coverage) > 0 && (await page.textContent(".status")).endsWith(`coverage ${coverage}`), coverage);
  }),
);

// A finished recording can be changed from its first tick on.
const recording = join(scratch, "disk.mcap");
const recorder = spawn(program, ["run", "scenarios/disk.yaml", "--policy", "policies/thesis.fsm", "--simulator", "quasistatic", "--record", recording], { cwd: root, stdio: "ignore" });
await once(recorder, "exit");
await serve(["replay", recording, "--live-speed", "max", "--live"], (address) =>
  open(address, "light", 1600, async (page) => {
    await expectStatus(page, /finished: completed, error .* um, coverage [\d.]+ %/);
    await tabTo(page, ".slider");
    await page.keyboard.press("Home");
    await expectTick(page, 0);
    await tabTo(page, ".fields input[type='number']");
    await page.keyboard.press("ArrowUp");
    await page.waitForFunction(() => /End at/.test(document.querySelector(".summary")?.textContent));
    // The contour and the figures are those of the shown tick.
    await page.keyboard.down("Shift");
    await tabTo(page, ".slider");
    await page.keyboard.up("Shift");
    await page.keyboard.press("End");
    await page.waitForFunction(() => document.querySelector(".scene .contour").getAttribute("d").length > 1000);
  }),
);

await rm(scratch, { recursive: true });
await browser.close();
