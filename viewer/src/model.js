// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file as the page needs it: a list of parts (whatever has a mesh), all their triangles in
// one set of vertices, what binds them, and the numbers of the run.
import { Matrix4, Quaternion, Vector3 } from "three";
import { Geometry } from "./geometry.js";
import { Motion } from "./motion.js";
import { blocks, exposures, sorted } from "./order.js";
import { compose, kIdentity, place, unplace } from "./pose.js";

const kGround = -1;

function poseOf(node) {
  if (node.matrix) return poseOfMatrix(new Matrix4().fromArray(node.matrix));
  const t = node.translation ?? [0, 0, 0],
    r = node.rotation ?? [0, 0, 0, 1],
    s = node.scale ?? [1, 1, 1];
  const isUniform = s[0] === s[1] && s[1] === s[2];
  return {
    pose: [...t, isUniform ? s[0] : 1, ...r],
    stretch: isUniform ? null : new Matrix4().makeScale(...s),
  };
}

// A matrix as a pose and, if it is none, what it does to the vertices before.
function poseOfMatrix(matrix) {
  const t = new Vector3(),
    r = new Quaternion(),
    s = new Vector3();
  matrix.decompose(t, r, s);
  const rigid = new Matrix4().compose(t, r, new Vector3(1, 1, 1));
  return { pose: [t.x, t.y, t.z, 1, r.x, r.y, r.z, r.w], stretch: rigid.invert().multiply(matrix) };
}

function isHull(name) {
  return name.startsWith("UCX_") || name.includes("-convcolonly");
}

function kindOf(extras, wall) {
  if (extras.radius !== undefined) return "projectile";
  if (extras.ends) return "member";
  if (wall || extras.volume !== undefined) return "chunk";
  return extras.mass !== undefined ? "panel" : "part";
}

class PartList {
  constructor(json) {
    this.json = json;
    this.parts = [];
    this.walls = [];
    const scene = json.scenes?.[json.scene ?? 0];
    const roots = scene?.nodes ?? (json.nodes ?? []).map((_, i) => i);
    const stack = roots
      .map((node) => ({ node, parent: kIdentity, wall: null, stretch: null }))
      .reverse();
    while (stack.length > 0) this.visit(stack.pop(), stack);
  }

  visit({ node: index, parent, wall, stretch }, stack) {
    const node = this.json.nodes[index];
    const name = node.name ?? `node ${index}`;
    const extras = node.extras?.sunder ?? {};
    const own = poseOf(node);
    const pull = [stretch, own.stretch]
      .filter(Boolean)
      .reduce((a, b) => a.clone().multiply(b), new Matrix4());
    const isStretched = stretch || own.stretch;
    if (extras.sunder !== undefined) {
      wall = { name, extras, parts: [], index: this.walls.length };
      this.walls.push(wall);
    }
    if (node.mesh !== undefined && !isHull(name)) {
      const part = {
        index: this.parts.length,
        node: index,
        name,
        extras,
        wall,
        kind: kindOf(extras, wall),
        mesh: node.mesh,
        parentPose: Float64Array.from(parent),
        pose: Float64Array.from(own.pose),
        stretch: isStretched ? pull : null,
        mass: extras.mass,
        volume: extras.volume,
        centroid: extras.centroid ?? [0, 0, 0],
        halfLength: (extras.length ?? 0) / 2,
      };
      this.parts.push(part);
      if (wall && part.kind === "chunk") wall.parts.push(part);
    }
    if (!node.children?.length) return;
    const world = [...kIdentity];
    compose(parent, 0, own.pose, 0, world, 0);
    for (let i = node.children.length - 1; i >= 0; --i)
      stack.push({
        node: node.children[i],
        parent: world,
        wall,
        stretch: isStretched ? pull : null,
      });
  }
}

// Bonds of all walls: two parts (b: -1 is the world) and a place in the walls' own frames.
function readBonds(gltf, walls) {
  const bonds = [];
  for (const wall of walls) {
    const table = wall.extras.bonds;
    if (!table?.count || table.pairs === undefined) continue;
    const pairs = gltf.accessor(table.pairs).array;
    const area = gltf.accessor(table.area).array,
      centroid = gltf.accessor(table.centroid).array;
    for (let i = 0; i < table.count; ++i) {
      const a = wall.parts[pairs[2 * i]],
        b = wall.parts[pairs[2 * i + 1]];
      if (!a) continue;
      const at = [centroid[3 * i], centroid[3 * i + 1], centroid[3 * i + 2]];
      bonds.push({ a, b: b ?? null, area: area[i], at });
      (a.bonds ??= []).push(bonds.length - 1);
      if (b) (b.bonds ??= []).push(bonds.length - 1);
    }
  }
  return bonds;
}

function readJoints(gltf, parts) {
  const table = gltf.json.extras?.sunder?.joints;
  if (!table?.names?.length || !table.parts || !table.points) return [];
  const byNode = new Map(parts.map((part) => [part.node, part]));
  const joints = table.names
    .map((name, index) => {
      const [a, b] = table.parts[index].map((node) =>
        node === kGround ? null : (byNode.get(node) ?? null),
      );
      const joint = {
        index,
        name,
        a,
        b,
        ends: table.ends?.[index] ?? [],
        point: table.points[index],
        broken: table.broken?.[index] ?? Infinity,
      };
      for (const part of [a, b]) {
        if (!part) continue;
        (part.joints ??= []).push(joint);
        const state = [0, 0, 0, 1, 0, 0, 0, 1];
        compose(part.parentPose, 0, part.pose, 0, state, 0);
        (joint.local ??= new Map()).set(part, unplace(state, 0, ...joint.point, [0, 0, 0]));
      }
      return joint;
    })
    .filter((joint) => joint.local);
  joints.forEach((joint, slot) => (joint.slot = slot));
  return joints;
}

