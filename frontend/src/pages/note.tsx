import type { ReactNode } from "react";
import { Icon, type IconName } from "../design/icons";
import "./board_page.css";

interface NoteProps {
  tone?: "info" | "warning" | "danger";
  icon?: IconName;
  children: ReactNode;
}

/** A remark in the page, where it is needed. */
export function Note({ tone = "info", icon, children }: NoteProps) {
  return (
    <div className={`note note--${tone}`} role={tone === "danger" ? "alert" : undefined}>
      <Icon name={icon ?? (tone === "info" ? "info" : "warning")} />
      <div>{children}</div>
    </div>
  );
}
