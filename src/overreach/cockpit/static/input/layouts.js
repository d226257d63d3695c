// Which axes and buttons of a gamepad mean what. Browsers know it of most pads ("standard"); of the others the operator
// shows it once, and this browser keeps it by the pad's name. `axis`: [number, sign of right or of forward].

import { keep as keepSetting, kept } from "../kept.js";

const STANDARD = { x: [0, 1], y: [1, -1], stop: 1, arm: 9, hold: [4, 5] };

const NAME = "gamepads";
let own = null;
const all = () => (own ??= parsed(kept(NAME)));
const parsed = (text) => {
  try {
    return JSON.parse(text) ?? {};
  } catch {
    return {};
  }
};

export const layoutOf = (pad) => (pad.mapping === "standard" ? STANDARD : all()[pad.id] ?? null);

export function keep(id, layout) {
  all()[id] = layout;
  keepSetting(NAME, JSON.stringify(own));
}

// Which buttons are down; some entries have holes where a button should be.
export const downs = (pad) => Array.from(pad.buttons, (button) => Boolean(button?.pressed));

export const read = (pad, [axis, sign]) => sign * (pad.axes[axis] ?? 0) || 0;

const FAR = 0.6; // an axis that has gone this far from where it was is meant
const BACK = 0.25;
const STEPS = [
  { say: "Push the stick that shall drive forward, and let go.", takes: "axis", part: "y" },
  { say: "Push it to the right, and let go.", takes: "axis", part: "x" },
  { say: "Press the button that shall stop.", takes: "button", part: "stop" },
  { say: "Press the button that shall arm.", takes: "button", part: "arm" },
  { say: "Press the button that is held as dead-man.", takes: "button", part: "hold" },
];

// Asks for a pad's layout, step by step; `look` is called with every reading, and returns the layout when it is known.
export class Asking {
  constructor(slot, pad) {
    this.slot = slot;
    this.rest = [...pad.axes];
    this.layout = {};
    this.step = 0;
    this.moved = null; // [axis, sign] that has gone far and is not back yet
    this.was = downs(pad);
  }

  get say() {
    return STEPS[this.step].say;
  }

  look(pad) {
    const { takes, part } = STEPS[this.step];
    const found = takes === "axis" ? this.axis(pad) : this.button(pad);
    this.was = downs(pad);
    if (found === null) return null;
    this.layout[part] = part === "hold" ? [found] : found;
    this.step += 1;
    return this.step === STEPS.length ? this.layout : null;
  }

  axis(pad) {
    const off = pad.axes.map((value, k) => value - (this.rest[k] ?? 0));
    if (!this.moved) {
      const k = off.findIndex((value, one) => Math.abs(value) > FAR && one !== this.layout.y?.[0]);
      if (k >= 0) this.moved = [k, Math.sign(off[k])];
      return null;
    }
    if (Math.abs(off[this.moved[0]]) > BACK) return null;
    const found = this.moved;
    this.moved = null;
    return found;
  }

  button(pad) {
    const used = [this.layout.stop, this.layout.arm];
    const k = downs(pad).findIndex((is, one) => is && !this.was[one] && !used.includes(one));
    return k >= 0 ? k : null;
  }
}
