const SENTENCES: Readonly<Record<string, string>> = {
  unauthenticated: "The provider has not signed you in, or its answer came too late. Try once more.",
  "not-invited": "Nobody here knows you yet. Ask for an invitation, and sign in by its link.",
  forbidden: "Your account is disabled. Whoever runs this server can open it again.",
  "not-found": "The invitation is not good any more. Ask for a new one.",
  conflict: "Another account is in the way. Sign out first, or ask for an invitation with another name.",
  unavailable: "The provider can't be reached. Try again in a moment.",
  "too-many": "Too many tries. Wait a little, then try again.",
};

/** What to say of a way through a provider that led nowhere; only sentences of our own, whatever the address says. */
export function providerProblem(code: string | null): string | null {
  if (code === null) return null;
  return SENTENCES[code] ?? "Signing in with the provider didn't work. Try once more.";
}
