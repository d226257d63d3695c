// Arrow keys and W A S D; E and Q, or Page Up and Down, for the height; I K, J L and U O turn the hand; B and G open and
// close it. Shift is a quarter of the speed. A held key is the dead-man.

const WAYS = {
  ArrowUp: [0, 1], KeyW: [0, 1],
  ArrowDown: [0, -1], KeyS: [0, -1],
  ArrowLeft: [-1, 0], KeyA: [-1, 0],
  ArrowRight: [1, 0], KeyD: [1, 0],
};
// Beside them: [part of the twist or gripper, which way]. "third" is what the two axes leave out, of v_y and w_z.
const MORE = {
  KeyE: ["v_z", 1], PageUp: ["v_z", 1], KeyQ: ["v_z", -1], PageDown: ["v_z", -1],
  KeyI: ["w_y", -1], KeyK: ["w_y", 1],
  KeyJ: ["w_x", -1], KeyL: ["w_x", 1],
  KeyU: ["third", 1], KeyO: ["third", -1],
  KeyB: ["gripper", 1], KeyG: ["gripper", -1],
};
const SLOW = 0.25;

// A field in which a Space or a letter is written. A list to choose from has a field, too, but only to be found by.
const writing = (target) => target.closest?.("input:not([readonly]):not([type=range]):not(.q-select__focus-target), textarea, [contenteditable]");

// A key that a text field or a slider would take for itself is not ours.
const elsewhere = (target) => target.closest?.("input, textarea, select, [contenteditable], .q-field, .q-slider, [role=slider], [role=listbox]");

// Where a key is; on-screen and remote keyboards say only what it writes.
const named = (event) => event.code || (/^[a-z]$/i.test(event.key) ? `Key${event.key.toUpperCase()}` : event.key);

const isStop = ({ code, key, target }) => code === "Escape" || key === "Escape" || ((code === "Space" || key === " ") && !writing(target));

export function attachKeys(stick, buttons) {
  const down = new Set();
  const more = new Set();
  let slow = false; // as the newest event has it: no key of its own is kept track of

  const steer = () => {
    let x = 0;
    let y = 0;
    for (const key of down) {
      x += WAYS[key][0];
      y += WAYS[key][1];
    }
    const size = Math.max(1, Math.hypot(x, y)) / (slow ? SLOW : 1);
    return [x / size, y / size];
  };
  const part = (key) => {
    const [name] = MORE[key];
    return name === "third" ? (stick.axes.includes("w_z") ? "v_y" : "w_z") : name;
  };
  const has = (key) => (part(key) === "gripper" ? stick.grips : stick.most[part(key)] > 0);
  const turn = () => {
    const parts = {};
    for (const key of more) parts[part(key)] = (parts[part(key)] ?? 0) + MORE[key][1] * (slow ? SLOW : 1);
    if (!more.size) stick.without("more keys");
    else if (!stick.also("more keys", parts)) more.clear();
  };
  const letGo = () => {
    down.clear();
    more.clear();
    stick.without("more keys");
    stick.release("keys");
  };
  const shift = (event) => {
    if (event.shiftKey === slow) return;
    slow = event.shiftKey;
    if (down.size) stick.move("keys", ...steer());
    if (more.size) turn();
  };
  const act = {
    Enter: (event) => event.target.tagName !== "BUTTON" && buttons.arm(),
    KeyR: buttons.reset,
    KeyF: buttons.follow,
    KeyT: buttons.turn,
    KeyC: buttons.clear,
  };
  // Before anything else on the page sees it: whatever is open, Stop is heard.
  window.addEventListener("keydown", (event) => {
    shift(event);
    if (isStop(event)) {
      event.preventDefault();
      return buttons.stop();
    }
    // While one of these is down some systems never report that other keys are released: release all.
    if (event.ctrlKey || event.metaKey || event.altKey) return letGo();
    if (elsewhere(event.target)) return;
    const key = named(event);
    if (WAYS[key]) {
      event.preventDefault();
      if (event.repeat) return;
      down.add(key);
      if (stick.holder === "keys") stick.move("keys", ...steer());
      else if (!stick.press("keys", ...steer(), false)) down.clear();
    } else if (MORE[key] && has(key)) {
      event.preventDefault();
      if (event.repeat) return;
      more.add(key);
      turn();
    } else if (event.repeat) return;
    else if (act[key]) act[key](event);
    else if (event.key === "+" || event.key === "=") buttons.zoom(1.25);
    else if (event.key === "-") buttons.zoom(0.8);
  }, true);
  window.addEventListener("keyup", (event) => {
    shift(event);
    if (isStop(event)) event.preventDefault(); // some browsers press the button that has the focus only now
    if (more.delete(named(event))) return turn();
    if (!down.delete(named(event))) return;
    if (down.size) stick.move("keys", ...steer());
    else stick.release("keys");
  }, true);
  for (const event of ["pointermove", "pointerdown", "wheel"]) window.addEventListener(event, shift, { capture: true, passive: true });
  for (const event of ["blur", "pagehide", "offline", "contextmenu"]) window.addEventListener(event, letGo);
  document.addEventListener("visibilitychange", () => document.hidden && letGo());
  // If anything else ends the hold, it ends for the keys that are down, too.
  stick.listeners.push(() => {
    if (stick.holder !== "keys") down.clear();
    if (!stick.extras.has("more keys")) more.clear();
  });
}
