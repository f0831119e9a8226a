// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D page with a run of 30,000 chunks in Debian's Chromium, drawn by the processor: how soon it
// is there, what a frame costs, how long the page ever stands still. Usage: SUNDER=… node view_bench.js
import { execFileSync } from "node:child_process";
import {
  appendFileSync,
  mkdtempSync,
  readFileSync,
  rmSync,
  statSync,
  writeFileSync,
} from "node:fs";
import { loadavg, tmpdir } from "node:os";
import { join } from "node:path";
import { launch, openPage } from "../tests/viewer/browser.js";

const kScene = {
  sunder: 1,
  seed: 7,
  walls: [
    {
      name: "wall",
      outline: { rect: [9, 6] },
      thickness: 0.2,
      material: "concrete-c30",
      pattern: { type: "voronoi-grid", cell: 0.0424 },
      anchors: ["bottom", "left", "right"],
    },
  ],
  projectiles: [
    { name: "ball", radius: 0.25, mass: 514, position: [4.5, 3, 0.6], velocity: [0, 0, -20] },
  ],
  simulation: { duration: 0.5 },
};
const kWindows = [
  { name: "phone", width: 390, height: 844 },
  { name: "desktop", width: 1280, height: 800 },
];
const kPlayed = 8000; // ms
const kBlock = "view page";

const work = mkdtempSync(join(tmpdir(), "sunder-view-bench-"));
const inWork = (name) => join(work, name);
const sunder = (...words) => execFileSync(process.env.SUNDER, words, { stdio: "pipe" });
const quantile = (values, q) =>
  [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(q * values.length))];

// Processor seconds of all of Chromium's processes.
async function processorTime(chromium) {
  chromium.session ??= await chromium.browser.newBrowserCDPSession();
  const { processInfo } = await chromium.session.send("SystemInfo.getProcessInfo");
  return processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0);
}

const dataOf = (page) => page.evaluate(() => ({ ...document.documentElement.dataset }));

// The longest time that the page's thread was busy in one go since the last call, ms.
async function longestTask(page) {
  await page.waitForTimeout(300);
  return page.evaluate(() => Math.max(0, ...tasks.splice(0)));
}

async function open(chromium, file, window) {
  const page = await openPage(chromium, file, { ...window, waits: false, observes: true });
  page.setDefaultTimeout(300000);
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  const data = await dataOf(page);
  return {
    page,
    rows: {
      "unpacked, s": data.unpack / 1000,
      "read into buffers, s": data.read / 1000,
      "first picture, s": data.first / 1000,
      "all is drawn, s": data.ready / 1000,
      "longest task while it opens, ms": await longestTask(page),
      "draw calls": data.calls,
      triangles: data.triangles,
      "vertices, lists, textures, MB": data.bytes / 1e6,
      "script's memory, MB": await page.evaluate(() => performance.memory.usedJSHeapSize / 1e6),
    },
  };
}

// Every step of the run, one a frame.
async function seek(chromium, page) {
  const before = await processorTime(chromium);
  const { script, clock } = await page.evaluate(async () => {
    const script = [],
      input = document.getElementById("time"),
      start = performance.now();
    for (let i = 0; i <= 120; ++i) {
      const begin = performance.now();
      input.value = (i / 120) * Number(input.max);
      input.dispatchEvent(new Event("input"));
      const jump = performance.now() - begin;
      await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
      script.push(jump + Number(document.documentElement.dataset.frame));
    }
    return { script, clock: (performance.now() - start) / script.length };
  });
  const used = (await processorTime(chromium)) - before;
  return {
    "script of a frame, median, ms": quantile(script, 0.5),
    "script of a frame, p95, ms": quantile(script, 0.95),
    "whole frame, all steps one by one, ms": clock,
    "the same, processor time, ms": (1000 * used) / script.length,
    "longest task meanwhile, ms": await longestTask(page),
  };
}

