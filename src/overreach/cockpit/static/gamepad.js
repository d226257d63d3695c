// The Gamepad API's standard mapping: left stick drives, B or Circle stops, Start arms.
// A self-centring stick is its own dead-man: off centre it is held, at centre it is released. After any release, and
// at the start, it must be seen at its centre before it counts again, and it takes the hold from no other input.

const CENTRE = 0.15;
const HOLD = 0.08; // once held, released only nearer to the centre
const BUTTON_STOP = 1;
const BUTTON_ARM = 9;

export function attachGamepad(stick, buttons) {
  const was = { stop: false, arm: false };
  let centred = false;
  const look = () => {
    const pad = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected);
    if (!pad || document.hidden) {
      centred = false;
      return stick.release("gamepad"); // unplugged, or out of sight
    }
    const [x, y] = [pad.axes[0] ?? 0, -(pad.axes[1] ?? 0)];
    const size = Math.hypot(x, y);
    const held = stick.holder === "gamepad";
    if (size > (held ? HOLD : CENTRE)) {
      const part = Math.min(1, (size - HOLD) / (1 - HOLD)) / size;
      if (held) {
        if (x * part !== stick.x || y * part !== stick.y) stick.move("gamepad", x * part, y * part);
      } else if (centred && !stick.held) {
        stick.press("gamepad", x * part, y * part);
        centred = false;
      }
    } else {
      stick.release("gamepad");
      centred = true;
    }
    const stop = pad.buttons[BUTTON_STOP]?.pressed ?? false;
    const arm = pad.buttons[BUTTON_ARM]?.pressed ?? false;
    if (stop && !was.stop) buttons.stop();
    if (arm && !was.arm) buttons.arm();
    was.stop = stop;
    was.arm = arm;
  };
  setInterval(look, 1000 / 60);
}
