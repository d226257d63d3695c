// What the page knows of gamepads, and the settings of the stick, which are this browser's own.

import { Gamepads } from "../input/gamepad.js";
import { USUAL_EXPO } from "../input/curve.js";
import { keep, kept } from "../kept.js";

const LOOK_MS = 120;
const $ = (id) => document.getElementById(id);

export class Inputs {
  constructor(stick, gamepads) {
    this.stick = stick;
    this.gamepads = gamepads;
    this.rows = new Map();
    this.range($("expo"), "expo", String(USUAL_EXPO), (value) => {
      stick.expo = Number(value);
      $("expo-value").textContent = Number(value).toFixed(1);
    });
    this.either($("deadman"), "deadman", "stick", (value) => (gamepads.button = value === "button"));
    setInterval(() => this.show(), LOOK_MS);
  }

  range(control, name, usual, use) {
    const value = kept(name, usual);
    control.value = value;
    if (control.value !== value) control.value = usual;
    use(control.value);
    control.addEventListener("input", () => {
      keep(name, control.value);
      use(control.value);
    });
  }

  // One of a few buttons. Not a list that opens: while the browser's own is open, no key reaches the page, nor does Stop.
  either(group, name, usual, use) {
    const buttons = [...group.querySelectorAll("button")];
    const choose = (value) => {
      for (const button of buttons) button.setAttribute("aria-pressed", button.dataset.value === value);
      use(value);
    };
    const value = kept(name, usual);
    choose(buttons.some((button) => button.dataset.value === value) ? value : usual);
    for (const button of buttons) {
      button.addEventListener("click", () => {
        keep(name, button.dataset.value);
        choose(button.dataset.value);
      });
    }
  }

  show() {
    const { pads, asking } = this.gamepads;
    $("pads-none").hidden = pads.size > 0;
    if (!pads.size) put($("pads-none"), `Gamepads: ${lower(Gamepads.why())}`);
    for (const slot of this.rows.keys()) {
      if (pads.has(slot)) continue;
      this.rows.get(slot).remove();
      this.rows.delete(slot);
    }
    for (const [slot, one] of pads) {
      if (!this.rows.has(slot)) this.rows.set(slot, this.row(slot));
      const row = this.rows.get(slot);
      put(row.querySelector("b"), one.name);
      put(row.querySelector("small"), asking?.slot === slot ? asking.say : this.state(one));
      row.dataset.drives = this.gamepads.holds === one;
      const [dot] = row.querySelectorAll("circle.dot");
      dot.setAttribute("cx", one.x * 10);
      dot.setAttribute("cy", -one.y * 10);
      put(row.querySelector("output"), one.down.flatMap((is, k) => (is ? [k] : [])).join(" "));
      const button = row.querySelector("button");
      button.hidden = Boolean(one.layout) && asking?.slot !== slot;
      put(button, asking?.slot === slot ? "Give up" : "Set up");
    }
  }

  row(slot) {
    const row = document.createElement("li");
    row.innerHTML = `<svg viewBox="-14 -14 28 28" aria-hidden="true"><circle r="13"/><circle class="dot" r="4"/></svg>
      <span><b></b><small></small></span><output aria-label="Buttons that are down"></output><button class="btn" hidden></button>`;
    row.querySelector("button").addEventListener("click", () => this.gamepads.setUp(slot));
    $("pads").append(row);
    return row;
  }

  state(one) {
    if (!one.layout) return "does not drive: this browser does not know its layout. Any of its buttons stops.";
    if (this.gamepads.holds === one) return "drives";
    if (!one.centred) return this.gamepads.button ? "let go of its button and stick first" : "let its stick go to the centre first";
    return "ready";
  }
}

const lower = (text) => text[0].toLowerCase() + text.slice(1);
const put = (element, text) => {
  if (element.textContent !== text) element.textContent = text;
};
