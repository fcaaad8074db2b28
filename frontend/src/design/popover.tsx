import { type ReactNode, useEffect, useId, useLayoutEffect, useRef, useState } from "react";
import { buttonClass } from "./button";
import { Icon, type IconName } from "./icons";

/** What a panel keeps to the edges of the window, px. */
const EDGE = 8;

interface PopoverProps {
  label: string;
  icon?: IconName;
  /** Shows the icon alone; the label is then the accessible name. */
  iconOnly?: boolean;
  tone?: "default" | "quiet";
  small?: boolean;
  align?: "start" | "end";
  children: (close: () => void) => ReactNode;
}

/** A button that opens a panel below itself. Escape and a press elsewhere close it; nothing behind it is blocked. */
export function Popover({ label, icon, iconOnly, tone, small, align = "end", children }: PopoverProps) {
  const [open, setOpen] = useState(false);
  const root = useRef<HTMLDivElement>(null);
  const button = useRef<HTMLButtonElement>(null);
  const panel = useRef<HTMLDivElement>(null);
  const panelId = useId();

  useEffect(() => {
    if (!open) return;
    const onPointerDown = (event: PointerEvent) => {
      if (!root.current?.contains(event.target as Node)) setOpen(false);
    };
    window.addEventListener("pointerdown", onPointerDown);
    return () => window.removeEventListener("pointerdown", onPointerDown);
  }, [open]);

  useLayoutEffect(() => {
    const shown = panel.current;
    if (!open || !shown) return;
    const { left, right } = shown.getBoundingClientRect();
    const overRight = Math.max(0, right - (document.documentElement.clientWidth - EDGE));
    shown.style.translate = `${left < EDGE ? EDGE - left : -overRight}px`;
  }, [open]);

  const close = () => {
    setOpen(false);
    button.current?.focus();
  };

  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: Escape is heard from whatever has the focus inside
    <div
      ref={root}
      className="popover"
      onKeyDown={(event) => {
        if (event.key !== "Escape" || !open) return;
        event.stopPropagation();
        close();
      }}
    >
      <button
        ref={button}
        type="button"
        className={buttonClass(tone, small, iconOnly ? "button--icon" : undefined)}
        aria-expanded={open}
        aria-controls={open ? panelId : undefined}
        aria-label={iconOnly ? label : undefined}
        title={iconOnly ? label : undefined}
        onClick={() => setOpen(!open)}
      >
        {icon ? <Icon name={icon} /> : null}
        {iconOnly ? null : label}
        {iconOnly ? null : <Icon name="down" size={12} />}
      </button>
      {open ? (
        <div ref={panel} id={panelId} className={`popover__panel popover__panel--${align}`}>
          {children(close)}
        </div>
      ) : null}
    </div>
  );
}
