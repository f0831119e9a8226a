// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of parts, as linear red, green, blue; and the keys that explain them.
import { Color } from "three";
import { number } from "./text.js";

const scratch = new Color();
const linear = (text) => scratch.set(text).toArray();

// Perceptually even: dark blue, green, yellow (after viridis, five stops).
const kRamp = ["#3b2a6b", "#2f6690", "#1f9e89", "#7cc65a", "#fde047"];
const kHeat = ["#707d92", "#3f8fc9", "#f2c14e", "#ee7c2b", "#d7263d"];
const linearRamp = (stops) => stops.map(linear);
const ramps = { size: linearRamp(kRamp), speed: linearRamp(kHeat) };

function ramp(stops, t, out) {
  const x = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(x), stops.length - 2),
    f = x - i;
  for (let k = 0; k < 3; ++k) out[k] = (1 - f) * stops[i][k] + f * stops[i + 1][k];
  return out;
}

/** Neighbouring numbers get hues far apart. */
export function hueOf(index) {
  const turn = (index * 0.61803398875 + 0.08) % 1;
  const light = 0.52 + 0.12 * ((index * 0.7548776662) % 1);
  return scratch.setHSL(turn, 0.48, light).toArray();
}

function logRange(values) {
  const positive = values.filter((v) => v > 0);
  const low = Math.min(...positive.slice(0, 1)),
    range = { low, high: low };
  for (const v of positive)
    ((range.low = Math.min(range.low, v)), (range.high = Math.max(range.high, v)));
  return range;
}

const kGrey = linear("#8b93a1"),
  kBall = linear("#5b6470");

function swatches(entries) {
  const list = document.createElement("ul");
  list.className = "swatches";
  for (const [colour, label] of entries) {
    const item = list.appendChild(document.createElement("li"));
    const swatch = item.appendChild(document.createElement("i"));
    swatch.style.background = colour;
    item.append(label);
  }
  return list;
}

function bar(stops, low, high, unit) {
  const box = document.createElement("div");
  box.className = "bar";
  const strip = box.appendChild(document.createElement("i"));
  strip.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
  for (const value of [low, high])
    box.appendChild(document.createElement("span")).textContent = `${number(value)} ${unit}`;
  return box;
}

const css = (rgb) => `#${scratch.setRGB(...rgb).getHexString()}`;

/** What the colours of a model can show. */
export class Colours {
  constructor(model) {
    this.model = model;
    const { parts } = model;
    const sized = parts.filter((part) => part.kind !== "projectile");
    this.sizeKey = sized.every((part) => part.volume > 0) ? "volume" : "mass";
    this.hasSizes = sized.every((part) => part[this.sizeKey] > 0);
    if (this.hasSizes) this.sizes = logRange(sized.map((part) => part[this.sizeKey]));
    this.speeds = new Float32Array(parts.length);
    this.topSpeed = 0;
    this.modes = [
      { id: "material", label: "Material", has: true },
      { id: "chunk", label: "Chunk", has: true },
      { id: "size", label: "Size", has: this.hasSizes, why: "sizes of parts" },
      {
        id: "utilisation",
        label: "Utilisation",
        has: model.motion.isLit,
        why: "loads of joints",
        changes: true,
      },
      {
        id: "speed",
        label: "Speed",
        has: model.motion.movers.length > 0,
        why: "motion",
        changes: true,
      },
    ];
  }

  mode(id) {
    return this.modes.find((mode) => mode.id === id && mode.has) ?? this.modes[0];
  }

  /** Calls write(part, rgb, amount) for all parts; amount 0 leaves the material's own colour. */
  paint(id, time, write) {
    const { parts, motion } = this.model;
    const out = [0, 0, 0];
    if (id === "speed") motion.speeds(time, this.speeds);
    for (const part of parts) {
      const isBall = part.kind === "projectile";
      if (id === "material") write(part, out, 0);
      else if (id === "chunk") write(part, isBall ? kBall : hueOf(part.index), 1);
      else if (id === "size") write(part, isBall ? kBall : this.size(part, out), 1);
      else if (id === "utilisation") write(part, kGrey, 0.8);
      else write(part, this.speed(part, out), 1);
    }
  }

  size(part, out) {
    const { low, high } = this.sizes;
    const span = Math.log(high / low);
    return ramp(ramps.size, span > 0 ? Math.log(part[this.sizeKey] / low) / span : 0.5, out);
  }

  speed(part, out) {
    return ramp(ramps.speed, Math.sqrt(this.speeds[part.index] / this.speedScale()), out);
  }

  /** m/s at which the colours end: the fastest part at any of some moments, found once. */
  speedScale() {
    if (this.topSpeed > 0) return this.topSpeed;
    const { motion, parts } = this.model;
    const speeds = new Float32Array(parts.length);
    for (let k = 1; k <= 24; ++k) {
      motion.speeds((motion.duration * k) / 24, speeds);
      for (const part of parts)
        if (part.kind !== "projectile") this.topSpeed = Math.max(this.topSpeed, speeds[part.index]);
    }
    this.topSpeed = Math.max(this.topSpeed, 0.1);
    return this.topSpeed;
  }

  key(id) {
    const { model } = this;
    if (id === "size")
      return bar(kRamp, this.sizes.low, this.sizes.high, this.sizeKey === "mass" ? "kg" : "m³");
    if (id === "speed") return bar(kHeat, 0, this.speedScale(), "m/s");
    if (id === "utilisation")
      return swatches([
        ["#e81e16", "force"],
        ["#1cb034", "torque"],
        ["#ffd000", "both"],
        ["#1c54f5", "joint broken"],
        ["#8b93a1", "no load"],
      ]);
    if (id === "material") {
      const { materials, lists, colour } = model.geometry;
      // A white material takes its look from the colours of vertices.
      const ownColour = (m, [first]) =>
        m.colour.map((c, k) => c * (colour ? colour[4 * first + k] / 255 : 1));
      const own = materials.map((m, i) => [m, lists[i]]).filter(([, list]) => list.length > 0);
      return swatches(
        own.map(([m, list]) => [css(ownColour(m, list)), m.name.replaceAll("_", " ")]),
      );
    }
    return document.createDocumentFragment();
  }
}
