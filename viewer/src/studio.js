// SPDX-License-Identifier: GPL-3.0-or-later
// What a model stands in: light from the sky and a sun with shadows, a ground with a grid.
import {
  Color,
  DirectionalLight,
  HemisphereLight,
  Mesh,
  PlaneGeometry,
  ShaderMaterial,
  ShadowMaterial,
  Vector3,
} from "three";

const kGridVertex = /* glsl */ `
out vec3 at;
void main() {
  vec4 p = modelMatrix * vec4(position, 1.0);
  at = p.xyz;
  gl_Position = projectionMatrix * viewMatrix * p;
}`;

// Lines one pixel wide, gone where they would be closer than two pixels, and far from the middle.
const kGridFragment = /* glsl */ `
in vec3 at;
uniform float step, extent;
uniform vec3 centre, ink;
float lines(float every) {
  vec2 x = at.xz / every, width = fwidth(x);
  vec2 away = abs(fract(x - 0.5) - 0.5) / width;
  vec2 line = clamp(1.0 - away, 0.0, 1.0) * clamp(0.5 / max(width, 1e-6) - 0.6, 0.0, 1.0);
  return max(line.x, line.y);
}
void main() {
  float fade = 1.0 - smoothstep(0.25, 1.0, distance(at, centre) / extent);
  float strength = max(0.13 * lines(step), 0.3 * lines(10.0 * step)) * fade;
  if (strength < 0.003) discard;
  gl_FragColor = vec4(ink, strength);
}`;

function gridMaterial() {
  return new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    uniforms: {
      step: { value: 1 },
      centre: { value: new Vector3() },
      extent: { value: 10 },
      ink: { value: new Color() },
    },
    vertexShader: kGridVertex,
    fragmentShader: kGridFragment,
  });
}

function plane(material, order) {
  const mesh = new Mesh(new PlaneGeometry(1, 1).rotateX(-Math.PI / 2), material);
  mesh.renderOrder = order;
  return mesh;
}

export class Studio {
  constructor(scene) {
    this.scene = scene;
    this.sky = new HemisphereLight(0xffffff, 0x8a8f9a, 1.7);
    this.sun = new DirectionalLight(0xfff4e2, 2.5);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.shade = plane(new ShadowMaterial({ depthWrite: false }), -2);
    this.shade.receiveShadow = true;
    this.grid = plane(gridMaterial(), -1);
    this.lights = {
      skyLight: { value: new Color() },
      groundLight: { value: new Color() },
      sunLight: { value: new Color() },
      sunWay: { value: new Vector3() },
    };
    scene.add(this.sky, this.sun, this.sun.target, this.shade, this.grid);
  }

  dress(isDark) {
    this.scene.background = new Color(isDark ? "#171b22" : "#e9edf2");
    this.grid.material.uniforms.ink.value.set(isDark ? "#c8d4e6" : "#41506a");
    this.sky.intensity = isDark ? 1.5 : 1.7;
    this.shade.material.opacity = isDark ? 0.42 : 0.24;
    const { lights, sky, sun } = this;
    const share = 1 / Math.PI; // of the light from where it is seen
    lights.skyLight.value.copy(sky.color).multiplyScalar(share * sky.intensity);
    lights.groundLight.value.copy(sky.groundColor).multiplyScalar(share * sky.intensity);
    lights.sunLight.value.copy(sun.color).multiplyScalar(share * sun.intensity);
  }

  /** Fits a model: `size` and `middle` of its box, height of the ground, and the camera's side. */
  fit(size, middle, ground, side) {
    for (const mesh of [this.shade, this.grid]) {
      mesh.position.set(middle.x, ground - 1e-3 * size, middle.z);
      mesh.scale.setScalar(12 * size);
    }
    const { uniforms } = this.grid.material;
    uniforms.step.value = 10 ** Math.round(Math.log10(size / 12));
    uniforms.extent.value = 3.2 * size;
    uniforms.centre.value.copy(this.grid.position);
    this.aim(size, middle, side);
  }

  // The sun comes from behind the camera's left shoulder.
  aim(size, middle, side) {
    const { sun } = this;
    const height = 0.95 * Math.hypot(side.x, side.z);
    const from = new Vector3(side.x - 0.5 * side.z, height, side.z + 0.5 * side.x).normalize();
    sun.position.copy(middle).addScaledVector(from, 3 * size);
    sun.target.position.copy(middle);
    this.lights.sunWay.value.copy(from);
    const bounds = { left: -size, right: size, top: size, bottom: -size };
    Object.assign(sun.shadow.camera, { ...bounds, near: size, far: 5.5 * size });
    sun.shadow.camera.updateProjectionMatrix();
    sun.shadow.normalBias = 0.0012 * size;
    sun.shadow.bias = -0.0004;
  }

  setShadows(isOn) {
    // Not castShadow, or all shaders would be made anew.
    this.sun.shadow.intensity = isOn ? 1 : 0;
    this.shade.visible = isOn;
  }
}
