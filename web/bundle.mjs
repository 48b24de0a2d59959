// Bundles each page's script into one file without imports: `node bundle.mjs DIRECTORY`.
import { build } from "esbuild";

const [directory] = process.argv.slice(2);
await build({
  entryPoints: { report: "src/report/main.ts" },
  outdir: directory,
  bundle: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
});
