/** Where to go after signing in: a page of this site, else the first one. Other sites' addresses are no path of ours. */
export function ownPath(next: string | null): string {
  if (next === null || !next.startsWith("/")) return "/";
  // "//elsewhere.org" and "/\elsewhere.org" name another host, and browsers drop tabs and line ends from addresses.
  const address = parsed(next);
  if (address?.origin !== "https://here.invalid") return "/";
  const path = `${address.pathname}${address.search}${address.hash}`;
  return path.startsWith("//") || path.startsWith("/sign-in") ? "/" : path;
}

function parsed(path: string): URL | null {
  try {
    return new URL(path, "https://here.invalid");
  } catch {
    return null;
  }
}
