// What the page says in words and numbers: verdict, authority, readout, and which buttons make sense.

import { WELL_MS } from "../link/fitness.js";

const NUMBERS_MS = 120;
const TOLD_MS = 2500;
const EDGE = 0.005; // a share nearer to 0 or 1 than this is called arm or base

const $ = (id) => document.getElementById(id);
const signed = (value, digits = 2) => (Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits).replace("-", "−");
const inMs = (us) => (us / 1000).toFixed(2);
const put = (element, text) => {
  if (element.textContent !== text) element.textContent = text;
};

export const authority = (share) => (share <= EDGE ? "arm" : share >= 1 - EDGE ? "base" : "blending");

export class Panel {
  constructor() {
    this.told = 0;
    this.until = 0;
    this.viewOnly = ""; // why nobody drives from here
    this.delay = 0;
    this.maxDelay = 0; // how old a command may be [ms]
    this.shares = [...document.querySelectorAll(".share")].map((row) => ({
      name: row.dataset.share, bar: row.querySelector(".bar"), fill: row.querySelector("i"),
      who: row.querySelector(".who"), value: row.querySelector(".value"),
    }));
  }

  welcome(robot) {
    put($("robot"), `${robot.name} · ${robot.simulated ? "simulated" : "real"} · ${robot.rate} Hz`);
    put($("r-stop"), `${robot.stop_time.toFixed(2)} s`);
    this.maxDelay = (robot.max_delay * 1000).toFixed(0);
    $("restart").hidden = !robot.simulated;
    $("lift").hidden = $("height").hidden = !robot.obeys.includes("v_z");
    $("gripper").hidden = !robot.obeys.includes("gripper");
  }

  show(s, operator) {
    const now = performance.now();
    const mine = s.armed && s.operator === operator;
    if (now - this.told > NUMBERS_MS) {
      this.told = now;
      this.numbers(s);
    }
    const part = s.scale > 0 && s.scale < 0.995 && s.look !== "stop" ? ` (× ${s.scale.toFixed(2)})` : "";
    if (now > this.until) {
      if (this.viewOnly && !s.stopped) this.say("warn", "View only", this.viewOnly);
      else if (s.armed && !mine) this.say("warn", "Watching", "Another page has armed the robot. Arm takes over when it rests.");
      else this.say(s.look, s.word, s.sentence + part);
    }
    for (const { name, bar, fill, who, value } of this.shares) {
      const share = s[name];
      if (value.textContent === share.toFixed(2)) continue;
      fill.style.transform = `scaleX(${share})`;
      bar.setAttribute("aria-valuenow", share.toFixed(2));
      put(value, share.toFixed(2));
      const word = authority(share);
      put(who, word);
      who.dataset.who = word;
    }
    $("arm").disabled = mine || s.stopped || Boolean(this.viewOnly);
    $("reset").disabled = !s.stopped;
    $("pad").dataset.armed = $("lift").dataset.armed = mine;
    const hint = s.stopped ? "Press Reset, then Arm" : this.viewOnly ? "View only" : !mine ? "Press Arm, then drag" : "";
    $("pad-hint").hidden = !hint;
    put($("pad-hint"), hint);
  }

  // The numbers are for reading: a few updates a second are enough, and spare most frames a layout.
  numbers(s) {
    const [x, y] = s.hand;
    put($("r-hand"), `${signed(x)}, ${signed(y)} m`);
    put($("r-height"), `${signed(s.hand[2])} m`);
    put($("r-gripper"), `${(s.opening * 100).toFixed(0)} % open`);
    put($("r-base"), `${signed(s.pose.x)}, ${signed(s.pose.y)} m · ${signed((s.pose.heading * 180) / Math.PI, 0)}°`);
    put($("r-speed"), `${Math.hypot(...s.velocity).toFixed(2)} m/s`);
    put($("r-refused"), `${s.refused}`);
    put($("r-age"), s.operator && s.heard ? `${(s.age * 1000).toFixed(0)} of ${this.maxDelay} ms` : `at most ${this.maxDelay} ms`);
    put($("r-late"), s.apart_p99 ? `${inMs(s.late_p99)}, ${inMs(s.apart_p99)} ms` : "–");
  }

  // A message that the next state must not overwrite.
  tell(word, reason) {
    this.until = performance.now() + TOLD_MS;
    this.say("warn", word, reason);
  }

  say(kind, word, reason) {
    if ($("verdict").dataset.kind !== kind) $("verdict").dataset.kind = kind;
    put($("verdict-word"), word);
    if ($("verdict-reason").textContent === reason) return;
    put($("verdict-reason"), reason);
    $("verdict").title = reason; // in full, for when the window is too narrow for it
  }

  // How late what is seen, or what is said, is now [ms], and whether one may drive by that.
  late(ms, good) {
    const why = ms > WELL_MS ? `${ms.toFixed(0)} ms late: nobody drives from here until it is better.` : "It was late: nobody drives from here until it has been better for a while.";
    this.viewOnly = good ? "" : why;
    const now = performance.now();
    if (now - this.delay < NUMBERS_MS) return;
    this.delay = now;
    put($("r-delay"), `${ms.toFixed(0)} ms`);
  }

  // Where the stick's "up" goes in the picture [rad], counter-clockwise from up.
  up(angle) {
    const turn = (-angle * 180) / Math.PI;
    if (Math.abs(turn - this.turn) < 0.2) return;
    this.turn = turn;
    $("pad-up").setAttribute("transform", `rotate(${turn.toFixed(1)})`);
  }

  down(reason) {
    this.say("stop", "No connection", reason);
    for (const id of ["arm", "reset"]) $(id).disabled = true;
    $("pad").dataset.armed = $("lift").dataset.armed = false;
    $("pad-hint").hidden = true;
  }

  // What the two axes of the pad mean: forward and leftward along the ground, or forward and turning.
  axes([, leftward]) {
    const turns = leftward === "w_z";
    const ways = turns ? "forward and back. Left and right: turn" : "up and down in the picture. Left and right: left and right";
    $("pad").setAttribute("aria-label", `Pad: drag to move the hand. Up and down: ${ways}. Or the arrow keys, W A S D, or a gamepad.`);
    $("axis-v").innerHTML = turns ? "v<sub>c</sub>" : "v<sub>x</sub>";
    $("axis-w").innerHTML = turns ? "ω<sub>c</sub>" : "v<sub>y</sub>";
    $("unit-w").textContent = turns ? "rad/s" : "m/s";
  }

  stick(stick) {
    put($("out-v"), signed(stick.forward));
    put($("out-w"), signed(stick.leftward));
    put($("out-z"), signed(stick.upward));
  }
}
