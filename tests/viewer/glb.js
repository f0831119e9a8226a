// SPDX-License-Identifier: GPL-3.0-or-later
// GLB files taken apart and put together, for tests.

export function readGlb(bytes) {
  const length = bytes.readUInt32LE(12);
  return {
    json: JSON.parse(bytes.toString("utf8", 20, 20 + length)),
    binary: Buffer.from(bytes.subarray(28 + length)),
  };
}

function padded(buffer, filler) {
  return Buffer.concat([buffer, Buffer.alloc((4 - (buffer.length % 4)) % 4, filler)]);
}

export function writeGlb({ json, binary }) {
  const body = padded(binary, 0);
  if (json.buffers) json.buffers[0].byteLength = body.length;
  const text = padded(Buffer.from(JSON.stringify(json)), " ");
  const head = Buffer.alloc(20),
    mark = Buffer.alloc(8);
  (head.write("glTF"),
    head.writeUInt32LE(2, 4),
    head.writeUInt32LE(28 + text.length + body.length, 8));
  (head.writeUInt32LE(text.length, 12), head.write("JSON", 16));
  (mark.writeUInt32LE(body.length), mark.write("BIN\0", 4));
  return Buffer.concat([head, text, mark, body]);
}

function turned([x, y, z, w], [a, b, c]) {
  const tx = 2 * (y * c - z * b),
    ty = 2 * (z * a - x * c),
    tz = 2 * (x * b - y * a);
  return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
}

/**
 * Puts a run of 1 s with joints into a building's file: `utilisation(j, time)` of joint j, which breaks at
 * `broken(j)` s or never (null). The joints are those that members name at their ends.
 */
export function addRun(glb, { utilisation, broken }) {
  const { json } = glb;
  const ends = new Map();
  json.nodes.forEach((node, index) =>
    node.extras?.sunder?.ends?.forEach((names, end) =>
      names.forEach((name) => {
        if (!ends.has(name)) ends.set(name, []);
        ends.get(name).push({ index, end });
      }),
    ),
  );
  const nodeOf = new Map(json.nodes.map((node, index) => [node.name, index]));
  const names = [...ends.keys()];
  const times = Array.from({ length: 51 }, (_, k) => k / 50);
  const rows = new Uint16Array(times.length * names.length);
  times.forEach((time, t) =>
    names.forEach(
      (_, j) =>
        (rows[t * names.length + j] = time >= (broken(j) ?? 9) ? 0 : 1000 * utilisation(j, time)),
    ),
  );
  glb.binary = padded(glb.binary, 0);
  json.bufferViews.push({ buffer: 0, byteOffset: glb.binary.length, byteLength: rows.byteLength });
  glb.binary = Buffer.concat([glb.binary, Buffer.from(rows.buffer)]);
  const points = names.map((name) => {
    const { index, end } = ends.get(name)[0];
    const node = json.nodes[index];
    const half = (node.extras.sunder.length / 2) * (end ? 1 : -1);
    return turned(node.rotation ?? [0, 0, 0, 1], [0, 0, half]).map(
      (v, k) => v + node.translation[k],
    );
  });
  const parts = names.map((name) =>
    name.split("@").map((part) => (part === "ground" ? -1 : nodeOf.get(part))),
  );
  const endOf = (j, node) => ends.get(names[j]).find(({ index }) => index === node)?.end ?? 2;
  json.extras = {
    sunder: {
      run: {
        verb: "collapse",
        seed: 7,
        times,
        kinetic: times.map((t) => 1e5 * t * t),
        friction: times.map((t) => 4e4 * t),
        broken_joints: times.map((t) => names.filter((_, j) => (broken(j) ?? 9) <= t).length),
        max_utilisation: times.map((t) => 0.4 + t),
      },
      joints: {
        names,
        parts,
        ends: parts.map((pair, j) => pair.map((node) => endOf(j, node))),
        points,
        broken: names.map((_, j) => broken(j)),
        times,
        utilisation: { bufferView: json.bufferViews.length - 1, componentType: 5123, scale: 0.001 },
      },
      events: [
        {
          time: 0.4,
          wall: "",
          point: points[0],
          speed: 0,
          utilisation: 1.2,
          bonds_broken: 0,
          chunks_freed: 0,
        },
      ],
    },
  };
  return { names, points };
}

/** Gives every part the same motion: none until 0.4 s, then half a metre along z within 0.1 s. */
export function moveAll(glb) {
  const { json } = glb;
  const values = Float32Array.of(0.4, 0.5, 0, 0, 0, 0, 0, 0.5);
  glb.binary = padded(glb.binary, 0);
  const view = json.bufferViews.push({
    buffer: 0,
    byteOffset: glb.binary.length,
    byteLength: values.byteLength,
  });
  glb.binary = Buffer.concat([glb.binary, Buffer.from(values.buffer)]);
  const common = { bufferView: view - 1, componentType: 5126, count: 2 };
  const input = json.accessors.push({ ...common, type: "SCALAR", min: [0.4], max: [0.5] }) - 1;
  const output = json.accessors.push({ ...common, byteOffset: 8, type: "VEC3" }) - 1;
  const parts = json.nodes.flatMap((node, i) => (node.mesh === undefined ? [] : [i]));
  json.animations = [
    {
      samplers: [{ input, output }],
      channels: parts.map((node) => ({ sampler: 0, target: { node, path: "translation" } })),
    },
  ];
}
