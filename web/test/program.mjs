// Programs that serve a page.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";

/** Starts a program in the checkout, gives the address of its page to `use`, and ends it. */
export async function serve(program, options, use) {
  const child = spawn(program, options, { cwd: join(import.meta.dirname, "../.."), stdio: ["ignore", "pipe", "pipe"] });
  const exit = once(child, "exit");
  let output = "";
  const address = new Promise((resolve, reject) => {
    for (const stream of [child.stdout, child.stderr]) {
      stream.on("data", (data) => {
        output += data;
        const found = /http:\/\/\S+/.exec(output);
        if (found && /\s/.test(output[found.index + found[0].length] ?? "")) {
          resolve(found[0]);
        }
      });
    }
    child.on("exit", () => reject(new Error(`${options.join(" ")} ended: ${output}`)));
  });
  try {
    await use(await address);
  } catch (error) {
    console.error(output);
    throw error;
  } finally {
    child.kill();
    await exit;
  }
}