/** Utilisation of all joints over time; null: the file has none. */
function readUtilisation(gltf) {
  const table = gltf.json.extras?.sunder?.joints;
  const block = table?.utilisation;
  if (!block || !table.times?.length) return null;
  const rows = gltf.numbers(block.bufferView, block.componentType ?? 5123);
  return {
    times: Float64Array.from(table.times),
    rows,
    scale: block.scale ?? 0.001,
    jointCount: table.names.length,
  };
}

/** The utilisation of a joint at the sample at or after a time. */
export function utilisationAt(table, joint, time) {
  if (!table) return undefined;
  let low = 0,
    high = table.times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (table.times[middle] < time - 1e-9) low = middle + 1;
    else high = middle;
  }
  return table.rows[low * table.jointCount + joint.index] * table.scale;
}

function mean(points) {
  const sum = [0, 0, 0];
  for (const p of points) for (let k = 0; k < 3; ++k) sum[k] += p[k] / points.length;
  return sum;
}

// Which way each part goes when the view is exploded, and how far at most.
function explodeWays(parts, motion) {
  const isBuilding = parts.some((part) => part.kind === "member");
  const groups = new Map();
  for (const part of parts) {
    if (part.kind === "projectile") continue;
    const key = isBuilding ? null : part.wall;
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(part);
  }
  const ways = new Float32Array(3 * parts.length);
  for (const group of groups.values()) {
    const centre = mean(group.map((part) => motion.centre(part)));
    for (const part of group) {
      const at = motion.centre(part);
      for (let k = 0; k < 3; ++k) ways[3 * part.index + k] = at[k] - centre[k];
    }
  }
  return ways;
}

// Box of what is there at the start (projectiles aside unless there is nothing else).
function boxOf(parts, motion, geometry) {
  const low = [Infinity, Infinity, Infinity],
    high = [-Infinity, -Infinity, -Infinity];
  const point = [0, 0, 0];
  const isSeen = (part) => part.kind !== "projectile";
  const seen = parts.some(isSeen) ? parts.filter(isSeen) : parts;
  for (const part of seen) {
    const box = geometry.boxes[part.index];
    if (!box) continue;
    for (let corner = 0; corner < 8; ++corner) {
      place(
        motion.state,
        part.index * 16,
        box[corner & 1 ? 3 : 0],
        box[corner & 2 ? 4 : 1],
        box[corner & 4 ? 5 : 2],
        point,
      );
      for (let k = 0; k < 3; ++k)
        ((low[k] = Math.min(low[k], point[k])), (high[k] = Math.max(high[k], point[k])));
    }
  }
  return low[0] <= high[0] ? { low, high } : { low: [-1, -1, -1], high: [1, 1, 1] };
}

// Heights that debris comes to rest at may be below what stands: the ground is at the lower one.
function groundHeight(model) {
  const { motion, parts, box } = model;
  const height = box.high[1] - box.low[1];
  motion.seek(motion.duration);
  let lowest = box.low[1];
  for (const part of parts) {
    const y = motion.centre(part)[1] - 0.5 * model.geometry.radii[part.index];
    if (y > box.low[1] - 3 * Math.max(1, height)) lowest = Math.min(lowest, y);
  }
  motion.seek(0);
  return lowest < box.low[1] - 0.02 * height ? lowest : box.low[1];
}

// What of each material is drawn when; edges in the order in which their parts move.
async function order(model, breath) {
  const { geometry, motion } = model;
  const seen = await exposures(model, breath);
  model.order = [];
  for (const [m, material] of geometry.materials.entries()) {
    if (!material.isInner) {
      model.order.push(await blocks(model, m, breath));
      continue;
    }
    const byTime = sorted(geometry.lists[m], geometry.spans[m], ({ part }) => seen[part]);
    geometry.lists[m] = byTime.list;
    model.order.push({ byTime });
  }
  model.lines = sorted(geometry.lines, geometry.lineSpans, ({ part }) => motion.start[part]);
  geometry.lines = model.lines.list;
}

/** Everything the page shows; `breath` (breath.js) lets it answer while it is read. */
export async function readModel(gltf, report, breath) {
  const { parts, walls } = new PartList(gltf.json);
  if (parts.length === 0) throw new Error("the file has no meshes");
  await breath.take();
  const geometry = new Geometry(gltf, parts);
  await geometry.read(gltf, parts, breath);
  for (const part of parts) {
    const box = geometry.boxes[part.index];
    if (part.kind === "part" && box)
      part.centroid = [0, 1, 2].map((k) => (box[k] + box[k + 3]) / 2);
  }
  await breath.take();
  const motion = new Motion(gltf, parts);
  await breath.take();
  const joints = readJoints(gltf, parts);
  const sunder = gltf.json.extras?.sunder ?? {};
  const scene = gltf.json.scenes?.[gltf.json.scene ?? 0]?.extras?.sunder ?? {};
  const model = {
    gltf,
    parts,
    walls,
    geometry,
    motion,
    joints,
    report,
    scene,
    bonds: readBonds(gltf, walls),
    utilisation: readUtilisation(gltf),
    run: sunder.run?.times ? sunder.run : null,
    events: sunder.events ?? [],
    explode: explodeWays(parts, motion),
    box: boxOf(parts, motion, geometry),
  };
  model.ground = groundHeight(model);
  await breath.take();
  await order(model, breath);
  return model;
}
