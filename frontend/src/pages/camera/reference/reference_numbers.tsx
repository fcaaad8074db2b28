import { readReference } from "./reference_text";

/** Focal lengths, principal point and coefficients of a reference. */
export function ReferenceNumbers({ reference }: { reference: Readonly<Record<string, unknown>> }) {
  return (
    <dl className="reference__numbers numeric">
      {readReference(reference).map(([name, value]) => (
        <div key={name}>
          <dt>{name}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
