// What a newcomer meets in the playground: the first view, a slow computer, the steps and their verdicts, and the editor.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { browser, open } from "./browser.mjs";

/** The choice of the speed, and the editor of the policy. */
const [SPEED, POLICY] = [".choices > label:last-child select", '.cm-content[aria-label="policy"]'];

const content = (page, selector) => page.$eval(selector, (part) => part.textContent);
const expect = (page, selector, text) => page.waitForFunction(([selector, text]) => document.querySelector(selector)?.textContent === text, [selector, text]);
const expectVerdict = (page, start) => page.waitForFunction((start) => document.querySelector(".verdict")?.textContent.startsWith(start), start);

/** Replaces the text of the policy. */
async function write(page, policy) {
  await page.focus(POLICY);
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText(policy);
}

export async function checkNewcomer(address) {
  await checkFirstView(address);
  await checkSlow(address);
  await checkVerdicts(address);
  await checkCheats(address);
  await checkEditor(address);
  await checkOwn(address);
  await checkShapes(address);
  await checkParts(address);
}

/** Before any script has run, the page says what it is. */
async function checkFirstView(address) {
  const context = await browser.newContext({ javaScriptEnabled: false });
  const page = await context.newPage();
  await page.goto(address);
  const body = await page.locator("main").innerText();
  assert.match(body, /^Vibrissa playground\n[^]*You write its policy\. Start with step 1\.[^]*are loading/);
  await context.close();
}

/** A worker that is slow to load is waited for. One that does not answer is ended, and a run starts another one. */
async function checkSlow(address) {
  await open("about:blank", "light", 1600, async (page) => {
    await page.addInitScript(() => {
      window.looks = [];
      window.setInterval = (look) => window.looks.push(look);
      window.workers = 0;
      const Real = window.Worker;
      window.Worker = class extends Real {
        constructor(address) {
          super(address);
          window.workers += 1;
        }
        postMessage(message) {
          if (!(window.isMute && message.type === "start")) {
            super.postMessage(message);
          }
        }
      };
    });
    const look = () => page.evaluate(() => Array.from({ length: 60 }).forEach(() => window.looks.forEach((look) => look())));
    let load = () => undefined;
    const held = new Promise((resolve) => { load = resolve; });
    await page.route("**/vibrissa.wasm", async (route) => {
      await held;
      await route.continue();
    });
    await page.goto(address);
    await page.waitForFunction(() => window.looks.length > 0);
    await look();
    load();
    await expectVerdict(page, "completed");
    await page.evaluate(() => { window.isMute = true; });
    await page.click(".bar .primary");
    await look();
    await expect(page, ".notice", "The simulation took too long to start. Press run to try again.");
    await page.evaluate(() => { window.isMute = false; });
    await page.keyboard.press("Control+Enter");
    await page.waitForFunction(() => document.querySelector(".status").dataset.state === "running" && document.querySelector(".notice").textContent === "");
    assert.equal(await page.evaluate(() => window.workers), 2);
  });
}

