// Gamepads, each for itself: a stick drives, B or Circle stops, Start arms. Any pad's Stop counts.
// A self-centring stick is its own dead-man, or a held button is (a setting). After any release, and at the start, a pad
// must be seen at its centre (with the button up) before it counts again, and it takes the hold from no other input.

import { Asking, downs, keep, layoutOf, read } from "./layouts.js";

const DEAD = 0.24; // below this a stick is let go of: as wide as XInput's dead zone for the left stick (7849 of 32767)
const TAKE = 0.27; // above this it takes hold
const POLL_MS = 1000 / 60;

export class Gamepads {
  constructor(stick, buttons) {
    this.stick = stick;
    this.buttons = buttons;
    this.button = false; // whether a held button is the dead-man
    this.pads = new Map(); // by slot: what is known of each
    this.holds = null; // the one that holds the stick
    this.asking = null; // of which pad the layout is being asked
    setInterval(() => this.look(), POLL_MS);
    window.addEventListener("gamepaddisconnected", () => this.look());
  }

  // The pads that this browser shows, by their slots.
  static all() {
    if (typeof navigator.getGamepads !== "function") return new Map();
    try {
      return new Map([...navigator.getGamepads()].map((pad, slot) => [slot, pad]).filter(([, pad]) => pad?.connected));
    } catch {
      return new Map(); // inside a page of another site
    }
  }

  static why() {
    if (typeof navigator.getGamepads === "function") return "None. Connect one and press a button on it: browsers show it only then.";
    if (!window.isSecureContext) return "This browser hides gamepads from a page at an address like this one: open it at http://localhost, or by https.";
    return "This browser knows no gamepads.";
  }

  look() {
    const seen = Gamepads.all();
    for (const [slot, one] of this.pads) if (!seen.has(slot) || seen.get(slot).id !== one.id) this.forget(slot, one);
    for (const [slot, pad] of seen) {
      if (!this.pads.has(slot)) this.pads.set(slot, new Known(pad));
      this.follow(slot, this.pads.get(slot), pad);
    }
  }

  forget(slot, one) {
    this.pads.delete(slot);
    if (this.holds === one) this.end();
    if (this.asking?.slot === slot) this.asking = null;
  }

  end(doubt = "") {
    this.holds = null;
    this.stick.release("gamepad", doubt);
  }

  follow(slot, one, pad) {
    const layout = one.layout = layoutOf(pad);
    const presses = one.presses(pad);
    if (this.asking?.slot === slot) return this.ask(one, pad);
    // Which button is which is not known of the others: there, every one of them stops.
    if (layout ? presses.includes(layout.stop) : presses.length) this.buttons.stop();
    if (!layout) return;
    const away = document.hidden || !document.hasFocus(); // browsers tell of gamepads to windows that nobody looks at, too
    if (presses.includes(layout.arm) && one.settled && !away) this.buttons.arm();
    one.settled ||= !pad.buttons[layout.arm]?.pressed;

    [one.x, one.y] = [read(pad, layout.x), read(pad, layout.y)];
    const size = Math.hypot(one.x, one.y);
    const down = layout.hold.some((button) => pad.buttons[button]?.pressed);
    const part = size > DEAD ? Math.min(1, (size - DEAD) / (1 - DEAD)) / size : 0;
    const mine = this.holds === one && this.stick.holder === "gamepad";
    one.rested ||= size <= DEAD;
    if (away || (this.holds === one && !mine)) one.centred = false; // another has taken or ended the hold
    if (this.holds === one && !mine) this.holds = null;
    const holding = this.button ? down : size > (mine ? DEAD : TAKE);
    if (!(this.button ? down : size > DEAD)) {
      if (mine) this.end();
      one.centred = one.rested && !away;
    } else if (mine) {
      if (!holding) this.end();
      else if (one.x * part !== this.stick.x || one.y * part !== this.stick.y) this.stick.move("gamepad", one.x * part, one.y * part);
    } else if (holding && one.centred && !away) {
      one.centred = false;
      if (this.holds) this.end("Two gamepads were moved: let go of both."); // the other may be an old, frozen entry
      else if (!this.stick.held && this.stick.press("gamepad", one.x * part, one.y * part)) this.holds = one;
    }
  }

  // Ask the operator for the layout of the pad in a slot; a second time: give it up.
  setUp(slot) {
    const pad = Gamepads.all().get(slot);
    this.asking = this.asking || !pad ? null : new Asking(slot, pad);
  }

  ask(one, pad) {
    const layout = this.asking.look(pad);
    if (!layout) return;
    keep(pad.id, layout);
    this.asking = null;
    one.centred = false;
  }
}

// One pad: which of its buttons were down, where its stick is, and whether it may take hold.
class Known {
  constructor(pad) {
    this.id = pad.id;
    this.layout = layoutOf(pad);
    this.rested = false; // whether its stick has been seen at the centre: some read anything before their first use
    this.centred = false;
    this.settled = false; // whether its arm button has been seen up: one that is stuck arms nothing
    this.x = this.y = 0;
    // Browsers show a pad only once a button is pressed: that press may be a Stop. Not so where any button would be one.
    this.down = this.layout ? [] : downs(pad);
  }

  // The buttons that have gone down since the last look.
  presses(pad) {
    const down = downs(pad);
    const newly = down.flatMap((is, k) => (is && !this.down[k] ? [k] : []));
    this.down = down;
    return newly;
  }

  get name() {
    return (this.id ?? "").replace(/^[0-9a-f]{1,4}-[0-9a-f]{1,4}-/i, "").replace(/\s*\([^(]*(vendor|product|standard).*$/i, "").trim() || "Gamepad";
  }
}
