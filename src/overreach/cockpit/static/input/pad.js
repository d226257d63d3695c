// The circular pad: mouse, pen or finger. A hold ends as soon as its meaning is in doubt.

const KNOB = 76; // how far the knob's centre goes, of the rim's 100
const STILL_PX = 0.5; // a pad that has moved further under the finger means something else

export function attachPad(stick, pad) {
  const knob = pad.querySelector("#pad-knob");
  const line = pad.querySelector("#pad-line");
  let hold = null; // pointer, buttons, box: as they were at the press

  const place = (event) => {
    const { left, top, width, height } = hold.box;
    const half = (width / 2) * (KNOB / 110);
    return [(event.clientX - left - width / 2) / half, -(event.clientY - top - height / 2) / half];
  };
  const end = (doubt = "") => {
    if (!hold) return;
    hold = null;
    stick.release("pad", doubt);
  };
  const moved = () => {
    const { left, top, width, height } = pad.getBoundingClientRect();
    const was = hold.box;
    const far = Math.max(Math.abs(left - was.left), Math.abs(top - was.top), Math.abs(width - was.width), Math.abs(height - was.height));
    return far > STILL_PX || hold.zoom !== zoom();
  };
  const inDoubt = () => hold && moved() && (end("The pad moved under the finger: press again."), true);

  pad.addEventListener("pointerdown", (event) => {
    if (event.button > 0 || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    end(); // of a touch whose end was never told, or with another finger: the newest press counts
    pad.focus({ preventScroll: true });
    hold = { pointer: event.pointerId, buttons: event.buttons, box: pad.getBoundingClientRect(), zoom: zoom() };
    try {
      pad.setPointerCapture(event.pointerId);
    } catch {
      return (hold = null); // the pointer is gone already
    }
    if (!stick.press("pad", ...place(event))) hold = null;
  });
  const move = (event) => {
    if (event.pointerId !== hold?.pointer) return;
    if (event.buttons !== hold.buttons) return end("Another button: press again.");
    if (!inDoubt()) stick.move("pad", ...place(event));
  };
  // Raw updates come at once; pointermove waits for the next frame, up to 17 ms, but tells of every button.
  if ("onpointerrawupdate" in window) pad.addEventListener("pointerrawupdate", move);
  pad.addEventListener("pointermove", move);
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
    pad.addEventListener(name, (event) => event.pointerId === hold?.pointer && end());
  }
  pad.addEventListener("contextmenu", (event) => event.preventDefault());

  for (const event of ["resize", "scroll", "orientationchange"]) window.addEventListener(event, inDoubt, true);
  for (const event of ["resize", "scroll"]) window.visualViewport?.addEventListener(event, inDoubt);
  const look = () => {
    inDoubt(); // whatever moved it: a panel that opens tells nobody
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
  window.addEventListener("keydown", (event) => ["Control", "Alt", "AltGraph", "Meta"].includes(event.key) && end(), true);

  stick.listeners.push(() => {
    if (stick.holder !== "pad") hold = null;
    pad.dataset.held = stick.held;
    const [x, y] = [stick.x * KNOB, -stick.y * KNOB];
    knob.setAttribute("cx", x);
    knob.setAttribute("cy", y);
    line.setAttribute("x2", x);
    line.setAttribute("y2", y);
  });
}

const zoom = () => `${window.devicePixelRatio} ${window.visualViewport?.scale}`;
