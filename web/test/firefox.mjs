// Runs the playground in Firefox, narrow and wide: `node firefox.mjs PROGRAM FOLDER FIREFOX`. With a fourth word, pictures are written into
// that folder. Firefox is driven by Marionette, which needs no other program: https://firefox-source-docs.mozilla.org/testing/marionette.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { serve } from "./program.mjs";

const [program, folder, firefox, pictures] = process.argv.slice(2);

/** Longer than any step takes here. */
const PATIENCE = 120_000;

/** Asks until the answer is true. */
async function until(ask, what) {
  for (const end = Date.now() + PATIENCE; Date.now() < end; await sleep(100)) {
    const answer = await ask();
    if (answer) {
      return answer;
    }
  }
  return assert.fail(`in vain: ${what}`);
}

/** Starts Firefox, gives a function that sends it a command to `use`, and ends it. */
async function drive(use) {
  const profile = await mkdtemp(join(tmpdir(), "firefox-"));
  // Firefox chooses a free port, and writes what pages say to the console.
  const settings = { "marionette.port": 0, "devtools.console.stdout.content": true };
  await writeFile(join(profile, "user.js"), Object.entries(settings).map(([name, value]) => `user_pref("${name}", ${value});\n`).join(""));
  const child = spawn(firefox, ["--headless", "--no-remote", "--marionette", "--profile", profile], { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, HOME: profile } });
  const exit = once(child, "exit");
  let said = "";
  for (const stream of [child.stdout, child.stderr]) {
    stream.on("data", (data) => { said += data; });
  }
  try {
    const port = Number(await until(() => readFile(join(profile, "MarionetteActivePort"), "utf8").catch(() => ""), `start of ${firefox}: ${said}`));
    const socket = connect(port, "127.0.0.1");
    await once(socket, "connect");
    const command = commands(socket);
    await use(command);
    // Texts of pages are in quotation marks. Those of Firefox itself are not.
    assert.deepEqual(said.split("\n").filter((line) => /^console\.\w+: ["({]|^JavaScript error: http/.test(line)), []);
    await command("Marionette:Quit", { flags: ["eForceQuit"] });
    socket.destroy();
  } finally {
    child.kill();
    await exit;
    await rm(profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

/** Messages are `LENGTH:[0,id,name,parameters]`, and answers `LENGTH:[1,id,error,result]`. */
function commands(socket) {
  const waiting = new Map();
  let received = Buffer.alloc(0);
  let last = 0;
  socket.on("data", (data) => {
    received = Buffer.concat([received, data]);
    for (;;) {
      const colon = received.indexOf(":");
      const end = colon + 1 + Number(received.subarray(0, colon).toString());
      if (colon < 0 || received.length < end) {
        return;
      }
      const message = JSON.parse(received.subarray(colon + 1, end).toString());
      received = received.subarray(end);
      // The first message is a greeting.
      if (Array.isArray(message)) {
        const [, id, error, result] = message;
        const { resolve, reject } = waiting.get(id);
        waiting.delete(id);
        error ? reject(new Error(error.message)) : resolve(result);
      }
    }
  });
  return (name, parameters = {}) => new Promise((resolve, reject) => {
    last += 1;
    waiting.set(last, { resolve, reject });
    const message = JSON.stringify([0, last, name, parameters]);
    socket.write(`${Buffer.byteLength(message)}:${message}`);
  });
}

await serve(program, ["playground", folder], (address) => drive(async (command) => {
  const { capabilities } = await command("WebDriver:NewSession");
  const script = async (text) => (await command("WebDriver:ExecuteScript", { script: text, args: [] })).value;
  const ends = () => until(() => script('return /^completed/.test(document.querySelector(".verdict")?.textContent ?? "") && document.querySelectorAll(".score tbody tr").length === 3;'), "a completed run with the scores beside it");
  // A window of Firefox has at least 500 pixels.
  for (const width of [500, 1600]) {
    await command("WebDriver:SetWindowRect", { width, height: 1000 });
    await command("WebDriver:Navigate", { url: address });
    await ends();
    for (const part of [".scene .whisker", ".scene .contour", ".box", ".guards li", ".plot .curve", ".parameters input", ".cm-gutters", ".t-keyword"]) {
      assert.ok(await script(`return document.querySelectorAll("${part}").length > 0;`), `${part} is missing`);
    }
    const overflow = await script("return document.documentElement.scrollWidth - innerWidth;");
    assert.ok(overflow <= 0, `the page is ${overflow} px too wide at ${width} px`);
    // What the page shows at first is the run of a built-in policy, whose figures stand beside it.
    const [own, other] = await script('return [...document.querySelectorAll(".score tbody tr")].map((row) => [...row.cells].slice(1).map((cell) => cell.textContent).join(" "));');
    assert.equal(own, other);
    if (pictures !== undefined) {
      const { value } = await command("WebDriver:TakeScreenshot", { full: true });
      await writeFile(join(pictures, `firefox-${width}.png`), Buffer.from(value, "base64"));
    }
  }
  console.log(`Firefox ${capabilities.browserVersion} runs and scores`);
}));
