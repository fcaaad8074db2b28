import { beforeEach, expect, it } from "vitest";
import type { PointerTool } from "../../canvas/pointer_tool";
import { ToolBox } from "./tool_box";

const tool = (cursor: string): PointerTool => ({
  cursor,
  down: () => undefined,
  move: () => undefined,
  up: () => undefined,
  cancel: () => undefined,
});
let box: ToolBox;

beforeEach(() => {
  box = new ToolBox();
  box.add("lasso", tool("lasso"));
  box.add("keep-brush", tool("brush"));
});

it("prefers what a key holds to what was chosen, and goes back to it", () => {
  box.choose("lasso");
  box.hold("keep-brush");
  expect(box.tool?.cursor).toBe("brush");
  box.release();
  expect(box.tool?.cursor).toBe("lasso");
});

it("releases only the tool whose key is up", () => {
  box.hold("keep-brush");
  box.release("lasso");
  expect(box.getState().held).toBe("keep-brush");
});

it("lays everything aside, and says whether there was anything", () => {
  expect(box.layAside()).toBe(false);
  box.choose("lasso");
  expect(box.layAside()).toBe(true);
  expect(box.tool).toBeNull();
});

it("has nothing in hand while the chosen tool isn't in the box", () => {
  const remove = box.add("trace", tool("trace"));
  box.choose("trace");
  remove();
  expect(box.tool).toBeNull();
  // The next image's tool comes into the same hand.
  box.add("trace", tool("the next image's"));
  expect(box.tool?.cursor).toBe("the next image's");
});

it("keeps a tool that took another one's place", () => {
  const remove = box.add("trace", tool("old"));
  box.add("trace", tool("new"));
  remove();
  box.choose("trace");
  expect(box.tool?.cursor).toBe("new");
});
