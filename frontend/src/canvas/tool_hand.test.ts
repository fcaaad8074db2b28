import { beforeEach, expect, it } from "vitest";
import type { PointerTool } from "./pointer_tool";
import { ToolHand } from "./tool_hand";

let heard: string[];
let hand: ToolHand;
let shown: PointerTool | null;

const tool = (name: string): PointerTool => ({
  cursor: name,
  down: ({ x }, _, shift) => heard.push(`${name} down ${x}${shift ? " shift" : ""}`),
  move: ({ x }) => heard.push(`${name} move ${x}`),
  up: ({ x }) => heard.push(`${name} up ${x}`),
  cancel: () => heard.push(`${name} cancel`),
  hover: (at) => heard.push(`${name} hover ${at?.x ?? "nowhere"}`),
});
const screen = { x: 10, y: 0 };

beforeEach(() => {
  heard = [];
  shown = null;
  hand = new ToolHand({
    imagePoint: ({ x, y }) => ({ x: x / 10, y }),
    show: (next) => {
      shown = next;
    },
  });
});

it("leaves drags and hovering to the view while no tool is in hand", () => {
  expect(hand.begin()).toBeNull();
  expect(hand.hover(screen)).toBe(false);
});

it("tells the tool places in the image", () => {
  hand.take(tool("brush"));
  const drag = hand.begin();
  drag?.down(screen, true);
  drag?.move(screen);
  drag?.up(screen);
  expect(heard).toEqual(["brush down 1 shift", "brush move 1", "brush up 1"]);
});

it("lets a drag end with the tool it began with", () => {
  hand.take(tool("brush"));
  const drag = hand.begin();
  drag?.down(screen, false);
  hand.take(null);
  expect(shown?.cursor).toBe("brush");
  drag?.up(screen);
  expect(heard).toEqual(["brush down 1", "brush up 1", "brush hover nowhere"]);
  expect(shown).toBeNull();
});

it("forgets a drag that is cancelled", () => {
  hand.take(tool("brush"));
  const drag = hand.begin();
  drag?.down(screen, false);
  expect(hand.cancel()).toBe(true);
  expect(hand.cancel()).toBe(false);
  drag?.move(screen);
  drag?.up(screen);
  expect(heard).toEqual(["brush down 1", "brush cancel"]);
});

it("takes the pointer away from a tool that is laid aside", () => {
  const brush = tool("brush");
  expect(hand.take(brush)).toBe(true);
  expect(hand.take(brush)).toBe(false);
  hand.take(null);
  expect(heard).toEqual(["brush hover nowhere"]);
});
