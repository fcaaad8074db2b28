import { useSyncExternalStore } from "react";
import { Button, IconButton } from "./button";
import { Icon, type IconName } from "./icons";

type ToastTone = "neutral" | "success" | "danger";

export interface ToastOptions {
  message: string;
  tone?: ToastTone;
  /** Usually Undo: what was done is already done, so nothing has to be asked beforehand. */
  action?: { label: string; run: () => void };
  /** How long it stays, in ms; errors stay until they are closed. */
  duration?: number;
  /** A toast with the same key replaces the one shown. */
  key?: string;
}

interface Shown extends ToastOptions {
  id: number;
}

const ICONS: Record<ToastTone, IconName> = { neutral: "info", success: "check", danger: "warning" };
const listeners = new Set<() => void>();
let shown: readonly Shown[] = [];
let nextId = 1;

export function toast(options: ToastOptions): void {
  const entry: Shown = { ...options, id: nextId++ };
  const others = shown.filter((other) => options.key === undefined || other.key !== options.key);
  set([...others, entry].slice(-3));
  const duration = options.duration ?? (options.tone === "danger" ? null : 6_000);
  if (duration !== null) setTimeout(() => dismiss(entry.id), duration);
}

export function dismissToast(key: string): void {
  set(shown.filter((entry) => entry.key !== key));
}

export function Toaster() {
  const entries = useSyncExternalStore(subscribe, () => shown);
  return (
    <div className="toaster" aria-live="polite">
      {entries.map((entry) => (
        <div key={entry.id} className={`toast toast--${entry.tone ?? "neutral"}`}>
          <Icon name={ICONS[entry.tone ?? "neutral"]} />
          <span>{entry.message}</span>
          {entry.action ? <ToastAction entry={entry} action={entry.action} /> : null}
          <IconButton small icon="cross" label="Close" side="up" onClick={() => dismiss(entry.id)} />
        </div>
      ))}
    </div>
  );
}

function ToastAction({ entry, action }: { entry: Shown; action: { label: string; run: () => void } }) {
  return (
    <Button
      small
      onClick={() => {
        dismiss(entry.id);
        action.run();
      }}
    >
      {action.label}
    </Button>
  );
}

function dismiss(id: number): void {
  set(shown.filter((entry) => entry.id !== id));
}

function set(next: readonly Shown[]): void {
  shown = next;
  for (const listener of listeners) listener();
}

function subscribe(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}
