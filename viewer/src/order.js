// SPDX-License-Identifier: GPL-3.0-or-later
// Which triangles can be seen when and from where, so that the others need not be drawn. The faces
// of cracks are behind each other until a chunk beside them moves; the flat faces of what never
// moves are seen from one side only.
import { kIdentity, place } from "./pose.js";
import { kStateSize } from "./motion.js";

const kFewest = 4000; // triangles of one direction for which a group of its own is worth it
const kBlocks = 4096; // triangles of a group that are left out together where they are not in sight

/** Spans of a list in the order of their keys: {list, keys, ends}; writes the spans' new places. */
export function sorted(list, spans, keyOf) {
  const keyed = spans.map((span) => ({ span, key: keyOf(span) }));
  keyed.sort((a, b) => (a.key < b.key ? -1 : a.key > b.key ? 1 : 0));
  const result = new Uint32Array(list.length);
  const keys = new Float64Array(spans.length),
    ends = new Uint32Array(spans.length);
  let at = 0;
  keyed.forEach(({ span, key }, i) => {
    result.set(list.subarray(span.start, span.start + span.count), at);
    span.start = at;
    at += span.count;
    keys[i] = key;
    ends[i] = at;
  });
  return { list: result, keys, ends };
}

/** Of a sorted list: how many indices have keys before `time`. */
export function countBefore({ keys, ends }, time) {
  let low = 0,
    high = keys.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (keys[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low === 0 ? 0 : ends[low - 1];
}

function crossOf(position, a, b, c) {
  const u = [0, 1, 2].map((k) => position[3 * b + k] - position[3 * a + k]);
  const v = [0, 1, 2].map((k) => position[3 * c + k] - position[3 * a + k]);
  return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
}

function areaOf(geometry, material, span) {
  const list = geometry.lists[material];
  let area = 0;
  for (let i = span.start; i < span.start + span.count; i += 3)
    area += 0.5 * Math.hypot(...crossOf(geometry.position, list[i], list[i + 1], list[i + 2]));
  return area;
}

/**
 * From when each part's crack faces may be seen: when it or one that it has a bond with moves;
 * -Infinity where its bonds do not cover them all.
 */
export async function exposures({ parts, bonds, geometry, motion }, breath) {
  const open = new Float64Array(parts.length);
  for (const [m, material] of geometry.materials.entries()) {
    if (!material.isInner) continue;
    for (const span of geometry.spans[m]) {
      open[span.part] += areaOf(geometry, m, span);
      if (breath.isDue) await breath.take();
    }
  }
  const left = open.slice();
  const result = Float64Array.from(parts, (part) => motion.start[part.index]);
  for (const { a, b, area } of bonds) {
    if (!b) continue;
    left[a.index] -= area;
    left[b.index] -= area;
    result[a.index] = Math.min(result[a.index], motion.start[b.index]);
    result[b.index] = Math.min(result[b.index], motion.start[a.index]);
  }
  for (const { index } of parts) if (left[index] > 1e-3 * open[index]) result[index] = -Infinity;
  return result;
}

// Numbers near each other for places near each other.
function morton(x, y, z) {
  const spread = (v) => {
    let bits = 0;
    for (let i = 0; i < 8; ++i) bits |= ((v >> i) & 1) << (3 * i);
    return bits;
  };
  return spread(x) | (spread(y) << 1) | (spread(z) << 2);
}

class Walls {
  constructor(model) {
    Object.assign(this, model);
    this.codes = new Map();
    this.point = [0, 0, 0];
  }

  // Normal of a triangle's first corner, in the world, as a whole number; 127 steps a unit.
  directionOf(part, vertex) {
    const { normal } = this.geometry,
      state = this.motion.state;
    const q = part * kStateSize + 4;
    const n = [normal[4 * vertex], normal[4 * vertex + 1], normal[4 * vertex + 2]];
    if (state[q + 3] !== 1) {
      const turn = [0, 0, 0, 1, state[q], state[q + 1], state[q + 2], state[q + 3]];
      place(turn, 0, ...n, n);
    }
    return (
      ((Math.round(n[0]) + 128) << 16) | ((Math.round(n[1]) + 128) << 8) | (Math.round(n[2]) + 128)
    );
  }

  worldOf(part, vertex) {
    const { position } = this.geometry;
    const [x, y, z] = position.subarray(3 * vertex, 3 * vertex + 3);
    return place(this.motion.state, part * kStateSize, x, y, z, this.point);
  }

  isUnmoved(part) {
    const at = part * kStateSize;
    return kIdentity.every((value, k) => this.motion.state[at + k] === value);
  }

  codeOf(index) {
    const { low, high } = this.box;
    const at = this.motion.centre(this.parts[index]);
    const cell = (k) =>
      Math.min(255, Math.max(0, Math.floor((256 * (at[k] - low[k])) / (high[k] - low[k] || 1))));
    return morton(cell(0), cell(1), cell(2));
  }

  // Triangles of what never moves, each with its direction.
  async split(list, spans, breath) {
    const pieces = [];
    for (const span of spans) {
      for (let i = span.start; i < span.start + span.count; i += 3) {
        const direction = this.directionOf(span.part, list[i]);
        const last = pieces.at(-1);
        if (
          last?.part === span.part &&
          last.direction === direction &&
          i === last.start + last.count
        )
          last.count += 3;
        else pieces.push({ part: span.part, start: i, count: 3, direction });
      }
      if (breath.isDue) await breath.take();
    }
    return pieces;
  }

  group(direction, pieces) {
    const n = [16, 8, 0].map((shift) => ((direction >> shift) & 255) - 128);
    const size = Math.hypot(...n) || 1;
    return { normal: direction === 0 ? null : n.map((x) => x / size), low: Infinity, pieces };
  }

  // Blocks of a group: ranges of the new list with the sphere around each.
  *blocksOf({ normal, pieces }, list) {
    for (const piece of pieces) piece.code = this.codeOf(piece.part);
    pieces.sort((a, b) => a.code - b.code || a.start - b.start);
    let block = null;
    for (const piece of pieces) {
      if (block && block.count >= 3 * kBlocks) (yield block, (block = null));
      block ??= {
        pieces: [],
        count: 0,
        normal,
        isUnmoved: true,
        least: Infinity,
        low: [1, 1, 1].map(() => Infinity),
        high: [1, 1, 1].map(() => -Infinity),
      };
      block.pieces.push(piece);
      block.count += piece.count;
      for (let i = piece.start; i < piece.start + piece.count; ++i)
        this.include(block, piece.part, list[i]);
      block.isUnmoved &&= this.isUnmoved(piece.part);
    }
    if (block) yield block;
  }

  include(block, part, vertex) {
    const p = this.worldOf(part, vertex);
    for (let k = 0; k < 3; ++k) {
      if (p[k] < block.low[k]) block.low[k] = p[k];
      if (p[k] > block.high[k]) block.high[k] = p[k];
    }
    if (!block.normal) return;
    const along = p[0] * block.normal[0] + p[1] * block.normal[1] + p[2] * block.normal[2];
    if (along < block.least) block.least = along;
  }
}

/**
 * Puts the triangles of a material in a new order: those of parts that move, then blocks of those
 * that never do. Returns how many indices the former have, and the blocks, [{start, count, low,
 * high, normal, least, isUnmoved}]: a block's faces can be seen from a point p only if
 * p · normal > least (normal null: from anywhere); isUnmoved: its parts' frames are the world's.
 */
export async function blocks(model, material, breath) {
  const { geometry, motion } = model;
  const walls = new Walls(model);
  const list = geometry.lists[material];
  const isStill = (span) => motion.start[span.part] === Infinity;
  const moving = geometry.spans[material].filter((span) => !isStill(span));
  const pieces = await walls.split(list, geometry.spans[material].filter(isStill), breath);
  const counts = new Map();
  for (const { direction, count } of pieces)
    counts.set(direction, (counts.get(direction) ?? 0) + count / 3);
  const groups = new Map();
  for (const piece of pieces) {
    const key = counts.get(piece.direction) >= kFewest ? piece.direction : 0;
    if (!groups.has(key)) groups.set(key, walls.group(key, []));
    groups.get(key).pieces.push(piece);
  }
  const result = new Uint32Array(list.length);
  let at = 0;
  const put = (span) => {
    result.set(list.subarray(span.start, span.start + span.count), at);
    span.start = at;
    at += span.count;
  };
  moving.forEach(put);
  const found = [];
  for (const group of groups.values())
    for (const block of walls.blocksOf(group, list)) {
      const start = at;
      block.pieces.forEach(put);
      found.push({ ...block, start, pieces: null });
      if (breath.isDue) await breath.take();
    }
  geometry.lists[material] = result;
  geometry.spans[material] = [...moving, ...pieces];
  return { moving: moving.reduce((sum, span) => sum + span.count, 0), blocks: found };
}
