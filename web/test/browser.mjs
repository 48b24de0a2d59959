// What the tests of all pages need: Chromium, pages whose console stays empty, and the key Tab.
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

// A browser that asks for updates would fail in a closed network.
const quiet = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
export const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: quiet });

/** Opens a page, gives it to `use`, and fails on a message of the console. */
export async function open(address, colorScheme, width, use) {
  const context = await browser.newContext({ colorScheme, viewport: { width, height: 1000 } });
  const page = await context.newPage();
  const messages = [];
  page.on("console", (message) => messages.push(message.text()));
  page.on("pageerror", (error) => messages.push(error.message));
  await page.goto(address);
  await use(page);
  assert.deepEqual(messages, [], `${address}, ${colorScheme}, ${width} px`);
  await context.close();
}

/** Checks that a page follows the scheme and fits into the window. */
export async function checkFit(page, colorScheme, width) {
  const { overflow, ground } = await page.evaluate(() => ({
    overflow: document.documentElement.scrollWidth - innerWidth,
    ground: getComputedStyle(document.body).backgroundColor,
  }));
  assert.ok(overflow <= 0, `${page.url()} is ${overflow} px too wide at ${width} px`);
  assert.equal(ground === "rgb(255, 255, 255)", colorScheme === "light", ground);
}

/** Moves the focus by the key Tab until the focused element matches. */
export async function tabTo(page, selector) {
  for (let count = 0; count < 3000; count += 1) {
    await page.keyboard.press("Tab");
    if (await page.evaluate((selector) => document.activeElement?.matches(selector), selector)) {
      return;
    }
  }
  assert.fail(`the key Tab does not reach ${selector}`);
}
