interface UrlFieldProps {
  label: string;
  value: string;
  onChange: (text: string) => void;
}

/** The address of a page elsewhere: http or https alone. */
export function UrlField({ label, value, onChange }: UrlFieldProps) {
  return (
    <label className="field">
      <span className="field__label">{label}</span>
      <input
        className="input"
        type="url"
        maxLength={500}
        pattern="https?://.*"
        placeholder="https://"
        value={value}
        onChange={(event) => onChange(event.target.value)}
      />
    </label>
  );
}
