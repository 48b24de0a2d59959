// Bundles each page's script and style sheet into one file each, without imports: `node bundle.mjs DIRECTORY`. The playground has a
// folder of its own: `node bundle.mjs DIRECTORY playground`.
import { copyFile } from "node:fs/promises";
import { join } from "node:path";
import { build } from "esbuild";

const [directory, only] = process.argv.slice(2);
const pages = only === undefined ? ["report", "live"] : [only];
const entries = pages.flatMap((page) => [
  { in: `src/${page}/main.ts`, out: page },
  { in: `src/${page}/page.css`, out: page },
]);
if (only === "playground") {
  entries.push({ in: "src/playground/worker.ts", out: "worker" });
}
await build({
  entryPoints: entries,
  outdir: directory,
  bundle: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  // The others are read in changes of `web/dist`.
  minify: only === "playground",
});
if (only === "playground") {
  await copyFile("src/playground/index.html", join(directory, "index.html"));
}
