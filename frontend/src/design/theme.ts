import { useSyncExternalStore } from "react";

export type ThemeChoice = "auto" | "light" | "dark";

const STORAGE_KEY = "clearlines.theme";
const darkPreferred = window.matchMedia("(prefers-color-scheme: dark)");
const listeners = new Set<() => void>();
let choice: ThemeChoice = storedChoice();

/** Sets the theme before the first paint and keeps following the system where the choice is "auto". */
export function startTheme(): void {
  apply();
  darkPreferred.addEventListener("change", apply);
}

export function useTheme(): { choice: ThemeChoice; setChoice: (next: ThemeChoice) => void } {
  return { choice: useSyncExternalStore(subscribe, () => choice), setChoice };
}

function setChoice(next: ThemeChoice): void {
  choice = next;
  try {
    localStorage.setItem(STORAGE_KEY, next);
  } catch {
    // Storage may be blocked; the choice then lasts as long as the page.
  }
  apply();
}

function apply(): void {
  const dark = choice === "dark" || (choice === "auto" && darkPreferred.matches);
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  for (const listener of listeners) listener();
}

function storedChoice(): ThemeChoice {
  try {
    const stored = localStorage.getItem(STORAGE_KEY);
    return stored === "light" || stored === "dark" ? stored : "auto";
  } catch {
    return "auto";
  }
}

function subscribe(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}
