// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D page in Debian's Firefox, which wants a screen for WebGL.
// Usage: SUNDER=build/release/bin/sunder xvfb-run -a node --test firefox_test.js; pictures go to OUT.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import puppeteer from "puppeteer-core";

const root = resolve(import.meta.dirname, "../..");
const sunder = resolve(process.env.SUNDER ?? join(root, "build/release/bin/sunder"));
const out = resolve(process.env.OUT ?? join(root, "out/view"));
const work = mkdtempSync(join(tmpdir(), "sunder-firefox-"));
const inWork = (name) => join(work, name);

let browser, report;

before(async () => {
  mkdirSync(out, { recursive: true });
  const scene = join(root, "data/scenes/window-shot.json");
  const words = ["impact", scene, "-o", inWork("run.html"), "--report", inWork("run.json"), "-q"];
  execFileSync(sunder, words, { stdio: "pipe" });
  report = JSON.parse(readFileSync(inWork("run.json"), "utf8"));
  browser = await puppeteer.launch({
    browser: "firefox",
    executablePath: process.env.FIREFOX ?? "/usr/bin/firefox-esr",
    headless: false,
    timeout: 120000,
  });
});

after(async () => {
  await browser?.close();
  rmSync(work, { recursive: true });
});

// Opens the page, runs the body, and asks that nothing was complained about.
async function withPage(window, body) {
  const page = await browser.newPage();
  const faults = [];
  page.setDefaultTimeout(120000);
  page.on("console", (message) => faults.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => faults.push(`error: ${error.message}`));
  await page.setViewport(window);
  await page.goto(`file://${inWork("run.html")}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  await body(page);
  assert.deepEqual(faults, []);
  await page.close();
}

// A PNG of the canvas, once everything is drawn.
async function shoot(page, name) {
  await new Promise((done) => setTimeout(done, 300));
  await page.waitForFunction(() => document.documentElement.dataset.level === "0");
  const clip = await (await page.$("#view")).boundingBox();
  const picture = await page.screenshot({ clip, path: join(out, `firefox-${name}.png`) });
  return Buffer.from(picture);
}

const textOf = (page, id) => page.$eval(`#${id}`, (element) => element.textContent);
const timeOf = (page) => page.$eval("#time", (input) => Number(input.value));

test("the page opens in Firefox, moves and answers clicks", async () => {
  await withPage({ width: 1000, height: 700 }, async (page) => {
    assert.ok((await textOf(page, "counts")).startsWith(`${report.chunks} chunks`));
    const start = await shoot(page, "start");
    assert.ok(start.length > 20000, `a picture of ${start.length} bytes`);
    await page.focus("#time");
    await page.keyboard.press("End");
    assert.ok((await timeOf(page)) > 0);
    assert.notDeepEqual(await shoot(page, "end"), start);
    await page.keyboard.press("Home");
    assert.deepEqual(await shoot(page, "start"), start);
    const view = await (await page.$("#view")).boundingBox();
    await page.mouse.click(view.x + 0.4 * view.width, view.y + 0.6 * view.height);
    assert.match(await textOf(page, "picked"), /_chunk_/);
    await page.click("#play");
    await page.waitForFunction(() => Number(document.getElementById("time").value) > 0.02);
  });
});

test("it fits a phone in Firefox", async () => {
  await withPage({ width: 390, height: 844 }, async (page) => {
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
    assert.ok((await shoot(page, "phone")).length > 10000);
  });
});
