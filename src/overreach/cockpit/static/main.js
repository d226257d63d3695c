// Ties the parts of the page together. `window.overreach` is for tests and the curious; nothing depends on it.

import { Gamepads } from "./input/gamepad.js";
import { attachKeys } from "./input/keys.js";
import { attachLift } from "./input/lift.js";
import { attachPad } from "./input/pad.js";
import { Stick } from "./input/stick.js";
import { attachStop } from "./input/stop.js";
import { keep, kept, SESSION } from "./kept.js";
import { Fitness } from "./link/fitness.js";
import { Link } from "./link/link.js";
import { Inputs } from "./show/inputs.js";
import { Panel } from "./show/panel.js";
import { Plots } from "./show/plots.js";
import { toggleTheme } from "./show/theme.js";
import { View } from "./show/view.js";

const SILENT_MS = 500; // without a state for this long, the robot side counts as silent
const STOP_AGAIN_MS = 150;
const LOOK_MS = 100;

const $ = (id) => document.getElementById(id);

// The page's library builds the page after this module has loaded.
async function built() {
  while (!$("view") || !$("inputs") || document.querySelectorAll(".plot").length < 4) await new Promise((resolve) => setTimeout(resolve, 10));
}

await built();
const panel = new Panel();
const view = new View($("view"));
const plots = new Plots([...document.querySelectorAll(".plot")]);
const fitness = new Fitness();
const page = { robot: null, settings: null, state: null, stopping: false, heard: performance.now(), drawn: null };

const silent = () => performance.now() - page.heard > SILENT_MS;

const link = new Link({
  welcome(robot, settings, scene) {
    page.robot = robot;
    const { v_c, w_c, v_z } = robot.limits;
    const most = { v_x: v_c, v_y: v_c, v_z, w_x: w_c, w_y: w_c, w_z: w_c };
    for (const part of Object.keys(most)) stick.most[part] = robot.obeys.includes(part) ? most[part] : 0;
    stick.grips = robot.obeys.includes("gripper");
    panel.welcome(robot);
    view.sized(robot.model, robot.reach[1]);
    configure(settings, scene);
  },
  settings: configure,
  state(state) {
    page.state = state;
    page.heard = performance.now();
    stick.opening = state.opening;
    view.show(state);
    plots.add(state);
  },
  heard() {
    stick.pump();
  },
  told(reason) {
    panel.tell("Robot side", reason);
  },
  up() {
    page.heard = performance.now();
  },
  down() {
    stick.release();
    panel.down("The page has lost the cockpit. Trying again.");
  },
});
const stick = new Stick(link);
stick.listeners.push(() => panel.stick(stick));
link.soon = () => stick.held; // the next command acknowledges the picture, and no beat is needed
stick.lost.push((why) => panel.tell(why === stick.barred ? "View only" : "Let go", why));

function configure(settings, scene) {
  if (page.settings && page.settings.hand !== settings.hand) view.clear(); // the path of another hand
  page.settings = settings;
  plots.configure(settings.workspace);
  if (settings.frame !== stick.frame) stick.release(stick.holder, "What the stick means has changed: press again.");
  stick.frame = settings.frame;
  stick.axes = page.robot.axes[settings.frame];
  panel.axes(stick.axes);
  view.scene = scene;
  view.dirty = true;
}

view.afterDraw.push((state) => {
  if (!state || !link.ready || (fitness.good && silent())) return; // an old state drawn again is not news
  panel.show(state, link.operator);
  panel.up(state.forward - view.up);
  page.drawn = { ack: state.ack, operator: state.operator, at: performance.now() };
});
view.afterFrame.push((at) => plots.afterFrame(at, stick.held));

// How late things are, and whether one may drive by that.
setInterval(() => {
  if (!link.ready) return;
  const now = performance.now();
  const late = link.delay.late(now);
  const good = fitness.look(late, now);
  panel.late(late, good);
  stick.bar(good ? "" : panel.viewOnly);
  if (good && silent()) panel.down(page.state?.verdict === "ending" ? "The robot side has ended." : "The robot side is silent.");
  else if (!good && page.state) panel.show(page.state, link.operator);
}, LOOK_MS);

async function ask(what) {
  const answer = await link.ask(what);
  if (!answer.done) panel.tell(answer.late ? "No answer" : "Not done", answer.reason);
  return answer;
}
// A stop that is not confirmed yet outlives the page: its library reloads it after a longer outage.
const PENDING = "stop";

const buttons = {
  // A stop is asked for again until the robot side confirms it, by its answer or its state, across lost connections too.
  async stop() {
    stick.release();
    if (page.stopping) return;
    page.stopping = true;
    keep(PENDING, "1", SESSION);
    const before = page.state?.t ?? 0;
    const stopped = () => page.state?.stopped && page.state.t > before;
    while (!(await link.ask("stop")).done && !stopped()) {
      panel.tell("Stop", "Not confirmed yet. Asking again.");
      await new Promise((resolve) => setTimeout(resolve, STOP_AGAIN_MS));
    }
    page.stopping = false;
    keep(PENDING, null, SESSION);
  },
  async arm() {
    if (stick.barred) return panel.tell("Not done", stick.barred);
    await ask("arm");
    $("pad").focus({ preventScroll: true });
  },
  reset: () => ask("reset"),
  async restart() {
    if (page.state?.armed && !(await ask("disarm")).done) return;
    for (let k = 0; k < 10; k++) {
      const answer = await link.ask("restart");
      if (answer.done) break;
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    view.clear();
    view.setFollow(true);
  },
  follow: () => view.setFollow(!view.follow),
  // The picture and what the stick means change together: up stays up.
  async turn() {
    const turns = !view.turns;
    const frame = turns ? "hand" : "world";
    if (page.settings.frame !== frame && !(await ask(`frame ${frame}`)).done) return;
    view.setTurns(turns);
  },
  clear: () => view.clear(),
  zoom: (factor) => view.zoom(factor),
};
attachStop($("stop"), buttons.stop);
for (const id of ["arm", "reset", "restart", "follow", "turn", "clear"]) $(id).addEventListener("click", () => buttons[id]());
$("zoom-in").addEventListener("click", () => view.zoom(1.25));
$("zoom-out").addEventListener("click", () => view.zoom(0.8));
$("theme").addEventListener("click", toggleTheme);
view.onFollow = (on) => $("follow").setAttribute("aria-pressed", on);
view.onTurns = (on) => $("turn").setAttribute("aria-pressed", on);

attachPad(stick, $("pad"));
attachLift(stick, $("lift"));
attachKeys(stick, buttons);
const gamepads = new Gamepads(stick, buttons);
new Inputs(stick, gamepads);

window.overreach = { page, panel, link, stick, view, plots, buttons, gamepads, fitness };
document.documentElement.dataset.ready = "true";
if (kept(PENDING, null, SESSION)) buttons.stop();
