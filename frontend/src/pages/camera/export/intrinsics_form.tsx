import { type FormEvent, useState } from "react";
import type { GivenIntrinsics } from "../../../api/camera_endpoints";
import { Button } from "../../../design/button";
import { NOTHING_GIVEN, readGiven } from "./export_text";

const FIELDS = [
  { name: "focal", label: "Focal length, px" },
  { name: "cx", label: "Principal point x" },
  { name: "cy", label: "y" },
] as const;
const EMPTY = { focal: "", cx: "", cy: "" };

/** A focal length that is known from elsewhere, in place of the one found. */
export function IntrinsicsForm({ onGiven }: { onGiven: (given: GivenIntrinsics) => void }) {
  const [typed, setTyped] = useState(EMPTY);
  const [refused, setRefused] = useState(false);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    const given = readGiven(typed);
    setRefused(given === null);
    if (given !== null) onGiven(given);
  };
  const clear = () => {
    setTyped(EMPTY);
    setRefused(false);
    onGiven(NOTHING_GIVEN);
  };
  return (
    <form className="intrinsics-form" onSubmit={submit}>
      {FIELDS.map(({ name, label }) => (
        <label key={name} className="field">
          <span className="field__label">{label}</span>
          <input
            className="input numeric"
            inputMode="decimal"
            autoComplete="off"
            value={typed[name]}
            aria-invalid={refused}
            onChange={(event) => setTyped({ ...typed, [name]: event.target.value })}
          />
        </label>
      ))}
      <Button type="submit" disabled={typed.focal.trim() === ""}>
        Use it
      </Button>
      <Button tone="quiet" onClick={clear}>
        Use what was found
      </Button>
      {refused ? (
        <p className="field__error" role="alert">
          A focal length above 0, and both numbers of a principal point or neither.
        </p>
      ) : null}
    </form>
  );
}
