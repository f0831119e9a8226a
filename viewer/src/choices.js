// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of buttons of the panel, and its lists of numbers.

export function element(tag, properties) {
  return Object.assign(document.createElement(tag), properties);
}

// A radio button or box that looks like a button; `why` it cannot be used, or null.
function choice(input, text, why, letter) {
  input.disabled = why !== null;
  const label = element("label", { title: why ?? `Key ${letter}` });
  label.append(input, element("span", { textContent: text }));
  return label;
}

/** Buttons of the colours, of which one is on. */
export function modeChoices(modes, onPick) {
  return modes.map((mode, i) => {
    const input = element("input", { type: "radio", name: "mode", id: `mode-${mode.id}` });
    input.onchange = () => onPick(mode.id);
    return choice(input, mode.label, mode.has ? null : `This file has no ${mode.why}`, i + 1);
  });
}

export const kToggles = [
  { id: "edges", text: "Edges", letter: "e" },
  { id: "wireframe", text: "Wireframe", letter: "w" },
  { id: "outer", text: "Outer faces", letter: "o", lacks: "inner faces" },
  { id: "graph", text: "Graph", letter: "g", lacks: "bonds or joints" },
  { id: "shadows", text: "Shadows", letter: "s" },
];

/** Buttons of what is shown; `missing` has the ids of those that the file has nothing for. */
export function toggleChoices(shown, missing, onChange) {
  return kToggles.map(({ id, text, letter, lacks }) => {
    const input = element("input", { type: "checkbox", id: `toggle-${id}`, checked: shown[id] });
    input.onchange = () => onChange(id, input.checked);
    const why = missing.includes(id) ? `This file has no ${lacks}` : null;
    return choice(input, text, why, letter.toUpperCase());
  });
}

/** Fills a <dl> with rows of [name, text]. */
export function fillRows(list, rows) {
  list.replaceChildren(
    ...rows.flatMap(([name, text]) => [
      element("dt", { textContent: name }),
      element("dd", { textContent: text }),
    ]),
  );
}
