// Arrow keys and W A S D. Shift is a quarter of the speed. A held key is the dead-man.

const WAYS = {
  ArrowUp: [0, 1], KeyW: [0, 1],
  ArrowDown: [0, -1], KeyS: [0, -1],
  ArrowLeft: [-1, 0], KeyA: [-1, 0],
  ArrowRight: [1, 0], KeyD: [1, 0],
};
const SLOW = 0.25;

const writing = (target) => target.closest?.("input, textarea, [contenteditable]");

// A key that a text field or a slider would take for itself is not ours.
const elsewhere = (target) => target.closest?.("input, textarea, select, [contenteditable], .q-field, .q-slider, [role=slider], [role=listbox]");

export function attachKeys(stick, buttons) {
  const down = new Set();
  let slow = false;

  const steer = () => {
    let x = 0;
    let y = 0;
    for (const code of down) {
      x += WAYS[code][0];
      y += WAYS[code][1];
    }
    const size = Math.max(1, Math.hypot(x, y)) / (slow ? SLOW : 1);
    return [x / size, y / size];
  };
  const letGo = () => {
    down.clear();
    stick.release("keys");
  };
  window.addEventListener("keydown", (event) => {
    if (event.code === "Escape" || (event.code === "Space" && !writing(event.target))) {
      event.preventDefault();
      return buttons.stop();
    }
    // While Ctrl, Alt or Meta is down some systems never report that other keys are released: release all.
    if (event.ctrlKey || event.metaKey || event.altKey) return letGo();
    if (elsewhere(event.target)) return;
    if (event.key === "Shift") {
      slow = true;
      if (down.size) stick.move("keys", ...steer());
    }
    if (event.repeat) return WAYS[event.code] && event.preventDefault();
    if (WAYS[event.code]) {
      event.preventDefault();
      down.add(event.code);
      if (stick.holder === "keys") stick.move("keys", ...steer());
      else stick.press("keys", ...steer());
    } else if (event.code === "Enter" && event.target.tagName !== "BUTTON") buttons.arm();
    else if (event.code === "KeyR") buttons.reset();
    else if (event.code === "KeyF") buttons.follow();
    else if (event.code === "KeyC") buttons.clear();
    else if (event.key === "+" || event.key === "=") buttons.zoom(1.25);
    else if (event.key === "-") buttons.zoom(0.8);
  });
  window.addEventListener("keyup", (event) => {
    if (event.key === "Shift") {
      slow = false;
      if (down.size) stick.move("keys", ...steer());
    }
    if (!down.delete(event.code)) return;
    if (down.size) stick.move("keys", ...steer());
    else stick.release("keys");
  });
  for (const event of ["blur", "pagehide", "offline", "contextmenu"]) window.addEventListener(event, letGo);
  document.addEventListener("visibilitychange", () => document.hidden && letGo());
  // If anything else ends the hold, it ends for the keys that are down, too.
  stick.listeners.push(() => stick.held || down.clear());
}
