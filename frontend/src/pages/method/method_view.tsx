import { useState } from "react";
import { Link, useNavigate } from "react-router";
import type { Method } from "../../api/board_types";
import { VersionsChart } from "../../charts/versions_chart";
import { Badge } from "../../design/badge";
import { Button } from "../../design/button";
import { formatQuantity } from "../../design/format";
import { Icon, type IconName } from "../../design/icons";
import { Popover } from "../../design/popover";
import { EmptyState } from "../../design/states";
import { KindBadge } from "../split_badges";
import { SubmissionTable } from "../submission_table";
import { MethodForm } from "./method_form";
import { useMethodActions } from "./use_method_actions";
import { bySplit, versionPoints } from "./versions";

export function MethodView({ method }: { method: Method }) {
  const [editing, setEditing] = useState(false);
  const { reveal } = useMethodActions(method);
  const groups = bySplit(method.submissions);
  return (
    <div className="board-page">
      {editing ? (
        <MethodForm method={method} close={() => setEditing(false)} />
      ) : (
        <header className="board-page__header">
          <div className="board-page__title">
            <h1>{method.name}</h1>
            <p className="board-page__facts muted numeric">
              <KindBadge kind={method.kind} />
              {method.anonymous ? <Badge icon="eyeOff">Anonymous</Badge> : null}
              <span>{byWhom(method)}</span>
              <span>{formatQuantity(method.submissions.length, "submission")}</span>
              <OutLink href={method.code_url} icon="code" text="Code" />
              <OutLink href={method.paper_url} icon="paper" text="Paper" />
            </p>
            {method.description ? <p className="method-description">{method.description}</p> : null}
          </div>
          {method.mine ? (
            <div className="board-page__actions">
              {method.anonymous ? (
                <Popover label="Reveal my name" icon="eye">
                  {() => (
                    <div className="method-reveal">
                      <p>Your name then stands on every board beside this method, for good.</p>
                      <Button tone="primary" onClick={reveal}>
                        Reveal it
                      </Button>
                    </div>
                  )}
                </Popover>
              ) : null}
              <Button icon="pencil" onClick={() => setEditing(true)}>
                Edit
              </Button>
            </div>
          ) : null}
        </header>
      )}
      {groups.length === 0 ? (
        <EmptyState icon="podium" title="Nothing submitted yet" />
      ) : (
        groups.map(({ split, submissions }) => (
          <VersionsOnSplit key={split.slug} split={split} submissions={submissions} />
        ))
      )}
    </div>
  );
}

function VersionsOnSplit({ split, submissions }: ReturnType<typeof bySplit>[number]) {
  const navigate = useNavigate();
  const points = versionPoints(submissions);
  return (
    <section className="section card" aria-label={`On ${split.name}`}>
      <header className="section__header">
        <h2>
          <Link to={`/splits/${split.slug}`}>{split.name}</Link>
        </h2>
        {points.length > 1 ? <span className="muted">F1 over time, with its interval</span> : null}
      </header>
      {points.length > 1 ? (
        <VersionsChart points={points} onOpen={(id) => navigate(`/submissions/${id}`)} />
      ) : null}
      <SubmissionTable submissions={submissions} />
    </section>
  );
}

function byWhom({ person, anonymous, mine, kind }: Method): string {
  if (kind !== "method") return "put there by this server";
  if (anonymous && mine) return "yours; your name isn't shown to others";
  return person ?? "anonymous";
}

function OutLink({ href, icon, text }: { href: string | null; icon: IconName; text: string }) {
  if (href === null || !/^https?:\/\//i.test(href)) return null;
  return (
    <a href={href} target="_blank" rel="noopener noreferrer" className="method-link">
      <Icon name={icon} /> {text}
    </a>
  );
}
