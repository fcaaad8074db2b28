import { useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { Link } from "react-router";
import { asProblem } from "../../../api/problem";
import { keys } from "../../../api/queries";
import { assignImages, type Person, teamKeys } from "../../../api/team_endpoints";
import type { Dataset } from "../../../api/types";
import { Button } from "../../../design/button";
import { ColumnHeads, numbers } from "../../../design/column_heads";
import { formatCount, formatQuantity } from "../../../design/format";
import { TableScroll } from "../../../design/table_scroll";
import { toast } from "../../../design/toast";
import { namesOf } from "./names";

interface TasksSectionProps {
  dataset: Dataset;
  people: readonly Person[];
  editable: boolean;
}

/** Whose task which images are. */
export function TasksSection({ dataset, people, editable }: TasksSectionProps) {
  const assigned = people.reduce((sum, person) => sum + person.assigned, 0);
  return (
    <section className="section card" aria-labelledby="tasks-title">
      <header className="section__header">
        <h2 id="tasks-title">Tasks</h2>
        <span className="muted numeric">
          {formatCount(assigned)} of {formatQuantity(dataset.images, "image")} assigned
        </span>
      </header>
      {people.length === 0 ? (
        <p className="muted">
          Nobody has decided on anything yet, and no image is anybody's task: all are everybody's.
        </p>
      ) : (
        <TableScroll label="Tasks by person">
          <table className="table">
            <ColumnHeads columns={["Person", numbers("Images"), numbers("Done"), numbers("Decisions")]} />
            <tbody>
              {people.map(({ person, assigned, done, decisions }) => (
                <tr key={person}>
                  <th scope="row" className="team__name" title={person}>
                    {assigned > 0 ? (
                      <Link to={`?assignee=${encodeURIComponent(person)}`}>{person}</Link>
                    ) : (
                      person
                    )}
                  </th>
                  <td className="table__number">{formatCount(assigned)}</td>
                  <td className="table__number">{formatCount(done)}</td>
                  <td className="table__number">{formatCount(decisions)}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </TableScroll>
      )}
      {editable ? <ShareForm slug={dataset.slug} /> : null}
    </section>
  );
}

/** Gives the open images that are nobody's task to several people in equal shares. */
function ShareForm({ slug }: { slug: string }) {
  const client = useQueryClient();
  const [text, setText] = useState("");
  const [busy, setBusy] = useState(false);
  const names = namesOf(text);

  async function submit(event: FormEvent): Promise<void> {
    event.preventDefault();
    if (names.length === 0) return;
    setBusy(true);
    try {
      const { people } = await assignImages(slug, { people: names, mode: "shares", image_ids: null });
      const given = people.reduce((sum, share) => sum + share.images, 0);
      toast({
        key: "assign",
        message:
          given === 0
            ? "Every open image is somebody's task already."
            : `${formatQuantity(given, "image")} given out: ${people.map(({ person, images }) => `${person} ${images}`).join(", ")}`,
      });
      setText("");
      await Promise.all([
        client.invalidateQueries({ queryKey: teamKeys.people(slug) }),
        client.invalidateQueries({ queryKey: keys.images(slug) }),
      ]);
    } catch (error) {
      toast({ key: "assign", tone: "danger", message: asProblem(error).message });
    } finally {
      setBusy(false);
    }
  }

  return (
    <form className="team__share-form" onSubmit={submit}>
      <label className="field">
        <span className="field__label">Share the open images that are nobody's among</span>
        <input
          className="input"
          value={text}
          placeholder="Mara, Jon, …"
          onChange={(event) => setText(event.target.value)}
        />
      </label>
      <Button type="submit" disabled={names.length === 0 || busy}>
        {names.length > 1 ? `Share among ${names.length}` : "Share"}
      </Button>
    </form>
  );
}
