// The circular pad: mouse, pen or finger. Up and down is v_c, left and right is w_c.

const KNOB = 76; // how far the knob's centre goes, of the rim's 100

export function attachPad(stick, pad) {
  const knob = pad.querySelector("#pad-knob");
  const line = pad.querySelector("#pad-line");
  let pointer = null;

  const place = (event) => {
    const box = pad.getBoundingClientRect();
    const half = (box.width / 2) * (KNOB / 110);
    return [(event.clientX - box.left - box.width / 2) / half, -(event.clientY - box.top - box.height / 2) / half];
  };
  pad.addEventListener("pointerdown", (event) => {
    if (pointer !== null || event.button > 0) return;
    event.preventDefault();
    pad.focus({ preventScroll: true });
    pointer = event.pointerId;
    pad.setPointerCapture(pointer);
    stick.press("pad", ...place(event));
  });
  // Raw updates come at once; pointermove waits for the next frame, up to 17 ms.
  const moved = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";
  pad.addEventListener(moved, (event) => event.pointerId === pointer && stick.move("pad", ...place(event)));
  const end = (event) => {
    if (event.pointerId !== pointer) return;
    pointer = null;
    stick.release("pad");
  };
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) pad.addEventListener(name, end);
  pad.addEventListener("contextmenu", (event) => event.preventDefault());

  stick.listeners.push(() => {
    pad.dataset.held = stick.held;
    const [x, y] = [stick.x * KNOB, -stick.y * KNOB];
    knob.setAttribute("cx", x);
    knob.setAttribute("cy", y);
    line.setAttribute("x2", x);
    line.setAttribute("y2", y);
  });
}
