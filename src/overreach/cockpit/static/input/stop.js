// The Stop button acts at the press: of any finger, mouse button or pen, however it goes on. While a page is scrolled by
// one finger, browsers tell of a second one by touch events alone.

export function attachStop(button, stop) {
  for (const press of ["pointerdown", "touchstart"]) button.addEventListener(press, stop, { passive: true });
  // By Enter, or by whoever reads the page aloud: such a click has no press before it.
  button.addEventListener("click", (event) => event.detail === 0 && stop());
}
