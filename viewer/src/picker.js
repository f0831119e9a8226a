// SPDX-License-Identifier: GPL-3.0-or-later
// Which part is under a pixel: the scene is drawn into one pixel, in numbers instead of colours.
import { Color, WebGLRenderTarget } from "three";
import { pickMaterial } from "./shaders.js";

export class Picker {
  constructor(world) {
    this.world = world;
    this.target = new WebGLRenderTarget(1, 1);
    this.pixel = new Uint8Array(4);
    this.material = pickMaterial(world.uniforms);
  }

  /** The part at a place in CSS pixels from the canvas's corner; null: none. */
  async at(x, y) {
    const { renderer, scene, camera, model } = this.world;
    const { clientWidth: width, clientHeight: height } = renderer.domElement;
    const background = scene.background,
      auto = renderer.shadowMap.needsUpdate;
    const colour = renderer.getClearColor(new Color()),
      alpha = renderer.getClearAlpha();
    camera.setViewOffset(width, height, x, y, 1, 1);
    camera.layers.set(1);
    scene.background = null;
    scene.overrideMaterial = this.material;
    renderer.shadowMap.needsUpdate = false;
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(scene, camera);
    const reading = renderer.readRenderTargetPixelsAsync(this.target, 0, 0, 1, 1, this.pixel);
    renderer.setRenderTarget(null);
    renderer.setClearColor(colour, alpha);
    renderer.shadowMap.needsUpdate = auto;
    scene.overrideMaterial = null;
    scene.background = background;
    camera.layers.set(0);
    camera.clearViewOffset();
    const [r, g, b] = await reading;
    return model.parts[r + 256 * g + 65536 * b - 1] ?? null;
  }
}
