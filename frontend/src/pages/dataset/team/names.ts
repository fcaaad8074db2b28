/** The names in a list that a person typed: "Mara, Jon" or one in each line; each once, in order. */
export function namesOf(text: string): string[] {
  const names = text
    .split(/[,;\n]/)
    .map((name) => name.trim().replace(/\s+/g, " "))
    .filter((name) => name !== "");
  return [...new Set(names)];
}
