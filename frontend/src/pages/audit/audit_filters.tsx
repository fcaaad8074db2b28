import { useEffect, useState } from "react";
import type { AuditFilter } from "../../api/account_types";
import { Button } from "../../design/button";
import { useSettled } from "../../design/use_settled";

const FIELDS: readonly { field: keyof AuditFilter; label: string; placeholder: string }[] = [
  { field: "person", label: "Person", placeholder: "Name" },
  { field: "kind", label: "What", placeholder: "dataset, user.role…" },
  { field: "dataset", label: "Dataset", placeholder: "Its address, vienna-downtown" },
];

const PAUSE_MS = 300;

interface AuditFiltersProps {
  filter: AuditFilter;
  change: (field: keyof AuditFilter, value: string) => void;
  /** Absent where nothing is filtered. */
  clear: (() => void) | null;
}

export function AuditFilters({ filter, change, clear }: AuditFiltersProps) {
  return (
    <search className="audit__filters">
      {FIELDS.map(({ field, label, placeholder }) => (
        <FilterField
          key={field}
          label={label}
          placeholder={placeholder}
          value={filter[field] ?? ""}
          change={(value) => change(field, value)}
        />
      ))}
      {clear ? (
        <Button tone="quiet" icon="cross" onClick={clear}>
          Show all
        </Button>
      ) : null}
    </search>
  );
}

interface FilterFieldProps {
  label: string;
  placeholder: string;
  value: string;
  change: (value: string) => void;
}

function FilterField({ label, placeholder, value, change }: FilterFieldProps) {
  const [text, setText] = useState(value);
  const settled = useSettled(text, value, PAUSE_MS);
  useEffect(() => setText(value), [value]);
  // biome-ignore lint/correctness/useExhaustiveDependencies: only what was typed is sent, not what came from the address
  useEffect(() => {
    if (settled.trim() !== value) change(settled.trim());
  }, [settled]);
  return (
    <label className="field">
      <span className="field__label">{label}</span>
      <input
        className="input"
        type="search"
        placeholder={placeholder}
        value={text}
        onChange={(event) => setText(event.target.value)}
      />
    </label>
  );
}
