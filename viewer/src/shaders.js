// SPDX-License-Identifier: GPL-3.0-or-later
// Every vertex knows the number of its part; where that part is and how it looks stands in two
// textures of floats, which are all that changes from one frame to the next.
import {
  DoubleSide,
  GLSL3,
  MeshDepthMaterial,
  MeshLambertMaterial,
  RGBADepthPacking,
  ShaderMaterial,
} from "three";

export const kTextureWidth = 2048;
/** Texels per part of the textures: motion (see motion.js), look (see scene.js). */
export const kMotionTexels = 4,
  kLookTexels = 3;

const kPlacing = /* glsl */ `
uniform highp sampler2D motionMap;
uniform highp sampler2D lookMap;
uniform float explode;
attribute float part;
vec4 partTexel(highp sampler2D map, uint texels, uint k) {
  uint i = uint(part + 0.5) * texels + k;
  return texelFetch(map, ivec2(i % ${kTextureWidth}u, i / ${kTextureWidth}u), 0);
}
vec4 motionTexel(uint k) { return partTexel(motionMap, ${kMotionTexels}u, k); }
vec4 lookTexel(uint k) { return partTexel(lookMap, ${kLookTexels}u, k); }
vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec3 placedBy(vec4 at, vec4 q, vec3 v) {
  vec3 result = at.xyz + at.w * turned(q, v);
  if (explode != 0.0) result += explode * lookTexel(2u).yzw;
  return result;
}
vec3 placed(vec3 v) { return placedBy(motionTexel(0u), motionTexel(1u), v); }
`;

// The paper's colours: red for force, green for torque, yellow for both, blue for a failed joint.
const kLights = /* glsl */ `
vec4 lightOf(vec3 load) {
  if (load.z > 0.5) return vec4(0.0116, 0.0887, 0.9131, 1.0);
  float most = max(load.x, load.y);
  if (most <= 0.0) return vec4(0.0);
  vec3 pure = load.x > load.y ? vec3(0.807, 0.013, 0.008) : vec3(0.0116, 0.4342, 0.0343);
  return vec4(mix(pure, vec3(1.0, 0.6308, 0.0), min(load.x, load.y) / most), pow(most, 0.7));
}
`;

function patched(shader, uniforms) {
  Object.assign(shader.uniforms, uniforms);
  shader.vertexShader = shader.vertexShader
    .replace(
      "#include <common>",
      `#include <common>
${kPlacing}
uniform float showLoads;
varying vec4 tint;
varying vec3 along;
flat varying vec4 load0, load1;
flat varying float picked;`,
    )
    .replace(
      "#include <beginnormal_vertex>",
      "vec4 turn = motionTexel(1u);\nvec3 objectNormal = turned(turn, normal);",
    )
    .replace(
      "#include <begin_vertex>",
      `vec3 transformed = placedBy(motionTexel(0u), turn, position);
vec4 form = lookTexel(1u);
tint = lookTexel(0u);
along = vec3(position.z, form.x, form.y);
load0 = load1 = vec4(0.0);
if (showLoads > 0.5) {
  load0 = motionTexel(2u);
  load1 = motionTexel(3u);
}
picked = form.z;`,
    );
  shader.fragmentShader = shader.fragmentShader
    .replace(
      "#include <common>",
      `// So that both sides may be shown without another shader.
#ifndef DOUBLE_SIDED
#define DOUBLE_SIDED
#endif
#include <common>
uniform float showLoads;
varying vec4 tint;
varying vec3 along;
flat varying vec4 load0, load1;
flat varying float picked;
${kLights}`,
    )
    .replace(
      "#include <color_fragment>",
      `#include <color_fragment>
diffuseColor.rgb = mix(diffuseColor.rgb, tint.rgb, tint.a);
if (showLoads > 0.5 && along.y > 0.0) {
  vec4 l0 = lightOf(load0.xyz), l1 = lightOf(load1.xyz);
  float near0 = clamp(1.0 - (along.x + along.y) / along.z, 0.0, 1.0);
  float near1 = clamp(1.0 - (along.y - along.x) / along.z, 0.0, 1.0);
  diffuseColor.rgb = mix(diffuseColor.rgb, l0.rgb, l0.a * near0);
  diffuseColor.rgb = mix(diffuseColor.rgb, l1.rgb, l1.a * near1);
}
diffuseColor.rgb = mix(diffuseColor.rgb, vec3(1.0, 0.45, 0.02), 0.75 * picked);`,
    )
    .replace(
      "#include <emissivemap_fragment>",
      "#include <emissivemap_fragment>\ntotalEmissiveRadiance += picked * vec3(0.22, 0.1, 0.0);",
    );
}

