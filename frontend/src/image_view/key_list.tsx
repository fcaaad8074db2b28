import { IconButton } from "../design/button";
import { Keys } from "../design/kbd";
import { type Command, keyCaps } from "./commands";
import "./key_list.css";

interface KeyListProps<Actions> {
  commands: readonly Command<Actions>[];
  /** Headings in their order. */
  groups: readonly string[];
  onClose: () => void;
}

/** All keys, beside the image: it isn't a dialog, so one can try them while reading. */
export function KeyList<Actions>({ commands, groups, onClose }: KeyListProps<Actions>) {
  return (
    <section className="image-box key-list" aria-label="Keys">
      <header>
        <h2>Keys</h2>
        <IconButton small icon="cross" label="Close" keys={["?"]} side="end" onClick={onClose} />
      </header>
      <div className="key-list__scroll">
        <div className="key-list__groups">
          {groups.map((group) => (
            <div key={group}>
              <h3>{group}</h3>
              <dl>
                {commands
                  .filter((command) => command.group === group)
                  .map((command) => (
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
      </div>
    </section>
  );
}

function KeyRow<Actions>({ command }: { command: Command<Actions> }) {
  return (
    <div>
      <dt>{command.label}</dt>
      <dd>
        {command.keys
          .filter((key, place) => place === 0 || isOfItsOwn(key, command.keys))
          .map((key) => (
            <Keys key={key} keys={keyCaps(key)} />
          ))}
      </dd>
    </div>
  );
}

/** Not what one presses for the same by habit, or with Shift by accident. */
function isOfItsOwn(key: string, keys: readonly string[]): boolean {
  return !key.startsWith("Ctrl") && key !== "=" && key !== `Shift+${keys[0]}`;
}

function TextRow({ what, how }: { what: string; how: string }) {
  return (
    <div>
      <dt>{what}</dt>
      <dd className="muted">{how}</dd>
    </div>
  );
}
