// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and words as people read them.

/** Three or four digits, powers of ten where they are shorter. */
export function number(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size >= 1e5 || size < 1e-3) {
    const [digits, power] = value.toExponential(2).split("e");
    const raised = [...String(Number(power))]
      .map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"["0123456789".indexOf(c)] ?? "⁻")
      .join("");
    return `${Number(digits)}·10${raised}`.replace(/^-/, "−");
  }
  const text = Number.isInteger(value)
    ? String(value)
    : Number(value.toPrecision(size >= 1000 ? 5 : 3)).toString();
  return text.replace(/^-/, "−").replace(/\B(?=(\d{3})+(?!\d)(?<!\.\d*))/g, " ");
}

const kPrefixes = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
];
/** With a prefix: 12.3 kJ. */
export function quantity(value, unit) {
  if (!Number.isFinite(value)) return `${number(value)} ${unit}`;
  const [size, prefix] = kPrefixes.find(([scale]) => Math.abs(value) >= scale) ?? [1, ""];
  return `${number(value / size)} ${prefix}${unit}`;
}

export function count(value, word) {
  return `${number(value)} ${word}${value === 1 ? "" : "s"}`;
}

export function seconds(value) {
  return `${value.toFixed(3)} s`;
}
