import { IconButton } from "../../design/button";
import { Keys } from "../../design/kbd";
import { COMMAND_GROUPS, COMMANDS, type Command, keyCaps } from "../../labelling/commands";
import "./key_list.css";

/** All keys, beside the image: it isn't a dialog, so one can try them while reading. */
export function KeyList({ onClose }: { onClose: () => void }) {
  return (
    <section className="key-list" aria-label="Keys">
      <header>
        <h2>Keys</h2>
        <IconButton small icon="cross" label="Close" keys={["?"]} side="end" onClick={onClose} />
      </header>
      <div className="key-list__groups">
        {COMMAND_GROUPS.map((group) => (
          <div key={group}>
            <h3>{group}</h3>
            <dl>
              {COMMANDS.filter((command) => command.group === group).map((command) => (
                <KeyRow key={command.id} command={command} />
              ))}
            </dl>
          </div>
        ))}
        <div>
          <h3>Mouse and touch</h3>
          <dl>
            <TextRow what="Select; again: the next one there" how="Click" />
            <TextRow what="Move the image" how="Drag" />
            <TextRow what="Zoom at the pointer" how="Wheel, pinch" />
          </dl>
        </div>
      </div>
    </section>
  );
}

function KeyRow({ command }: { command: Command }) {
  return (
    <div>
      <dt>{command.label}</dt>
      <dd>
        {command.keys
          .filter((key) => !key.startsWith("Ctrl") && key !== "=")
          .map((key) => (
            <Keys key={key} keys={keyCaps(key)} />
          ))}
      </dd>
    </div>
  );
}

function TextRow({ what, how }: { what: string; how: string }) {
  return (
    <div>
      <dt>{what}</dt>
      <dd className="muted">{how}</dd>
    </div>
  );
}
