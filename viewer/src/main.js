// SPDX-License-Identifier: GPL-3.0-or-later
import { Breath } from "./breath.js";
import { Chart } from "./chart.js";
import { element, fillRows, kToggles, modeChoices, toggleChoices } from "./choices.js";
import { Colours } from "./colours.js";
import { embeddedBytes, embeddedList } from "./embedded.js";
import { readGltf } from "./gltf.js";
import { readModel } from "./model.js";
import { reportRows } from "./numbers.js";
import { Player } from "./player.js";
import { Quality } from "./quality.js";
import { Selection } from "./selection.js";
import { brokenTimes, chartsOf } from "./series.js";
import { count, seconds } from "./text.js";
import { World } from "./world.js";

const $ = (id) => document.getElementById(id);
class Page {
  constructor(list) {
    this.list = list;
    this.asked = new URLSearchParams(location.search || location.hash.slice(1));
    this.shown = { edges: true, wireframe: false, outer: true, graph: false, shadows: true };
    this.isDirty = true;
    this.world = new World($("view"), () => (this.isDirty = true));
    this.quality = new Quality((level) => this.world.setLevel(level));
    this.player = new Player(() => this.timeChanged());
    this.charts = [];
    this.selection = new Selection(this.world, () => (this.isDirty = true));
    this.listen();
  }

