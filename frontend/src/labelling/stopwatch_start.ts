/** The page's one stopwatch: only one image is under review at a time. */

import { Stopwatch } from "./stopwatch";

export const stopwatch = new Stopwatch(() => performance.now());

document.addEventListener("visibilitychange", () => {
  if (document.visibilityState === "hidden") stopwatch.hide();
  else stopwatch.show();
});
