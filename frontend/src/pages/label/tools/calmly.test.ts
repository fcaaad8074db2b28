import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { calmly } from "./calmly";

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

it("acts at once, then as often as it may, and for the last time in the end", () => {
  let acts = 0;
  const { call } = calmly(() => acts++);
  call();
  expect(acts).toBe(1);
  for (let i = 0; i < 10; i++) call();
  expect(acts).toBe(1);
  vi.advanceTimersByTime(1_000);
  expect(acts).toBe(2);
  call();
  expect(acts).toBe(3);
});

it("forgets what is still to come", () => {
  let acts = 0;
  const { call, forget } = calmly(() => acts++);
  call();
  call();
  forget();
  vi.advanceTimersByTime(1_000);
  expect(acts).toBe(1);
});
