// SPDX-License-Identifier: GPL-3.0-or-later
// All triangles of all parts in one set of vertices, and one index list per material: so that a
// file of any number of chunks is drawn by one call per material.
import { Vector3 } from "three";
import { borderEdges, faceNormal, isForward, sharpEdges } from "./edges.js";

// One primitive with normals of its own per face, whatever the file has.
function primitiveOf(gltf, primitive, stretch) {
  const { attributes } = primitive;
  const source = gltf.accessor(attributes.POSITION);
  let positions = source.array;
  const count = source.count;
  if (stretch) {
    positions = new Float32Array(positions.length);
    const point = new Vector3();
    for (let v = 0; v < count; ++v)
      point
        .fromArray(source.array, 3 * v)
        .applyMatrix4(stretch)
        .toArray(positions, 3 * v);
  }
  const indices =
    primitive.indices === undefined
      ? Uint32Array.from({ length: count }, (_, i) => i)
      : gltf.accessor(primitive.indices).array;
  const extra = {
    material: primitive.material ?? -1,
    colours: attributes.COLOR_0 === undefined ? null : gltf.accessor(attributes.COLOR_0),
    uvs: attributes.TEXCOORD_0 === undefined ? null : gltf.accessor(attributes.TEXCOORD_0).array,
  };
  if (attributes.NORMAL !== undefined && !stretch)
    return {
      key: attributes.POSITION,
      listKey: primitive.indices,
      positions,
      normals: gltf.accessor(attributes.NORMAL).array,
      indices,
      ...extra,
    };
  return flat(positions, indices, extra);
}

// Every triangle gets vertices of its own, with its normal.
function flat(positions, indices, extra) {
  const own = new Float32Array(3 * indices.length),
    normals = new Float32Array(3 * indices.length);
  for (let i = 0; i < indices.length; i += 3) {
    const n = faceNormal(positions, indices[i], indices[i + 1], indices[i + 2]);
    for (let k = 0; k < 3; ++k) {
      own.set(positions.subarray(3 * indices[i + k], 3 * indices[i + k] + 3), 3 * (i + k));
      normals.set(n, 3 * (i + k));
    }
  }
  const spread = (source, width) => {
    if (!source) return null;
    const result = new Float32Array(width * indices.length);
    for (let i = 0; i < indices.length; ++i)
      for (let k = 0; k < width; ++k) result[width * i + k] = source[width * indices[i] + k];
    return result;
  };
  const { colours, uvs } = extra;
  return {
    key: null,
    listKey: null,
    positions: own,
    normals,
    indices: Uint32Array.from(indices, (_, i) => i),
    material: extra.material,
    colours: colours && { array: spread(colours.array, colours.width), width: colours.width },
    uvs: spread(uvs, 2),
  };
}

export class Geometry {
  constructor(gltf, parts) {
    this.boxes = [];
    this.radii = new Float32Array(parts.length);
    this.widths = new Float32Array(parts.length);
    this.borders = new Map();
    const { materials = [], images = [], textures = [] } = gltf.json;
    const imageOf = (m) => textures[m.pbrMetallicRoughness?.baseColorTexture?.index]?.source;
    this.materials = [...materials, {}].map((m) => ({
      name: m.name ?? "no material",
      colour:
        m.pbrMetallicRoughness?.baseColorFactor?.slice(0, 3) ??
        (m.name ? [1, 1, 1] : [0.55, 0.55, 0.55]),
      isInner: (m.name ?? "").endsWith("_inner"),
      isDouble: m.doubleSided === true,
      metal: m.pbrMetallicRoughness?.metallicFactor ?? 0,
      image: images[imageOf(m)]?.bufferView,
      mime: images[imageOf(m)]?.mimeType,
    }));
    this.hasTextures = this.materials.some((m) => m.image !== undefined);
  }

  /** Reads all meshes; must be awaited before anything else. */
  async read(gltf, parts, breath) {
    const pieces = await this.gather(gltf, parts, breath);
    this.allocate(pieces);
    for (const piece of pieces) {
      this.fill(piece);
      if (breath.isDue) await breath.take();
    }
    await this.addLines(pieces, breath);
    delete this.borders;
  }

  // What each part is made of; primitives of a part that share vertices do so here.
  async gather(gltf, parts, breath) {
    const pieces = [];
    for (const part of parts) {
      if (breath.isDue) await breath.take();
      const own = [];
      for (const source of gltf.json.meshes[part.mesh].primitives) {
        if ((source.mode ?? 4) !== 4 || source.attributes?.POSITION === undefined) continue;
        const primitive = primitiveOf(gltf, source, part.stretch);
        const shared = own.find((other) => other.key !== null && other.key === primitive.key);
        own.push({ ...primitive, part, shared: shared ?? null });
      }
      pieces.push(...own);
    }
    return pieces;
  }

