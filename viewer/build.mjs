// SPDX-License-Identifier: GPL-3.0-or-later
// Bundles src/ with three.js and puts script and style into page.html: one file without links.
// Usage: node build.mjs OUTPUT. Run in a folder where `npm install` was.
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const output = process.argv[2] ?? "out.html";
const bundle = await build({
  entryPoints: ["src/main.js"],
  bundle: true,
  minify: true,
  format: "iife",
  target: ["es2022"],
  charset: "utf8",
  legalComments: "eof",
  write: false,
});
const script = bundle.outputFiles[0].text.trim();
const style = (
  await build({ entryPoints: ["src/page.css"], minify: true, write: false })
).outputFiles[0].text.trim();
if (/<\/script|<!--/i.test(script)) throw new Error("the script would end its own element");
const template = await readFile("page.html", "utf8");
const page = template.replace("/*style*/", () => style).replace("/*script*/", () => script);
await writeFile(output, page);