/** Verdicts are of the shown step and of the present text, and say what is missing in the words of the page. */
async function checkVerdicts(address) {
  await open(address, "light", 1600, async (page) => {
    await expectVerdict(page, "completed");
    await page.selectOption(SPEED, "3");
    await page.click(".lessons .primary");
    await expectVerdict(page, "timeout: the loop did not close within 120 s. Not met: there is no mean error, because nothing was recorded; coverage is 0 %");
    assert.equal(await content(page, ".lesson-verdict"), "", "the first run is not one of the reader");
    await page.click(".bar .primary");
    await expect(page, ".lesson-verdict", "Not yet: the outcome is timeout (the loop did not close within 120 s); the run has to end within 5 s (it took 120 s).");
    // The run of this step is still going on when the next one is shown.
    await page.selectOption(SPEED, "0");
    await page.click(".bar .primary");
    await page.selectOption(SPEED, "3");
    await page.click(".lessons .head button:nth-child(3)");
    await expectVerdict(page, "failed: lost the object. Not met: coverage is 13.559 %, expected at least 95 %. Simulated");
    assert.equal(await content(page, ".lesson-verdict"), "");
    await page.click(".bar .primary");
    await expect(page, ".lesson-verdict", "Not yet: the outcome is failed (lost the object); the coverage has to be at least 95 % (now 13.6 %).");
    // A text with an error has no verdict, no result, and its own name.
    await write(page, "machine other\n\ninitial A\n\nstate A { stop  when r9.touching -> A }\n");
    await expect(page, ".score .own .name", "this policy (from the previous text)");
    await page.waitForFunction(() => /^error in line 5: /.test(document.querySelector(".listed li")?.textContent ?? ""));
    await page.click(".bar .primary");
    await page.waitForFunction(() => document.querySelector("pre.fault").textContent.includes("error[P"));
    assert.equal(await content(page, ".notice"), "This run cannot begin. What you see is still the one before.");
    assert.equal(await page.evaluate(() => document.querySelector("pre.fault").previousElementSibling.className), "listed");
    assert.equal(await content(page, ".lesson-verdict"), "");
    assert.ok(await page.isDisabled('.tools >> text="result"'));
    const [saved] = await Promise.all([page.waitForEvent("download"), page.click('.tools >> text="policy"')]);
    assert.equal(saved.suggestedFilename(), "other.fsm");
    assert.ok((await readFile(await saved.path(), "utf8")).startsWith("machine other"));
    // Errors of both figures and tasks are in one unit.
    await page.click(".lessons .head button:nth-child(4)");
    await expect(page, ".score .own .name", "this policy");
    await page.click(".bar .primary");
    await expect(page, ".lesson-verdict", "Not yet: the run has to end within 30 s (it took 54.7 s).");
  });
}

/** A step is not done by another task, or in another scene. */
async function checkCheats(address) {
  await open(address, "light", 1600, async (page) => {
    await expectVerdict(page, "completed");
    await page.selectOption(SPEED, "3");
    await page.click(".lessons .primary");
    await write(page, 'machine mine\n\ninitial A\n\nstate A {\n  stop\n  after 1 s -> Success("time")\n}\n');
    await page.click(".bar .primary");
    await expect(page, ".lesson-verdict", "Not yet: the run must not end before 3.7 s (it ended after 1.03 s).");
    await page.click(".lessons .head button:nth-child(5)");
    await page.click(".lessons >> text=solution");
    await expect(page, ".lesson-verdict", "Done.");
    await page.selectOption(".scenes select", { label: "disk" });
    await expect(page, ".lesson-verdict", "Not yet: the scene has to be box.");
  });
}

