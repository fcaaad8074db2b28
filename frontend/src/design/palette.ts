import { useSyncExternalStore } from "react";
import { PALETTES, type Palette } from "../canvas/palette";

const STORAGE_KEY = "clearlines.palette";
const listeners = new Set<() => void>();
let palette: Palette = storedPalette();

/** Sets the palette before the first paint. */
export function startPalette(): void {
  apply();
}

export function usePalette(): Palette {
  return useSyncExternalStore(subscribeToPalette, getPalette);
}

export function getPalette(): Palette {
  return palette;
}

/** Every page, and every picture on them, has these colours from now on. */
export function setPalette(next: Palette): void {
  if (next === palette) return;
  palette = next;
  try {
    localStorage.setItem(STORAGE_KEY, next);
  } catch {
    // Storage may be blocked; the choice then lasts as long as the page.
  }
  apply();
}

export function subscribeToPalette(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

function apply(): void {
  document.documentElement.dataset.palette = palette;
  for (const listener of [...listeners]) listener();
}

function storedPalette(): Palette {
  try {
    return PALETTES.find((known) => known === localStorage.getItem(STORAGE_KEY)) ?? "standard";
  } catch {
    return "standard";
  }
}
