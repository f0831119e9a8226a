// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a file's animation: where every part is at a time, and how its ends are lit.
import { compose, place } from "./pose.js";

/** Numbers per part in Motion.state: pose (8), then of end 0 and 1 force, torque, failed, moved. */
export const kStateSize = 16;

class Track {
  constructor(times, values, width, isStep, isRotation) {
    Object.assign(this, { times, values, width, isStep, isRotation });
    this.cursor = 0;
    this.now = new Float64Array(width);
  }

  /** When the values leave those given, s. */
  leaves(rest) {
    const { times, values, width, isStep } = this;
    for (let k = 0; k < times.length; ++k)
      for (let i = 0; i < width; ++i)
        if (values[k * width + i] !== Math.fround(rest[i]))
          return k === 0 ? -Infinity : times[isStep ? k : k - 1];
    return Infinity;
  }

  seek(time) {
    const { times } = this;
    const last = times.length - 1;
    let k = this.cursor;
    if (time < times[k] || (k < last && time >= times[k + 1])) {
      if (k + 2 <= last && time >= times[k + 1] && time < times[k + 2]) {
        ++k;
      } else {
        let low = 0,
          high = times.length; // first key after the time
        while (low < high) {
          const middle = (low + high) >> 1;
          if (times[middle] <= time) low = middle + 1;
          else high = middle;
        }
        k = Math.max(0, low - 1);
      }
      this.cursor = k;
    }
    return k;
  }

  evaluate(time) {
    const k = this.seek(time),
      { values, width, now, times } = this;
    const from = k * width;
    const isEnd = k + 1 >= times.length || time <= times[k] || this.isStep;
    if (isEnd) {
      for (let i = 0; i < width; ++i) now[i] = values[from + i];
      return;
    }
    const t = (time - times[k]) / (times[k + 1] - times[k]);
    let sign = 1;
    if (this.isRotation) {
      let along = 0;
      for (let i = 0; i < 4; ++i) along += values[from + i] * values[from + 4 + i];
      if (along < 0) sign = -1;
    }
    for (let i = 0; i < width; ++i)
      now[i] = (1 - t) * values[from + i] + sign * t * values[from + width + i];
    if (!this.isRotation) return;
    // Between two steps a chunk turns little: the straight way, made a unit again, will do.
    const size = Math.hypot(now[0], now[1], now[2], now[3]) || 1;
    for (let i = 0; i < 4; ++i) now[i] /= size;
  }
}

export class Motion {
  /** `parts`: see model.js. */
  constructor(gltf, parts) {
    this.parts = parts;
    this.state = new Float32Array(parts.length * kStateSize);
    this.local = new Float64Array(parts.length * 8);
    this.tracks = [];
    this.movers = [];
    this.duration = 0;
    this.isLit = false;
    this.readTracks(gltf);
    for (const part of parts) this.local.set(part.pose, 8 * part.index);
    this.start = this.starts();
    for (const part of parts) this.write(part);
    this.seek(0);
    this.times = this.keyTimes();
  }

  readTracks(gltf) {
    const byNode = new Map(this.parts.map((part) => [part.node, part]));
    const known = new Map();
    const movers = new Set();
    for (const animation of gltf.json.animations ?? []) {
      for (const { sampler: index, target } of animation.channels) {
        const part = byNode.get(target.node);
        const sampler = animation.samplers[index];
        if (!part || !["translation", "rotation", "scale", "weights"].includes(target.path))
          continue;
        if (sampler.interpolation === "CUBICSPLINE")
          throw new Error("the animation has splines, which this page does not play");
        const key = `${sampler.input} ${sampler.output} ${sampler.interpolation}`;
        if (!known.has(key)) known.set(key, this.track(gltf, sampler, target.path));
        (part.tracks ??= {})[target.path] = known.get(key);
        movers.add(part);
        if (target.path === "weights") this.isLit = true;
      }
    }
    this.tracks = [...known.values()];
    this.movers = [...movers];
  }

