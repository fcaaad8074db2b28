import { describe, expect, it } from "vitest";
import { commandFor } from "../../image_view/keymap";
import { press } from "../../image_view/test_keys";
import { COMMANDS } from "../../labelling/commands";
import { LAYERS } from "./layers";
import { layerKey, VIEWER_COMMAND_GROUPS, VIEWER_COMMANDS, VIEWER_KEYMAP } from "./viewer_commands";

describe("commands of the viewer", () => {
  it("have keys of their own, and a heading that is listed", () => {
    const keys = VIEWER_COMMANDS.flatMap((command) => command.keys);
    expect(new Set(keys).size).toBe(keys.length);
    const groups: readonly string[] = VIEWER_COMMAND_GROUPS;
    for (const { group } of VIEWER_COMMANDS) expect(groups).toContain(group);
  });

  it("move the view and go to images by the keys of the label page", () => {
    for (const id of ["fit", "zoom-in", "pan-left", "next-image", "previous-image", "key-list", "leave"]) {
      const keys = (commands: readonly { id: string; keys: readonly string[] }[]) =>
        commands.find((command) => command.id === id)?.keys;
      expect(keys(VIEWER_COMMANDS)).toEqual(keys(COMMANDS));
    }
  });

  it("toggle each layer by its number", () => {
    for (const layer of LAYERS) {
      expect(commandFor(VIEWER_KEYMAP, press(layerKey(layer)), false)?.id).toBe(`layer-${layer}`);
    }
  });
});
