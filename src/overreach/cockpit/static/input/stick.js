// One stick from many inputs (pad, keys, gamepad). The input that took hold last keeps it until it lets go.
// While held it sends a heartbeat, so that silence means loss; press and release are sent at once, everything else at
// most 60 times a second and only while few messages are on their way: what waits is the newest, never a queue.

import { factor, USUAL_EXPO } from "./curve.js";

const HEARTBEAT_MS = 33;
const APART_MS = 1000 / 57; // with what may be saved up, no second has more than 60
const AWAY_MOST = 3; // messages on their way
const SAVED_MOST = 3; // messages that may follow each other at once after a while with fewer
const AGAIN_MS = [20, 60]; // a release is said again

export class Stick {
  constructor(link) {
    this.link = link;
    this.frame = "hand"; // sent with every message: what the two axes mean
    this.axes = ["v_x", "w_z"]; // forward, leftward: parts of the twist in that frame
    this.most = { v_x: 0, v_y: 0, w_z: 0, v_z: 0 }; // at full deflection
    this.expo = USUAL_EXPO;
    this.barred = ""; // why nobody may take hold from here
    this.grip = 0;
    this.holder = null;
    this.lifter = null; // the input that moves the hand up or down; it holds alone where nothing else does
    this.z = 0; // up, -1 to 1
    this.x = 0; // right, -1 to 1: where it is
    this.y = 0; // up, -1 to 1
    this.curved = false; // whether the curve is applied to it
    this.last = 0;
    this.left = 0; // how many more could have been sent then
    this.due = false;
    this.listeners = []; // called with the stick when it has changed
    this.lost = []; // called with the reason when a hold was ended by doubt
    setInterval(() => this.pump(), HEARTBEAT_MS / 2);
    for (const event of ["blur", "pagehide", "freeze", "offline"]) window.addEventListener(event, () => this.release());
    document.addEventListener("visibilitychange", () => document.hidden && this.release());
  }

  get held() {
    return this.holder !== null;
  }
  get seq() {
    return this.link.seq;
  }
  // What is asked for along the two axes; left is positive, and turns counter-clockwise.
  get forward() {
    return this.y * this.scale * this.most[this.axes[0]];
  }
  get leftward() {
    return -this.x * this.scale * this.most[this.axes[1]];
  }
  get scale() {
    return this.curved ? factor(Math.hypot(this.x, this.y), this.expo) : 1;
  }
  get upward() {
    return this.z * this.most.v_z;
  }
  get twist() {
    const twist = { [this.axes[0]]: brief(this.forward), [this.axes[1]]: brief(this.leftward) };
    if (this.z) twist.v_z = brief(this.upward);
    return twist;
  }

  // Take hold; returns whether that was allowed. curved: for a stick that can stand anywhere, unlike keys.
  press(holder, x = 0, y = 0, curved = true) {
    if (this.barred) {
      for (const listener of this.lost) listener(this.barred);
      return false;
    }
    this.holder = holder;
    this.grip += 1;
    this.curved = curved;
    this.put(x, y);
    this.say(true);
    return true;
  }

  move(holder, x, y) {
    if (this.holder !== holder) return;
    this.put(x, y);
    this.say();
  }

  put(x, y) {
    const size = Math.max(1, Math.hypot(x, y));
    this.x = x / size;
    this.y = y / size;
  }

  // Move up or down, beside whatever moves the hand along the ground, or alone; returns whether that was allowed.
  lift(lifter, z) {
    const alone = !this.held;
    this.lifter = lifter;
    this.z = Math.max(-1, Math.min(1, z));
    if (!alone) this.say();
    else if (!this.press(lifter, 0, 0, false)) {
      this.lifter = null;
      this.z = 0;
      return false;
    }
    return true;
  }

  // Up and down alone are let go: what is held along the ground goes on.
  lower(lifter, doubt = "") {
    if (this.lifter !== lifter) return;
    this.lifter = null;
    this.z = 0;
    if (this.holder === lifter || doubt) this.release(this.holder, doubt);
    else this.say(true);
  }

  // Let go. doubt: why, where it was not the operator's own doing. Whoever still moves it up or down then holds alone.
  release(holder = this.holder, doubt = "") {
    if (this.holder === null || this.holder !== holder) return;
    const others = arguments.length > 0 && !doubt && this.lifter !== null && this.lifter !== holder;
    this.x = this.y = 0;
    if (others) {
      this.holder = this.lifter;
      this.say(true);
      return;
    }
    this.holder = this.lifter = null;
    this.z = 0;
    this.say(true);
    for (const ms of AGAIN_MS) setTimeout(() => !this.held && this.say(), ms);
    if (doubt) for (const listener of this.lost) listener(doubt);
  }

  // Nobody may take hold, for this reason; "" lifts it.
  bar(reason) {
    this.barred = reason;
    if (reason) this.release();
  }

  say(now = false) {
    this.due = true;
    for (const listener of this.listeners) listener(this);
    if (now) this.send();
    else this.pump();
  }

  // Send what is due as soon as it may go.
  pump() {
    const since = performance.now() - this.last;
    if (this.held && since >= HEARTBEAT_MS - 4) this.due = true;
    if (!this.due || this.link.away >= AWAY_MOST) return;
    // A few may follow each other at once, so that a movement need not wait for the heartbeat before it. Where answers
    // take long the few are spread evenly: in a burst, the wait for them would be taken for silence.
    const spread = this.link.delay.trip / AWAY_MOST;
    const wait = spread > APART_MS ? spread - since : (1 - this.saved(since)) * APART_MS;
    if (wait < 0.5) this.send();
    else this.timer ??= setTimeout(() => this.pump((this.timer = null)), wait);
  }

  // How many messages may be sent now, `since` [ms] after the last.
  saved(since) {
    return Math.min(SAVED_MOST, this.left + since / APART_MS);
  }

  send() {
    const now = performance.now();
    this.left = Math.max(0, this.saved(now - this.last) - 1);
    this.last = now;
    this.due = false;
    const { grip, held, twist, frame } = this;
    const seen = this.link.t;
    this.link.sendNumbered({ type: "command", grip, held, twist, frame, seen });
  }
}

const brief = (value) => Math.round(value * 1e6) / 1e6; // a thin link carries every digit