/** What the reader has written comes back after a reload, and after a look at another policy. */
async function checkOwn(address) {
  await open(address, "light", 1600, async (page) => {
    const written = 'machine written\n\ninitial A\n\nstate A {\n  stop\n  after 1 s -> Success("time")\n}\n';
    const shown = () => page.$$eval(`${POLICY} .cm-line`, (lines) => lines.map((line) => line.textContent).join("\n"));
    await expectVerdict(page, "completed");
    // Nothing is before the first text.
    await page.focus(POLICY);
    await page.keyboard.press("Control+z");
    assert.match(await shown(), /^(#|machine)/);
    await write(page, written);
    await page.selectOption(".choices > label:nth-last-child(2) select", "0");
    await page.waitForFunction(() => !document.querySelector('.cm-content[aria-label="policy"]').textContent.includes("machine written"));
    await page.selectOption(".choices > label:nth-last-child(2) select", { label: "own" });
    assert.equal(await shown(), written);
    await page.reload();
    await expectVerdict(page, "ended");
    assert.equal(await shown(), written);
    assert.equal(await content(page, ".notice"), "This is your policy of the last visit. The list of policies has the others.");
    const [saved] = await Promise.all([page.waitForEvent("download"), page.click('.tools >> text="result"')]);
    assert.deepEqual(JSON.parse(await readFile(await saved.path(), "utf8")).set, {});
  });
}

/** Ctrl+Z in the drawing takes back what was moved there. A text that is no breakpoint is refused beside its field. */
async function checkShapes(address) {
  await open(address, "light", 1600, async (page) => {
    await expectVerdict(page, "completed");
    await page.$eval(".shapes", (part) => { part.open = true; });
    const place = (start) => page.waitForFunction((start) => document.querySelector(".shapes .handle")?.getAttribute("aria-label").includes(start), start);
    await place("400 mm, 400 mm");
    await page.focus(".shapes .handle");
    await page.keyboard.press("ArrowRight");
    await place("410 mm, 400 mm");
    await page.keyboard.press("Control+z");
    await place("400 mm, 400 mm");
    await page.keyboard.press("Control+y");
    await place("410 mm, 400 mm");
    await page.fill('[aria-label="state or condition of a new breakpoint"]', "<b>nonsense");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => /^this is no breakpoint/.test([...document.querySelectorAll("form.add + p")].map((part) => part.textContent).join()));
  });
}

/** The editor indents, leaves no brace behind, says its keys, and warnings are in the page. */
async function checkEditor(address) {
  await open(address, "light", 1600, async (page) => {
    await expectVerdict(page, "completed");
    await write(page, "machine m\n\ninitial A\n\n");
    for (const line of ["state A {", "stop", "when time > 1 s -> B", "}", "state B {", "if true {", "stop", "}", "}"]) {
      await page.keyboard.type(line);
      // A proposal would take the key Enter.
      await page.keyboard.press("Escape");
      await page.keyboard.press("Enter");
    }
    const lines = await page.$$eval(`${POLICY} .cm-line`, (lines) => lines.map((line) => line.textContent.trimEnd()).join("\n"));
    assert.equal(lines, "machine m\n\ninitial A\n\nstate A {\n  stop\n  when time > 1 s -> B\n}\nstate B {\n  if true {\n    stop\n  }\n}\n");
    await page.waitForFunction(() => [...document.querySelectorAll(".listed li")].some(({ textContent }) => textContent.startsWith("warning in line")));
    const { ring, keys } = await page.$eval(POLICY, (part) => ({ ring: getComputedStyle(part).outline, keys: document.getElementById(part.getAttribute("aria-describedby"))?.textContent }));
    assert.match(ring, /solid 2px/);
    assert.equal(keys, "Tab indents; Esc, then Tab leaves. Ctrl+Enter runs.");
    await page.focus(".statechart .box[role]");
    assert.match(await page.$eval(".statechart .box[role]", (box) => getComputedStyle(box).outline), /solid 2px/);
  });
}

/** Headings, tables, pictures, names and sizes of all parts, in a narrow window. */
async function checkParts(address) {
  await open(address, "light", 400, async (page) => {
    await expectVerdict(page, "completed");
    await page.waitForFunction(() => document.querySelectorAll(".score tbody tr").length === 3);
    await page.$$eval("details", (parts) => parts.forEach((part) => { part.open = true; }));
    assert.deepEqual(await page.$$eval("h1", (parts) => parts.map((part) => part.textContent)), ["Vibrissa playground"]);
    assert.ok(await page.$eval(".score .table", (box) => box.scrollWidth <= box.clientWidth), "the score is cut");
    const { bare, misnamed, small, names } = await page.evaluate(() => {
      const seen = (selector) => [...document.querySelectorAll(selector)].filter((part) => part.checkVisibility());
      return {
        bare: [...seen("svg:not([aria-hidden], [aria-label])"), ...seen("table:not(:has(caption))")].map((part) => part.outerHTML.slice(0, 200)),
        misnamed: seen("button[aria-label]").filter((part) => /[\p{L}\p{N}]/u.test(part.textContent) && !part.ariaLabel.startsWith(part.textContent)).map((part) => part.outerHTML),
        small: seen("button, select, summary, input:not([type=radio], [type=checkbox])").filter((part) => part.getBoundingClientRect().height < 24).map((part) => part.outerHTML),
        names: [...document.querySelector(".scenes select").options].map(({ text }) => text),
      };
    });
    assert.deepEqual([bare, misnamed, small], [[], [], []]);
    assert.equal(new Set(names).size, names.length, "each scene has a name of its own");
  });
}
