// The top view: fixed, with the world's x up and y to the left, or turning, with the hand's direction up.
// Drawn only when something has changed.

import { colour, onTheme } from "./theme.js";

const TRAIL_STEP = 0.02; // [m]
const TRAIL_LENGTH = 6000;
const [USUAL_REACH, LARGER] = [0.9, 2.2]; // reach of an arm [m] that is shown as it is, and how much larger at most
const NAMES = ["ink", "muted", "line", "grid", "grid-major", "arm", "base", "hand", "space", "band", "panel", "stage"];

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.needle = document.getElementById("needle");
    this.paint = canvas.getContext("2d", { alpha: false }); // opaque: nothing behind it is blended in
    this.scale = 150; // [px/m]
    this.centre = { x: 0.3, y: 0 };
    this.up = 0; // what is up in the picture: an angle in the world [rad]
    this.settled = true;
    this.turns = false; // whether that is where the hand points
    this.follow = true;
    this.trails = { hand: [], base: [] };
    this.dirty = true;
    this.afterDraw = []; // called with the state that was drawn
    this.afterFrame = []; // called in every frame, after any drawing
    this.colours();
    onTheme(() => this.colours());
    this.resize(); // states may come before the first frame
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.attach();
    const frame = (at) => {
      requestAnimationFrame(frame); // first: whatever goes wrong in one frame, there is a next
      this.step(at);
    };
    requestAnimationFrame(frame);
  }

  colours() {
    this.c = Object.fromEntries(NAMES.map((name) => [name, colour(name)]));
    this.dirty = true;
  }

  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.w = this.canvas.clientWidth;
    this.h = this.canvas.clientHeight;
    this.canvas.width = Math.round(this.w * ratio);
    this.canvas.height = Math.round(this.h * ratio);
    this.ratio = ratio;
    this.free = this.uncovered();
    this.fit ??= this.scale = Math.max(80, Math.min(190, Math.min(this.w / 4.2, this.h / 3.6)));
    this.dirty = true;
  }

  // The middle of what the pad leaves free: all of the picture, what is above the pad, or what is beside it. [px]
  uncovered() {
    const [box, pad] = [this.canvas, document.getElementById("pad")].map((one) => one.getBoundingClientRect());
    const whole = { x: this.w / 2, y: this.h / 2 };
    if (pad.top > box.bottom - 8) return whole;
    if (pad.left + pad.right > box.left + box.right + 80) return { x: (pad.left - box.left) / 2, y: whole.y };
    return { x: whole.x, y: (pad.top - box.top) / 2 };
  }

  // A small robot is shown larger: once for each robot, before anybody zooms.
  sized(name, reach) {
    if (this.name === name) return;
    this.name = name;
    this.scale = this.fit * Math.max(1, Math.min(LARGER, USUAL_REACH / reach));
    this.dirty = true;
  }

  show(state) {
    this.state = state;
    this.trace("hand", state.hand[0], state.hand[1]);
    this.trace("base", state.pose.x, state.pose.y);
    this.dirty = true;
  }

  trace(name, x, y) {
    const trail = this.trails[name];
    const last = trail[trail.length - 1];
    const step = last ? Math.hypot(x - last[0], y - last[1]) : Infinity;
    if (step > 1 && last) trail.length = 0; // put somewhere else
    if (step >= TRAIL_STEP) trail.push([x, y]);
    if (trail.length > TRAIL_LENGTH) trail.splice(0, TRAIL_LENGTH / 10);
  }

  clear() {
    this.trails = { hand: [], base: [] };
    this.dirty = true;
  }

  zoom(factor) {
    this.scale = Math.max(25, Math.min(600, this.scale * factor));
    this.dirty = true;
  }

  setTurns(on) {
    this.turns = on;
    this.settled = false;
    this.onTurns?.(on);
    this.dirty = true;
  }

  setFollow(on) {
    this.follow = on;
    this.onFollow?.(on);
    this.dirty = true;
  }

  attach() {
    const fingers = new Map();
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY * 0.0015));
    }, { passive: false });
    this.canvas.addEventListener("pointerdown", (event) => {
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      const was = fingers.get(event.pointerId);
      if (!was) return;
      const now = [event.clientX, event.clientY];
      const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
      if (other) this.zoom(Math.hypot(now[0] - other[0], now[1] - other[1]) / Math.max(1, Math.hypot(was[0] - other[0], was[1] - other[1])));
      else if (event.pointerType !== "touch") {
        if (this.follow) this.setFollow(false);
        this.canvas.classList.add("dragged");
        const [left, down] = [(now[0] - was[0]) / this.scale, (now[1] - was[1]) / this.scale];
        const [c, s] = [Math.cos(this.up), Math.sin(this.up)];
        this.centre.x += down * c - left * s;
        this.centre.y += down * s + left * c;
        this.dirty = true;
      }
      fingers.set(event.pointerId, now);
    });
    const lift = (event) => {
      fingers.delete(event.pointerId);
      this.canvas.classList.remove("dragged");
    };
    this.canvas.addEventListener("pointerup", lift);
    this.canvas.addEventListener("pointercancel", lift);
  }

  step(at) {
    const dt = Math.min(0.1, (at - (this.at ?? at)) / 1000);
    this.at = at;
    this.turn(dt);
    if (this.follow && this.state) {
      const { pose, hand } = this.state;
      const [ahead, aside] = [(this.free.y - this.h / 2) / this.scale, (this.free.x - this.w / 2) / this.scale];
      const [c, s] = [Math.cos(this.up), Math.sin(this.up)];
      const goal = {
        x: 0.5 * (pose.x + hand[0]) + ahead * c - aside * s,
        y: 0.5 * (pose.y + hand[1]) + ahead * s + aside * c,
      };
      const part = 1 - Math.exp(-dt / 0.25);
      const [dx, dy] = [goal.x - this.centre.x, goal.y - this.centre.y];
      if (Math.hypot(dx, dy) * this.scale > 0.2) {
        const whole = Math.hypot(dx, dy) > 5;
        this.centre.x += dx * (whole ? 1 : part);
        this.centre.y += dy * (whole ? 1 : part);
        this.dirty = true;
      }
    }
    if (this.dirty && this.w) {
      this.dirty = false;
      this.draw();
      for (const done of this.afterDraw) done(this.state);
    }
    for (const done of this.afterFrame) done(at);
  }

  // Turn the picture to its up: with the hand exactly, and on a change of mind within a moment.
  turn(dt) {
    const goal = this.turns && this.state ? this.state.theta_e : 0;
    const off = Math.atan2(Math.sin(goal - this.up), Math.cos(goal - this.up));
    if (this.settled && (this.turns || off === 0)) {
      if (off !== 0) this.dirty = true;
      this.up = goal;
    } else {
      const part = 1 - Math.exp(-dt / 0.08);
      this.settled = Math.abs(off) < 0.01;
      this.up = this.settled ? goal : this.up + off * part;
      this.dirty = true;
    }
    const turned = `rotate(${((this.up * 180) / Math.PI).toFixed(1)})`;
    if (turned !== this.turned) this.needle.setAttribute("transform", (this.turned = turned));
  }

  px(x, y) {
    const [dx, dy] = [(x - this.centre.x) * this.scale, (y - this.centre.y) * this.scale];
    const [c, s] = [Math.cos(this.up), Math.sin(this.up)];
    return [this.w / 2 - (dy * c - dx * s), this.h / 2 - (dx * c + dy * s)];
  }

  // The angle on the screen, clockwise from the right, of a direction in the world.
  onScreen(angle) {
    return this.up - angle - Math.PI / 2;
  }

  draw() {
    const g = this.paint;
    g.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    g.fillStyle = this.c.stage;
    g.fillRect(0, 0, this.w, this.h);
    this.grid();
    if (!this.state || !this.scene) return;
    this.trail("base", this.c.base);
    this.trail("hand", this.c.hand);
    this.workspace();
    this.base();
    this.arm();
    this.hand();
  }

  grid() {
    const g = this.paint;
    const step = [0.1, 0.25, 0.5, 1, 2, 5, 10].find((one) => one * this.scale >= 34) ?? 10;
    const line = (from, to) => {
      g.beginPath();
      g.moveTo(...from);
      g.lineTo(...to);
      g.stroke();
    };
    const reach = Math.hypot(this.w, this.h) / 2 / this.scale; // lines long enough for any turn
    const crisp = (point) => (this.up === 0 ? point.map((one) => Math.round(one) + 0.5) : point);
    g.lineWidth = 1;
    for (const [across, along] of [["y", "x"], ["x", "y"]]) {
      const { [across]: middle, [along]: centre } = this.centre;
      for (let k = Math.ceil((middle - reach) / step); k * step <= middle + reach; k++) {
        g.strokeStyle = k % 4 === 0 ? this.c["grid-major"] : this.c.grid;
        line(...[-reach, reach].map((far) => {
          const point = { [across]: k * step, [along]: centre + far };
          return crisp(this.px(point.x, point.y));
        }));
      }
    }
    // Where the world begins.
    g.lineWidth = 2;
    g.fillStyle = g.strokeStyle = this.c.muted;
    g.font = "11px system-ui, sans-serif";
    g.textAlign = "center";
    g.textBaseline = "middle";
    const pixel = 1 / this.scale;
    for (const [name, x, y] of [["x", 1, 0], ["y", 0, 1]]) {
      line(this.px(0, 0), this.px(26 * x * pixel, 26 * y * pixel));
      g.fillText(name, ...this.px(34 * x * pixel, 34 * y * pixel));
    }
    g.textBaseline = "alphabetic";
    // Scale.
    const length = step * 4 * this.scale < this.w / 3 ? step * 4 : step;
    const [sx, sy] = [16, this.h - 16];
    g.lineWidth = 2;
    g.beginPath();
    g.moveTo(sx, sy - 5);
    g.lineTo(sx, sy);
    g.lineTo(sx + length * this.scale, sy);
    g.lineTo(sx + length * this.scale, sy - 5);
    g.stroke();
    g.fillText(`${length} m`, sx + (length * this.scale) / 2, sy - 6);
  }

  trail(name, ink) {
    const g = this.paint;
    const points = this.trails[name];
    if (points.length < 2) return;
    g.strokeStyle = ink;
    g.globalAlpha = 0.55;
    g.lineWidth = name === "hand" ? 2.5 : 2;
    g.setLineDash(name === "hand" ? [] : [7, 5]);
    g.lineJoin = "round";
    g.beginPath();
    for (const [x, y] of points) g.lineTo(...this.px(x, y));
    g.stroke();
    g.setLineDash([]);
    g.globalAlpha = 1;
  }

  // From here to `restore` what is drawn is in the base frame: x forward, y to the left, in m.
  inBaseFrame() {
    const g = this.paint;
    const { x, y, heading } = this.state.pose;
    g.save();
    g.translate(...this.px(x, y));
    g.rotate(this.onScreen(heading));
    g.scale(this.scale, -this.scale);
  }

  closed(points) {
    const g = this.paint;
    g.beginPath();
    for (const [x, y] of points) g.lineTo(x, y);
    g.closePath();
  }

  workspace() {
    const g = this.paint;
    this.inBaseFrame();
    g.fillStyle = this.c.space;
    this.closed(this.scene.workspace);
    g.fill();
    g.fillStyle = this.c.band;
    for (const band of this.scene.bands) {
      this.closed(band);
      g.fill();
    }
    g.strokeStyle = this.c.arm;
    g.lineWidth = 1.5 / this.scale;
    g.setLineDash([5 / this.scale, 4 / this.scale]);
    this.closed(this.scene.workspace);
    g.stroke();
    g.setLineDash([]);
    g.restore();
  }

  base() {
    const g = this.paint;
    const { x, y, heading } = this.state.pose;
    const [length, width] = this.scene.footprint.map((side) => side * this.scale);
    g.save();
    g.translate(...this.px(x, y));
    g.rotate(this.onScreen(heading)); // from here on x is the base's x axis, y to its right
    g.fillStyle = this.c.base;
    for (const wheel of this.scene.wheels) {
      g.save();
      g.translate(wheel.x * this.scale, -wheel.y * this.scale);
      g.rotate(-wheel.heading);
      const [long, wide] = [2 * wheel.radius * this.scale, 0.8 * wheel.radius * this.scale];
      g.beginPath();
      g.roundRect(-long / 2, -wide / 2, long, wide, 3);
      g.fill();
      g.restore();
    }
    g.beginPath();
    g.roundRect(-length / 2, -width / 2, length, width, Math.min(length, width) * 0.18);
    g.globalAlpha = 0.22;
    g.fill();
    g.globalAlpha = 1;
    g.strokeStyle = this.c.base;
    g.lineWidth = 2;
    g.stroke();
    g.beginPath(); // which way it faces
    g.moveTo(length * 0.44, 0);
    g.lineTo(length * 0.31, -width * 0.13);
    g.lineTo(length * 0.31, width * 0.13);
    g.closePath();
    g.fill();
    g.restore();
  }

  arm() {
    const g = this.paint;
    const points = this.state.links.map(([x, y]) => this.px(x, y));
    g.lineCap = g.lineJoin = "round";
    for (const [ink, width] of [[this.c.panel, 13], [this.c.arm, 9]]) {
      g.strokeStyle = ink;
      g.lineWidth = Math.max(3, (width * this.scale) / 150);
      g.beginPath();
      for (const point of points) g.lineTo(...point);
      g.stroke();
    }
    for (const [x, y] of points.slice(0, -1)) this.disc(x, y, 0.038, this.c.panel, this.c.arm);
  }

  disc(x, y, radius, fill, stroke) {
    const g = this.paint;
    g.beginPath();
    g.arc(x, y, Math.max(3, radius * this.scale), 0, 2 * Math.PI);
    g.fillStyle = fill;
    g.fill();
    g.strokeStyle = stroke;
    g.lineWidth = 2.5;
    g.stroke();
  }

  // The hand, the way it points, and where it is going.
  hand() {
    const g = this.paint;
    const s = this.state;
    const [x_e, y_e] = s.hand;
    const [x, y] = this.px(x_e, y_e);
    g.save();
    g.translate(x, y);
    g.rotate(this.onScreen(s.theta_e));
    g.strokeStyle = this.c.hand;
    g.lineWidth = Math.max(2.5, 0.024 * this.scale);
    g.lineCap = "round";
    const k = this.scale;
    g.beginPath();
    g.moveTo(0.13 * k, -0.055 * k);
    g.lineTo(0.05 * k, -0.055 * k);
    g.lineTo(0.05 * k, 0.055 * k);
    g.lineTo(0.13 * k, 0.055 * k);
    g.stroke();
    g.restore();
    this.disc(x, y, 0.042, this.c.hand, this.c.panel);
    const [vx, vy] = s.velocity;
    const speed = Math.hypot(vx, vy);
    if (speed > 0.01) {
      const length = speed * 1.5;
      const tip = this.px(x_e + (vx / speed) * (0.14 + length), y_e + (vy / speed) * (0.14 + length));
      const tail = this.px(x_e + (vx / speed) * 0.14, y_e + (vy / speed) * 0.14);
      const way = Math.atan2(tip[1] - tail[1], tip[0] - tail[0]);
      g.strokeStyle = g.fillStyle = this.c.hand;
      g.lineWidth = 3;
      g.beginPath();
      g.moveTo(...tail);
      g.lineTo(...tip);
      g.stroke();
      g.beginPath();
      g.moveTo(tip[0] + 7 * Math.cos(way), tip[1] + 7 * Math.sin(way));
      for (const side of [2.5, -2.5]) g.lineTo(tip[0] + 8 * Math.cos(way + side), tip[1] + 8 * Math.sin(way + side));
      g.closePath();
      g.fill();
    }
  }
}
