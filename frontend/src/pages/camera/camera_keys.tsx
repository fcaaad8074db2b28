import { IconButton } from "../../design/button";
import { Keys } from "../../design/kbd";
import { keyCaps } from "../../image_view/commands";
import { BEFORE_AFTER_COMMANDS } from "./before_after/before_after_commands";
import { PART_NAMES, PARTS } from "./camera_address";
import "../../image_view/image_view.css";
import "../../image_view/key_list.css";

type Row = readonly [what: string, keys: readonly string[]];

const PART_ROWS: readonly Row[] = [
  ...PARTS.map((part, place): Row => [PART_NAMES[part], [String(place + 1)]]),
  ["Show or hide this list", ["?"]],
];
const LIST_ROWS: readonly Row[] = [
  ["Read the cells of a map", ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"]],
  ["Go through the lines", ["ArrowUp", "ArrowDown"]],
  ["Open a line in its image", ["Enter"]],
  ["Move the edge", ["ArrowLeft", "ArrowRight"]],
];
const MOUSE_ROWS: readonly (readonly [string, string])[] = [
  ["Open the line there", "Click"],
  ["Move the edge", "Drag its handle"],
  ["Half and half", "Double click on it"],
  ["Move the image", "Drag"],
  ["Zoom at the pointer", "Wheel, pinch"],
];

/** All keys of the camera's page. */
export function CameraKeys({ onClose }: { onClose: () => void }) {
  const ofImage = (group: string) =>
    BEFORE_AFTER_COMMANDS.filter((command) => command.group === group).map(
      ({ label, keys }): Row => [label, keys.slice(0, 1)],
    );
  return (
    <section className="image-box key-list camera-keys" aria-label="Keys">
      <header>
        <h2>Keys</h2>
        <IconButton small icon="cross" label="Close" keys={["?"]} side="end" onClick={onClose} />
      </header>
      <div className="key-list__scroll">
        <div className="key-list__groups">
          <Group name="Parts" rows={PART_ROWS} />
          <Group name="Before and after" rows={ofImage("Image")} />
          <Group name="View" rows={ofImage("View")} />
          <Group name="With the focus on it" rows={LIST_ROWS} />
          <div>
            <h3>Mouse and touch</h3>
            <dl>
              {MOUSE_ROWS.map(([what, how]) => (
                <div key={what}>
                  <dt>{what}</dt>
                  <dd className="muted">{how}</dd>
                </div>
              ))}
            </dl>
          </div>
        </div>
      </div>
    </section>
  );
}

function Group({ name, rows }: { name: string; rows: readonly Row[] }) {
  return (
    <div>
      <h3>{name}</h3>
      <dl>
        {rows.map(([what, keys]) => (
          <div key={what}>
            <dt>{what}</dt>
            <dd>
              {keys.map((key) => (
                <Keys key={key} keys={keyCaps(key)} />
              ))}
            </dd>
          </div>
        ))}
      </dl>
    </div>
  );
}
