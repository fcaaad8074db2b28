import { beforeEach, expect, it } from "vitest";
import { HintBook } from "./hint_book";
import { HINTS, NEWCOMER, nextHint } from "./hints";

const all = () => true;
let kept: Map<string, string>;
let storage: Storage;

beforeEach(() => {
  kept = new Map();
  storage = {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => kept.set(key, value),
  } as unknown as Storage;
});

it("tells nothing at first, then one thing at a time", () => {
  expect(nextHint(NEWCOMER, all)).toBeNull();
  expect(nextHint({ judged: 2, known: [] }, all)?.id).toBe("keys");
  expect(nextHint({ judged: 1000, known: [] }, all)?.id).toBe("keys");
  expect(nextHint({ judged: 1000, known: ["keys"] }, all)?.id).toBe("brush");
});

it("passes over what isn't possible now", () => {
  expect(nextHint({ judged: 1000, known: [] }, (id) => id === "family")?.id).toBe("family");
});

it("has nothing left for whoever knows everything", () => {
  expect(nextHint({ judged: 1000, known: HINTS.map(({ id }) => id) }, all)).toBeNull();
});

it("remembers what was learnt, once, and how much was judged", () => {
  const book = new HintBook(storage);
  let heard = 0;
  book.subscribe(() => heard++);
  book.learnt("lasso");
  book.learnt("lasso");
  for (let i = 0; i < 500; i++) book.judged();
  const again = new HintBook(storage).getState();
  expect(again.known).toEqual(["lasso"]);
  expect(HINTS.every(({ after }) => again.judged >= after)).toBe(true);
  // Nobody is bothered for ever with counting.
  expect(heard).toBeLessThan(200);
});

it.each(["{", '"text"', '{"known": 3, "judged": "many"}', '{"known": ["nonsense"]}'])(
  "starts anew where %s was stored",
  (text) => {
    kept.set("clearlines.hints", text);
    expect(new HintBook(storage).getState()).toEqual(NEWCOMER);
  },
);