export function surfaceMaterial(options, uniforms) {
  const material = new MeshLambertMaterial({
    ...options,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  material.onBeforeCompile = (shader) => patched(shader, uniforms);
  return material;
}

export function shadowMaterial(uniforms) {
  const material = new MeshDepthMaterial({ depthPacking: RGBADepthPacking, side: DoubleSide });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", `#include <common>\n${kPlacing}`)
      .replace("#include <begin_vertex>", "vec3 transformed = placed(position);");
  };
  return material;
}

/** Lines fade where a part is only a few pixels wide, and in what has not moved yet. */
export function lineMaterial(uniforms) {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    uniforms,
    transparent: true,
    depthWrite: false,
    vertexShader: `${kPlacing.replace("attribute", "in")}
uniform float pixels;
out float strength;
void main() {
  vec4 seen = modelViewMatrix * vec4(placed(position), 1.0);
  gl_Position = projectionMatrix * seen;
  vec4 form = lookTexel(1u);
  float size = lookTexel(2u).x * pixels / max(gl_Position.w, 1e-6);
  bool moved = motionTexel(2u).w > 0.5;
  strength = max(moved ? 0.75 : form.w, form.z) * smoothstep(1.5, 14.0, size);
}`,
    fragmentShader: `uniform vec3 ink;
in float strength;
out vec4 colour;
void main() {
  if (strength < 0.01) discard;
  colour = vec4(ink, strength);
}`,
  });
}

/** Lines between parts: whole while both ends see the bond at the same place. */
export function graphMaterial(uniforms) {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    uniforms,
    transparent: true,
    depthTest: false,
    depthWrite: false,
    vertexShader: `${kPlacing.replace("attribute", "in")}
in float other;      // the other part; below 0: the world
in vec3 shared;      // the bond in this part's frame
in vec3 facing;      // the same in the other's, or in the world
in float reach;      // m, above which it is broken
in float value;      // utilisation; below 0: not known
in float ended;      // s, when it broke
uniform float time;
out vec4 paint;
vec3 seenBy(int index, vec3 v) {
  int i = index * ${kMotionTexels};
  vec4 at = texelFetch(motionMap, ivec2(i % ${kTextureWidth}, i / ${kTextureWidth}), 0);
  ++i;
  vec4 q = texelFetch(motionMap, ivec2(i % ${kTextureWidth}, i / ${kTextureWidth}), 0);
  return at.xyz + turned(q, v) * at.w;
}
void main() {
  vec3 here = seenBy(int(part + 0.5), shared);
  vec3 there = other < -0.5 ? facing : seenBy(int(other + 0.5), facing);
  bool broken = time >= ended || distance(here, there) > reach;
  vec3 good = mix(vec3(0.05, 0.45, 0.85), vec3(0.95, 0.35, 0.05), clamp(value, 0.0, 1.0));
  paint = broken ? vec4(0.9, 0.1, 0.1, 0.22) : vec4(good, 0.85);
  if (motionTexel(0u).w < 1e-6) paint.a = 0.0;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(placed(position), 1.0);
  gl_PointSize = broken ? 5.0 : 7.0;
}`,
    fragmentShader: `in vec4 paint;
out vec4 colour;
uniform float round;
void main() {
  if (paint.a < 0.01) discard;
  if (round > 0.5 && distance(gl_PointCoord, vec2(0.5)) > 0.5) discard;
  colour = vec4(pow(paint.rgb, vec3(1.0 / 2.2)), paint.a);
}`,
  });
}

/**
 * Surfaces for slow machines: lit in the vertices, by the sky and the sun without shadows. The
 * colours of loads are left to surfaceMaterial(). `isStill`: vertices are where they belong.
 */
export function fastMaterial({ color, vertexColors, isStill }, uniforms) {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    defines: isStill ? { IS_STILL: "" } : {},
    uniforms: { ...uniforms, base: { value: color } },
    vertexColors,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: `${kPlacing.replace("attribute", "in")}
uniform vec3 base, skyLight, groundLight, sunLight, sunWay;
uniform float painted;
flat out vec3 shade;
void main() {
#ifdef IS_STILL
  vec3 n = normal, at = position;
#else
  vec4 turn = motionTexel(1u);
  vec3 n = turned(turn, normal), at = placedBy(motionTexel(0u), turn, position);
#endif
  gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
  vec3 own = base;
#ifdef USE_COLOR_ALPHA
  own *= color.rgb;
#endif
  if (painted > 0.5) {
    vec4 tint = lookTexel(0u);
    own = mix(own, tint.rgb, tint.a);
    own = mix(own, vec3(1.0, 0.45, 0.02), 0.75 * lookTexel(1u).z);
  }
  vec3 light = mix(groundLight, skyLight, 0.5 * n.y + 0.5) + sunLight * max(dot(n, sunWay), 0.0);
  shade = pow(clamp(own * light, 0.0, 1.0), vec3(1.0 / 2.2));
}`,
    fragmentShader: `flat in vec3 shade;
out vec4 colour;
void main() { colour = vec4(shade, 1.0); }`,
  });
}
