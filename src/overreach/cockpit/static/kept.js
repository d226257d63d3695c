// What this browser keeps of the page's own: for good, or in `SESSION` for as long as the tab is open. Private windows
// may refuse: a choice then holds for this page only.

export const SESSION = "sessionStorage";
const FOR_GOOD = "localStorage";
const full = (name) => `overreach-${name}`;

export function kept(name, usual = null, where = FOR_GOOD) {
  try {
    return window[where].getItem(full(name)) ?? usual;
  } catch {
    return usual;
  }
}

// Keep a text; null forgets it.
export function keep(name, value, where = FOR_GOOD) {
  try {
    if (value === null) window[where].removeItem(full(name));
    else window[where].setItem(full(name), value);
  } catch {
    // See above.
  }
}
