// Ties the parts of the page together. `window.overreach` is for tests and the curious; nothing depends on it.

import { attachGamepad } from "./gamepad.js";
import { attachKeys } from "./keys.js";
import { Link } from "./link.js";
import { attachPad } from "./pad.js";
import { Panel } from "./panel.js";
import { Plots } from "./plots.js";
import { Stick } from "./stick.js";
import { toggleTheme } from "./theme.js";
import { View } from "./view.js";

const SILENT_MS = 500; // without a state for this long, the robot side counts as silent
const STOP_AGAIN_MS = 150;

const $ = (id) => document.getElementById(id);

// The page's library builds the page after this module has loaded.
async function built() {
  while (!$("view") || document.querySelectorAll(".plot").length < 4) await new Promise((resolve) => setTimeout(resolve, 10));
}

await built();
const panel = new Panel();
const view = new View($("view"));
const plots = new Plots([...document.querySelectorAll(".plot")]);
const page = { robot: null, settings: null, state: null, stopping: false, heard: performance.now(), drawn: null };

const silent = () => performance.now() - page.heard > SILENT_MS;

const link = new Link({
  welcome(robot, settings, scene) {
    page.robot = robot;
    const { v_c, w_c } = robot.limits;
    stick.most = { v_x: v_c, v_y: v_c, w_z: w_c };
    panel.welcome(robot);
    configure(settings, scene);
  },
  settings: configure,
  state(state) {
    page.state = state;
    page.heard = performance.now();
    view.show(state);
    plots.add(state);
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

function configure(settings, scene) {
  page.settings = settings;
  plots.configure(settings.workspace);
  stick.frame = settings.frame;
  stick.axes = page.robot.axes[settings.frame];
  panel.axes(stick.axes);
  view.scene = scene;
  view.dirty = true;
}

view.afterDraw.push((state) => {
  if (!state || !link.ready || silent()) return; // an old state drawn again is not news
  panel.show(state, link.operator);
  stick.seen = state.t;
  page.drawn = { ack: state.ack, operator: state.operator, at: performance.now() };
});
view.afterFrame.push((at) => plots.afterFrame(at, stick.held));
setInterval(() => {
  if (link.ready && silent()) panel.down(page.state?.verdict === "ending" ? "The robot side has ended." : "The robot side is silent.");
}, 100);

async function ask(what) {
  const answer = await link.ask(what);
  if (!answer.done) panel.tell("Not done", answer.reason);
  return answer;
}
const buttons = {
  // A stop is asked for again until the robot side confirms it, across lost connections too.
  async stop() {
    stick.release();
    if (page.stopping) return;
    page.stopping = true;
    while (!(await ask("stop")).done) await new Promise((resolve) => setTimeout(resolve, STOP_AGAIN_MS));
    page.stopping = false;
  },
  arm: () => ask("arm").then(() => $("pad").focus({ preventScroll: true })),
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
  clear: () => view.clear(),
  zoom: (factor) => view.zoom(factor),
};
for (const id of ["stop", "arm", "reset", "restart", "follow", "clear"]) $(id).addEventListener("click", () => buttons[id]());
$("zoom-in").addEventListener("click", () => view.zoom(1.25));
$("zoom-out").addEventListener("click", () => view.zoom(0.8));
$("theme").addEventListener("click", toggleTheme);
view.onFollow = (on) => $("follow").setAttribute("aria-pressed", on);

attachPad(stick, $("pad"));
attachKeys(stick, buttons);
attachGamepad(stick, buttons);
stick.listeners.push((now) => panel.stick(now));

window.overreach = { page, link, stick, view, plots, buttons };
document.documentElement.dataset.ready = "true";
