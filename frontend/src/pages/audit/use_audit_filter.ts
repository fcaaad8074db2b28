import { useCallback, useMemo } from "react";
import { useSearchParams } from "react-router";
import type { AuditFilter } from "../../api/account_types";

const FIELDS = ["person", "kind", "dataset"] as const;

/** What of the audit is shown, kept in the address; changing it doesn't fill the history. */
export function useAuditFilter() {
  const [parameters, setParameters] = useSearchParams();
  const filter = useMemo<AuditFilter>(
    () => Object.fromEntries(FIELDS.flatMap((field) => entryOf(field, parameters.get(field)))),
    [parameters],
  );
  const change = useCallback(
    (field: keyof AuditFilter, value: string) => {
      setParameters(
        (before) => {
          const after = new URLSearchParams(before);
          if (value === "") after.delete(field);
          else after.set(field, value);
          return after;
        },
        { replace: true },
      );
    },
    [setParameters],
  );
  const clear = useCallback(() => setParameters({}, { replace: true }), [setParameters]);
  return { filter, change, clear, any: Object.keys(filter).length > 0 };
}

function entryOf(field: string, value: string | null): [string, string][] {
  return value === null || value.trim() === "" ? [] : [[field, value.trim()]];
}
