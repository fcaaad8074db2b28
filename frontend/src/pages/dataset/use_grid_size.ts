import { useState } from "react";
import type { GridSize } from "./grid_layout";

const STORAGE_KEY = "clearlines.grid-size";

/** The size of the pictures that this person likes. */
export function useGridSize(): [GridSize, (size: GridSize) => void] {
  const [size, setSize] = useState<GridSize>(stored);
  const choose = (next: GridSize) => {
    setSize(next);
    try {
      localStorage.setItem(STORAGE_KEY, next);
    } catch {
      // Storage may be blocked; the choice then lasts as long as the page.
    }
  };
  return [size, choose];
}

function stored(): GridSize {
  try {
    return localStorage.getItem(STORAGE_KEY) === "large" ? "large" : "small";
  } catch {
    return "small";
  }
}
