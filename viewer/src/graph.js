// SPDX-License-Identifier: GPL-3.0-or-later
// The support graph over the picture: chunks and their bonds, or a building's parts and joints.
import { BufferAttribute, BufferGeometry, Group, LineSegments, Points } from "three";
import { utilisationAt } from "./model.js";
import { compose, place } from "./pose.js";
import { graphMaterial } from "./shaders.js";

const kNever = 1e30;

function restPose(part) {
  const pose = new Float64Array(8);
  compose(part.parentPose, 0, part.pose, 0, pose, 0);
  return pose;
}

class Builder {
  constructor(count) {
    const floats = (width) => new Float32Array(width * count);
    this.at = 0;
    this.columns = {
      position: floats(3),
      part: floats(1),
      other: floats(1),
      shared: floats(3),
      facing: floats(3),
      reach: floats(1),
      value: floats(1),
      ended: floats(1),
    };
  }
  add(row) {
    for (const [name, column] of Object.entries(this.columns)) {
      const value = row[name];
      if (Array.isArray(value)) column.set(value, 3 * this.at);
      else column[this.at] = value;
    }
    ++this.at;
  }
  geometry() {
    const geometry = new BufferGeometry();
    for (const [name, column] of Object.entries(this.columns))
      geometry.setAttribute(
        name,
        new BufferAttribute(
          column,
          name === "position" || name === "shared" || name === "facing" ? 3 : 1,
        ),
      );
    return geometry;
  }
}

export class Graph {
  constructor(model, uniforms) {
    this.model = model;
    this.object = new Group();
    this.object.visible = false;
    this.uniforms = uniforms;
    this.isBuilt = false;
  }

  get isEmpty() {
    return this.model.bonds.length === 0 && this.model.joints.length === 0;
  }

  /** Made when first shown: most who open a page never ask for it. */
  build() {
    if (this.isBuilt) return;
    this.isBuilt = true;
    const { bonds, joints } = this.model;
    const lines = new Builder(2 * bonds.length + 4 * joints.length);
    for (const bond of bonds) this.addBond(bond, lines);
    for (const joint of joints) this.addJoint(joint, lines);
    const dots = new Builder(joints.length || this.model.parts.length);
    if (joints.length > 0)
      for (const joint of joints)
        dots.add(this.row(joint, joint.a ?? joint.b, joint.local.get(joint.a ?? joint.b)));
    else
      for (const part of this.model.parts)
        dots.add({
          position: part.centroid,
          part: part.index,
          other: part.index,
          shared: [0, 0, 0],
          facing: [0, 0, 0],
          reach: 1,
          value: 0,
          ended: kNever,
        });
    this.lines = this.add(
      new LineSegments(lines.geometry(), graphMaterial({ ...this.uniforms, round: { value: 0 } })),
    );
    this.dots = this.add(
      new Points(dots.geometry(), graphMaterial({ ...this.uniforms, round: { value: 1 } })),
    );
  }

  add(object) {
    object.frustumCulled = false;
    object.renderOrder = 3;
    this.object.add(object);
    return object;
  }

  addBond({ a, b, at, area }, lines) {
    const reach = 0.02 * Math.sqrt(area) + 1e-4;
    const world = place(restPose(a), 0, ...at, [0, 0, 0]);
    const common = { shared: at, facing: b ? at : world, reach, value: 0, ended: kNever };
    lines.add({ ...common, position: a.centroid, part: a.index, other: b ? b.index : -1 });
    lines.add({
      ...common,
      position: b ? b.centroid : at,
      part: (b ?? a).index,
      other: b ? a.index : -1,
    });
  }

  row(joint, part, position) {
    const other = part === joint.a ? joint.b : joint.a;
    return {
      position,
      part: part.index,
      other: other ? other.index : -1,
      shared: joint.local.get(part),
      facing: other ? joint.local.get(other) : joint.point,
      reach: kNever,
      value: 0,
      ended: joint.broken === Infinity ? kNever : joint.broken,
    };
  }

  addJoint(joint, lines) {
    for (const part of [joint.a, joint.b]) {
      const owner = part ?? joint.a ?? joint.b;
      const from = part ? part.centroid : joint.local.get(owner);
      lines.add(this.row(joint, owner, from));
      lines.add(this.row(joint, owner, joint.local.get(owner)));
    }
  }

  /** Joints get the colour of what they bear. */
  seek(time) {
    const { joints, utilisation } = this.model;
    if (!this.isBuilt || !this.object.visible || !utilisation) return;
    const dots = this.dots.geometry.getAttribute("value"),
      lines = this.lines.geometry.getAttribute("value");
    const first = 2 * this.model.bonds.length;
    for (const joint of joints) {
      const value = utilisationAt(utilisation, joint, time);
      dots.array[joint.slot] = value;
      lines.array.fill(value, first + 4 * joint.slot, first + 4 * joint.slot + 4);
    }
    dots.needsUpdate = lines.needsUpdate = true;
  }
}
