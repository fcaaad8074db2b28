import { expect, it } from "vitest";
import { Speed } from "./speed";

it("says nothing from one moment, then bytes per second of the last seconds alone", () => {
  const speed = new Speed(1_000);
  speed.record(0, 0);
  expect(speed.bytesPerSecond).toBe(0);
  speed.record(500, 1_000);
  expect(speed.bytesPerSecond).toBe(2_000);
  for (let time = 1_000; time <= 5_000; time += 500) speed.record(time, 1_000 + (time - 500) / 10);
  expect(speed.bytesPerSecond).toBe(100);
});
