// SPDX-License-Identifier: GPL-3.0-or-later
// The picture: light, ground, camera, and the meshes of a model with the two textures that move
// and paint them.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  FloatType,
  FrontSide,
  LineSegments,
  Mesh,
  NearestFilter,
  PCFShadowMap,
  PerspectiveCamera,
  RGBAFormat,
  Scene,
  Sphere,
  SRGBColorSpace,
  Texture,
  Vector3,
  WebGLRenderer,
  RepeatWrapping,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Graph } from "./graph.js";
import { kStateSize } from "./motion.js";
import { Picker } from "./picker.js";
import { place } from "./pose.js";
import { Studio } from "./studio.js";
import {
  kLookTexels,
  kMotionTexels,
  kTextureWidth,
  lineMaterial,
  shadowMaterial,
  surfaceMaterial,
} from "./shaders.js";

function floatTexture(texels) {
  const height = Math.max(1, Math.ceil(texels / kTextureWidth));
  const texture = new DataTexture(
    new Float32Array(4 * kTextureWidth * height),
    kTextureWidth,
    height,
    RGBAFormat,
    FloatType,
  );
  texture.minFilter = texture.magFilter = NearestFilter;
  return texture;
}

export class World {
  constructor(canvas, onChange) {
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: true,
      powerPreference: "high-performance",
    });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(38, 1, 0.1, 1000);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.addEventListener("change", onChange);
    this.uniforms = {
      motionMap: { value: null },
      lookMap: { value: null },
      showLoads: { value: 0 },
      explode: { value: 0 },
      pixels: { value: 800 },
      ink: { value: new Color() },
      time: { value: 0 },
    };
    this.studio = new Studio(this.scene);
    this.meshes = [];
    this.picker = new Picker(this);
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", () => (this.dress(dark.matches), onChange()));
    this.dress(dark.matches);
  }

  dress(isDark) {
    this.studio.dress(isDark);
    this.uniforms.ink.value.set(isDark ? "#05070a" : "#0d1420").convertLinearToSRGB();
  }

  /** Shows a model; what was there before is freed. */
  show(model) {
    this.clear();
    this.model = model;
    const count = model.parts.length;
    this.motionMap = this.uniforms.motionMap.value = floatTexture(count * kMotionTexels);
    this.lookMap = this.uniforms.lookMap.value = floatTexture(count * kLookTexels);
    model.motion.shareState(this.motionMap.image.data);
    this.look = this.lookMap.image.data;
    for (const part of model.parts) this.writeForm(part);
    this.attributes(model.geometry);
    this.sphere = new Sphere(new Vector3(), Infinity);
    model.geometry.lists.forEach(
      (list, i) => list.length > 0 && this.addSurface(list, model.geometry.materials[i]),
    );
    this.addLines(model.geometry.lines);
    this.graph = new Graph(model, this.uniforms);
    this.scene.add(this.graph.object);
    this.fit();
    this.frame();
  }

  writeForm(part) {
    const at = part.index * 4 * kLookTexels;
    const rest =
      {
        chunk:
          this.model.motion.movers.length > 0 && part.wall?.extras.kind !== "solid" ? 0.2 : 0.55,
      }[part.kind] ?? 0.6;
    const form = [
      part.halfLength,
      Math.min(0.5, part.halfLength / 2) || 1,
      0,
      rest,
      this.model.geometry.widths[part.index],
      ...this.model.explode.subarray(3 * part.index, 3 * part.index + 3),
    ];
    this.look.set(form, at + 4);
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

  geometryOf(list) {
    const geometry = new BufferGeometry();
    for (const [name, attribute] of Object.entries(this.shared))
      geometry.setAttribute(name, attribute);
    geometry.setIndex(new BufferAttribute(list, 1));
    geometry.boundingSphere = this.sphere; // or three.js would look at every vertex
    return geometry;
  }

  addSurface(list, source) {
    const options = {
      color: new Color(...source.colour),
      vertexColors: Boolean(this.shared.color),
      map: this.textureOf(source),
    };
    const mesh = new Mesh(this.geometryOf(list), surfaceMaterial(options, this.uniforms));
    mesh.customDepthMaterial = shadowMaterial(this.uniforms);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    mesh.userData = { isInner: source.isInner, isDouble: source.isDouble };
    mesh.layers.enable(1);
    this.meshes.push(mesh);
    this.scene.add(mesh);
  }

  textureOf(source) {
    if (source.image === undefined) return null;
    const texture = new Texture();
    texture.colorSpace = SRGBColorSpace;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    texture.flipY = false;
    const blob = new Blob([this.model.gltf.bytes(source.image)], { type: source.mime });
    createImageBitmap(blob)
      .then(
        (image) => (
          (texture.image = image),
          (texture.needsUpdate = true),
          this.controls.dispatchEvent({ type: "change" })
        ),
      )
      .catch(() => {});
    return texture;
  }

  addLines(list) {
    this.lines = new LineSegments(this.geometryOf(list), lineMaterial(this.uniforms));
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 1;
    this.scene.add(this.lines);
  }

  clear() {
    for (const object of [...this.meshes, this.lines, this.graph?.object]) {
      if (!object) continue;
      object.removeFromParent();
      object.traverse(
        (child) => (
          child.geometry?.dispose(),
          child.material?.map?.dispose(),
          child.material?.dispose()
        ),
      );
    }
    (this.motionMap?.dispose(), this.lookMap?.dispose());
    this.meshes = [];
    this.uniforms.explode.value = 0;
  }

  fit() {
    const { box, ground } = this.model;
    this.size = Math.hypot(...box.high.map((h, k) => h - box.low[k]));
    this.middle = new Vector3(...box.high.map((h, k) => (h + box.low[k]) / 2));
    this.side = this.direction();
    this.studio.fit(this.size, this.middle, ground, this.side);
  }

  /** From which side at the start: a little from above, where the chunks of a hit wall go. */
  direction() {
    const { parts, motion } = this.model;
    const ball = parts.find((part) => part.kind === "projectile");
    const isBuilding = parts.some((part) => part.kind === "member");
    const { low, high } = this.model.box;
    const sideOf = (k) =>
      ball ? Math.sign(motion.centre(ball)[k] - (low[k] + high[k]) / 2) || 1 : 1;
    const side = sideOf(2);
    if (isBuilding) {
      const x = sideOf(0);
      return new Vector3(0.8 * x, 0.42, 1.0 * (ball ? side : 1));
    }
    return new Vector3(0.52, 0.3, ball ? -side : 1);
  }

  frame() {
    const { box } = this.model,
      { camera, middle } = this;
    const direction = this.side.clone().normalize();
    camera.position.copy(middle).add(direction);
    camera.lookAt(middle);
    camera.updateMatrixWorld();
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0),
      up = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    const tall = Math.tan((camera.fov * Math.PI) / 360) * 0.86,
      wide = tall * camera.aspect;
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const p = new Vector3(...[0, 1, 2].map((k) => (corner & (1 << k) ? box.high[k] : box.low[k])))
        .sub(middle)
        .multiplyScalar(1 + this.uniforms.explode.value);
      const need = Math.max(Math.abs(p.dot(right)) / wide, Math.abs(p.dot(up)) / tall);
      distance = Math.max(distance, need + p.dot(direction));
    }
    camera.position.copy(middle).addScaledVector(direction, distance);
    ((camera.near = this.size / 500), (camera.far = 60 * this.size));
    camera.updateProjectionMatrix();
    this.controls.target.copy(middle);
    this.controls.maxDistance = 20 * this.size;
    this.controls.minDistance = this.size / 200;
    this.controls.update();
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.uniforms.pixels.value = height / Math.tan((this.camera.fov * Math.PI) / 360);
  }

  /** Colour of a part; amount 0 leaves its material. */
  paint(part, rgb, amount) {
    const at = part.index * 4 * kLookTexels;
    ((this.look[at] = rgb[0]),
      (this.look[at + 1] = rgb[1]),
      (this.look[at + 2] = rgb[2]),
      (this.look[at + 3] = amount));
    this.lookMap.needsUpdate = true;
  }

  mark(part, isPicked) {
    this.look[part.index * 4 * kLookTexels + 6] = isPicked ? 1 : 0;
    this.lookMap.needsUpdate = true;
  }

  moved(time) {
    this.uniforms.time.value = time;
    this.motionMap.needsUpdate = true;
    this.refreshShadows();
  }

  refreshShadows() {
    this.renderer.shadowMap.needsUpdate = true;
  }

  setShown({ edges, wireframe, outer, graph, shadows }) {
    for (const mesh of this.meshes) {
      const { isInner, isDouble } = mesh.userData;
      mesh.visible = outer || isInner;
      mesh.material.wireframe = wireframe;
      mesh.material.side = isDouble || !outer || wireframe ? DoubleSide : FrontSide;
      mesh.material.needsUpdate = true;
    }
    this.lines.visible = edges && !wireframe;
    this.graph.object.visible = graph;
    this.studio.setShadows(shadows);
    this.refreshShadows();
  }

  /** Where a joint is in the canvas, CSS pixels; null: behind the camera, or its parts are gone. */
  onScreen(joint) {
    const { model, renderer, camera } = this;
    const isThere = (part) => part && model.motion.state[part.index * kStateSize + 3] > 1e-6;
    const part = [joint.a, joint.b].find(isThere);
    if (!part) return null;
    const at = place(
      model.motion.state,
      part.index * kStateSize,
      ...joint.local.get(part),
      [0, 0, 0],
    );
    for (let k = 0; k < 3; ++k)
      at[k] += this.uniforms.explode.value * model.explode[3 * part.index + k];
    const seen = new Vector3(...at).project(camera);
    if (seen.z > 1) return null;
    const { clientWidth, clientHeight } = renderer.domElement;
    return { x: ((seen.x + 1) / 2) * clientWidth, y: ((1 - seen.y) / 2) * clientHeight };
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
  }
}
