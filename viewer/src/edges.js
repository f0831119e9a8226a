// SPDX-License-Identifier: GPL-3.0-or-later
// Which edges of a mesh are lines to draw.

const kMostVertices = 2 ** 26; // so that a pair of them is one whole number

/**
 * Edges [a0, b0, a1, b1, …] of an index list that only one of its triangles has. Where every face
 * has vertices of its own these are the borders of faces, each once from either side.
 */
export function borderEdges(indices) {
  const seen = new Set();
  for (let i = 0; i < indices.length; i += 3) {
    for (let k = 0; k < 3; ++k)
      seen.add(indices[i + k] * kMostVertices + indices[i + ((k + 1) % 3)]);
  }
  const edges = [];
  for (const key of seen) {
    const a = Math.floor(key / kMostVertices),
      b = key % kMostVertices;
    if (!seen.has(b * kMostVertices + a)) edges.push(a, b);
  }
  return edges;
}

/** True for one of the two directions of an edge, the same for equal bits. */
export function isForward(positions, a, b) {
  for (let k = 0; k < 3; ++k) {
    const difference = positions[3 * a + k] - positions[3 * b + k];
    if (difference !== 0) return difference < 0;
  }
  return true;
}

/** Number of the vertex that stands for each one's place. */
function weld(positions) {
  const first = new Map();
  const ids = new Uint32Array(positions.length / 3);
  for (let v = 0; v < ids.length; ++v) {
    const key = `${positions[3 * v]},${positions[3 * v + 1]},${positions[3 * v + 2]}`;
    const known = first.get(key);
    ids[v] = known ?? v;
    if (known === undefined) first.set(key, v);
  }
  return ids;
}

/** Normal of a triangle, of length 1 (0 if it has no area). */
export function faceNormal(p, a, b, c) {
  const ux = p[3 * b] - p[3 * a],
    uy = p[3 * b + 1] - p[3 * a + 1],
    uz = p[3 * b + 2] - p[3 * a + 2];
  const vx = p[3 * c] - p[3 * a],
    vy = p[3 * c + 1] - p[3 * a + 1],
    vz = p[3 * c + 2] - p[3 * a + 2];
  const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
  const size = Math.hypot(...n) || 1;
  return [n[0] / size, n[1] / size, n[2] / size];
}

/**
 * Edges of a mesh across which it turns by more than about 25°, or where the group of the triangle
 * changes, or where it ends; vertices at the same place are one.
 */
export function sharpEdges(positions, indices, groups) {
  const ids = weld(positions);
  const sides = new Map();
  const count = positions.length / 3;
  for (let i = 0; i < indices.length; i += 3) {
    const side = {
      n: faceNormal(positions, indices[i], indices[i + 1], indices[i + 2]),
      group: groups[i / 3],
    };
    for (let k = 0; k < 3; ++k) {
      const a = ids[indices[i + k]],
        b = ids[indices[i + ((k + 1) % 3)]];
      const key = Math.min(a, b) * count + Math.max(a, b);
      const known = sides.get(key);
      if (known) known.push(side);
      else sides.set(key, [side]);
    }
  }
  const edges = [];
  for (const [key, [one, two]] of sides) {
    const isFlat =
      two &&
      one.group === two.group &&
      one.n[0] * two.n[0] + one.n[1] * two.n[1] + one.n[2] * two.n[2] > 0.906;
    if (!isFlat) edges.push(Math.floor(key / count), key % count);
  }
  return edges;
}
