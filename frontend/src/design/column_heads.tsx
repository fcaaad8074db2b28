interface Column {
  name: string;
  /** Its values are numbers, set against their right edge. */
  numeric?: boolean;
}

/** The head of a table: a name alone, or one over numbers. */
export function ColumnHeads({ columns }: { columns: readonly (string | Column)[] }) {
  return (
    <thead>
      <tr>
        {columns
          .map((column) => (typeof column === "string" ? { name: column } : column))
          .map(({ name, numeric = false }) => (
            <th key={name} scope="col" className={numeric ? "table__number" : undefined}>
              {name}
            </th>
          ))}
      </tr>
    </thead>
  );
}

/** A column of numbers. */
export function numbers(name: string): Column {
  return { name, numeric: true };
}
