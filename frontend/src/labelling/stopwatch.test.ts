import { expect, it } from "vitest";
import { Stopwatch } from "./stopwatch";

function started() {
  let time = 1000;
  const stopwatch = new Stopwatch(() => time);
  return { stopwatch, pass: (milliseconds: number) => (time += milliseconds) };
}

it("measures since the last restart", () => {
  const { stopwatch, pass } = started();
  pass(250.4);
  expect(stopwatch.read()).toBe(250);
  stopwatch.restart();
  pass(30);
  expect(stopwatch.read()).toBe(30);
});

it("stands still while the page is hidden", () => {
  const { stopwatch, pass } = started();
  pass(100);
  stopwatch.hide();
  pass(60_000);
  expect(stopwatch.read()).toBe(100);
  stopwatch.show();
  pass(20);
  expect(stopwatch.read()).toBe(120);
});

it("starts at zero after a restart in the background", () => {
  const { stopwatch, pass } = started();
  stopwatch.hide();
  pass(500);
  stopwatch.restart();
  pass(500);
  stopwatch.show();
  pass(7);
  expect(stopwatch.read()).toBe(7);
});