  listen() {
    new ResizeObserver(() => this.resized()).observe($("stage"));
    $("play").onclick = () => this.player.toggle();
    $("time").oninput = () => this.player.jump(Number($("time").value));
    $("rate").onchange = () => (this.player.rate = Number($("rate").value));
    $("frame").onclick = () => (this.world.frame(), (this.isDirty = true));
    $("explode").oninput = () => this.explode(Number($("explode").value));
    $("file").onchange = () => this.open(Number($("file").value));
    addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.model) return;
    const isField =
      /^(SELECT|TEXTAREA)$/.test(event.target.tagName) ||
      (event.target.tagName === "INPUT" &&
        event.target.type === "range" &&
        event.target.id !== "time");
    if (isField && /^(Arrow|Home|End)/.test(event.key)) return;
    if (event.key === " " && /^(BUTTON|SUMMARY|SELECT)$/.test(event.target.tagName)) return;
    const action = this.actionOf(event);
    if (!action) return;
    event.preventDefault();
    action();
  }

  actionOf({ key, shiftKey }) {
    const { player } = this;
    const toggle = kToggles.find(({ letter }) => letter === key.toLowerCase());
    if (toggle) return () => $(`toggle-${toggle.id}`).click();
    const mode = this.colours.modes[Number(key) - 1];
    if (mode?.has) return () => this.setMode(mode.id);
    return {
      " ": () => player.toggle(),
      ArrowRight: () => player.step(shiftKey ? 10 : 1),
      ArrowLeft: () => player.step(shiftKey ? -10 : -1),
      Home: () => player.go(0),
      End: () => player.go(player.duration),
      f: () => $("frame").click(),
      F: () => $("frame").click(),
      Escape: () => this.selection.select(null),
    }[key];
  }

  async open(index) {
    const entry = this.list[index];
    this.say(`Opening ${entry.name} …`);
    await new Promise((done) => setTimeout(done));
    const start = performance.now();
    try {
      const breath = new Breath();
      const [main, companion] = await Promise.all(
        entry.files.map((file) => embeddedBytes(file, breath)),
      );
      const unpacked = performance.now();
      this.model = await readModel(readGltf(main, companion), entry.report ?? null, breath);
      const read = performance.now();
      this.world.show(this.model);
      this.fill(entry);
      this.say("");
      document.documentElement.dataset.bytes = this.world.bytes();
      await this.drawFirst();
      this.tell({
        unpack: unpacked - start,
        read: read - unpacked,
        build: performance.now() - read,
      });
    } catch (error) {
      this.say(`${entry.name}: ${error.message}`, true);
      console.error(error);
    }
  }

  // On a slow machine first as when it moves: soon there, and later nothing waits for shaders.
  async drawFirst() {
    if (this.world.isSoftware) {
      this.quality.begin(2);
      this.draw();
      await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
      this.quality.set(0);
    }
    this.draw();
    document.documentElement.dataset.ready ??= performance.now().toFixed(0);
  }

  /** Measured times, in ms, for whoever looks at the page with tools. */
  tell(times) {
    for (const [name, value] of Object.entries(times))
      document.documentElement.dataset[name] = value.toFixed(1);
  }

  say(text, isError = false) {
    $("message").textContent = text;
    $("message").classList.toggle("error", isError);
  }

  fill(entry) {
    const { model } = this;
    this.colours = new Colours(model);
    $("name").textContent = entry.name;
    document.title = `${entry.name} – sunder`;
    $("counts").textContent = this.countsText();
    this.player.reset(model.motion.times);
    this.player.rate = Number($("rate").value);
    $("timeline").hidden = $("time").disabled = model.motion.duration === 0;
    $("time").max = model.motion.duration;
    this.fillChoices();
    this.fillCharts();
    this.fillReport();
    $("explode").value = 0;
    const mode = this.asked.get("colour") ?? (model.motion.isLit ? "utilisation" : "material");
    this.world.setShown(this.shown);
    this.setMode(this.colours.mode(mode).id);
    if (this.asked.has("explode")) this.explode(Number(this.asked.get("explode")));
    this.player.go(Number(this.asked.get("t") ?? 0));
    this.selection.reset(model, this.colours.speeds);
    this.resized();
    this.world.frame();
    this.isDirty = true;
  }

  countsText() {
    const { parts, motion, joints, scene } = this.model;
    const of = (kind) => parts.filter((part) => part.kind === kind).length;
    const words = [
      ["chunk", "chunk"],
      ["member", "member"],
      ["panel", "panel"],
      ["projectile", "projectile"],
      ["part", "mesh"],
    ];
    const texts = words
      .filter(([kind]) => of(kind) > 0)
      .map(([kind, word]) => count(of(kind), word).replace("meshs", "meshes"));
    const jointCount = joints.length || scene.joints;
    if (jointCount) texts.push(count(jointCount, "joint"));
    if (motion.duration > 0) texts.push(`${motion.duration.toFixed(2)} s`);
    return texts.join(" · ");
  }

  fillChoices() {
    const { model, colours, world, shown } = this;
    const { materials, lists } = model.geometry;
    const missing = [];
    if (world.graph.isEmpty) missing.push("graph");
    if (!materials.some((m, i) => m.isInner && lists[i].length > 0)) missing.push("outer");
    for (const id of missing) shown[id] = id === "outer";
    $("modes").replaceChildren(...modeChoices(colours.modes, (id) => this.setMode(id)));
    const toggles = toggleChoices(shown, missing, (id, isOn) => this.toggle(id, isOn));
    $("toggles").replaceChildren(...toggles);
  }

  toggle(id, isOn) {
    this.shown[id] = isOn;
    if (id === "graph" && isOn) this.world.graph.build();
    this.world.setShown(this.shown);
    this.world.graph.seek(this.player.time);
    this.isDirty = true;
  }

  fillCharts() {
    const { charts, missing } = chartsOf(this.model);
    const { duration } = this.model.motion;
    this.charts = charts.map((series) => new Chart(series, duration, (t) => this.player.jump(t)));
    $("charts").replaceChildren(...this.charts.map((chart) => chart.element));
    $("charts").hidden = this.charts.length === 0;
    const list = missing.join(", ").replace(/, ([^,]*)$/, " and $1");
    const isTold = duration > 0 && missing.length > 0;
    $("missing").textContent = isTold ? `The file has no time series of ${list}.` : "";
    requestAnimationFrame(() => this.charts.forEach((chart) => chart.paint()));
    this.markEvents();
  }

  /** Ticks on the timeline where something broke. */
  markEvents() {
    const canvas = $("marks");
    const width = (canvas.width = Math.round(canvas.clientWidth * devicePixelRatio));
    const height = (canvas.height = Math.round(canvas.clientHeight * devicePixelRatio));
    const { model } = this;
    if (!width || !model?.motion.duration) return;
    const times = [...brokenTimes(model), ...model.events.map((event) => event.time)];
    const context = canvas.getContext("2d");
    context.fillStyle = getComputedStyle(canvas).color;
    context.globalAlpha = times.length > 60 ? 0.35 : 0.7;
    const thickness = Math.max(1, devicePixelRatio);
    for (const time of times.filter(Number.isFinite))
      context.fillRect((time / model.motion.duration) * (width - 2), 0, thickness, height);
  }

  fillReport() {
    const rows = reportRows(this.model.report);
    $("report").hidden = rows.length === 0;
    fillRows($("reported"), rows);
  }

  setMode(id) {
    this.mode = this.colours.mode(id);
    $(`mode-${this.mode.id}`).checked = true;
    $("key").replaceChildren(this.colours.key(this.mode.id));
    this.world.uniforms.showLoads.value = this.mode.id === "utilisation" ? 1 : 0;
    this.world.setShown(this.shown);
    this.paint();
  }

  paint() {
    this.world.isTinted = false;
    this.colours.paint(this.mode.id, this.player.time, (part, rgb, amount) =>
      this.world.paint(part, rgb, amount),
    );
    this.isDirty = true;
  }

  explode(amount) {
    $("explode").value = amount;
    this.world.uniforms.explode.value = amount;
    this.world.setShown(this.shown);
    this.isDirty = true;
  }

  timeChanged() {
    if (!this.model) return;
    const { time, isPlaying } = this.player;
    this.model.motion.seek(time);
    if (this.mode?.id === "speed") this.paint();
    this.world.moved(time);
    this.world.graph.seek(time);
    $("time").value = time;
    $("time").setAttribute("aria-valuetext", seconds(time));
    $("clock").textContent = seconds(time);
    document.body.classList.toggle("playing", isPlaying);
    $("play").setAttribute("aria-label", isPlaying ? "Stop" : "Play");
    for (const chart of this.charts) chart.seek(time);
    this.selection.tell(time);
    this.isDirty = true;
  }

  resized() {
    const { clientWidth: width, clientHeight: height } = $("stage");
    const size = `${width} ${height} ${devicePixelRatio}`;
    if (width === 0 || height === 0 || size === this.size) return;
    this.size = size;
    const aspect = this.world.camera.aspect;
    this.world.resize(width, height);
    if (this.model && Math.abs(aspect - width / height) > 0.3) this.world.frame();
    for (const chart of this.charts) chart.paint();
    this.markEvents();
    // At once, or the canvas would be blank for a frame.
    if (document.documentElement.dataset.ready) this.draw();
  }

  draw() {
    this.isDirty = false;
    this.world.draw();
    const { dataset } = document.documentElement;
    dataset.frames = Number(dataset.frames ?? 0) + 1;
    dataset.level = this.world.level;
    const { triangles, calls } = this.world.renderer.info.render;
    Object.assign(dataset, { triangles, calls });
    dataset.first ??= performance.now().toFixed(0);
  }

  run() {
    let last = performance.now();
    const frame = (now) => {
      requestAnimationFrame(frame);
      const start = performance.now();
      this.player.advance(Math.min((now - last) / 1000, 0.1));
      last = now;
      this.world.controls.update();
      if (!this.model) return;
      if (this.isDirty) this.quality.changed(start);
      else if (!this.quality.rests(start)) return;
      this.draw();
      this.tell({ frame: performance.now() - start });
    };
    requestAnimationFrame(frame);
  }
}

async function start() {
  const list = embeddedList();
  let page;
  try {
    page = new Page(list);
  } catch (error) {
    $("message").textContent =
      `This page needs WebGL 2, which this browser does not give it: ${error.message}`;
    $("message").classList.add("error");
    return;
  }
  if (list.length === 0) return page.say("There is no file in this page.", true);
  $("files").hidden = list.length === 1;
  $("file").replaceChildren(
    ...list.map((entry, i) => element("option", { value: i, textContent: entry.name })),
  );
  await page.open(0);
  page.run();
}

start();
