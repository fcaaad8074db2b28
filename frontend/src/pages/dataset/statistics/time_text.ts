/** Times of decisions as people say them. */

/** "0.8 s", "12 s", "2 min". */
export function timeText(milliseconds: number | null): string {
  if (milliseconds === null) return "–";
  const seconds = milliseconds / 1000;
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 90) return `${Math.round(seconds)} s`;
  return `${Math.round(seconds / 60)} min`;
}

/** The names of a histogram's bars, from the lower ends of their times: "0.5 to 0.7 s", the last "30 s and more". */
export function binNames(edges: readonly number[]): { label: string; name: string }[] {
  return edges.map((low, index) => {
    const high = edges[index + 1];
    return {
      label: edgeText(low),
      name: high === undefined ? `${edgeText(low)} and more` : `${edgeText(low)} to ${edgeText(high)}`,
    };
  });
}

/** An edge is a round number: it is told whole, "0.25 s". */
function edgeText(milliseconds: number): string {
  return milliseconds < 60_000 ? `${milliseconds / 1000} s` : `${milliseconds / 60_000} min`;
}

/** Days in a row, those on which nothing happened too, so that a pause is seen as one. */
export function everyDay<T extends { day: string }>(days: readonly T[], empty: (day: string) => T): T[] {
  const first = days[0];
  const last = days.at(-1);
  if (first === undefined || last === undefined) return [];
  const known = new Map(days.map((entry) => [entry.day, entry]));
  const all: T[] = [];
  for (let time = Date.parse(first.day); time <= Date.parse(last.day); time += 86_400_000) {
    const day = new Date(time).toISOString().slice(0, 10);
    all.push(known.get(day) ?? empty(day));
  }
  return all;
}