  /** Writes into another array of the same layout from now on. */
  shareState(array) {
    array.set(this.state);
    this.state = array;
  }

  /** From when each part is no longer where it was, s; Infinity: it stays. */
  starts() {
    const starts = new Float64Array(this.parts.length).fill(Infinity);
    for (const { index, pose, tracks } of this.movers) {
      const rest = { translation: pose.subarray(0, 3), rotation: pose.subarray(4, 8) };
      rest.scale = [pose[3], pose[3], pose[3]];
      for (const [path, track] of Object.entries(tracks))
        if (path !== "weights") starts[index] = Math.min(starts[index], track.leaves(rest[path]));
    }
    return starts;
  }

  track(gltf, sampler, path) {
    const times = gltf.accessor(sampler.input).array;
    const output = gltf.accessor(sampler.output);
    const width = (output.count * output.width) / times.length;
    this.duration = Math.max(this.duration, times[times.length - 1]);
    return new Track(
      times,
      output.array,
      width,
      sampler.interpolation === "STEP",
      path === "rotation",
    );
  }

  /** All times at which something has a key, ascending. */
  keyTimes() {
    let longest = [];
    for (const track of this.tracks) if (track.times.length > longest.length) longest = track.times;
    const all = new Set(longest);
    (all.add(0), all.add(this.duration));
    return Float64Array.from(all).sort();
  }

  write(part) {
    compose(part.parentPose, 0, this.local, 8 * part.index, this.state, part.index * kStateSize);
  }

  /** Where everything is at a time. O(tracks + parts that ever move). */
  seek(time) {
    for (const track of this.tracks) track.evaluate(time);
    const { local, state } = this;
    for (const part of this.movers) {
      const { translation: t, rotation: r, scale: s, weights: w } = part.tracks;
      const at = 8 * part.index,
        to = part.index * kStateSize;
      if (t) for (let k = 0; k < 3; ++k) local[at + k] = t.now[k];
      if (s) local[at + 3] = s.now[0];
      if (r) for (let k = 0; k < 4; ++k) local[at + 4 + k] = r.now[k];
      this.write(part);
      state[to + 11] = (t && time > t.times[0]) || (r && time > r.times[0]) ? 1 : 0;
      if (!w) continue;
      for (let end = 0; end < 2; ++end)
        for (let k = 0; k < 3; ++k) state[to + 8 + 4 * end + k] = w.now[3 * end + k];
    }
  }

  /** Where a part's centre of mass is. */
  centre(part, out = [0, 0, 0]) {
    const [x, y, z] = part.centroid;
    return place(this.state, part.index * kStateSize, x, y, z, out);
  }

  /** Speed in m/s of one part's centre of mass over the last step before a time. */
  speedOf(part, time) {
    if (!part.tracks) return 0;
    const step = this.step();
    const earlier = Math.max(0, time - step);
    this.seek(earlier);
    const before = this.centre(part);
    this.seek(earlier + step);
    const after = this.centre(part);
    this.seek(time);
    return Math.hypot(after[0] - before[0], after[1] - before[1], after[2] - before[2]) / step;
  }

  step() {
    return Math.max(this.duration / Math.max(1, this.times.length - 1), 1e-6);
  }

  /** Speed in m/s of all parts' centres of mass over the last step before a time. */
  speeds(time, out) {
    const step = this.step();
    const earlier = Math.max(0, time - step),
      later = earlier + step;
    const before = new Float64Array(3 * this.movers.length);
    const point = [0, 0, 0];
    this.seek(earlier);
    this.movers.forEach((part, i) => before.set(this.centre(part, point), 3 * i));
    this.seek(later);
    out.fill(0);
    this.movers.forEach((part, i) => {
      this.centre(part, point);
      out[part.index] =
        Math.hypot(
          point[0] - before[3 * i],
          point[1] - before[3 * i + 1],
          point[2] - before[3 * i + 2],
        ) / step;
    });
    this.seek(time);
    return out;
  }
}
