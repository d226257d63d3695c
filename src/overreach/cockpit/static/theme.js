// Light, dark, or as the system prefers. Colours are read from the style sheet, so that they are set in one place.

const system = matchMedia("(prefers-color-scheme: dark)");
const listeners = [];

const chosen = () => {
  try {
    return localStorage.getItem("overreach-theme");
  } catch {
    return null;
  }
};
const apply = () => {
  const dark = chosen() ? chosen() === "dark" : system.matches;
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  window.Quasar?.Dark?.set(dark);
  for (const listener of listeners) listener();
};

export function toggleTheme() {
  const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  try {
    localStorage.setItem("overreach-theme", next);
  } catch {
    // Private windows may refuse: the choice then holds for this page only.
  }
  document.documentElement.dataset.theme = next;
  window.Quasar?.Dark?.set(next === "dark");
  for (const listener of listeners) listener();
}

export const onTheme = (listener) => listeners.push(listener);
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

system.addEventListener("change", apply);
apply();
