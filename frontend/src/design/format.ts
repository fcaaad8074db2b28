/** Numbers and times as people read them. */

// Made when a time is first shown: with the first of these a browser loads what it knows of languages, for some 40 ms in
// which it does nothing else. For the same reason whole numbers do without.
let dates: Intl.DateTimeFormat | null = null;
let days: Intl.DateTimeFormat | null = null;

/** A whole number with its thousands apart: "1,234". */
export function formatCount(count: number): string {
  return String(Math.round(count)).replace(/\B(?=(\d{3})+$)/g, ",");
}

/** "1 image", "2 images". */
export function formatQuantity(count: number, one: string, many = `${one}s`): string {
  return `${formatCount(count)} ${count === 1 ? one : many}`;
}

export function formatDate(time: string): string {
  dates ??= new Intl.DateTimeFormat("en", { dateStyle: "medium", timeStyle: "short" });
  return dates.format(new Date(time));
}

/** The day alone, where the time of day says nothing. */
export function formatDay(time: string): string {
  days ??= new Intl.DateTimeFormat("en", { dateStyle: "medium" });
  return days.format(new Date(time));
}

/**
 * A name cut into a beginning, which may be shortened, and an end, which stays.
 *
 * Image names differ at their end, so that is what must stay readable in a narrow tile.
 */
export function splitForEllipsis(name: string, end = 10): [string, string] {
  const characters = Array.from(name);
  if (characters.length <= end + 2) return [name, ""];
  return [characters.slice(0, -end).join(""), characters.slice(-end).join("")];
}

/** A message of the server as a sentence; it gives them without capital letter and full stop. */
export function sentence(text: string): string {
  const trimmed = text.trim();
  return capitalized(/[.!?:]$/.test(trimmed) ? trimmed : `${trimmed}.`);
}

export function capitalized(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** "1.2 MB/s" for bytes per second. */
export function formatSpeed(bytesPerSecond: number): string {
  return `${formatBytes(Math.round(bytesPerSecond))}/s`;
}

/** A duration, rounded to what one would say: "40 s", "3 min", "2 h 5 min". */
export function formatDuration(seconds: number): string {
  if (seconds < 60) return `${Math.max(1, Math.round(seconds))} s`;
  const minutes = Math.round(seconds / 60);
  if (minutes < 60) return `${minutes} min`;
  const rest = minutes % 60;
  return rest === 0 ? `${Math.floor(minutes / 60)} h` : `${Math.floor(minutes / 60)} h ${rest} min`;
}

export function formatBytes(bytes: number): string {
  if (bytes < 1e3) return `${bytes} B`;
  if (bytes < 1e6) return `${(bytes / 1e3).toFixed(0)} kB`;
  if (bytes < 1e9) return `${(bytes / 1e6).toFixed(1)} MB`;
  return `${(bytes / 1e9).toFixed(1)} GB`;
}
