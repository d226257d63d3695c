// What this browser keeps of the page's own settings. Private windows may refuse: a choice then holds for this page only.

const full = (name) => `overreach-${name}`;

export function kept(name, usual = null) {
  try {
    return localStorage.getItem(full(name)) ?? usual;
  } catch {
    return usual;
  }
}

export function keep(name, value) {
  try {
    localStorage.setItem(full(name), value);
  } catch {
    // See above.
  }
}
