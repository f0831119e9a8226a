// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D page in Debian's Chromium, with real clicks and keys, and pictures that are compared.
// Usage: SUNDER=build/release/bin/sunder node --test page_test.js; pictures go to OUT.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { describe, difference, launch, openPage, shoot } from "./browser.js";
import { addRun, moveAll, readGlb, writeGlb } from "./glb.js";

const root = resolve(import.meta.dirname, "../..");
const sunder = resolve(process.env.SUNDER ?? join(root, "build/release/bin/sunder"));
const out = resolve(process.env.OUT ?? join(root, "out/view"));
const work = mkdtempSync(join(tmpdir(), "sunder-view-"));
const inWork = (name) => join(work, name);
const run = (...words) =>
  execFileSync(sunder, words, { stdio: ["ignore", "pipe", "pipe"] }).toString();

const kWall = {
  sunder: 1,
  seed: 7,
  walls: [
    {
      name: "wall",
      outline: { rect: [4, 2.5] },
      thickness: 0.2,
      material: "concrete-c30",
      anchors: ["bottom", "left", "right"],
      pattern: { type: "voronoi-grid", cell: 0.25 },
    },
  ],
  projectiles: [
    { name: "ball", radius: 0.3, mass: 800, position: [1.8, 1.4, 1], velocity: [0, 0, -10] },
  ],
  simulation: { duration: 1 },
};
const kFrame = {
  sunder: 1,
  seed: 7,
  building: {
    posts: [3, 3],
    storeys: 3,
    storey_height: 3.5,
    bay: [6, 6],
    post_section: "HEB300",
    beam_section: "IPE300",
    steel: "s235",
    slab: { thickness: 0.15, material: "concrete-c30" },
    live_load: 2000,
  },
  scenario: { remove: ["post_2_2_0", "post_1_2_0", "post_2_1_0"] },
  simulation: { duration: 1 },
};

let chromium, wall, frame;

before(async () => {
  mkdirSync(out, { recursive: true });
  writeFileSync(inWork("wall.json"), JSON.stringify(kWall));
  run(
    "impact",
    inWork("wall.json"),
    "-o",
    inWork("wall.glb"),
    "--report",
    inWork("report.json"),
    "-q",
  );
  run("view", inWork("wall.glb"), inWork("report.json"), "-o", inWork("wall.html"), "-q");
  wall = {
    ...readGlb(readFileSync(inWork("wall.glb"))),
    report: JSON.parse(readFileSync(inWork("report.json"), "utf8")),
  };
  writeFileSync(inWork("frame.json"), JSON.stringify(kFrame));
  run("collapse", inWork("frame.json"), "-o", inWork("frame.glb"), "-q");
  frame = readGlb(readFileSync(inWork("frame.glb")));
  frame.run = addRun(frame, {
    utilisation: (j, time) => 0.3 + (j % 7) / 10 + time / 50,
    broken: (j) => (j % 3 === 0 ? 0.5 : null),
  });
  writeFileSync(inWork("frame.glb"), writeGlb(frame));
  run("view", inWork("frame.glb"), "-o", inWork("frame.html"), "-q");
  chromium = await launch();
});

after(async () => {
  await chromium?.browser.close();
  rmSync(work, { recursive: true });
});

// Opens a page, runs the body, and asks that nothing was complained about or loaded.
async function withPage(name, options, body) {
  const page = await openPage(chromium, inWork(name), options);
  try {
    await body(page);
    assert.deepEqual([...page.faults], []);
  } finally {
    await page.context().close();
  }
}

const timeOf = async (page) => Number(await page.locator("#time").inputValue());

test("a page opens from a file, shows its chunks and loads nothing", async () => {
  await withPage("wall.html", {}, async (page) => {
    assert.match(
      await page.locator("#counts").textContent(),
      new RegExp(`^${wall.report.chunks} chunks · 1 projectile · 1\\.00 s$`),
    );
    assert.equal(await page.locator("#name").textContent(), "wall.glb");
    const { colours } = await describe(
      chromium,
      await shoot(page, { path: join(out, "wall-start.png") }),
    );
    assert.ok(colours > 200, `${colours} colours`);
  });
});

