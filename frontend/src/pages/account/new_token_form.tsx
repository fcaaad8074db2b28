import { useState } from "react";
import type { Role } from "../../api/board_types";
import { Button } from "../../design/button";
import { FormProblem } from "../../design/form_problem";
import { RoleOptions } from "../../design/role_options";
import { useSentForm } from "../../design/use_sent_form";

const LIFETIMES: readonly { days: number | null; label: string }[] = [
  { days: 30, label: "30 days" },
  { days: 365, label: "a year" },
  { days: null, label: "until revoked" },
];

interface NewTokenFormProps {
  /** One's own role, beyond which no token may do anything. */
  most: Role;
  make: (label: string, role: Role, days: number | null) => Promise<void>;
}

export function NewTokenForm({ most, make }: NewTokenFormProps) {
  const [label, setLabel] = useState("");
  const [role, setRole] = useState<Role>(most === "reader" ? "reader" : "submitter");
  const [lifetime, setLifetime] = useState(0);
  const { onSubmit, busy, problem } = useSentForm(() =>
    make(label.trim(), role, LIFETIMES[lifetime]?.days ?? null),
  );
  return (
    <form className="account-page__row" onSubmit={onSubmit}>
      <label className="field">
        <span className="field__label">Label</span>
        <input
          className="input"
          placeholder="Laptop"
          maxLength={200}
          value={label}
          onChange={(event) => setLabel(event.target.value)}
        />
      </label>
      <label className="field">
        <span className="field__label">Role</span>
        <select className="input" value={role} onChange={(event) => setRole(event.target.value as Role)}>
          <RoleOptions most={most} />
        </select>
      </label>
      <label className="field">
        <span className="field__label">Good for</span>
        <select
          className="input"
          value={lifetime}
          onChange={(event) => setLifetime(Number(event.target.value))}
        >
          {LIFETIMES.map((each, index) => (
            <option key={each.label} value={index}>
              {each.label}
            </option>
          ))}
        </select>
      </label>
      <Button type="submit" icon="plus" busy={busy} disabled={label.trim() === ""}>
        Make a token
      </Button>
      <FormProblem text={problem} />
    </form>
  );
}
