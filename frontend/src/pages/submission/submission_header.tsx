import { useState } from "react";
import { Link } from "react-router";
import type { Submission } from "../../api/board_types";
import { Badge } from "../../design/badge";
import { Button, IconButton } from "../../design/button";
import { formatDate } from "../../design/format";
import { Icon } from "../../design/icons";
import { InlineEdit } from "../../design/inline_edit";
import { Popover } from "../../design/popover";
import { KindBadge, SubmissionBadge } from "../split_badges";
import { Downloads, sizeText } from "../submission_table";
import { useSubmissionActions } from "../use_submission_actions";
import { useWorstImage } from "./use_worst_image";

export function SubmissionHeader({ submission }: { submission: Submission }) {
  const { method, split, split_version, person, status, visibility, created_at } = submission;
  return (
    <header className="board-page__header">
      <div className="board-page__title">
        <h1>
          <Link to={`/methods/${method.slug}`} className="submission-method">
            {method.name}
          </Link>
        </h1>
        <Label submission={submission} />
        <p className="board-page__facts muted numeric">
          <SubmissionBadge status={status} />
          <KindBadge kind={method.kind} />
          {visibility === "private" ? <Badge icon="lock">Private</Badge> : null}
          <Link to={`/splits/${split.slug}`}>
            {split.name}, version {split_version}
          </Link>
          <span>{person ?? (method.kind === "method" ? "anonymous" : "this server")}</span>
          <time dateTime={created_at}>{formatDate(created_at)}</time>
          <span>{sizeText(submission)}</span>
        </p>
      </div>
      <Actions submission={submission} />
    </header>
  );
}

function Label({ submission }: { submission: Submission }) {
  const { relabel } = useSubmissionActions();
  const [editing, setEditing] = useState(false);
  const { id, label, mine } = submission;
  if (editing) {
    return (
      <InlineEdit
        label="Version, in your words"
        value={label ?? ""}
        placeholder="v2, threshold 0.4"
        maxLength={100}
        close={() => setEditing(false)}
        save={(text) => relabel(id, text)}
      />
    );
  }
  if (!mine && !label) return null;
  return (
    <p className="submission-label">
      {label ?? <span className="muted">No version given</span>}
      {mine ? (
        <IconButton small icon="pencil" label="Change the version's name" onClick={() => setEditing(true)} />
      ) : null}
    </p>
  );
}

function Actions({ submission }: { submission: Submission }) {
  const { withdraw, restore, setVisibility, rescore } = useSubmissionActions();
  const worst = useWorstImage(submission);
  const { id, can, mine, status, visibility } = submission;
  return (
    <div className="board-page__actions">
      {worst ? (
        <Button tone="primary" icon="eye" onClick={worst.open} busy={worst.busy}>
          Open the worst image
        </Button>
      ) : null}
      {can.download ? (
        <Popover label="Download" icon="download">
          {() => <Downloads submission={submission} />}
        </Popover>
      ) : null}
      {status === "withdrawn" && mine ? (
        <Button icon="undo" onClick={() => restore(id)}>
          Put back
        </Button>
      ) : null}
      {can.withdraw || can.rescore ? (
        <Popover label="More" icon="more" iconOnly tone="quiet">
          {(close) => {
            const act = (run: () => void) => () => {
              close();
              run();
            };
            return (
              <>
                {can.withdraw ? (
                  <button
                    type="button"
                    className="menu-item"
                    onClick={act(
                      () => void setVisibility(id, visibility === "public" ? "private" : "public"),
                    )}
                  >
                    <Icon name={visibility === "public" ? "lock" : "eye"} />
                    {visibility === "public" ? "Make private" : "Make public"}
                  </button>
                ) : null}
                {can.rescore ? (
                  <button type="button" className="menu-item" onClick={act(() => void rescore(id))}>
                    <Icon name="retry" /> Score again
                  </button>
                ) : null}
                {can.withdraw ? (
                  <button
                    type="button"
                    className="menu-item menu-item--danger"
                    onClick={act(() => void withdraw(submission))}
                  >
                    <Icon name="trash" /> Withdraw
                  </button>
                ) : null}
              </>
            );
          }}
        </Popover>
      ) : null}
    </div>
  );
}