  allocate(pieces) {
    let vertices = 0;
    const indices = new Array(this.materials.length).fill(0);
    for (const piece of pieces) {
      piece.first = piece.shared ? piece.shared.first : vertices;
      if (!piece.shared) vertices += piece.positions.length / 3;
      if (piece.material < 0) piece.material = this.materials.length - 1;
      indices[piece.material] += piece.indices.length;
    }
    this.position = new Float32Array(3 * vertices);
    this.normal = new Int8Array(4 * vertices);
    this.part = new Float32Array(vertices);
    this.colour = pieces.some((piece) => piece.colours)
      ? new Uint8Array(4 * vertices).fill(255)
      : null;
    this.uv = this.hasTextures ? new Float32Array(2 * vertices) : null;
    this.lists = indices.map((count) => new Uint32Array(count));
    this.used = indices.map(() => 0);
    this.spans = indices.map(() => []); // {part, start, count} in each list
    this.triangles = indices.reduce((a, b) => a + b, 0) / 3;
  }

  fill(piece) {
    const list = this.lists[piece.material];
    let at = this.used[piece.material];
    for (let i = 0; i < piece.indices.length; ++i) list[at++] = piece.first + piece.indices[i];
    const { length: count } = piece.indices;
    this.spans[piece.material].push({ part: piece.part.index, start: at - count, count });
    this.used[piece.material] = at;
    if (piece.shared) return;
    this.fillVertices(piece);
  }

  fillVertices(piece) {
    const { first, positions, normals, part } = piece;
    const count = positions.length / 3;
    this.position.set(positions, 3 * first);
    this.part.fill(part.index, first, first + count);
    for (let v = 0; v < count; ++v)
      for (let k = 0; k < 3; ++k)
        this.normal[4 * (first + v) + k] = Math.round(127 * normals[3 * v + k]);
    if (piece.colours) {
      const { array, width } = piece.colours;
      for (let v = 0; v < count; ++v)
        for (let k = 0; k < 3; ++k)
          this.colour[4 * (first + v) + k] = Math.round(
            255 * Math.min(1, Math.max(0, array[width * v + k])),
          );
    }
    if (this.uv && piece.uvs) this.uv.set(piece.uvs.subarray(0, 2 * count), 2 * first);
    this.measure(part.index, positions, part.centroid);
  }

  measure(index, positions, centre) {
    const box = (this.boxes[index] ??= [
      Infinity,
      Infinity,
      Infinity,
      -Infinity,
      -Infinity,
      -Infinity,
    ]);
    for (let i = 0; i < positions.length; i += 3) {
      for (let k = 0; k < 3; ++k) {
        if (positions[i + k] < box[k]) box[k] = positions[i + k];
        if (positions[i + k] > box[3 + k]) box[3 + k] = positions[i + k];
      }
    }
    this.widths[index] = Math.min(box[3] - box[0], box[4] - box[1], box[5] - box[2]);
    this.radii[index] = 0.5 * Math.hypot(box[3] - box[0], box[4] - box[1], box[5] - box[2]);
  }

  // Solids and foreign meshes: edges by angle. Walls and parts of buildings, whose faces have
  // vertices of their own: borders of faces, each once.
  async addLines(pieces, breath) {
    const lines = [];
    this.lineSpans = [];
    for (let i = 0; i < pieces.length;) {
      let end = i + 1;
      while (end < pieces.length && pieces[end].part === pieces[i].part) ++end;
      const own = pieces.slice(i, end);
      const { part } = own[0];
      const start = lines.length;
      const isOurs =
        part.kind !== "part" && part.kind !== "projectile" && part.wall?.extras.kind !== "solid";
      if (isOurs && own.every((piece) => piece.listKey !== null)) this.addBorders(own, lines);
      else if (part.kind !== "projectile") this.addSharp(own, lines);
      this.lineSpans.push({ part: part.index, start, count: lines.length - start });
      i = end;
      if (breath.isDue) await breath.take();
    }
    this.lines = Uint32Array.from(lines);
  }

  addBorders(own, lines) {
    for (const piece of own) {
      let edges = this.borders.get(piece.listKey);
      if (!edges) this.borders.set(piece.listKey, (edges = borderEdges(piece.indices)));
      for (let e = 0; e < edges.length; e += 2) {
        const a = edges[e],
          b = edges[e + 1];
        if (isForward(piece.positions, a, b)) lines.push(piece.first + a, piece.first + b);
      }
    }
  }

  addSharp(own, lines) {
    const positions = [],
      indices = [],
      groups = [],
      back = [];
    for (const piece of own) {
      const base = back.length;
      for (let v = 0; v < piece.positions.length / 3; ++v) {
        positions.push(
          piece.positions[3 * v],
          piece.positions[3 * v + 1],
          piece.positions[3 * v + 2],
        );
        back.push(piece.first + v);
      }
      for (const index of piece.indices) indices.push(base + index);
      for (let t = 0; t < piece.indices.length; t += 3) groups.push(piece.material);
    }
    for (const v of sharpEdges(positions, indices, groups)) lines.push(back[v]);
  }
}