test("the scrubber moves the scene, and back to the same picture", async () => {
  await withPage("wall.html", {}, async (page) => {
    const start = await shoot(page);
    const track = await page.locator("#time").boundingBox();
    await page.mouse.click(track.x + 0.5 * track.width, track.y + track.height / 2);
    assert.ok(Math.abs((await timeOf(page)) - 0.5) < 0.02);
    const middle = await shoot(page, { path: join(out, "wall-middle.png") });
    assert.ok((await difference(chromium, start, middle)) > 0.02);
    await page.keyboard.press("Home");
    assert.equal(await timeOf(page), 0);
    assert.ok((await difference(chromium, start, await shoot(page))) < 1e-4);
  });
});

test("keys step through the run as it was computed", async () => {
  await withPage("wall.html", {}, async (page) => {
    const times = [];
    for (let i = 0; i < 3; ++i)
      (await page.keyboard.press("ArrowRight"), times.push(await timeOf(page)));
    assert.deepEqual(
      times.map((t) => Math.round(t * 240)),
      [1, 2, 3],
    );
    await page.keyboard.press("Shift+ArrowRight");
    assert.equal(Math.round((await timeOf(page)) * 240), 13);
    await page.keyboard.press("End");
    assert.ok(Math.abs((await timeOf(page)) - 1) < 1e-6);
  });
});

test("play runs, slow motion is slower, a second click stops", async () => {
  await withPage("wall.html", {}, async (page) => {
    await page.locator("#rate").selectOption("0.1");
    await page.click("#play");
    await page.waitForFunction(() => Number(document.getElementById("time").value) > 0.02);
    await page.click("#play");
    const stopped = await timeOf(page);
    assert.ok(stopped < 0.9, `slow motion came to ${stopped} s`);
    await page.waitForTimeout(200);
    assert.equal(await timeOf(page), stopped);
    await page.locator("#rate").selectOption("2");
    await page.locator("#view").focus();
    await page.keyboard.press("Space");
    await page.waitForFunction(() => Number(document.getElementById("time").value) >= 1);
  });
});

test("every colour changes the picture; what the file has not is out of reach", async () => {
  await withPage("wall.html", { query: "?t=0.3" }, async (page) => {
    const shots = { material: await shoot(page) };
    for (const mode of ["chunk", "size", "speed"]) {
      await page.locator(`label:has(#mode-${mode})`).click();
      shots[mode] = await shoot(page, { path: join(out, `wall-${mode}.png`) });
    }
    assert.ok(await page.locator("#mode-utilisation").isDisabled());
    const names = Object.keys(shots);
    for (let i = 0; i < names.length; ++i)
      for (let k = i + 1; k < names.length; ++k)
        assert.ok(
          (await difference(chromium, shots[names[i]], shots[names[k]])) > 0.1,
          `${names[i]} and ${names[k]}`,
        );
    await page.keyboard.press("1");
    assert.ok(await page.locator("#mode-material").isChecked());
    assert.ok((await difference(chromium, shots.material, await shoot(page))) < 1e-3);
  });
});

test("explode, wireframe, edges, outer faces, graph and shadows are to be seen", async () => {
  await withPage("wall.html", {}, async (page) => {
    const plain = await shoot(page);
    for (const [id, least] of [
      ["wireframe", 0.05],
      ["edges", 0.01],
      ["outer", 0.05],
      ["graph", 0.01],
      ["shadows", 0.01],
    ]) {
      await page.locator(`label:has(#toggle-${id})`).click();
      const changed = await difference(
        chromium,
        plain,
        await shoot(page, { path: join(out, `wall-${id}.png`) }),
      );
      assert.ok(changed > least, `${id} changes ${changed}`);
      await page.locator(`label:has(#toggle-${id})`).click();
    }
    assert.ok((await difference(chromium, plain, await shoot(page))) < 1e-3);
    const slider = await page.locator("#explode").boundingBox();
    await page.mouse.click(slider.x + 0.4 * slider.width, slider.y + slider.height / 2);
    assert.ok(
      (await difference(
        chromium,
        plain,
        await shoot(page, { path: join(out, "wall-exploded.png") }),
      )) > 0.05,
    );
  });
});

// A picture with what is left out and one with everything: exploded, if only by a millionth.
async function comparePictures(name, time) {
  const drawn = [];
  for (const explode of ["0", "1e-6"])
    await withPage(name, { query: `?t=${time}&explode=${explode}` }, async (page) => {
      const picture = await shoot(page, { path: join(out, `all-${explode}-${time}.png`) });
      const triangles = await page.evaluate(() => document.documentElement.dataset.triangles);
      drawn.push({ picture, triangles: Number(triangles) });
    });
  const [some, all] = drawn;
  return {
    changed: await difference(chromium, some.picture, all.picture),
    share: some.triangles / all.triangles,
  };
}

