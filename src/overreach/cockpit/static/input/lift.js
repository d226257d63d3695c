// The lever for height: springs back to the middle, holds like the pad, and can be held beside it.

const STILL_PX = 0.5; // a lever that has moved under the finger means something else
const REACH = 0.8; // full deflection at this part of half its length

export function attachLift(stick, lift) {
  const knob = lift.querySelector("#lift-knob");
  const rail = lift.querySelector(".rail");
  let hold = null; // pointer, box: as they were at the press

  const place = (event) => {
    const { top, height } = hold.box;
    return Math.max(-1, Math.min(1, -(event.clientY - top - height / 2) / ((height / 2) * REACH)));
  };
  const end = (doubt = "") => {
    if (!hold) return;
    hold = null;
    stick.without("lift", doubt);
  };
  const inDoubt = () => {
    if (!hold) return false;
    const now = rail.getBoundingClientRect();
    const far = Math.max(Math.abs(now.top - hold.box.top), Math.abs(now.height - hold.box.height), Math.abs(now.left - hold.box.left));
    if (far <= STILL_PX) return false;
    end("The lever moved under the finger: press again.");
    return true;
  };
  lift.addEventListener("pointerdown", (event) => {
    if (event.button > 0 || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    end();
    hold = { pointer: event.pointerId, box: rail.getBoundingClientRect() };
    try {
      lift.setPointerCapture(event.pointerId);
    } catch {
      return (hold = null); // the pointer is gone already
    }
    if (!stick.also("lift", { v_z: place(event) })) hold = null;
  });
  lift.addEventListener("pointermove", (event) => {
    if (event.pointerId === hold?.pointer && !inDoubt()) stick.also("lift", { v_z: place(event) });
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
    lift.addEventListener(name, (event) => event.pointerId === hold?.pointer && end());
  }
  lift.addEventListener("contextmenu", (event) => event.preventDefault());
  for (const event of ["resize", "scroll", "orientationchange"]) window.addEventListener(event, inDoubt, true);
  window.addEventListener("keydown", (event) => ["Control", "Alt", "AltGraph", "Meta"].includes(event.key) && end(), true);

  stick.listeners.push(() => {
    if (!stick.extras.has("lift")) hold = null;
    const z = stick.extra("v_z");
    lift.dataset.held = hold !== null || z !== 0;
    lift.setAttribute("aria-valuenow", z.toFixed(2));
    knob.style.top = `calc(${(50 - z * REACH * 40).toFixed(1)}% - 29px)`;
  });
}
