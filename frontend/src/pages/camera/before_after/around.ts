/** The places `[first, end)` of so many at most around one of them, moved inwards at the ends. */
export function around(current: number, most: number, count: number): readonly [number, number] {
  const first = Math.max(0, Math.min(current - Math.floor(most / 2), count - most));
  return [first, Math.min(count, first + most)];
}
