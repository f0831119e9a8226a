// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's Chromium with pages from files, and what their pictures show.
import { chromium } from "playwright-core";

const kFlags = [
  "--no-sandbox",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--disable-background-networking",
  "--disable-component-update",
];

export async function launch() {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: kFlags,
  });
  const painter = await browser.newPage();
  return { browser, painter };
}

// Lengths of all tasks over 50 ms, in `tasks`.
function collectTasks() {
  globalThis.tasks = [];
  new PerformanceObserver((list) =>
    list.getEntries().forEach(({ duration }) => tasks.push(duration)),
  ).observe({ type: "longtask", buffered: true });
}

/** A page that is open and drawn; `faults` collects what it should not do; `observes`: see above. */
export async function openPage(
  { browser },
  path,
  {
    query = "",
    width = 1280,
    height = 800,
    scale = 1,
    scheme = "light",
    waits = true,
    observes = false,
  } = {},
) {
  const context = await browser.newContext({
    viewport: { width, height },
    deviceScaleFactor: scale,
    colorScheme: scheme,
    offline: true,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(60000);
  if (observes) await page.addInitScript(collectTasks);
  const faults = [];
  page.on("console", (message) => faults.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => faults.push(`error: ${error.message}`));
  page.on("request", (request) =>
    request.url().startsWith("file:") && !faults.opened
      ? (faults.opened = true)
      : faults.push(`request: ${request.url().slice(0, 90)}`),
  );
  await page.goto(
    `file://${encodeURI(path).replaceAll("?", "%3F").replaceAll("#", "%23")}${query}`,
  );
  if (waits) await page.waitForFunction(() => document.documentElement.dataset.ready);
  return Object.assign(page, { faults });
}

/** A PNG of the canvas, or of all, after everything asked for is drawn in full. */
export async function shoot(page, { all = false, path } = {}) {
  await page.evaluate(
    () =>
      new Promise((done) =>
        requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 60))),
      ),
  );
  await page.waitForFunction(() => document.documentElement.dataset.level === "0");
  const clip = all ? undefined : await page.locator("#view").boundingBox();
  return page.screenshot({ clip, path });
}

/** Of two PNGs: share of pixels that differ by more than 12 of 255 in a channel. */
export function difference({ painter }, a, b) {
  return compare(painter, [a, b], "difference");
}

/** Of one PNG: how many colours there are, its mean brightness, share of pixels that are mostly blue. */
export function describe({ painter }, png) {
  return compare(painter, [png], "describe");
}

function compare(painter, pngs, what) {
  return painter.evaluate(
    async ({ pngs, what }) => {
      const images = await Promise.all(
        pngs.map(async (png) => {
          const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
          const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
          const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
          context.drawImage(bitmap, 0, 0);
          return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
        }),
      );
      const [a, b] = images;
      if (what === "difference") {
        let count = 0;
        for (let i = 0; i < a.length; i += 4)
          if (
            Math.max(
              Math.abs(a[i] - b[i]),
              Math.abs(a[i + 1] - b[i + 1]),
              Math.abs(a[i + 2] - b[i + 2]),
            ) > 12
          )
            ++count;
        return count / (a.length / 4);
      }
      const colours = new Set();
      let light = 0,
        blue = 0,
        red = 0;
      for (let i = 0; i < a.length; i += 4) {
        colours.add((a[i] << 16) | (a[i + 1] << 8) | a[i + 2]);
        light += a[i] + a[i + 1] + a[i + 2];
        if (a[i + 2] > 110 && a[i + 2] > 1.9 * a[i] && a[i + 2] > 1.6 * a[i + 1]) ++blue;
        if (a[i] > 110 && a[i] > 1.9 * a[i + 1] && a[i] > 1.9 * a[i + 2]) ++red;
      }
      const pixels = a.length / 4;
      return {
        colours: colours.size,
        light: light / (3 * pixels),
        blue: blue / pixels,
        red: red / pixels,
      };
    },
    { pngs: pngs.map((png) => png.toString("base64")), what },
  );
}
