// Uses the playground in Chromium: `node playground.mjs PROGRAM FOLDER`. The program serves the folder that `cargo x playground` has built.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { browser, checkFit, open, tabTo } from "./browser.mjs";
import { fragment, hostileLinks } from "./hostile.mjs";
import { checkNewcomer } from "./newcomer.mjs";
import { serve } from "./program.mjs";

const [program, folder] = process.argv.slice(2);

/** The choices of the bar. */
const [SCENE, SPEED] = [".scenes select", ".choices > label:last-child select"];

/** The first lines of an editor. */
const text = (page, name) => page.$$eval(`.cm-content[aria-label="${name}"] .cm-line`, (lines) => lines.slice(0, 20).map((line) => line.textContent).join("\n"));

/** Waits until the score of the run matches. */
const expectVerdict = (page, pattern) => page.waitForFunction((source) => new RegExp(source).test(document.querySelector(".verdict")?.textContent ?? ""), pattern.source);

/** Replaces the text of the policy. */
async function write(page, policy) {
  await page.focus('.cm-content[aria-label="policy"]');
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText(policy);
}

const still = (scenario) => ({ scenario, policy: "machine still  initial Still  state Still { stop }\n", set: {} });

await serve(program, ["playground", folder], async (address) => {
  await checkNewcomer(address);

  for (const colorScheme of ["light", "dark"]) {
    for (const width of [400, 1600]) {
      await open(address, colorScheme, width, async (page) => {
        await expectVerdict(page, /^completed/);
        await page.waitForFunction(() => document.querySelectorAll(".score tbody tr").length === 3);
        await checkFit(page, colorScheme, width);
        for (const part of [".scene .whisker", ".scene .contour", ".box", ".guards li", ".plot .curve", ".parameters input", ".cm-gutters", ".t-keyword"]) {
          assert.ok((await page.$$(part)).length > 0, `${part} is missing`);
        }
        // What screen readers say: every part that can be focused, and every picture, has a name.
        const { nodes } = await (await page.context().newCDPSession(page)).send("Accessibility.getFullAXTree");
        const isFocusable = ({ properties = [] }) => properties.some(({ name, value }) => name === "focusable" && value.value);
        const named = nodes.filter((node) => !node.ignored && node.role.value !== "generic" && (isFocusable(node) || ["image", "img"].includes(node.role.value)));
        assert.ok(named.length > 40);
        assert.deepEqual(named.filter(({ name }) => !name?.value).map(({ role }) => role.value), []);
        // By keyboard alone: the key Tab reaches every control.
        await page.$$eval("details", (parts) => parts.forEach((part) => { part.open = true; }));
        await page.waitForFunction(() => document.querySelectorAll(".shapes .handle").length > 0);
        await page.evaluate(() => { document.activeElement.blur(); document.body.prepend(Object.assign(document.createElement("div"), { id: "start", tabIndex: -1 })); document.getElementById("start").focus(); });
        for (let count = 0; count < 600; count += 1) {
          await page.keyboard.press("Escape");
          await page.keyboard.press("Tab");
          if (await page.evaluate(() => document.activeElement === document.body || document.activeElement.dataset.reached === "")) {
            break;
          }
          await page.evaluate(() => { document.activeElement.dataset.reached = ""; });
        }
        const missed = await page.$$eval("button, input, select, summary, .cm-content, [tabindex='0']", (parts) =>
          parts.filter((part) => part.checkVisibility() && !part.disabled && part.dataset.reached === undefined && !(part.type === "radio" && !part.checked)).map((part) => part.outerHTML));
        assert.deepEqual(missed, []);
      });
    }
  }

  await open(address, "light", 1600, async (page) => {
    await expectVerdict(page, /^completed/);
    await page.waitForFunction(() => document.querySelectorAll(".score tbody tr").length === 3);
    const others = await page.$$eval(".score tbody tr", (rows) => rows.map((row) => [...row.cells].slice(1).map((cell) => cell.textContent).join(" ")));
    assert.equal(others[0], others[1], "the same policy has the same figures");

    // By keyboard: run, pause, step and stop. In real time, so that the run is not over before.
    await page.selectOption(SPEED, "0");
    await page.keyboard.press("Control+Enter");
    await page.waitForFunction(() => document.querySelector(".status").dataset.state === "running");
    await page.focus(".slider");
    await page.keyboard.press("p");
    await page.waitForFunction(() => document.querySelector(".status").dataset.state === "paused");
    const paused = Number(await page.inputValue(".slider"));
    await page.keyboard.press("s");
    await page.waitForFunction((tick) => Number(document.querySelector(".slider").value) === tick + 1, paused);
    await page.keyboard.press("p");
    await tabTo(page, ".bar .tools button:nth-child(2)");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.querySelector(".status").textContent.includes("stopped"));
    await page.selectOption(SPEED, "2");

    // Diagnostics while typing, and a policy that does not compile is refused in words.
    await write(page, "machine m\n\nwhisker r0\n\ninitial A\n\nstate A { stop  when r0.tuching -> B }\n");
    await page.waitForFunction(() => /^[1-9]\d* error/.test(document.querySelector(".problems").textContent));
    assert.ok((await page.$$(".cm-lintRange-error")).length > 0);
    await page.keyboard.press("Control+Enter");
    await page.waitForFunction(() => document.querySelector("pre.fault").textContent.includes("error[P"));

    // Completion, hover texts and the formatter.
    await write(page, "machine m\n\nwhisker r0\n\ninitial A\n\nstate A { stop  when r0.touching -> Failure(\"x\") }\n\nlet bend(w: whisker) = w.base_");
    await page.keyboard.press("Control+Space");
    await page.waitForSelector(".cm-tooltip-autocomplete");
    assert.ok((await page.textContent(".cm-tooltip-autocomplete")).includes("base_angle"));
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => !document.querySelector(".cm-tooltip-autocomplete"));
    await page.hover(".cm-line:nth-child(7) .t-keyword");
    await page.waitForSelector(".cm-tooltip .hover");
    await write(page, "machine m   initial A state A {stop}\n");
    await page.waitForFunction(() => document.querySelector(".problems").textContent.startsWith("0 errors"));
    await page.click('.bar >> text="format"');
    await page.waitForFunction(() => document.querySelectorAll('.cm-content[aria-label="policy"] .cm-line').length > 3);

    // The steps.
    for (let step = 1; step <= 5; step += 1) {
      await page.selectOption(SPEED, "3");
      await page.click(`.lessons .head button:nth-child(${step})`);
      await page.click(".lessons >> text=solution");
      await page.waitForFunction(() => document.querySelector(".lesson-verdict")?.textContent === "Done.");
    }

    // Downloads.
    for (const [name, start] of [["policy", "machine"], ["scenario", "#"], ["result", "{"], ["picture", "<svg"]]) {
      const [saved] = await Promise.all([page.waitForEvent("download"), page.click(`.tools >> text="${name}"`)]);
      assert.ok((await readFile(await saved.path(), "utf8")).startsWith(start), name);
    }

    // A policy whose run would take for ever in a scene is stopped.
    await write(page, still("").policy);
    await page.selectOption(SPEED, "0");
    await page.click(".bar .primary");
    await page.waitForFunction(() => document.querySelector(".status").dataset.state === "running");
    await page.click('.bar >> text="stop"');
    await page.waitForFunction(() => document.querySelector(".status").textContent.includes("stopped"));
  });

  // Scenes of the zoo and of families, each of which runs.
  await open(address, "light", 1600, async (page) => {
    await expectVerdict(page, /^completed/);
    await page.selectOption(SPEED, "3");
    const titled = (pattern) => page.waitForFunction((source) => new RegExp(source).test(document.querySelector(".title h2").textContent), pattern.source);
    for (const [scene, title] of [["zoo/star5", /^star5/], ["family rooms", /^rooms-0/], ["family shapes", /^shapes-0/]]) {
      await page.selectOption(SCENE, scene);
      await titled(title);
      await page.waitForFunction(() => document.querySelectorAll(".scene .whisker").length > 0 && Number(document.querySelector(".slider").max) > 10);
      assert.equal(await page.textContent("pre.fault"), "");
    }
    await page.click(".scenes button");
    await titled(/^shapes-1/);
    assert.equal(await page.inputValue(SCENE), "family shapes");
  });

  // Shapes by mouse and by keyboard, at both widths.
  for (const width of [400, 1600]) {
    await open(address, "light", width, async (page) => {
      await expectVerdict(page, /^completed/);
      await write(page, still("").policy);
      await page.click(".shapes > summary");
      const handles = page.locator(".shapes .handle");
      const expectCount = (count) => page.waitForFunction((count) => document.querySelectorAll(".shapes .handle").length === count, count);
      const place = (index) => handles.nth(index).getAttribute("aria-label");
      await expectCount(2);
      const before = await place(0);
      await handles.nth(0).focus();
      await page.keyboard.press("ArrowUp");
      await page.waitForFunction((before) => document.querySelector(".shapes .handle").getAttribute("aria-label") !== before, before);
      assert.equal(await place(0), "place of object 1, circle: 400 mm, 410 mm");
      assert.ok(await handles.nth(0).evaluate((handle) => handle === document.activeElement), "the handle keeps the focus");
      // By mouse: the disk smaller, then another one, and a polygon.
      const centre = async (index) => {
        await page.locator(".shapes svg").scrollIntoViewIfNeeded();
        const { x, y, width, height } = await handles.nth(index).boundingBox();
        return [x + width / 2, y + height / 2];
      };
      const drag = async ([x, y], [right, down]) => {
        await page.mouse.move(x, y);
        await page.mouse.down();
        await page.mouse.move(x + right, y + down, { steps: 4 });
        await page.mouse.up();
      };
      const radius = await place(1);
      await drag(await centre(1), [-30, 0]);
      await page.waitForFunction((radius) => document.querySelectorAll(".shapes .handle")[1].getAttribute("aria-label") !== radius, radius);
      await page.click(".shapes >> text=add disk");
      // The last handle is the rim of the first disk.
      const beside = async (right, down) => {
        const [x, y] = await centre((await handles.count()) - 1);
        return [x + right, y + down];
      };
      await drag(await beside(20, -70), [10, 0]);
      await expectCount(4);
      await page.click(".shapes >> text=add polygon");
      const [x, y] = await beside(0, 70);
      for (const [right, down] of [[0, 0], [20, 0], [20, 20]]) {
        await page.mouse.click(x + right, y + down);
      }
      await page.focus(".shapes svg");
      await page.keyboard.press("Enter");
      await expectCount(7);
      assert.match(await place(0), /^corner 1 of object 1, polygon/);
      await handles.nth(0).focus();
      await page.keyboard.press("Delete");
      await expectCount(4);
      assert.equal(await page.inputValue(SCENE), "own");
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(overflow <= 0, `shapes are ${overflow} px too wide at ${width} px`);
    });
  }

  // The book's listings open in the playground, and each is a policy. Some are for a rig with other whiskers, which the page says.
  const docs = join(import.meta.dirname, "../../docs");
  const pages = ["", "howto/"].flatMap((folder) => readdirSync(join(docs, folder)).filter((name) => name.endsWith(".md")).map((name) => folder + name));
  const texts = await Promise.all(pages.map((name) => readFile(join(docs, name), "utf8")));
  const listings = texts.flatMap((text) => [...text.matchAll(/^```fsm\n(.*?)^```/gms)].map(([, listing]) => listing));
  assert.ok(listings.length > 20);
  let links = [];
  await open("about:blank", "light", 1600, async (page) => {
    await page.route("**/book.html", (route) => route.fulfill({ contentType: "text/html", body: "<link rel=icon href=data:,><script>const path_to_root = ''</script>" }));
    await page.route("**/playground/index.html", (route) => route.fulfill({ contentType: "text/html", body: "" }));
    await page.goto(`${address}book.html`);
    await page.evaluate((listings) => {
      for (const listing of listings) {
        const code = Object.assign(document.createElement("code"), { className: "language-fsm", textContent: listing });
        document.body.append(document.createElement("pre"));
        document.body.lastElementChild.append(code);
      }
    }, listings);
    await page.addScriptTag({ content: await readFile(join(docs, "try-it.js"), "utf8") });
    await page.waitForSelector(".try-it");
    links = await page.$$eval(".try-it", (links) => links.map((link) => link.href));
  });
  assert.equal(links.length, listings.length);
  await open(address, "light", 1600, async (page) => {
    for (const [index, link] of links.entries()) {
      await page.goto("about:blank");
      await page.goto(address + new URL(link).hash);
      await page.waitForFunction(() => (document.querySelector("pre.fault")?.textContent ?? "") !== "" || document.querySelector(".status")?.dataset.state === "running" || document.querySelector(".verdict")?.textContent);
      assert.match(await page.textContent("pre.fault"), /^$|^the rig has no whisker/, listings[index]);
    }
    console.log(`${links.length} listings of the book`);
  });

  // A link holds everything.
  await open(address, "light", 1600, async (page) => {
    await expectVerdict(page, /^completed/);
    const slider = page.locator(".parameters input[type=range]").first();
    await slider.focus();
    await page.keyboard.press("ArrowRight");
    await page.click('.bar >> text="copy link"');
    await page.waitForFunction(() => location.hash.length > 100);
    const [link, before, value] = [page.url(), await text(page, "policy"), await slider.inputValue()];
    await open(link, "light", 1600, async (other) => {
      await expectVerdict(other, /^completed/);
      assert.equal(await text(other, "policy"), before);
      assert.equal(await other.locator(".parameters input[type=range]").first().inputValue(), value);
    });
  });

  // Hostile links: nothing in them runs, becomes markup, leaves the page, or makes it useless.
  const scene = await readFile(join(import.meta.dirname, "../../scenarios/disk.yaml"), "utf8");
  await open(address, "light", 1600, async (page) => {
    await expectVerdict(page, /^completed/);
    const requests = [];
    page.on("request", (request) => requests.push(request.url()));
    page.on("dialog", (dialog) => assert.fail(dialog.message()));
    // The editor itself puts empty pictures beside marks.
    const parts = () => page.evaluate(() => document.querySelectorAll("script, style, iframe, img:not(.cm-widgetBuffer), object, embed, a[href], base").length);
    const count = await parts();
    const links = hostileLinks(scene);
    assert.ok(links.length >= 100);
    for (const [index, link] of links.entries()) {
      await page.goto("about:blank");
      await page.goto(address + link);
      // It runs, is refused in words, or is stopped.
      await page.waitForFunction(() => ["pre.fault", ".notice", ".verdict"].some((part) => (document.querySelector(part)?.textContent ?? "") !== "") || document.querySelector(".status")?.dataset.state === "running", undefined, { timeout: 20_000 });
      assert.equal(await page.evaluate(() => window.hacked), undefined, `link ${index}`);
      assert.equal(await parts(), count, `link ${index}`);
      assert.equal(page.url().split("#")[0], address, `link ${index}`);
      assert.equal(await page.evaluate(() => Object.keys({ ...Object.prototype }).length), 0, `link ${index}`);
    }
    assert.deepEqual(requests.filter((request) => !request.startsWith(address) && !request.startsWith("blob:") && !request.startsWith("about:")), []);
    // What a link says is shown as what it is.
    await page.goto("about:blank");
    await page.goto(address + links[0]);
    await page.waitForFunction(() => document.querySelector(".verdict")?.textContent.includes("<img src=x onerror=hacked=1>"));
    // The page still works.
    await page.click(".lessons .head button:nth-child(1)");
    await page.click(".lessons >> text=solution");
    await page.waitForFunction(() => document.querySelector(".lesson-verdict")?.textContent === "Done.");
    console.log(`${links.length} hostile links`);
  });
});
await browser.close();
