// SPDX-License-Identifier: GPL-3.0-or-later
// The picture: light, ground, camera, and the meshes of a model with the two textures that move
// and paint them.
import {
  Box3,
  BufferAttribute,
  Color,
  DataTexture,
  FloatType,
  LineSegments,
  NearestFilter,
  PCFShadowMap,
  PerspectiveCamera,
  RGBAFormat,
  Scene,
  SRGBColorSpace,
  Texture,
  Vector3,
  WebGLRenderer,
  RepeatWrapping,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Graph } from "./graph.js";
import { kStateSize } from "./motion.js";
import { countBefore } from "./order.js";
import { Picker } from "./picker.js";
import { place } from "./pose.js";
import { Studio } from "./studio.js";
import { kLookTexels, kMotionTexels, kTextureWidth, lineMaterial } from "./shaders.js";
import { Surfaces } from "./surfaces.js";

const kShadowPause = 250; // ms between shadows where every frame is slow
const kSmallest = 3; // of what lineMaterial takes for a size: less is not to be seen

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

// True where the processor draws: it has better things to do than to smooth edges.
function isSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return false;
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

export class World {
  constructor(canvas, onChange) {
    this.isSoftware = isSoftware();
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: !this.isSoftware,
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
      painted: { value: 0 },
      explode: { value: 0 },
      pixels: { value: 800 },
      ink: { value: new Color() },
      time: { value: 0 },
    };
    this.studio = new Studio(this.scene);
    Object.assign(this.uniforms, this.studio.lights);
    this.level = 0;
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
    this.picked = new Set();
    const count = model.parts.length;
    this.motionMap = this.uniforms.motionMap.value = floatTexture(count * kMotionTexels);
    this.lookMap = this.uniforms.lookMap.value = floatTexture(count * kLookTexels);
    model.motion.shareState(this.motionMap.image.data);
    this.look = this.lookMap.image.data;
    for (const part of model.parts) this.writeForm(part);
    this.surfaces = new Surfaces(model, this.uniforms, (source) => this.textureOf(source));
    this.scene.add(...this.surfaces.meshes);
    this.addLines(model.geometry.lines);
    const { lineSpans, widths } = model.geometry;
    this.widest = lineSpans.reduce((most, { part }) => Math.max(most, widths[part]), 0);
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
    const index = new BufferAttribute(list, 1);
    const geometry = this.surfaces.geometryOf(index);
    this.lines = new LineSegments(geometry, lineMaterial(this.uniforms));
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 1;
    this.scene.add(this.lines);
  }

  clear() {
    this.surfaces?.dispose();
    for (const object of [this.lines, this.graph?.object]) {
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
    Object.assign(this, { width, height });
    this.setPixels();
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.uniforms.pixels.value = height / Math.tan((this.camera.fov * Math.PI) / 360);
  }

  // Where the processor draws, triangles cost, not pixels, and another size makes the page wait.
  setPixels() {
    const whole = Math.min(devicePixelRatio, 2);
    const isCoarse = this.level > 1 && !this.isSoftware;
    this.renderer.setPixelRatio(isCoarse ? Math.min(whole, this.level > 2 ? 0.6 : 1) : whole);
    this.renderer.setSize(this.width, this.height, false);
  }

  /** With how little a frame is drawn: see quality.js. */
  setLevel(level) {
    this.level = level;
    if (!this.isSoftware) this.setPixels();
    this.setShown(this.shown);
    this.refreshShadows();
  }

  /** Colour of a part; amount 0 leaves its material. */
  paint(part, rgb, amount) {
    const at = part.index * 4 * kLookTexels;
    ((this.look[at] = rgb[0]),
      (this.look[at + 1] = rgb[1]),
      (this.look[at + 2] = rgb[2]),
      (this.look[at + 3] = amount));
    this.isTinted ||= amount > 0;
    this.lookMap.needsUpdate = true;
  }

  mark(part, isPicked) {
    this.look[part.index * 4 * kLookTexels + 6] = isPicked ? 1 : 0;
    if (isPicked) this.picked.add(part);
    else this.picked.delete(part);
    this.lookMap.needsUpdate = true;
  }

  moved(time) {
    this.uniforms.time.value = time;
    this.motionMap.needsUpdate = true;
    this.surfaces.seek(time);
    this.refreshShadows();
  }

  /** Shadows are drawn anew with the next frame, on slow machines not with each. */
  refreshShadows() {
    this.hasOldShadows = true;
  }

  renewShadows() {
    const now = performance.now();
    const isLate = now - (this.shadowTime ?? 0) > kShadowPause;
    if (
      !this.shown.shadows ||
      !this.hasOldShadows ||
      this.level > 1 ||
      (this.level === 1 && !isLate)
    )
      return;
    this.hasOldShadows = false;
    this.shadowTime = now;
    this.renderer.shadowMap.needsUpdate = true;
  }

  setShown(shown) {
    this.shown = shown;
    const { wireframe, outer, graph, shadows } = shown;
    const isExploded = this.uniforms.explode.value > 0;
    const isFast = this.level > 1 && this.uniforms.showLoads.value === 0;
    this.surfaces.setShown({ wireframe, outer, isExploded, isFast });
    this.graph.object.visible = graph;
    this.studio.setShadows(shadows && this.level < 2);
    this.refreshShadows();
  }

  // Edges of what has not moved are faint, all are where parts are small (lineMaterial).
  showLines() {
    const { model, lines, shown, uniforms, camera } = this;
    const largest = this.widest * uniforms.pixels.value;
    const distance = new Box3(
      new Vector3(...model.box.low),
      new Vector3(...model.box.high),
    ).distanceToPoint(camera.position);
    const isSmall = uniforms.explode.value === 0 && largest < kSmallest * distance;
    const isMoving = countBefore(model.lines, uniforms.time.value);
    lines.visible = shown.edges && !shown.wireframe && this.level < 2;
    const hasFaint = this.level === 0 && !isSmall;
    lines.geometry.setDrawRange(0, hasFaint ? Infinity : isMoving);
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

  /** Of vertices, lists and textures on the graphics card, shadows aside. */
  bytes() {
    const lists = [...this.model.geometry.lists, this.model.geometry.lines];
    const shared = Object.values(this.surfaces.shared).map(({ array }) => array);
    const textures = [this.motionMap, this.lookMap].map(({ image }) => image.data);
    return [...lists, ...shared, ...textures].reduce((sum, { byteLength }) => sum + byteLength, 0);
  }

  draw() {
    this.showLines();
    this.renewShadows();
    this.uniforms.painted.value = this.isTinted || this.picked.size > 0 ? 1 : 0;
    this.renderer.render(this.scene, this.camera);
  }
}