test("what is out of sight is not drawn, and not missed", async () => {
  for (const time of [0, 0.06, 0.5]) {
    const { changed, share } = await comparePictures("wall.html", time);
    assert.ok(changed < 1e-3, `at ${time} s ${changed} of the picture differs`);
    assert.ok(share < 0.9, `${share} of the triangles`);
  }
  const late = readGlb(readFileSync(inWork("wall.glb")));
  moveAll(late);
  writeFileSync(inWork("late.glb"), writeGlb(late));
  run("view", inWork("late.glb"), "-o", inWork("late.html"), "-q");
  const { changed } = await comparePictures("late.html", 0);
  assert.ok(changed < 1e-3, `${changed} of what moves later differs`);
});

test("a click on a chunk shows its numbers, on nothing clears them", async () => {
  await withPage("wall.html", {}, async (page) => {
    const view = await page.locator("#view").boundingBox();
    await page.mouse.click(view.x + view.width / 2, view.y + view.height / 2);
    await page.locator("#selection").waitFor();
    const name = await page.locator("#picked").textContent();
    const node = wall.json.nodes.find((n) => n.name === name);
    assert.ok(node, name);
    const text = await page.locator("#numbers").textContent();
    assert.ok(text.includes(`mass${Number(node.extras.sunder.mass.toPrecision(3))} kg`), text);
    await shoot(page, { all: true, path: join(out, "wall-picked.png") });
    await page.mouse.click(view.x + 30, view.y + view.height - 20);
    await page.locator("#selection").waitFor({ state: "hidden" });
  });
});

test("a building's ends of members show what their joints bear, blue where one is broken", async () => {
  await withPage("frame.html", { query: "?colour=utilisation" }, async (page) => {
    const start = await describe(
      chromium,
      await shoot(page, { path: join(out, "frame-start.png") }),
    );
    await page.locator("#view").focus();
    await page.keyboard.press("End");
    const end = await describe(
      chromium,
      await shoot(page, { all: true, path: join(out, "frame-end.png") }),
    );
    assert.ok(end.blue > start.blue + 2e-4, `${start.blue} ${end.blue}`);
  });
});

test("charts follow the scrubber, and a click on one goes there", async () => {
  await withPage("frame.html", {}, async (page) => {
    const titles = await page.locator("#charts figcaption b").allTextContents();
    assert.deepEqual(titles, ["Broken joints", "Largest utilisation", "Energy"]);
    assert.equal(await page.locator("#missing").textContent(), "");
    const count = page.locator("#charts figure").first().locator("output");
    assert.equal(await count.textContent(), "0");
    const chart = await page.locator("#charts canvas").first().boundingBox();
    await page.mouse.click(chart.x + 0.75 * chart.width, chart.y + 20);
    assert.ok(
      Math.abs((await timeOf(page)) - 0.75 * (await page.locator("#time").getAttribute("max"))) <
        0.02,
    );
    assert.equal(await count.textContent(), String(Math.ceil(frame.run.names.length / 3)));
    assert.match(await page.locator("#charts").textContent(), /kinetic 56\.\d kJ/);
  });
});

test("a click on a joint shows what it bears and when it breaks", async () => {
  await withPage("frame.html", { query: "?t=0.25" }, async (page) => {
    await page.keyboard.press("g");
    assert.ok(await page.locator("#toggle-graph").isChecked());
    const view = await page.locator("#view").boundingBox();
    // The nearest corner is in the middle: up along its post there must be a joint.
    let text = "";
    for (let y = 0.9; y > 0.2 && !text.includes("joint"); y -= 0.01) {
      await page.mouse.click(view.x + 0.544 * view.width, view.y + y * view.height);
      await page.waitForTimeout(30);
      text = await page.locator("#numbers").textContent();
    }
    assert.match(text, /kindjoint/);
    const index = frame.run.names.indexOf(await page.locator("#picked").textContent());
    assert.ok(index >= 0);
    assert.ok(text.includes(index % 3 === 0 ? "at 0.500 s" : "not in this run"), text);
    await shoot(page, { all: true, path: join(out, "frame-joint.png") });
    await page.locator("#related button").first().click();
    assert.match(await page.locator("#numbers").textContent(), /kind(member|slab or wall)/);
  });
});

