// SPDX-License-Identifier: GPL-3.0-or-later
// Poses as 8 numbers: x y z scale, quaternion x y z w. Scales are uniform.

export const kIdentity = [0, 0, 0, 1, 0, 0, 0, 1];

/** Turns (x, y, z) by the pose at `at` in `poses`, with its scale and place; into out[0..2]. */
export function place(poses, at, x, y, z, out) {
  const s = poses[at + 3],
    qx = poses[at + 4],
    qy = poses[at + 5],
    qz = poses[at + 6],
    qw = poses[at + 7];
  const tx = 2 * (qy * z - qz * y),
    ty = 2 * (qz * x - qx * z),
    tz = 2 * (qx * y - qy * x);
  out[0] = poses[at] + s * (x + qw * tx + qy * tz - qz * ty);
  out[1] = poses[at + 1] + s * (y + qw * ty + qz * tx - qx * tz);
  out[2] = poses[at + 2] + s * (z + qw * tz + qx * ty - qy * tx);
  return out;
}

/** a × b into out at `at`: first b, then a. */
export function compose(a, aAt, b, bAt, out, at) {
  const ax = a[aAt + 4],
    ay = a[aAt + 5],
    az = a[aAt + 6],
    aw = a[aAt + 7];
  const bx = b[bAt + 4],
    by = b[bAt + 5],
    bz = b[bAt + 6],
    bw = b[bAt + 7];
  const scale = a[aAt + 3] * b[bAt + 3];
  place(a, aAt, b[bAt], b[bAt + 1], b[bAt + 2], kScratch);
  ((out[at] = kScratch[0]),
    (out[at + 1] = kScratch[1]),
    (out[at + 2] = kScratch[2]),
    (out[at + 3] = scale));
  out[at + 4] = aw * bx + ax * bw + ay * bz - az * by;
  out[at + 5] = aw * by - ax * bz + ay * bw + az * bx;
  out[at + 6] = aw * bz + ax * by - ay * bx + az * bw;
  out[at + 7] = aw * bw - ax * bx - ay * by - az * bz;
}
const kScratch = [0, 0, 0];

/** Where a point in the world lies in the pose's own frame. */
export function unplace(poses, at, x, y, z, out) {
  const inverse = [0, 0, 0, 1, -poses[at + 4], -poses[at + 5], -poses[at + 6], poses[at + 7]];
  const s = poses[at + 3] || 1;
  return place(
    inverse,
    0,
    (x - poses[at]) / s,
    (y - poses[at + 1]) / s,
    (z - poses[at + 2]) / s,
    out,
  );
}
