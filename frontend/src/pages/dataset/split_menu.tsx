import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { splitQuery } from "../../api/board_queries";
import type { Split } from "../../api/board_types";
import { formatQuantity } from "../../design/format";
import { Icon } from "../../design/icons";
import { InlineEdit } from "../../design/inline_edit";
import { Popover } from "../../design/popover";
import { useSplitActions } from "./use_split_actions";

/** What a maintainer can do with a split. */
export function SplitMenu({ split }: { split: Split }) {
  return (
    <Popover label={`More for ${split.name}`} icon="more" iconOnly tone="quiet" small>
      {(close) => <Entries split={split} close={close} />}
    </Popover>
  );
}

function Entries({ split, close }: { split: Split; close: () => void }) {
  const { rename, freezeAnew, closeNow, remove } = useSplitActions(split);
  const [renaming, setRenaming] = useState(false);
  const whole = useQuery(splitQuery(split.slug));
  const changed = whole.data?.labels_since?.changed.length ?? 0;
  const act = (run: () => Promise<void>) => () => {
    close();
    void run();
  };
  if (renaming) {
    return <InlineEdit label="Name of the split" value={split.name} close={close} save={rename} />;
  }
  return (
    <>
      <button type="button" className="menu-item" onClick={() => setRenaming(true)}>
        <Icon name="pencil" /> Rename
      </button>
      <button type="button" className="menu-item" onClick={act(freezeAnew)}>
        <Icon name="snow" /> Freeze version {split.version.number + 1}
        {changed > 0 ? <span className="muted">{formatQuantity(changed, "image")} relabelled</span> : null}
      </button>
      {split.closed ? null : (
        <button type="button" className="menu-item" onClick={act(closeNow)}>
          <Icon name="lock" /> Close now
        </button>
      )}
      <button type="button" className="menu-item menu-item--danger" onClick={act(remove)}>
        <Icon name="trash" /> Delete
      </button>
    </>
  );
}
