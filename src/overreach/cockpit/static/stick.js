// One stick from many inputs (pad, keys, gamepad). The input that took hold last keeps it until it lets go.
// While held it sends a heartbeat, so that silence means loss. On release it sends zero three times.

const HEARTBEAT_MS = 33;

export class Stick {
  constructor(link) {
    this.link = link;
    this.frame = "hand"; // sent with every message: what the two axes mean
    this.axes = ["v_x", "w_z"]; // forward, leftward: parts of the twist in that frame
    this.most = { v_x: 0, v_y: 0, w_z: 0 }; // at full deflection
    this.seen = 0; // time of the newest state that this page has shown
    this.seq = 0;
    this.grip = 0;
    this.holder = null;
    this.x = 0; // right, -1 to 1
    this.y = 0; // up, -1 to 1
    this.last = 0;
    this.listeners = [];
    setInterval(() => {
      if (this.held && performance.now() - this.last >= HEARTBEAT_MS - 4) this.say();
    }, HEARTBEAT_MS / 2);
    for (const event of ["blur", "pagehide", "offline"]) window.addEventListener(event, () => this.release());
    document.addEventListener("visibilitychange", () => document.hidden && this.release());
  }

  get held() {
    return this.holder !== null;
  }
  // What is asked for along the two axes; left is positive, and turns counter-clockwise.
  get forward() {
    return this.y * this.most[this.axes[0]];
  }
  get leftward() {
    return -this.x * this.most[this.axes[1]];
  }
  get twist() {
    return { [this.axes[0]]: this.forward, [this.axes[1]]: this.leftward };
  }

  press(holder, x = 0, y = 0) {
    this.holder = holder;
    this.grip += 1;
    this.move(holder, x, y);
  }

  move(holder, x, y) {
    if (this.holder !== holder) return;
    const size = Math.max(1, Math.hypot(x, y));
    this.x = x / size;
    this.y = y / size;
    this.say();
  }

  release(holder = this.holder) {
    if (this.holder === null || this.holder !== holder) return;
    this.holder = null;
    this.x = this.y = 0;
    this.say();
    for (const ms of [20, 60]) setTimeout(() => !this.held && this.say(), ms);
  }

  say() {
    this.last = performance.now();
    this.seq += 1;
    const { seq, grip, held, twist, frame, seen } = this;
    this.link.send({ type: "command", seq, grip, held, twist, frame, seen });
    for (const listener of this.listeners) listener(this);
  }
}
