// Bundles each page's script and style sheet into one file each, without imports: `node bundle.mjs DIRECTORY`.
import { build } from "esbuild";

const [directory] = process.argv.slice(2);
await build({
  entryPoints: ["report", "live"].flatMap((page) => [
    { in: `src/${page}/main.ts`, out: page },
    { in: `src/${page}/page.css`, out: page },
  ]),
  outdir: directory,
  bundle: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
});
