import { useEffect, useRef } from "react";
import type { Submission } from "../../api/board_types";
import { Button, IconButton } from "../../design/button";
import { Keys } from "../../design/kbd";
import { Popover } from "../../design/popover";
import { Segmented } from "../../design/segmented";
import { useComparableSubmissions } from "../use_comparable_submissions";
import type { Difference, Side } from "./difference";
import { submissionName } from "./submission_name";

interface CompareSectionProps {
  a: Submission;
  b: Submission | null;
  other: number | null;
  side: Side;
  sideBySide: boolean;
  differences: boolean;
  difference: Difference | null;
  onCompare: (other: number | null) => void;
  onSide: (side: Side) => void;
  onSideBySide: () => void;
  onDifferences: () => void;
}

/** A second submission on the same image. */
export function CompareSection(props: CompareSectionProps) {
  const { a, b, other, onCompare } = props;
  return (
    <section className="panel-section" aria-label="Compare">
      <div className="panel-heading">
        <h2>Compare</h2>
        <span className="panel-heading__end">
          <Popover label={other === null ? "Compare with…" : "Another…"} small align="end">
            {(close) => (
              <Choices
                a={a}
                other={other}
                onChoose={(id) => {
                  onCompare(id);
                  close();
                }}
              />
            )}
          </Popover>
          {other === null ? null : (
            <IconButton
              small
              icon="cross"
              label="Stop comparing"
              side="end"
              onClick={() => onCompare(null)}
            />
          )}
        </span>
      </div>
      {b === null ? null : <Comparison {...props} b={b} />}
    </section>
  );
}

interface ChoicesProps {
  a: Submission;
  other: number | null;
  onChoose: (id: number) => void;
}

function Choices({ a, other, onChoose }: ChoicesProps) {
  const { pending, submissions } = useComparableSubmissions(a);
  const list = useRef<HTMLUListElement>(null);
  const count = submissions.length;
  // biome-ignore lint/correctness/useExhaustiveDependencies: a longer list may reach below what the panel shows
  useEffect(() => {
    list.current?.scrollIntoView({ block: "nearest" });
  }, [count, pending]);
  if (pending) return <p className="muted compare-none">Loading the submissions</p>;
  if (count === 0) return <p className="muted compare-none">No other scored submission.</p>;
  return (
    <ul className="compare-choices" ref={list}>
      {submissions.map(({ id, method, label }) => (
        <li key={id}>
          <button
            type="button"
            className="menu-item"
            aria-current={id === other}
            onClick={() => onChoose(id)}
          >
            {label ? `${method} ${label}` : `${method}, submission ${id}`}
          </button>
        </li>
      ))}
    </ul>
  );
}

function Comparison(props: CompareSectionProps & { b: Submission }) {
  const { a, b, side, sideBySide, differences, difference, onSide, onSideBySide, onDifferences } = props;
  return (
    <>
      <dl className="compare-names">
        <div>
          <dt>A</dt>
          <dd>{submissionName(a)}</dd>
        </div>
        <div>
          <dt>B</dt>
          <dd>{submissionName(b)}</dd>
        </div>
      </dl>
      <div className="compare-buttons">
        <Segmented
          label="Submission that is looked at"
          name="side"
          value={side}
          choices={[
            { value: "a", label: "A" },
            { value: "b", label: "B" },
          ]}
          onChange={onSide}
        />
        <Keys keys={["B"]} />
        <Button small aria-pressed={sideBySide} aria-keyshortcuts="S" onClick={onSideBySide}>
          Side by side <Keys keys={["S"]} />
        </Button>
      </div>
      {difference === null ? null : <DifferenceTable difference={difference} />}
      <label className="checkbox">
        <input type="checkbox" checked={differences} onChange={onDifferences} />
        Highlight the differences <Keys keys={["D"]} />
      </label>
    </>
  );
}

function DifferenceTable({ difference }: { difference: Difference }) {
  const { found, alarms } = difference;
  return (
    <table className="metric-table">
      <thead>
        <tr>
          <th scope="col">
            <span className="visually-hidden">Difference</span>
          </th>
          <th scope="col">only A</th>
          <th scope="col">only B</th>
        </tr>
      </thead>
      <tbody>
        <tr title="Labels that one submission found and the other one missed">
          <th scope="row">Found</th>
          <td className="numeric">{found.a.size}</td>
          <td className="numeric">{found.b.size}</td>
        </tr>
        <tr title="False positives of one submission where the other one has none">
          <th scope="row">False positives</th>
          <td className="numeric">{alarms.a.size}</td>
          <td className="numeric">{alarms.b.size}</td>
        </tr>
      </tbody>
    </table>
  );
}
