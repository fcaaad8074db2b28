import { type RefObject, useEffect, useRef } from "react";
import { Link } from "react-router";
import type { Difference } from "../../api/team_endpoints";
import { Button, IconButton } from "../../design/button";
import { Ellipsis } from "../../design/ellipsis";
import { formatCount } from "../../design/format";
import { Icon, type IconName } from "../../design/icons";
import { Keys } from "../../design/kbd";
import type { DifferencesActions } from "./differences_commands";
import { type Judged, keyOf, openCount } from "./differences_state";
import type { Differences } from "./use_differences";

const NAMES: Readonly<Record<Judged, string>> = { keep: "Keep", reject: "Reject", ambiguous: "Ambiguous" };
const ICONS: Readonly<Record<Judged, IconName>> = { keep: "check", reject: "cross", ambiguous: "question" };
const CAPS: Readonly<Record<Judged, string>> = { keep: "K", reject: "X", ambiguous: "A" };

interface DifferencesPanelProps {
  slug: string;
  differences: Differences;
  current: Difference;
  actions: DifferencesActions;
  panelRef: RefObject<HTMLElement | null>;
}

/** Who said what, the decision, and the list of all differences. */
export function DifferencesPanel({ slug, differences, current, actions, panelRef }: DifferencesPanelProps) {
  const { state } = differences;
  const left = openCount(state);
  const total = state.differences.length;
  return (
    <aside
      className="image-panel"
      aria-label="Differences"
      ref={panelRef}
      tabIndex={-1}
      id="differences-panel"
    >
      <div className="image-panel__scroll">
        <section className="panel-section" aria-label="Progress">
          <p className="panel-progress">
            <strong className="numeric">{formatCount(total - left)}</strong>{" "}
            <span className="muted numeric">of {formatCount(total)} decided</span>
          </p>
          <progress className="differences__progress" value={total - left} max={total} />
        </section>
        <section className="panel-section" aria-label="This difference">
          <div className="panel-heading">
            <h2>Difference</h2>
            <Link
              className="panel-heading__end"
              to={`/datasets/${slug}/images/${current.image_id}?segment=${current.segment_id}`}
            >
              Open in the image
            </Link>
          </div>
          <dl className="differences__said" id="difference-said" aria-live="polite">
            <Said name="First" person={current.first.person} verdict={current.first.verdict} />
            <Said name="Second" person={current.second.person} verdict={current.second.verdict} />
            {current.adjudicated === null ? null : (
              <Said
                name="Decided"
                person={current.adjudicated.person}
                verdict={current.adjudicated.verdict}
              />
            )}
          </dl>
          <div className="differences__buttons">
            {(["keep", "reject", "ambiguous"] as const).map((verdict) => (
              <Button
                key={verdict}
                icon={ICONS[verdict]}
                aria-pressed={current.adjudicated?.verdict === verdict}
                aria-keyshortcuts={CAPS[verdict]}
                onClick={() => actions.judge(verdict)}
              >
                {NAMES[verdict]} <Keys keys={[CAPS[verdict]]} />
              </Button>
            ))}
          </div>
        </section>
        <List differences={differences} />
      </div>
      <footer className="image-panel__footer">
        <IconButton
          icon="undo"
          label="Take the latest one back"
          keys={["Z"]}
          side="up"
          tone="default"
          onClick={actions.undo}
        />
        <Button className="image-panel__wide" onClick={() => actions.step(1)}>
          Next difference <Keys keys={["Tab"]} />
        </Button>
      </footer>
    </aside>
  );
}

function Said({ name, person, verdict }: { name: string; person: string | null; verdict: Judged }) {
  return (
    <div>
      <dt className="muted">{name}</dt>
      <dd>
        <span className={`differences__verdict differences__verdict--${verdict}`}>
          <Icon name={ICONS[verdict]} size={14} /> {NAMES[verdict]}
        </span>
        <Ellipsis text={person ?? "nobody's name"} />
      </dd>
    </div>
  );
}

function List({ differences }: { differences: Differences }) {
  const { state, choose } = differences;
  const active = useRef<HTMLButtonElement>(null);
  // biome-ignore lint/correctness/useExhaustiveDependencies: another current one has to be in view
  useEffect(() => active.current?.scrollIntoView({ block: "nearest" }), [state.current]);
  return (
    <section className="panel-section" aria-label="All differences">
      <ol className="differences__list">
        {state.differences.map((difference, index) => {
          const newImage = state.differences[index - 1]?.image_id !== difference.image_id;
          return (
            <li key={keyOf(difference)}>
              {newImage ? (
                <h3 className="differences__image">
                  <Ellipsis text={difference.image} />
                </h3>
              ) : null}
              <button
                ref={index === state.current ? active : null}
                type="button"
                className="differences__entry"
                aria-current={index === state.current}
                onClick={() => choose(index)}
              >
                <span className="numeric">{Math.round(difference.length)} px</span>
                <span>
                  {NAMES[difference.first.verdict]} / {NAMES[difference.second.verdict]}
                </span>
                {difference.adjudicated === null ? (
                  <span className="muted">open</span>
                ) : (
                  <Icon name={ICONS[difference.adjudicated.verdict]} size={14} />
                )}
              </button>
            </li>
          );
        })}
      </ol>
    </section>
  );
}
