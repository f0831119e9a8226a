// SPDX-License-Identifier: GPL-3.0-or-later
// What the panel says of a part or joint at a time: rows of [name, text].
import { utilisationAt } from "./model.js";
import { compose, place } from "./pose.js";
import { number, quantity, seconds } from "./text.js";

const vector = (v) => v.map((x) => number(Number(x.toFixed(3)))).join(", ");

export const kindNames = {
  chunk: "chunk",
  member: "member",
  panel: "slab or wall",
  projectile: "projectile",
  part: "mesh",
};

function bondRows(part, model) {
  if (!part.bonds) return [];
  let broken = 0,
    area = 0;
  for (const index of part.bonds) {
    const bond = model.bonds[index];
    if (isBondBroken(bond, model.motion)) ++broken;
    area += bond.area;
  }
  return [
    ["bonds", `${part.bonds.length}, ${broken} of them broken`],
    ["bonded area", `${number(area)} m²`],
  ];
}

const kRest = new Float64Array(8),
  kHere = [0, 0, 0],
  kThere = [0, 0, 0];
/** True when the two sides of a bond are not at the same place any more. */
export function isBondBroken({ a, b, at, area }, motion) {
  place(motion.state, 16 * a.index, ...at, kHere);
  if (b) place(motion.state, 16 * b.index, ...at, kThere);
  else {
    compose(a.parentPose, 0, a.pose, 0, kRest, 0);
    place(kRest, 0, ...at, kThere);
  }
  return (
    Math.hypot(kHere[0] - kThere[0], kHere[1] - kThere[1], kHere[2] - kThere[2]) >
    0.02 * Math.sqrt(area) + 1e-4
  );
}

export function partRows(part, model, speeds) {
  const { extras } = part;
  const rows = [["kind", kindNames[part.kind]]];
  if (part.wall) rows.push(["of", part.wall.name]);
  const material = extras.material ?? part.wall?.extras.material;
  if (material) rows.push(["material", material]);
  if (part.mass !== undefined) rows.push(["mass", `${number(part.mass)} kg`]);
  if (part.volume !== undefined) rows.push(["volume", `${number(part.volume)} m³`]);
  if (extras.radius !== undefined) rows.push(["radius", `${number(extras.radius)} m`]);
  if (extras.length !== undefined) rows.push(["length", `${number(extras.length)} m`]);
  rows.push(["centre", `${vector(model.motion.centre(part))} m`]);
  if (model.motion.movers.length > 0) {
    const speed = speeds[part.index];
    rows.push(["speed", `${number(Number(speed.toPrecision(3)))} m/s`]);
    if (part.mass !== undefined)
      rows.push(["kinetic energy", quantity(0.5 * part.mass * speed * speed, "J")]);
  }
  return [...rows, ...bondRows(part, model)];
}

export function jointRows(joint, model, time) {
  const rows = [
    ["kind", "joint"],
    ["joins", [joint.a?.name ?? "ground", joint.b?.name ?? "ground"].join(" and ")],
  ];
  const value = utilisationAt(model.utilisation, joint, time);
  if (value !== undefined)
    rows.push(["utilisation", time >= joint.broken ? "broken" : number(value)]);
  rows.push([
    "breaks",
    Number.isFinite(joint.broken) ? `at ${seconds(joint.broken)}` : "not in this run",
  ]);
  rows.push(["place", `${vector(joint.point)} m`]);
  const told = model.report?.broken_joints?.find?.((entry) => entry.joint === joint.name);
  if (told)
    rows.push(
      ["by", [told.mode, told.rule, told.component].filter(Boolean).join(", ")],
      ["load at break", number(told.utilisation)],
    );
  return rows;
}

/** The plain numbers of a report, in its own order; lists as their length. */
export function reportRows(report) {
  const rows = [];
  const add = (key, value) => {
    const name = key.replaceAll("_", " ");
    if (typeof value === "number") rows.push([name, number(value)]);
    else if (typeof value === "string" || typeof value === "boolean")
      rows.push([name, String(value)]);
    else if (Array.isArray(value) && value.length > 0 && value.every((v) => typeof v === "number"))
      rows.push([name, value.map(number).join(", ")]);
    else if (Array.isArray(value))
      rows.push([
        name,
        value.every((v) => typeof v === "string") && value.length > 0
          ? value.join("; ")
          : `${value.length}`,
      ]);
    else if (value && typeof value === "object" && !key.includes(" "))
      for (const [inner, v] of Object.entries(value)) add(`${key} ${inner}`, v);
  };
  for (const [key, value] of Object.entries(report ?? {})) add(key, value);
  return rows;
}
