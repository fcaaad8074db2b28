const KEY = "clearlines-page";
let kept: string | null = null;

/** What tells this page from every other; it survives a reload, so that a page doesn't wait for its own lease. */
export function pageId(): string {
  kept ??= remembered() ?? crypto.randomUUID();
  try {
    sessionStorage.setItem(KEY, kept);
  } catch {
    // Without storage a reload is another page of the same person.
  }
  return kept;
}

function remembered(): string | null {
  try {
    return sessionStorage.getItem(KEY);
  } catch {
    return null;
  }
}
