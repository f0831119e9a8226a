// SPDX-License-Identifier: GPL-3.0-or-later
// A small chart over time: drag on it to go there.
import { number, quantity } from "./text.js";
import { valueAt } from "./series.js";

const kInks = [
  "#2f7fd6",
  "#e0702a",
  "#2ca86e",
  "#b04fc4",
  "#c9a227",
  "#d2405f",
  "#5c7a9c",
  "#8a8f98",
];

export class Chart {
  constructor(series, duration, onSeek) {
    Object.assign(this, { series, duration });
    this.element = document.createElement("figure");
    this.element.className = "chart";
    const caption = this.element.appendChild(document.createElement("figcaption"));
    caption.append(Object.assign(document.createElement("b"), { textContent: series.title }));
    this.legend = caption.appendChild(document.createElement("span"));
    this.legend.className = "legend";
    this.labels = series.lines.map((line, i) => this.addLabel(line, i));
    this.canvas = this.element.appendChild(document.createElement("canvas"));
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${series.title} over time`);
    const seek = (event) => {
      const box = this.canvas.getBoundingClientRect();
      onSeek((Math.min(Math.max(event.clientX - box.left, 0), box.width) / box.width) * duration);
    };
    this.canvas.addEventListener(
      "pointerdown",
      (event) => (this.canvas.setPointerCapture(event.pointerId), seek(event)),
    );
    this.canvas.addEventListener("pointermove", (event) => event.buttons > 0 && seek(event));
    this.measure();
  }

  addLabel(line, i) {
    const label = this.legend.appendChild(document.createElement("span"));
    if (this.series.lines.length > 1) {
      label.append(
        Object.assign(document.createElement("i"), {
          style: `background:${kInks[i % kInks.length]}`,
        }),
        `${line.label} `,
      );
    }
    return label.appendChild(document.createElement("output"));
  }

  measure() {
    ((this.low = 0), (this.high = this.series.limit ?? 0));
    for (const line of this.series.lines) {
      for (const value of line.values) {
        if (Number.isFinite(value))
          ((this.low = Math.min(this.low, value)), (this.high = Math.max(this.high, value)));
      }
    }
    // A single shock would flatten everything else.
    if (this.series.limit) this.high = Math.min(this.high, 4 * this.series.limit);
    if (this.high === this.low) this.high = this.low + 1;
  }

  /** Draws the lines into the canvas at its present size. */
  paint() {
    const { canvas, series, duration, low, high } = this;
    const scale = devicePixelRatio || 1;
    const width = (canvas.width = Math.round(canvas.clientWidth * scale));
    const height = (canvas.height = Math.round(canvas.clientHeight * scale));
    if (width === 0 || height === 0) return;
    const context = canvas.getContext("2d");
    const pad = 3 * scale;
    const x = (time) => (time / duration) * width;
    const y = (value) =>
      height - pad - ((Math.min(value, high) - low) / (high - low)) * (height - 2 * pad);
    const style = getComputedStyle(canvas);
    context.lineWidth = scale;
    context.strokeStyle = style.getPropertyValue("--rule");
    for (const value of [0, series.limit]) {
      if (value === undefined) continue;
      context.setLineDash(value === 0 ? [] : [4 * scale, 3 * scale]);
      context.beginPath();
      (context.moveTo(0, Math.round(y(value)) + 0.5),
        context.lineTo(width, Math.round(y(value)) + 0.5));
      context.stroke();
    }
    context.setLineDash([]);
    context.lineWidth = 1.5 * scale;
    context.lineJoin = "round";
    series.lines.forEach((line, i) => {
      context.strokeStyle = kInks[i % kInks.length];
      context.beginPath();
      let last = null;
      line.times.forEach((time, k) => {
        const value = line.values[k];
        if (!Number.isFinite(value)) return void (last = null);
        if (last === null) context.moveTo(x(time), y(value));
        else {
          if (series.isStep) context.lineTo(x(time), y(last));
          context.lineTo(x(time), y(value));
        }
        last = value;
      });
      context.stroke();
    });
    this.picture = document.createElement("canvas");
    Object.assign(this.picture, { width, height });
    this.picture.getContext("2d").drawImage(canvas, 0, 0);
    this.ink = style.color;
    this.seek(this.time ?? 0);
  }

  seek(time) {
    this.time = time;
    this.series.lines.forEach((line, i) => {
      const value = valueAt(line, time, this.series.isStep);
      const text = this.series.unit ? quantity(value, this.series.unit) : number(value);
      if (this.labels[i].textContent !== text) this.labels[i].textContent = text;
    });
    if (!this.picture) return;
    const context = this.canvas.getContext("2d");
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.drawImage(this.picture, 0, 0);
    context.fillStyle = this.ink;
    const width = Math.max(1, devicePixelRatio);
    context.fillRect(
      (time / this.duration) * (this.canvas.width - width),
      0,
      width,
      this.canvas.height,
    );
  }
}
