import { useQuery } from "@tanstack/react-query";
import { useId } from "react";
import { peopleQuery } from "../../api/team_endpoints";
import type { Verdict } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Popover } from "../../design/popover";
import { type ImageView, VERDICTS } from "./image_view";
import "./more_filters.css";

const VERDICT_WORDS: Readonly<Record<Verdict, string>> = {
  keep: "Something kept",
  reject: "Something rejected",
  ambiguous: "Something ambiguous",
  undecided: "Something undecided",
};
/** Stands for images that are nobody's task, whose name is empty. */
const NOBODY = "\u0000nobody";
const ANY = "\u0000any";

interface MoreFiltersProps {
  slug: string;
  view: ImageView;
  onChange: (changes: Partial<ImageView>) => void;
}

/** Filters by people, verdicts and scores, which one needs less often. */
export function MoreFilters({ slug, view, onChange }: MoreFiltersProps) {
  const { assignee, person, verdict, min_score, max_score } = view;
  const set = [assignee, person, verdict, min_score, max_score].filter((value) => value !== null).length;
  return (
    <Popover icon="filter" label={set > 0 ? `More filters (${set})` : "More filters"} align="start">
      {() => <Fields slug={slug} view={view} onChange={onChange} />}
    </Popover>
  );
}

function Fields({ slug, view, onChange }: MoreFiltersProps) {
  const { label: annotates } = useRights();
  const people = useQuery({ ...peopleQuery(slug), enabled: annotates }).data ?? [];
  const names = people.map(({ person }) => person);
  return (
    <div className="more-filters">
      <Field label="Verdicts">
        {(id) => (
          <select
            id={id}
            className="input"
            value={view.verdict ?? ANY}
            onChange={({ target }) =>
              onChange({ verdict: target.value === ANY ? null : (target.value as Verdict) })
            }
          >
            <option value={ANY}>Any</option>
            {VERDICTS.map((verdict) => (
              <option key={verdict} value={verdict}>
                {VERDICT_WORDS[verdict]}
              </option>
            ))}
          </select>
        )}
      </Field>
      <Field label="Task of">
        {(id) => (
          <select
            id={id}
            className="input"
            value={view.assignee === null ? ANY : view.assignee === "" ? NOBODY : view.assignee}
            onChange={({ target: { value } }) =>
              onChange({ assignee: value === ANY ? null : value === NOBODY ? "" : value })
            }
          >
            <option value={ANY}>Anybody</option>
            <option value={NOBODY}>Nobody in particular</option>
            {withCurrent(names, view.assignee).map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        )}
      </Field>
      <Field label="Decided on by">
        {(id) => (
          <select
            id={id}
            className="input"
            value={view.person ?? ANY}
            onChange={({ target: { value } }) => onChange({ person: value === ANY ? null : value })}
          >
            <option value={ANY}>Anybody</option>
            {withCurrent(names, view.person).map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        )}
      </Field>
      <Field label="A candidate's score from">
        {(id) => (
          <span className="more-filters__range">
            <Score
              id={id}
              label="Least score"
              value={view.min_score}
              onChange={(min_score) => onChange({ min_score })}
            />
            to
            <Score
              label="Greatest score"
              value={view.max_score}
              onChange={(max_score) => onChange({ max_score })}
            />
          </span>
        )}
      </Field>
    </div>
  );
}

function Field({ label, children }: { label: string; children: (id: string) => React.ReactNode }) {
  const id = useId();
  return (
    <div className="field">
      <label className="field__label" htmlFor={id}>
        {label}
      </label>
      {children(id)}
    </div>
  );
}

interface ScoreProps {
  id?: string;
  label: string;
  value: number | null;
  onChange: (value: number | null) => void;
}

function Score({ id, label, value, onChange }: ScoreProps) {
  return (
    <input
      id={id}
      className="input"
      type="number"
      aria-label={label}
      min={0}
      max={1}
      step={0.05}
      value={value ?? ""}
      placeholder="any"
      onChange={({ target }) => {
        const score = target.valueAsNumber;
        onChange(score >= 0 && score <= 1 ? score : null);
      }}
    />
  );
}

/** A name from a shared link is offered too, although nothing is known of it here. */
function withCurrent(names: readonly string[], current: string | null): string[] {
  return current && !names.includes(current) ? [...names, current] : [...names];
}