async function play(page) {
  await page.locator("#rate").selectOption("0.02");
  await page.locator("#time").press("Home");
  await page.waitForTimeout(1000);
  await longestTask(page);
  const first = await dataOf(page);
  await page.click("#play");
  await page.waitForTimeout(kPlayed);
  const last = await dataOf(page);
  await page.click("#play");
  return {
    "frames a second while it plays": (1000 * (last.frames - first.frames)) / kPlayed,
    "triangles of such a frame": last.triangles,
    "longest task meanwhile, ms ": await longestTask(page),
  };
}

// Clicks on chunks, the timeline dragged, the camera turned.
async function handle(page) {
  const view = await page.locator("#view").boundingBox();
  for (let i = 0; i < 5; ++i) {
    await page.mouse.click(view.x + (0.3 + 0.1 * i) * view.width, view.y + 0.5 * view.height);
    await page.waitForTimeout(200);
  }
  const clicked = await longestTask(page);
  const drag = async (box, height) => {
    await page.mouse.move(box.x + 0.2 * box.width, box.y + height);
    await page.mouse.down();
    for (let i = 0; i < 30; ++i)
      await page.mouse.move(box.x + (0.2 + 0.02 * i) * box.width, box.y + height);
    await page.mouse.up();
  };
  const track = await page.locator("#time").boundingBox();
  await drag(track, track.height / 2);
  const scrubbed = await longestTask(page);
  await drag(view, view.height / 2);
  return {
    "longest task: clicks on chunks, ms": clicked,
    "dragging the timeline, ms": scrubbed,
    "turning the camera, ms": await longestTask(page),
  };
}

async function measure(chromium, window) {
  const { page, rows } = await open(chromium, inWork("run.html"), window);
  Object.assign(rows, await seek(chromium, page), await play(page), await handle(page));
  await page.context().close();
  return rows;
}

const short = (value) => {
  const number = Number(value);
  return number >= 100 ? number.toFixed(0) : String(Number(number.toPrecision(2)));
};

function save(results) {
  const folder = process.env.SUNDER_BENCH_RESULTS;
  if (!folder) return;
  const machine =
    /model name.*: (.*)/.exec(readFileSync("/proc/cpuinfo", "utf8"))?.[1] ?? "unknown";
  const tail = `${process.env.SUNDER_BENCH_COMMIT ?? "unknown"},"${machine}",${new Date().toISOString().slice(0, 10)}`;
  const file = join(folder, "bench/view-page.csv");
  writeFileSync(file, "what,window,value,commit,machine,date\n");
  results.forEach((rows, i) => {
    for (const [what, value] of Object.entries(rows))
      appendFileSync(file, `"${what.trim()}",${kWindows[i].name},${Number(value)},${tail}\n`);
  });
}

writeFileSync(inWork("scene.json"), JSON.stringify(kScene));
sunder(
  "impact",
  inWork("scene.json"),
  "-o",
  inWork("run.glb"),
  "--report",
  inWork("run.json"),
  "-q",
);
sunder("view", inWork("run.glb"), "-o", inWork("run.html"), "-q");
const { chunks, chunks_freed: freed } = JSON.parse(readFileSync(inWork("run.json"), "utf8"));
const megabytes = (name) => (statSync(inWork(name)).size / 1e6).toFixed(1);
const sizes = `GLB ${megabytes("run.glb")} MB, page ${megabytes("run.html")} MB`;
const chromium = await launch();
try {
  const load = loadavg()[0];
  const results = [];
  for (const window of kWindows) results.push(await measure(chromium, window));
  const version = chromium.browser.version().split(".")[0];
  console.log(`\n<!-- bench: ${kBlock} -->`);
  console.log(
    `A wall of ${chunks} chunks, ${freed} of them set free; ${sizes}; Chromium ${version}, SwiftShader; ` +
      `load of the machine before it began: ${load.toFixed(1)}.\n`,
  );
  console.log(`| | ${kWindows.map((w) => `${w.name}, ${w.width} × ${w.height}`).join(" | ")} |`);
  console.log(`|---|${"---|".repeat(kWindows.length)}`);
  for (const what of Object.keys(results[0]))
    console.log(`| ${what.trim()} | ${results.map((rows) => short(rows[what])).join(" | ")} |`);
  console.log("<!-- end -->");
  save(results);
} finally {
  await chromium.browser.close();
  rmSync(work, { recursive: true });
}
