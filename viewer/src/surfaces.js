// SPDX-License-Identifier: GPL-3.0-or-later
// The meshes of a model's triangles: one per material with all of them, and, for what is usually
// shown, such as leave out what cannot be seen (order.js).
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  FrontSide,
  Mesh,
  Sphere,
  Vector3,
} from "three";
import { countBefore } from "./order.js";
import { fastMaterial, shadowMaterial, surfaceMaterial } from "./shaders.js";

const kEverywhere = new Sphere(new Vector3(), Infinity);

export class Surfaces {
  /** `textureOf` gives a material's picture or null. */
  constructor(model, uniforms, textureOf) {
    Object.assign(this, { model, uniforms });
    this.attributes(model.geometry);
    this.meshes = [];
    model.geometry.lists.forEach((list, i) => {
      if (list.length > 0) this.addMaterial(i, textureOf(model.geometry.materials[i]));
    });
    this.time = 0;
  }

  attributes(geometry) {
    this.shared = {
      position: new BufferAttribute(geometry.position, 3),
      normal: new BufferAttribute(geometry.normal, 4, true),
      part: new BufferAttribute(geometry.part, 1),
    };
    if (geometry.colour) this.shared.color = new BufferAttribute(geometry.colour, 4, true);
    if (geometry.uv) this.shared.uv = new BufferAttribute(geometry.uv, 2);
  }

  /** A geometry over the common vertices. */
  geometryOf(index, sphere = kEverywhere) {
    const geometry = new BufferGeometry();
    for (const [name, attribute] of Object.entries(this.shared))
      geometry.setAttribute(name, attribute);
    geometry.setIndex(index);
    geometry.boundingSphere = sphere; // or three.js would look at every vertex
    return geometry;
  }

  addMaterial(i, map) {
    const { geometry, order } = this.model;
    const source = geometry.materials[i];
    const options = {
      color: new Color(...source.colour),
      vertexColors: Boolean(this.shared.color),
      map,
    };
    const full = surfaceMaterial(options, this.uniforms);
    const kit = {
      index: new BufferAttribute(geometry.lists[i], 1),
      full,
      fast: map ? full : fastMaterial(options, this.uniforms),
      still: map ? full : fastMaterial({ ...options, isStill: true }, this.uniforms),
      depth: shadowMaterial(this.uniforms),
      source,
    };
    const { byTime, moving, blocks } = order[i];
    this.add(kit, { isWhole: true });
    if (byTime) this.add(kit, { byTime });
    if (moving) this.add(kit, { start: 0, count: moving });
    for (const block of blocks ?? [])
      this.add(kit, { start: block.start, count: block.count, block });
  }

  add(kit, range) {
    const { index, full, depth, source } = kit;
    const { block, start, count } = range;
    const fast = block?.isUnmoved ? kit.still : kit.fast;
    const mesh = new Mesh(this.geometryOf(index, block && sphereOf(block)), full);
    if (count) mesh.geometry.setDrawRange(start, count);
    mesh.customDepthMaterial = depth;
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = Boolean(block);
    mesh.userData = { ...range, full, fast, isInner: source.isInner, isDouble: source.isDouble };
    if (block?.normal && !source.isDouble) this.hideFromBehind(mesh);
    this.meshes.push(mesh);
  }

  // Faces that all look away from the camera are not drawn, but still cast shadows.
  hideFromBehind(mesh) {
    const { start, count, block } = mesh.userData;
    const [x, y, z] = block.normal;
    const normal = new Vector3(x, y, z);
    const { center, radius } = mesh.geometry.boundingSphere;
    mesh.onBeforeRender = (renderer, scene, camera) => {
      // Normals are rounded to 1/127.
      const slack = 0.01 * (camera.position.distanceTo(center) + radius);
      const isSeen = camera.position.dot(normal) > block.least - slack;
      mesh.geometry.setDrawRange(start, isSeen ? count : 0);
    };
    mesh.onBeforeShadow = () => mesh.geometry.setDrawRange(start, count);
  }

  /** What has come into sight until a time is drawn from now on. */
  seek(time) {
    for (const { geometry, userData } of this.meshes)
      if (userData.byTime) geometry.setDrawRange(0, countBefore(userData.byTime, time));
  }

  /** `isFast`: lit in the vertices, without shadows. */
  setShown({ wireframe, outer, isExploded, isFast }) {
    const isAll = wireframe || !outer || isExploded;
    for (const mesh of this.meshes) {
      const { isWhole, isInner, isDouble, full, fast } = mesh.userData;
      mesh.visible = (outer || isInner) && Boolean(isWhole) === isAll;
      mesh.material = isFast && !wireframe ? fast : full;
      const side = isDouble || !outer || wireframe ? DoubleSide : FrontSide;
      for (const material of [full, fast]) Object.assign(material, { side, wireframe });
    }
  }

  dispose() {
    for (const mesh of this.meshes) {
      mesh.removeFromParent();
      mesh.geometry.dispose();
      const { full, fast } = mesh.userData;
      for (const material of [full, fast, mesh.customDepthMaterial]) material.dispose();
      full.map?.dispose();
    }
  }
}

function sphereOf({ low, high }) {
  const a = new Vector3(...low),
    b = new Vector3(...high);
  return new Sphere(a.clone().add(b).multiplyScalar(0.5), 0.5 * a.distanceTo(b));
}
