import type { ButtonHTMLAttributes, ReactNode } from "react";
import { Icon, type IconName } from "./icons";
import { Tooltip } from "./tooltip";

type Tone = "default" | "primary" | "quiet" | "danger";

interface ButtonProps extends ButtonHTMLAttributes<HTMLButtonElement> {
  tone?: Tone;
  small?: boolean;
  icon?: IconName | undefined;
  busy?: boolean;
  children?: ReactNode;
}

export function Button({ tone = "default", small, icon, busy, children, className, ...rest }: ButtonProps) {
  return (
    <button
      type="button"
      {...rest}
      disabled={rest.disabled || busy}
      className={buttonClass(tone, small, className)}
    >
      {busy ? <span className="spinner" aria-hidden="true" /> : icon ? <Icon name={icon} /> : null}
      {children}
    </button>
  );
}

interface IconButtonProps extends Omit<ButtonProps, "children" | "icon"> {
  icon: IconName;
  label: string;
  keys?: string[];
  side?: "down" | "up" | "end" | "after";
}

/** A button of an icon alone: the label is its accessible name and its tooltip. */
export function IconButton({ icon, label, keys, side, tone = "quiet", small, ...rest }: IconButtonProps) {
  return (
    <Tooltip text={label} keys={keys} side={side}>
      <button
        type="button"
        aria-label={label}
        {...rest}
        className={buttonClass(tone, small, `button--icon ${rest.className ?? ""}`)}
      >
        <Icon name={icon} />
      </button>
    </Tooltip>
  );
}

export function buttonClass(tone: Tone = "default", small?: boolean, extra?: string): string {
  const names = ["button"];
  if (tone !== "default") names.push(`button--${tone}`);
  if (small) names.push("button--small");
  if (extra) names.push(extra);
  return names.join(" ");
}
