// One stick from many inputs (pad, keys, gamepad). The input that took hold last keeps it until it lets go.
// While held it sends a heartbeat, so that silence means loss; press and release are sent at once, everything else at
// most 60 times a second and only while few messages are on their way: what waits is the newest, never a queue.

import { factor, USUAL_EXPO } from "./curve.js";

const HEARTBEAT_MS = 33;
const APART_MS = 1000 / 57; // with what may be saved up, no second has more than 60
const AWAY_MOST = 3; // messages on their way
const SAVED_MOST = 3; // messages that may follow each other at once after a while with fewer
const AGAIN_MS = [20, 60]; // a release is said again
const SQUEEZE_S = 1.5; // from open to closed

const within = (value, most = 1) => Math.max(-most, Math.min(most, value));

export class Stick {
  constructor(link) {
    this.link = link;
    this.frame = "hand"; // sent with every message: what the two axes mean
    this.axes = ["v_x", "w_z"]; // forward, leftward: parts of the twist in that frame
    this.most = { v_x: 0, v_y: 0, v_z: 0, w_x: 0, w_y: 0, w_z: 0 }; // at full deflection; 0: the robot has no such motion
    this.grips = false; // whether it has a gripper
    this.opening = 0; // of the gripper, 0 to 1, as it was told last
    this.expo = USUAL_EXPO;
    this.barred = ""; // why nobody may take hold from here
    this.grip = 0;
    this.holder = null;
    this.extras = new Map(); // input -> what it moves beside the two axes, each -1 to 1; one holds alone where nothing else does
    this.gripper = null; // the opening that is wanted, 0 to 1, while an input moves it
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
  // How far the inputs beside the two axes move a part of the twist, or the gripper, -1 to 1.
  extra(part) {
    let sum = 0;
    for (const parts of this.extras.values()) sum += parts[part] ?? 0;
    return within(sum);
  }
  get upward() {
    return this.extra("v_z") * this.most.v_z;
  }
  get twist() {
    const twist = { [this.axes[0]]: brief(this.forward), [this.axes[1]]: brief(this.leftward) };
    for (const part of Object.keys(this.most)) {
      const more = this.extra(part) * this.most[part];
      if (more) twist[part] = brief(within((twist[part] ?? 0) + more, this.most[part]));
    }
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

  // Move more parts, beside whatever moves the two axes, or alone; returns whether that was allowed.
  also(by, parts) {
    const alone = !this.held;
    this.extras.set(by, parts);
    if (!alone) this.say();
    else if (!this.press(by, 0, 0, false)) {
      this.extras.delete(by);
      return false;
    }
    return true;
  }

  // These parts alone are let go: what else is held goes on.
  without(by, doubt = "") {
    if (!this.extras.delete(by)) return;
    if (this.holder === by || doubt) this.release(this.holder, doubt);
    else this.say(true);
  }

  // Let go. doubt: why, where it was not the operator's own doing. Whoever still moves other parts then holds alone.
  release(holder = this.holder, doubt = "") {
    if (this.holder === null || this.holder !== holder) return;
    this.extras.delete(holder);
    this.x = this.y = 0;
    if (arguments.length > 0 && !doubt && this.extras.size) {
      [this.holder] = this.extras.keys();
      this.say(true);
      return;
    }
    this.holder = null;
    this.extras.clear();
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
    this.squeeze(Math.min(100, now - this.last) / 1000);
    this.left = Math.max(0, this.saved(now - this.last) - 1);
    this.last = now;
    this.due = false;
    const { grip, held, twist, frame } = this;
    const seen = this.link.t;
    const message = { type: "command", grip, held, twist, frame, seen };
    if (this.gripper !== null) message.gripper = brief(this.gripper);
    this.link.sendNumbered(message);
  }

  // Open or close the gripper a little further, from where it is.
  squeeze(seconds) {
    const way = this.grips ? this.extra("gripper") : 0;
    if (way) this.gripper = Math.max(0, Math.min(1, (this.gripper ?? this.opening) + (way * seconds) / SQUEEZE_S));
    else this.gripper = null;
  }
}

const brief = (value) => Math.round(value * 1e6) / 1e6; // a thin link carries every digit
