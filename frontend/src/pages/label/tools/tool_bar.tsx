import type { ReactNode } from "react";
import { useRights } from "../../../api/use_rights";
import { IconButton } from "../../../design/button";
import type { IconName } from "../../../design/icons";
import { HINT_OF_TOOL } from "../../../labelling/hints/hints";
import { hintBook } from "../../../labelling/hints/hints_start";
import type { ToolName } from "../../../labelling/tools/tool_box";
import { toolBox } from "../../../labelling/tools/tools_start";
import { useToolBoxState } from "./use_tool_box";
import "./tool_bar.css";

interface ToolButton {
  readonly name: ToolName | null;
  readonly label: string;
  readonly icon: IconName;
  readonly caps: string;
  /** Gives verdicts. */
  readonly judges?: boolean;
}

const BUTTONS: readonly ToolButton[] = [
  { name: null, label: "Pointer: click selects, drag moves", icon: "pointer", caps: "Esc" },
  { name: "keep-brush", label: "Keep brush; or hold", icon: "keepBrush", caps: "W", judges: true },
  { name: "reject-brush", label: "Reject brush; or hold", icon: "rejectBrush", caps: "E", judges: true },
  {
    name: "turn-brush",
    label: "Turn brush, from one wrong line to another; or hold",
    icon: "turnBrush",
    caps: "T",
    judges: true,
  },
  { name: "lasso", label: "Lasso selects; or hold", icon: "lasso", caps: "Q" },
];

interface ToolBarProps {
  /** Further groups of buttons below the tools. */
  children?: ReactNode;
}

/** What keys hold, for hands that hold no keys: touch and trackpad. */
export function ToolBar({ children }: ToolBarProps) {
  const { chosen, held } = useToolBoxState();
  const { label: judges } = useRights();
  const current = held ?? chosen;
  return (
    <div className="tool-bar" role="toolbar" aria-label="Tools" aria-orientation="vertical">
      {BUTTONS.filter((button) => judges || !button.judges).map(({ name, label, icon, caps }) => (
        <IconButton
          key={label}
          icon={icon}
          label={label}
          side="after"
          keys={[caps]}
          className={name === null ? "" : `tool-bar__${name}`}
          aria-pressed={current === name}
          onClick={() => {
            if (name !== null) hintBook.learnt(HINT_OF_TOOL[name]);
            toolBox.choose(name);
          }}
        />
      ))}
      {children}
    </div>
  );
}
