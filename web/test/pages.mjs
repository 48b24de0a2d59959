// Opens reports in Chromium, light and dark, narrow and wide, and uses them by keyboard alone: `node pages.mjs BENCH SWEEP`.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";
import { browser, checkFit, open, tabTo } from "./browser.mjs";

const [bench, sweep] = process.argv.slice(2).map((path) => pathToFileURL(path).href);

for (const address of [bench, sweep]) {
  for (const colorScheme of ["light", "dark"]) {
    for (const width of [400, 1600]) {
      await open(address, colorScheme, width, (page) => checkFit(page, colorScheme, width));
    }
  }
}

await open(bench, "light", 1600, async (page) => {
  // A heading sorts its column in both directions.
  await tabTo(page, "thead th:nth-child(5) button");
  for (const sign of [1, -1]) {
    await page.keyboard.press("Enter");
    const errors = await page.$$eval("tbody td:nth-child(5)", (cells) => cells.map((cell) => parseFloat(cell.textContent)));
    const numbers = errors.filter((error) => !Number.isNaN(error));
    assert.ok(numbers.length > 1 && numbers.every((error, index) => index === 0 || sign * (error - numbers[index - 1]) >= 0), String(errors));
  }
  // The exported table has the columns that do not fit too.
  await page.keyboard.down("Shift");
  await tabTo(page, "button[aria-label*='as CSV']");
  await page.keyboard.up("Shift");
  const [saved] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
  const lines = (await readFile(await saved.path(), "utf8")).trim().split("\r\n");
  const rows = await page.$$eval("tbody tr", (rows) => rows.length);
  assert.ok(lines.length === rows + 1 && lines[0].startsWith("scene,policy,outcome") && lines[0].includes("sim s"), lines[0]);
  // Arrows move through the tip estimates of a figure, and a figure can be enlarged and exported.
  await tabTo(page, ".drawing");
  await page.keyboard.press("ArrowRight");
  assert.match(await page.textContent(".note"), /mm · [\d.]+ s · \w+/);
  const whole = await page.getAttribute(".drawing svg", "viewBox");
  await page.keyboard.press("+");
  assert.notEqual(await page.getAttribute(".drawing svg", "viewBox"), whole);
  await page.keyboard.press("0");
  assert.equal(await page.getAttribute(".drawing svg", "viewBox"), whole);
  const [figure] = await Promise.all([page.waitForEvent("download"), page.click("button[aria-label*='as SVG']")]);
  const svg = await readFile(await figure.path(), "utf8");
  assert.ok(svg.startsWith("<svg") && svg.includes('xmlns="http://www.w3.org/2000/svg"') && !svg.includes("overlay"));
  // A printed page has no picture of a hatched area, which would make it a hundred times as large.
  const pdf = await page.pdf();
  assert.ok(pdf.length < 10_000_000, `${pdf.length} bytes`);
});

await open(sweep, "dark", 1600, async (page) => {
  // A cell of a heat map opens its runs.
  await tabTo(page, ".heat td a");
  const target = await page.evaluate(() => document.activeElement.getAttribute("href"));
  await page.keyboard.press("Enter");
  assert.ok(await page.isVisible(`${target} table`));
});

await browser.close();
