// Light, dark, or as the system prefers. Colours are read from the style sheet, so that they are set in one place.

import { keep, kept } from "../kept.js";

const system = matchMedia("(prefers-color-scheme: dark)");
const listeners = [];

const apply = () => {
  const dark = kept("theme") ? kept("theme") === "dark" : system.matches;
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  window.Quasar?.Dark?.set(dark);
  for (const listener of listeners) listener();
};

export function toggleTheme() {
  const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  keep("theme", next);
  document.documentElement.dataset.theme = next;
  window.Quasar?.Dark?.set(next === "dark");
  for (const listener of listeners) listener();
}

export const onTheme = (listener) => listeners.push(listener);
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

system.addEventListener("change", apply);
apply();
