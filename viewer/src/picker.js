// SPDX-License-Identifier: GPL-3.0-or-later
// Which part is under a pixel: a ray against the spheres of all parts, then the triangles of those
// it meets. Nothing waits for the graphics card.
import { Vector3 } from "three";
import { kStateSize } from "./motion.js";
import { place, unplace } from "./pose.js";

// Along the ray from o by d (any length) to a triangle; Infinity: it misses.
function meets(o, d, p, a, b, c) {
  const ux = p[b] - p[a],
    uy = p[b + 1] - p[a + 1],
    uz = p[b + 2] - p[a + 2];
  const vx = p[c] - p[a],
    vy = p[c + 1] - p[a + 1],
    vz = p[c + 2] - p[a + 2];
  const hx = d[1] * vz - d[2] * vy,
    hy = d[2] * vx - d[0] * vz,
    hz = d[0] * vy - d[1] * vx;
  const size = ux * hx + uy * hy + uz * hz;
  if (size === 0) return Infinity;
  const sx = o[0] - p[a],
    sy = o[1] - p[a + 1],
    sz = o[2] - p[a + 2];
  const u = (sx * hx + sy * hy + sz * hz) / size;
  const qx = sy * uz - sz * uy,
    qy = sz * ux - sx * uz,
    qz = sx * uy - sy * ux;
  const v = (d[0] * qx + d[1] * qy + d[2] * qz) / size;
  const t = (vx * qx + vy * qy + vz * qz) / size;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : Infinity;
}

export class Picker {
  constructor(world) {
    this.world = world;
  }

  // Spans of some parts in all lists, by part.
  spansOf(parts) {
    const found = new Map(parts.map((part) => [part, []]));
    const { materials, lists, spans } = this.world.model.geometry;
    spans.forEach((own, m) => {
      for (const { part, start, count } of own)
        found.get(part)?.push({ list: lists[m], start, count, isInner: materials[m].isInner });
    });
    return found;
  }

  /** The part at a place in CSS pixels from the canvas's corner; null: none. */
  at(x, y) {
    const { camera, renderer } = this.world;
    const { clientWidth, clientHeight } = renderer.domElement;
    camera.updateMatrixWorld();
    const far = new Vector3((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight, 0.5);
    const way = far.unproject(camera).sub(camera.position).normalize();
    return this.along(camera.position.toArray(), way.toArray());
  }

  /** The first part that a ray meets; `d` of length 1. */
  along(o, d) {
    const { model } = this.world;
    const candidates = this.candidates(o, d);
    const spans = this.spansOf(candidates.map(({ part }) => part));
    let best = null,
      nearest = Infinity;
    for (const { part, begin } of candidates) {
      if (begin > nearest) break;
      const at = this.hit(part, spans.get(part), o, d);
      if (at < nearest) ((nearest = at), (best = model.parts[part]));
    }
    return best;
  }

  // Parts whose spheres the ray meets, the nearest first.
  candidates(o, d) {
    const { model, uniforms } = this.world;
    const { boxes, radii } = model.geometry,
      { state } = model.motion;
    const found = [],
      at = [0, 0, 0];
    for (let part = 0; part < boxes.length; ++part) {
      const box = boxes[part];
      if (!box) continue;
      const middle = [(box[0] + box[3]) / 2, (box[1] + box[4]) / 2, (box[2] + box[5]) / 2];
      place(state, part * kStateSize, ...middle, at);
      for (let k = 0; k < 3; ++k)
        at[k] += uniforms.explode.value * model.explode[3 * part + k] - o[k];
      const radius = radii[part] * state[part * kStateSize + 3];
      const along = at[0] * d[0] + at[1] * d[1] + at[2] * d[2];
      const aside = at[0] ** 2 + at[1] ** 2 + at[2] ** 2 - along ** 2;
      if (radius < 1e-9 || along < -radius || aside > radius ** 2) continue;
      found.push({ part, begin: along - Math.sqrt(radius ** 2 - aside) });
    }
    return found.sort((a, b) => a.begin - b.begin);
  }

  hit(part, spans, o, d) {
    const { model, uniforms, shown } = this.world;
    const { state } = model.motion,
      { position } = model.geometry;
    const at = part * kStateSize;
    const away = [0, 1, 2].map((k) => uniforms.explode.value * model.explode[3 * part + k]);
    const own = unplace(state, at, o[0] - away[0], o[1] - away[1], o[2] - away[2], [0, 0, 0]);
    const turn = [0, 0, 0, state[at + 3], ...state.subarray(at + 4, at + 8)];
    const way = unplace(turn, 0, ...d, [0, 0, 0]);
    let nearest = Infinity;
    for (const { list, start, count, isInner } of spans) {
      if (!isInner && !shown.outer) continue;
      for (let i = start; i < start + count; i += 3)
        nearest = Math.min(
          nearest,
          meets(own, way, position, 3 * list[i], 3 * list[i + 1], 3 * list[i + 2]),
        );
    }
    return nearest;
  }
}
