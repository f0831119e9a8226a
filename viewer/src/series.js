// SPDX-License-Identifier: GPL-3.0-or-later
// Which time series a model has, as charts: {title, unit, isStep, lines: [{label, times, values}]}.

const kEnergies = [
  "kinetic",
  "strain",
  "fracture",
  "friction",
  "contact",
  "damping",
  "plastic",
  "numerical",
];

// How many of a list of times have come, as a line of steps.
function countOf(times, duration) {
  const sorted = [...times].filter(Number.isFinite).sort((a, b) => a - b);
  const line = { times: [0], values: [0] };
  sorted.forEach((time, i) => (line.times.push(time), line.values.push(i + 1)));
  (line.times.push(duration), line.values.push(sorted.length));
  return line;
}

/** When joints broke, s. */
export function brokenTimes(model) {
  if (model.joints.length > 0) return model.joints.map((joint) => joint.broken);
  return (model.scene.broken_joints ?? []).map((joint) => joint.time);
}

function hasValues(values) {
  return Array.isArray(values) && values.some((v) => v !== null && v !== 0);
}

function countCharts(model, duration) {
  const { run } = model;
  const lines = [];
  const broken = brokenTimes(model);
  if (hasValues(run?.broken_joints))
    lines.push({ label: "joints", times: run.times, values: run.broken_joints });
  else if (broken.some(Number.isFinite))
    lines.push({ label: "joints", ...countOf(broken, duration) });
  if (hasValues(run?.broken_bonds))
    lines.push({ label: "bonds", times: run.times, values: run.broken_bonds });
  return lines.map((line) => ({
    title: `Broken ${line.label}`,
    unit: "",
    isStep: true,
    lines: [line],
  }));
}

/** Charts, and what there was nothing for. */
export function chartsOf(model) {
  const { run, motion } = model;
  const charts = countCharts(model, motion.duration);
  const missing = [];
  if (charts.length === 0) missing.push("what broke");
  if (hasValues(run?.max_utilisation))
    charts.push({
      title: "Largest utilisation",
      unit: "",
      limit: 1,
      lines: [{ label: "utilisation", times: run.times, values: run.max_utilisation }],
    });
  else missing.push("utilisation");
  // Rounding is not worth a line of its own.
  const largest = (key) => Math.max(...(run?.[key] ?? [0]).map(Math.abs));
  const least = 1e-6 * Math.max(...kEnergies.map(largest));
  const energies = kEnergies.filter((key) => largest(key) > least);
  if (energies.length > 0)
    charts.push({
      title: "Energy",
      unit: "J",
      lines: energies.map((key) => ({ label: key, times: run.times, values: run[key] })),
    });
  else missing.push("energy");
  if (hasValues(run?.moving))
    charts.push({
      title: "Moving bodies",
      unit: "",
      isStep: true,
      lines: [{ label: "bodies", times: run.times, values: run.moving }],
    });
  return { charts, missing };
}

/** The value of a line at a time: of the sample before, or between two. */
export function valueAt({ times, values }, time, isStep) {
  let low = 0,
    high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  if (low === 0) return values[0];
  if (isStep || low === times.length || values[low] === null) return values[low - 1];
  const t = (time - times[low - 1]) / (times[low] - times[low - 1]);
  return values[low - 1] + t * (values[low] - values[low - 1]);
}
