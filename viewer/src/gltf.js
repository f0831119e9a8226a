// SPDX-License-Identifier: GPL-3.0-or-later
// glTF 2.0 as far as meshes, materials, images and node animations go; extras are left as they are.

const kWidths = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
const kArrays = {
  5120: Int8Array,
  5121: Uint8Array,
  5122: Int16Array,
  5123: Uint16Array,
  5125: Uint32Array,
  5126: Float32Array,
};
const kLargest = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };

class Gltf {
  constructor(json, binary) {
    this.json = json;
    this.binary = binary;
    this.known = new Map();
  }

  /** Bytes of a buffer view. */
  bytes(index) {
    const view = this.json.bufferViews[index];
    return this.binary.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
  }

  /** A buffer view as whole numbers of one type, as extras refer to them. */
  numbers(index, componentType) {
    const bytes = this.bytes(index);
    const Kind = kArrays[componentType];
    return new Kind(bytes.slice().buffer, 0, Math.floor(bytes.length / Kind.BYTES_PER_ELEMENT));
  }

  /** An accessor's values, `width` per element. Normalized integers become floats. */
  accessor(index) {
    let found = this.known.get(index);
    if (!found) this.known.set(index, (found = this.read(this.json.accessors[index])));
    return found;
  }

  read(accessor) {
    if (!accessor || accessor.sparse) throw new Error("the file has sparse or missing accessors");
    const width = kWidths[accessor.type];
    const Kind = kArrays[accessor.componentType];
    const size = Kind.BYTES_PER_ELEMENT;
    const count = accessor.count;
    if (accessor.bufferView === undefined) return { array: new Kind(count * width), width, count };
    const view = this.json.bufferViews[accessor.bufferView];
    const stride = view.byteStride ?? width * size;
    const start = this.binary.byteOffset + (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    let array;
    if (stride === width * size && start % size === 0) {
      array = new Kind(this.binary.buffer, start, count * width);
    } else {
      array = new Kind(count * width);
      const target = new Uint8Array(array.buffer);
      const source = new Uint8Array(this.binary.buffer);
      for (let i = 0; i < count; ++i)
        target.set(
          source.subarray(start + i * stride, start + i * stride + width * size),
          i * width * size,
        );
    }
    if (accessor.normalized)
      array = Float32Array.from(array, (v) => v / kLargest[accessor.componentType]);
    return { array, width, count };
  }
}

/** A .glb, or a .gltf with its .bin. Throws Error with what is wrong. */
export function readGltf(bytes, companion) {
  const head = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const text = new TextDecoder();
  if (companion) return new Gltf(JSON.parse(text.decode(bytes)), companion);
  if (bytes.length < 20 || head.getUint32(0, true) !== 0x46546c67)
    throw new Error("the file is not a GLB");
  const length = head.getUint32(12, true);
  const json = JSON.parse(text.decode(bytes.subarray(20, 20 + length)));
  const at = 20 + length;
  const size = at + 8 <= bytes.length ? head.getUint32(at, true) : 0;
  return new Gltf(json, bytes.subarray(at + 8, at + 8 + size));
}
