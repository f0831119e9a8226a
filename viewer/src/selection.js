// SPDX-License-Identifier: GPL-3.0-or-later
// What was clicked, and the panel with its numbers.
import { element, fillRows } from "./choices.js";
import { jointRows, partRows } from "./numbers.js";

const $ = (id) => document.getElementById(id);
const kNear = 14; // CSS pixels within which a click finds a joint
const kStill = 4; // CSS pixels that a click may move; more is a drag

function isJoint(thing) {
  return thing.point !== undefined;
}

export class Selection {
  /** `onChange` is called when the picture must be drawn anew. */
  constructor(world, onChange) {
    Object.assign(this, { world, onChange, thing: null });
    const canvas = $("view");
    let down = null;
    canvas.addEventListener("pointerdown", (event) => (down = event));
    canvas.addEventListener("pointerup", (event) => {
      const moved = down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY);
      if (down && event.button === 0 && moved < kStill) this.click(event);
      down = null;
    });
    $("drop").onclick = () => this.select(null);
  }

  /** Another model is shown; `speeds` are those of the colours, m/s. */
  reset(model, speeds) {
    Object.assign(this, { model, speeds, thing: null });
    this.select(null);
  }

  click(event) {
    if (!this.model) return;
    const box = $("view").getBoundingClientRect();
    const x = event.clientX - box.left;
    const y = event.clientY - box.top;
    this.select(this.jointAt(x, y) ?? this.world.picker.at(x, y));
  }

  jointAt(x, y) {
    if (!this.world.graph.object.visible) return null;
    let best = null;
    let nearest = kNear;
    for (const joint of this.model.joints) {
      const at = this.world.onScreen(joint);
      const distance = at ? Math.hypot(at.x - x, at.y - y) : Infinity;
      if (distance >= nearest) continue;
      nearest = distance;
      best = joint;
    }
    return best;
  }

  /** Shows the numbers of a part or joint; null: of nothing. */
  select(thing) {
    for (const part of this.parts()) this.world.mark(part, false);
    this.thing = thing;
    for (const part of this.parts()) this.world.mark(part, true);
    $("selection").hidden = !thing;
    if (thing) {
      $("picked").textContent = thing.name;
      this.fillRelated();
      this.tell(this.time);
    }
    this.onChange();
  }

  parts() {
    if (!this.thing) return [];
    return isJoint(this.thing) ? [this.thing.a, this.thing.b].filter(Boolean) : [this.thing];
  }

  fillRelated() {
    const others = isJoint(this.thing) ? this.parts() : (this.thing.joints ?? []);
    const buttons = others.map((other) => {
      const button = element("button", { type: "button", textContent: other.name });
      button.onclick = () => this.select(other);
      return button;
    });
    $("related").replaceChildren(...buttons);
  }

  /** The numbers at a time. */
  tell(time) {
    this.time = time;
    const { thing, model, speeds } = this;
    if (!thing) return;
    if (isJoint(thing)) return fillRows($("numbers"), jointRows(thing, model, time));
    speeds[thing.index] = model.motion.speedOf(thing, time);
    fillRows($("numbers"), partRows(thing, model, speeds));
  }
}