test("on a phone everything is within the window and works", async () => {
  await withPage("frame.html", { width: 390, height: 844 }, async (page) => {
    const wide = await page.evaluate(
      () =>
        [...document.querySelectorAll("button, select, input, canvas, h1, p, dl, figure")]
          .filter((e) => e.checkVisibility())
          .map((e) => e.getBoundingClientRect())
          .filter((r) => r.width > 0 && (r.left < -1 || r.right > 391)).length,
    );
    assert.equal(wide, 0);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
    const start = await shoot(page, { all: true, path: join(out, "phone.png") });
    assert.ok((await describe(chromium, await shoot(page))).colours > 200);
    await page.locator("#time").press("End");
    assert.ok((await difference(chromium, start, await shoot(page, { all: true }))) > 0.005);
    await page.locator("label:has(#mode-speed)").click();
    assert.ok(await page.locator("#mode-speed").isChecked());
  });
});

test("at night the page is dark", async () => {
  await withPage("wall.html", { scheme: "dark", query: "?t=0.25&colour=chunk" }, async (page) => {
    const { light } = await describe(
      chromium,
      await shoot(page, { all: true, path: join(out, "wall-dark.png") }),
    );
    assert.ok(light < 90, `mean ${light}`);
  });
});

test("names and reports that look like tags stay text", async () => {
  const evil = "</script><script>document.title='evil'</script><!--";
  const glb = readGlb(readFileSync(inWork("wall.glb")));
  for (const node of glb.json.nodes) if (node.extras?.sunder?.volume) node.name = evil;
  copyFileSync(inWork("wall.glb"), inWork("<b>&amp;.glb"));
  writeFileSync(inWork("evil.glb"), writeGlb(glb));
  writeFileSync(inWork("evil.json"), JSON.stringify({ version: evil, seed: 1 }));
  run(
    "view",
    inWork("<b>&amp;.glb"),
    inWork("evil.glb"),
    inWork("evil.json"),
    "-o",
    inWork("evil.html"),
    "-q",
  );
  await withPage("evil.html", {}, async (page) => {
    assert.equal(await page.locator("#name").textContent(), "<b>&amp;.glb");
    await page.locator("#file").selectOption("1");
    await page.waitForFunction(() => document.getElementById("name").textContent === "evil.glb");
    await page.locator("#report summary").click();
    assert.equal(await page.locator("#reported dd").first().textContent(), evil);
    assert.equal(await page.title(), "evil.glb – sunder");
  });
});

test("other formats and assets at rest are shown without a timeline", async () => {
  for (const suffix of ["gltf", "obj", "stl", "ply"])
    run("fracture", inWork("wall.json"), "-o", inWork(`still.${suffix}`), "-q");
  const files = ["gltf", "obj", "stl", "ply"].map((suffix) => inWork(`still.${suffix}`));
  run("view", ...files, "-o", inWork("still.html"), "-q");
  await withPage("still.html", {}, async (page) => {
    assert.ok(await page.locator("#timeline").isHidden());
    const texts = [];
    for (let i = 0; i < 4; ++i) {
      await page.locator("#file").selectOption(String(i));
      await page.waitForFunction(
        (name) => document.getElementById("name").textContent === name,
        `still.${["gltf", "obj", "stl", "ply"][i]}`,
      );
      texts.push(await page.locator("#counts").textContent());
      const { colours } = await describe(
        chromium,
        await shoot(page, { path: join(out, `still-${i}.png`) }),
      );
      assert.ok(colours > 100, `${files[i]}: ${colours} colours`);
    }
    assert.match(texts[0], /^\d+ chunks$/);
    assert.equal(texts[1], texts[0].replace("chunks", "meshes"));
    assert.equal(texts[2], "1 mesh");
  });
});

test("a file that the page cannot show is told, not thrown", async () => {
  const glb = readGlb(readFileSync(inWork("wall.glb")));
  glb.json.nodes.forEach((node) => delete node.mesh);
  writeFileSync(inWork("empty.glb"), writeGlb(glb));
  run("view", inWork("empty.glb"), "-o", inWork("empty.html"), "-q");
  const page = await openPage(chromium, inWork("empty.html"), { waits: false });
  await page.locator("#message.error").waitFor();
  assert.match(await page.locator("#message").textContent(), /empty\.glb: the file has no meshes/);
  await page.context().close();
});

test("the verbs that simulate write pages too", async () => {
  run("impact", inWork("wall.json"), "-o", inWork("direct.html"), "-q");
  await withPage("direct.html", {}, async (page) => {
    assert.match(
      await page.locator("#counts").textContent(),
      new RegExp(`^${wall.report.chunks} chunks`),
    );
  });
});
