import type { ReactNode } from "react";

interface SegmentedProps<T extends string> {
  /** Accessible name of the choice. */
  label: string;
  name: string;
  value: T;
  choices: readonly { value: T; label: ReactNode; title?: string }[];
  onChange: (value: T) => void;
}

/** A choice of one out of a few, all in view. */
export function Segmented<T extends string>({ label, name, value, choices, onChange }: SegmentedProps<T>) {
  return (
    <fieldset className="segmented" style={{ margin: 0 }}>
      <legend className="visually-hidden">{label}</legend>
      {choices.map((choice) => (
        <label key={choice.value} className="segmented__choice" title={choice.title}>
          <input
            type="radio"
            name={name}
            value={choice.value}
            checked={choice.value === value}
            onChange={() => onChange(choice.value)}
          />
          {choice.label}
        </label>
      ))}
    </fieldset>
  );
}
