/** The two parameters that are told apart worst; null where there aren't two. */
export function strongest(
  names: readonly string[],
  correlation: readonly (readonly number[])[],
): { first: string; second: string; value: number } | null {
  const pairs = names.flatMap((first, row) =>
    names
      .slice(row + 1)
      .map((second, offset) => ({ first, second, value: correlation[row]?.[row + 1 + offset] ?? 0 })),
  );
  return pairs.sort((a, b) => Math.abs(b.value) - Math.abs(a.value))[0] ?? null;
}
